"""Pencil curves compared with their closed forms (PEN), creases and the height map's second difference; run time
against tolerance, and at 200 000 triangles."""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Mesh, Tool, plan

from .. import _bench as core
from .. import baselines, report, valleys
from ..curves import SPACING, Agreement, Segments, compare
from ..measure import Progress, Settings, child, shares, steady, threads, watched
from ..pencil_cases import TOLERANCE, TOOL, Case, case, cases, contacts, digest, lines_of, picture, turned
from ..remesh import STEP, WAYS, Patch, Surface, mesh
from ..report import Column, Report
from .stl import model_paths, save

SHARE = 0.01  # missed and false length that are allowed
TOLERANCES = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005)
CREASES = (3.0, 5.0, 8.0, 12.0, 20.0, 30.0, 45.0)  # degrees
BENDS = (0.003, 0.006, 0.012, 0.017, 0.03, 0.06, 0.12)  # mm
KIND = baselines.PIXEL  # added to the limit at which the baselines are judged


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("pencil", {"radius": valleys.R, "tolerance": TOLERANCE, "pixel": baselines.PIXEL})
    share = shares(progress)
    curves(out, settings, share(0, 0.7))
    tolerances(out, settings, share(0.7, 0.8))
    scale(out, settings, share(0.8, 0.9))
    models(out, settings, share(0.9, 1))
    return out


# ---- parts with curves in closed form


def curves(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "valleys",
        f"Parts with known curves, ball of {valleys.R:g} mm, tolerance {TOLERANCE:g} mm",
        Column("part", "part"),
        Column("found by", "engine"),
        Column("curves mm", "true_mm", lambda v: f"{v:.1f}"),
        Column("paths (true)", "paths"),
        Column("Hausdorff distance mm", "hausdorff_mm", report.mm),
        Column("allowed", "limit_mm", report.mm),
        Column("mean mm", "mean_mm", report.mm),
        Column("missed", "missed", share_text),
        Column("false", "false_text"),
        Column("contacts mm", "contacts_mm", report.mm),
        Column("processor time", "cpu_s", report.micro),
    )
    every = out.section(
        "cases",
        "Each mesh of these parts",
        Column("part", "part"),
        Column("mesh", "way"),
        Column("off by mm", "moved", lambda v: f"{v:g}"),
        Column("triangles", "triangles"),
        Column("paths (true)", "paths"),
        Column("Hausdorff distance mm", "hausdorff_mm", report.mm),
        Column("of it facets", "facets_mm", report.mm),
        Column("mean mm", "mean_mm", report.mm),
        Column("missed mm", "missed_mm", report.mm),
        Column("false mm", "false_mm", report.mm),
        Column("contacts mm", "contacts_mm", report.mm),
        Column("normals °", "normals_degrees", report.mm),
        Column("points", "points"),
        Column("balls tried", "balls"),
        Column("processor time", "cpu_s", report.micro),
    )
    parts = valleys.parts()
    if settings.quick:
        parts = [p for p in parts if p.name in ("90° groove", "175° groove", "blind hole", "T-slot", "pocket", "box")]
    few = slice(2, 5, 2) if settings.quick else slice(None)
    spacing = 0.5 if settings.quick else 0.02
    rivals = {"creases": Rival(CREASES[few], "°", spacing), "second difference": Rival(BENDS[few], " mm", spacing)}
    rows: dict[str, list[dict[str, Any]]] = {}
    for seed, part in enumerate(watched(parts, progress)):
        rows[part.name] = [judged(out, every, c, settings) for c in cases(part, seed, settings.quick)]
        for c in (case(part, way, seed, upright=True) for way in (WAYS[:1] if settings.quick else WAYS)):
            rivals["creases"].add(c, baselines.Creases.of(c.mesh, valleys.R).sharper)
            rivals["second difference"].add(c, baselines.HeightMap.of(c.mesh, valleys.R).bent)
    for part in parts:
        table.row(part=part.name, engine="Riffler", **worst(part, rows[part.name]), drawn=picture(part))
        for name, rival in rivals.items():
            table.row(part=part.name, engine=f"{name} > {rival.best:g}{rival.unit}", **rival.row(part))
    ours = [r for found in rows.values() for r in found]
    table.row(part="all", engine="Riffler", **total(ours), cpu_s=float(np.mean([r["cpu_s"] for r in ours])))
    for name, rival in rivals.items():
        table.row(part="all", engine=f"{name} > {rival.best:g}{rival.unit}", **total(rival.chosen))
    tried = "; ".join(f"{n}: {', '.join(f'{x:g}' for x in r.tried)}{r.unit}" for n, r in rivals.items())
    table.notes.append(
        "The worst of each part's meshes: coarse and even; fine and moved at random along the surface; needles; and "
        "the fine one 10 m off. Riffler's are turned at random. Allowed: the tolerance, and what the chords of a "
        "cylinder's facets add. Missed: the share of the true curves farther than that from any path; false: the "
        "length of paths farther than that from any true curve, as a share of them, or in mm where there is none. "
        "Contacts on a cylinder are on its facets, and move by up to R × the angle between two of these. The other two "
        "are our own plain versions, on the parts as they stand, upright; each has the threshold of those tried that "
        f"serves it best over all parts ({tried}), and "
        f"{KIND:g} mm more is allowed to them: a pixel of the height map."
    )


