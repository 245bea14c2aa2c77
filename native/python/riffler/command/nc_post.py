"""Write a plan, a recording or a program as NC code for a machine.

riffler nc post pencil.json --feed 800 --post linuxcnc-xyzac --post-option rot_point=0,0,-40 --out p.ngc
riffler nc post p.ngc --machine tcp --post linuxcnc-xyzac --post-option rot_point=0,0,-40 --out q.ngc
riffler nc post session.rjournal --out session.rprog

files:
  .json      a plan, as riffler plan writes it: its cutter locations, or else its paths with the ball's tip on them
  .rjournal  a recording; without --feed at the speed of the hand
  .rprog     a program, exact to the bit; --out may be one, too
  others     NC code, written for --machine
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Collection
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from .. import Collider, Journal, Program, Tool, _core, machines, plan
from ..formats import PARTS
from ..program_results import WriteReport
from . import tools
from .arguments import CODE, JOURNALS, PLANS, PROGRAMS, finite, input_file, length, machine_options, output_file
from .console import Console, number, times
from .parser import Parser
from .programs import add_machine, machine_name, read_program
from .shapes import read_part
from .surroundings import add_fixtures, add_rods, fixture, fixtures_alone, rods, with_rods

HELP = "write NC code for a machine"
AXIS_TOLERANCE = 0.00175  # rad
LIFTED = 0.01  # mm that the tool may enter the part of a plan
TOUCHED = 0.02  # mm, the same on approaches and retracts
WRITTEN = 0.05  # mm, the same between the blocks of the NC code
OF_A_PART = ("fixture", "shank", "holder", "clearance", "skip_blocked")  # options that need --part
FEED = 500.0  # mm/min, the slow default for plans


def add_arguments(parser: Parser) -> None:
    parser.add_input("program", "a plan, a recording or a program, see above", PLANS + JOURNALS + PROGRAMS + CODE,
        flags=("--plan", "--journal"))  # fmt: skip
    parser.add_argument("--post", metavar="NAME", help="the machine; riffler nc machines lists them")
    parser.offer("post", machines())
    about = "option of the post; may be repeated"
    option = parser.add_argument("--post-option", action="append", default=[], metavar="KEY=VALUE", help=about)
    parser.add_old_name("--option", option)
    parser.add_argument(
        "--tolerance", metavar="MM", default="0.01", help="largest error of the tip between blocks (default 0.01)"
    )
    parser.add_argument(
        "--axis-tolerance", metavar="DEG", help="largest error of the tool's axis between blocks (default 0.1)"
    )
    parser.add_argument("--feed", metavar="F", help="mm/min at the tip (default for plans: 500)")
    parser.add_argument("--spindle", metavar="S", help="rev/min, negative counter-clockwise")
    tools.add_tools(parser, required=False)
    parser.add_argument("--safe-height", metavar="MM", help="z between cuts of a plan or a recording")
    parser.add_argument("--axis", metavar="X,Y,Z", help="tool axis on a plan's paths without axes (default 0,0,1)")
    parser.add_file("--part", "part of a plan: lift the tool along its axis where it would gouge the part", PARTS)
    add_fixtures(parser)
    add_rods(parser)
    parser.add_argument(
        "--clearance", metavar="MM", help="least distance of shank and holder from part and fixtures (default 0)"
    )
    parser.add_argument("--skip-blocked", action="store_true", help="with --part, leave out paths that no lift frees")
    add_machine(parser, "machine that NC code was written for")
    parser.add_file("--out", "NC code (.ngc, .nc, …), or .rprog", CODE + PROGRAMS, required=True)


def run(arguments: argparse.Namespace, console: Console) -> int:
    out = output_file(arguments.out, CODE + PROGRAMS)
    saved = out.suffix.lower() in PROGRAMS
    post = None if arguments.post is None else machine_name(arguments.post, "--post")
    if not saved and post is None:
        raise ValueError("--post: a machine's name expected; riffler nc machines lists them")
    if saved and (arguments.post is not None or arguments.post_option):
        raise ValueError(f"--out {out.name}: a .rprog file is for no machine; leave out --post and --post-option")
    how = {
        "tolerance": length(arguments.tolerance, "--tolerance"),
        "axis_tolerance": AXIS_TOLERANCE
        if arguments.axis_tolerance is None
        else math.radians(length(arguments.axis_tolerance, "--axis-tolerance")),
        "options": machine_options(arguments.post_option, "--post-option"),
    }
    program, notes, collider, depth = read(arguments, console)
    if not len(program):
        raise ValueError(f"{Path(arguments.program).name}: it has no moves")
    with console.step("write"), console.writing(out) as beside:
        how["collider"], how["contact_tolerance"] = collider, max(WRITTEN, depth)
        report = program.save(beside) if post is None else program.write(beside, post=post, **how)
    data = summary(program, report) | {"post": arguments.post, "notes": notes}
    data |= {"out": str(out), "bytes": out.stat().st_size, "seconds": console.seconds}
    console.result(data, f"{out.name} written", rows(data))
    return 0


# ---- arguments


def vector(text: str, what: str) -> np.ndarray:
    numbers = np.array([finite(part, f"{what}: an entry") for part in text.split(",")])
    if len(numbers) != 3 or not np.any(numbers):
        raise ValueError(f"{what}: x,y,z expected, not all of them 0")
    return numbers / np.linalg.norm(numbers)


# ---- the program


def read(arguments: argparse.Namespace, console: Console) -> tuple[Program, list[str], Collider | None, float]:
    """The program, notes on it, the collider that its moves are checked with, and the depth in mm to which the plan
    lets them enter the part."""
    kind = Path(arguments.program).suffix.lower()
    path = input_file(arguments.program, (kind,))
    code = kind not in PLANS + JOURNALS + PROGRAMS
    for name, kinds, instead in (
        ("safe_height", PLANS + JOURNALS, "; a program takes --post-option safe_height=…"),
        ("axis", PLANS, ""),
        *((name, PLANS, "") for name in ("part", *OF_A_PART)),
    ):
        if getattr(arguments, name) in (None, [], False):
            continue
        if kind not in kinds:
            raise ValueError(f"--{name.replace('_', '-')}: only for {' and '.join(kinds)} files{instead}")
        if name in OF_A_PART and arguments.part is None:
            raise ValueError(f"--{name.replace('_', '-')}: only with --part")
    if arguments.machine is not None:
        machine_name(arguments.machine, "--machine")
    if code and arguments.machine is None:
        raise ValueError(f"--machine: name the machine that {path.name} was written for")
    if not code and (arguments.machine is not None or arguments.machine_option):
        raise ValueError("--machine: only for NC code")
    notes: list[str] = []
    if kind in PLANS:
        with console.step("read"):
            planned = plan.load(path)
        return from_plan(planned, path.name, arguments, console)
    with console.step("read"):
        if kind in JOURNALS:
            program, notes = recorded(path, arguments)
        else:
            how = machine_options(arguments.machine_option, "--machine-option")
            program = read_program(path, arguments.machine or "tcp", how, console)
    return changed(program, arguments), notes, None, 0.0


def recorded(path: Path, arguments: argparse.Namespace) -> tuple[Program, list[str]]:
    feed = None if arguments.feed is None else length(arguments.feed, "--feed")
    spindle = 0.0 if arguments.spindle is None else finite(arguments.spindle, "--spindle")
    journal = Journal.load(path)
    notes = [] if journal.cut_at is None else [f"the recording is cut off at byte {journal.cut_at}: all whole strokes"]
    return journal.program(feed=feed, spindle=spindle, safe_height=height(arguments)), notes


def height(arguments: argparse.Namespace) -> float | None:
    return None if arguments.safe_height is None else finite(arguments.safe_height, "--safe-height")


def changed(program: Program, arguments: argparse.Namespace) -> Program:
    """The program with the feed, spindle and tools of the command line."""
    if arguments.feed is None and arguments.spindle is None and not arguments.tool:
        return program
    rapid = np.asarray(program.rapid)
    feed, spindle, known = program.feed, program.spindle, program.tools
    if arguments.feed is not None:
        feed = np.where(rapid, 0.0, length(arguments.feed, "--feed"))
    if arguments.spindle is not None:
        spindle = finite(arguments.spindle, "--spindle")
    if arguments.tool:
        given = tools.assign(map(tools.parse, arguments.tool), np.asarray(program.tool)[1:], 0.0)
        known |= {n: tool for n, tool in given.items() if n > 0}
    return Program(
        program.poses, feed, rapid=rapid, tool=program.tool, line=program.line, spindle=spindle,
        tools=known, provenance=program.provenance, notes=program.notes,
        at_machine=program.at_machine, via=program.via,
    )  # fmt: skip


def from_plan(
    planned: plan.Plan, name: str, arguments: argparse.Namespace, console: Console
) -> tuple[Program, list[str], Collider | None, float]:
    feed = FEED if arguments.feed is None else length(arguments.feed, "--feed")
    spindle = 0.0 if arguments.spindle is None else finite(arguments.spindle, "--spindle")
    axis = vector(arguments.axis or "0,0,1", f"--axis {arguments.axis}")
    called, tool = tool_of(planned, arguments)
    tool = with_rods({called: tool}, rods(arguments))[called]
    notes = [f"feed {FEED:g} mm/min: plans have no feed, --feed sets another"] if arguments.feed is None else []
    paths = [path if len(path.axes) else upright(path, axis) for path in planned.paths]
    turned = sum(len(path.axes) == 0 for k, path in enumerate(planned.paths) if k not in planned.off)
    if turned:
        notes.append(f"{turned} paths without axes: the tool stands along {', '.join(f'{x:g}' for x in axis)}")
    collider = None
    if planned.off:
        notes.append(f"{listed(sorted(planned.off), len(paths))}: switched off in the plan, left out")
    if arguments.part is not None:
        cl, collider = lifted(planned, paths, tool, arguments, console, notes)
    else:
        known = {k: rows for k, rows in enumerate(located(planned)) if k not in planned.off}
        cl = [start(planned, k, paths[k], tool) if rows is None else rows for k, rows in known.items()]
        if any(rows is None for rows in known.values()):
            notes.append("not checked for gouges: --part does that")
    depth = planned.deepest + 3 * chords(planned) if planned.depths else 0.0
    program = Program.from_cl(
        [rows for rows in cl if len(rows)], tools=[tool], feed=feed, spindle=spindle, safe_height=height(arguments),
        collider=collider, contact_tolerance=max(TOUCHED, depth),
        provenance={"plan": name, "part": planned.part.get("name", ""), **planned.provenance},
    )  # fmt: skip
    return (program.renumber_tools({1: called}) if called != 1 else program), notes, collider, depth


def chords(planned: plan.Plan) -> float:
    """Largest distance in mm between the surface and a path whose poses are kept, between the path's points."""
    return max(LIFTED, planned.tolerance or 0.0)


