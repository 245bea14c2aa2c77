"""The result of `riffler.cad.read`: a mesh, and for each of its triangles the exact face that it belongs to."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
from numpy.typing import NDArray

from .._core import Mesh, Surface

Color = tuple[float, float, float]


@dataclass(frozen=True)
class CadFace:
    """A face of a CAD file in its place in the assembly: one of `CadPart.faces`; see `riffler.cad.read`."""

    name: str
    """Name in the file; often empty."""
    color: Color | None
    """Red, green, blue in [0, 1] (sRGB) of the face, or else of its body; None if the file has no colour."""
    kind: str
    """Kind of surface: "plane", "cylinder", "cone", "sphere", "torus", "bspline", "bezier", "revolution", "extrusion",
    "offset" or "other"; "mesh" for triangles without a surface."""
    area: float
    """Area of the exact face, mm²."""
    body: int
    """Index of its body in `CadPart.bodies`."""


@dataclass(frozen=True)
class CadBody:
    """A solid or sheet of a CAD file in its place in the assembly: one of `CadPart.bodies`; see `riffler.cad.read`."""

    name: str
    """Names from the outermost assembly to the part, with "/" between them."""
    color: Color | None
    """Red, green, blue in [0, 1] (sRGB); None if the file has no colour."""
    solid: bool
    """Whether the body encloses material; otherwise it is a sheet of faces."""
    volume: float
    """Volume of the exact solid (OpenCASCADE's integral), mm³; 0 for a sheet."""
    area: float
    """Area of the exact faces, mm²."""
    open_edges: int
    """Number of edges where the body's triangles end; 0 if its mesh is closed."""


@dataclass(frozen=True)
class CadReport:
    """A report on how a CAD file was read: `CadPart.report`; see `riffler.cad.read`."""

    schema: str
    """Schema that a STEP file states; otherwise "IGES" or "BREP"."""
    unit: str
    """Unit of the file's lengths, such as "inch". All results are converted to mm."""
    tolerance: float
    """Requested chord error, mm."""
    deviation: float
    """Largest measured distance between the exact surface and its triangles, mm: measured at the middles of triangles
    and of their sides, not proven."""
    solids: int
    """Number of solids; each copy counts."""
    sheets: int
    """Number of faces or groups of faces that enclose no solid."""
    fixed: int
    """Number of faces that healing changed."""
    sewn: int
    """Number of edges at which faces were joined."""
    invalid: int
    """Number of faces that OpenCASCADE still reports as invalid after healing."""
    left_out: int
    """Number of faces that could not be tessellated."""
    volume: float
    """Exact volume of all solids, mm³."""
    area: float
    """Exact area of all faces, mm²."""
    closed: bool
    """Whether all bodies are solids and all their meshes are closed."""
    notes: tuple[str, ...]
    """Sentences on everything that the reader assumed, mended or left out."""
    seconds: dict[str, float]
    """Time of each step, s."""


@dataclass(frozen=True, eq=False)
class CadPart:
    """A part from a CAD file: its mesh, and the face of each triangle.

    Examples
    --------
    >>> part = riffler.cad.read("part.step", tolerance=0.01)
    >>> part, part.bodies[0].name, part.faces[0].kind
    (<riffler.cad.CadPart: 3 bodies, 12 faces, 444 triangles>, 'Fixture/Plate', 'plane')
    """

    mesh: Mesh
    """All bodies in their places, mm. Faces of a body share vertices where they meet; different bodies share none."""
    face_of_triangle: NDArray[np.int32]
    """(k,): for each triangle of the mesh the index of its face in ``faces``."""
    faces: tuple[CadFace, ...]
    """The faces, in the order of their triangles."""
    bodies: tuple[CadBody, ...]
    """The solids and sheets, in the order of their triangles."""
    report: CadReport
    """Report on how the file was read."""
    surface: Surface | None = None
    """The exact faces, as `Surface.read` returns them; None unless `riffler.cad.read` has ``exact=True``."""

    def find(self, name: str) -> NDArray[np.int64]:
        """Finds faces by name. Upper and lower case differ; ``*``, ``?`` and ``[…]`` match as in paths of files.

        Parameters
        ----------
        name : str
            The name, or a pattern.

        Returns
        -------
        ndarray of shape (n,)
            Indices of the faces, ascending; empty if there are none.

        Examples
        --------
        >>> part = riffler.cad.read("part.step")
        >>> part.find("datum*")
        array([5])
        """
        return np.array([n for n, face in enumerate(self.faces) if fnmatchcase(face.name, name)], np.int64)

    def triangles_of(self, faces: int | Iterable[int]) -> NDArray[np.int64]:
        """Finds the triangles of one or more faces.

        Parameters
        ----------
        faces : int or iterable of int
            Indices in ``faces``.

        Returns
        -------
        ndarray of shape (n,)
            Indices of the triangles, ascending.

        Raises
        ------
        IndexError
            There is no such face.

        Examples
        --------
        >>> part = riffler.cad.read("part.step")
        >>> part.triangles_of(part.find("datum A"))
        array([10, 11])
        """
        chosen = np.array([faces] if isinstance(faces, int | np.integer) else list(faces), np.int64).reshape(-1)
        for index in chosen:
            if not 0 <= index < len(self.faces):
                raise IndexError(f"faces: there is no face {index}; the part has {len(self.faces)}, from 0")
        wanted = np.zeros(len(self.faces), bool)
        wanted[chosen] = True
        return np.flatnonzero(wanted[self.face_of_triangle])

    def mesh_of(self, faces: int | Iterable[int]) -> Mesh:
        """The triangles of one or more faces as a mesh of their own.

        Parameters
        ----------
        faces : int or iterable of int
            Indices in ``faces``.

        Returns
        -------
        Mesh
            The mesh; it is open where the faces end.

        Raises
        ------
        IndexError
            There is no such face.

        Examples
        --------
        >>> part = riffler.cad.read("part.step")
        >>> round(part.mesh_of(part.find("datum A")).area, 6)
        800.0
        """
        used, inverse = np.unique(self.mesh.triangles[self.triangles_of(faces)], return_inverse=True)
        return Mesh(self.mesh.vertices[used], inverse.reshape(-1, 3).astype(np.int32))

    def outline(self, faces: int | Iterable[int]) -> list[NDArray[np.float64]]:
        """Returns the closed curves around one or more faces: their common border, including holes. `plan.finish`
        accepts the curves as its ``region``.

        Parameters
        ----------
        faces : int or iterable of int
            Indices in ``faces``; an edge between two of them is not on the border.

        Returns
        -------
        list of ndarray of shape (n, 3), mm
            The curves; none repeats its first point at the end. The faces are on their left, seen from outside.
            Empty for faces without a border, such as a whole sphere.

        Raises
        ------
        IndexError
            There is no such face.

        Examples
        --------
        >>> part = riffler.cad.read("part.step")
        >>> [curve.shape for curve in part.outline(part.find("datum A"))]
        [(4, 3)]
        """
        rows = self.mesh.triangles[self.triangles_of(faces)].astype(np.int64)
        edges = np.concatenate([rows[:, [0, 1]], rows[:, [1, 2]], rows[:, [2, 0]]])
        several = {(a, b) for a, b in edges.tolist()}
        after: dict[int, list[int]] = {}
        for a, b in edges.tolist():
            if (b, a) not in several:
                after.setdefault(a, []).append(b)
        curves = []
        while after:
            start = next(iter(after))
            curve, at = [], start
            while at in after:
                curve.append(at)
                at = _step(after, at)
            curves.append(self.mesh.vertices[curve].copy())
        return curves

    def __repr__(self) -> str:
        return (
            f"<riffler.cad.CadPart: {len(self.bodies)} bodies, {len(self.faces)} faces, "
            f"{len(self.mesh.triangles)} triangles>"
        )


def _step(after: dict[int, list[int]], at: int) -> int:
    following = after[at].pop()
    if not after[at]:
        del after[at]
    return following
