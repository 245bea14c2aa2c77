"""Where Blender's versions differ: the only module that asks which one it runs in, or tries what is there.

A function does one thing in this Blender's way, and says how the ways differ. numpy is imported where it is used: the
panel that says that it is missing needs this module.
"""

import bpy

from ..translations import CONTEXT, local

# From 4.0 on a layout has a bar, and a polygon's corners end where the next one's begin: no count of them is kept.
_SINCE_4_0 = bpy.app.version >= (4, 0, 0)
# From 4.1 on auto smooth is gone: sharp edges are an attribute, and polygons are smooth until they are told otherwise.
_SINCE_4_1 = bpy.app.version >= (4, 1, 0)
# From 4.4 on an action keeps its curves by slots: one for each thing that is animated by it.
_SINCE_4_4 = bpy.app.version >= (4, 4, 0)
# From 4.5 on a mesh takes the normals of its corners as they are given.
OWN_NORMALS = bpy.app.version >= (4, 5, 0)
# Before 4.1 a polygon is smooth or flat as a whole, unless auto smooth, which is slow, makes its normals.
SMOOTH_BY_POLYGON = not _SINCE_4_1


def user_folder(name):
    """A folder of the user's for files that the add-on keeps, which outlives an update of it; it need not be there yet.
    Extensions, which there are from 4.2 on, have one of their own; none may write into its folder."""
    package = __package__.rpartition(".")[0]
    if package.startswith("bl_ext."):
        return bpy.utils.extension_path_user(package, path=name)
    return bpy.utils.user_resource("DATAFILES", path=f"riffler/{name}")


def graphics():
    """What draws the window, or nothing where there is none: Blender 3.4 does not outlive the question then."""
    if bpy.app.background:
        return ""
    import gpu

    return f"{gpu.platform.renderer_get()}, {gpu.platform.version_get()}"


def own_words(cls):
    """What a class that is not registered yet, and its fields, are called is looked up as ours. Fields of Blender 3.4
    know no contexts: its own words for theirs come first."""
    if hasattr(cls, "bl_label"):
        cls.bl_translation_context = CONTEXT
    for field in fields_of(cls).values():
        if "translation_context" in (getattr(getattr(field, "function", None), "__doc__", None) or ""):
            field.keywords["translation_context"] = CONTEXT


def fields_of(cls):
    """{name: field} of a class and those that it is built on. Python 3.14, which Blender 5.2 has, makes annotations
    when they are asked for: none stand among a class's names before."""
    fields = {}
    for base in reversed(cls.__mro__):
        fields |= getattr(base, "__annotations__", {})
    return fields


def progress(layout, state):
    """A bar for `state.percent`, named `state.running`. Before 4.0 a slider looks like one."""
    row = layout.row()
    row.use_property_split = False  # the name goes into the bar, as wide as the panel
    if _SINCE_4_0:
        row.progress(factor=state.percent / 100, text=f"{local(state.running)} {state.percent:.0f} %")
    else:
        row.prop(state, "percent", text=state.running, slider=True)


def write_positions(mesh, co):
    """`co`: flat float32 of all vertices. An attribute is copied as it is; before 3.5 there is none."""
    if "position" in mesh.attributes:
        mesh.attributes["position"].data.foreach_set("vector", co)
    else:
        mesh.vertices.foreach_set("co", co)


def read_positions(mesh, co):
    """Into `co`, as `write_positions` has it."""
    if "position" in mesh.attributes:
        mesh.attributes["position"].data.foreach_get("vector", co)
    else:
        mesh.vertices.foreach_get("co", co)


def write_triangles(mesh, tri):
    """`tri`: flat int32, the vertices of all corners of a mesh whose polygons are all triangles."""
    import numpy as np

    faces = len(mesh.polygons)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * faces, 3, dtype=np.int32))
    if not _SINCE_4_0:
        mesh.polygons.foreach_set("loop_total", np.full(faces, 3, np.int32))
    if ".corner_vert" in mesh.attributes:
        mesh.attributes[".corner_vert"].data.foreach_set("value", tri)
    else:  # unsigned is the type Blender stores: 14 times as fast as int32 in 3.4
        mesh.loops.foreach_set("vertex_index", tri.view(np.uint32))


