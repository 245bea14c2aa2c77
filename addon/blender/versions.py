"""The differences between Blender's versions: the only module that checks which version it runs in, or which features
exist.

Each function does one thing in the method of this Blender, and its docstring states how the versions differ. numpy is
imported where it is used: the panel that reports it as missing needs this module.
"""

import bpy

from ..translations import CONTEXT, local

# From 4.0 on a layout has a progress bar, and a polygon's corners end where those of the next begin: their count is not
# stored.
_SINCE_4_0 = bpy.app.version >= (4, 0, 0)
# From 4.1 on there is no auto smooth: sharp edges are an attribute, and polygons are smooth by default.
_SINCE_4_1 = bpy.app.version >= (4, 1, 0)
# From 4.4 on an action keeps its curves in slots: one for each datablock that it animates.
_SINCE_4_4 = bpy.app.version >= (4, 4, 0)
# From 4.5 on a mesh stores custom normals of its corners unchanged.
OWN_NORMALS = bpy.app.version >= (4, 5, 0)
# Before 4.1 a polygon is smooth or flat as a whole, unless auto smooth, which is slow, computes its normals.
SMOOTH_BY_POLYGON = not _SINCE_4_1


def user_folder(name):
    """A folder of the user's for files that the add-on keeps, which survives updates; it need not exist yet. Extensions
    (from 4.2 on) have a user folder of their own, and may not write into their installation folder."""
    package = __package__.rpartition(".")[0]
    if package.startswith("bl_ext."):
        return bpy.utils.extension_path_user(package, path=name)
    return bpy.utils.user_resource("DATAFILES", path=f"riffler/{name}")


def graphics():
    """Name of the graphics backend, or "" without a window: Blender 3.4 crashes if it is queried then."""
    if bpy.app.background:
        return ""
    import gpu

    return f"{gpu.platform.renderer_get()}, {gpu.platform.version_get()}"


def own_words(cls):
    """Makes Blender translate the labels of a class that is not registered yet, and of its fields, from our table.
    Fields of Blender 3.4 have no contexts: there Blender's own words come first."""
    if hasattr(cls, "bl_label"):
        cls.bl_translation_context = CONTEXT
    for field in fields_of(cls).values():
        if "translation_context" in (getattr(getattr(field, "function", None), "__doc__", None) or ""):
            field.keywords["translation_context"] = CONTEXT


def fields_of(cls):
    """{name: field} of a class and its bases. Python 3.14, in Blender 5.2, evaluates annotations lazily: they are not
    in the class's __dict__ before."""
    fields = {}
    for base in reversed(cls.__mro__):
        fields |= getattr(base, "__annotations__", {})
    return fields


def progress(layout, state):
    """A bar for `state.percent`, named `state.running`. Before 4.0 it is a slider, which looks alike."""
    row = layout.row()
    row.use_property_split = False  # the name goes into the bar, as wide as the panel
    if _SINCE_4_0:
        row.progress(factor=state.percent / 100, text=f"{local(state.running)} {state.percent:.0f} %")
    else:
        row.prop(state, "percent", text=state.running, slider=True)


def write_positions(mesh, co):
    """`co`: flat float32 of all vertices. Copies an attribute; before 3.5 there is none."""
    if "position" in mesh.attributes:
        mesh.attributes["position"].data.foreach_set("vector", co)
    else:
        mesh.vertices.foreach_set("co", co)


def read_positions(mesh, co):
    """Reads into `co`, in the layout of `write_positions`."""
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
    """Like `shade_by_angle`, for a mesh that changes all the time and is part of a larger one. `normals`, if
    OWN_NORMALS: (corners, 3) float32 of the whole mesh. `smooth`, if SMOOTH_BY_POLYGON: which triangles are smooth.
    Auto smooth computes normals again at each undo: 27 of 60 ms for four chunks of 12 000 triangles."""
    if OWN_NORMALS:
        mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER").data.foreach_set("vector", normals.ravel())
    elif SMOOTH_BY_POLYGON:
        mesh.polygons.foreach_set("use_smooth", smooth)
    else:
        mesh.set_sharp_from_angle(angle=angle)


def lighten(mesh):
    """Before 4.0 undo reads a mesh again as soon as anything near it changes, even a large one: a mesh that is hidden
    for a while is replaced by the corners of its box. Since then a large mesh costs nothing."""
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
    """Makes faces smooth, and edges steeper than `angle` (rad) sharp."""
    if _SINCE_4_1:
        mesh.set_sharp_from_angle(angle=angle)
    else:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = angle


def channels(ob):
    """The F-curves of an object's action; an empty tuple without one."""
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
    """The same for writing: makes an action of the name, with the containers of its curves, if there is none."""
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
