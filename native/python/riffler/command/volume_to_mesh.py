"""Turn a dexel volume into a closed mesh.

riffler volume to-mesh part.rvol --out part.stl [--detail 0.01]
"""

from __future__ import annotations

import argparse

from .. import Volume
from ..formats import MESHES, VOLUMES
from .arguments import input_file, length, output_file
from .console import Console, number, times
from .detail import Detail, Written, add_detail, detail_of
from .parser import Once, Parser
from .shapes import to_mesh, write_mesh

HELP = "turn a dexel volume into a closed mesh"


def add_arguments(parser: Parser) -> None:
    parser.add_input("volume", ".rvol", VOLUMES)
    parser.add_file("--out", ".stl, .obj, .ply or .3mf", MESHES, required=True)
    add_detail(parser)
    about = "fewest triangles within this distance of the full mesh; slower than --detail"
    tolerance = parser.add_argument("--tolerance", metavar="MM", action=Once, help=about)
    parser.add_old_name("--decimate", tolerance)


def run(arguments: argparse.Namespace, console: Console) -> int:
    if arguments.tolerance is not None and arguments.detail is not None:
        raise ValueError("--detail or --tolerance expected, not both")
    tolerance = None if arguments.tolerance is None else length(arguments.tolerance, "--tolerance")
    path = input_file(arguments.volume, VOLUMES)
    out = output_file(arguments.out, MESHES)
    with console.step("read") as progress:
        volume = Volume.load(path, progress=progress)
    detail = detail_of(arguments) if tolerance is None else Detail(all=True)
    mesh, written = to_mesh(volume, console, out, detail)
    if tolerance is not None:
        with console.step("decimate"):
            mesh = mesh.decimate(tolerance=tolerance)
        written = Written(len(mesh.triangles), written.all_triangles, tolerance)
    write_mesh(mesh, out, console)
    data = {
        "out": str(out),
        **written.to_dict(),
        "triangles_before_decimation": written.all_triangles,
        "volume": volume.volume,
        "mesh_volume": float(mesh.volume),
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    rows = [
        ("triangles", str(written)),
        ("volume", number(data["mesh_volume"], "mm³")),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(console.seconds)),
    ]
    console.result(data, f"{out.name} written", rows)
    return 0