def located(planned: plan.Plan) -> list:
    return list(planned.cl) or [None] * len(planned.paths)


def tool_of(planned: plan.Plan, arguments: argparse.Namespace) -> tuple[int, Tool]:
    """The number by which the program calls the plan's tool, and the tool: the plan's, or one with the same tip."""
    if not arguments.tool:
        return 1, planned.tool
    if len(arguments.tool) > 1:
        raise ValueError("--tool: a plan has one tool")
    given = tools.parse(arguments.tool[0])
    tool = given.make(planned.tool.length)
    if tip_radius(tool) != tip_radius(planned.tool) or tool.diameter != planned.tool.diameter:
        raise ValueError(f"--tool {given.text}: the plan is for {planned.tool.name}")
    return given.number or 1, tool


def tip_radius(tool: Tool) -> float | None:
    """Radius of the ball at the tip, mm, or None if the tip is not a ball."""
    try:
        return _core.tip_ball_radius(tool, "tool")
    except ValueError:
        return None


def upright(path, axis: np.ndarray):
    return path.with_axes(np.tile(axis, (len(path), 1)))


def start(planned: plan.Plan, number: int, path, tool: Tool) -> np.ndarray:
    """(n, 6): poses of the tool along a path, before any check."""
    return plan.poses_of(path) if number in planned.depths else tips(path, tool)


