"""Turn a mesh into a dexel volume.

riffler convert part.stl --pitch 0.2 --out part.rvol
"""

from __future__ import annotations

import argparse

from .arguments import MESHES, VOLUMES, add_directions, add_pitch, input_file, length, output_file
from .console import Console, number, times
from .shapes import from_mesh, rays, write_volume

HELP = "turn a mesh into a dexel volume"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("mesh", metavar="FILE", help=".stl, .obj or .ply")
    add_pitch(parser, required=True)
    add_directions(parser)
    parser.add_argument("--out", required=True, metavar="FILE", help=".rvol")


def run(arguments: argparse.Namespace, console: Console) -> int:
    pitch = length(arguments.pitch, "--pitch")
    path = input_file(arguments.mesh, MESHES)
    out = output_file(arguments.out, VOLUMES)
    volume = from_mesh(path, pitch, arguments.directions or "xyz", console, "convert")
    write_volume(volume, out, console)
    data = {
        "out": str(out),
        "pitch": volume.pitch,
        "directions": volume.directions,
        "lower": volume.lower.tolist(),
        "upper": volume.upper.tolist(),
        "rays": rays(volume),
        "volume": volume.volume,
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    rows = [
        ("rays", f"{number(data['rays'])} ({volume.directions}, pitch {volume.pitch:g} mm)"),
        ("volume", number(data["volume"], "mm³")),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(console.seconds)),
    ]
    console.result(data, f"{out.name} written", rows)
    return 0
