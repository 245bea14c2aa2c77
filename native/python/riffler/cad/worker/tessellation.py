"""Tessellates bodies within the chord tolerance. Faces that meet share vertices, because an edge has one polygon that
all its faces use."""

# Type checkers find no types for OCP.
# pyright: reportAttributeAccessIssue=false, reportMissingImports=false
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepGProp import BRepGProp
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.collections import IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher as ShapeMap
from OCP.gp import gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.IMeshTools import IMeshTools_Parameters
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from .healing import Body, Healed

ANGLE = 0.5  # largest angle between neighbouring chords, rad: keeps small arcs round
ATTEMPTS = 4  # number of attempts, each with a smaller deflection
SAMPLES = 8_000  # largest number of triangles of a body at which the deviation is measured


@dataclass
class Meshed:
    points: np.ndarray
    triangles: np.ndarray
    face_of_triangle: np.ndarray
    bodies: list[dict[str, Any]] = field(default_factory=list)
    faces: list[dict[str, Any]] = field(default_factory=list)
    deviation: float = 0.0
    left_out: int = 0


@dataclass
class Pieces:
    """The triangles of one body."""

    points: np.ndarray
    triangles: np.ndarray
    face_of_triangle: np.ndarray
    left_out: list[int]
    open_edges: int
    deviation: float = 0.0


def tessellate(healed: Healed, tolerance: float) -> Meshed:
    points, triangles, numbers = [], [], []
    meshed = Meshed(np.zeros((0, 3)), np.zeros((0, 3), np.int32), np.zeros(0, np.int32))
    start = 0
    for number, body in enumerate(healed.bodies):
        pieces = body_mesh(body, tolerance)
        points.append(pieces.points)
        triangles.append(pieces.triangles + start)
        numbers.append(pieces.face_of_triangle + len(meshed.faces))
        start += len(pieces.points)
        meshed.deviation = max(meshed.deviation, pieces.deviation)
        meshed.left_out += len(pieces.left_out)
        meshed.faces += [_face(face, number) for face in body.faces]
        meshed.bodies.append(_body(body, pieces))
    meshed.points = np.concatenate(points) if points else meshed.points
    meshed.triangles = np.concatenate(triangles).astype(np.int32) if points else meshed.triangles
    meshed.face_of_triangle = np.concatenate(numbers).astype(np.int32) if points else meshed.face_of_triangle
    return meshed


def _body(body: Body, pieces: Pieces) -> dict[str, Any]:
    volume, area = GProp_GProps(), GProp_GProps()
    BRepGProp.SurfaceProperties_s(body.shape, area, False, False)
    if body.solid:
        BRepGProp.VolumeProperties_s(body.shape, volume, False, False, False)
    return {
        "name": body.name,
        "color": body.color,
        "solid": body.solid,
        "volume": _finite(volume.Mass()) if body.solid else 0.0,
        "area": _finite(area.Mass()),
        "open_edges": pieces.open_edges,
        "edge_gap": _edge_gap(body),
    }


def _edge_gap(body: Body) -> float:
    """Largest distance of edges from their faces, mm, as stated by the file or by healing."""
    edges = ShapeMap()
    TopExp.MapShapes_s(body.shape, TopAbs_ShapeEnum.TopAbs_EDGE, edges)
    return max(
        (BRep_Tool.Tolerance_s(TopoDS.Edge(edges.FindKey(k))) for k in range(1, edges.Extent() + 1)), default=0.0
    )


def _face(face: Any, body: int) -> dict[str, Any]:
    area = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face.shape, area, False, False)
    location = TopLoc_Location()
    kind = "mesh"
    if BRep_Tool.Surface_s(face.shape, location) is not None:
        kind = str(BRepAdaptor_Surface(face.shape, False).GetType()).rsplit("_", 1)[-1].lower()
    return {
        "name": face.name,
        "color": face.color,
        "kind": KINDS.get(kind, kind),
        "area": _finite(area.Mass()),
        "body": body,
    }


KINDS = {
    "beziersurface": "bezier", "bsplinesurface": "bspline", "surfaceofrevolution": "revolution",
    "surfaceofextrusion": "extrusion", "offsetsurface": "offset", "othersurface": "other",
}  # fmt: skip


def _finite(value: float) -> float:
    return value if math.isfinite(value) else 0.0