def tips(path, tool: Tool) -> np.ndarray:
    """(n, 6): poses that put the ball's centre on the path; a loop ends by repeating its first row."""
    radius = tip_radius(tool)
    if radius is None or abs(radius - path.radius) > 1e-9:
        raise ValueError(
            f"{tool.name} has no ball of radius {path.radius:g} mm at its tip: --part finds where it touches"
        )
    out = np.hstack([path.centres - radius * path.axes, path.axes])
    return np.vstack([out, out[:1]]) if path.closed else out


def lifted(
    planned: plan.Plan, paths: list, tool: Tool, arguments: argparse.Namespace, console: Console, notes: list[str]
) -> tuple[list[np.ndarray], Collider]:
    """The rows of every path, lifted where necessary, and the collider that they were checked with."""
    part = input_file(arguments.part, PARTS)
    fixtures = [fixture(name, console) for name in arguments.fixture]
    guarded = with_room(tool, arguments)
    with console.step("locate") as progress:
        mesh = read_part(part, console, hollow=True)
        wanted = planned.part.get("sha256")
        if wanted and plan.part_of(mesh, part.name)["sha256"] != wanted:
            raise ValueError(f"{part.name}: the plan is for another part, {planned.part.get('name', 'without a name')}")
        collider, found, raised, blocked = Collider(mesh, fixtures=fixtures), [], {}, {}
        alone = fixtures_alone(fixtures) if planned.deepest else None
        for k in sorted({*range(len(paths))} - planned.off):
            path = paths[k]
            if k in planned.depths:
                depth = planned.depths[k]
                rows, report = plan.kept_locations(path, guarded, collider, depth=depth, tolerance=chords(planned))
            else:
                rows, report = plan.cutter_locations(path, guarded, collider, tolerance=LIFTED)
            if not report.ok:
                blocked[k] = first_blocked(path, rows, report)
            elif k in planned.depths and (entering := first_within(alone, guarded, rows)) is not None:
                blocked[k] = placed(entering)
            else:
                found.append(rows)
                if len(high := report.lift[report.lift > LIFTED]):
                    raised[k] = high
            if progress:
                progress((k + 1) / len(paths))
    if blocked:
        said = f"{listed(blocked, len(paths))}: places that no lift frees, the first at {next(iter(blocked.values()))}"
        if not arguments.skip_blocked:
            move = ", move the fixtures" if fixtures else ""
            turn = "give it another depth or tilt" if planned.depths else "turn the tool with --axis"
            raise ValueError(f"{said}; {turn}{move}, or leave such paths out with --skip-blocked")
        notes.append(f"{said}: left out")
    if raised:
        lifts = np.concatenate(list(raised.values()))
        notes.append(
            f"{len(lifts)} of {sum(map(len, found))} rows are lifted, by up to {lifts.max():.3g} mm "
            f"({listed(raised, len(paths))}): the tool cannot reach the path there; other axes may allow it"
        )
    names = ", ".join([part.name, *(Path(name).name for name in arguments.fixture)])
    notes.append(f"all rows, approaches and retracts are free of {names} within {LIFTED:g} mm")
    if planned.deepest:
        notes.append(f"the cutter enters {part.name} by up to {planned.deepest:g} mm, as planned")
    if not (tool.shank or tool.holder):
        notes.append("shank and holder were not checked: --shank and --holder describe them")
    if not fixtures:
        notes.append("no fixtures were checked: --fixture names them")
    return found, collider


