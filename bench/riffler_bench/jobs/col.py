"""COL: a tool with its holder against a part with sharp valleys: depth, force and signed distance, against FCL and
Coal; budgets and what they miss; depths compared with the independent reference; the force over an edge."""

from __future__ import annotations

import json
import statistics
from pathlib import Path
from typing import Any

import numpy as np

from .. import _bench as core
from .. import report
from ..measure import Progress, Settings, quantile
from ..report import Column, Report
from ..rivals import LeftOutError, program

SQUARES = {"quick": (40,), "full": (100, 316)}  # of two triangles, along each side
TOOLS = ("long", "short")
PART_BUDGETS = (20e-6, 50e-6, 100e-6, 200e-6, 500e-6, 1e-3)  # s
BUDGETS = (5e-6, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6, 500e-6, 1e-3)  # s
TARGETS = {"mean_us": 80, "p99_us": 350, "clearance_us": 100, "mean_ratio": 0.55, "p99_ratio": 0.35}
FCL, COAL = "FCL OBB, tool mesh", "Coal OBBRSS, tool mesh"
CAD_PARTS = ("fandisk", "ktoolcav", "ktoolcor", "spider")  # files that are looked for among the models
PLAIN = ("bore", "wall")  # where a shank would be as wide as the bore
ROUNDING = 1e-9  # mm
MISSED = (  # of queries that a budget ended, with their bound
    Column("missed depth, mean mm", "missed_mean_mm", report.mm),
    Column("largest mm", "missed_max_mm", report.mm),
    Column("its bound, mean mm", "bound_mean_mm", report.mm),
    Column("largest mm", "bound_max_mm", report.mm),
    Column("bound violated", "violated"),
)
CURVE = np.linspace(0, 1, 201)  # shares at which times are kept for the plot


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("col", {"targets": TARGETS})
    done = progress or (lambda share: None)
    times(out, settings, lambda share: done(0.4 * share))
    parts(out, settings, lambda share: done(0.4 + 0.1 * share))
    part_budgets(out, settings, lambda share: done(0.5 + 0.05 * share))
    budgets(out, settings)
    done(0.6)
    errors(out, settings, lambda share: done(0.6 + 0.35 * share))
    slide(out, settings)
    return out


# ---- time, against others


def times(out: Report, settings: Settings, progress: Any) -> None:
    table = out.section(
        "times",
        "Processor time of one pose, one thread",
        Column("triangles", "triangles"),
        Column("tool", "tool"),
        Column("engine", "engine"),
        Column("asked for", "what"),
        Column("poses", "poses"),
        Column("mean", "mean_s", report.micro),
        Column("median", "median_s", report.micro),
        Column("99 %", "p99_s", report.micro),
        Column("Riffler ÷ this: mean", "mean_ratio", report.ratio),
        Column("99 %", "p99_ratio", report.ratio),
        Column("other verdict", "disagree"),
        Column("prepared in", "build_s", report.micro),
    )
    sizes = SQUARES["quick" if settings.quick else "full"]
    poses, repeats = (60, 1) if settings.quick else (2000, 3)
    shares = []
    for done, (squares, tool) in enumerate((s, t) for s in sizes for t in TOOLS):
        progress(done / (len(sizes) * len(TOOLS)))
        missing: list[tuple[str, object]] = []
        try:
            figures = program(settings, "riffler_contact", squares, tool, poses, repeats)
        except LeftOutError as why:
            figures = json.loads(core.contact_times(squares, tool, poses, repeats))
            missing = [("FCL", why), ("Coal", why)]
        engines = " ".join(row["engine"] for row in figures["asked"])
        if not missing:
            missing = [(name, "it was not there when riffler_contact was built") for name in ("FCL", "Coal")
                       if name not in engines]  # fmt: skip
        add_times(out, table, figures, tool)
        for name, why in missing:
            table.row(triangles=figures["triangles"], tool=tool, engine=f"{name}: left out, {why}")
        shares.append(
            f"{figures['triangles']} triangles, {tool} tool: {100 * figures['colliding']:.0f} % of the poses collide, "
            f"{100 * figures['holder']:.0f} % with the holder deepest"
        )
    table.notes.append(
        f"{'; '.join(shares)}. The tool mesh has {figures['tool_triangles']} triangles (36 steps around); the four "
        "shapes are ball, cylinder, cone and cylinder. Others are asked for pairs of triangles that meet, or triangles "
        "that meet a shape, without depth or force. A pose's time is the median of three. *Other verdict*: poses that "
        "Riffler finds to collide and the other to be free, or the reverse. The tool mesh lies within the tool, by up "
        "to 0.011 mm at the ball and 0.076 mm at the holder; distances between meshes are 0 where they overlap."
    )