def body_mesh(body: Body, tolerance: float) -> Pieces:
    """Tries smaller deflections until the measured deviation is within the tolerance and a solid's mesh is closed."""
    best = None
    deflection, enough = tolerance, math.inf
    for _ in range(ATTEMPTS):
        _mesh(body, deflection)
        pieces = _extract(body)
        pieces.deviation = _deviation(body, pieces)
        if best is None or _worth(pieces, tolerance) < _worth(best, tolerance):
            best = pieces
        whole = not (body.solid and pieces.open_edges) and not pieces.left_out
        if whole and (pieces.deviation <= tolerance or pieces.deviation > enough):
            break
        finer = min(0.9 if whole else 0.5, max(0.25, 0.9 * tolerance / max(pieces.deviation, tolerance)))
        deflection *= finer
        # If the deviation falls much less than the deflection, the deflection is not its cause: the mesher misses a
        # feature, or the file has gaps between edges and faces. Even finer meshes would only be larger.
        enough = 0.5 * (1 + finer) * pieces.deviation
    assert best is not None
    return best


def _worth(pieces: Pieces, tolerance: float) -> tuple[int, int, float]:
    return len(pieces.left_out), pieces.open_edges, max(pieces.deviation, tolerance)


def _mesh(body: Body, deflection: float) -> None:
    location = TopLoc_Location()
    if any(BRep_Tool.Surface_s(face.shape, location) is None for face in body.faces):
        return  # the face has only triangles, as in AP242's tessellated solids
    BRepTools.Clean_s(body.shape, True)
    parameters = IMeshTools_Parameters()
    parameters.Deflection = parameters.DeflectionInterior = deflection
    parameters.Angle = parameters.AngleInterior = ANGLE
    parameters.MinSize = min(0.1 * deflection, 1e-3)
    parameters.InParallel = True
    parameters.ControlSurfaceDeflection = True
    parameters.ForceFaceDeflection = True  # otherwise gaps in the file make the mesh coarser than requested
    BRepMesh_IncrementalMesh(body.shape, parameters)


class _Vertices:
    """Numbers the vertices of a body's mesh: corners of the body, inner points of edges, and inner nodes of faces."""

    def __init__(self, body: Body) -> None:
        self.corners, self.edges = ShapeMap(), ShapeMap()
        TopExp.MapShapes_s(body.shape, TopAbs_ShapeEnum.TopAbs_VERTEX, self.corners)
        self.points: list[tuple[float, float, float] | None] = [None] * self.corners.Extent()
        self.along: dict[int, list[int]] = {}

    def of_edge(self, edge: Any, count: int) -> list[int]:
        """Numbers of the points of an edge's polygon. They are the same for all faces at the edge."""
        number = self.edges.Add(edge)
        known = self.along.get(number)
        if known is not None and len(known) == count:
            return known
        first = self._corner(TopExp.FirstVertex_s(edge, False))
        last = self._corner(TopExp.LastVertex_s(edge, False))
        if BRep_Tool.Degenerated_s(edge):
            made = [first] * count
        else:
            made = [first, *(self.new() for _ in range(count - 2)), last]
        self.along.setdefault(number, made)
        return made

    def _corner(self, vertex: Any) -> int:
        number = self.corners.FindIndex(vertex) if not vertex.IsNull() else 0
        return number - 1 if number > 0 else self.new()

    def new(self) -> int:
        self.points.append(None)
        return len(self.points) - 1


def _extract(body: Body) -> Pieces:
    vertices = _Vertices(body)
    triangles, faces, left_out = [], [], []
    for number, face in enumerate(body.faces):
        location = TopLoc_Location()
        mesh = BRep_Tool.Triangulation_s(face.shape, location)
        if mesh is None or mesh.NbTriangles() == 0:
            left_out.append(number)
            continue
        rows = _face_triangles(face.shape, mesh, location, vertices)
        triangles.append(rows)
        faces.append(np.full(len(rows), number, np.int32))
    points = np.array([p if p is not None else (math.nan,) * 3 for p in vertices.points], float).reshape(-1, 3)
    rows = np.concatenate(triangles) if triangles else np.zeros((0, 3), np.int64)
    numbers = np.concatenate(faces) if faces else np.zeros(0, np.int32)
    used, inverse = np.unique(rows, return_inverse=True)
    return Pieces(points[used], inverse.reshape(-1, 3).astype(np.int64), numbers, left_out, count_open(rows))