@dataclass
class Rival:
    """A baseline at all its thresholds."""

    tried: tuple[float, ...]
    unit: str
    spacing: float  # of the compared places, mm

    def __post_init__(self) -> None:
        self.results: list[list[dict[str, Any]]] = [[] for _ in self.tried]

    def add(self, c: Case, find) -> None:
        for results, threshold in zip(self.results, self.tried, strict=True):
            segments, paths = find(threshold)
            result = compare(segments, c.lines, c.limit + KIND, self.spacing)
            results.append({"part": c.part.name, **figures(c, result), "count": paths})

    @property
    def chosen(self) -> list[dict[str, Any]]:
        """The results at the threshold with the least missed and false length."""
        return min(self.results, key=lambda rs: sum(r["missed_mm"] + r["false_mm"] for r in rs))

    @property
    def best(self) -> float:
        return self.tried[next(k for k, rs in enumerate(self.results) if rs is self.chosen)]

    def row(self, part: valleys.Part) -> dict[str, Any]:
        return worst(part, [r for r in self.chosen if r["part"] == part.name])


def figures(c: Case, result: Agreement) -> dict[str, Any]:
    return {
        "true_mm": result.true_length,
        "found_mm": result.found_length,
        "hausdorff_mm": result.hausdorff,
        "mean_mm": result.mean,
        "missed_mm": result.missed,
        "false_mm": result.false,
        "limit_mm": c.limit,
        "facets_mm": c.facets,
    }


def worst(part: valleys.Part, rows: list[dict[str, Any]]) -> dict[str, Any]:
    def most(key: str) -> float | None:
        known = [r[key] for r in rows if r.get(key) is not None]
        return max(known) if known else None

    true = rows[0]["true_mm"]
    counts = [r["count"] for r in rows]
    told = f"{min(counts)}" if min(counts) == max(counts) else f"{min(counts)} to {max(counts)}"
    times = [r["cpu_s"] for r in rows if "cpu_s" in r]
    # Without both sets there is no distance: one of them empty somewhere says so.
    lost = any(r["hausdorff_mm"] is None for r in rows)
    return {
        "true_mm": true,
        "paths": f"{told} ({len(part.curves)})",
        "hausdorff_mm": None if lost else most("hausdorff_mm"),
        "limit_mm": most("limit_mm"),
        "mean_mm": None if lost else most("mean_mm"),
        "missed": most("missed_mm") / true if true else None,
        "false_text": share_text(most("false_mm") / true) if true else f"{most('false_mm'):.3g} mm",
        "contacts_mm": most("contacts_mm"),
        **({"cpu_s": float(np.mean(times))} if times else {}),
    }


def total(rows: list[dict[str, Any]]) -> dict[str, Any]:
    true = sum(r["true_mm"] for r in rows)
    return {
        "missed": sum(r["missed_mm"] for r in rows) / true,
        "false_text": share_text(sum(r["false_mm"] for r in rows) / true),
    }


def between(settings: Settings) -> float:
    """mm between the compared places; the ends of all pieces are compared, too."""
    return 5 * SPACING if settings.quick else SPACING


def share_text(value: float) -> str:
    return f"{100 * value:.3g} %"


