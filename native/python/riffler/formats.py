"""The suffixes of the files that commands and jobs read and write."""

from __future__ import annotations

from .cad import EXTENSIONS as CAD

MESHES = (".stl", ".obj", ".ply", ".3mf")  # are read and written
PARTS = MESHES + CAD  # are read
VOLUMES = (".rvol",)
