"""Mends shapes: repairs faces that OpenCASCADE reports as invalid, and joins surfaces that only touch each other."""

# Type checkers find no types for OCP.
# pyright: reportAttributeAccessIssue=false, reportMissingImports=false
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepLib import BRepLib
from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap
from OCP.ShapeFix import ShapeFix_Shape, ShapeFix_Solid
from OCP.TopAbs import TopAbs_ShapeEnum as Kind
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS

from .document import Color, Prototype

LEAST_GAP, MOST_GAP = 1e-3, 0.02  # limits of the gap that sewing closes, mm; between them it is the chord tolerance
RELATIVE_GAP = 1e-3  # largest gap that sewing closes, as a share of the part's size


@dataclass
class Face:
    """A face with its name and colour in the file."""

    shape: Any
    name: str = ""
    color: Color | None = None


@dataclass
class Body:
    """A solid, or faces that do not enclose a solid."""

    shape: Any
    solid: bool
    name: str
    color: Color | None
    faces: list[Face] = field(default_factory=list)


@dataclass
class Healed:
    bodies: list[Body]
    fixed: int = 0
    """Number of faces that were changed."""
    sewn: int = 0
    """Number of edges at which two faces were joined."""
    invalid: int = 0
    """Number of faces that are still invalid."""
    notes: list[str] = field(default_factory=list)


def shapes_of(shape: Any, kind: Any) -> list[Any]:
    """Each shape of a kind once, in the file's order, with the orientation of its first occurrence."""
    found = ShapeMap()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(k) for k in range(1, found.Extent() + 1)]


def heal(prototype: Prototype, tolerance: float) -> Healed:
    named = _Attributes(prototype)
    shape = prototype.shape
    healed = Healed([])
    if not BRepCheck_Analyzer(shape).IsValid():
        fix = ShapeFix_Shape(shape)
        fix.Perform()
        context, fixed = fix.Context(), fix.Shape()
        if fixed is not None and not fixed.IsNull():
            before = shapes_of(shape, Kind.TopAbs_FACE)
            healed.fixed = sum(not context.Apply(face).IsSame(face) for face in before)
            named.follow(lambda part: context.Apply(part))
            shape = fixed
    gap = _gap(shape, tolerance)
    loose = _loose_faces(shape)
    for solid in shapes_of(shape, Kind.TopAbs_SOLID):
        for body in _mended(solid, gap, named, healed):
            named.describe(body, solid)
            healed.bodies.append(body)
    if loose:
        for body in _sewn(loose, gap, named, healed):
            named.describe(body, body.shape)
            healed.bodies.append(body)
    for body in healed.bodies:
        for face in body.faces:
            healed.invalid += not BRepCheck_Analyzer(face.shape).IsValid()
    return healed


def _gap(shape: Any, tolerance: float) -> float:
    """Largest gap that sewing closes, mm: the chord tolerance, within limits, and small compared with the part."""
    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box, False)
    size = 0.0 if box.IsVoid() else box.SquareExtent() ** 0.5
    return max(1e-7, min(max(tolerance, LEAST_GAP), MOST_GAP, RELATIVE_GAP * size))


class _Attributes:
    """Names and colours by shape; they follow the shapes through healing."""

    def __init__(self, prototype: Prototype) -> None:
        self.prototype = prototype
        self.parts = [(shape, name, color) for shape, name, color in prototype.parts]
        self._index()

    def follow(self, change: Any) -> None:
        moved = [(change(shape), name, color) for shape, name, color in self.parts]
        self.parts = [entry for entry in moved if entry[0] is not None and not entry[0].IsNull()]
        self._index()

    def _index(self) -> None:
        self.map, self.of = ShapeMap(), {}
        for shape, name, color in self.parts:
            inside = [shape]
            if shape.ShapeType() not in (Kind.TopAbs_FACE, Kind.TopAbs_SOLID):
                inside += shapes_of(shape, Kind.TopAbs_FACE)  # a coloured shell, or a fixed face that became several
            for part in inside:
                number = self.map.Add(part)
                old_name, old_color = self.of.get(number, ("", None))
                self.of[number] = (name or old_name, color or old_color)

    def find(self, shape: Any) -> tuple[str, Color | None]:
        return self.of.get(self.map.FindIndex(shape), ("", None))

    def describe(self, body: Body, solid: Any) -> None:
        name, color = self.find(solid)
        body.name = name or self.prototype.name
        body.color = color or self.prototype.color
        for face in body.faces:
            face.name, face.color = self.find(face.shape)


