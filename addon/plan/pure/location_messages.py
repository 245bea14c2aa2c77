"""Messages about cutter locations for the lists of plan/findings.py: where the tool was lifted, and where no
collision-free location exists."""

from __future__ import annotations

import numpy as np

from ...common import units

ORDER = ("blocked", "unsafe", "lifted", "inserted")  # what blocks a program comes first


def entries(path: int, centres: np.ndarray, cl: np.ndarray, report) -> list[dict]:
    """Findings of a riffler.plan.LocationReport of the path with this number, from 0, and these points (n, 3) mm."""
    out = []
    for reason, points in _blocked(report.blocked):
        where = f"point {points[0]}" if len(points) == 1 else f"{len(points)} points from {points[0]} on"
        out.append(_entry(path, "blocked", points[0], centres[points[0]], f"{where}: {reason}"))
    for row, least, _, reason in report.unsafe:
        point = _point(report.points, row)
        out.append(_entry(path, "unsafe", point, centres[point], f"after point {point}: {reason} ({_mm(least)})"))
    for first, last in _runs(report.lifted):
        worst = first + int(np.argmax(report.lift[first : last + 1]))
        what = f"{_rows(last - first + 1)} lifted by up to {_mm(report.lift[worst])}, off the {report.pieces[worst]}"
        out.append(_entry(path, "lifted", _point(report.points, worst), cl[worst, :3], what))
    if len(report.inserted):
        first = int(report.inserted[0])
        point = _point(report.points, first)
        out.append(
            _entry(path, "inserted", point, cl[first, :3], f"{_rows(len(report.inserted))} inserted between its points")
        )
    return out


def left(reports, tolerance: float) -> str:
    """A message about lifts on collision-free paths, or "". A lift by more than the tolerance leaves material on the
    path."""
    lifts = np.concatenate([np.empty(0), *(np.asarray(r.lift, float) for r in reports)])
    lifts = lifts[lifts > tolerance]
    if not len(lifts):
        return ""
    are = "is" if len(lifts) == 1 else "are"
    return f"{_rows(len(lifts))} {are} lifted by up to {_mm(lifts.max())}: material stays"


def entered(path: int, place: np.ndarray, gap: float, name: str) -> dict:
    """A finding of a path whose poses enter a fixture, with `gap` (negative mm)."""
    return _entry(path, "blocked", 0, place, f"the tool enters {name}, {_mm(-gap)} deep")


def without_key(path: int, point: int, place: np.ndarray, reason: str) -> dict:
    """A finding of a path without a free orientation at this point."""
    return _entry(path, "blocked", point, place, f"no key, point {point}: {reason}")


def renumbered(entry: dict, path: int) -> dict:
    """The finding with the path's new number, from 0."""
    _, what = entry["name"].split(", ", 1)
    return {**entry, "path": path, "name": f"Path {path + 1}, {what}"}


def ordered(found: list[dict]) -> list[dict]:
    return sorted(found, key=lambda e: (ORDER.index(e["kind"]), e["path"], e["point"]))


def _entry(path, kind, point, place, what):
    place = tuple(float(x) for x in place)
    return {"kind": kind, "path": path, "point": int(point), "place": place, "name": f"Path {path + 1}, {what}"}


def _rows(count):
    return units.counted(count, "row")


def _mm(value):
    return f"{units.trim(float(value), 3)} mm"


def _blocked(blocked):
    """Neighbouring points with the same reason are one finding: [(reason, points)]."""
    out: list[tuple[str, list[int]]] = []
    for point, reason in blocked:
        if out and reason == out[-1][0] and point == out[-1][1][-1] + 1:
            out[-1][1].append(int(point))
        else:
            out.append((reason, [int(point)]))
    return out


def _runs(rows):
    if not len(rows):
        return []
    cuts = np.flatnonzero(np.diff(rows) > 1)
    return list(zip(rows[np.append(0, cuts + 1)].tolist(), rows[np.append(cuts, len(rows) - 1)].tolist(), strict=True))


def _point(points, row):
    """The path's point at a row, or the last point before the row."""
    known = np.asarray(points)[: row + 1]
    known = known[known >= 0]
    return int(known[-1]) if len(known) else 0
