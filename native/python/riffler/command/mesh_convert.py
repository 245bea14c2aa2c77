"""Write a mesh or a CAD file in another format: equal vertices are welded, and nothing else changes.

riffler mesh convert part.obj part.stl
riffler mesh convert part.step part.stl --tolerance 0.01
riffler mesh convert part.stl --unit inch --out part.3mf
"""

from __future__ import annotations

import argparse

from .. import Mesh, cad
from ..formats import MESHES, PARTS
from .arguments import A_PART, input_file, length, output_file
from .console import Console, number, times
from .parser import Parser
from .shapes import read_mesh, write_mesh

HELP = "write a mesh or a CAD file in another format"
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": 25.4}


def add_arguments(parser: Parser) -> None:
    parser.add_input("mesh", A_PART, PARTS)
    parser.add_input("out", "the file to write: .stl, .obj, .ply or .3mf", MESHES)
    parser.add_argument("--tolerance", metavar="MM", help="chord error of a CAD file (default 0.01)")
    parser.add_argument(
        "--unit", choices=UNITS, help="unit of the lengths in MESH (default mm; CAD files state their own)"
    )


def run(arguments: argparse.Namespace, console: Console) -> int:
    path = input_file(arguments.mesh, PARTS)
    out = output_file(arguments.out, MESHES)
    if path.suffix.lower() in cad.EXTENSIONS:
        if arguments.unit is not None:
            raise ValueError(f"--unit is for meshes; {path.name} states its own")
        chord = 0.01 if arguments.tolerance is None else length(arguments.tolerance, "--tolerance")
        with console.step("read") as progress:
            mesh = read_mesh(path, console, tolerance=chord, progress=progress)
    else:
        if arguments.tolerance is not None:
            raise ValueError(
                f"--tolerance is for CAD files; {path.name} has triangles: riffler mesh decimate leaves some out"
            )
        with console.step("read"):
            mesh = Mesh.read(path)
        if arguments.unit is not None:
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