def write_edges(mesh, ends, corners):
    """`ends`: flat int32, both vertices of all edges; `corners`: the edge that each corner of a polygon begins."""
    import numpy as np

    if ".edge_verts" in mesh.attributes:
        mesh.attributes[".edge_verts"].data.foreach_set("value", ends)
        mesh.attributes[".corner_edge"].data.foreach_set("value", corners)
    else:
        mesh.edges.foreach_set("vertices", ends.view(np.uint32))
        mesh.loops.foreach_set("edge_index", corners.view(np.uint32))


def write_material_indices(mesh, indices):
    """`indices`: int32, the slot of each face. An attribute since 3.5."""
    if "material_index" not in mesh.attributes and _SINCE_4_0:
        mesh.attributes.new("material_index", "INT", "FACE")
    if "material_index" in mesh.attributes:
        mesh.attributes["material_index"].data.foreach_set("value", indices)
    else:
        mesh.polygons.foreach_set("material_index", indices)


def shade_chunk(mesh, angle, smooth=None, normals=None):
    """As `shade_by_angle`, of a mesh that changes all the time and is part of another. `normals`, where OWN_NORMALS:
    (corners, 3) float32 of the whole's. `smooth`, where SMOOTH_BY_POLYGON: which triangles are. Auto smooth computes
    normals again at each undo: 27 of 60 ms for four chunks of 12 000 triangles.
    """
    if OWN_NORMALS:
        mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER").data.foreach_set("vector", normals.ravel())
    elif SMOOTH_BY_POLYGON:
        mesh.polygons.foreach_set("use_smooth", smooth)
    else:
        mesh.set_sharp_from_angle(angle=angle)


def lighten(mesh):
    """Before 4.0 undo reads a mesh again as soon as anything near it changed, however large: one that is hidden for a
    while gives way to the corners of its box. Since then it costs nothing."""
    if _SINCE_4_0 or mesh.users > 1 or not mesh.polygons:
        return
    import numpy as np

    co = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", co.ravel())
    low, high = co.min(axis=0), co.max(axis=0)
    mesh.clear_geometry()
    mesh.vertices.add(8)
    corners = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)], np.float32)
    mesh.vertices.foreach_set("co", corners.ravel())
    mesh.update()


def shade_by_angle(mesh, angle):
    """Smooth, with edges steeper than `angle` (rad) sharp."""
    if _SINCE_4_1:
        mesh.set_sharp_from_angle(angle=angle)
    else:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = angle


def channels(ob):
    """The F-curves of the action that an object has; an empty tuple where it has none."""
    data = ob.animation_data
    if data is None or data.action is None:
        return ()
    if not _SINCE_4_4:
        return data.action.fcurves
    if data.action_slot is None or not data.action.layers or not data.action.layers[0].strips:
        return ()
    bag = data.action.layers[0].strips[0].channelbag(data.action_slot)
    return () if bag is None else bag.fcurves


def own_channels(ob, name):
    """The same to be written: an action of the name is made where there is none, with all that curves stand in."""
    data = ob.animation_data_create()
    if data.action is None:
        data.action = bpy.data.actions.new(name)
    action = data.action
    if not _SINCE_4_4:
        return action.fcurves
    if data.action_slot is None:
        data.action_slot = action.slots[0] if len(action.slots) else action.slots.new("OBJECT", ob.name)
    layer = action.layers[0] if len(action.layers) else action.layers.new("Layer")
    strip = layer.strips[0] if len(layer.strips) else layer.strips.new(type="KEYFRAME")
    return strip.channelbag(data.action_slot, ensure=True).fcurves