def judged(out: Report, table: report.Section, c: Case, settings: Settings) -> dict[str, Any]:
    """A row for one mesh; what is wrong with it is a problem of the report."""
    with steady():
        start = time.thread_time()
        paths = plan.pencil(c.mesh, TOOL, tolerance=TOLERANCE)
        seconds = time.thread_time() - start
    result = compare(lines_of(paths), c.lines, c.limit, between(settings))
    near = contacts(paths, c.true) if len(paths) and c.true else {}
    row = table.row(
        part=c.part.name,
        way=c.way,
        moved=c.moved,
        triangles=len(c.mesh.triangles),
        paths=f"{len(paths)} ({len(c.true)})",
        count=len(paths),
        points=sum(len(p.centres) for p in paths),
        balls=paths.stats.balls,
        cpu_s=seconds,
        **figures(c, result),
        **near,
    )
    what = f"{c.part.name}, {c.way}, off by {c.moved:g}"
    said = f"{what}: {len(paths)} paths for {len(c.true)}, {row}"
    out.check(len(paths) == len(c.true), said)
    out.check(sum(bool(p.closed) for p in paths) == sum(t.closed for t in c.true), f"{what}: closed flags")
    out.check(result.hausdorff is not None and result.hausdorff <= c.limit, said)
    out.check(result.missed <= SHARE * result.true_length and result.false <= SHARE * result.true_length, said)
    allowed = 2 * c.limit + valleys.R * c.tilt
    out.check(near.get("contacts_mm", 0) <= allowed, f"{what}: contacts off by {near.get('contacts_mm')}, {allowed}")
    degrees = np.degrees(c.tilt) + np.degrees(2 * c.limit / valleys.R)
    out.check(near.get("normals_degrees", 0) <= degrees, f"{what}: normals off by {near.get('normals_degrees')}°")
    with threads(2):
        again = plan.pencil(c.mesh, TOOL, tolerance=TOLERANCE)
    out.check(digest(paths) == digest(again), f"{what}: other bytes with two threads")
    return row


# ---- time against error


def smooth(part: valleys.Part, around: int) -> Surface:
    """The part with so many rows around its cylinder that their chords do not count."""
    return Surface(part.surface.at, part.surface.across, [Patch(p.length, around) for p in part.surface.along], True)


def tolerances(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "tolerance",
        "What a tolerance costs and gives, one thread",
        Column("part", "part"),
        Column("triangles", "triangles"),
        Column("tolerance mm", "tolerance", lambda v: f"{v:g}"),
        Column("Hausdorff distance mm", "hausdorff_mm", report.mm),
        Column("mean mm", "mean_mm", report.mm),
        Column("points", "points"),
        Column("processor time", "cpu_s", report.micro),
    )
    tilted, bored = valleys.boss(25), valleys.hole(25)
    rows = 256 if settings.quick else 2048
    chosen = {
        part.name: (mesh(smooth(part, rows), "coarse", np.random.default_rng(1))[0], part) for part in (tilted, bored)
    }
    for part in (valleys.groove(90), valleys.pit(65)):
        chosen[part.name] = (sized(part.surface, 200 if settings.quick else 5_000), part)
    rng = np.random.default_rng(5)
    asked = TOLERANCES[1:4:2] if settings.quick else TOLERANCES
    for name, (upon, part) in watched(list(chosen.items()), progress):
        turn = turned(rng)
        placed = Mesh(np.asarray(upon.vertices) @ turn.T, upon.triangles)
        true = Segments.of([c.placed(turn, np.zeros(3)).centres for c in part.curves], [c.closed for c in part.curves])
        sag = part.lever * part.bent * (1 - np.cos(pi / rows))
        for tolerance in asked:
            with steady():
                start = time.thread_time()
                paths = plan.pencil(placed, TOOL, tolerance=tolerance)
                seconds = time.thread_time() - start
            result = compare(lines_of(paths), true, tolerance + sag, between(settings))
            out.check(
                result.hausdorff is not None and result.hausdorff <= tolerance + sag,
                f"{name}: {result.hausdorff} mm at tolerance {tolerance:g}",
            )
            table.row(
                part=name,
                triangles=len(placed.triangles),
                tolerance=tolerance,
                hausdorff_mm=result.hausdorff,
                mean_mm=result.mean,
                points=sum(len(p.centres) for p in paths),
                cpu_s=seconds,
            )
    table.notes.append(
        f"The cylinders have {rows} facets, whose chords are within {8 * (1 - np.cos(pi / rows)):.1g} mm; the plane "
        "ones are exact, so their error is what rounding leaves."
    )


