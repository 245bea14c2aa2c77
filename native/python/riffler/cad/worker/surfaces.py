"""Converts the faces of bodies to rational B-spline patches with their borders in (u, v)."""

# Type checkers find no types for OCP.
# pyright: reportAttributeAccessIssue=false, reportMissingImports=false
from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert
from OCP.BRepTools import BRepTools, BRepTools_WireExplorer
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Pnt
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from .document import ContentError
from .healing import Healed

START = 8  # parts of an edge that are examined first
DEEPEST = 14  # halvings of each of them


def convert(healed: Healed, tolerance: float) -> tuple[list[dict[str, Any]], dict[str, np.ndarray]]:
    """Returns a record for each face, and arrays whose rows the records use one after the other: nets of points with
    weights (n, 4), knots (n,), and borders (n, 2)."""
    records: list[dict[str, Any]] = []
    points: list[np.ndarray] = []
    knots: list[np.ndarray] = []
    trims: list[np.ndarray] = []
    for body in healed.bodies:
        for face in body.faces:
            where = f"face {len(records)}{f' ({face.name})' if face.name else ''}"
            try:
                patch = _patch(face.shape, tolerance)
            except Standard_Failure as error:
                raise ContentError(f"{where} cannot be converted to B-splines ({error}); Mesh.read reads it") from error
            if patch is None:
                raise ContentError(f"{where} has triangles only, no exact surface; Mesh.read reads it")
            record, net, own, loops = patch
            points.append(net)
            knots += own
            trims += loops
            records.append({"name": face.name, "color": face.color or body.color, **record})
    arrays = {
        "nets": np.concatenate(points) if points else np.zeros((0, 4)),
        "knots": np.concatenate(knots) if knots else np.zeros(0),
        "trims": np.concatenate(trims) if trims else np.zeros((0, 2)),
    }
    return records, arrays


def _patch(face: Any, tolerance: float) -> tuple[dict[str, Any], np.ndarray, list[np.ndarray], list[np.ndarray]] | None:
    location = TopLoc_Location()
    if BRep_Tool.Surface_s(face, location) is None:
        return None
    made = TopoDS.Face(BRepBuilderAPI_NurbsConvert(face, True).Shape())
    surface = _surface(made)
    net = np.array(
        [
            [*surface.Pole(i, j).Coord(), surface.Weight(i, j)]
            for i in range(1, surface.NbUPoles() + 1)
            for j in range(1, surface.NbVPoles() + 1)
        ]
    )
    sequences = surface.UKnotSequence(), surface.VKnotSequence()
    knots = [np.array([row.Value(k) for k in range(row.Lower(), row.Upper() + 1)]) for row in sequences]
    loops = _loops(made, surface, tolerance)
    record = {
        "degrees": [surface.UDegree(), surface.VDegree()],
        "counts": [surface.NbUPoles(), surface.NbVPoles()],
        "loops": [len(loop) for loop in loops],
        "reversed": made.Orientation() == TopAbs_Orientation.TopAbs_REVERSED,
    }
    return record, net, knots, loops


def _surface(face: Any) -> Any:
    """The face's surface in its place, not periodic, over a domain that contains the face."""
    location = TopLoc_Location()
    surface = BRep_Tool.Surface_s(face, location)
    if not isinstance(surface, Geom_BSplineSurface):
        raise Standard_Failure(f"a {type(surface).__name__} remains")
    surface = surface.Copy()
    if not location.IsIdentity():
        surface.Transform(location.Transformation())
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    a0, a1, b0, b1 = surface.Bounds()
    small_u, small_v = 1e-9 * (a1 - a0), 1e-9 * (b1 - b0)
    beyond_u = surface.IsUPeriodic() and (u0 < a0 - small_u or u1 > a1 + small_u)
    beyond_v = surface.IsVPeriodic() and (v0 < b0 - small_v or v1 > b1 + small_v)
    if beyond_u or beyond_v:  # the seam is inside the face: begin the period at its border
        surface.Segment(
            u0 if beyond_u else a0, u0 + (a1 - a0) if beyond_u else a1,
            v0 if beyond_v else b0, v0 + (b1 - b0) if beyond_v else b1,
        )  # fmt: skip
    if surface.IsUPeriodic():
        surface.SetUNotPeriodic()
    if surface.IsVPeriodic():
        surface.SetVNotPeriodic()
    return surface


def _loops(face: Any, surface: Any, tolerance: float) -> list[np.ndarray]:
    u0, u1, v0, v1 = surface.Bounds()
    loops = []
    wires = TopExp_Explorer(face, TopAbs_ShapeEnum.TopAbs_WIRE)
    while wires.More():
        rows: list[tuple[float, float]] = []
        walk = BRepTools_WireExplorer(TopoDS.Wire(wires.Current()), face)
        while walk.More():
            rows += _edge(walk.Current(), face, surface, tolerance)[:-1]
            walk.Next()
        if len(rows) > 2:
            loops.append(np.clip(np.array(rows), (u0, v0), (u1, v1)))
        wires.Next()
    return loops


def _edge(edge: Any, face: Any, surface: Any, tolerance: float) -> list[tuple[float, float]]:
    """Parameters along an edge in the direction of its wire, so close together that the middle of each straight line
    between them is within the tolerance."""
    first, last = BRep_Tool.Range_s(edge, face)
    curve = BRep_Tool.CurveOnSurface_s(edge, face, first, last)
    if curve is None:
        raise Standard_Failure("an edge has no curve in its parameters")
    found = [curve.Value(first).Coord()]
    one, two = gp_Pnt(), gp_Pnt()

    def divide(t0: float, a: tuple[float, float], t1: float, b: tuple[float, float], deep: int) -> None:
        middle = 0.5 * (t0 + t1)
        exact, straight = curve.Value(middle).Coord(), (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]))
        surface.D0(*exact, one)
        surface.D0(*straight, two)
        if deep < DEEPEST and one.Distance(two) > 0.5 * tolerance:
            divide(t0, a, middle, exact, deep + 1)
            divide(middle, exact, t1, b, deep + 1)
        else:
            found.append(b)

    places = np.linspace(first, last, START + 1)
    for t0, t1 in pairwise(places):
        divide(float(t0), found[-1], float(t1), curve.Value(float(t1)).Coord(), 0)
    return found[::-1] if edge.Orientation() == TopAbs_Orientation.TopAbs_REVERSED else found
