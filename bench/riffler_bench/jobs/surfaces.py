"""Exact surfaces against tessellations of them: time of a query, ripple of the force along a torus, and the error."""

from __future__ import annotations

from .. import report
from ..measure import Progress, Settings, child, watched
from ..report import Column, Report
from ..torus import DEPTH, RADIUS, RING, TUBE

RIPPLE = 1e-3  # largest wanted, of the force


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("surfaces", {"ripple": RIPPLE, "depth_mm": DEPTH})
    table = out.section(
        "torus",
        "A ball on a torus, exact and in triangles, one thread",
        Column("surface", "surface"),
        Column("triangles", "triangles", lambda n: report.grouped(n) if n else ""),
        Column("collider ms", "build_s", lambda s: report.three(1e3 * s)),
        Column("query, mean µs", "mean_s", lambda s: report.three(1e6 * s)),
        Column("99 % µs", "p99_s", lambda s: report.three(1e6 * s)),
        Column("depth off by mm", "depth_mm", report.mm),
        Column("force ripples by %", "ripple", lambda x: report.three(100 * x)),
        Column("cutter location off by mm", "cl_mm", report.mm),
    )
    tolerances: list[float | None] = [None, 0.1, 0.01] if settings.quick else [None, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4]
    for tolerance in watched(tolerances, progress):
        figures = child("surfaces", tolerance=tolerance, count=40 if settings.quick else 400)
        name = "exact" if tolerance is None else f"triangles within {tolerance:g} mm"
        row = table.row(surface=name, tolerance=tolerance, **figures)
        if tolerance is None:
            out.check(row["depth_mm"] <= 1e-6, f"depth: {row['depth_mm']} mm off the closed form")
            out.check(row["ripple"] <= RIPPLE, f"force: ripples by {row['ripple']}")
    table.notes.append(
        f"A torus of {RING:g} mm and {TUBE:g} mm, a ball of {2 * RADIUS:g} mm, {DEPTH:g} mm deep. Depth and cutter "
        "location (the clearance 0.05 mm above the torus) are compared with the closed form. The ripple is half of "
        "largest minus smallest force, over their mean, at 200 places 0.02 mm apart along the torus."
    )
    return out
