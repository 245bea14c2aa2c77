"""Remove triangles of a mesh while its surface stays within a tolerance, or down to a number of triangles.

riffler mesh decimate part.stl --tolerance 0.01 --out small.stl
riffler mesh decimate part.stl --triangles 20000 --out small.stl
"""

from __future__ import annotations

import argparse

from ..formats import MESHES, PARTS
from .arguments import A_PART, input_file, length, output_file, whole
from .console import Console, number, times
from .parser import Parser
from .shapes import read_mesh, write_mesh

HELP = "remove triangles within a tolerance"


def add_arguments(parser: Parser) -> None:
    parser.add_input("mesh", A_PART, PARTS)
    parser.add_argument("--tolerance", metavar="MM", help="largest distance that the surface may move")
    parser.add_argument("--triangles", metavar="N", help="number of triangles to keep")
    parser.add_file("--out", ".stl, .obj, .ply or .3mf", MESHES, required=True)


def run(arguments: argparse.Namespace, console: Console) -> int:
    if arguments.tolerance is None and arguments.triangles is None:
        raise ValueError("--tolerance or --triangles expected")
    tolerance = None if arguments.tolerance is None else length(arguments.tolerance, "--tolerance")
    triangles = None if arguments.triangles is None else whole(arguments.triangles, "--triangles")
    path = input_file(arguments.mesh, PARTS)
    out = output_file(arguments.out, MESHES)
    with console.step("read") as progress:
        mesh = read_mesh(path, console, progress=progress)
    with console.step("decimate") as progress:
        small = mesh.decimate(triangles=triangles, tolerance=tolerance, progress=progress)
    with console.step("measure"):
        moved = max(float(small.deviation(mesh).max(initial=0)), float(mesh.deviation(small).max(initial=0)))
    data = {
        "out": str(out),
        "triangles": write_mesh(small, out, console),
        "triangles_before": len(mesh.triangles),
        "deviation": moved,
        "volume": float(small.volume),
        "volume_before": float(mesh.volume),
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    rows = [
        ("triangles", f"{number(data['triangles'])} of {number(data['triangles_before'])}"),
        ("deviation", f"{moved:.3g} mm at most, measured at the vertices of both meshes"),
        ("volume", f"{number(data['volume'], 'mm³')}, {number(data['volume_before'], 'mm³')} before"),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(console.seconds)),
    ]
    console.result(data, f"{out.name} written", rows)
    return 0
