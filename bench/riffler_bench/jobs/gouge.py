"""Cutter locations on parts in a vise: does the swept tool with its holder gouge, by a judge that shares no code with
the planner; and where every named cutter touches planes, balls and rods."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from math import radians
from typing import Any

import numpy as np
from riffler import Collider, Mesh, Tool, plan

from .. import parts, report
from ..measure import Progress, Settings, steady, watched
from ..report import Column, Report
from ..swept import Box, Judge, dense
from ..touching import Shape, shapes

MODELS = ("ktoolcav", "ktoolcor", "fandisk")
SIZE = 100.0  # mm, the largest side of every part
TOLERANCE = 0.01  # mm
WAY, TURN = 0.05, radians(0.1)  # between the judge's poses
DIAMETER = 6.0
SHANK = [(22, 3, 34, 3), (34, 3, 42, 8)]
HOLDER = [(42, 13, 70, 16)]
LEAST, SHARP = 3.0, radians(20)  # mm, rad: shorter or flatter valleys, such as those between facets, are left out
PITCH = 2.0  # mm, of the jaws
STEP = 2.0  # mm between points of a path, for keys
TOUCHES = 1e-9  # mm
BINS = 300  # of the plot
ROUNDING = 1e-9  # mm


def the_tool() -> Tool:
    return Tool.ball(DIAMETER, 22).with_shank(SHANK).with_holder(HOLDER)


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("gouge", {"tolerance_mm": TOLERANCE, "touches_mm": TOUCHES})
    swept(out, settings, (lambda share: progress(0.98 * share)) if progress else None)
    touching(out, settings)
    return out


# ---- paths


@dataclass
class Scene:
    part: Mesh
    paths: list[Any]
    found: int  # paths, before the shorter ones were left out
    collider: Collider
    judge: Judge
    pencil_s: float


def swept(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "paths",
        "Pencil cuts in a vise, ball Ø6 with shank and holder",
        Column("part", "part"),
        Column("orientations", "rule"),
        Column("paths", "paths"),
        Column("without free orientation", "none_free"),
        Column("length mm", "length_mm", report.three),
        Column("points", "points"),
        Column("lifted", "lifted"),
        Column("by at most mm", "lift_mm", report.three),
        Column("inserted", "inserted"),
        Column("blocked", "blocked"),
        Column("moves unsafe", "unsafe"),
        Column("deepest at the points before mm", "before_mm", report.mm),
        Column("judged at", "judged", lambda n: f"{n} poses"),
        Column("deepest after mm", "after_mm", report.mm),
        Column("proven mm", "proven_mm", report.mm),
        Column("the report's bound mm", "bound_mm", report.mm),
    )
    times = out.section(
        "times",
        "Processor time of the stages",
        Column("part", "part"),
        Column("triangles", "triangles"),
        Column("orientations", "rule"),
        Column("pencil", "pencil_s", report.micro),
        Column("orientations", "orient_s", report.micro),
        Column("locations", "locate_s", report.micro),
        Column("looks a point", "evaluations", report.three),
        Column("a look", "look_s", report.micro),
    )
    meshes, most = {}, 60.0 if settings.quick else 400.0
    for name in MODELS:
        path = settings.models / f"{name}.stl" if settings.models else None
        if path and path.exists() and not settings.quick:
            meshes[name] = scaled(Mesh.read(path))
        else:
            why = "--quick" if settings.quick else "no such file" if path else "no folder named (--models)"
            table.row(part=f"{name}: left out, {why}")
    meshes["star, made in code"] = scaled(parts.sharp(800 if settings.quick else 5000))
    cases = [(name, rule) for name in meshes for rule in RULES]
    scenes: dict[str, Scene] = {}
    for name, rule in watched(cases, progress):
        if name not in scenes:
            scenes[name] = prepared(meshes[name], most)
        rows = planned(scenes[name], rule, settings.quick)
        judged(out, name, rule, scenes[name], rows)
        table.row(part=name, rule=rule, **rows.figures)
        times.row(part=name, rule=rule, triangles=len(meshes[name].triangles), **rows.times)
    table.notes += notes(most, table.rows)
    times.notes.append(
        "All with one thread: finding all paths, the maps of free orientations, and the cutter locations. Looks: "
        "clearances of part and jaws at a pose, and groups of bounds or triangles on a move; the locations' time for "
        "each."
    )


def notes(most: float, rows: list[dict[str, Any]]) -> list[str]:
    why = [f"{row['part']}, {row['rule']}: {row['reasons']}" for row in rows if row.get("reasons")]
    return [
        f"Parts are scaled to {SIZE:g} mm. Valleys are {LEAST:g} mm or more long, with {np.degrees(SHARP):g}° or more "
        f"between the directions to both contacts; the longest are taken until they add up to {most:g} mm. Cutter "
        "to 22 mm, shank R3 to 34, taper to R8 at 42, holder R13 to R16 from there to 70. Two jaws 16 mm thick, dexels "
        "2 mm apart, hold the part over 40 % of its height, below where most valleys open to.",
        "*Before*: the deepest entry of the surface of part or jaws into cutter, shank or holder where the tool stands "
        f"at the path's points unlifted. *After*: at poses at most {WAY} mm and {np.degrees(TURN):.1f}° apart on all "
        "moves between rows. Both are attained at a point; *proven* is what branch and bound over all triangles "
        "leaves possible at those poses.",
        *([f"What blocks points: {'; '.join(why)}."] if why else []),
    ]


def scaled(mesh: Mesh) -> Mesh:
    vertices = np.asarray(mesh.vertices)
    lower, upper = vertices.min(0), vertices.max(0)
    return Mesh((vertices - (lower + upper) / 2) * (SIZE / (upper - lower).max()), mesh.triangles)


def prepared(part: Mesh, most: float) -> Scene:
    tool = the_tool()
    with steady():
        begun = time.process_time()
        found = plan.pencil(part, tool, minimum_length=LEAST, bitangency_angle=SHARP)
        pencil_s = time.process_time() - begun
    paths, length = [], 0.0
    for path in sorted(found, key=lambda p: -p.length):
        if length < most:
            paths.append(path.divided(STEP))
            length += path.length
    jaws = vise(part, paths)
    collider = Collider(part, fixtures=[jaw.volume(PITCH) for jaw in jaws])
    return Scene(part, paths, len(found), collider, Judge(part, jaws, tool, HOLDER[-1][2]), pencil_s)


def vise(part: Mesh, paths: list[Any]) -> list[Box]:
    """Up is the coordinate direction that most of the valleys open to; the jaws stand where the part is narrower."""
    open_to = sum((middles(path).sum(0) for path in paths), np.zeros(3))
    up = int(np.argmax(abs(open_to)))
    lower, upper = (np.array(b, float) for b in part.bounds)
    sides = [k for k in range(3) if k != up]
    across = min(sides, key=lambda k: upper[k] - lower[k])
    if open_to[up] > 0:
        upper[up] = lower[up] + 0.4 * (upper[up] - lower[up])
    else:
        lower[up] = upper[up] - 0.4 * (upper[up] - lower[up])
    first, last = (lower.copy(), upper.copy()), (lower.copy(), upper.copy())
    first[0][across], first[1][across] = lower[across] - 16, lower[across]
    last[0][across], last[1][across] = upper[across], upper[across] + 16
    # Whole dexels: a volume's grid has the nearest whole number, and otherwise may not end at the box.
    return [Box(low, low + PITCH * np.ceil((high - low) / PITCH)) for low, high in (first, last)]


def middles(path: Any) -> np.ndarray:
    """The mean of both normals at every point: straight out of the valley."""
    mean = path.normals.sum(1)
    length = np.linalg.norm(mean, axis=1)[:, None]
    return np.where(length > 1e-6, mean / np.maximum(length, 1e-6), path.normals[:, 0])


# ---- orientations


Oriented = list[Any]  # of paths; None where no orientation is free


def grid(quick: bool) -> np.ndarray:
    return np.radians(np.linspace(-70, 70, 7 if quick else 13))


def key_points(path: Any) -> np.ndarray:
    count = int(np.clip(np.ceil(path.length / 15) + 1, 2, 10))
    return np.unique(np.linspace(0, len(path) - 1, min(count, len(path)), dtype=int))


def from_maps(scene: Scene, quick: bool) -> Oriented:
    """Keys where the maps at a few points suggest some, smoothly joined."""
    angles, out = grid(quick), []
    for path in scene.paths:
        maps = plan.free_orientations(
            path, scene.judge.tool, scene.collider, index=key_points(path), inclinations=angles, tilts=angles
        )
        keys = {found.index: found.suggestion for found in maps if found.suggestion is not None}
        out.append(path.orient(keys, interpolation="smooth") if keys else None)
    return out


def least_tilt(scene: Scene, quick: bool) -> Oriented:
    angles = grid(quick)
    return [
        plan.min_tilt(path, scene.judge.tool, scene.collider, inclinations=angles, tilts=angles)[0]
        for path in scene.paths
    ]


def bad(scene: Scene, quick: bool) -> Oriented:
    """Leaning 50° to one side of the valley, then to the other."""
    out = []
    for path in scene.paths:
        keys, centres, sign = {}, path.centres, 1
        for k in key_points(path):
            feed = centres[min(k + 1, len(path) - 1)] - centres[max(k - 1, 0)]
            middle = middles(path)[k]
            across = np.cross(middle, feed)
            across /= max(np.linalg.norm(across), 1e-300)
            axis = np.cos(radians(50)) * middle + sign * np.sin(radians(50)) * across
            keys[int(k)], sign = axis / np.linalg.norm(axis), -sign
        out.append(path.orient(keys, interpolation="smooth"))
    return out


RULES: dict[str, Callable[[Scene, bool], Oriented]] = {
    "keys from maps": from_maps,
    "least tilt": least_tilt,
    "bad keys": bad,
}


# ---- plan and judge


@dataclass
class Rows:
    oriented: Oriented
    cls: list[tuple[np.ndarray, plan.LocationReport]]
    figures: dict[str, Any] = field(default_factory=dict)
    times: dict[str, Any] = field(default_factory=dict)


def planned(scene: Scene, rule: str, quick: bool) -> Rows:
    with steady():
        begun = time.process_time()
        oriented = RULES[rule](scene, quick)
        turned = time.process_time()
        some = [path for path in oriented if path is not None]
        cls = [plan.cutter_locations(path, scene.judge.tool, scene.collider, tolerance=TOLERANCE) for path in some]
        ended = time.process_time()
    evaluations, points = sum(r.evaluations for _, r in cls), sum(len(path) for path in some)
    why = Counter(reason.split(",")[0] for _, r in cls for _, reason in r.blocked)
    reports = [r for _, r in cls]
    figures = {
        "paths": len(oriented), "found": scene.found, "none_free": len(oriented) - len(some),
        "length_mm": sum(path.length for path in some), "points": points,
        "lifted": sum(len(r.lifted) for r in reports), "inserted": sum(len(r.inserted) for r in reports),
        "lift_mm": max((float(r.lift.max(initial=0)) for r in reports), default=0.0),
        "blocked": sum(len(r.blocked) for r in reports), "unsafe": sum(len(r.unsafe) for r in reports),
        "bound_mm": max((max(0.0, -r.bound) for r in reports if len(r.points)), default=0.0),
        "reasons": ", ".join(f"{count} × {text}" for text, count in why.most_common()),
        "unsafe_reasons": dict(Counter(way[3] for r in reports for way in r.unsafe)),
    }  # fmt: skip
    times = {
        "pencil_s": scene.pencil_s, "orient_s": turned - begun, "locate_s": ended - turned,
        "evaluations": evaluations / max(points, 1), "look_s": (ended - turned) / max(evaluations, 1),
    }  # fmt: skip
    return Rows([path for path in oriented if path is not None], cls, figures, times)


def judged(out: Report, part: str, rule: str, scene: Scene, rows: Rows) -> None:
    """Adds what the judge finds; entries on moves that the report calls unsafe count against its bound only."""
    where, judge = f"{part}, {rule}", scene.judge
    before, after, proven, poses, lost = [0.0], 0.0, 0.0, 0, 0
    series, start = {"after_place_mm": [], "after_entry_mm": [], "before_place_mm": [], "before_entry_mm": []}, 0.0
    for path, (cl, rep) in zip(rows.oriented, rows.cls, strict=True):
        tips = path.centres - path.radius * path.axes
        wanted = judge.entries(np.hstack([tips, path.axes]), gap=0.01)[:, 0]
        before.append(float(wanted.max()))
        at = np.append(0, np.cumsum(np.linalg.norm(np.diff(path.centres, axis=0), axis=1)))
        series["before_place_mm"] += (start + at).tolist()
        series["before_entry_mm"] += wanted.tolist()
        if len(cl):
            between, moves = dense(cl, WAY, TURN)
            entries = judge.entries(between, TOLERANCE)
            lost += int(judge.holds_top(between).sum())
            poses += len(between)
            safe = ~np.isin(moves, [way[0] for way in rep.unsafe])
            after = max(after, float(entries[safe, 0].max(initial=0)))
            proven = max(proven, float(entries[safe, 1].max(initial=0)))
            deepest = float(entries[:, 0].max())
            out.check(deepest <= max(0, -rep.bound) + ROUNDING, f"{where}: {deepest:.4g} mm, bound {-rep.bound:.4g}")
            way = np.append(0, np.cumsum(np.linalg.norm(np.diff(between[:, :3], axis=0), axis=1)))
            share = way / way[-1] if way[-1] > 0 else way
            binned = np.zeros(BINS)
            np.maximum.at(binned, (share * (BINS - 1)).astype(int), entries[:, 0])
            series["after_place_mm"] += (start + path.length * np.linspace(0, 1, BINS)).tolist()
            series["after_entry_mm"] += binned.tolist()
        start += path.length
    out.check(after <= TOLERANCE + ROUNDING, f"{where}: {after:.4g} mm deep between the rows")
    out.check(lost == 0, f"{where}: {lost} poses cannot be judged, the tool's upper end is in a jaw or the part's box")
    rows.figures |= {"before_mm": max(before), "after_mm": after, "proven_mm": proven, "judged": poses, **series}


# ---- where cutters touch


def touching(out: Report, settings: Settings) -> None:
    table = out.section(
        "touching",
        "Cutters placed by contact point, normal and axis: largest error against the closed form",
        Column("cutter", "cutter"),
        Column("placings", "count"),
        Column("plane mm", "plane_mm", report.mm),
        Column("ball R2 to R200 mm", "ball_mm", report.mm),
        Column("rod R2 to R200 mm", "rod_mm", report.mm),
        Column("contact from the cutter mm", "contact_mm", report.mm),
    )
    count = 500 if settings.quick else 20_000
    for name, shape in shapes().items():
        figures = touched(shape, count, np.random.default_rng(11))
        table.row(cutter=name, count=count, **figures)
        worst = max(figures.values())
        out.check(worst <= TOUCHES, f"{name}: {worst:.3g} mm from where it should touch")
    table.notes.append(
        "Axes up to 80° from the normal, every hundredth parallel to it, contacts within 100 mm. Plane: the height of "
        "the cutter's lowest point over it, by its support function. Ball and rod, bulging, of material: the cutter's "
        "distance from the ball's centre, and the least from the rod's axis, less the radius."
    )


def units(rng: np.random.Generator, count: int) -> np.ndarray:
    v = rng.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1)[:, None]


def touched(shape: Shape, count: int, rng: np.random.Generator) -> dict[str, float]:
    normals, feeds, contacts = units(rng, count), units(rng, count), rng.uniform(-100, 100, (count, 3))
    across = np.cross(normals, units(rng, count))
    across /= np.linalg.norm(across, axis=1)[:, None]
    lean = np.radians(rng.uniform(0, 80, count))[:, None]
    lean[::100] = 0
    axes = np.cos(lean) * normals + np.sin(lean) * across
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    poses = plan.contact_locations(contacts, normals, axes, shape.tool, feeds=feeds)
    # The plane: how far down the cutter reaches from its tip, against the tip's height.
    along = (axes * normals).sum(1)
    sideways = np.linalg.norm(normals - along[:, None] * axes, axis=1)
    height = ((poses[:, :3] - contacts) * normals).sum(1)
    radius = 2 * 100 ** rng.random(count)
    middle = contacts - radius[:, None] * normals
    rod = np.cross(normals, units(rng, count))
    rod /= np.linalg.norm(rod, axis=1)[:, None]
    steps = np.concatenate([[0], *(sign * np.geomspace(1e-7, 30, 60) for sign in (1, -1))])
    line = middle[:, None] + steps[:, None] * rod[:, None]
    to_rod = shape.distance(line, np.broadcast_to(poses[:, None], (*line.shape[:2], 6))).min(1)
    return {
        "plane_mm": float(abs(height - shape.support(sideways, -along)).max()),
        "ball_mm": float(abs(shape.distance(middle, poses) - radius).max()),
        "rod_mm": float(abs(to_rod - radius).max()),
        "contact_mm": float(abs(shape.distance(contacts, poses)).max()),
    }
