"""Puts the parts that the reader returned in their places in the assembly, and makes the report."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._core import FormatError, Mesh
from .part import CadBody, CadFace, CadPart, CadReport

LARGEST = 1e30
UNUSUAL = 0.1, 20_000.0  # mm: a part smaller or larger than these may have the wrong unit


def assemble(
    answer: dict[str, Any], arrays: dict[str, np.ndarray], name: str, schema: str, tolerance: float, unit: str | None
) -> CadPart:
    """Makes the part from the reader's answer: a copy of every prototype in each of its places."""
    points, triangles, numbers = [], [], []
    faces: list[CadFace] = []
    bodies: list[CadBody] = []
    start = 0
    for instance in answer["instances"]:
        k = instance["prototype"]
        prototype = answer["prototypes"][k]
        matrix = np.array(instance["matrix"], float)
        rows = arrays[f"triangles{k}"]
        if np.linalg.det(matrix[:, :3]) < 0:  # mirrored: reverse the order of the corners
            rows = rows[:, ::-1]
        points.append(arrays[f"points{k}"] @ matrix[:, :3].T + matrix[:, 3])
        triangles.append(rows + start)
        numbers.append(arrays[f"faces{k}"] + len(faces))
        start += len(points[-1])
        colors = [instance["color"] or body["color"] for body in prototype["bodies"]]
        faces += [_face(face, colors, len(bodies)) for face in prototype["faces"]]
        bodies += [
            _body(body, color, instance["name"], prototype["name"])
            for body, color in zip(prototype["bodies"], colors, strict=True)
        ]
    vertices, corners = np.concatenate(points), np.concatenate(triangles).astype(np.int32)
    if not len(corners):
        raise FormatError(
            f"{name}: none of its {len(faces)} faces could be tessellated; export it again, as AP214 or AP242"
        )
    if not (abs(vertices) <= LARGEST).all():
        raise FormatError(f"{name}: a vertex is not finite or beyond 1e30; expected coordinates in mm")
    mesh = Mesh(vertices, corners)
    face_of_triangle = np.concatenate(numbers).astype(np.int32)
    face_of_triangle.flags.writeable = False
    report = _report(answer, mesh, bodies, faces, schema, tolerance, unit)
    return CadPart(mesh, face_of_triangle, tuple(faces), tuple(bodies), report)


def _rgb(color: list[float] | None) -> tuple[float, float, float] | None:
    return None if color is None else (float(color[0]), float(color[1]), float(color[2]))


def _face(face: dict[str, Any], colors: list[Any], first_body: int) -> CadFace:
    color = _rgb(face["color"] or colors[face["body"]])
    return CadFace(face["name"], color, face["kind"], face["area"], first_body + face["body"])


def _body(body: dict[str, Any], color: list[float] | None, path: str, part: str) -> CadBody:
    own = body["name"]
    label = path if not own or own == part else f"{path}/{own}" if path else own
    return CadBody(label, _rgb(color), body["solid"], body["volume"], body["area"], body["open_edges"])


def _report(
    answer: dict[str, Any],
    mesh: Mesh,
    bodies: list[CadBody],
    faces: list[CadFace],
    schema: str,
    tolerance: float,
    unit: str | None,
) -> CadReport:
    def total(key: str) -> int:
        return sum(answer["prototypes"][i["prototype"]][key] for i in answer["instances"])

    solids = sum(body.solid for body in bodies)
    counts = {key: total(key) for key in ("fixed", "sewn", "invalid", "left_out")}
    deviation = max((p["deviation"] for p in answer["prototypes"]), default=0.0)
    notes = [*answer["notes"], *(note for p in answer["prototypes"] for note in p["notes"])]
    if unit is not None and unit != answer["unit"]:
        notes.append(f"its numbers are taken in {unit}, as asked; it states {answer['unit']}")
    notes += _notes_on_bodies(bodies, faces)
    notes += _notes_on_healing(**counts)
    if deviation > tolerance:
        gap = max(body["edge_gap"] for p in answer["prototypes"] for body in p["bodies"])
        notes.append(
            f"{deviation:.3g} mm between faces and triangles were measured, more than the tolerance; the file's own "
            f"edges are up to {gap:.3g} mm from its faces"
        )
    size = float(np.ptp(mesh.bounds, axis=0).max())
    if not UNUSUAL[0] <= size <= UNUSUAL[1]:
        notes.append(f"its largest side is {size:.4g} mm: if its unit is wrong, unit= of riffler.cad.read sets another")
    return CadReport(
        schema=schema,
        unit=unit or answer["unit"],
        tolerance=tolerance,
        deviation=deviation,
        solids=solids,
        sheets=len(bodies) - solids,
        volume=sum(body.volume for body in bodies),
        area=sum(body.area for body in bodies),
        closed=solids == len(bodies) and not counts["left_out"] and not any(body.open_edges for body in bodies),
        notes=tuple(dict.fromkeys(notes)),
        seconds=answer["seconds"],
        **counts,
    )


def _notes_on_bodies(bodies: list[CadBody], faces: list[CadFace]) -> list[str]:
    notes = []
    sheets = [body for body in bodies if not body.solid]
    broken = [body for body in bodies if body.solid and body.open_edges]
    remedy = "Volume.from_mesh closes openings, or"
    if len(sheets) == len(bodies):
        notes.append(
            f"it has no solid: {_count(len(sheets), 'sheet', 'sheets')} of {_count(len(faces), 'face', 'faces')} with "
            f"{_open_edges(sheets)}; {remedy} export a solid"
        )
    elif sheets:
        notes.append(f"{_count(len(sheets), 'body is a sheet', 'bodies are sheets')} enclosing no material")
    if broken:
        notes.append(
            f"{_count(len(broken), 'solid has', 'solids have')} {_open_edges(broken)}, the first is "
            f"{broken[0].name or 'without a name'}; {remedy} mend it in the CAD system"
        )
    return notes


def _notes_on_healing(fixed: int, sewn: int, invalid: int, left_out: int) -> list[str]:
    notes = []
    if fixed:
        notes.append(f"{_count(fixed, 'face was', 'faces were')} invalid and mended")
    if sewn:
        notes.append(f"{_count(sewn, 'edge', 'edges')} joined where faces were only next to each other")
    if invalid:
        faces = _count(invalid, "face is", "faces are")
        notes.append(f"{faces} still invalid after healing: compare them with the CAD system")
    if left_out:
        notes.append(f"{_count(left_out, 'face was', 'faces were')} left out: they could not be tessellated")
    return notes


def _open_edges(bodies: list[CadBody]) -> str:
    return _count(sum(body.open_edges for body in bodies), "open edge", "open edges")


def _count(n: int, one: str, many: str) -> str:
    return f"{n:,} {one if n == 1 else many}".replace(",", "\u2009")
