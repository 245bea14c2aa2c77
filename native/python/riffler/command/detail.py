"""--detail: whether the mesh file of a volume gets all triangles, or only those that its shape needs."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import SurfaceReport, Volume
from .arguments import length
from .console import Console, number
from .parser import Parser

ALL = "all"
SHARE = 0.1  # default tolerance over pitch: below the error that the pitch causes on a curved surface


@dataclass(frozen=True)
class Detail:
    """Value of --detail; `tolerance` in mm, None for the default share of the pitch."""

    tolerance: float | None = None
    all: bool = False

    def of(self, volume: Volume) -> float | None:
        """Tolerance in mm; None for all triangles."""
        if self.all:
            return None
        return SHARE * volume.pitch if self.tolerance is None else self.tolerance


@dataclass(frozen=True)
class Written:
    """A mesh file of a volume."""

    triangles: int
    all_triangles: int
    tolerance: float | None

    def to_dict(self) -> dict[str, Any]:
        return {
            "triangles": self.triangles,
            "all_triangles": self.all_triangles,
            "mesh_tolerance": self.tolerance,
        }

    def __str__(self) -> str:
        return counted(self.triangles, self.all_triangles, self.tolerance)


NOT_MESHED = {"triangles": None, "all_triangles": None, "mesh_tolerance": None}  # for files that are not meshes


def add_detail(parser: Parser) -> None:
    parser.add_argument(
        "--detail",
        metavar="MM",
        help="largest distance from the mesh of all triangles, or all for that mesh (default: a tenth of the pitch)",
    )
    parser.offer("detail", (ALL,))


def detail_of(arguments: argparse.Namespace) -> Detail:
    text = arguments.detail
    if text is None:
        return Detail()
    if text == ALL:
        return Detail(all=True)
    try:
        return Detail(length(text, "--detail"))
    except ValueError as error:
        raise ValueError(f"{error}; --detail {ALL} writes all triangles") from None


def counted(triangles: int, all_triangles: int, tolerance: float | None) -> str:
    if tolerance is None:
        return number(triangles)
    return f"{number(triangles)} of {number(all_triangles)}, within {tolerance:g} mm (--detail {ALL} for all)"


def announce(out: Path, triangles: int, report: SurfaceReport, tolerance: float | None, console: Console) -> None:
    """Prints the number of triangles at the terminal, before the file is written."""
    said = counted(triangles, report.all_triangles, tolerance)
    if out.suffix.lower() == ".stl":
        said += f"; {size(triangles)}" + ("" if tolerance is None else f" instead of {size(report.all_triangles)}")
    console.announce(f"{out.name}: triangles {said}")


def size(triangles: int) -> str:
    """The size of a binary STL."""
    return f"{number(round((84 + 50 * triangles) / 1e6, 3))} MB"
