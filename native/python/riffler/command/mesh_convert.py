"""Write a mesh in another format: equal vertices are welded, and nothing else changes.

riffler mesh convert part.obj --out part.stl
riffler mesh convert part.stl --unit inch --out part.3mf
"""

from __future__ import annotations

import argparse

from .. import Mesh
from .arguments import MESHES, input_file, output_file
from .console import Console, number, times
from .parser import Parser
from .shapes import write_mesh

HELP = "write a mesh in another format"
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": 25.4}


def add_arguments(parser: Parser) -> None:
    parser.add_input("mesh", ".stl, .obj, .ply or .3mf", MESHES)
    parser.add_argument("--unit", choices=UNITS, default="mm", help="unit of the lengths in MESH (default mm)")
    parser.add_file("--out", ".stl, .obj, .ply or .3mf", MESHES, required=True)


def run(arguments: argparse.Namespace, console: Console) -> int:
    path = input_file(arguments.mesh, MESHES)
    out = output_file(arguments.out, MESHES)
    with console.step("read"):
        mesh = Mesh.read(path)
    if arguments.unit != "mm":
        mesh = Mesh(UNITS[arguments.unit] * mesh.vertices, mesh.triangles)
    triangles = write_mesh(mesh, out, console)
    lower, upper = mesh.bounds
    data = {
        "out": str(out),
        "vertices": len(mesh.vertices),
        "triangles": triangles,
        "lower": lower.tolist(),
        "upper": upper.tolist(),
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    rows = [
        ("triangles", f"{number(triangles)}, {number(data['vertices'])} vertices"),
        ("size", " × ".join(number(float(side)) for side in upper - lower) + " mm"),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(console.seconds)),
    ]
    console.result(data, f"{out.name} written", rows)
    return 0
