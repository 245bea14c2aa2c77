"""Carve stock with an NC program and write the material that is left.

riffler volume carve part.ngc --stock 100x60x30 --pitch 0.25 --tool ball:6 --out part.stl
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from .. import Program, Tool, Volume
from ..formats import MESHES, VOLUMES
from . import tools
from .arguments import length, machine_options, output_file
from .console import Console, number, times
from .detail import NOT_MESHED, Written, add_detail, detail_of
from .parser import Parser
from .programs import add_machine, add_program, machine_name, read_program
from .shapes import rays, write_left
from .stock import add_stock, stock

HELP = "carve stock with an NC program"
AWAY = -1  # tool number of moves that begin or end at a position of the machine: no tool has it


def add_arguments(parser: Parser) -> None:
    add_program(parser)
    add_stock(parser)
    tools.add_tools(parser)
    add_machine(parser)
    parser.add_argument(
        "--tolerance", default="0.01", metavar="MM", help="largest error of moves that turn the tool (default 0.01)"
    )
    add_detail(parser)
    parser.add_file(
        "--out", "the material that is left: .stl, .obj, .ply, .3mf or .rvol", MESHES + VOLUMES, required=True
    )


def run(arguments: argparse.Namespace, console: Console) -> int:
    tolerance = length(arguments.tolerance, "--tolerance")
    detail = detail_of(arguments)
    out = output_file(arguments.out, MESHES + VOLUMES)
    wanted = [tools.parse(text) for text in arguments.tool]
    machine = machine_name(arguments.machine or "tcp", "--machine")
    with console.step("program"):
        how = machine_options(arguments.machine_option, "--machine-option")
        program = read_program(Path(arguments.program), machine, how, console).followed()
        poses = np.asarray(program.poses)
        called = called_in_part(program)
        rapid = np.asarray(program.rapid)[1:]
    if len(poses) < 2:
        raise ValueError(f"{Path(arguments.program).name}: no moves to carve")
    # A cutter that is given without a length gets one that always reaches out of the stock.
    volume = stock(arguments, console)
    reach = float(np.linalg.norm(volume.upper - volume.lower))
    by_number = tools.assign(wanted, called[1:][called[1:] != AWAY], reach)
    before = volume.volume
    removed = carve(volume, poses, called, by_number, tolerance, console)
    after = volume.volume

    written = write_left(volume, out, console, detail)

    data = {
        "out": str(out),
        "pitch": volume.pitch,
        "directions": volume.directions,
        "rays": rays(volume),
        "moves": len(removed),
        "moves_without_tool": sum(last - first for first, last, n in tools.runs(called) if n not in (*by_number, AWAY)),
        "moves_at_machine": int((called[1:] == AWAY).sum()),
        "tools": {str(n): tool.to_dict() for n, tool in by_number.items()},
        "volume_before": before,
        "volume": after,
        "removed": float(removed.sum()),
        "removed_by_rapids": float(removed[rapid].sum()),
        **(written.to_dict() if written else NOT_MESHED),
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    console.result(data, f"{out.name} written", table(data, written))
    return 0


def called_in_part(program: Program) -> np.ndarray:
    """(n,) tool numbers of the rows; AWAY if the move to a row begins or ends at a position of the machine."""
    away = np.asarray(program.at_machine)
    return np.where(np.append(False, away[1:] | away[:-1]), AWAY, program.tool)


def carve(
    volume: Volume,
    poses: np.ndarray,
    called: np.ndarray,
    by_number: dict[int, Tool],
    tolerance: float,
    console: Console,
) -> np.ndarray:
    """Carves all moves; returns the volume that each removed, mm³. Every run of moves with one tool is one call.

    The first move after a tool change starts where the last one ended, as on a machine that changes tools in place.
    """
    removed = np.zeros(len(poses) - 1)
    with console.step("carve") as progress:
        for first, last, tool in tools.runs(called):
            if tool not in by_number:
                continue  # nothing is in the spindle yet

            def share(done: float, first: int = first, last: int = last) -> None:
                if progress is not None:
                    progress((first + done * (last - first)) / len(removed))

            watched = None if progress is None else share
            cut = volume.carve(by_number[tool], poses[first : last + 1], tolerance=tolerance, progress=watched)
            removed[first:last] = cut.removed
    return removed


def table(data: dict, written: Written | None) -> list[tuple[str, str]]:
    rows = [
        ("rays", f"{number(data['rays'])} ({data['directions']}, pitch {data['pitch']:g} mm)"),
        ("moves", number(data["moves"])),
        ("tools", ", ".join(f"T{n} {tool['name']}" for n, tool in data["tools"].items())),
        ("removed", number(data["removed"], "mm³")),
        ("left", number(data["volume"], "mm³")),
    ]
    if data["removed_by_rapids"] > 0:
        rows.insert(4, ("by rapids", number(data["removed_by_rapids"], "mm³") + "  (rapid moves in material!)"))
    if data["moves_without_tool"] > 0:
        rows.insert(
            2, ("", f"{number(data['moves_without_tool'])} of them before the first tool is called: not carved")
        )
    if written is not None:
        rows.append(("triangles", str(written)))
    return [*rows, ("file", number(data["bytes"], "bytes")), ("times", times(data["seconds"]))]