def _faces(shape: Any) -> list[Face]:
    return [Face(TopoDS.Face(face)) for face in shapes_of(shape, Kind.TopAbs_FACE)]


def _loose_faces(shape: Any) -> list[Any]:
    """Faces that do not belong to a solid."""
    inside = ShapeMap()
    for solid in shapes_of(shape, Kind.TopAbs_SOLID):
        TopExp.MapShapes_s(solid, Kind.TopAbs_FACE, inside)
    return [face for face in shapes_of(shape, Kind.TopAbs_FACE) if not inside.Contains(face)]


def open_edges(shape: Any) -> int:
    """Number of edges that belong to one face only. Seams and poles do not count."""
    edges, uses = ShapeMap(), {}
    for face in shapes_of(shape, Kind.TopAbs_FACE):
        walk = TopExp_Explorer(face, Kind.TopAbs_EDGE)
        while walk.More():
            number = edges.Add(walk.Current())
            uses[number] = uses.get(number, 0) + 1
            walk.Next()
    return sum(n == 1 and not BRep_Tool.Degenerated_s(TopoDS.Edge(edges.FindKey(k))) for k, n in uses.items())


def _mended(solid: Any, gap: float, named: _Attributes, healed: Healed) -> list[Body]:
    """The solid itself or, if its faces are not joined all around, the bodies that sewing makes of them."""
    if open_edges(solid) == 0:
        return [Body(solid, True, "", None, _faces(solid))]
    before = open_edges(solid)
    pieces = _sewn(shapes_of(solid, Kind.TopAbs_FACE), gap, named, healed)
    if sum(open_edges(piece.shape) for piece in pieces) < before:
        return pieces
    return [Body(solid, True, "", None, _faces(solid))]


def _sewn(faces: list[Any], gap: float, named: _Attributes, healed: Healed) -> list[Body]:
    sewing = BRepBuilderAPI_Sewing(gap)
    for face in faces:
        sewing.Add(face)
    sewing.Perform()
    whole = sewing.SewedShape()
    if whole is None or whole.IsNull() or not shapes_of(whole, Kind.TopAbs_FACE):
        healed.notes.append(f"{len(faces)} faces could not be joined")
        return [Body(face, False, "", None, _faces(face)) for face in faces]
    healed.sewn += sewing.NbContigousEdges()
    named.follow(lambda part: sewing.ModifiedSubShape(part) if sewing.IsModifiedSubShape(part) else part)
    bodies = []
    shells = shapes_of(whole, Kind.TopAbs_SHELL)
    for shell in shells:
        if open_edges(shell) == 0:
            solid = ShapeFix_Solid().SolidFromShell(TopoDS.Shell(shell))
            if solid is not None and not solid.IsNull():
                BRepLib.OrientClosedSolid_s(solid)
                bodies.append(Body(solid, True, "", None, _faces(solid)))
                continue
        bodies.append(Body(shell, False, "", None, _faces(shell)))
    inside = ShapeMap()
    for shell in shells:
        TopExp.MapShapes_s(shell, Kind.TopAbs_FACE, inside)
    bodies += [
        Body(face, False, "", None, _faces(face))
        for face in shapes_of(whole, Kind.TopAbs_FACE)
        if not inside.Contains(face)
    ]
    return bodies
