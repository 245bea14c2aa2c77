"""Turn a mesh into a dexel volume.

riffler volume from-mesh part.stl --pitch 0.2 --out part.rvol
"""

from __future__ import annotations

import argparse
import dataclasses

from .. import VolumeReport
from ..formats import PARTS, VOLUMES
from .arguments import A_PART, add_directions, add_pitch, input_file, length, output_file
from .console import Console, Rows, number, times
from .parser import Parser
from .shapes import from_mesh, rays, write_volume

HELP = "turn a mesh into a dexel volume"


def add_arguments(parser: Parser) -> None:
    parser.add_input("mesh", A_PART, PARTS)
    add_pitch(parser, required=True)
    add_directions(parser)
    parser.add_file("--out", ".rvol", VOLUMES, required=True)


def run(arguments: argparse.Namespace, console: Console) -> int:
    pitch = length(arguments.pitch, "--pitch")
    path = input_file(arguments.mesh, PARTS)
    out = output_file(arguments.out, VOLUMES)
    volume, report = from_mesh(path, pitch, arguments.directions or "xyz", console, "convert")
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
        "mesh": dataclasses.asdict(report),
        "seconds": console.seconds,
    }
    rows = [
        ("rays", f"{number(data['rays'])} ({volume.directions}, pitch {volume.pitch:g} mm)"),
        ("volume", number(data["volume"], "mm³")),
        ("file", number(data["bytes"], "bytes")),
        *defects(report),
        ("times", times(console.seconds)),
    ]
    console.result(data, f"{out.name} written", rows)
    return 0


def defects(report: VolumeReport) -> Rows:
    """The defects of a mesh and the treatment of each, as rows of a table."""

    def count(name: str, one: str, many: str = "") -> str:
        n = int(getattr(report, name))
        return f"{number(n)} {one if n == 1 else many or one + 's'}"

    def share(name: str) -> str:
        percent = 100 * getattr(report, name)
        return f"{percent:.3g} %" if percent >= 0.01 else "less than 0.01 %"

    def listed(**words: str) -> str:
        return ", ".join(count(name, word) for name, word in words.items() if getattr(report, name))

    rows: Rows = []
    if report.openings:
        text = f"{count('openings', 'opening')}, {count('open_edges', 'open edge')}"
        if report.doubtful_rays:
            text += f"; {share('doubtful_rays')} of the rays end in an opening instead of at the part's surface"
        rows.append(("open", text))
    elif report.open_edges:
        rows.append(("open", f"{count('open_edges', 'open edge')} that cancel: the volume is not in doubt"))
    if edges := listed(nonmanifold_edges="non-manifold edge", inconsistent_edges="inconsistently oriented edge"):
        rows.append(("edges", edges))
    if triangles := listed(turned="triangle"):
        rows.append(("turned", f"{triangles} to agree with their neighbours"))
    if pieces := listed(one_sided="piece"):
        rows.append(("one side", f"{pieces} like a Möbius strip, left unchanged"))
    if report.flipped_shells:
        shells = count("flipped_shells", "shell is", "shells are")
        rows.append(("inside out", f"{shells} inside out, {share('inside_out')} of the volume; taken as solid"))
    if report.overlap:
        rows.append(("overlap", f"{share('overlap')} of the volume is enclosed more than once; taken once"))
    if triangles := listed(duplicates="doubled triangle", degenerate="flat triangle"):
        rows.append(("triangles", triangles))
    return rows