# ---- many triangles


def scale(out: Report, settings: Settings, progress: Progress) -> None:
    wanted = 1_000 if settings.quick else 200_000
    table = out.section(
        "scale",
        "Many triangles",
        Column("part", "part"),
        Column("triangles", "triangles"),
        Column("threads", "threads"),
        Column("wall time", "wall_s", report.micro),
        Column("processor time", "cpu_s", report.micro),
        Column("paths", "paths"),
        Column("balls tried", "balls"),
        Column("of these in valleys", "starts"),
        Column("balls set along valleys", "steps"),
        Column("peak memory", "peak_bytes", report.megabytes),
    )
    parts = [valleys.boss(25), valleys.slot(), valleys.groove(90, 1.2 * valleys.R, found=False), valleys.sphere()]
    chosen = [(part, wanted) for part in (parts[::3] if settings.quick else parts)]
    if not settings.quick:
        chosen.append((valleys.boss(25), 1_000_000))
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "part")
        for part, many in watched(chosen, progress):
            upon = sized(part.surface, many)
            save(upon, path)
            for count in (1, 2):
                found = child("pencil", count, path=path, diameter=2 * valleys.R, tolerance=TOLERANCE)
                table.row(part=part.name, triangles=len(upon.triangles), threads=count, **found)
                out.check(found["paths"] == len(part.curves), f"{part.name}, {len(upon.triangles)}: {found}")
                if part.surface.convex:
                    out.check(found["starts"] == found["steps"] == 0, f"{part.name}: work where it is convex: {found}")
            out.check(
                table.rows[-1]["digest"] == table.rows[-2]["digest"], f"{part.name}: other bytes with two threads"
            )


def sized(surface: Surface, wanted: int) -> Mesh:
    """The fine mesh with about so many triangles."""
    step = STEP
    for _ in range(6):
        upon, *_ = mesh(surface, "fine", np.random.default_rng(2), step)
        ratio = len(upon.triangles) / wanted
        if abs(ratio - 1) < 0.005:
            break
        step *= ratio**0.5
    return upon


# ---- parts from files


def models(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "models",
        "Parts from files: what must hold at every point of every path",
        Column("part", "part"),
        Column("triangles", "triangles"),
        Column("ball Ø mm", "diameter", report.three),
        Column("paths", "paths"),
        Column("length mm", "length_mm", report.three),
        Column("ball enters the part by mm", "entered_mm", report.mm),
        Column("contacts off the part mm", "off_mm", report.mm),
        Column("off the ball", "ball_mm", report.mm),
        Column("wall time, all threads", "wall_s", report.micro),
    )
    paths = model_paths(settings)
    if not paths:
        table.notes.append("Left out: no folder with .stl files was named (--models).")
    for path in watched(paths, progress):
        upon = Mesh.read(path)
        size = float(np.max(np.subtract(*np.asarray(upon.bounds)[::-1])))
        radius = 0.02 * size
        start = time.perf_counter()
        found = plan.pencil(upon, Tool.ball(2 * radius, 10 * radius), tolerance=1e-4 * size)
        seconds = time.perf_counter() - start
        figures = {"entered_mm": 0.0, "off_mm": 0.0, "ball_mm": 0.0}
        if found:
            centres = np.concatenate([np.asarray(p.centres) for p in found])
            touched = np.concatenate([np.asarray(p.contacts) for p in found])
            room = core.mesh_distances(np.ascontiguousarray(centres), upon)
            away = np.linalg.norm(touched - centres[:, None], axis=2)
            figures = {
                "entered_mm": float(max(0.0, (radius - room).max())),
                "off_mm": float(core.mesh_distances(np.ascontiguousarray(touched.reshape(-1, 3)), upon).max()),
                "ball_mm": float(abs(away - radius).max()),
            }
        good = max(figures.values()) <= 1e-4 * size
        out.check(good, f"{path.stem}: {figures}, tolerance {1e-4 * size:.2g}")
        table.row(
            part=path.stem,
            triangles=len(upon.triangles),
            diameter=2 * radius,
            paths=len(found),
            length_mm=float(sum(p.length for p in found)),
            wall_s=seconds,
            **figures,
        )
    if table.rows:
        table.notes.append("Ø: a twenty-fifth of the part; tolerance: a ten-thousandth of it.")
