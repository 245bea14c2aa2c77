"""The display of a sculpt's mask: protected faces have another material, in every shading mode."""

import bpy
import numpy as np

from ..blender import versions

NAME = "Riffler Mask"
COLOUR = (0.16, 0.2, 0.3, 1.0)


def on_grid_of(volume, mask):
    """The mask of a sculpt that becomes `volume`, with other rays or another box; None if nothing stays protected."""
    if mask is None or mask.volume == 0:
        return None
    if (mask.pitch, mask.directions) == (volume.pitch, volume.directions):
        made = mask.grow(volume.lower, volume.upper)
        if np.array_equal([made.lower, made.upper], [volume.lower, volume.upper]):
            return made  # on its previous rays
    made = mask.resample(volume.pitch, volume.directions, lower=volume.lower, upper=volume.upper)
    return made if made.volume > 0 else None


def show(mesh, mask, co, tri):
    """Gives the faces within `mask` (a volume or None) the mask's material. `co` (V, 3) mm in the sculpt's frame, `tri`
    (F, 3): the mesh's current geometry."""
    slot = next((k for k, m in enumerate(mesh.materials) if m is not None and m.name == NAME), None)
    if mask is None:
        if slot is not None:  # the last one, where it was added
            mesh.materials.pop(index=slot)
        return
    if not len(tri):
        return
    covered = mask.contains(co[tri].mean(axis=1))
    if not covered.any():
        return
    if slot is None:
        if not mesh.materials:
            mesh.materials.append(None)  # for unprotected faces
        mesh.materials.append(_material())
        slot = len(mesh.materials) - 1
    versions.write_material_indices(mesh, np.where(covered, slot, 0).astype(np.int32))


def is_shown(mesh):
    """Whether faces of the mesh have, or had, the mask's material."""
    return NAME in mesh.materials


def _material():
    material = bpy.data.materials.get(NAME)
    if material is None:
        material = bpy.data.materials.new(NAME)
        material.diffuse_color = COLOUR
    return material
