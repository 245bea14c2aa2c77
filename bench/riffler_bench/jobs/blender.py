"""The add-on in Blender: how long a stroke takes from the event to the picture, stage by stage, compared with Blender's
own sculpt mode and its boolean modifier; a large surface to an STL; a part to NC code."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Collider, Mesh, Program, Tool, plan

from .. import report
from ..blenders import Blender
from ..measure import Progress, Settings, cores
from ..report import Column, Report, Section
from ..rivals import LeftOutError
from .gouge import LEAST, scaled

SIDES = {"250 k": 55.0, "1 M": 115.0}  # mm, of a block 10 mm high at 0.25 mm
EXPORTED = 79.0  # mm: half a million triangles
KINDS = {"mesh": "draw brush", "dyntopo": "draw brush, dyntopo"}
MODEL = "ktoolcav"
TOOL = Tool.ball(6, 110)  # reaches into any valley of a part of 100 mm
UP = (0.0, 0.0, 1.0)
POST = "linuxcnc-xyzac"
ERROR = 0.02  # of a stroke's volume, for the check; a pixel in a window is 0.1 mm
Row = dict[str, Any]


def run(settings: Settings, progress: Progress = None) -> Report:
    load = os.getloadavg()[0]
    out = Report("blender", {"load": load, "cores_free": cores(), "sides_mm": SIDES})
    makers = stroke_table, undo_table, sculpt_table, boolean_table, export_table, plan_table
    tables = tuple(make(out) for make in makers)
    stroke, undo, sculpt, boolean, export, planned = tables
    given = list(answering(settings, stroke))
    for k, blender in enumerate(given):
        tell = (lambda share, k=k: progress((k + share) / len(given))) if progress else (lambda share: None)
        sizes = {"quick": 30.0} if settings.quick else SIDES
        for n, (size, side) in enumerate(sizes.items()):
            strokes(out, (stroke, undo, sculpt), blender, size, side, settings.quick)
            tell(0.7 * (n + 1) / len(sizes))
        if k == 0:
            for size, side in sizes.items():
                booleans(out, boolean, blender, size, side, settings.quick)
        exported(out, export, blender, settings.quick)
        planning(planned, blender, settings)
    natively(planned, settings)
    notes(out, tables, load)
    return out


def answering(settings: Settings, table: Section):
    """The Blenders; those that are not there are named in a row."""
    if not settings.blenders:
        table.row(where="Blender: left out, none was named (--blender)")
    for path in settings.blenders:
        try:
            yield Blender.of(path)
        except LeftOutError as why:
            table.row(where=f"Blender: left out, {why}")


# ---- tables


def milliseconds(value: float) -> str:
    return report.three(1e3 * value)


def stroke_table(out: Report) -> Section:
    stages = ("cut", "follow", "mesh", "transfer", "depsgraph", "draw", "event", "other")
    return out.section(
        "stroke",
        "An event of a stroke, by stage, ms; medians",
        Column("Blender", "where"),
        Column("triangles", "triangles", report.grouped),
        Column("shown", "shown", report.grouped),
        *(Column(name, f"{name}_s", milliseconds) for name in stages),
        Column("event to end, median", "p50_s", milliseconds),
        Column("95 %", "p95_s", milliseconds),
        Column("processor time", "cpu_s", milliseconds),
        Column("pictures", "pictures", report.three),
        Column("tiles", "bricks", report.three),
        Column("chunks", "chunks", report.three),
        Column("triangles moved", "moved", report.grouped),
        Column("kB", "kilobytes", report.three),
        Column("end of stroke", "end_s", milliseconds),
        Column("removed more than exact", "removed_over", report.percent),
    )


def undo_table(out: Report) -> Section:
    of = {"": "", "_second": " of the second", "_first": " of the first"}
    return out.section(
        "undo",
        "Undo and redo of a stroke, ms; medians",
        Column("Blender", "where"),
        Column("triangles", "triangles", report.grouped),
        *(Column(f"{k}{said}", f"{k}{kind}_s", milliseconds) for kind, said in of.items() for k in ("undo", "redo")),
        Column("undo, processor time", "undo_cpu_s", milliseconds),
        Column("undo of an empty's move", "undo_other_s", milliseconds),
    )


def sculpt_table(out: Report) -> Section:
    return out.section(
        "sculpt",
        "An event of Blender's sculpt mode, ms; medians",
        Column("Blender", "where"),
        Column("brush", "brush"),
        Column("triangles", "triangles", report.grouped),
        Column("depsgraph", "depsgraph_s", milliseconds),
        Column("draw", "draw_s", milliseconds),
        Column("event to end, median", "p50_s", milliseconds),
        Column("95 %", "p95_s", milliseconds),
        Column("processor time", "cpu_s", milliseconds),
        Column("÷ Riffler, wall time", "ratio", report.ratio),
        Column("÷ Riffler, processor time", "cpu_ratio", report.ratio),
        Column("undo", "undo_s", milliseconds),
        Column("", "note"),
    )


def boolean_table(out: Report) -> Section:
    return out.section(
        "boolean",
        "One swept ball, Ø6 over 20 mm, taken from a block",
        Column("Blender", "where"),
        Column("by", "engine"),
        Column("triangles", "triangles", report.grouped),
        Column("time", "wall_s", report.micro),
        Column("processor time", "cpu_s", report.micro),
        Column("÷ Riffler, processor time", "ratio", report.ratio),
        Column("removed more than exact", "removed_over", report.percent),
        Column("", "note"),
    )


def export_table(out: Report) -> Section:
    return out.section(
        "export",
        "A sculpt to a binary STL",
        Column("Blender", "where"),
        Column("operator", "operator"),
        Column("triangles", "triangles", report.grouped),
        Column("bytes", "bytes", report.grouped),
        Column("time", "wall_s", report.micro),
        Column("processor time", "cpu_s", report.micro),
        Column("÷ Riffler, wall time", "ratio", report.ratio),
        Column("", "note"),
    )


def plan_table(out: Report) -> Section:
    return out.section(
        "plan",
        f"{MODEL} from the part to NC code",
        Column("where", "where"),
        Column("paths", "paths"),
        Column("points", "points", report.grouped),
        Column("find", "find_s", report.micro),
        Column("keys", "keys_s", report.micro),
        Column("locations", "locations_s", report.micro),
        Column("write", "nc_s", report.micro),
        Column("all", "wall_s", report.micro),
        Column("processor time", "cpu_s", report.micro),
        Column("blocks", "blocks", report.grouped),
        Column("", "note"),
    )


# ---- what is measured


def asked(section: Section, blender: Blender, row: Row, work: Callable[[], Row]) -> Row | None:
    """The row with what `work` gives; where it cannot be measured, with why, and None."""
    try:
        found = work()
    except LeftOutError as why:
        section.row(**row | {"where": f"{blender.name}{row['where']}: left out, {why}"})
        return None
    return section.row(**row | {"where": f"Blender {found.pop('version')}{row['where']}"} | found)


def ways(blender: Blender, quick: bool) -> list[tuple[str, bool]]:
    """Named as tables have it, and whether it is in a window."""
    return [("", False), *([(", window", True)] if blender.application and not quick else [])]


def strokes(out: Report, tables: tuple[Section, ...], blender: Blender, size: str, side: float, quick: bool) -> None:
    stroke, undo, sculpt = tables
    for where, window in ways(blender, quick):
        how = {"strokes": 3 if quick else 4 if window else 5, "events": 10 if quick else 16 if window else 30}
        function = "windowed" if window else "headless"

        def own(detail, function=function, how=how, window=window) -> Row:
            row = blender.run(f"stroke.{function}", window=window, side=side, detail=detail, **how)
            return row | {"kilobytes": row["bytes"] / 1e3}

        begun = {"size": size, "window": window}
        mine = asked(stroke, blender, {"where": where, **begun}, partial(own, "NEEDED"))
        asked(stroke, blender, {"where": f"{where}, all triangles", **begun}, partial(own, "ALL"))
        if mine is not None:
            undo.row(**mine)
            error = mine["removed_over"]
            out.check(abs(error) <= ERROR, f"{mine['where']}, {size}: a stroke's volume is off by {error:.3%}")
        for kind, brush in KINDS.items():
            if blender.application and not window:
                continue  # its window says more
            before = {"where": where, "brush": brush, "size": size, "window": window}
            ask = lambda kind=kind, how=how, f=function, w=window: blender.run(  # noqa: E731
                f"sculpt_mode.{f}", window=w, kind=kind, side=side, **how
            )
            row = asked(sculpt, blender, before, ask)
            if row is not None and mine is not None:
                row["ratio"], row["cpu_ratio"] = row["p50_s"] / mine["p50_s"], row["cpu_s"] / mine["cpu_s"]


def booleans(out: Report, table: Section, blender: Blender, size: str, side: float, quick: bool) -> None:
    repeats = 2 if quick else 5

    def judged(row: Row | None) -> None:
        if row is not None:
            where = f"{row['where']}, {size}, {row['engine']}"
            if row["engine"] == "Riffler":
                out.check(abs(row["removed_over"]) < ERROR, f"{where}: the volume is off by {row['removed_over']:.3%}")
            elif abs(row["removed_over"]) > ERROR:
                row["note"] = "a wrong volume"

    row = {"where": "", "engine": "Riffler", "size": size}
    mine = asked(table, blender, row, lambda: blender.run("booleans.live", side=side, repeats=repeats))
    judged(mine)
    try:
        solvers = blender.run("booleans.solvers")["solvers"]
    except LeftOutError:
        return
    for solver in solvers:
        row = {"where": "", "engine": f"boolean modifier, {solver}", "size": size}
        theirs = asked(
            table, blender, row, lambda s=solver: blender.run("booleans.modifier", solver=s, side=side, repeats=repeats)
        )
        judged(theirs)
        if mine is not None and theirs is not None:
            theirs["ratio"] = theirs["cpu_s"] / mine["cpu_s"]


def exported(out: Report, table: Section, blender: Blender, quick: bool) -> None:
    side, repeats = (30.0, 2) if quick else (EXPORTED, 7)
    with tempfile.TemporaryDirectory() as own:
        try:
            found = blender.run("export.export", side=side, folder=own, repeats=repeats)
        except LeftOutError as why:
            table.row(where=f"{blender.name}: left out, {why}")
            return
    first = found["rows"][0]
    for row in found["rows"]:
        table.row(where=f"Blender {found['version']}", ratio=row["wall_s"] / first["wall_s"], **row)
    same = found["same"] and found["facets"] == [found["mesh"]] * 2
    out.check(same, f"Blender {found['version']}: the facets of the STL files differ")


def part_of(settings: Settings) -> Mesh:
    """Scaled to 100 mm, as the job gouge has it."""
    path = settings.models / f"{MODEL}.stl" if settings.models else None
    if settings.quick or path is None or not path.exists():
        why = "--quick" if settings.quick else "no such file" if path else "no folder named (--models)"
        raise LeftOutError(why)
    return scaled(Mesh.read(path))


def planning(table: Section, blender: Blender, settings: Settings) -> None:
    with tempfile.TemporaryDirectory() as own:
        try:
            file = Path(own) / "part.stl"
            part_of(settings).write(file)
            given = {"part": str(file), "tool": TOOL.to_dict(), "axis": UP, "minimum": LEAST}
            row = blender.run("planning.plan", folder=own, post=POST, **given)
        except LeftOutError as why:
            table.row(where=f"{blender.name}: {MODEL} left out, {why}")
            return
    table.row(where=f"Blender {row.pop('version')}, operators", **row)


def natively(table: Section, settings: Settings) -> None:
    """The same without Blender, all threads."""
    try:
        part = part_of(settings)
    except LeftOutError as why:
        table.row(where=f"Python: {MODEL} left out, {why}")
        return
    seconds: dict[str, float] = {}

    def timed(name: str, work: Callable[[], Any]) -> Any:
        begin = time.perf_counter()
        result = work()
        seconds[f"{name}_s"] = time.perf_counter() - begin
        return result

    cpu = time.process_time()
    found = timed("find", lambda: plan.pencil(part, TOOL, tolerance=0.01, minimum_length=LEAST))
    paths = timed("keys", lambda: [path.orient({0: UP}, interpolation="smooth") for path in found])
    with tempfile.TemporaryDirectory() as own:
        file = Path(own) / "native.ngc"

        def locations() -> list[np.ndarray]:
            around = Collider(part)
            both = [plan.cutter_locations(p, TOOL, around, tolerance=0.01, max_lift=1000.0) for p in paths]
            return [rows for rows, said in both if said.ok]

        rows = timed("locations", locations)

        def write() -> dict[str, Any]:
            program = Program.from_cl(rows, tools=[TOOL], feed=800, spindle=12000, occupied=part.bounds)
            return program.write(file, post=POST, tolerance=0.01, options={"rot_point": [0, 0, -40]})

        blocks = timed("nc", write).blocks
        size = file.stat().st_size
    table.row(
        where="Python", paths=len(found), points=sum(map(len, paths)), blocks=blocks, bytes=size, **seconds,
        wall_s=sum(seconds.values()), cpu_s=time.process_time() - cpu,
        note="" if len(rows) == len(paths) else f"{len(paths) - len(rows)} paths still collide",
    )  # fmt: skip


def notes(out: Report, tables: tuple[Section, ...], load: float) -> None:
    stroke, undo, sculpt, boolean, export, planned = tables
    renderers = {row["renderer"] for row in stroke.rows if row.get("renderer")}
    out.settings["load_after"] = os.getloadavg()[0]
    stroke.notes += [
        "A 6 mm ball 0.8 mm deep at 72 mm/s, 60 events a second, on a block at 0.25 mm, tri-dexel. *event*: until the "
        "tool has it; *follow*: picking the surface and making poses; *draw*: the last picture; *other*: all else, as "
        "earlier pictures and the wait for the next look, of which 30 are made a second. Without a window an event "
        "ends when Blender's dependency graph is up to date; in a window it ends when a "
        "pixel of the new picture has been read back. Anti-aliasing is off. "
        "Blender makes a new batch for each chunk that "
        "has changed. Exact: the closed form of the groove.",
        f"Load of the machine before and after: {load:.1f} and {out.settings['load_after']:.1f}; two busy threads got "
        f"{out.settings['cores_free']:.2f} processors. "
        + (f"Drawn by {', '.join(sorted(renderers))}." if renderers else "Nothing was drawn."),
    ]
    undo.notes.append(
        "Without a window the operator, in a window from Ctrl-Z to the picture. The first stroke's brings the sculpt's "
        "own mesh back, the second's has a step before it in which all chunks were new; the others are in the first "
        "columns. *An empty's move*: a step that touches nothing of the sculpt, in the same file, what Blender takes "
        "for any."
    )
    sculpt.notes.append(
        "The brush is as wide as the ball, and goes the same way. Without a window a whole stroke is made by "
        "sculpt.brush_stroke, shared by its events, without the dependency graph. Multires is not among them: a "
        "scripted stroke, or one of simulated events, leaves such a sheet as it was."
    )
    boolean.notes.append(
        "Medians of five evaluations after a first one; the capsule has 64 segments around. Riffler: one move, carved, "
        "meshed, in Blender's chunks, and the dependency graph."
    )
    export.notes.append(
        "Medians of seven, in turn, into the same folder. Facets are read back from both files, and must be the same."
    )
    planned.notes.append(
        f"{MODEL} scaled to 100 mm, ball Ø6, valleys of {LEAST:g} mm or more, one upright key a path, {POST}. Once, "
        "wall time. In Blender paths also get a point a frame, curves and a timeline."
    )
