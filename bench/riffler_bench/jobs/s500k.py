"""S500k: half a million short moves, level and ramping, and ten million streamed: time, moves a second, memory."""

from __future__ import annotations

from .. import report
from ..measure import Progress, Settings, child, watched
from ..report import Column, Report


def run(settings: Settings, progress: Progress = None) -> Report:
    moves = 5_000 if settings.quick else 500_000
    out = Report("s500k", {"moves": moves})
    table = out.section(
        "moves",
        f"{moves:,} moves of 0.4 mm, flat Ø6, h = 0.5, block of 100 × 60 × 20 mm".replace(",", "\u2009"),
        Column("path", "path"),
        Column("threads", "threads"),
        Column("wall time", "wall_s", report.micro),
        Column("processor time", "cpu_s", report.micro),
        Column("moves/s", "moves_per_s", lambda n: f"{n:,.0f}".replace(",", "\u2009")),
        Column("peak memory", "peak_bytes", report.megabytes),
        Column("removed mm³", "removed", lambda v: f"{v:.1f}"),
        Column("÷ z", "ratio", report.ratio),
    )
    calls = 20
    cases = [(path, threads) for path in ("level", "ramping", f"ramping, {calls} calls") for threads in (1, None)]
    for path, threads in watched(cases, progress):
        many = path not in ("level", "ramping")
        if many:
            r = child("streamed", threads, moves=moves, calls=calls)
        else:
            r = child("s500k", threads, moves=moves, ramping=path == "ramping")
        table.row(
            path=path,
            threads="1" if threads else "all",
            moves_per_s=moves * (calls if many else 1) / r["wall_s"],
            **r,
        )
        off = abs(r["removed"] - r["lost"])
        out.check(off <= 1e-9 * r["lost"], f"removed sums to {r['removed']}, the volume lost {r['lost']}")
    for path in ("level", "ramping"):
        one, three = (child("s500k", 1, moves=moves, ramping=path == "ramping", directions=d) for d in ("z", "xyz"))
        ratio = three["cpu_s"] / one["cpu_s"]
        table.row(path=f"{path}, xyz", threads="1", moves_per_s=moves / three["wall_s"], ratio=ratio, **three)
        out.check(three["removed"] == one["removed"], f"{path}: z and xyz differ")
    table.notes.append("Memory is the peak of a whole process, with Python, numpy and the poses (24 MB).")
    return out
