"""What `riffler.cad.read` returns: a mesh whose triangles know the exact face that they are part of."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
from numpy.typing import NDArray

from .._core import Mesh

Color = tuple[float, float, float]


@dataclass(frozen=True)
class CadFace:
    """A face of a CAD file, placed: one of `CadPart.faces`; see `riffler.cad.read`."""

    name: str
    """As the file has it; often empty."""
    color: Color | None
    """Red, green, blue in [0, 1] (sRGB): of the face, else of its body; None: the file states none."""
    kind: str
    """Its surface: "plane", "cylinder", "cone", "sphere", "torus", "bspline", "bezier", "revolution", "extrusion",
    "offset" or "other"; "mesh" for triangles without a surface."""
    area: float
    """mm², of the exact face."""
    body: int
    """Index of its body in `CadPart.bodies`."""


@dataclass(frozen=True)
class CadBody:
    """A solid or a sheet of a CAD file, placed: one of `CadPart.bodies`; see `riffler.cad.read`."""

    name: str
    """Names from the outermost assembly to the part, with "/" between them."""
    color: Color | None
    """Red, green, blue in [0, 1] (sRGB); None: the file states none."""
    solid: bool
    """Whether it encloses material; otherwise it is a sheet of faces."""
    volume: float
    """mm³, of the exact solid (OpenCASCADE's integral); 0 for a sheet."""
    area: float
    """mm², of the exact faces."""
    open_edges: int
    """Edges where the surface of its triangles ends; 0: closed."""


@dataclass(frozen=True)
class CadReport:
    """How a CAD file was read: `CadPart.report`; see `riffler.cad.read`."""

    schema: str
    """The schema that a STEP file states, "IGES" or "BREP"."""
    unit: str
    """The unit of the file's lengths, such as "inch"; they are converted to mm."""
    tolerance: float
    """mm: the chord error that was asked for."""
    deviation: float
    """mm: the largest distance of the exact surface from its triangle that was found at the middles of triangles and of
    their sides. It is measured, not proven."""
    solids: int
    """Solids, each copy counted."""
    sheets: int
    """Faces or groups of faces that enclose no solid."""
    fixed: int
    """Faces that healing changed."""
    sewn: int
    """Edges at which faces were joined."""
    invalid: int
    """Faces that OpenCASCADE still calls invalid after healing."""
    left_out: int
    """Faces that could not be tessellated."""
    volume: float
    """mm³: the exact volume of all solids."""
    area: float
    """mm²: the exact area of all faces."""
    closed: bool
    """Whether all bodies are solids and their meshes closed."""
    notes: tuple[str, ...]
    """Sentences on everything that was assumed, mended or left out."""
    seconds: dict[str, float]
    """s: time of each step."""


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
    """All bodies, placed, mm. Faces of a body share vertices where they meet; bodies share none."""
    face_of_triangle: NDArray[np.int32]
    """(k,): of each triangle of the mesh, the index of its face in ``faces``."""
    faces: tuple[CadFace, ...]
    """The faces, in the order of their triangles."""
    bodies: tuple[CadBody, ...]
    """The solids and sheets, in the order of their triangles."""
    report: CadReport
    """How it was read."""

    def find(self, name: str) -> NDArray[np.int64]:
        """Indices of the faces with a name. Upper and lower case differ; ``*``, ``?`` and ``[…]`` match as in paths.

        Parameters
        ----------
        name : str
            The name, or a pattern.

        Returns
        -------
        ndarray of shape (n,)
            Ascending; empty if there are none.

        Examples
        --------
        >>> part = riffler.cad.read("part.step")
        >>> part.find("datum*")
        array([5])
        """
        return np.array([n for n, face in enumerate(self.faces) if fnmatchcase(face.name, name)], np.int64)

    def triangles_of(self, faces: int | Iterable[int]) -> NDArray[np.int64]:
        """Indices of the triangles of one or more faces.

        Parameters
        ----------
        faces : int or iterable of int
            Indices in ``faces``.

        Returns
        -------
        ndarray of shape (n,)
            Ascending.

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
            Open where the faces end.

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
        """The closed curves around one or more faces: their common border, holes included. `plan.finish` takes them as
        its ``region``.

        Parameters
        ----------
        faces : int or iterable of int
            Indices in ``faces``; edges between two of them are inside, not on the border.

        Returns
        -------
        list of ndarray of shape (n, 3), mm
            Each curve without its first point repeated at the end. The faces are on its left, seen from outside.
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
