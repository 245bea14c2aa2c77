"""Carve the stock of a recorded session again, and write the same result to the bit.

riffler volume replay session.rjournal --out session.rvol
"""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import Journal
from ..formats import MESHES, VOLUMES
from .arguments import JOURNALS, input_file, output_file
from .console import Console, number, times
from .detail import NOT_MESHED, Written, add_detail, detail_of
from .parser import Parser
from .shapes import rays, write_left

HELP = "carve the strokes of a recorded session again"


def add_arguments(parser: Parser) -> None:
    parser.add_input("journal", ".rjournal", JOURNALS)
    parser.add_argument("--folder", metavar="DIR", help="folder of the stock's snapshot (default: the journal's)")
    add_detail(parser)
    parser.add_file("--out", ".stl, .obj, .ply, .3mf or .rvol", MESHES + VOLUMES, required=True)


def run(arguments: argparse.Namespace, console: Console) -> int:
    path = input_file(arguments.journal, JOURNALS)
    detail = detail_of(arguments)
    out = output_file(arguments.out, MESHES + VOLUMES)
    with console.step("read"):
        journal = Journal.load(path)
    with console.step("replay") as progress:
        volume = journal.replay(Path(arguments.folder or path.parent), progress=progress)
    written = write_left(volume, out, console, detail)
    strokes = journal.strokes
    data = {
        "out": str(out),
        "strokes": len(strokes),
        "rows": sum(len(stroke) for stroke in strokes),
        "cut_at": journal.cut_at,
        "pitch": volume.pitch,
        "directions": volume.directions,
        "rays": rays(volume),
        "volume": volume.volume,
        **(written.to_dict() if written else NOT_MESHED),
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    console.result(data, f"{out.name} written", table(data, written))
    return 0


def table(data: dict, written: Written | None) -> list[tuple[str, str]]:
    rows = [
        ("strokes", f"{number(data['strokes'])}, {number(data['rows'])} rows"),
        ("rays", f"{number(data['rays'])} ({data['directions']}, pitch {data['pitch']:g} mm)"),
        ("left", number(data["volume"], "mm³")),
    ]
    if data["cut_at"] is not None:
        rows.insert(1, ("", f"the recording is cut off at byte {data['cut_at']}: all whole strokes"))
    if written is not None:
        rows.append(("triangles", str(written)))
    return [*rows, ("file", number(data["bytes"], "bytes")), ("times", times(data["seconds"]))]
