"""Carve stock with an NC program and write what is left.

riffler carve --stock 100x60x30 --pitch 0.25 --tool ball:6 --program part.ngc --out part.stl
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from .. import Program, Tool, Volume
from . import tools
from .arguments import (
    MESHES,
    ORIGINS,
    VOLUMES,
    add_directions,
    add_machine_option,
    add_pitch,
    input_file,
    is_solid,
    length,
    machine_options,
    output_file,
    solid,
)
from .console import Console, number, times
from .shapes import from_mesh, rays, write_left

HELP = "carve stock with an NC program"
AWAY = -1  # the number of no tool: of a move that begins or ends at a position of the machine
__doc__ = f"{__doc__}\n{tools.FORMS}"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_stock(parser)
    parser.add_argument("--tool", required=True, action="append", metavar="TOOL", help="see above; may be repeated")
    parser.add_argument("--program", required=True, metavar="FILE", help="NC program, RS-274, or .rprog")
    parser.add_argument("--machine", default="tcp", help='what the program\'s axes mean (default "tcp": tip and axis)')
    add_machine_option(parser)
    parser.add_argument("--tolerance", default="0.01", metavar="MM", help="of moves that turn the tool (default 0.01)")
    parser.add_argument("--out", required=True, metavar="FILE", help=".stl, .obj, .ply, .3mf or .rvol")


def run(arguments: argparse.Namespace, console: Console) -> int:
    tolerance = length(arguments.tolerance, "--tolerance")
    out = output_file(arguments.out, MESHES + VOLUMES)
    wanted = [tools.parse(text) for text in arguments.tool]
    with console.step("program"):
        how = machine_options(arguments.machine_option, "--machine-option")
        program = read_program(Path(arguments.program), arguments.machine, how, console).followed()
        poses = np.asarray(program.poses)
        called = called_in_part(program)
        rapid = np.asarray(program.rapid)[1:]
    if len(poses) < 2:
        raise ValueError(f"{Path(arguments.program).name}: no moves to carve")
    # A cutter whose length is not named is long enough to reach out of the stock wherever it is.
    volume = stock(arguments, console)
    reach = float(np.linalg.norm(volume.upper - volume.lower))
    by_number = tools.assign(wanted, called[1:][called[1:] != AWAY], reach)
    before = volume.volume
    removed = carve(volume, poses, called, by_number, tolerance, console)
    after = volume.volume

    triangles = write_left(volume, out, console)

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
        "triangles": triangles,
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    console.result(data, f"{out.name} written", table(data))
    return 0


def called_in_part(program: Program) -> np.ndarray:
    """(n,) the rows' tool numbers; AWAY where the motion there begins or ends at a position of the machine."""
    away = np.asarray(program.at_machine)
    return np.where(np.append(False, away[1:] | away[:-1]), AWAY, program.tool)


def is_saved(path: Path) -> bool:
    return path.suffix.lower() == ".rprog"


def read_program(path: Path, machine: str, options: dict[str, Any] | None, console: Console) -> Program:
    """Loads a saved program or reads NC code for the machine; prints the notes of its reader on stderr."""
    program = Program.load(path) if is_saved(path) else Program.read(path, machine=machine, options=options)
    for note in program.notes:
        console.warning(f"{path.name}, line {note.line}: {note.message}")
    return program


def add_stock(parser: argparse.ArgumentParser) -> None:
    """What `stock` reads."""
    parser.add_argument(
        "--stock",
        required=True,
        metavar="WxDxH|sphere:D|cylinder:D:H|FILE",
        help="a block's sizes, a sphere's diameter, a cylinder's diameter and height along z, or a .stl, .obj, .ply, "
        ".3mf or .rvol file",
    )
    add_pitch(parser, required=False, more=" (a .rvol file brings its own)")
    add_directions(parser)
    parser.add_argument(
        "--origin",
        metavar="X,Y,Z",
        help=f"lower corner of the box of what has sizes (default 0,0,0), or one of {', '.join(ORIGINS)}",
    )


def stock(arguments: argparse.Namespace, console: Console) -> Volume:
    """The volume to carve: a block, sphere or cylinder, a mesh or a .rvol file."""
    pitch = None if arguments.pitch is None else length(arguments.pitch, "--pitch")
    if is_solid(arguments.stock):
        kind, lower, upper = solid(arguments.stock, arguments.origin or "corner")
        if pitch is None:
            raise ValueError(f"--pitch is needed for a {kind}")
        with console.step("stock"):
            return _solid(kind, np.array(lower), np.array(upper), pitch, arguments.directions or "xyz")
    path = input_file(arguments.stock, MESHES + VOLUMES)
    if arguments.origin is not None:
        raise ValueError(f"--origin is for stock of given sizes; {path.name} has its own place")
    if path.suffix.lower() in VOLUMES:
        with console.step("stock") as progress:
            volume = Volume.load(path, progress=progress)
        if pitch is not None and pitch != volume.pitch:
            raise ValueError(f"{path.name} has pitch {volume.pitch} mm, not the {pitch} of --pitch")
        if arguments.directions not in (None, volume.directions):
            raise ValueError(f"{path.name} has directions {volume.directions}, not {arguments.directions}")
        return volume
    if pitch is None:
        raise ValueError(f"--pitch is needed for {path.name}")
    return from_mesh(path, pitch, arguments.directions or "xyz", console, "stock")[0]


def _solid(kind: str, lower: np.ndarray, upper: np.ndarray, pitch: float, directions: str) -> Volume:
    """What fills the box, and has its corners as they are."""
    if kind == "block":
        return Volume.block(lower, upper, pitch, directions)
    centre, (w, _, h) = 0.5 * (lower + upper), upper - lower
    if kind == "sphere":
        return Volume.sphere(centre, 0.5 * w, pitch, directions, lower=lower, upper=upper)
    return Volume.cylinder(centre, 0.5 * w, h, pitch, directions, lower=lower, upper=upper)


def carve(
    volume: Volume,
    poses: np.ndarray,
    called: np.ndarray,
    by_number: dict[int, Tool],
    tolerance: float,
    console: Console,
) -> np.ndarray:
    """What each move took away, mm³. Every run of moves of one tool is one call.

    The first move after a tool change starts where the last one ended, as on a machine that changes tools in place.
    """
    removed = np.zeros(len(poses) - 1)
    with console.step("carve") as progress:
        for first, last, tool in tools.runs(called):
            if tool not in by_number:
                continue  # nothing is in the spindle yet

            def share(done: float, first: int = first, last: int = last) -> None:
                if progress:
                    progress((first + done * (last - first)) / len(removed))

            cut = volume.carve(
                by_number[tool], poses[first : last + 1], tolerance=tolerance, progress=share if progress else None
            )
            removed[first:last] = cut.removed
    return removed


def table(data: dict) -> list[tuple[str, str]]:
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
    if data["triangles"] is not None:
        rows.append(("triangles", number(data["triangles"])))
    return [*rows, ("file", number(data["bytes"], "bytes")), ("times", times(data["seconds"]))]