def add_times(out: Report, table: report.Section, figures: dict[str, Any], tool: str) -> None:
    """Rows of one part and tool: signed distances are compared with Riffler's, all else with its query."""
    asked = figures["asked"]
    mine = {row["what"]: row for row in asked if row["engine"] == "Riffler"}
    depth, distance = np.array(mine["depth, force and torque"]["answers"]), mine["signed distance"]["answers"]
    overlaps = np.array(distance) < 0
    out.check(np.array_equal(depth > 0, overlaps), f"{tool} tool: depth and signed distance disagree")
    for row in asked:
        us, answers = row["us"], np.array(row["answers"])
        ours = mine["signed distance" if row["what"] == "signed distance" else "depth, force and torque"]["us"]
        ours = ours[: len(us)]
        figure = {"mean_s": 1e-6 * statistics.mean(us), "p99_s": 1e-6 * quantile(us, 0.99)}
        if row["engine"] != "Riffler":
            figure["mean_ratio"] = 1e-6 * statistics.mean(ours) / figure["mean_s"]
            figure["p99_ratio"] = 1e-6 * quantile(ours, 0.99) / figure["p99_s"]
        hits = answers < 0 if row["what"] == "signed distance" else answers > 0
        table.row(
            triangles=figures["triangles"], tool=tool, engine=row["engine"], what=row["what"], poses=len(us),
            median_s=1e-6 * statistics.median(us), build_s=row["build_s"] or None, **figure,
            disagree=int(np.sum(hits != overlaps[: len(us)])), overlaps=int(overlaps[: len(us)].sum()),
            times_us=np.quantile(us, CURVE).round(3).tolist(),
        )  # fmt: skip


# ---- parts as CAD programs write them


def parts(out: Report, settings: Settings, progress: Any) -> None:
    table = out.section(
        "parts",
        "Long triangles, needles and few large ones: processor time of one pose, one thread",
        Column("part", "part"),
        Column("triangles", "triangles"),
        Column("tool", "tool"),
        Column("touching", "touching", lambda x: f"{100 * x:.0f} %"),
        Column("depth, force and torque: mean", "mean_s", report.micro),
        Column("99 %", "p99_s", report.micro),
        Column("signed distance: mean", "distance_s", report.micro),
        Column("in doubt after 200 µs", "in_doubt", lambda x: f"{100 * x:.1f} %"),
        Column("FCL, all contacts: mean", "fcl_s", report.micro),
        Column("FCL, 99 %", "fcl_p99_s", report.micro),
        Column("Riffler ÷ FCL: mean", "mean_ratio", report.ratio),
        Column("Riffler ÷ FCL: 99 %", "p99_ratio", report.ratio),
        Column("Riffler ÷ Coal: mean", "coal_mean_ratio", report.ratio),
        Column("Riffler ÷ Coal: 99 %", "coal_p99_ratio", report.ratio),
        Column("out of reach", "away_s", report.micro),
    )
    found = models(settings)
    named = parts_of(found)
    poses, repeats = (20, 1) if settings.quick else (500, 3)
    cases = [(part, tool) for part in named for tool in (("plain",) if part in PLAIN else ("plain", "long"))]
    for done, (part, tool) in enumerate(cases):
        progress(done / len(cases))
        try:
            figures = program(settings, "riffler_contact", part, tool, poses, repeats)
        except LeftOutError:
            figures = json.loads(core.contact_times(1, tool, poses, repeats, part))
        add_part(table, figures, part.rpartition("/")[2].removesuffix(".stl"), tool)
    if len(found) < len(CAD_PARTS):
        table.notes.append("Left out: " + ", ".join(sorted(set(CAD_PARTS) - {p.stem for p in found})) + " (--models).")
    table.notes.append(
        "Half of the poses on parts from files are on the pencil paths of the ball, the others anywhere on the part: "
        "from 2 mm above to 0.3 mm deep. Bore and wall are one cylinder, R20 × 60 of 360 facets, with the tool along "
        "it. In doubt: a depth that may be more than 0.05 mm larger than most of three answers. FCL: oriented boxes, "
        "Coal: oriented boxes and swept spheres, tool as a mesh. Out of reach: the tool 1 000 mm above each pose."
    )


