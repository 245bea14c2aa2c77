"""Parts from files at 256² columns, tri-dexel: the volume of closed ones, of open ones beside the winding number's."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

from ... import Mesh, Volume
from .. import report
from ..measure import Progress, Settings, watched
from ..report import Column, Report

COUNTS = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "duplicates", "degenerate")


def winding_volume(mesh: Mesh, cells: int) -> tuple[float, float]:
    """Volume of the points whose |generalized winding number| exceeds 1/2, by stratified samples, with one standard
    deviation of that estimate. Solid angles of all triangles (Van Oosterom and Strackee 1983), double precision."""
    rng = np.random.default_rng(3)
    lower, upper = np.asarray(mesh.bounds)
    size = upper - lower
    n = np.maximum(1, np.round(cells * size / size.max())).astype(int)
    grid = np.stack(np.meshgrid(*(np.arange(k) for k in n), indexing="ij"), -1).reshape(-1, 3)
    points = lower + (grid + rng.random(grid.shape)) / n * size
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    inside = np.zeros(len(points), bool)
    for start in range(0, len(points), 64):
        p = points[start : start + 64]
        a, b, c = (corners[None, :, k] - p[:, None] for k in range(3))
        la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
        num = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
        den = la * lb * lc + np.einsum("ijk,ijk->ij", a, b) * lc
        den += np.einsum("ijk,ijk->ij", b, c) * la + np.einsum("ijk,ijk->ij", c, a) * lb
        inside[start : start + 64] = abs(2 * np.arctan2(num, den).sum(1) / (4 * np.pi)) > 0.5
    share, box = inside.mean(), size.prod()
    # Stratified: only cells that the surface crosses vary; their number grows as cells².
    return share * box, box * np.sqrt(share * (1 - share) / len(points)) / np.sqrt(cells) * 2


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("models", {})
    table = out.section(
        "parts",
        "Parts from files, 256² columns, tri-dexel",
        Column("part", "part"),
        Column("triangles", "triangles"),
        Column("open edges", "open_edges"),
        Column("reference mm³", "reference_text"),
        Column("dexel volume", "volume", lambda v: f"{v:.6g}"),
        Column("difference", "difference", report.percent),
        Column("asked", "asked", lambda v: f"{100 * v:g} %"),
        Column("wall time", "seconds", report.micro),
        Column("mesh audit", "audit"),
    )
    paths = sorted(settings.models.glob("*.stl")) if settings.models else []
    if not paths:
        table.notes.append("Left out: no folder with .stl files was named (--models).")
    for path in watched(paths[:2] if settings.quick else paths, progress):
        figures = compare(path)
        table.row(**figures)
        out.check(figures["audit"] == "clean", f"{path.name}: {figures}")
    return out


def compare(path: Path) -> dict:
    mesh = Mesh.read(path)
    audit = mesh.audit()
    broken = audit["open_edges"] + audit["nonmanifold_edges"] > 0
    # As many evaluations for every part: the reference takes points x triangles.
    cells = round(40 * min(1.0, 5000 / len(mesh.triangles)) ** (1 / 3))
    reference, deviation = winding_volume(mesh, cells) if broken else (mesh.volume, 0.0)
    lower, upper = np.asarray(mesh.bounds)
    start = time.perf_counter()
    volume = Volume.from_mesh(mesh, (upper - lower).max() / 256, "xyz")
    seconds = time.perf_counter() - start
    out = volume.to_mesh().audit()
    difference, asked = volume.volume / reference - 1, 0.02 if broken else 0.003
    good = abs(difference) <= asked + 3 * deviation / reference and not any(out[k] for k in COUNTS)
    return {
        "part": path.stem,
        "triangles": len(mesh.triangles),
        "open_edges": int(audit["open_edges"]),
        "reference_text": f"{reference:.6g}" + (f" ± {deviation:.2g}" if broken else ""),
        "volume": volume.volume,
        "difference": float(difference),
        "asked": asked,
        "seconds": seconds,
        "audit": "clean" if good else "**BAD**",
    }
