"""Check that a mesh is a closed 2-manifold; exit status 1 if not.

riffler mesh audit part.stl
"""

from __future__ import annotations

import argparse
import dataclasses

from .. import Mesh
from ..formats import PARTS
from .arguments import A_PART, input_file
from .console import Console, number
from .parser import Parser
from .shapes import read_mesh

HELP = "check that a mesh is a closed 2-manifold"

# A count above 0 means that the mesh is not a closed 2-manifold.
DEFECTS = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "duplicates")


def add_arguments(parser: Parser) -> None:
    parser.add_input("mesh", A_PART, PARTS)


def repairs(mesh: Mesh) -> dict[str, int]:
    """Numbers of triangles that riffler would turn or leave out to use the mesh as a solid."""
    return dataclasses.asdict(mesh.orient_with_report()[1])


def run(arguments: argparse.Namespace, console: Console) -> int:
    path = input_file(arguments.mesh, PARTS)
    mesh = read_mesh(path, console)
    audit = dataclasses.asdict(mesh.audit())
    closed = not any(audit[key] for key in DEFECTS)
    data = {
        "file": str(path),
        "closed": closed,
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.triangles),
        **audit,
        **repairs(mesh),
    }
    rows = [(key.replace("_", " "), number(value)) for key, value in data.items() if key not in ("file", "closed")]
    verdict = "a closed 2-manifold" if closed else "not a closed 2-manifold"
    console.result(data, f"{path.name}: {verdict}", rows)
    return 0 if closed else 1