def _face_triangles(face: Any, mesh: Any, location: Any, vertices: _Vertices) -> np.ndarray:
    """(k, 3) numbers of vertices, counter-clockwise seen from outside. Leaves out triangles without area at poles."""
    place = location.Transformation()
    nodes: list[int] = [-1] * (mesh.NbNodes() + 1)
    walk = TopExp_Explorer(face, TopAbs_ShapeEnum.TopAbs_EDGE)
    while walk.More():
        edge = TopoDS.Edge(walk.Current())
        polygon = BRep_Tool.PolygonOnTriangulation_s(edge, mesh, location)
        if polygon is not None:
            count = polygon.NbNodes()
            for k, number in enumerate(vertices.of_edge(edge, count), 1):
                nodes[polygon.Node(k)] = number
        walk.Next()
    for k in range(1, len(nodes)):
        if nodes[k] < 0:
            nodes[k] = vertices.new()
        if vertices.points[nodes[k]] is None:
            vertices.points[nodes[k]] = mesh.Node(k).Transformed(place).Coord()
    corners = np.array([mesh.Triangle(k).Get() for k in range(1, mesh.NbTriangles() + 1)], np.int64)
    rows = np.array(nodes, np.int64)[corners]
    if (face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED) != place.IsNegative():
        rows = rows[:, ::-1]
    same = (rows[:, 0] == rows[:, 1]) | (rows[:, 1] == rows[:, 2]) | (rows[:, 2] == rows[:, 0])
    return rows[~same]


def count_open(rows: np.ndarray) -> int:
    """Number of edges where the surface ends: triangles there do not use both directions of the edge equally often."""
    if not len(rows):
        return 0
    edges = np.concatenate([rows[:, [0, 1]], rows[:, [1, 2]], rows[:, [2, 0]]]).astype(np.int64)
    forward = edges[:, 0] < edges[:, 1]
    key = edges.min(1) * (int(rows.max()) + 1) + edges.max(1)
    _, inverse = np.unique(key, return_inverse=True)
    return int((np.bincount(inverse, np.where(forward, 1, -1)) != 0).sum())


def _deviation(body: Body, pieces: Pieces) -> float:
    """Largest distance of the surface from its triangles at middles of triangles and sides, in OpenCASCADE's unit."""
    total = 0
    for face in body.faces:
        mesh = BRep_Tool.Triangulation_s(face.shape, TopLoc_Location())
        total += mesh.NbTriangles() if mesh is not None else 0
    stride = max(1, total // SAMPLES)
    return max((_face_deviation(face.shape, stride) for face in body.faces), default=0.0)


def _pole_nodes(face: Any, mesh: Any, location: Any) -> set[int]:
    """Nodes at poles. One of their parameters is arbitrary, so mean parameters would lie outside of the triangle."""
    found: set[int] = set()
    walk = TopExp_Explorer(face, TopAbs_ShapeEnum.TopAbs_EDGE)
    while walk.More():
        edge = TopoDS.Edge(walk.Current())
        if BRep_Tool.Degenerated_s(edge):
            polygon = BRep_Tool.PolygonOnTriangulation_s(edge, mesh, location)
            if polygon is not None:
                found.update(polygon.Node(k) for k in range(1, polygon.NbNodes() + 1))
        walk.Next()
    return found


def _face_deviation(face: Any, stride: int) -> float:
    location = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, location)
    if mesh is None or not mesh.HasUVNodes() or BRep_Tool.Surface_s(face, TopLoc_Location()) is None:
        return 0.0
    surface = BRepAdaptor_Surface(face, False)
    place = location.Transformation()
    poles = _pole_nodes(face, mesh, location)
    corners, params = [], []
    for k in range(1, mesh.NbTriangles() + 1, stride):
        three = mesh.Triangle(k).Get()
        if not poles.isdisjoint(three):
            continue
        corners.append([mesh.Node(n).Transformed(place).Coord() for n in three])
        params.append([mesh.UVNode(n).Coord() for n in three])
    if not corners:
        return 0.0
    xyz, uv = np.array(corners), np.array(params)
    a, b, c = xyz[:, 0], xyz[:, 1], xyz[:, 2]
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    worst = 0.0
    point = gp_Pnt()
    for weights in ((1 / 3, 1 / 3, 1 / 3), (0.5, 0.5, 0), (0, 0.5, 0.5), (0.5, 0, 0.5)):
        places = np.einsum("j,kji->ki", np.array(weights), uv)
        exact = np.empty((len(places), 3))
        for row, (u, v) in enumerate(places):
            surface.D0(u, v, point)
            exact[row] = point.Coord()
        flat = np.einsum("j,kji->ki", np.array(weights), xyz)
        gap = np.linalg.norm(exact - flat, axis=1)
        good = length > 1e-12
        gap[good] = np.minimum(gap[good], abs(np.einsum("ij,ij->i", exact - a, normal)[good]) / length[good])
        worst = max(worst, float(gap[np.isfinite(gap)].max(initial=0.0)))
    return worst
