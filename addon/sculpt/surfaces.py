"""The surface that a sculpt's own mesh shows: the triangles that its shape needs, or two for each cell of the surface.

Colours of vertices and marks of faces need all triangles, because a flat face otherwise has only a few vertices.
"""

from dataclasses import dataclass

import numpy as np
import riffler

from ..blender import meshes, versions

DETAIL = (
    ("NEEDED", "As Needed", "Triangles where the shape needs them: a flat face has few"),
    ("ALL", "All", "Two triangles for each cell of the surface"),
)
SHARE = 0.1  # largest distance of the needed triangles from the mesh of all triangles, as a share of the pitch


@dataclass
class Surface:
    """Vertices (V, 3) mm and triangles (F, 3); `shading`, the arguments of meshes.fill that give the mesh the normals
    of all triangles. `within`: largest distance from the mesh of all triangles, mm; None: it has all of them.
    `all_triangles`: their number."""

    vertices: np.ndarray
    triangles: np.ndarray
    shading: dict
    within: float | None
    all_triangles: int


def within(detail, pitch, mask=None):
    """Largest distance, in mm, of a sculpt's displayed triangles from the mesh of all triangles. None: it shows all of
    them, because the user chose that (`detail`), to mark the mask, or because this Blender takes no custom normals."""
    return None if detail == "ALL" or mask is not None or not versions.OWN_NORMALS else SHARE * pitch


def of_volume(volume, tolerance, progress=None):
    """The Surface of a volume; `tolerance` in mm, None for all triangles."""
    if tolerance is not None:
        return of_mesher(riffler.Mesher(volume, tolerance=tolerance, progress=progress))
    surface = volume.to_mesh(progress=progress)
    return Surface(surface.vertices, surface.triangles, {}, None, len(surface.triangles))


def of_mesher(mesher):
    """The same for a mesher with a tolerance."""
    patch = mesher.patch(mesher.patches(), edges=True, normals=meshes.SHARP_ANGLE)
    shading = {"edges": [patch.edges, patch.corner_edges], "normals": patch.normals}
    return Surface(patch.vertices, patch.triangles, shading, mesher.tolerance, mesher.all_triangles)
