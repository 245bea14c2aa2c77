"""Turn a dexel volume into a closed mesh.

riffler volume to-mesh part.rvol --out part.stl [--tolerance 0.01]
"""

from __future__ import annotations

import argparse

from .. import Volume
from .arguments import MESHES, VOLUMES, input_file, length, output_file
from .console import Console, number, times
from .parser import Once, Parser
from .shapes import to_mesh, write_mesh

HELP = "turn a dexel volume into a closed mesh"


def add_arguments(parser: Parser) -> None:
    parser.add_input("volume", ".rvol", VOLUMES)
    parser.add_file("--out", ".stl, .obj, .ply or .3mf", MESHES, required=True)
    about = "leave out triangles as long as the surface moves no further"
    tolerance = parser.add_argument("--tolerance", metavar="MM", action=Once, help=about)
    parser.add_old_name("--decimate", tolerance)


def run(arguments: argparse.Namespace, console: Console) -> int:
    tolerance = None if arguments.tolerance is None else length(arguments.tolerance, "--tolerance")
    path = input_file(arguments.volume, VOLUMES)
    out = output_file(arguments.out, MESHES)
    with console.step("read") as progress:
        volume = Volume.load(path, progress=progress)
    mesh = to_mesh(volume, console, out)
    meshed = len(mesh.triangles)
    if tolerance is not None:
        with console.step("decimate"):
            mesh = mesh.decimate(tolerance=tolerance)
    triangles = write_mesh(mesh, out, console)
    data = {
        "out": str(out),
        "triangles": triangles,
        "triangles_before_decimation": meshed,
        "volume": volume.volume,
        "mesh_volume": float(mesh.volume),
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    before = f"  (of {number(meshed)})" if tolerance is not None else ""
    rows = [
        ("triangles", number(triangles) + before),
        ("volume", number(data["mesh_volume"], "mm³")),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(console.seconds)),
    ]
    console.result(data, f"{out.name} written", rows)
    return 0