def models(settings: Settings) -> list[Path]:
    """Parts from files that are there."""
    paths = [settings.models / f"{name}.stl" for name in CAD_PARTS] if settings.models else []
    return [path for path in paths if path.exists()]


def parts_of(found: list[Path]) -> list[str]:
    """Named parts, and those of the files."""
    return [*core.contact_part_names(), *map(str, found)]


def add_part(table: report.Section, figures: dict[str, Any], part: str, tool: str) -> None:
    asked = {(row["engine"], row["what"]): row["us"] for row in figures["asked"]}
    ours = asked["Riffler", "depth, force and torque"]
    row: dict[str, Any] = {
        "mean_s": 1e-6 * statistics.mean(ours),
        "p99_s": 1e-6 * quantile(ours, 0.99),
        "distance_s": 1e-6 * statistics.mean(asked["Riffler", "signed distance"]),
        "away_s": 1e-6 * figures["away_us"],
    }
    if theirs := asked.get((FCL, "all contacts")):
        row |= {"fcl_s": 1e-6 * statistics.mean(theirs), "fcl_p99_s": 1e-6 * quantile(theirs, 0.99)}
        row |= {"mean_ratio": row["mean_s"] / row["fcl_s"], "p99_ratio": row["p99_s"] / row["fcl_p99_s"]}
    if theirs := asked.get((COAL, "all contacts")):
        row["coal_mean_ratio"] = row["mean_s"] / (1e-6 * statistics.mean(theirs))
        row["coal_p99_ratio"] = row["p99_s"] / (1e-6 * quantile(theirs, 0.99))
    table.row(
        part=part, tool=tool, triangles=figures["triangles"], touching=figures["colliding"],
        in_doubt=figures["in_doubt"], **row,
    )  # fmt: skip


def part_budgets(out: Report, settings: Settings, progress: Any) -> None:
    """Budgets of a ball on the same parts."""
    table = out.section(
        "part-budgets",
        "Queries with a time budget on these parts",
        Column("part", "part"),
        Column("budget", "budget_s", report.micro),
        *MISSED,
    )
    poses = 20 if settings.quick else 500
    named = parts_of(models(settings))
    for done, part in enumerate(named):
        progress(done / len(named))
        name = part.rpartition("/")[2].removesuffix(".stl")
        runs = [json.loads(core.contact_budgets(1, "plain", poses, list(PART_BUDGETS), part))["budgets"]
                for _ in range(3)]  # fmt: skip
        for k, budget in enumerate(PART_BUDGETS):
            missed, bound = (np.array([run[k][key] for run in runs]) for key in ("missed_mm", "bound_mm"))
            table.row(part=name, budget_s=budget, **missing(missed, bound, out, f"{name}, {1e6 * budget:g} µs"))
    table.notes.append(
        f"{poses} poses of a ball R3 × 30 as above. The median of three queries counts, since a budget is real time; "
        "violations are counted in all three."
    )


# ---- budgets


def missing(missed: np.ndarray, bound: np.ndarray, out: Report, budget: str) -> dict[str, Any]:
    """The cells of MISSED, from (runs, poses) depths and bounds, mm: the median run of each pose; violations in all."""
    violated = int(np.sum((missed > bound + ROUNDING) | (missed < -ROUNDING)))
    out.check(violated == 0, f"{budget}: the bound was violated {violated} times")
    depth, bounds = np.median(missed, axis=0).clip(0), np.median(bound, axis=0)
    figures = (depth.mean(), depth.max(), bounds.mean(), bounds.max(), violated)
    return dict(zip((column.key for column in MISSED), figures, strict=True))


def budgets(out: Report, settings: Settings) -> None:
    table = out.section(
        "budgets",
        "Queries with a time budget, long tool",
        Column("triangles", "triangles"),
        Column("budget", "budget_s", report.micro),
        Column("mean time", "mean_s", report.micro),
        Column("99 %", "p99_s", report.micro),
        Column("candidates looked at", "checked", lambda x: f"{100 * x:.1f} %"),
        *MISSED,
    )
    poses = 60 if settings.quick else 2000
    for squares in SQUARES["quick" if settings.quick else "full"]:
        figures = json.loads(core.contact_budgets(squares, "long", poses, [*BUDGETS, 1.0]))
        for row in figures["budgets"]:
            us, missed, bound = (np.array([row[key]]) for key in ("us", "missed_mm", "bound_mm"))
            table.row(
                triangles=2 * squares**2, budget_s=1e-6 * row["budget_us"], mean_s=1e-6 * us.mean(),
                p99_s=1e-6 * quantile(us[0], 0.99), checked=float(np.mean(row["checked"])),
                **missing(missed, bound, out, f"budget of {row['budget_us']:g} µs"),
            )  # fmt: skip
    table.notes.append(
        f"{poses} poses; the depth missed is that of the query without budget less that of the one with it. The last "
        "row's budget is longer than any query takes."
    )


