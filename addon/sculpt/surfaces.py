"""The surface that a sculpt's own mesh shows: the triangles that its shape needs, or two for each cell of the surface.

What colours or marks vertices and faces needs all of them: a flat face has only a few when they are left out.
"""

from dataclasses import dataclass

import numpy as np
import riffler

from ..blender import meshes, versions

DETAIL = (
    ("NEEDED", "As Needed", "Triangles where the shape needs them: a flat face has few"),
    ("ALL", "All", "Two triangles for each cell of the surface"),
)
SHARE = 0.1  # of the pitch: how far the triangles that are needed may be from all of them


@dataclass
class Surface:
    """Vertices (V, 3) mm and triangles (F, 3); `shading`, the arguments of meshes.fill that give the mesh the normals
    of all triangles. `within`: mm that it may be from all triangles, `all_triangles` in number; None: it has all."""

    vertices: np.ndarray
    triangles: np.ndarray
    shading: dict
    within: float | None
    all_triangles: int


def within(detail, pitch, mask=None):
    """mm that the triangles that a sculpt shows may be from all of them; None: all are shown, as the user wants it
    (`detail`), to mark those under the mask, or since this Blender takes no normals for large ones."""
    return None if detail == "ALL" or mask is not None or not versions.OWN_NORMALS else SHARE * pitch


def of_volume(volume, tolerance, progress=None):
    """The Surface of a volume; `tolerance` in mm, None for all triangles."""
    if tolerance is not None:
        return of_mesher(riffler.Mesher(volume, tolerance=tolerance, progress=progress))
    surface = volume.to_mesh(progress=progress)
    return Surface(surface.vertices, surface.triangles, {}, None, len(surface.triangles))


def of_mesher(mesher):
    """The same of a mesher with a tolerance."""
    patch = mesher.patch(mesher.patches(), edges=True, normals=meshes.SHARP_ANGLE)
    shading = {"edges": [patch.edges, patch.corner_edges], "normals": patch.normals}
    return Surface(patch.vertices, patch.triangles, shading, mesher.tolerance, mesher.all_triangles)
