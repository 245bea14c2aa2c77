"""The drop cutter against OpenCAMLib's: where cutters come to rest on parts from above, and points a second."""

from __future__ import annotations

import tempfile
from math import radians, tan
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Mesh, Tool

from .. import parts, report
from ..measure import Progress, Settings, child, watched
from ..report import Column, Report
from ..rivals import LeftOutError, ask
from .stl import model_paths, save

WANTED = 1e-6  # mm between the two
HALF_ANGLE = radians(30)


def cutters(diameter: float) -> dict[str, tuple[Tool, str, list[float]]]:
    """Ours, and OpenCAMLib's class with its sizes; the length is that of the part and more."""
    length, corner = 20 * diameter, diameter / 8
    cone = diameter / 2 / tan(HALF_ANGLE)
    return {
        "cylindrical": (Tool.flat(diameter, length), "CylCutter", [diameter, length]),
        "ball": (Tool.ball(diameter, length), "BallCutter", [diameter, length]),
        "bull nose": (Tool.fillet(diameter, corner, length), "BullCutter", [diameter, corner, length]),
        "cone": (
            Tool.cone_end(HALF_ANGLE, cone / 2, HALF_ANGLE, diameter, length),
            "ConeCutter",
            [diameter, HALF_ANGLE, length],
        ),
    }


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("drop", {"wanted_mm": WANTED})
    table = out.section(
        "points",
        "Cutters dropped on parts, one thread",
        Column("part", "part"),
        Column("triangles", "triangles"),
        Column("cutter", "cutter"),
        Column("points", "points"),
        Column("Riffler, points/s", "rate", thousands),
        Column("OpenCAMLib, points/s", "rival_rate", thousands),
        Column("ratio", "ratio", report.ratio),
        Column("largest difference mm", "largest_mm", report.mm),
        Column("99.9 % within mm", "most_mm", report.mm),
        Column("over 1e-6 mm", "over"),
        Column("one finds nothing", "alone"),
        Column("Riffler there, off the closed form mm", "mine_mm", report.mm),
        Column("OpenCAMLib there", "theirs_mm", report.mm),
        Column("", "note"),
    )
    meshes = {path.stem: Mesh.read(path) for path in model_paths(settings)}
    if not meshes:
        table.notes.append("Parts from files left out: no folder with .stl files was named (--models).")
        meshes = {"organic, made in code": parts.organic(20_000), "sharp, made in code": parts.sharp(20_000)}
    count = 300 if settings.quick else 1000
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder)
        cases = [(part, cutter) for part in meshes for cutter in cutters(1.0)]
        for part, cutter in watched(cases, progress):
            row = dropped(part, meshes[part], cutter, count, settings, path)
            table.row(**row)
            # Where the two differ, the closed form must side with riffler.
            judged = "mine_mm" in row
            differ = row.get("over", 0) + row.get("alone", 0)
            good = row["mine_mm"] <= WANTED and row["mine_lost"] == 0 if judged else differ == 0
            out.check(good, f"{part}, {cutter}: {row}")
    table.notes.append(
        "Points at random over the part's box, the cutter's diameter a twentieth of the part. Points a second with "
        "the building of the tree over the triangles; of Riffler's, the medians of three runs. Where a cone's heights "
        "differ, the height is found once more, for every triangle below it, as the greatest value of a concave "
        "function on it; what stands there is the largest difference from that."
    )
    return out


def thousands(value: float) -> str:
    return f"{report.three(value / 1000)} k"