# ---- errors


def errors(out: Report, settings: Settings, progress: Any) -> None:
    table = out.section(
        "errors",
        "Signed distances against the independent reference",
        Column("triangles", "triangles"),
        Column("tool", "tool"),
        Column("poses", "poses"),
        Column("points on the part", "points", report.mega),
        Column("they are shallower by: least mm", "sampled_min_mm", report.mm),
        Column("most mm", "sampled_max_mm", report.mm),
        Column("may be mm", "spacing_mm", report.mm),
        Column("poses bracketed", "bracketed"),
        Column("brackets' largest width mm", "width_mm", report.mm),
        Column("largest difference from attained mm", "attained_mm", report.mm),
        Column("outside of bracket", "outside"),
    )
    poses, points, brackets, gap = (4, 20_000, 2, 1e-3) if settings.quick else (200, 1_000_000, 40, 1e-5)
    sizes = SQUARES["quick" if settings.quick else "full"]
    for done, (squares, tool) in enumerate((s, t) for s in sizes for t in TOOLS):
        progress(done / (len(sizes) * len(TOOLS)))
        figures = json.loads(core.contact_errors(squares, tool, poses, points, brackets, gap))
        ours, depth, sampled, lower, upper = (
            np.array(figures[key]) for key in ("clearance_mm", "depth_mm", "sampled_mm", "lower_mm", "upper_mm")
        )
        above, spacing = sampled - ours, figures["spacing_mm"]
        close = ours[: len(lower)]
        outside = int(np.sum((close < lower - ROUNDING) | (close > upper + ROUNDING)))
        table.row(
            triangles=2 * squares**2, tool=tool, poses=poses, points=figures["points"], sampled_min_mm=above.min(),
            sampled_max_mm=above.max(), spacing_mm=spacing, bracketed=len(lower), width_mm=(upper - lower).max(),
            attained_mm=abs(close - upper).max(), outside=outside,
        )  # fmt: skip
        where = f"{2 * squares**2} triangles, {tool} tool"
        out.check(above.min() >= -ROUNDING, f"{where}: {-above.min():.2g} mm deeper at a point of the part")
        out.check(above.max() <= spacing, f"{where}: {above.max():.2g} mm deeper than points allow")
        out.check(outside == 0, f"{where}: {outside} distances are outside of their bracket")
        out.check(abs(depth - np.maximum(0, -ours)).max() <= ROUNDING, f"{where}: the query's depth is another one")
    table.notes.append(
        "Points are the middles of equal parts of the triangles: the true least distance is at most theirs, and lower "
        "by at most their spacing. Brackets are found by branch and bound over every triangle; their upper end is "
        "attained, after a direct search at the best place. Both use a distance to the tool that shares no code with "
        "what they judge."
    )


# ---- over an edge


def slide(out: Report, settings: Settings) -> None:
    table = out.section(
        "slide",
        "Force on a ball R3 that slides off a plane over its edge, 0.2 mm deep",
        Column("steps of mm", "step_mm", report.mm),
        Column("largest force N", "largest_N", report.three),
        Column("largest change of a step N", "jump_N", report.mm),
        Column("largest difference from the integral N", "difference_N", report.mm),
    )
    for steps in (15, 30) if settings.quick else (75, 150, 300):
        figures = {key: np.array(value) for key, value in json.loads(core.contact_slide(steps)).items()}
        force = np.stack([figures["force_x_N"], figures["force_z_N"]], 1)
        exact = np.stack([figures["reference_x_N"], figures["reference_z_N"]], 1)
        table.row(
            step_mm=6 / steps, largest_N=np.linalg.norm(force, axis=1).max(),
            jump_N=np.linalg.norm(np.diff(force, axis=0), axis=1).max(),
            difference_N=np.linalg.norm(force - exact, axis=1).max(),
            **{key: value.tolist() for key, value in figures.items()},
        )  # fmt: skip
    table.notes.append(
        "The integral of stiffness × depth over plane and wall, by the reference's distance on a lattice of 0.02 mm. A "
        "continuous force changes half as much in half a step."
    )