def first_blocked(path, rows: np.ndarray, report: plan.LocationReport) -> str:
    """The first blocked place of a path: the ball's centre at a point without a row, or the tip between two rows."""
    return placed(path.centres[report.blocked[0][0]] if report.blocked else rows[report.unsafe[0][0], :3])


def first_within(fixtures: Collider | None, tool: Tool, rows: np.ndarray) -> np.ndarray | None:
    """The tip of the first row at which the tool enters a fixture."""
    return next((row[:3] for row in rows if fixtures and fixtures.nearest(tool, row).distance < -LIFTED), None)


def placed(point: np.ndarray) -> str:
    return ", ".join(f"{x:.3f}" for x in point)


def listed(numbers: Collection[int], of: int) -> str:
    """Paths by number, or only their count if there are more than five."""
    if len(numbers) > 5:
        return f"{len(numbers)} of {of} paths"
    return f"path{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))}"


def with_room(tool: Tool, arguments: argparse.Namespace) -> Tool:
    """The tool with shank and holder larger by the clearance; the cutter touches what it cuts and is unchanged."""
    if arguments.clearance is None:
        return tool
    room = finite(arguments.clearance, "--clearance")
    if room < 0:
        raise ValueError(f"--clearance {arguments.clearance}: must not be negative")
    if not (tool.shank or tool.holder):
        raise ValueError("--clearance needs a shank or a holder, which --shank and --holder describe")
    return plan.with_room(tool, room)


# ---- the report


def summary(program: Program, report: WriteReport | None) -> dict[str, Any]:
    """Figures of the program, and of its NC code if ``report`` is given."""
    way = np.linalg.norm(np.diff(program.poses[:, :3], axis=0), axis=1)
    rapid, feed = np.asarray(program.rapid)[1:], np.asarray(program.feed)[1:]
    cutting = ~rapid & (feed > 0)
    data = {
        "rows": len(program),
        "length": float(way[~rapid].sum()),
        "rapid_length": float(way[rapid].sum()),
        "minutes": float((way[cutting] / feed[cutting]).sum()),
        "tools": sorted({int(n) for n in program.tool}),
    }
    return data | ({} if report is None else asdict(report) | {"subdivisions": report.blocks - len(program)})


def rows(data: dict[str, Any]) -> list[tuple[str, str]]:
    shown = [("rows", number(data["rows"]))]
    if "blocks" in data:
        shown.append(("blocks", f"{number(data['blocks'])}, {number(data['subdivisions'])} more than rows"))
        if data["slowed_blocks"]:
            shown.append(("slowed", f"{number(data['slowed_blocks'])} blocks, to the largest speed of an axis"))
        if data["rewinds"]:
            shown.append(("rewinds", f"{number(len(data['rewinds']))}: the tool leaves the part and turns axes back"))
        if data["pole_passages"]:
            shown.append(("passages", f"{number(len(data['pole_passages']))} near the singular direction"))
    return [
        *shown,
        ("length", f"{number(data['length'], 'mm')}, and {number(data['rapid_length'], 'mm')} in rapid"),
        ("time", f"{number(data['minutes'], 'min')} at the feed, without rapids"),
        ("tools", ", ".join(f"T{n}" for n in data["tools"])),
        *(("note", note) for note in data["notes"]),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(data["seconds"])),
    ]
