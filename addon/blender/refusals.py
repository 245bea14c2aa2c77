"""Why an object cannot be used in its state, or means something else than it seems to: one sentence for each state,
with the remedy. Every operator takes its messages from here."""

import numpy as np

from . import meshes

ALIKE = 1e-4  # tolerance of axes that must be perpendicular (cosines), and of scales that must be 1
NOTHING = 1e-6  # of the largest scale: matrices are single precision
CLEAR_SCALE = "use Object > Clear > Scale"
CLEAR_PARENT = "use Object > Parent > Clear and Keep Transformation"
BY_CONSTRAINT = "take away the constraint that does it"


# ------------------------------------------------------------------ what cannot be
def linked(*data):
    """Why an object, and its data if given, cannot be changed; or ""."""
    name = data[0].name
    if any(d.override_library for d in data):
        return f"{name} overrides data of another file, which keeps no edits: {_local(data)}"
    if any(d.library for d in data):
        return f"{name} is linked from another file: {_local(data)}"
    return ""


def _local(data):
    return f"use Object > Relations > Make Local > Selected Objects{' and Data' if len(data) > 1 else ''}"


def instance(ob):
    """Why an object that stands for a collection, as a linked one does, has no surface; or "". "" for None."""
    if ob is None or ob.instance_type != "COLLECTION" or ob.instance_collection is None:
        return ""
    return f"{ob.name} is an instance of {ob.instance_collection.name}: use Object > Apply > Make Instances Real"


def disabled(ob, view_layer):
    """Why the object's place and modifiers are unknown; or ""."""
    if not ob.hide_viewport and _evaluated(set(ob.users_collection), view_layer.layer_collection):
        return ""
    return f"{ob.name} is disabled in viewports or in this view layer: enable it in the Outliner"


def _evaluated(homes, layer):
    """True if the objects of these collections are evaluated: hidden ones are, disabled ones are not, although they
    report it when something points to them."""
    if layer.exclude or layer.collection.hide_viewport:
        return False
    return layer.collection in homes or any(_evaluated(homes, child) for child in layer.children)


def flat(ob, matrix=None):
    """Why an object has no millimetres, or "". `matrix`: of the world, if not the object's own."""
    sizes = np.linalg.svd(_axes(ob, matrix), compute_uv=False)
    if np.isfinite(sizes).all() and sizes[-1] > NOTHING * sizes[0]:
        return ""
    return f"{ob.name} is scaled to nothing along an axis: {_unscale(ob)}"


def sheared(ob, matrix=None):
    """Why nothing can be put at an object's place, or "": Blender drops the shear, so it would lie elsewhere. `matrix`:
    of the world, if not the object's own."""
    if not _is_sheared(_axes(ob, matrix)):
        return ""
    return f"{ob.name} is sheared: {BY_CONSTRAINT if ob.parent is None else CLEAR_PARENT}"


def _is_sheared(axes):
    size = np.linalg.norm(axes, axis=0)
    if not size.all():
        return False  # the object is flat
    between = (axes / size).T @ (axes / size)
    return np.abs(between - np.eye(3)).max() > ALIKE


def refuse(context, ob):
    """ValueError if a sculpt cannot be used."""
    why = disabled(ob, context.view_layer) or flat(ob)
    if not why and _is_sheared(_axes(ob)):
        why = f"{ob.name} is sheared: {_unscale(ob)}"  # the scale that the shear leaves is not the object's own
    if why:
        raise ValueError(why)


# ------------------------------------------------------------------ what can be, but is not what it seems
def scaled(ob):
    """Why lengths in a sculpt differ from those of the scene, or ""."""
    axes = _axes(ob)
    if np.allclose(axes.T @ axes, np.eye(3), rtol=0, atol=ALIKE) and np.linalg.det(axes) > 0:
        return ""
    return (
        f"{ob.name} is scaled or mirrored: its millimetres follow its own axes, not the scene's. To make them "
        f"equal, {_unscale(ob)}"
    )


def modified(ob):
    """Why a sculpt's volume differs from what is visible, or ""."""
    if not has_modifiers(ob):
        return ""
    return (
        f"{ob.name} has modifiers, which the volume does not include: use Apply Mesh Edits to include them, or "
        "remove them"
    )


def has_modifiers(ob):
    """True if a visible modifier changes the mesh, which the volume does not include."""
    return any(modifier.show_viewport for modifier in ob.modifiers)


def _axes(ob, matrix=None):
    return (meshes.matrix(ob.matrix_world) if matrix is None else matrix)[:3, :3]


def _unscale(ob):
    if ob.parent is not None:
        return f"{CLEAR_PARENT}, then {CLEAR_SCALE.removeprefix('use ')}"
    return BY_CONSTRAINT if all(s == 1 for s in ob.scale) else CLEAR_SCALE