def dropped(part: str, mesh: Mesh, cutter: str, count: int, settings: Settings, folder: Path) -> dict[str, Any]:
    save(mesh, str(folder / "part"))
    low, high = np.asarray(mesh.bounds)
    size = float((high - low).max())
    tool, kind, sizes = cutters(size / 20)[cutter]
    np.save(folder / "points.npy", np.random.default_rng(8).uniform(low[:2], high[:2], (count, 2)))
    given = {"points": str(folder / "points.npy"), "path": str(folder / "part")}
    mine = child("drop", tool=tool.to_dict(), result=str(folder / "mine.npy"), **given)
    row = {"part": part, "triangles": len(mesh.triangles), "cutter": cutter, "points": count}
    row |= {"rate": count / mine["cpu_s"], "cpu_s": mine["cpu_s"]}
    try:
        theirs = ask(
            settings, "drop.py", "opencamlib", 1, mesh=given["path"], kind=kind, sizes=sizes,
            points=given["points"], result=str(folder / "theirs.npy"),
        )  # fmt: skip
    except LeftOutError as why:
        return row | {"note": f"OpenCAMLib: left out, {why}"}
    a, b = np.load(folder / "mine.npy"), np.load(folder / "theirs.npy")
    both = np.isfinite(a) & np.isfinite(b)
    apart = abs(a - b)[both]
    seconds = theirs["cpu_s"] + theirs["build_s"]
    alone = np.isfinite(a) != np.isfinite(b)
    differ = np.flatnonzero(alone | (both & (abs(np.nan_to_num(a) - np.nan_to_num(b)) > WANTED)))
    if cutter == "cone" and len(differ):
        where = np.load(folder / "points.npy")[differ]
        true = np.array([cone_height(mesh, p, size / 40, 1 / tan(HALF_ANGLE)) for p in where])
        for key, heights in (("mine_mm", a[differ]), ("theirs_mm", b[differ])):
            found = np.isfinite(heights) & np.isfinite(true)
            row[key] = float(abs(heights - true)[found].max(initial=0))
            row[key.replace("mm", "lost")] = int((np.isfinite(heights) != np.isfinite(true)).sum())
    return row | {
        "rival_rate": count / seconds,
        "ratio": seconds / mine["cpu_s"],
        "largest_mm": float(apart.max(initial=0)),
        "most_mm": float(np.quantile(apart, 0.999)) if len(apart) else 0.0,
        "over": int((apart > WANTED).sum()),
        "alone": int(alone.sum()),
        "engine": theirs["engine"],
    }


def cone_height(mesh: Mesh, place: np.ndarray, radius: float, slope: float) -> float:
    """The tip's height of a cone that comes down at `place`: the most of z - slope · rho over the part within `radius`.

    On a triangle that is a concave function of the place. Its greatest value is on an edge, below the tip, or on the
    rim where the triangle is steeper than the cone: there straight up the slope.
    """
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)] - [*place, 0]
    flat = corners[:, :, :2]
    corners = corners[((flat.min(1) <= radius) & (flat.max(1) >= -radius)).all(1)]
    begin = corners.reshape(-1, 3)
    way = np.roll(corners, -1, axis=1).reshape(-1, 3) - begin
    # The part of each edge that lies within the radius.
    a, b = (way[:, :2] ** 2).sum(1), (way[:, :2] * begin[:, :2]).sum(1)
    c = (begin[:, :2] ** 2).sum(1) - radius**2
    root = np.sqrt(np.maximum(b * b - a * c, 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        low = np.where(a > 0, (-b - root) / a, 0).clip(0, 1)
        high = np.where(a > 0, (-b + root) / a, 1).clip(0, 1)

    def value(share: np.ndarray) -> np.ndarray:
        p = begin + share[:, None] * way
        return p[:, 2] - slope * np.hypot(p[:, 0], p[:, 1])

    within = np.where(a > 0, b * b >= a * c, c <= 0) & (high >= low)
    begin, way, low, high = begin[within], way[within], low[within], high[within]
    for _ in range(100):  # thirds of what is left
        left, right = low + (high - low) / 3, high - (high - low) / 3
        up = value(left) < value(right)
        low, high = np.where(up, left, low), np.where(up, high, right)
    at = begin + ((low + high) / 2)[:, None] * way
    best = value((low + high) / 2)[np.hypot(at[:, 0], at[:, 1]) <= radius * (1 + 1e-9)].max(initial=-np.inf)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    level = abs(normals[:, 2]) > 1e-12 * np.linalg.norm(normals, axis=1)
    corners, normals = corners[level], normals[level]
    rise = -normals[:, :2] / normals[:, 2:]
    steep = np.linalg.norm(rise, axis=1)
    on_rim = np.where(steep > slope, radius / np.maximum(steep, 1e-300), 0)[:, None] * rise
    for spot in (np.zeros_like(rise), on_rim):
        z = corners[:, 0, 2] + ((spot - corners[:, 0, :2]) * rise).sum(1)
        off = corners[:, :, :2] - spot[:, None]
        turn = off[:, :, 0] * np.roll(off, -1, axis=1)[:, :, 1] - off[:, :, 1] * np.roll(off, -1, axis=1)[:, :, 0]
        inside = (turn >= 0).all(1) | (turn <= 0).all(1)
        best = max(best, (z - slope * np.linalg.norm(spot, axis=1))[inside].max(initial=-np.inf))
    return float(best)
