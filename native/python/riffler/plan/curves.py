"""Curves from files, for strategies that follow curves."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import _core, files
from ..hints import hinted

FORMATS = (".obj", ".txt", ".xyz", ".csv", ".json")


@hinted("plan.read_curves")
def read_curves(path: str | os.PathLike[str]) -> list[NDArray[np.float64]]:
    """The curves of a file.

    Parameters
    ----------
    path : path_like
        ``.obj``: the polylines of its ``l`` elements; those that share an end are one curve. ``.txt``, ``.xyz``,
        ``.csv``: x, y and z of a point on each line, with blanks, commas or semicolons between them; an empty line
        begins another curve, ``#`` a comment. ``.json``: a list of curves, each a list of points [x, y, z].

    Returns
    -------
    list of ndarray, shape (n, 3)
        Points of each curve, mm.

    Raises
    ------
    FormatError
        Naming the file and the place.
    ValueError
        For another kind of file.

    Examples
    --------
    >>> from pathlib import Path
    >>> _ = Path("line.csv").write_text("0, 0, 5" + chr(10) + "9, 0, 5")
    >>> riffler.plan.read_curves("line.csv")
    [array([[0., 0., 5.],
           [9., 0., 5.]])]
    """
    target = Path(path)
    kind = target.suffix.lower()
    if kind not in FORMATS:
        raise ValueError(f"{target.name}: {' or '.join(FORMATS)} expected")
    text = files.read(target).decode("utf-8-sig", errors="replace")
    read = {".obj": _of_obj, ".json": _of_json}.get(kind, _of_columns)
    try:
        curves = [np.array(curve, dtype=float) for curve in read(text)]
    except _WrongPlaceError as error:
        raise _core.FormatError(f"{target.name}: {error}") from None
    if not curves:
        what = "no polyline (an l element; in Blender: convert the curve to a mesh)" if kind == ".obj" else "no curve"
        raise _core.FormatError(f"{target.name}: {what}")
    for k, curve in enumerate(curves):
        if len(curve) < 2:
            raise _core.FormatError(f"{target.name}: curve {k} has one point only")
    return curves


class _WrongPlaceError(ValueError):
    """An error at a place of a file."""


def _point(words, place: str) -> list[float]:
    try:
        point = [float(word) for word in words]
    except (ValueError, TypeError):
        point = []
    if len(point) != 3 or not np.isfinite(point).all():
        raise _WrongPlaceError(f"{place}: three numbers expected")
    return point


def _of_columns(text: str) -> list[list[list[float]]]:
    curves: list[list[list[float]]] = [[]]
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition("#")[0].replace(",", " ").replace(";", " ").split()
        if words:
            curves[-1].append(_point(words, f"line {number}"))
        elif not line.strip() and curves[-1]:
            curves.append([])
    return [curve for curve in curves if curve]


def _of_json(text: str) -> list[list[list[float]]]:
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise _WrongPlaceError(str(error)) from None
    if not isinstance(data, list) or not all(isinstance(curve, list) for curve in data):
        raise _WrongPlaceError("a list of curves expected, each a list of points [x, y, z]")
    return [
        [_point(p if isinstance(p, list) else (), f"curve {c}, point {k}") for k, p in enumerate(curve)]
        for c, curve in enumerate(data)
    ]


def _of_obj(text: str) -> list[np.ndarray]:
    points: list[list[float]] = []
    pieces: list[list[int]] = []
    for number, line in enumerate(text.splitlines(), 1):
        word, *rest = line.split() or [""]
        if word == "v":
            points.append(_point(rest[:3], f"line {number}"))
        elif word == "l":
            pieces.append([_index(entry, len(points), f"line {number}") for entry in rest])
            if len(pieces[-1]) < 2:
                raise _WrongPlaceError(f"line {number}: two vertices or more expected")
    return [np.array([points[i] for i in line]) for line in _joined(pieces)]


def _index(entry: str, count: int, place: str) -> int:
    try:
        index = int(entry.partition("/")[0])
    except ValueError:
        index = 0
    index = index - 1 if index > 0 else count + index
    if not 0 <= index < count:
        raise _WrongPlaceError(f"{place}: {entry} is not a vertex above it")
    return index


def _joined(pieces: list[list[int]]) -> list[list[int]]:
    """Joins polylines that share an end with exactly one other, in the order of their first pieces."""
    at: dict[int, list[int]] = {}
    for k, piece in enumerate(pieces):
        for end in {piece[0], piece[-1]} if piece[0] != piece[-1] else ():
            at.setdefault(end, []).append(k)
    left = [True] * len(pieces)

    def grown(line: list[int]) -> list[int]:
        """Appends the pieces that follow the line's last vertex; returns the same list."""
        while len(at.get(line[-1], ())) == 2:
            following = next((k for k in at[line[-1]] if left[k]), None)
            if following is None:
                break
            left[following] = False
            piece = pieces[following]
            line += (piece if piece[0] == line[-1] else piece[::-1])[1:]
        return line

    out = []
    for k, piece in enumerate(pieces):
        if left[k]:
            left[k] = False
            forward = grown(list(piece))
            out.append(forward if forward[0] == forward[-1] else grown(forward[::-1])[::-1])
    return out
