"""A map of distances as a coloured mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .. import Mesh

LEGEND = "blue is rest material, red is gouged, white is right; the property quality has the distance in mm"
REST, GOUGE = np.array([33, 102, 172]), np.array([178, 24, 43])


def colours(distance: np.ndarray, scale: float) -> np.ndarray:
    """Colours (n, 3) uint8 for distances (n,) in mm; full colours from ``scale`` mm on. Both signs fade alike."""
    share = np.clip(np.abs(distance) / scale, 0, 1)[:, None]
    full = np.where(distance[:, None] > 0, REST, GOUGE)
    return np.rint(255 + share * (full - 255)).astype(np.uint8)


def write_map(path: Path, mesh: Mesh, distance: np.ndarray, scale: float) -> None:
    """Writes a binary PLY with x, y, z, red, green, blue and quality (mm), as MeshLab and Blender read them."""
    place = [("x", "<f4"), ("y", "<f4"), ("z", "<f4")]
    vertices = np.zeros(
        len(mesh.vertices), [*place, ("red", "u1"), ("green", "u1"), ("blue", "u1"), ("quality", "<f4")]
    )
    for k, name in enumerate("xyz"):
        vertices[name] = mesh.vertices[:, k]
    for k, name in enumerate(("red", "green", "blue")):
        vertices[name] = colours(distance, scale)[:, k]
    vertices["quality"] = distance
    faces = np.zeros(len(mesh.triangles), [("n", "u1"), ("corners", "<i4", 3)])
    faces["n"], faces["corners"] = 3, mesh.triangles
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"comment {LEGEND}; full colours at {scale:g} mm\n"
        f"element vertex {len(vertices)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float quality\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(header.encode() + vertices.tobytes() + faces.tobytes())
