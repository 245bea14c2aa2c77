"""Reads one file: the document, healing, tessellation, and the answer for the caller."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from .document import ContentError, Prototype, read_document
from .healing import Healed, heal
from .surfaces import convert
from .tessellation import tessellate

Report = Callable[[str, float], None]


def run(request: dict[str, Any], folder: Path, report: Report) -> dict[str, Any]:
    """Returns the answer as data for JSON, and writes the arrays of all prototypes to ``folder / "arrays.npz"``."""
    try:
        return _run(request, folder, report)
    except ContentError as bad:
        return {"error": "format", "message": str(bad)}


def _run(request: dict[str, Any], folder: Path, report: Report) -> dict[str, Any]:
    start = time.perf_counter()
    document = read_document(request["path"], request["kind"], lambda share: report("read", 0.3 * share))
    scale = request["unit_mm"] / document.unit_mm if request["unit_mm"] else 1.0
    tolerance = request["tolerance"] / scale  # in OpenCASCADE's unit of length
    seconds = {"read": time.perf_counter() - start}
    arrays: dict[str, np.ndarray] = {}
    prototypes = []
    triangles = 0
    count = len(document.prototypes)
    for number, prototype in enumerate(document.prototypes):
        report("tessellate", 0.3 + 0.65 * number / count)
        start = time.perf_counter()
        healed = heal(prototype, tolerance)
        seconds["heal"] = seconds.get("heal", 0.0) + time.perf_counter() - start
        answer: dict[str, Any] = {}
        prototypes.append(answer)
        if request["borders"]:
            answer |= _surfaces(healed, number, request["borders"] / scale, scale, arrays, seconds)
        if not request["mesh"]:
            continue
        answer |= _mesh(prototype, healed, number, tolerance, scale, arrays, seconds)
        triangles += document.copies(number) * len(arrays[f"triangles{number}"])
        if triangles > request["max_triangles"]:
            raise ContentError(
                f"more than {request['max_triangles']:,} triangles within {request['tolerance']:g} mm, copies counted; "
                "a larger tolerance needs fewer, or read the bodies one at a time"
            )
    report("write", 0.96)
    np.savez(folder / "arrays.npz", **arrays)  # pyright: ignore[reportArgumentType]
    return {
        "unit": document.unit,
        "schema": document.schema,
        "prototypes": prototypes,
        "instances": [
            {"prototype": i.prototype, "matrix": _scaled(i.matrix, scale), "name": i.name, "color": i.color}
            for i in document.instances
        ],
        "notes": document.notes,
        "seconds": seconds,
    }


def _scaled(matrix: list[list[float]], scale: float) -> list[list[float]]:
    return [[*row[:3], row[3] * scale] for row in matrix]


def _surfaces(
    healed: Healed,
    number: int,
    tolerance: float,
    scale: float,
    arrays: dict[str, np.ndarray],
    seconds: dict[str, float],
) -> dict[str, Any]:
    start = time.perf_counter()
    patches, made = convert(healed, tolerance)
    seconds["convert"] = seconds.get("convert", 0.0) + time.perf_counter() - start
    made["nets"][:, :3] *= scale
    arrays.update({f"{name}{number}": array for name, array in made.items()})
    return {"patches": patches}


def _mesh(
    prototype: Prototype,
    healed: Healed,
    number: int,
    tolerance: float,
    scale: float,
    arrays: dict[str, np.ndarray],
    seconds: dict[str, float],
) -> dict[str, Any]:
    start = time.perf_counter()
    meshed = tessellate(healed, tolerance)
    seconds["tessellate"] = seconds.get("tessellate", 0.0) + time.perf_counter() - start
    arrays[f"points{number}"] = meshed.points * scale
    arrays[f"triangles{number}"] = meshed.triangles
    arrays[f"faces{number}"] = meshed.face_of_triangle
    for body in meshed.bodies:
        body["volume"] *= scale**3
        body["area"] *= scale**2
        body["edge_gap"] *= scale
    for face in meshed.faces:
        face["area"] *= scale**2
    return {
        "name": prototype.name,
        "bodies": meshed.bodies,
        "faces": meshed.faces,
        "fixed": healed.fixed,
        "sewn": healed.sewn,
        "invalid": healed.invalid,
        "deviation": meshed.deviation * scale,
        "left_out": meshed.left_out,
        "notes": healed.notes,
    }
