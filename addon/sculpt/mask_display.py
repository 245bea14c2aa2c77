"""What is protected of a sculpt, as it is seen: faces of another material, in every way of shading."""

import bpy
import numpy as np

from ..blender import versions

NAME = "Riffler Mask"
COLOUR = (0.16, 0.2, 0.3, 1.0)


def on_grid_of(volume, mask):
    """The mask of a sculpt that becomes `volume`, which has other rays or another box; None where nothing is left."""
    if mask is None or mask.volume == 0:
        return None
    if (mask.pitch, mask.directions) == (volume.pitch, volume.directions):
        made = mask.grown(volume.lower, volume.upper)
        if np.array_equal([made.lower, made.upper], [volume.lower, volume.upper]):
            return made  # on the rays that it had
    made = mask.resampled(volume.pitch, volume.directions, volume.lower, volume.upper)
    return made if made.volume > 0 else None


def show(mesh, mask, co, tri):
    """Gives the faces that lie in `mask` (a volume or None) the mask's material. `co` (V, 3) mm in the sculpt's frame,
    `tri` (F, 3): what the mesh was just filled with."""
    slot = next((k for k, m in enumerate(mesh.materials) if m is not None and m.name == NAME), None)
    if mask is None:
        if slot is not None:  # the last one, as it was put on
            mesh.materials.pop(index=slot)
        return
    if not len(tri):
        return
    covered = mask.contains(co[tri].mean(axis=1))
    if not covered.any():
        return
    if slot is None:
        if not mesh.materials:
            mesh.materials.append(None)  # of what is free
        mesh.materials.append(_material())
        slot = len(mesh.materials) - 1
    versions.write_material_indices(mesh, np.where(covered, slot, 0).astype(np.int32))


def _material():
    material = bpy.data.materials.get(NAME)
    if material is None:
        material = bpy.data.materials.new(NAME)
        material.diffuse_color = COLOUR
    return material
