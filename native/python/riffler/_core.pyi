# Made by `make stubs` from the built module; not to be edited.
from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import os
import pathlib
import riffler.pen_results
import riffler.plan.locations
import riffler.plan.operations
import riffler.plan.orientations
import riffler.plan.strategies.pencil
import riffler.plan.strategies.swarf
import riffler.program_results
import riffler.results
import typing
_Found = typing.TypeVar('_Found')
_Made = typing.TypeVar('_Made')
import typing_extensions
__all__: list[str] = ['AtomicFileWriter', 'Brushed', 'Cancelled', 'Collider', 'Contact', 'Cut', 'Finding', 'FormatError', 'FrozenSurface', 'History', 'Journal', 'JournalStroke', 'JournalWriter', 'Material', 'Mesh', 'Mesher', 'NotATask', 'Note', 'OrientFrame', 'OrientSession', 'PenDevice', 'PenError', 'PenGeometry', 'PenState', 'PencilPath', 'Pointer', 'Program', 'ProgramStream', 'Session', 'SessionFrame', 'SimulatedPen', 'SlabWorker', 'Smoothed', 'Snapshot', 'Surface', 'Task', 'Tool', 'ToolShape', 'ToolSize', 'Verification', 'VerifyPlan', 'VerifyReport', 'Volume', 'clear_drafts', 'clear_passes', 'contact_locations', 'cut_along', 'cutter_locations', 'draft_prefix', 'drop', 'engrave', 'falloff', 'finish', 'finish_patterns', 'lift', 'machine_options', 'machine_texts', 'machines', 'min_tilt', 'orientation_maps', 'outline', 'pencil', 'read_file', 'replace_file', 'replaceable', 'require_revolved', 'rough', 'set_threads', 'stepover_of_scallop', 'swarf', 'then', 'threads', 'tip_ball_radius', 'verify']
class FormatError(ValueError):
    """
    A file with invalid content. Names the file, the line or byte, and what was expected.
    """
class Cancelled(RuntimeError):
    """
    A long call was stopped by its progress callback. The object is unchanged.
    """
class NotATask(TypeError):
    pass
class Task:
    """
    A long call on a native thread that runs no Python; a riffler.Future waits for it.

    What the call was given is taken when it is made, volumes by a snapshot; what is done with them afterwards changes
    nothing. A Task that nobody holds any more is cancelled and waited for; so are all when Python ends.
    """
    def __repr__(self) -> str:
        ...
    def cancel(self) -> None:
        """
        Asks the call to end with Cancelled, and does not wait. No effect if the call has ended.
        """
    def result(self) -> object:
        """
        What the call returns, the same object each time; waits for it without blocking other threads. Raises what the call raises, Cancelled after ``cancel``. Ctrl-C ends the waiting, not the call.
        """
    def wait(self, timeout: typing.SupportsFloat | None = None) -> bool:
        """
        Waits until the call has ended, at most this many seconds. Returns whether it has ended. Other threads run meanwhile.
        """
    @property
    def done(self) -> bool:
        """
        Whether ``result`` returns at once: the call has finished, failed or been cancelled.
        """
    @property
    def share(self) -> float:
        """
        The finished share, in [0, 1]. Never decreases; 1 only if the call has finished.
        """
class AtomicFileWriter:
    """
    A file that replaces ``path`` at ``commit``.

    Follows links; keeps permissions and owner of an existing file. RuntimeError if ``path`` is not a regular file.
    """
    def __init__(self, path: os.PathLike | str | bytes) -> None:
        ...
    def commit(self) -> None:
        """
        Once.
        """
    def fileno(self) -> int:
        """
        File descriptor of the draft, which is written to; -1 after ``commit``.
        """
class Mesh:
    """
    A triangle mesh, mm. It never changes: a method that changes a mesh returns a new one.

    Parameters
    ----------
    vertices : array_like of shape (n, 3), mm
        Positions; they are not welded.
    triangles : array_like of shape (k, 3), integers
        Indices of vertices, counter-clockwise seen from outside.

    Raises
    ------
    ValueError
        Names argument and row: a wrong shape, a vertex that is not finite or beyond 1e30, an index out of range.

    Examples
    --------
    >>> mesh = riffler.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> mesh.area
    0.5
    """
    @staticmethod
    def read(path: os.PathLike | str | bytes, *, tolerance: typing.SupportsFloat = 0.01, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Mesh:
        """
        Reads a .stl (binary or ASCII), .obj, .ply or .3mf file, in which equal vertices become one, or a CAD file.

        From a .3mf file reads all build items, in place, converted to mm; this needs the package lib3mf. From a .step, .stp, .iges,
        .igs or .brep file reads all bodies, in place, converted to mm, healed and tessellated; this needs the extra riffler[cad].
        `riffler.cad.read` returns their faces, names and colours as well.

        Parameters
        ----------
        path : path_like, with one of these extensions
            The file.
        tolerance : float, mm
            Chord error of a CAD file. Other files have triangles already, and it has no effect.
        progress : callable or None
            Called with the finished share of the part of the file at hand, of .stl and .3mf not after the beginning. Returning
            False cancels.

        Returns
        -------
        Mesh
            In mm.

        Raises
        ------
        FormatError
            Names the byte or line of a bad file (of .3mf and CAD files what was expected), among them files without a triangle.
        ValueError
            Another extension, or an extra that is missing.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> volume.to_mesh().write("block.stl")
        >>> riffler.Mesh.read("block.stl")
        <riffler.Mesh: 210 vertices, 416 triangles>
        """
    def __copy__(self) -> Mesh:
        ...
    def __deepcopy__(self, memo: dict) -> Mesh:
        ...
    def __getstate__(self) -> tuple:
        ...
    def __init__(self, vertices: numpy.typing.ArrayLike, triangles: numpy.typing.ArrayLike) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    def audit(self, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> riffler.results.Audit:
        """
        Counts the defects of a mesh.

        Parameters
        ----------
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Audit
            All counts are 0 for a closed two-manifold without defects.

        Examples
        --------
        >>> mesh = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh()
        >>> audit = mesh.audit()
        >>> audit.open_edges, audit.components
        (0, 1)
        """
    def decimate(self, *, triangles: typing.SupportsInt | None = None, tolerance: typing.SupportsFloat | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Mesh:
        """
        A mesh with fewer triangles.

        It is closed and two-manifold if this one is; sharp edges and borders stay. The vertices are some of the old ones,
        or, if that fits better, new ones between them.

        Parameters
        ----------
        triangles : int, how many triangles to keep, or None
            Number of triangles to stop at.
        tolerance : float, mm, or None
            Largest distance between old and new surface. With both limits, decimation stops at the first one reached.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Mesh
            A new mesh.

        Raises
        ------
        ValueError
            Neither limit is given, or one is negative or not finite.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> ball = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.5, directions="xyz").to_mesh()
        >>> len(ball.decimate(triangles=500).triangles)
        500
        """
    def deviation(self, other: Mesh, *, signed: bool = False, progress: collections.abc.Callable[[float], bool | None] | None = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Distance of each vertex from the surface of another mesh.

        Parameters
        ----------
        other : Mesh
            The surface to measure from.
        signed : bool
            Whether distances inside of ``other`` are negative.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        ndarray of shape (n,), float64, mm
            One distance for each vertex.

        Raises
        ------
        ValueError
            ``other`` has no triangles.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> ball = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.5, directions="xyz").to_mesh()
        >>> bool(abs(ball.decimate(tolerance=0.02).deviation(ball)).max() <= 0.02)
        True
        """
    def orient(self, *, hollow: bool = False) -> Mesh:
        """
        This mesh as the surface of a solid: the mesh itself, or one in which triangles are turned.

        What takes a mesh as a solid (Volume.from_mesh, Collider, verify, plan.pencil, plan.engrave, deviation with signs) does
        this by itself. In closed pieces orientation is carried over edges that two triangles share, the larger area decides, and
        they then face outwards, but for cavities: pieces within another that are oriented the opposite way round. Open pieces,
        and pieces with one side only, stay unchanged.

        Parameters
        ----------
        hollow : bool
            Leave closed pieces that all face inwards, as plans and Collider do: room in endless material.

        Returns
        -------
        Mesh
            This mesh where nothing had to be turned.

        Examples
        --------
        >>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh()
        >>> inside_out = riffler.Mesh(block.vertices, block.triangles[:, ::-1])
        >>> bool(inside_out.volume < 0 < inside_out.orient().volume)
        True
        """
    def orient_with_report(self, *, hollow: bool = False) -> tuple[Mesh, riffler.results.Orientation]:
        """
        The same as `orient`, with a report of the faults.

        Parameters
        ----------
        hollow : bool
            As of `orient`.

        Returns
        -------
        (Mesh, Orientation)
            The mesh, and the counts of turned and unused triangles.

        Examples
        --------
        >>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh()
        >>> inside_out = riffler.Mesh(block.vertices, block.triangles[:, ::-1])
        >>> mesh, report = inside_out.orient_with_report()
        >>> report.turned_shells
        1
        """
    def smooth(self, *, iterations: typing.SupportsInt = 10, tolerance: typing.SupportsFloat | None = None, feature_angle: typing.SupportsFloat = 0.7, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Mesh:
        """
        A smoother mesh of the same triangles (Taubin's filter) and the same volume.

        Edges whose sides turn by more than ``feature_angle`` stay sharp; corners stay in their place, and so do vertices on
        borders.

        Parameters
        ----------
        iterations : int, steps of the filter
            Not negative.
        tolerance : float, mm, or None
            Largest total move of a vertex.
        feature_angle : float, rad
            Between the normals of an edge's two sides.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Mesh
            A new mesh.

        Raises
        ------
        ValueError
            A negative number, or an angle that is not positive.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> ball = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.5, directions="xyz").to_mesh()
        >>> smoother = ball.smooth(iterations=5, tolerance=0.05)
        >>> bool(abs(smoother.vertices - ball.vertices).max() <= 0.05)
        True
        """
    def write(self, path: os.PathLike | str | bytes, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        """
        Writes a .stl (binary), .obj, .ply (binary) or .3mf file, whole or not at all.

        Coordinates of .stl are rounded to float32, those of .3mf (mm) are float32 to the last step; .3mf needs the package
        lib3mf, which reports no progress.

        Parameters
        ----------
        path : path_like, with one of these extensions
            The file; an existing one is replaced.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Raises
        ------
        RuntimeError
            The file cannot be written.
        ValueError
            Another extension.
        Cancelled
            ``progress`` returned False. No file is written; an existing one is unchanged.

        Examples
        --------
        >>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh().write("block.ply")
        """
    @property
    def area(self) -> float:
        """
        mm².
        """
    @property
    def bounds(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (2, 3) float64, mm: lower and upper corner of the triangles' box. ValueError without triangles.
        """
    @property
    def triangles(self) -> numpy.ndarray:
        """
        (k, 3) int32, read-only, no copy.
        """
    @property
    def vertices(self) -> numpy.ndarray:
        """
        (n, 3) float64, mm, read-only, no copy.
        """
    @property
    def volume(self) -> float:
        """
        mm³, signed; defined for closed meshes.
        """
class Surface:
    """
    An exact surface of rational B-spline (NURBS) patches, mm. It never changes.

    `Surface.nurbs` makes a surface of one patch; this makes one of several, which need not be connected.

    Parameters
    ----------
    surfaces : list of Surface
        Their patches, in this order.

    Raises
    ------
    ValueError
        No surface.

    Examples
    --------
    >>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
    ...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
    >>> wall = riffler.Surface.nurbs([[[0, 0, 0], [4, 0, 0]], [[0, 0, 3], [4, 0, 3]]], [[1, 1], [1, 1]],
    ...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
    >>> riffler.Surface([flat, wall])
    <riffler.Surface: 2 patches>
    """
    @staticmethod
    def nurbs(points: numpy.typing.ArrayLike, weights: numpy.typing.ArrayLike, knots_u: numpy.typing.ArrayLike, knots_v: numpy.typing.ArrayLike, degree_u: typing.SupportsInt, degree_v: typing.SupportsInt, *, trims: collections.abc.Sequence[numpy.typing.ArrayLike] | None = None, name: str = '') -> Surface:
        """
        A surface of one patch.

        Parameters
        ----------
        points : array_like of shape (nu, nv, 3), mm
            Control points, not multiplied by the weights.
        weights : array_like of shape (nu, nv)
            Positive, with a ratio of at most 1e12.
        knots_u : array_like of nu + degree_u + 1 numbers
            Not decreasing; the patch's domain begins at knot degree_u and ends at knot nu.
        knots_v : array_like of nv + degree_v + 1 numbers
            Likewise.
        degree_u, degree_v : int, 1 to 15
            Degrees of the polynomials.
        trims : list of array_like of shape (k, 2), or None
            Borders: closed polylines in (u, v) within the domain, the last point joined to the first. The patch is where an odd
            number of them encloses a parameter. None: the whole domain. With borders, degree_u + degree_v may be at most 15.
        name : str
            See ``names``.

        Returns
        -------
        Surface
            Its normals are in the direction of dS/du × dS/dv.

        Raises
        ------
        ValueError
            Names argument and row: a wrong shape or number of knots, knots that decrease or tear the surface, a weight that is
            not positive, a degree out of range, a number that is not finite, a border that leaves the domain or encloses nothing.

        Examples
        --------
        >>> r = 0.5 ** 0.5
        >>> quarter = riffler.Surface.nurbs([[[5, 0, 0], [5, 0, 9]], [[5, 5, 0], [5, 5, 9]], [[0, 5, 0], [0, 5, 9]]],
        ...                                 [[1, 1], [r, r], [1, 1]], [0, 0, 0, 1, 1, 1], [0, 0, 1, 1], 2, 1)
        >>> points, normals, distance = quarter.closest([[6, 8, 4]])  # of a cylinder of radius 5
        >>> points.round(9).tolist(), distance.round(9).tolist()
        ([[3.0, 4.0, 4.0]], [5.0])
        """
    @staticmethod
    def read(path: os.PathLike | str | bytes, *, tolerance: typing.SupportsFloat = 0.0001, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Surface:
        """
        The exact faces of a STEP, IGES or BREP file: one patch for each face, in its place, in mm.

        OpenCASCADE (``pip install 'riffler[cad]'``) converts the faces to rational B-splines, in a process of its own, without
        approximating planes, quadrics and tori. Edges become borders. Normals point out of solids.

        Parameters
        ----------
        path : path_like
            A file with the extension .step, .stp, .iges, .igs or .brep.
        tolerance : float, mm
            Of the borders: distance of their straight pieces from the edges, measured in their middles.
        progress : callable or None
            Called with the finished share several times a second; returning False cancels.

        Returns
        -------
        Surface
            Its ``names`` are those of the faces.

        Raises
        ------
        FormatError
            The file has no faces, is damaged, or has a face without an exact surface.
        ValueError
            An argument is wrong, or the package is missing; the message then has the command that installs it.
        riffler.cad.CadReaderError
            The reader's process crashed.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> part = riffler.Surface.read("part.step")
        >>> part.patch_count, part.names[5]
        (12, 'datum A')
        """
    def __copy__(self) -> Surface:
        ...
    def __deepcopy__(self, memo: dict) -> Surface:
        ...
    def __init__(self, surfaces: collections.abc.Sequence[Surface]) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def closest(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        The nearest point of the surface to each point, of all patches: never a local minimum.

        No point of the surface is nearer than the returned distance by more than 1e-9 mm, or 1e-13 of the largest coordinate of
        surface and points if that is more: bounds from the control points prove it.

        Parameters
        ----------
        points : array_like of shape (n, 3), mm
            Anywhere.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        (points, normals, distance) : ndarrays of shape (n, 3), (n, 3) and (n,), float64
            The nearest points, mm; the surface's unit normals there, as by `evaluate`; the distances, mm, not negative.

        Raises
        ------
        ValueError
            Names the row of a point that is not finite.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
        ...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
        >>> points, normals, distance = flat.closest([[1, 2, 3], [7, 5, 4]])
        >>> points.round(9).tolist(), distance.round(9).tolist()
        ([[1.0, 2.0, 0.0], [4.0, 5.0, 0.0]], [3.0, 5.0])
        """
    def domain(self, patch: typing.SupportsInt = 0) -> numpy.typing.NDArray[numpy.float64]:
        """
        The domain of a patch.

        Parameters
        ----------
        patch : int
            Which patch, counted from 0.

        Returns
        -------
        ndarray of shape (2, 2), float64
            Smallest and largest (u, v).

        Raises
        ------
        ValueError
            The patch does not exist.

        Examples
        --------
        >>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
        ...                              [0, 0, 1, 1], [2, 2, 3, 3], 1, 1)
        >>> flat.domain().tolist()
        [[0.0, 2.0], [1.0, 3.0]]
        """
    def evaluate(self, uv: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, patch: typing.SupportsInt = 0, progress: collections.abc.Callable[[float], bool | None] | None = None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Points and unit normals at parameters.

        At a pole, where a derivative is 0, the normal is the limit of those inside the patch. It is 0 where the patch has no
        area.

        Parameters
        ----------
        uv : array_like of shape (n, 2)
            Parameters, within the domain of the patch.
        patch : int
            Which patch, counted from 0.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        (points, normals) : ndarrays of shape (n, 3), float64
            mm, and unit vectors in the direction of dS/du × dS/dv.

        Raises
        ------
        ValueError
            Names the row of parameters that are not in the domain, or a patch that does not exist.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
        ...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
        >>> points, normals = flat.evaluate([[0.5, 0.2]])
        >>> points.tolist(), normals.tolist()
        ([[2.0, 1.0, 0.0]], [[0.0, 0.0, 1.0]])
        """
    def inside(self, uv: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], patch: typing.SupportsInt = 0) -> numpy.typing.NDArray[numpy.bool]:
        """
        Whether parameters are inside the borders of a patch.

        Parameters
        ----------
        uv : array_like of shape (n, 2)
            Parameters, within the domain of the patch.
        patch : int
            Which patch, counted from 0.

        Returns
        -------
        ndarray of shape (n,), bool
            True everywhere for a patch without borders.

        Raises
        ------
        ValueError
            Names the row of parameters that are not in the domain, or a patch that does not exist.

        Examples
        --------
        >>> corner = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
        ...                                [0, 0, 1, 1], [0, 0, 1, 1], 1, 1, trims=[[[0, 0], [1, 0], [0, 1]]])
        >>> corner.inside([[0.2, 0.2], [0.9, 0.9]]).tolist()
        [True, False]
        """
    def to_mesh(self, tolerance: typing.SupportsFloat, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Mesh:
        """
        A mesh that deviates from the surface by at most a tolerance, in both directions.

        Bounds of second derivatives prove it; vertices lie on the surface. Seams of closed patches, and patches that have an
        edge in common (the same curve with the same parameters), share vertices, and a pole is one vertex: what is closed stays
        closed. With borders, only equal corners are one vertex, and triangles that meet may have gaps within the tolerance
        between them; `Mesh.read` makes closed meshes of CAD files.

        Parameters
        ----------
        tolerance : float, mm
            At least 1e-8, and 1e-10 of the largest coordinate.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Mesh
            Counter-clockwise seen from the side of the normals.

        Raises
        ------
        ValueError
            A tolerance that is too small, or that makes more than 50 million triangles.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
        ...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
        >>> flat.to_mesh(0.01)
        <riffler.Mesh: 4 vertices, 2 triangles>
        """
    @property
    def bounds(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (2, 3) float64, mm: lower and upper corner of the control points' box, which contains the surface.
        """
    @property
    def names(self) -> list[str]:
        """
        Names of the patches, often empty.
        """
    @property
    def patch_count(self) -> int:
        """
        Number of patches.
        """
class Tool:
    """
    A cutter with the shank and holder above it; immutable.

    Heights are measured from the tip towards the spindle, lengths in mm, angles in rad. ``length`` includes the
    rounded or conical end. Sizes that are not positive or do not fit raise ValueError naming the size.

    Examples
    --------
    >>> riffler.Tool.ball(diameter=6, length=30) == riffler.Tool.ball(6, 30)
    True
    """
    @staticmethod
    def ball(diameter: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        Ball end mill.

        Parameters
        ----------
        diameter : float, mm
            Diameter of the cylinder above the end, in mm.
        length : float, mm
            Cutting length from the tip, in mm.

        Returns
        -------
        Tool
            A tool without shank and holder.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> riffler.Tool.ball(diameter=6.0, length=30.0).kind
        'ball'
        """
    @staticmethod
    def chisel(width: typing.SupportsFloat, thickness: typing.SupportsFloat, bevel: typing.SupportsFloat, length: typing.SupportsFloat, skew: typing.SupportsFloat = 0.0) -> Tool:
        """
        A hand tool: a flat blade with its edge across the tip, flat behind, ground in front.

        Parameters
        ----------
        width, thickness : float, mm
            Of the blade, across and along the cutting direction.
        bevel : float, rad
            Between the flat back and the ground face.
        length : float, mm
            From the tip to the upper end.
        skew : float, rad
            Turns the edge about the cutting direction; the tip stays its middle.

        Returns
        -------
        Tool
            For poses of shape (n, 9); see `convex`.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> riffler.Tool.chisel(width=12, thickness=3, bevel=0.5, length=60).name
        'chisel 12'
        """
    @staticmethod
    def cone_end(tip_half_angle: typing.SupportsFloat, tip_height: typing.SupportsFloat, half_angle: typing.SupportsFloat, diameter: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        Sharp tip, a first cone, a second cone, then a cylinder.

        Parameters
        ----------
        tip_half_angle : float, rad
            Angle between the axis and the first cone.
        tip_height : float, mm
            Height of the first cone, in mm.
        half_angle : float, rad
            Angle between the axis and the flank.
        diameter : float, mm
            Diameter of the cylinder above the end, in mm.
        length : float, mm
            Cutting length from the tip, in mm.

        Returns
        -------
        Tool
            A tool without shank and holder.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> riffler.Tool.cone_end(tip_half_angle=0.5235987755982988, tip_height=1.0, half_angle=0.08726646259971647, diameter=6.0, length=30.0).kind
        'cone_end'
        """
    @staticmethod
    def convex(hulls: collections.abc.Sequence[numpy.typing.ArrayLike]) -> Tool:
        """
        A hand tool: the union of the convex hulls of points. No body of revolution, so its poses have a roll.

        Parameters
        ----------
        hulls : list of array_like of shape (k, 3), mm
            Points of each body, in the tool's frame: z from the tip to the handle, x the cutting direction, y across.

        Returns
        -------
        Tool
            For `Volume.carve` with poses of shape (n, 9); what needs a body of revolution refuses it.

        Raises
        ------
        ValueError
            Names the body: fewer than four points or more than 128, one that is not finite, or a flat body.

        Examples
        --------
        >>> wedge = riffler.Tool.convex([[(0, -3, 0), (0, 3, 0), (2, -3, 4), (2, 3, 4), (0, -3, 20), (0, 3, 20)]])
        >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
        >>> cut = volume.carve(wedge, [[5, 10, 8, 0, 0, 1, 1, 0, 0], [15, 10, 8, 0, 0, 1, 1, 0, 0]])
        >>> cut.removed.round(3).tolist()
        [126.0]
        """
    @staticmethod
    def fillet(diameter: typing.SupportsFloat, corner_radius: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        Flat end mill with a rounded edge.

        Parameters
        ----------
        diameter : float, mm
            Diameter of the cylinder above the end, in mm.
        corner_radius : float, mm
            Radius of the rounded edge, in mm.
        length : float, mm
            Cutting length from the tip, in mm.

        Returns
        -------
        Tool
            A tool without shank and holder.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> riffler.Tool.fillet(diameter=6.0, corner_radius=1.0, length=30.0).kind
        'fillet'
        """
    @staticmethod
    def flat(diameter: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        Flat end mill.

        Parameters
        ----------
        diameter : float, mm
            Diameter of the cylinder above the end, in mm.
        length : float, mm
            Cutting length from the tip, in mm.

        Returns
        -------
        Tool
            A tool without shank and holder.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> riffler.Tool.flat(diameter=6.0, length=30.0).kind
        'flat'
        """
    @staticmethod
    def from_dict(d: dict) -> Tool:
        """
        The tool of a tool library's entry.

        Parameters
        ----------
        d : dict with the keys of `to_dict`
            Kind and sizes; name, shank and holder if the tool has them.

        Returns
        -------
        Tool
            Equal to the tool whose `to_dict` this is.

        Raises
        ------
        ValueError
            Names the key that is missing or wrong.

        Examples
        --------
        >>> riffler.Tool.from_dict({"kind": "ball", "diameter": 6, "length": 30}).diameter
        6.0
        """
    @staticmethod
    def gouge(width: typing.SupportsFloat, radius: typing.SupportsFloat, bevel: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        A hand tool: a blade with a round channel, filled up to the rims, so that the chip is taken out.

        Parameters
        ----------
        width : float, mm
            Between the rims; at most twice the radius.
        radius : float, mm
            Of the sweep. The arc is a polygon in it, within 0.01 mm or of 24 sides.
        bevel : float, rad
            Between the outer side and the ground end.
        length : float, mm
            From the tip to the upper end.

        Returns
        -------
        Tool
            For poses of shape (n, 9); see `convex`.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> riffler.Tool.gouge(width=8, radius=5, bevel=0.6, length=60).diameter < 10
        True
        """
    @staticmethod
    def knife(width: typing.SupportsFloat, thickness: typing.SupportsFloat, edge_angle: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        A hand tool: a blade whose edge runs up from the tip and leads in the cutting direction.

        Parameters
        ----------
        width, thickness : float, mm
            From edge to back, and across.
        edge_angle : float, rad
            Between the two sides of the edge.
        length : float, mm
            From the tip to the upper end; the back begins a width above the tip.

        Returns
        -------
        Tool
            For poses of shape (n, 9); see `convex`.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> riffler.Tool.knife(width=10, thickness=2, edge_angle=0.5, length=60).length
        60.0
        """
    @staticmethod
    def profile(segments: numpy.typing.ArrayLike | collections.abc.Sequence[collections.abc.Sequence[float]], length: typing.SupportsFloat) -> Tool:
        """
        A free profile from the tip (0, 0) upwards; a cylinder follows up to ``length``.

        Parameters
        ----------
        segments : list of rows of 2 or 4 numbers, mm
            (radius, height): a line to this point; (radius, height, centre_radius, centre_height): the shorter arc to it.
        length : float, mm
            Cutting length from the tip.

        Returns
        -------
        Tool
            A tool without shank and holder.

        Raises
        ------
        ValueError
            Names the row.

        Examples
        --------
        >>> riffler.Tool.profile([(2, 0), (3, 1)], length=20).diameter
        6.0
        """
    @staticmethod
    def shapes() -> list[ToolShape]:
        """
        The named cutter shapes with their sizes, for forms: all that have a function here except `profile`.

        Returns
        -------
        list of ToolShape
            In the order of the table.

        Examples
        --------
        >>> [shape.name for shape in riffler.Tool.shapes()][:2]
        ['ball', 'flat']
        """
    @staticmethod
    def taper(tip_radius: typing.SupportsFloat, half_angle: typing.SupportsFloat, diameter: typing.SupportsFloat, length: typing.SupportsFloat, flat_tip: bool = False) -> Tool:
        """
        Cone above a ball tip or a flat one, then a cylinder.

        Parameters
        ----------
        tip_radius : float, mm
            Radius of the ball or flat at the tip, in mm.
        half_angle : float, rad
            Angle between the axis and the flank.
        diameter : float, mm
            Diameter of the cylinder above the end, in mm.
        length : float, mm
            Cutting length from the tip, in mm.
        flat_tip : bool
            A flat instead of a ball at the tip.

        Returns
        -------
        Tool
            A tool without shank and holder.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> riffler.Tool.taper(tip_radius=0.5, half_angle=0.08726646259971647, diameter=6.0, length=30.0, flat_tip=False).kind
        'taper'
        """
    @staticmethod
    def v_tool(angle: typing.SupportsFloat, width: typing.SupportsFloat, bevel: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        A hand tool: two blades that meet at an angle, filled up to the rims; a parting tool.

        Parameters
        ----------
        angle : float, rad
            Between the blades.
        width : float, mm
            Between the rims.
        bevel : float, rad
            Between the line where the blades meet and the ground end.
        length : float, mm
            From the tip to the upper end.

        Returns
        -------
        Tool
            For poses of shape (n, 9); see `convex`.

        Raises
        ------
        ValueError
            Names the size that is not positive or does not fit the others.

        Examples
        --------
        >>> [body.shape for body in riffler.Tool.v_tool(angle=1.0, width=8, bevel=0.6, length=60).hulls]
        [(6, 3)]
        """
    def __eq__(self, other: object) -> bool:
        ...
    def __getstate__(self) -> dict:
        ...
    def __hash__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: dict) -> None:
        ...
    def named(self, name: str) -> Tool:
        """
        The same tool under another name.

        Parameters
        ----------
        name : str
            For messages and tool libraries.

        Returns
        -------
        Tool
            A new tool.

        Examples
        --------
        >>> riffler.Tool.ball(6, 30).named("finisher").name
        'finisher'
        """
    def outline(self, *, tolerance: typing.SupportsFloat = 0.01) -> list[tuple[str, numpy.typing.NDArray[numpy.float64]]]:
        """
        The outline of cutter, shank and holder together, from the tip upwards, for drawing.

        Parts inside another piece are left out.

        Parameters
        ----------
        tolerance : float, mm
            Largest distance of polylines from arcs.

        Returns
        -------
        list of (str, ndarray of shape (n, 2), mm)
            "cutter", "shank" or "holder", and a polyline of radius and height.

        Raises
        ------
        ValueError
            A tolerance that is not positive.

        Examples
        --------
        >>> [(part, line.tolist()) for part, line in riffler.Tool.flat(6, 30).outline()][0]
        ('cutter', [[0.0, 0.0], [3.0, 0.0], [3.0, 30.0], [0.0, 30.0]])
        """
    def to_dict(self) -> dict[str, bool | float | str | list[tuple[float, ...]]]:
        """
        The JSON / TOML form: kind, its sizes, name, shank and holder.

        Returns
        -------
        dict
            Numbers, texts and lists only.

        Examples
        --------
        >>> riffler.Tool.ball(6, 30).to_dict()["kind"]
        'ball'
        """
    def with_holder(self, pieces: numpy.typing.ArrayLike) -> Tool:
        """
        The same tool with another holder.

        Parameters
        ----------
        pieces : array_like of shape (k, 4), mm
            Truncated cones (z0, r0, z1, r1), heights from the tip.

        Returns
        -------
        Tool
            A new tool.

        Raises
        ------
        ValueError
            Names the row.

        Examples
        --------
        >>> riffler.Tool.ball(6, 30).with_holder([(40, 15, 80, 20)]).holder
        [(40.0, 15.0, 80.0, 20.0)]
        """
    def with_margins(self, *, shank: typing.SupportsFloat = 0.0, holder: typing.SupportsFloat = 0.0) -> Tool:
        """
        The same tool with a wider shank and holder, to plan and check with a safety margin.

        The ends of the holder move too, those of the shank do not.

        Parameters
        ----------
        shank, holder : float, mm
            Added width of each on every side.

        Returns
        -------
        Tool
            A new tool.

        Raises
        ------
        ValueError
            A negative margin.

        Examples
        --------
        >>> riffler.Tool.ball(6, 30).with_shank([(30, 3, 60, 3)]).with_margins(shank=0.5).shank
        [(30.0, 3.5, 60.0, 3.5)]
        """
    def with_shank(self, pieces: numpy.typing.ArrayLike) -> Tool:
        """
        The same tool with another shank.

        Parameters
        ----------
        pieces : array_like of shape (k, 4), mm
            Truncated cones (z0, r0, z1, r1), heights from the tip.

        Returns
        -------
        Tool
            A new tool.

        Raises
        ------
        ValueError
            Names the row.

        Examples
        --------
        >>> riffler.Tool.ball(6, 30).with_shank([(30, 3, 60, 3)]).shank
        [(30.0, 3.0, 60.0, 3.0)]
        """
    @property
    def diameter(self) -> float:
        """
        Largest diameter of the cutter, mm.
        """
    @property
    def holder(self) -> list[tuple[float, float, float, float]]:
        """
        Truncated cones (z0, r0, z1, r1), mm.
        """
    @property
    def hulls(self) -> list[numpy.typing.NDArray[numpy.float64]]:
        """
        The corners of each convex body of a hand tool, mm: arrays of shape (k, 3). Empty for tools of revolution.
        """
    @property
    def kind(self) -> str:
        """
        "ball", "flat" …, "profile", or a hand tool's: "chisel", …, "convex".
        """
    @property
    def length(self) -> float:
        """
        Length from the tip to the end of the cutter, mm.
        """
    @property
    def name(self) -> str:
        """
        Name in messages and tool libraries.
        """
    @property
    def shank(self) -> list[tuple[float, float, float, float]]:
        """
        Truncated cones (z0, r0, z1, r1), mm.
        """
class ToolSize:
    """
    One size of a cutter shape. It means the same in every shape that has it. See `Tool.shapes`.
    """
    def __repr__(self) -> str:
        ...
    @property
    def default(self) -> bool | float:
        """
        First value of a form; suits a cutter of 6 mm.
        """
    @property
    def description(self) -> str:
        """
        One phrase for a form's tooltip.
        """
    @property
    def high(self) -> float:
        """
        Largest value that a form should offer.
        """
    @property
    def label(self) -> str:
        """
        Short name for a form.
        """
    @property
    def largest(self) -> float | None:
        """
        Largest multiple of the diameter that a form should offer, or None.
        """
    @property
    def low(self) -> float:
        """
        Smallest value that a form should offer.
        """
    @property
    def name(self) -> str:
        """
        The argument's name, and the key in a tool's dict.
        """
    @property
    def unit(self) -> str:
        """
        "mm", "rad" or "bool".
        """
class ToolShape:
    """
    A named cutter shape, one row of the table of cutters. See `Tool.shapes`.
    """
    def __repr__(self) -> str:
        ...
    @property
    def description(self) -> str:
        """
        One phrase for a form's tooltip.
        """
    @property
    def label(self) -> str:
        """
        Short name for a form.
        """
    @property
    def name(self) -> str:
        """
        The kind of its tools, and the function of Tool that makes them.
        """
    @property
    def sizes(self) -> list[ToolSize]:
        """
        In the order of the function's arguments; one is "diameter", one "length".
        """
class Volume:
    """
    A dexel volume: material as spans along parallel rays.

    ``directions`` is "z" for one grid of rays or "xyz" for three (a tri-dexel volume, which also keeps the surface's
    normals and so its sharp edges). Ray (i, j) of "z" is at lower + ((i + .5) h, (j + .5) h); "x" rays are indexed
    (y, z), "y" rays (z, x). Lengths in mm.

    Make volumes with `block`, `empty`, `sphere`, `cylinder`, `from_mesh` and `load`. Set operators work on volumes
    with the same lower, upper, pitch and directions: ``v | w``, ``v & w``, ``v - w`` give a new volume, ``v |= w``,
    ``v &= w``, ``v -= w`` change v.

    Examples
    --------
    >>> block = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
    >>> ball = riffler.Volume.sphere((10, 10, 10), 6, pitch=0.5, lower=block.lower, upper=block.upper)
    >>> dish = block - ball
    >>> bool(dish.volume < block.volume), (dish | ball).volume == block.volume
    (True, True)
    """
    @staticmethod
    def block(lower: numpy.typing.ArrayLike, upper: numpy.typing.ArrayLike, pitch: typing.SupportsFloat, directions: str = 'z') -> Volume:
        """
        A box full of material.

        Parameters
        ----------
        lower, upper : array_like of shape (3,), mm
            Opposite corners of the box.
        pitch : float, mm
            Distance of neighbouring rays.
        directions : "z" or "xyz"
            One grid of rays, or three.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        ValueError
            Before anything is allocated, if it does not fit in memory.

        Examples
        --------
        >>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).volume
        24.0
        """
    @staticmethod
    def cylinder(centre: numpy.typing.ArrayLike, radius: typing.SupportsFloat, height: typing.SupportsFloat, pitch: typing.SupportsFloat, directions: str = 'z', *, axis: numpy.typing.ArrayLike = (0, 0, 1), lower: numpy.typing.ArrayLike | None = None, upper: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        A cylinder of material, made of exact rays as `sphere`.

        The caps are planes, and meet the side at a sharp edge in volumes of three directions.

        Parameters
        ----------
        centre : array_like of shape (3,), mm
            The middle of the cylinder.
        radius : float, mm
            Of the cylinder.
        height : float, mm
            Along the axis.
        pitch : float, mm
            Distance of neighbouring rays.
        directions : "z" or "xyz"
            One grid of rays, or three.
        axis : array_like of shape (3,), of any length but 0
            Direction of the axis.
        lower, upper : array_like of shape (3,), mm, or None
            The volume's box; material outside it is clipped. Default: the cylinder's own.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        ValueError
            As for `sphere`.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> rod = riffler.Volume.cylinder((0, 0, 0), 2, 10, pitch=0.1, axis=(1, 0, 0))
        >>> round(rod.volume)
        126
        """
    @staticmethod
    def empty(lower: numpy.typing.ArrayLike, upper: numpy.typing.ArrayLike, pitch: typing.SupportsFloat, directions: str = 'z') -> Volume:
        """
        A box without material, to add material to (``carve`` with mode "add", ``|=``).

        Parameters
        ----------
        lower, upper : array_like of shape (3,), mm
            Opposite corners of the box.
        pitch : float, mm
            Distance of neighbouring rays.
        directions : "z" or "xyz"
            One grid of rays, or three.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        ValueError
            The box is empty or does not fit in memory.

        Examples
        --------
        >>> riffler.Volume.empty((0, 0, 0), (4, 3, 2), pitch=0.5).volume
        0.0
        """
    @staticmethod
    def from_bytes(data: typing_extensions.Buffer, *, name: str = 'volume') -> Volume:
        """
        A volume from the bytes of `to_bytes`.

        Parameters
        ----------
        data : bytes, or another buffer
            Of a .rvol file.
        name : str
            Name for messages.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        FormatError
            The bytes are damaged.

        Examples
        --------
        >>> data = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_bytes()
        >>> riffler.Volume.from_bytes(data).volume
        24.0
        """
    @staticmethod
    def from_mesh(mesh: Mesh, pitch: typing.SupportsFloat, directions: str = 'z', *, lower: numpy.typing.ArrayLike | None = None, upper: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        The solid within a mesh: points whose absolute generalized winding number exceeds 1/2.

        Inside-out, overlapping, touching and open parts are fine, as are triangles that face against their neighbours and
        repeated ones (`Mesh.orient`). Material thinner than the pitch may be lost: more than crumbs of it raise a
        UserWarning; `from_mesh_with_report` puts it into its report.

        Parameters
        ----------
        mesh : Mesh
            A mesh with a volume greater than 0.
        pitch : float, mm
            Distance of neighbouring rays.
        directions : "z" or "xyz"
            One grid of rays, or three.
        lower, upper : array_like of shape (3,), mm, or None
            The volume's box; material outside it is clipped. Default: the mesh's own.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        ValueError
            The mesh is flat or empty, or the volume does not fit in memory.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> mesh = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5, directions="xyz").to_mesh()
        >>> round(riffler.Volume.from_mesh(mesh, 0.25).volume, 3)
        24.0
        """
    @staticmethod
    def from_mesh_with_report(mesh: Mesh, pitch: typing.SupportsFloat, directions: str = 'z', *, lower: numpy.typing.ArrayLike | None = None, upper: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> tuple[Volume, riffler.results.VolumeReport]:
        """
        The same as `from_mesh`, with a report on the mesh's faults and the lost material.

        Parameters
        ----------
        mesh : Mesh
            A mesh with a volume greater than 0.
        pitch : float, mm
            Distance of neighbouring rays.
        directions : "z" or "xyz"
            One grid of rays, or three.
        lower, upper : array_like of shape (3,), mm, or None
            The volume's box; material outside it is clipped. Default: the mesh's own.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        (Volume, VolumeReport)
            The volume, and the report.

        Raises
        ------
        ValueError
            As `from_mesh`.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> mesh = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh()
        >>> volume, report = riffler.Volume.from_mesh_with_report(mesh, 0.25)
        >>> report.open_edges, report.lost_note
        (0, '')
        """
    @staticmethod
    def load(path: os.PathLike | str | bytes, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        Reads a .rvol file.

        Parameters
        ----------
        path : path_like
            The file.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        FormatError
            The file is damaged or not a .rvol file. Names the byte.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).save("block.rvol")
        >>> riffler.Volume.load("block.rvol").volume
        24.0
        """
    @staticmethod
    def sphere(centre: numpy.typing.ArrayLike, radius: typing.SupportsFloat, pitch: typing.SupportsFloat, directions: str = 'z', *, lower: numpy.typing.ArrayLike | None = None, upper: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        A ball of material, made of exact rays: it has no facets.

        Each end of a span is at the ray's intersection with the sphere, to rounding, with the sphere's normal.

        Parameters
        ----------
        centre : array_like of shape (3,), mm
            Of the ball.
        radius : float, mm
            Of the ball.
        pitch : float, mm
            Distance of neighbouring rays.
        directions : "z" or "xyz"
            One grid of rays, or three.
        lower, upper : array_like of shape (3,), mm, or None
            The volume's box; material outside it is clipped. Default: the ball's own.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        ValueError
            All rays of a direction miss the ball. The message names a pitch at which they do not.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> ball = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.1)
        >>> round(ball.volume)
        524
        """
    def __and__(self, arg0: Volume) -> Volume:
        ...
    def __copy__(self) -> Volume:
        ...
    def __deepcopy__(self, arg0: dict) -> Volume:
        ...
    def __getstate__(self) -> bytes:
        ...
    def __iand__(self, arg0: Volume) -> Volume:
        ...
    def __ior__(self, arg0: Volume) -> Volume:
        ...
    def __isub__(self, arg0: Volume) -> Volume:
        ...
    def __or__(self, arg0: Volume) -> Volume:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: bytes) -> None:
        ...
    def __sub__(self, arg0: Volume) -> Volume:
        ...
    def add(self, other: Volume, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        Adds the other volume's material, in place: ``v |= other`` with progress; see `subtract`.

        Parameters
        ----------
        other : Volume
            Of the same lower, upper, pitch and directions.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            This volume.

        Examples
        --------
        >>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> riffler.Volume.empty((0, 0, 0), (4, 3, 2), pitch=0.5).add(block).volume
        24.0
        """
    def brush(self, kind: str, dabs: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.SupportsFloat, *, strength: typing.SupportsFloat = 1.0, amount: typing.SupportsFloat = 0.0, falloff: str = 'smooth', protect: Volume | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Brushed:
        """
        Displaces the surface by dabs of a round brush with falloff; volumes with directions "xyz" only.

        With f the falloff at a point times ``strength``, and the axis that of the dab:

        ============ =========================================================================================
        "clay"       adds a layer of f · amount along the axis where the surface faces it; a negative one digs
        "inflate"    f · amount along the surface's own normal; a negative one deflates
        "flatten"    f of the distance to the mean plane of the surface in the radius, raised by amount
        "scrape"     as "flatten", only what stands above the plane
        "fill"       as "flatten", only what lies below the plane
        "grab"       f times the vector from the first dab's centre to the last one's, as one displacement
        "snake_hook" f times the vector from each dab's centre to the next one's
        "pinch"      f / 2 of the distance to the line through the centre along the axis
        "crease"     as "pinch", and f² / strength · amount along the axis: negative for a furrow, positive for a ridge
        "twist"      turns by f · amount, in rad, about that line
        ============ =========================================================================================

        Nothing changes, to the bit, farther than the radius from the centres; for "grab" and "snake_hook", from the line that
        the centre moves on. Detail as fine as a pitch moves along where the displacement is along the surface's normal; a
        displacement along the surface resamples it. Material never leaves the volume's box.

        Parameters
        ----------
        kind : str
            One of the names above.
        dabs : array_like of shape (n, 6), mm
            Centre of each dab and its unit axis, out of the material.
        radius : float, mm
            Radius of the brush.
        strength : float, from 0 to 1
            Factor of the displacement.
        amount : float
            Displacement at the centre, mm, or rad for "twist".
        falloff : str
            "smooth", "smoother", "sphere", "root", "sharp", "linear", "sharper", "inverse_square" or "constant": see
            ``riffler.falloff``.
        protect : Volume or None
            Region that must not change, material and air; a volume with the same lower, upper, pitch and directions.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Brushed
            The volumes removed and added, and what was cut off.

        Raises
        ------
        ValueError
            The volume has one direction only; the protected volume's grid is another; names argument and row.
        Cancelled
            ``progress`` returned False; the volume is unchanged.

        Examples
        --------
        >>> volume = riffler.Volume.sphere((0, 0, 0), 20, 0.5, "xyz", lower=(-23,) * 3, upper=(23,) * 3)
        >>> made = volume.brush("clay", [(0, 0, 20, 0, 0, 1)], 8, amount=1)
        >>> bool(made.added > 0), made.clipped
        (True, False)
        """
    def carve(self, tool: Tool, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, tolerance: typing.SupportsFloat = 0.01, dt: numpy.typing.ArrayLike | None = None, removal_constant: typing.SupportsFloat = 0.05, mode: str = 'remove', protect: Volume | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Cut:
        """
        Removes what the cutter sweeps along a path, or adds it. Shank and holder never cut.

        Parameters
        ----------
        tool : Tool
            Its cutter is swept.
        poses : array_like of shape (n, 6), tip in mm and unit axis
            Tip xyz, then unit axis xyz from the tip to the spindle; n - 1 moves. A hand tool (`Tool.convex` and its like) needs
            the shape (n, 9): then its unit forward direction xyz, square to the axis.
        tolerance : float, mm
            Tolerance of moves that turn the axis; others are exact.
        dt : array_like, a number or of shape (n - 1,), s, or None
            Duration of the moves; needed for force.
        removal_constant : float, N·s/mm³
            Force for each rate of removal.
        mode : "remove" or "add"
            "add" adds material wherever the cutter sweeps within the volume's box; ``removed`` then has the added volume.
        protect : Volume or None
            Region that must not change, material and air; a volume with the same lower, upper, pitch and directions.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Cut
            The volume that each move removed.

        Raises
        ------
        ValueError
            Names argument and row: a wrong shape, an axis that is not a unit vector, opposite axes, for a hand tool a forward
            direction that is not square to the axis and a half turn; or the protected volume's grid is another.
        Cancelled
            ``progress`` returned False; the volume is unchanged.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
        >>> cut = volume.carve(riffler.Tool.flat(6, 30), [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]], dt=1.0)
        >>> cut.removed.round(3).tolist(), bool(cut.force[0, 0] < 0)
        ([240.0], True)
        """
    def clip(self, point: numpy.typing.ArrayLike, normal: numpy.typing.ArrayLike, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        Removes the material in front of a plane, in place; the plane's normal is that of the new face.

        Parameters
        ----------
        point : array_like of shape (3,), mm
            A point on the plane.
        normal : array_like of shape (3,), of any length but 0
            Points to the side that is removed.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            This volume.

        Raises
        ------
        ValueError
            A normal of length 0.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> volume.clip(point=(0, 0, 1), normal=(0, 0, 1)).volume
        12.0
        """
    def contains(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.bool]:
        """
        Whether points are in the material, by the nearest ray of each direction; with three directions, by the majority.

        Parameters
        ----------
        points : array_like of shape (n, 3), mm
            Anywhere.

        Returns
        -------
        ndarray of shape (n,), bool
            One for each point.

        Examples
        --------
        >>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).contains([[1, 1, 1], [1, 1, 3]]).tolist()
        [True, False]
        """
    def copy(self) -> Volume:
        """
        An independent volume; shares its tiles until one of the two is written.

        Returns
        -------
        Volume
            A new volume.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> volume.copy().to_bytes() == volume.to_bytes()
        True
        """
    def grow(self, lower: numpy.typing.ArrayLike | None = None, upper: numpy.typing.ArrayLike | None = None, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        This volume in a larger box: a new volume with the same spans and normals, bit for bit.

        Rays stay in place, and rays without material are added next to them: each side of the box moves outward by
        whole pitches until it lies at or beyond that of ``lower`` to ``upper``, to 1e-6 of a pitch. A side that does already
        stays. Where a box's size is not a whole number of pitches, an upper side may move one pitch more; ``volume`` then counts
        the rays that were last with whole cells.

        Parameters
        ----------
        lower, upper : array_like of shape (3,), mm, or None
            The box to reach. Default: this volume's own.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        ValueError
            Before anything is allocated, if the box does not fit in memory.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> volume.grow(upper=(6, 3, 2)).upper.tolist()
        [6.0, 3.0, 2.0]
        """
    def intersect(self, other: Volume, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        Keeps the material that both volumes have, in place: ``v &= other`` with progress; see `subtract`.

        Parameters
        ----------
        other : Volume
            Of the same lower, upper, pitch and directions.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            This volume.

        Examples
        --------
        >>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> block.copy().intersect(block).volume
        24.0
        """
    def intervals(self, direction: str) -> tuple:
        """
        The material along every ray of a direction.

        Parameters
        ----------
        direction : "x", "y" or "z", one that the volume has
            Of the rays.

        Returns
        -------
        counts : ndarray of shape (nu, nv), uint32
            Spans of each ray.
        spans : ndarray of shape (counts.sum(), 2), float64, mm
            Near and far end of each span: coordinates along the ray, rays in C order.

        Raises
        ------
        ValueError
            The volume has no such rays.

        Examples
        --------
        >>> counts, spans = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).intervals("z")
        >>> counts.shape, spans[0].tolist()
        ((8, 6), [0.0, 2.0])
        """
    def normals(self, direction: str) -> numpy.typing.NDArray[numpy.float64]:
        """
        The surface's normals at the ends of the spans of `intervals`; volumes with directions "xyz" only.

        Parameters
        ----------
        direction : "x", "y" or "z", one that the volume has
            Of the rays.

        Returns
        -------
        ndarray of shape (spans, 2, 3), float64
            Unit normals at near and far ends, out of the material.

        Raises
        ------
        ValueError
            The volume has no such rays, or no normals.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5, directions="xyz")
        >>> volume.normals("z")[0].round(3).tolist()
        [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]
        """
    def parts(self, *, minimum: typing.SupportsFloat = 0.0, progress: collections.abc.Callable[[float], bool | None] | None = None) -> list[Volume]:
        """
        The connected pieces of this volume as volumes on the same grid, the largest first.

        Spans of neighbouring rays are connected where they overlap. The parts' volumes sum to this one's.

        Parameters
        ----------
        minimum : float, mm³
            Smaller pieces stay with the largest.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        list of Volume
            New volumes.

        Raises
        ------
        ValueError
            More than 1000 pieces, or a negative ``minimum``.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
        >>> cut = volume.carve(riffler.Tool.flat(4, 30), [[-5, 12, 0, 0, 0, 1], [25, 12, 0, 0, 0, 1]])
        >>> [part.volume for part in volume.parts()]
        [2000.0, 1200.0]
        """
    def resample(self, pitch: typing.SupportsFloat, directions: str | None = None, *, lower: numpy.typing.ArrayLike | None = None, upper: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        This volume at another pitch, with other directions or in another box: a new volume.

        Material outside the new box is left out. Resamples the mesh of `to_mesh`, so a finer pitch brings no
        detail back. A volume with the same pitch, directions and box is a copy, bit for bit.

        Parameters
        ----------
        pitch : float, mm
            Distance of neighbouring rays.
        directions : "z", "xyz" or None
            Default: this volume's own.
        lower, upper : array_like of shape (3,), mm, or None
            The box. Default: this volume's own.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            A new volume.

        Raises
        ------
        ValueError
            The volume does not fit in memory.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> fine = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5, directions="xyz").resample(0.25)
        >>> round(fine.volume, 3), fine.pitch
        (24.0, 0.25)
        """
    def restore(self, snapshot: Snapshot) -> None:
        """
        Restores a snapshot of this volume.

        Parameters
        ----------
        snapshot : Snapshot
            A result of `snapshot`.

        Raises
        ------
        ValueError
            The snapshot is of a volume with another box, pitch or directions.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> before = volume.snapshot()
        >>> half = volume.clip((2, 0, 0), (1, 0, 0))
        >>> volume.restore(before)
        >>> volume.volume
        24.0
        """
    def save(self, path: os.PathLike | str | bytes, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        """
        Writes a .rvol file, whole or not at all. Equal volumes are equal files.

        Parameters
        ----------
        path : path_like
            The file; an existing one is replaced.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Raises
        ------
        RuntimeError
            The file cannot be written.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).save("block.rvol")
        >>> riffler.Volume.load("block.rvol")
        <riffler.Volume "z", pitch 0.5 mm, 8 × 6 rays>
        """
    def smooth(self, centres: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.SupportsFloat, *, strength: typing.SupportsFloat = 0.5, protect: Volume | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Smoothed:
        """
        Smooths the surface by dabs of a round brush, one after the other; volumes with directions "xyz" only.

        A dab levels what is finer than about four pitches and moves nothing by more than one pitch; repeat it for more. Planes
        stay planes, edges become round, convex places lose material and concave ones get some, within the volume's box only.

        Parameters
        ----------
        centres : array_like of shape (n, 3) or (3,), mm
            Centres of the dabs.
        radius : float, mm
            Radius of the brush; material beyond it is unchanged.
        strength : float, from 0 to 1
            Blend factor at the brush's centre: 0 unchanged, 1 fully smoothed; less towards the rim.
        protect : Volume or None
            Region that must not change, material and air; a volume with the same lower, upper, pitch and directions.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Smoothed
            The volumes that each dab removed and added.

        Raises
        ------
        ValueError
            The volume has one direction only; the protected volume's grid is another; names argument and row.
        Cancelled
            ``progress`` returned False; the volume is unchanged.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz")
        >>> moved = volume.smooth((20, 10, 10), radius=4)
        >>> bool(moved.removed[0] > 0), len(moved)
        (True, 1)
        """
    def snapshot(self) -> Snapshot:
        """
        The present state, for `restore`; costs pointers only.

        Returns
        -------
        Snapshot
            The state of this volume at the call.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
        >>> before = volume.snapshot()
        >>> cut = volume.carve(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
        >>> volume.restore(before)
        >>> volume.volume
        4000.0
        """
    def subtract(self, other: Volume, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        Removes the other volume's material, in place: ``v -= other`` with progress.

        Parameters
        ----------
        other : Volume
            Of the same lower, upper, pitch and directions.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume
            This volume.

        Raises
        ------
        ValueError
            The other volume's grid is another.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> block.copy().subtract(block).volume
        0.0
        """
    def take_counters(self) -> riffler.results.VolumeCounters:
        """
        The counters, which start again from 0.

        Returns
        -------
        VolumeCounters
            The work since the volume was made, or since the last call.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
        >>> cut = volume.carve(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
        >>> volume.take_counters().moves, volume.counters.moves
        (1, 0)
        """
    def to_bytes(self, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> bytes:
        """
        The bytes of the .rvol file.

        Parameters
        ----------
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        bytes
            The same for equal volumes.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
        >>> riffler.Volume.from_bytes(volume.to_bytes()).volume
        24.0
        """
    def to_mesh(self, *, tolerance: typing.SupportsFloat | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Mesh:
        """
        The surface: closed, outward, two-manifold, and still so in a binary STL.

        Material thinner than the pitch is not part of it. A UserWarning reports more than crumbs of such material;
        `to_mesh_with_report` puts it into its report.

        Parameters
        ----------
        tolerance : float, mm, or None
            Leaves out triangles that the shape does not need: no point of the mesh is farther than this from the surface of
            all triangles, and the reverse. It is as closed and as sharp at edges, and its vertices are some of theirs. None, or
            less than the step of float32 at the box's largest coordinate (0 too): all triangles. More than the size of the part
            keeps at least four triangles of each shell.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        Mesh
            Without triangles for an empty volume.

        Raises
        ------
        ValueError
            A tolerance that is negative or not finite.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh().audit().open_edges
        0
        >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.25, directions="xyz")
        >>> len(volume.to_mesh().triangles) > 100 * len(volume.to_mesh(tolerance=0.02).triangles)
        True
        """
    def to_mesh_with_report(self, *, tolerance: typing.SupportsFloat | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> tuple[Mesh, riffler.results.SurfaceReport]:
        """
        The same as `to_mesh`, with a report on material that is too thin for the pitch and so not part of the mesh.

        Parameters
        ----------
        tolerance : float, mm, or None
            Leaves out triangles that the shape does not need: no point of the mesh is farther than this from the surface of
            all triangles, and the reverse. It is as closed and as sharp at edges, and its vertices are some of theirs. None, or
            less than the step of float32 at the box's largest coordinate (0 too): all triangles. More than the size of the part
            keeps at least four triangles of each shell.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        (Mesh, SurfaceReport)
            The mesh, and the report.

        Raises
        ------
        ValueError
            A tolerance that is negative or not finite.
        Cancelled
            ``progress`` returned False.

        Examples
        --------
        >>> mesh, report = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh_with_report()
        >>> report.lost, report.lost_box, report.all_triangles == len(mesh.triangles)
        (0.0, None, True)
        """
    @property
    def counters(self) -> riffler.results.VolumeCounters:
        """
        VolumeCounters: the work since the volume was made, or since `take_counters`. Reading them changes nothing.
        """
    @property
    def directions(self) -> str:
        """
        "z" or "xyz".
        """
    @property
    def lower(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) mm: the box's corner with the smallest coordinates.
        """
    @property
    def nbytes(self) -> int:
        """
        Bytes held, shared tiles counted once.
        """
    @property
    def pitch(self) -> float:
        """
        Distance of neighbouring rays, mm.
        """
    @property
    def rays(self) -> int:
        """
        Number of rays, all directions.
        """
    @property
    def revision(self) -> int:
        """
        Number that changes with the content.
        """
    @property
    def upper(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) mm: the box's corner with the largest coordinates.
        """
    @property
    def volume(self) -> float:
        """
        mm³: sum of length × area of the z rays, or of the only rays if there are no z rays. The area is h², except for the last rays, whose cells end with the box.
        """
class Cut:
    """
    The volume and force of each move of a carve; arrays with one row per move. See `Volume.carve`.
    """
    def __len__(self) -> int:
        ...
    @property
    def force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N on the tool, against its motion; zeros unless dt was given.
        """
    @property
    def removed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm³.
        """
    @property
    def torque(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N·mm about the tip at the move's end.
        """
class Snapshot:
    """
    The state of a volume at one time; shares its tiles until they are written. See `Volume.snapshot`.
    """
    @property
    def nbytes(self) -> int:
        """
        Bytes held, shared tiles counted once.
        """
    @property
    def revision(self) -> int:
        """
        The volume's revision at that time.
        """
    @property
    def volume(self) -> float:
        """
        mm³ of material.
        """
class Smoothed:
    """
    The effect of each dab of a smooth brush; arrays with one number per dab. See `Volume.smooth`.
    """
    def __len__(self) -> int:
        ...
    @property
    def added(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm³ added.
        """
    @property
    def removed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm³ removed.
        """
class Brushed:
    """
    The effect of the dabs of a brush. See `Volume.brush`.
    """
    @property
    def added(self) -> float:
        """
        mm³ added, summed over the dabs.
        """
    @property
    def clipped(self) -> bool:
        """
        Whether material reached the volume's box and was cut off there; `Volume.grow` enlarges it.
        """
    @property
    def lost(self) -> float:
        """
        mm³ of walls thinner than the pitch that a displacement sideways by more than a pitch dropped.
        """
    @property
    def removed(self) -> float:
        """
        mm³ removed, summed over the dabs.
        """
class History:
    """
    A base volume and strokes in order that stay editable.

    ``h.volume`` is always, byte for byte, what ``base.carve(...)`` with the enabled strokes in order gives. Each tile keeps
    its versions after the strokes that touch it. An edit sets the tiles that its stroke touches back to the version before
    it, and carves only the later strokes that touch these tiles, only there; it stops where a tile has its old content again.

    The base is a snapshot: carving the volume later does not change the history. An edit that fails or is cancelled leaves
    everything unchanged. Edits release Python's lock and use the number of threads of any long call.

    Parameters
    ----------
    base : Volume
        The volume that the strokes are carved into.
    memory_limit : int, bytes
        For the versions of tiles, about 25 kB each with rays in three directions. Beyond it, the history keeps every second,
        fourth, … version of a tile, and an edit carves up to as many more strokes there. An edit needs as much again while it
        runs.

    Examples
    --------
    >>> block = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz")
    >>> history = riffler.History(block)
    >>> ball = riffler.Tool.ball(6, 30)
    >>> first = history.add(ball, [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
    >>> second = history.add(ball, [[10, 5, 8, 0, 0, 1], [10, 15, 8, 0, 0, 1]])
    >>> history.replace(first, poses=[[5, 12, 7, 0, 0, 1], [15, 12, 7, 0, 0, 1]])
    >>> cut = block.carve(ball, [[5, 12, 7, 0, 0, 1], [15, 12, 7, 0, 0, 1]])
    >>> cut = block.carve(ball, [[10, 5, 8, 0, 0, 1], [10, 15, 8, 0, 0, 1]])
    >>> history.volume.to_bytes() == block.to_bytes()
    True
    """
    def __init__(self, base: Volume, *, memory_limit: typing.SupportsInt = 536870912) -> None:
        ...
    def __len__(self) -> int:
        ...
    def add(self, tool: Tool, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, mode: str = 'remove', tolerance: typing.SupportsFloat = 0.01, protect: Volume | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> int:
        """
        Adds a stroke at the end. It carves like ``volume.carve`` with the same arguments.

        Parameters
        ----------
        tool : Tool
            Its cutter is swept.
        poses : array_like of shape (n, 6), tip in mm and unit axis
            Tip xyz, then unit axis xyz from the tip to the spindle; n - 1 moves. For a hand tool (n, 9), as in `Volume.carve`.
        mode : "remove" or "add"
            "add" puts material on wherever the cutter sweeps within the volume's box.
        tolerance : float, mm
            Tolerance of moves that turn the axis; others are exact.
        protect : Volume or None
            Of the base's lower, upper, pitch and directions; what lies in it stays unchanged by this stroke. Kept as a snapshot.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        int
            The stroke's id, for the other calls. Ids are never reused.

        Raises
        ------
        ValueError
            The history has no such stroke; or names argument and row: no poses, a wrong shape, an axis that is not a unit vector, opposite
            axes, a protected volume with another grid. The history is unchanged.
        Cancelled
            ``progress`` returned False; the history is unchanged.

        Examples
        --------
        >>> block = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
        >>> history = riffler.History(block)
        >>> history.add(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
        1
        """
    def enable(self, stroke: typing.SupportsInt, enabled: bool = True, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        """
        Enables or disables a stroke. A disabled stroke keeps its place and cuts nothing.

        Parameters
        ----------
        stroke : int
            Its id.
        enabled : bool
            False disables it.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Raises
        ------
        ValueError
            The history has no such stroke; or names argument and row: no poses, a wrong shape, an axis that is not a unit vector, opposite
            axes, a protected volume with another grid. The history is unchanged.
        Cancelled
            ``progress`` returned False; the history is unchanged.

        Examples
        --------
        >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> stroke = history.add(riffler.Tool.flat(6, 30), [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]])
        >>> history.enable(stroke, False)
        >>> history.volume.volume
        4000.0
        """
    def insert(self, tool: Tool, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, before: typing.SupportsInt, mode: str = 'remove', tolerance: typing.SupportsFloat = 0.01, protect: Volume | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> int:
        """
        Adds a stroke before another one; see `add`.

        Parameters
        ----------
        tool : Tool
            Its cutter is swept.
        poses : array_like of shape (n, 6), tip in mm and unit axis
            As for `add`.
        before : int
            Id of the stroke that follows the new one.
        mode : "remove" or "add"
            As for `add`.
        tolerance : float, mm
            Tolerance of moves that turn the axis; others are exact.
        protect : Volume or None
            As for `add`.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Returns
        -------
        int
            The new stroke's id.

        Raises
        ------
        ValueError
            The history has no such stroke; or names argument and row: no poses, a wrong shape, an axis that is not a unit vector, opposite
            axes, a protected volume with another grid. The history is unchanged.
        Cancelled
            ``progress`` returned False; the history is unchanged.

        Examples
        --------
        >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> ball = riffler.Tool.ball(6, 30)
        >>> last = history.add(ball, [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
        >>> first = history.insert(ball, [[5, 5, 8, 0, 0, 1], [15, 5, 8, 0, 0, 1]], before=last)
        >>> history.ids == [first, last]
        True
        """
    def move(self, stroke: typing.SupportsInt, *, before: typing.SupportsInt | None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        """
        Moves a stroke to another place in the order.

        Parameters
        ----------
        stroke : int
            Its id.
        before : int or None
            Id of the stroke to move it before; None: to the end. Its own id: no change.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Raises
        ------
        ValueError
            The history has no such stroke; or names argument and row: no poses, a wrong shape, an axis that is not a unit vector, opposite
            axes, a protected volume with another grid. The history is unchanged.
        Cancelled
            ``progress`` returned False; the history is unchanged.

        Examples
        --------
        >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> poses = [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]]
        >>> cut = history.add(riffler.Tool.flat(6, 30), poses)
        >>> fill = history.add(riffler.Tool.flat(4, 30), poses, mode="add")
        >>> history.move(cut, before=None)
        >>> history.ids == [fill, cut], round(history.volume.volume, 6)
        (True, 3760.0)
        """
    def remove(self, stroke: typing.SupportsInt, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        """
        Removes a stroke for good; `enable` can bring a disabled stroke back.

        Parameters
        ----------
        stroke : int
            Its id.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Raises
        ------
        ValueError
            The history has no such stroke; or names argument and row: no poses, a wrong shape, an axis that is not a unit vector, opposite
            axes, a protected volume with another grid. The history is unchanged.
        Cancelled
            ``progress`` returned False; the history is unchanged.

        Examples
        --------
        >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> stroke = history.add(riffler.Tool.flat(6, 30), [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]])
        >>> history.remove(stroke)
        >>> history.volume.volume, history.ids
        (4000.0, [])
        """
    def replace(self, stroke: typing.SupportsInt, *, tool: Tool | None = None, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None, mode: str | None = None, tolerance: typing.SupportsFloat | None = None, protect: Volume | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        """
        Changes a stroke. It keeps its id, its place in the order, and whether it is enabled.

        Parameters
        ----------
        stroke : int
            Its id.
        tool : Tool or None
            None: unchanged.
        poses : array_like of shape (n, 6), tip in mm and unit axis, or None
            None: unchanged.
        mode : "remove", "add" or None
            None: unchanged.
        tolerance : float, mm, or None
            None: unchanged.
        protect : Volume or None
            None: unchanged; an empty volume protects nothing.
        progress : callable or None
            Called with the finished share; returning False cancels.

        Raises
        ------
        ValueError
            The history has no such stroke; or names argument and row: no poses, a wrong shape, an axis that is not a unit vector, opposite
            axes, a protected volume with another grid. The history is unchanged.
        Cancelled
            ``progress`` returned False; the history is unchanged.

        Examples
        --------
        >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> stroke = history.add(riffler.Tool.flat(6, 30), [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]])
        >>> history.replace(stroke, tool=riffler.Tool.flat(4, 30))
        >>> round(history.volume.volume, 6)
        3840.0
        """
    def stats(self) -> riffler.results.HistoryStats:
        """
        The work of the last edit, and the size of the history.

        Returns
        -------
        HistoryStats
            An edit restores only the tiles that the edited stroke touches, and runs only later strokes, in these tiles.

        Examples
        --------
        >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (80, 20, 10), pitch=0.5))
        >>> ball = riffler.Tool.ball(6, 30)
        >>> left = history.add(ball, [[5, 8, 8, 0, 0, 1], [8, 8, 8, 0, 0, 1]])
        >>> right = history.add(ball, [[70, 8, 8, 0, 0, 1], [74, 8, 8, 0, 0, 1]])
        >>> history.replace(left, poses=[[5, 8, 7, 0, 0, 1], [8, 8, 7, 0, 0, 1]])
        >>> history.stats().tiles_restored, history.stats().strokes_run
        (1, 1)
        """
    def stroke(self, stroke: typing.SupportsInt) -> riffler.results.HistoryStroke:
        """
        A stroke's content.

        Parameters
        ----------
        stroke : int
            Its id.

        Returns
        -------
        HistoryStroke
            A copy.

        Raises
        ------
        ValueError
            The history has no such stroke.

        Examples
        --------
        >>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> stroke = history.add(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
        >>> history.stroke(stroke).mode, history.stroke(stroke).poses.shape, history.stroke(stroke).enabled
        ('remove', (2, 6), True)
        """
    @property
    def base(self) -> Volume:
        """
        Volume: the base before all strokes; an independent volume that shares its tiles.
        """
    @property
    def ids(self) -> list[int]:
        """
        list of int: the ids of all strokes in order, disabled ones included.
        """
    @property
    def volume(self) -> Volume:
        """
        Volume: the base with the enabled strokes. An independent volume that shares its tiles: costs pointers only.
        """
class FrozenSurface:
    """
    The surface of a mesher at the time of `Mesher.freeze`, to be picked; it never changes. See `Mesher.freeze`.
    """
    def pick(self, origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> riffler.results.Hit | riffler.results.Hits | None:
        """
        The first point of the surface along a ray, or along each of several.

        No ray passes between two triangles, and a ray that touches an edge hits it.

        Parameters
        ----------
        origin : array_like of shape (3,) or (n, 3), mm
            Origin of each ray.
        direction : array_like of the same shape, of any length but 0
            Direction of each ray.

        Returns
        -------
        Hit, None or Hits
            For one ray a Hit, or None. For (n, 3) arrays a Hits with arrays of n rows: for a ray without a hit, ``distance`` is
            inf, ``brick`` -1, the rest NaN.

        Raises
        ------
        ValueError
            Names argument and row: a number that is not finite, or a direction of length 0.

        Examples
        --------
        >>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> hit = mesher.pick((10, 10, 20), (0, 0, -1))
        >>> round(hit.distance, 3), hit.normal.round(3).tolist()
        (10.0, [0.0, 0.0, 1.0])
        """
    def take_counters(self) -> riffler.results.PickCounters:
        """
        The counters, which start again from 0.

        Returns
        -------
        PickCounters
            The work since the last call.

        Examples
        --------
        >>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> hit = mesher.pick((10, 10, 20), (0, 0, -1))
        >>> mesher.take_counters().rays, mesher.counters.rays
        (1, 0)
        """
    @property
    def counters(self) -> riffler.results.PickCounters:
        """
        PickCounters: the work of picking since it was made, or since `take_counters`. Reading them changes nothing.
        """
    @property
    def nbytes(self) -> int:
        """
        Bytes of its triangles, of which it shares those of bricks that did not change with the mesher.
        """
    @property
    def triangles(self) -> int:
        """
        Number of triangles.
        """
class Mesher:
    """
    The mesh of a volume that keeps changing, in bricks of 32 × 32 × 32 cells.

    ``Mesher(volume)`` meshes the volume; ``update(volume)`` meshes only its changes. The mesh is
    always, bit for bit, that of ``volume.to_mesh()``, with a tolerance that of ``volume.to_mesh(tolerance=tolerance)``.
    It keeps a snapshot of the volume, which shares its tiles.

    With a tolerance, patches and `mesh` have only the triangles that the shape needs. The mesher keeps the full mesh too,
    for the next update: `pick` and `freeze` find the full surface, and ``patch(normals=...)`` takes its normals, so that a
    long triangle is shaded like the small ones that it replaces. It takes about a third more memory than without a tolerance.

    Parameters
    ----------
    volume : Volume
        The volume to mesh first.
    tolerance : float, mm, or None
        Leaves out triangles that the shape does not need within this distance, with the rules of `Volume.to_mesh`: 0, or
        less than the step of float32 at the part's coordinates, keeps all of them. None: all of them.
    progress : callable or None
        Called with the finished share; returning False cancels.

    Examples
    --------
    >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
    >>> mesher = riffler.Mesher(volume)
    >>> cut = volume.carve(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
    >>> changed = mesher.update(volume)
    >>> len(mesher.mesh().triangles) == len(volume.to_mesh().triangles)
    True
    >>> riffler.Mesher(volume, tolerance=0.05).triangles < 0.1 * mesher.triangles
    True

    Raises
    ------
    ValueError
        A tolerance that is negative or not finite.
    """
    def __init__(self, volume: Volume, *, tolerance: typing.SupportsFloat | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        ...
    def freeze(self) -> FrozenSurface:
        """
        Copies the current surface, for picking while the mesher follows the volume.

        A stroke that follows the surface on which it began does not climb into its own groove. What did not change since the
        last call is shared; the first call looks at all triangles.

        Returns
        -------
        FrozenSurface
            It never changes.

        Examples
        --------
        >>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> mesher.freeze().pick((10, 10, 20), (0, 0, 1)) is None
        True
        """
    def mesh(self) -> Mesh:
        """
        The whole mesh, the same as ``to_mesh()`` of the volume, with the mesher's tolerance.

        Returns
        -------
        Mesh
            A new mesh.

        Examples
        --------
        >>> riffler.Mesher(riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)).mesh().audit().open_edges
        0
        """
    def patch(self, bricks: typing.SupportsInt | collections.abc.Sequence[typing.SupportsInt], *, edges: bool = False, normals: typing.SupportsFloat | None = None) -> riffler.results.Patch:
        """
        The triangles of a brick, or of several without seams between them.

        The brick's own vertices come first, then those of its neighbours that its triangles touch; what two patches share has
        the same coordinates in both, bit for bit. With a tolerance, own vertices without a triangle of the patch are left out.

        Parameters
        ----------
        bricks : int or list of int
            Numbers as `patches` and `update` give them, each once.
        edges : bool
            Whether edges are wanted, and of each triangle's corners the edge to the next one: Blender's ``.edge_verts`` and
            ``.corner_edge``.
        normals : float, rad, or None
            Asks for normals of the triangles' corners on the whole mesh: the mean of the triangles around the vertex, in
            whatever brick, whose normals are within this angle of the corner's own. With a tolerance, the mean of those of the
            full mesh that bend no more than the surface under the triangle does.

        Returns
        -------
        Patch
            Without triangles if the brick has none.

        Raises
        ------
        IndexError
            There is no such brick.
        ValueError
            A brick is given twice.

        Examples
        --------
        >>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5))
        >>> patch = mesher.patch(0, normals=0.5)
        >>> patch.vertices.shape, patch.triangles.shape, patch.normals.shape
        ((210, 3), (416, 3), (1248, 3))
        """
    def patches(self) -> list[int]:
        """
        Numbers of the bricks that have triangles.

        Returns
        -------
        list of int
            Ascending.

        Examples
        --------
        >>> riffler.Mesher(riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)).patches()
        [0]
        """
    def pick(self, origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> riffler.results.Hit | riffler.results.Hits | None:
        """
        The first point of the surface along a ray, or along each of several.

        No ray passes between two triangles, and a ray that touches an edge hits it.

        Parameters
        ----------
        origin : array_like of shape (3,) or (n, 3), mm
            Origin of each ray.
        direction : array_like of the same shape, of any length but 0
            Direction of each ray.

        Returns
        -------
        Hit, None or Hits
            For one ray a Hit, or None. For (n, 3) arrays a Hits with arrays of n rows: for a ray without a hit, ``distance`` is
            inf, ``brick`` -1, the rest NaN.

        Raises
        ------
        ValueError
            Names argument and row: a number that is not finite, or a direction of length 0.

        Examples
        --------
        >>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> hit = mesher.pick((10, 10, 20), (0, 0, -1))
        >>> round(hit.distance, 3), hit.normal.round(3).tolist()
        (10.0, [0.0, 0.0, 1.0])
        """
    def take_counters(self) -> riffler.results.PickCounters:
        """
        The counters, which start again from 0.

        Returns
        -------
        PickCounters
            The work since the last call.

        Examples
        --------
        >>> mesher = riffler.Mesher(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
        >>> hit = mesher.pick((10, 10, 20), (0, 0, -1))
        >>> mesher.take_counters().rays, mesher.counters.rays
        (1, 0)
        """
    def update(self, volume: Volume, *, normals: bool = False) -> list[int]:
        """
        Follows a change of the volume.

        Parameters
        ----------
        volume : Volume
            As it is now.
        normals : bool
            Also return the bricks whose triangles are the same, but whose ``patch(normals=...)`` may have other normals, since
            they meet changed ones.

        Returns
        -------
        list of int
            Numbers of the bricks whose patches changed, ascending.

        Raises
        ------
        ValueError
            A volume with another box, pitch or directions.

        Examples
        --------
        >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
        >>> mesher = riffler.Mesher(volume)
        >>> mesher.update(volume)
        []
        """
    @property
    def all_triangles(self) -> int:
        """
        Number of triangles of the full mesh; without a tolerance the same as `triangles`.
        """
    @property
    def counters(self) -> riffler.results.PickCounters:
        """
        PickCounters: the work of picking since it was made, or since `take_counters`. Reading them changes nothing.
        """
    @property
    def shape(self) -> tuple[int, int, int]:
        """
        Number of bricks along each axis, with or without triangles: brick n is at ``numpy.unravel_index(n, shape)``.
        """
    @property
    def tolerance(self) -> float | None:
        """
        The tolerance that it was made with, mm; None: all triangles.
        """
    @property
    def triangles(self) -> int:
        """
        Number of triangles.
        """
class Contact:
    """
    Contact of a tool at a pose. Forces act on the tool, in the part's frame. See `Collider.query`.
    """
    def __repr__(self) -> str:
        ...
    @property
    def checked(self) -> float:
        """
        Share of the candidate triangles that was examined; 1 without a budget.
        """
    @property
    def depth(self) -> float:
        """
        mm; 0 without contact.
        """
    @property
    def force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        N, (3,): pushes the tool out of contact.
        """
    @property
    def missed_depth_bound(self) -> float:
        """
        mm: the true depth is at most depth + missed_depth_bound.
        """
    @property
    def parts(self) -> list[str]:
        """
        What touches at each point: "cutter", "shank", "holder", or "fixture" where it is one that is touched.
        """
    @property
    def points(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3) mm: the deepest point, then the sample points and pieces of fixtures that are in the tool.
        """
    @property
    def torque(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        N·mm, (3,), about the tip.
        """
class Collider:
    """
    A part and its fixtures, for contact and clearance of tools; immutable.

    A pose is 6 numbers: tip in mm, unit axis from the tip to the spindle. Calls may come from several threads; they release
    Python's lock.

    Parameters
    ----------
    part : Mesh or Surface
        The surface; an empty one is ignored. With an exact `Surface`, whose normals point out of the material, depth and
        clearance are those of the exact surface, to 1e-6 mm, and the force has no facets.
    fixtures : list of Volume
        Each may have its own pitch; empty ones are ignored.
    spacing : float, mm, or None
        Spacing of the points on the part over which forces are summed. Default: √(area / 100 000), of an exact
        `Surface` √(area / 400 000).
    stiffness : float, N per mm of depth and mm² of surface
        Against the cutter.
    holder_stiffness : float, N per mm of depth and mm² of surface
        Against shank and holder.
    fixture_stiffness : float, N per mm³ of a fixture in the tool, or a Material, or a list of one for each fixture
        Against the whole tool.
    fixture_push : {"normal", "centre"}
        Direction in which a fixture pushes: off the wall that the tool touches, or, as in the dissertation, towards the middle
        of cutter, shank or holder, which slides the tool along a wall.

    Raises
    ------
    ValueError
        Names the argument: a spacing that is not positive, another number of stiffnesses than of fixtures.

    Examples
    --------
    >>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz").to_mesh()
    >>> collider = riffler.Collider(part)
    >>> collider.clearance(riffler.Tool.ball(6, 30), [[10, 10, 12, 0, 0, 1]]).round(3).tolist()
    [2.0]
    """
    @staticmethod
    def made(part: Mesh | Surface, *, fixtures: collections.abc.Sequence[Volume] = [], spacing: typing.SupportsFloat | None = None, stiffness: typing.SupportsFloat = 1.0, holder_stiffness: typing.SupportsFloat = 10.0, fixture_stiffness: float | Material | collections.abc.Sequence[float | Material] = 10.0, fixture_push: typing.Literal['normal', 'centre'] = 'normal', progress: collections.abc.Callable[[float], bool | None] | None = None) -> Collider:
        """
        The same as ``Collider(…)``, as a function with progress: what `riffler.submit` calls.

        Parameters
        ----------
        part : Mesh or Surface
            The surface; an empty one is ignored. With an exact `Surface`, whose normals point out of the material, depth and
            clearance are those of the exact surface, to 1e-6 mm, and the force has no facets.
        fixtures : list of Volume
            Each may have its own pitch; empty ones are ignored.
        spacing : float, mm, or None
            Spacing of the points on the part over which forces are summed. Default: √(area / 100 000), of an exact
            `Surface` √(area / 400 000).
        stiffness : float, N per mm of depth and mm² of surface
            Against the cutter.
        holder_stiffness : float, N per mm of depth and mm² of surface
            Against shank and holder.
        fixture_stiffness : float, N per mm³ of a fixture in the tool, or a Material, or a list of one for each fixture
            Against the whole tool.
        fixture_push : {"normal", "centre"}
            Direction in which a fixture pushes: off the wall that the tool touches, or, as in the dissertation, towards the middle
            of cutter, shank or holder, which slides the tool along a wall.
        progress : callable or None
            Called at the beginning and at the end only.

        Returns
        -------
        Collider
            A new collider.

        Examples
        --------
        >>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5).to_mesh()
        >>> riffler.submit(riffler.Collider, part, spacing=0.5).result().spacing
        0.5
        """
    def __init__(self, part: Mesh | Surface, *, fixtures: collections.abc.Sequence[Volume] = [], spacing: typing.SupportsFloat | None = None, stiffness: typing.SupportsFloat = 1.0, holder_stiffness: typing.SupportsFloat = 10.0, fixture_stiffness: float | Material | collections.abc.Sequence[float | Material] = 10.0, fixture_push: typing.Literal['normal', 'centre'] = 'normal') -> None:
        ...
    def __repr__(self) -> str:
        ...
    def clearance(self, tool: Tool, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        The smallest signed distance between the part's surface and a tool at each pose, on all threads.

        The tool is the union of cutter, shank and holder. Fixtures do not count.

        Parameters
        ----------
        tool : Tool
            Cutter, shank and holder.
        poses : array_like of shape (n, 6), tip in mm and unit axis
            Poses of the tool.

        Returns
        -------
        ndarray of shape (n,), float64, mm
            Negative where they overlap.

        Raises
        ------
        ValueError
            Names argument and row.

        Examples
        --------
        >>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz").to_mesh()
        >>> collider = riffler.Collider(part)
        >>> collider.clearance(riffler.Tool.flat(6, 30), [[10, 10, 11, 0, 0, 1], [10, 10, 9, 0, 0, 1]]).round(3).tolist()
        [1.0, -1.0]
        """
    def nearest(self, tool: Tool, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> riffler.results.Nearest:
        """
        The point of part and fixtures that is nearest to a tool.

        Parameters
        ----------
        tool : Tool
            Cutter, shank and holder.
        pose : array_like of shape (6,), tip in mm and unit axis
            Poses of the tool.

        Returns
        -------
        Nearest
            Distance, point on part or fixture, and the nearest part of the tool, or "fixture".

        Examples
        --------
        >>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz").to_mesh()
        >>> collider = riffler.Collider(part)
        >>> distance, point, part = collider.nearest(riffler.Tool.ball(6, 30), [10, 10, 12, 0, 0, 1])
        >>> round(distance, 3), part
        (2.0, 'cutter')
        """
    def query(self, tool: Tool, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, budget_us: typing.SupportsFloat | None = None) -> Contact:
        """
        Force, torque, depth and points of a tool in contact.

        Parameters
        ----------
        tool : Tool
            Cutter, shank and holder.
        pose : array_like of shape (6,), tip in mm and unit axis
            Poses of the tool.
        budget_us : float, µs, or None
            Time after which the rest is only bounded: see ``checked`` and ``missed_depth_bound``.

        Returns
        -------
        Contact
            A contact; its depth is 0 if nothing touches.

        Raises
        ------
        ValueError
            Names the argument: an axis that is not a unit vector, a number that is not finite, a negative budget.

        Examples
        --------
        >>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz").to_mesh()
        >>> collider = riffler.Collider(part)
        >>> hit = collider.query(riffler.Tool.ball(6, 30), [10, 10, 9.5, 0, 0, 1])
        >>> round(hit.depth, 3), hit.parts[0], bool(hit.force[2] > 0)
        (0.5, 'cutter', True)
        """
    @property
    def spacing(self) -> float:
        """
        Spacing of the points on the part, mm.
        """
class Note:
    """
    An assumption of a reader of NC code, or code that it skipped: see `Program.read`.
    """
    def __repr__(self) -> str:
        ...
    @property
    def kind(self) -> str:
        """
        "skipped", "coordinates" (what follows may be elsewhere), "work offset", "units", "machine position", "rapid", "motion", "start", "tool length", "cutter compensation", "user code" or "end".
        """
    @property
    def line(self) -> int:
        """
        Line of the source, from 1.
        """
    @property
    def message(self) -> str:
        """
        A sentence on what the reader assumed or skipped.
        """
class ProgramStream:
    """
    An iterator over programs: see `Program.stream`.
    """
    def __iter__(self) -> typing.Self:
        ...
    def __next__(self) -> Program:
        ...
class Program:
    """
    A program: poses, feeds and tools; immutable.

    One row per move end. Between two rows the tip moves on a line and the axis on the great circle at constant rate, by way
    of the poses in ``via`` where there are any.

    Parameters
    ----------
    poses : array_like, shape (n, 6)
        Tip in mm and unit axis, tip to spindle.
    feed : array_like, shape (n,), or float
        mm/min at the tip.
    rapid : array_like of bool, shape (n,), or bool
        Rows that end a rapid.
    tool : array_like of int, shape (n,), or int
        Tool numbers; 0: none.
    line : array_like of int, shape (n,), or int
        Source lines from 1; 0: no source.
    spindle : array_like, shape (n,), or float
        rev/min; negative counter-clockwise, 0 stopped.
    tools : dict, optional
        Number to Tool, of the tools whose shape is known.
    provenance : dict, optional
        Strings that the NC code repeats in its header comment.
    notes : list of Note
        Assumptions of the reader of NC code, and skipped code.
    at_machine : array_like of bool, shape (n,), or bool
        Rows that end at a position of the machine whose place in the part is not known.
    via : dict, optional
        Row to poses (k, 6) on the move to it.

    Raises
    ------
    ValueError
        Naming the row: not finite, not a unit axis, a feed of 0 where the tip moves, ``at_machine`` with another pose than
        the row before.

    Examples
    --------
    >>> program = riffler.Program([(0, 0, 5, 0, 0, 1), (20, 0, 5, 0, 0, 1)], feed=600, rapid=[True, False])
    >>> program.feed
    array([  0., 600.])
    """
    @staticmethod
    def from_bytes(data: bytes) -> Program:
        """
        A program from the bytes of a .rprog file.

        Parameters
        ----------
        data : bytes
            As ``to_bytes`` makes them.

        Returns
        -------
        Program

        Raises
        ------
        FormatError
            Naming the byte.

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
        >>> len(riffler.Program.from_bytes(program.to_bytes()))
        5
        """
    @staticmethod
    def from_cl(cl: collections.abc.Iterable[numpy.typing.ArrayLike], tools: collections.abc.Iterable[Tool] | None, *, feed: numpy.typing.ArrayLike | collections.abc.Sequence[numpy.typing.ArrayLike], spindle: numpy.typing.ArrayLike | collections.abc.Sequence[numpy.typing.ArrayLike] = 0.0, safe_height: typing.SupportsFloat | None = None, clearance: typing.SupportsFloat = 10.0, occupied: tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike] | None = None, provenance: collections.abc.Mapping[str, object] | None = None, collider: Collider | None = None, retract: typing.SupportsFloat | None = None, direction: numpy.typing.ArrayLike | None = None, lead_in: typing.SupportsFloat | None = None, contact_tolerance: typing.SupportsFloat = 0.02) -> Program:
        """
        A program from cutter locations: every (n, 6) array is one cut.

        Its rows become feed moves in order, none merged. Before a cut there is a rapid at safe height to above its first point,
        along the tool's axis, and the feed in; after it a rapid out along the axis. With a ``collider``, approaches, retracts and
        the moves between cuts are resolved with cutter, shank and holder: along the tool's axis where that is clear, otherwise by
        another link, the axis unchanged; such a link is fed, since it may cross stock.

        Parameters
        ----------
        cl : list of array_like, shape (n, 6)
            Tip in mm and unit axis, as ``riffler.plan.cutter_locations`` returns them.
        tools : list of Tool, or None
            One for all arrays or one for each; None: tool 1 of unknown shape.
        feed : float or array_like, or a list of one for each array
            mm/min at the tip; an array has one for each row.
        spindle : float, or a list of one for each array
            rev/min; negative counter-clockwise.
        safe_height : float, optional
            z (mm) above everything; None: ``clearance`` above all tips and ``occupied``.
        clearance : float
            mm.
        occupied : tuple of two array_like, shape (3,), optional
            Corners of a box around stock, part and fixtures, mm. Part and fixtures of ``collider`` are occupied, too.
        provenance : dict, optional
            Strings for the header comment.
        collider : Collider, optional
            Part and fixtures.
        retract : float, optional
            mm of the first stretch out of a cut; None: searches a clear one.
        direction : array_like, shape (3,), optional
            Unit vector of that stretch; None: likewise.
        lead_in : float, optional
            mm before a cut at feed, if everything above is air; None: the whole approach at feed.
        contact_tolerance : float
            mm by which a tool may enter part and fixtures, as cuts touch the part.

        Returns
        -------
        Program

        Raises
        ------
        ValueError
            Naming the path, the row, the place and the remedy if no link is clear.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=6, length=30)
        >>> cut = [(0, 0, 0, 0, 0, 1), (20, 0, 0, 0, 0, 1)]
        >>> program = riffler.Program.from_cl([cut], [ball], feed=600, spindle=12000)
        >>> int((~program.rapid).sum()), program.tools[1] == ball
        (2, True)
        """
    @staticmethod
    def joined(programs: collections.abc.Sequence[Program]) -> Program:
        """
        Programs one after the other.

        Parameters
        ----------
        programs : list of Program
            In their order.

        Returns
        -------
        Program

        Raises
        ------
        ValueError
            If one number is used for two shapes.

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
        >>> len(riffler.Program.joined([program, program]))
        10
        """
    @staticmethod
    def load(path: os.PathLike | str | bytes, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Program:
        """
        Reads a .rprog file.

        Parameters
        ----------
        path : path_like
            The file.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        Program

        Raises
        ------
        FormatError
            Naming the byte, if the file is damaged or not a .rprog file.

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
        >>> program.save("part.rprog")
        >>> bool((riffler.Program.load("part.rprog").poses == program.poses).all())
        True
        """
    @staticmethod
    def read(path: os.PathLike | str | bytes, *, machine: str = 'tcp', options: collections.abc.Mapping[str, float | bool | str | collections.abc.Sequence[float]] | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Program:
        """
        Reads NC code as a machine's control has it: RS-274, APT, Heidenhain's Klartext or Sinumerik.

        Poses are in the coordinates in which the first move is programmed. Code that the reader does not understand is an error,
        unless ``unknown`` is "skip".

        Parameters
        ----------
        path : path_like
            The file.
        machine : str
            A name of ``machines``, or the path of a .toml file.
        options : dict, optional
            Options of the machine, and of reading:

            - ``chord_tolerance`` (mm, 0.002): for curves.
            - ``axis_tolerance`` (rad): blocks whose rotary axes leave the great circle by more become several rows; without it a
              block is one row, and the poses in between are in ``via``.
            - ``block_delete`` (True): skips lines that begin with /.
            - ``unknown``: "error" or "skip"; ``notes`` and ``provenance`` list what was skipped.
            - ``cutter_compensation``: "error", "ignore" (points are those of the tool's centre) or "offset" (points are the
              contour's, and the tool's centre is offset from it); ``tool_diameters`` for that, mm: one number, or a dict by
              the number of the offset D or of the tool.
            - ``units``: "mm" or "inch", before the program declares them.
            - ``arc_tolerance`` (mm, 0.005): by which an arc's end may miss its circle.
            - ``arc_centres``: "relative" (to the arc's start) or "absolute", until G90.1 or G91.1.
            - ``first_feed`` (mm/min): of feed moves before the first F.
            - ``first_motion``: "none", "G0" or "G1": of axis words before the first motion.
            - ``g54`` … ``g59``, ``g59_1`` … ``g59_3``, ``g28``, ``g30``: machine positions of work offsets and homes, three to
              six numbers.
            - ``subroutines``: a folder of files name.ngc; ``parameters``: a file of LinuxCNC's parameters; ``max_turns`` (1e6) of
              loops and calls.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        Program

        Raises
        ------
        FormatError
            Naming file, line and block.
        ValueError
            Naming the option that is wrong.

        Examples
        --------
        >>> text = "G21 G90\\nT1 M6\\nG1 X10 Y0 Z5 F600\\nX20\\nM2\\n"
        >>> from pathlib import Path
        >>> _ = Path("part.ngc").write_text(text)
        >>> riffler.Program.read("part.ngc", machine="3-axis").poses[-1, :3]
        array([20.,  0.,  5.])
        """
    @staticmethod
    def stream(path: os.PathLike | str | bytes, *, machine: str = 'tcp', options: collections.abc.Mapping[str, float | bool | str | collections.abc.Sequence[float]] | None = None, rows: typing.SupportsFloat = 65536) -> ProgramStream:
        """
        Reads as ``read`` does, in memory that does not grow with the file.

        Parameters
        ----------
        path : path_like
            The file.
        machine : str
            A name of ``machines``, or the path of a .toml file.
        options : dict, optional
            As for ``read``.
        rows : int
            Largest number of rows of a program.

        Returns
        -------
        ProgramStream
            An iterator of programs; each after the first begins with the row at which the one before ended.

        Examples
        --------
        >>> text = "G21 G90\\nT1 M6\\nG1 X10 Y0 Z5 F600\\nX20\\nX30\\nM2\\n"
        >>> from pathlib import Path
        >>> _ = Path("part.ngc").write_text(text)
        >>> [len(part) for part in riffler.Program.stream("part.ngc", machine="3-axis", rows=2)]
        [2, 2]
        """
    def __getstate__(self) -> bytes:
        ...
    def __init__(self, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], feed: numpy.typing.ArrayLike, *, rapid: numpy.typing.ArrayLike = False, tool: numpy.typing.ArrayLike = 1, line: numpy.typing.ArrayLike = 0, spindle: numpy.typing.ArrayLike = 0.0, tools: collections.abc.Mapping[int, Tool] | None = None, provenance: collections.abc.Mapping[str, object] | None = None, notes: collections.abc.Sequence[Note] = [], at_machine: numpy.typing.ArrayLike = False, via: collections.abc.Mapping[int, numpy.typing.ArrayLike] | None = None) -> None:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: bytes) -> None:
        ...
    def cuts(self) -> list[tuple[int, numpy.typing.NDArray[numpy.float64]]]:
        """
        The poses for a replay, tool by tool.

        Returns
        -------
        list of tuple
            (tool number, poses (k, 6)), one for each run of rows in the part with one tool; rapids and the poses of ``via`` are
            included.

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600, tool=3)
        >>> [(number, poses.shape) for number, poses in program.cuts()]
        [(3, (5, 6))]
        """
    def followed(self) -> Program:
        """
        The program with the poses of ``via`` as rows of their own.

        Between its rows the tool moves as on the machine.

        Returns
        -------
        Program

        Examples
        --------
        >>> program = riffler.Program([(0, 0, 5, 0, 0, 1), (20, 0, 5, 0, 0, 1)], feed=600, rapid=[True, False])
        >>> len(program.followed())
        2
        """
    def renumber_tools(self, numbers: collections.abc.Mapping[typing.SupportsInt, typing.SupportsInt]) -> Program:
        """
        The program with other tool numbers.

        Parameters
        ----------
        numbers : dict
            Old number to new; a tool that is not in it keeps its number.

        Returns
        -------
        Program

        Raises
        ------
        ValueError
            If two shapes would share a number.

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(2)], feed=600, tool=1)
        >>> program.renumber_tools({1: 7}).tool
        array([7, 7], dtype=int32)
        """
    def rows_at(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, tools: collections.abc.Mapping[int, Tool] | None = None, tolerance: typing.SupportsFloat = 0.05, progress: collections.abc.Callable[[float], bool | None] | None = None) -> numpy.typing.NDArray[numpy.int32]:
        """
        The row that made the surface at each point.

        The swept bodies of all moves are searched; nothing has to be stored while cutting. ``program.line`` and ``program.tool`` of
        the rows are the lines and tools that made a surface.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            mm: points on the surface that the program leaves, such as vertices of its mesh.
        tools : dict, optional
            Number to Tool; takes the place of the program's own.
        tolerance : float
            mm that a point may be off the surface; a quarter of the pitch fits vertices of a mesh.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        ndarray, shape (n,)
            The row whose move swept along the point, the first if several did; -1 where none did: the stock's own surface.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=6, length=30)
        >>> program = riffler.Program([(0, 0, 8, 0, 0, 1), (20, 0, 8, 0, 0, 1), (20, 9, 8, 0, 0, 1)], 600, tools={1: ball})
        >>> program.rows_at([(10, 0, 8), (20, 5, 8), (10, 20, 10)])
        array([ 1,  2, -1], dtype=int32)
        """
    def save(self, path: os.PathLike | str | bytes, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        """
        Writes a .rprog file: everything to the bit, which NC code cannot keep.

        Writes the whole file or none. The same program gives the same bytes.

        Parameters
        ----------
        path : path_like
            The file.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
        >>> program.save("part.rprog")
        >>> len(riffler.Program.load("part.rprog"))
        5
        """
    def scale_feeds(self, factor: typing.SupportsFloat) -> Program:
        """
        The program with other feeds; rapids are unchanged.

        Parameters
        ----------
        factor : float
            Factor on the feeds.

        Returns
        -------
        Program

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(2)], feed=600)
        >>> program.scale_feeds(0.5).feed
        array([300., 300.])
        """
    def scheduled(self, stock: Volume, *, removal_rate: typing.SupportsFloat | None = None, force: typing.SupportsFloat | None = None, lowest: typing.SupportsFloat = 1.0, highest: typing.SupportsFloat | None = None, removal_constant: typing.SupportsFloat = 0.05, tools: collections.abc.Mapping[int, Tool] | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Program:
        """
        The program with feeds at which the simulated removal rate, or force, stays below a limit.

        The program runs on a copy of the stock, in steps of four pitches or a quarter of the cutter's radius. Where the feed that
        a step needs differs from the one before, the row is divided there; nothing else changes.

        Parameters
        ----------
        stock : Volume
            At the beginning of the program. Not changed.
        removal_rate : float, optional
            mm³/min; this or ``force``, or both.
        force : float, optional
            N, of removal: ``removal_constant`` times the removal rate.
        lowest : float
            mm/min, the smallest feed.
        highest : float, optional
            mm/min, to which feeds may rise; None: to the program's own.
        removal_constant : float
            N·s/mm³, as for ``Volume.carve``.
        tools : dict, optional
            Number to Tool; takes the place of the program's own.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        Program

        Raises
        ------
        ValueError
            Naming the row and the place where the limit needs a feed below ``lowest``, a tool of unknown shape, or the argument.

        Examples
        --------
        >>> stock = riffler.Volume.block((0, 0, 0), (40, 20, 10), pitch=0.5)
        >>> cut = [(-5, 10, 8, 0, 0, 1), (45, 10, 8, 0, 0, 1)]
        >>> program = riffler.Program(cut, feed=1200, spindle=9000, tools={1: riffler.Tool.flat(diameter=6, length=20)})
        >>> slower = program.scheduled(stock, removal_rate=6000)
        >>> bool(slower.feed.min() < 600), float(slower.feed.max()), len(slower) > len(program)
        (True, 1200.0, True)
        """
    def to_bytes(self) -> bytes:
        """
        The bytes of the .rprog file.

        Returns
        -------
        bytes

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
        >>> len(riffler.Program.from_bytes(program.to_bytes()))
        5
        """
    def transformed(self, matrix: numpy.typing.ArrayLike) -> Program:
        """
        The program in another clamping.

        Parameters
        ----------
        matrix : array_like, shape (4, 4)
            Turns and moves (mm) the part, without scale or mirror.

        Returns
        -------
        Program

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
        >>> program.transformed(np.diag([-1, -1, 1, 1])).poses[1, :3]
        array([-1.,  0.,  5.])
        """
    def trimmed(self, first: typing.SupportsInt, last: typing.SupportsInt) -> Program:
        """
        Some rows as a program.

        Parameters
        ----------
        first, last : int
            Rows ``first`` to ``last`` - 1. The first of them becomes a rapid; the caller adds an approach before it.

        Returns
        -------
        Program

        Examples
        --------
        >>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
        >>> len(program.trimmed(1, 4))
        3
        """
    def write(self, path: os.PathLike | str | bytes, *, post: str = 'tcp', tolerance: typing.SupportsFloat = 0.01, axis_tolerance: typing.SupportsFloat = 0.00175, options: collections.abc.Mapping[str, float | bool | str | collections.abc.Sequence[float]] | None = None, collider: Collider | None = None, stock: Volume | None = None, contact_tolerance: typing.SupportsFloat = 0.05) -> riffler.program_results.WriteReport:
        """
        Writes NC code: the whole file or none. The same program gives the same bytes.

        Every row is the end of a block; more blocks come between two rows where machine axes that move linearly would take the
        tip more than ``tolerance`` off the straight line or the axis more than ``axis_tolerance`` off the great circle. Where a
        rotary axis moves together with linear ones that are written as they stand, blocks are under G93, each with
        F = 1 / minutes: the tip's travel at the feed, or longer where an axis's rate asks for it.

        Parameters
        ----------
        path : path_like
            The file.
        post : str
            A name of ``machines``, or the path of a .toml file.
        tolerance : float
            mm.
        axis_tolerance : float
            rad.
        options : dict, optional
            The machine's (``rot_point``, ``offset``, ``tool_offset`` of LinuxCNC's tables, named as its pins; ``pivot_length`` of
            heads), and those of all: ``tcp`` (False: X Y Z are where the axes stand; True: the tip in part coordinates),
            ``direction`` ("linuxcnc" or "iso", of tables), ``limits_x`` … ``limits_c`` [low, high], ``rate_x`` … ``rate_c``,
            ``max_rotary`` (deg/min), ``line_numbers``, ``coolant``, ``retract``, ``safe_height``, ``arcs``, ``vectors``:
            docs/machines.md and ``machine_options``.
        collider : Collider, optional
            Checks the machine's own motion between the ends of blocks, with cutter, shank and holder against part and
            fixtures.
        stock : Volume, optional
            Stock to check that motion in, as in a verification.
        contact_tolerance : float
            mm by which part and fixtures may be entered.

        Returns
        -------
        WriteReport

        Raises
        ------
        ValueError
            Naming the row, the place and the remedy: a row that the machine cannot hold, a collision with part or fixtures, a rapid in the
            stock, or shank or holder in it. Nothing is written.

        Examples
        --------
        >>> cut = [(0, 0, 0, 0, 0, 1), (20, 0, 0, 0, 0, 1)]
        >>> program = riffler.Program.from_cl([cut], [riffler.Tool.ball(diameter=6, length=30)], feed=600)
        >>> program.write("part.ngc", post="linuxcnc-xyzac", options={"rot_point": (0, 0, 0)}).rewinds
        []
        """
    @property
    def at_machine(self) -> numpy.typing.NDArray[numpy.bool]:
        """
        (n,) bool: rows that end at a position of the machine (G28, G30, G53) whose place in the part is not known. Their pose is that of the row before; the motions there and from there are neither cut nor compared.
        """
    @property
    def feed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm/min at the tip; 0 for rapids.
        """
    @property
    def line(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (n,) int32 source lines from 1; 0: no source.
        """
    @property
    def notes(self) -> list[Note]:
        """
        Assumptions of the reader, and skipped code. Programs made from arrays have none.
        """
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6): tip xyz, unit axis xyz (tip to spindle). Read-only view.
        """
    @property
    def provenance(self) -> dict[str, str]:
        """
        Strings that the NC code repeats in its header comment.
        """
    @property
    def rapid(self) -> numpy.typing.NDArray[numpy.bool]:
        """
        (n,) bool: rows that end a rapid.
        """
    @property
    def spindle(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) rev/min; negative counter-clockwise, 0 stopped.
        """
    @property
    def tool(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (n,) int32 tool numbers; 0: none.
        """
    @property
    def tools(self) -> dict[int, Tool]:
        """
        Tools whose shape is known, by number.
        """
    @property
    def via(self) -> dict[int, numpy.typing.NDArray[numpy.float64]]:
        """
        (k, 6) poses on the move to a row, by row: where rotary axes that turn evenly take the tool off the great circle by more than 0.002 rad, in programs that were read without ``axis_tolerance``.
        """
class Finding:
    """
    One fault, neighbouring rows of a program with the same kind, tool and fixture: see `verify`.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        """
        For JSON: all attributes.

        Returns
        -------
        dict

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> ball = riffler.Tool.ball(diameter=6, length=30)
        >>> program = riffler.Program([(0, 0, 8, 0, 0, 1), (20, 20, 8, 0, 0, 1)], 0, rapid=True, tools={1: ball})
        >>> riffler.verify(program, stock).findings[0].to_dict()["kind"]
        'rapid'
        """
    @property
    def fixture(self) -> int | None:
        """
        Number of the fixture, from 0, or None.
        """
    @property
    def kind(self) -> str:
        """
        "rapid", "holder", "shank", "fixture", "gouge", "rest", "spindle" (a feed move into material with a spindle
        that stands), "machine" (the machine cannot hold the row) or "unknown" (it could not be checked).
        """
    @property
    def last_line(self) -> int:
        """
        Source line of the last row.
        """
    @property
    def last_row(self) -> int:
        """
        Last row.
        """
    @property
    def line(self) -> int:
        """
        Source line of the first row from 1; 0: no source.
        """
    @property
    def member(self) -> str:
        """
        Piece of the tool: cutter, shank, holder, or beyond where its description ends.
        """
    @property
    def message(self) -> str:
        """
        A sentence with the fault and the remedy.
        """
    @property
    def point(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) mm: the worst place, part coordinates.
        """
    @property
    def row(self) -> int:
        """
        First row; the move that ends there.
        """
    @property
    def tool(self) -> int:
        """
        Tool number.
        """
    @property
    def unit(self) -> str:
        """
        Unit of ``value``.
        """
    @property
    def value(self) -> float:
        """
        How much, in ``unit``. rapid, spindle: mm³ that all rows took. holder, shank, fixture, unknown: mm³ in
        the way of the worst row (where a slab of the stock has been hit 256 times, only one further hit in sixteen is measured).
        gouge, rest: mm under or over the part's surface.
        """
class VerifyReport:
    """
    The result of a verification: see `verify`.
    """
    def __repr__(self) -> str:
        ...
    def part_deviation(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        Distance of the part's vertices from the remaining stock. Computed at the first call; later calls return the same.

        Returns
        -------
        ndarray, shape (vertices,), or None
            mm from each vertex of the part to the surface of the remaining stock: positive where material covers it, negative where it
            is missing, -inf where nothing is left at all. None without a part.

        Examples
        --------
        >>> stock = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz")
        >>> program = riffler.Program([[10, 10, 20, 0, 0, 1]], feed=600)
        >>> report = riffler.verify(program, stock, part_mesh=stock.to_mesh())
        >>> bool(abs(report.part_deviation()).max() < 1e-6)
        True
        """
    def stock_deviation(self) -> tuple[Mesh, numpy.typing.NDArray[numpy.float64]] | None:
        """
        Mesh of the remaining stock, and its distances from the part. Computed at the first call; later calls return the same.

        Returns
        -------
        tuple of Mesh and ndarray, shape (vertices,), or None
            The remaining stock, and mm from each of its vertices to the part's surface: positive in rest material,
            negative in gouges. None without a part.

        Examples
        --------
        >>> stock = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz")
        >>> program = riffler.Program([[10, 10, 20, 0, 0, 1]], feed=600)
        >>> report = riffler.verify(program, stock, part_mesh=stock.to_mesh())
        >>> mesh, distance = report.stock_deviation()
        >>> bool(abs(distance).max() < 1e-6)
        True
        """
    def to_dict(self) -> dict:
        """
        For JSON: passed, findings, not_checked, rows, time, volume, removed (mm³ in sum), stats.

        Returns
        -------
        dict

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> ball = riffler.Tool.ball(diameter=6, length=30)
        >>> program = riffler.Program([(0, 0, 8, 0, 0, 1), (20, 20, 8, 0, 0, 1)], 600, spindle=9000, tools={1: ball})
        >>> riffler.verify(program, stock).to_dict()["rows"]
        2
        """
    @property
    def findings(self) -> list[Finding]:
        """
        The faults, by rows.
        """
    @property
    def not_checked(self) -> list[str]:
        """
        Sentences on checks that were not requested and so cannot fail.
        """
    @property
    def passed(self) -> bool:
        """
        True only if every requested check could be made and found nothing.
        """
    @property
    def rate(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm³/min; 0 where a move takes no time.
        """
    @property
    def removed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm³ that each row's move took; row 0: 0.
        """
    @property
    def seconds(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) s: the tip's travel at its feed, rapids at ``rapid_feed``; where the tip stands still, the axis' angle at
        3600 deg/min. Acceleration and tool changes are left out.
        """
    @property
    def stats(self) -> riffler.program_results.VerifyStats:
        """
        Operation counts.
        """
    @property
    def time(self) -> float:
        """
        s, all rows.
        """
    @property
    def volume(self) -> Volume:
        """
        The material that is left.
        """
class Verification:
    """
    Verifies a program again and again while it is edited.

    ``run`` of a program that is like the one before repeats only what differs: rows before the first difference come from
    snapshots, and parts of the stock that no differing move can touch stay unchanged. The report is that of a fresh run, bit
    for bit.

    Parameters
    ----------
    stock_volume : Volume
        Not changed.
    part_mesh : Mesh, optional
        For gouges and rest material.
    fixtures : list of Volume or Mesh
        Volumes or meshes that the whole tool must stay clear of; a Mesh becomes a Volume at the stock's pitch.
    tools : dict, optional
        Number to Tool; takes the place of the program's own.
    tolerance : float
        mm, of cutting, as in ``Volume.carve``; shallower contact does not count.
    gouge_tolerance : float
        mm under the part's surface from which removed material is a gouge.
    rest_tolerance : float, optional
        mm over the part's surface from which material is a finding; None: rest material is mapped, not judged.
    rapid_feed : float
        mm/min, for the time.
    machine : str, optional
        A name of ``machines`` on which the program is to run: the first row that its axes or their limits cannot hold is a
        finding "machine".
    machine_options : dict, optional
        Options of the machine; those of reading are ignored.
    machine_frame : array_like, shape (4, 4), optional
        Transform from the coordinates of stock and program to those of the program on the machine, if they differ.
    progress : callable, optional
        Called with the finished share, from 0 for each chunk; returning False cancels.

    Examples
    --------
    >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
    >>> ball = riffler.Tool.ball(diameter=6, length=30)
    >>> verification = riffler.Verification(stock, tools={1: ball})
    >>> cut = [(5, 10, 8, 0, 0, 1), (15, 10, 8, 0, 0, 1)]
    >>> verification.run(riffler.Program.from_cl([cut], [ball], feed=600, spindle=9000)).findings
    []
    """
    def __init__(self, stock_volume: Volume, part_mesh: Mesh | None = None, fixtures: collections.abc.Iterable[Volume | Mesh] | None = (), *, tools: collections.abc.Mapping[int, Tool] | None = None, tolerance: typing.SupportsFloat = 0.01, gouge_tolerance: typing.SupportsFloat = 0.05, rest_tolerance: typing.SupportsFloat | None = None, rapid_feed: typing.SupportsFloat = 10000.0, machine: str | None = None, machine_options: collections.abc.Mapping[str, float | bool | str | collections.abc.Sequence[float]] | None = None, machine_frame: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        ...
    def run(self, program: Program, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> VerifyReport:
        """
        Verifies a program. After an error or Cancelled the object is unchanged.

        Parameters
        ----------
        program : Program
            The program.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        VerifyReport

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> ball = riffler.Tool.ball(diameter=6, length=30)
        >>> program = riffler.Program.from_cl([[(5, 10, 8, 0, 0, 1)]], [ball], feed=600, spindle=9000)
        >>> riffler.Verification(stock).run(program).findings
        []
        """
class SlabWorker:
    """
    Simulates slabs of a VerifyPlan: made from its ``context``.
    """
    def __init__(self, context: bytes) -> None:
        ...
    def run(self, task: bytes, moves: collections.abc.Sequence[bytes]) -> bytes:
        """
        What VerifyPlan.accept takes. FormatError for damaged bytes.
        """
class VerifyPlan:
    """
    A verification whose slabs run elsewhere; arguments as of riffler.verify.
    """
    def __init__(self, stock_volume: Volume, part_mesh: Mesh | None = None, fixtures: collections.abc.Iterable[Volume | Mesh] | None = (), *, tools: collections.abc.Mapping[int, Tool] | None = None, tolerance: typing.SupportsFloat = 0.01, gouge_tolerance: typing.SupportsFloat = 0.05, rest_tolerance: typing.SupportsFloat | None = None, rapid_feed: typing.SupportsFloat = 10000.0, machine: str | None = None, machine_options: collections.abc.Mapping[str, float | bool | str | collections.abc.Sequence[float]] | None = None, machine_frame: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> None:
        ...
    def accept(self, slab: typing.SupportsInt, result: bytes, last: bool) -> None:
        """
        A result of SlabWorker.run; ``last``: the slab has no more moves. FormatError for damaged bytes.
        """
    def add(self, program: Program, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> list[tuple[int, int, bytes]]:
        """
        List of (slab, number of moves, bytes) of the chunk: the moves that can touch each slab.
        """
    def context(self) -> bytes:
        """
        What SlabWorker is made of, after the last chunk.
        """
    def finish(self, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> VerifyReport:
        """
        The VerifyReport, after the results of all slabs.
        """
    def task(self, slab: typing.SupportsInt) -> bytes:
        """
        The slab as it stands.
        """
class PenGeometry:
    """
    A pen's lengths, gears, encoders, motors and limits, and its kinematics.

    Two arms, R and L, hold the two ends of a grip. Counts are the six counters in the device's own order (``channels``);
    joints are θ1 θ2 θ3 of R, then of L, in rad. Poses are the grip's pivot and the unit axis along it, away from the tool's
    tip. Arrays have one row per moment.

    Examples
    --------
    >>> pen = riffler.pen.PenGeometry.load("riffler")
    >>> pen.forward([pen.home]).shape
    (1, 6)
    """
    @staticmethod
    def load(name: str) -> PenGeometry:
        """
        Reads the geometry of a pen.

        Parameters
        ----------
        name : str
            A name of ``riffler.pen.names()``, or the path of a .toml file.

        Returns
        -------
        PenGeometry

        Raises
        ------
        FormatError
            Naming the file's line.
        ValueError
            Listing the known pens.

        Examples
        --------
        >>> riffler.pen.PenGeometry.load("riffler").name
        'riffler'
        """
    def capability(self) -> riffler.pen_results.PenCapability:
        """
        What each coordinate senses and pushes.

        Returns
        -------
        riffler.pen.PenCapability

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.capability().axes["x"].sensing
        'position'
        """
    def converter_steps(self, torques: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.int16], numpy.typing.NDArray[numpy.float64]]:
        """
        As ``motor_currents``, in the steps of the pen's digital to analogue converter.

        Parameters
        ----------
        torques : array_like, shape (n, 6)
            Of the joints, N·mm.

        Returns
        -------
        steps : ndarray of int16, shape (n, 6)
        scale : ndarray, shape (n,)

        Raises
        ------
        ValueError
            For a pen without a converter.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> steps, scale = pen.converter_steps([(1, 0, 0, 0, 0, 0)])
        >>> steps.shape, scale
        ((1, 6), array([1.]))
        """
    def counts(self, joints: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.int32]:
        """
        The nearest counts of joint angles.

        Parameters
        ----------
        joints : array_like, shape (n, 6)
            θ1 θ2 θ3 of R, then of L, rad.

        Returns
        -------
        ndarray of int32, shape (n, 6)

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> bool((pen.counts(pen.joints([pen.home])) == pen.home).all())
        True
        """
    def diagnose(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> riffler.pen_results.GripDiagnosis:
        """
        Which counter is wrong, from counts of different postures.

        Parameters
        ----------
        counts : array_like, shape (n, 6)
            Readings of the counters, in the device's order.

        Returns
        -------
        riffler.pen.GripDiagnosis

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.diagnose([pen.home]).fault
        'unclear'
        """
    def efforts(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wrenches: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], at: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Joint torques for a force and a torque on the hand.

        Parameters
        ----------
        counts : array_like, shape (n, 6)
            Readings of the counters, in the device's order.
        wrenches : array_like, shape (n, 6)
            Force, N, and torque, N·mm, in the frame of poses.
        at : array_like, shape (n, 3)
            Points about which the torques act, mm.

        Returns
        -------
        torques : ndarray, shape (n, 6)
            Of the joints, N·mm.
        missing : ndarray, shape (n, 3)
            The torque that cannot be felt, N·mm.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> torques, missing = pen.efforts([pen.home], [(0, 0, 1, 0, 0, 0)], pen.forward([pen.home])[:, :3])
        >>> torques.shape
        (1, 6)
        """
    def ends(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Ends of the arms in their frame: (2.1) and (2.2) of the source.

        Parameters
        ----------
        counts : array_like, shape (n, 6)
            Readings of the counters, in the device's order.

        Returns
        -------
        ndarray, shape (n, 2, 3)
            Of R and of L, mm.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.ends([pen.home]).shape
        (1, 2, 3)
        """
    def forward(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Poses of counts: (2.3) and (2.4) of the source.

        Parameters
        ----------
        counts : array_like, shape (n, 6)
            Readings of the counters, in the device's order.

        Returns
        -------
        ndarray, shape (n, 6)
            The grip's pivot, mm, and the unit axis along it.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.forward([pen.home]).shape
        (1, 6)
        """
    def homed(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, probe: typing.SupportsInt = 0) -> PenGeometry:
        """
        The same pen, homed by its readings instead of presets. Counters may wrap.

        Parameters
        ----------
        counts : array_like, shape (1, 6)
            Readings of the counters in the home posture.
        probe : int
            Reading of the seventh counter there.

        Returns
        -------
        PenGeometry

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.homed([pen.home + 100]).name
        'riffler'
        """
    def inverse(self, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], list[tuple[str, str]]]:
        """
        Joint angles of poses.

        Parameters
        ----------
        poses : array_like, shape (n, 6)
            The grip's pivot, mm, and the unit axis along it.

        Returns
        -------
        joints : ndarray, shape (n, 6)
            rad.
        reach : list of tuple
            Of R and of L: "reached", "too far", "too near", "on axis" (of θ1, or folded), "limits" (the angles are beyond the
            joints' or the elbow's) or "not finite".

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> joints, reach = pen.inverse(pen.forward([pen.home]))
        >>> reach
        [('reached', 'reached')]
        """
    def jacobian(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Derivative of each arm's end by its joint angles: (2.7) and (2.8) of the source.

        Parameters
        ----------
        counts : array_like, shape (n, 6)
            Readings of the counters, in the device's order.

        Returns
        -------
        ndarray, shape (n, 2, 3, 3)
            Of R and of L: x y z by θ1 θ2 θ3, mm/rad.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.jacobian([pen.home]).shape
        (1, 2, 3, 3)
        """
    def joints(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Joint angles of counts: (2.9) of the source.

        Parameters
        ----------
        counts : array_like, shape (n, 6)
            Readings of the counters, in the device's order.

        Returns
        -------
        ndarray, shape (n, 6)
            θ1 θ2 θ3 of R, then of L, rad.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.joints([pen.home]).shape
        (1, 6)
        """
    def motor_currents(self, torques: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.int16], numpy.typing.NDArray[numpy.float64]]:
        """
        Motor currents for joint torques.

        Parameters
        ----------
        torques : array_like, shape (n, 6)
            Of the joints, N·mm.

        Returns
        -------
        currents : ndarray of int16, shape (n, 6)
            mA, in the device's order.
        scale : ndarray, shape (n,)
            The factor by which all six of a row were scaled, so that none passes its peak.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> currents, scale = pen.motor_currents([(1, 0, 0, 0, 0, 0)])
        >>> scale
        array([1.])
        """
    def noticed_counts(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Number of counts by which each channel may be off, in either direction, before the error is detected, if all others are right.

        Parameters
        ----------
        counts : array_like, shape (n, 6)
            Readings of the counters, in the device's order.

        Returns
        -------
        ndarray, shape (n, 6)
            Infinite if no error is detected, 0 in rows that do not fit.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.noticed_counts([pen.home]).shape
        (1, 6)
        """
    def probe_angle(self, count: typing.SupportsInt) -> float:
        """
        The grip's rotation about the pose's axis, turns added up.

        Parameters
        ----------
        count : int
            Readings of the seventh counter.

        Returns
        -------
        float
            rad.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.probe_angle(0)
        0.0
        """
    def split(self, wrenches: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], apart: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Forces of the two arms for a force and a torque on the hand.

        Parameters
        ----------
        wrenches : array_like, shape (n, 6)
            Force, N, and torque about the grip's pivot, N·mm.
        apart : array_like, shape (n, 3)
            From R's end to L's, mm.

        Returns
        -------
        forces : ndarray, shape (n, 2, 3)
            Of R and of L, N.
        missing : ndarray, shape (n, 3)
            The torque that cannot be felt: its part along the grip, N·mm.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> forces, missing = pen.split([(0, 0, 1, 0, 0, 0)], [(0, 0, 50)])
        >>> forces.sum(axis=1)
        array([[0., 0., 1.]])
        """
    def stretch(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Error of the grip's length as computed from the counts, mm.

        Parameters
        ----------
        counts : array_like, shape (n, 6)
            Readings of the counters, in the device's order.

        Returns
        -------
        ndarray, shape (n,)
            mm.

        Examples
        --------
        >>> pen = riffler.pen.PenGeometry.load("riffler")
        >>> pen.stretch([pen.home]).shape
        (1,)
        """
    @property
    def channels(self) -> list[riffler.pen_results.PenChannel]:
        """
        The six motors with their encoders, in the device's order.
        """
    @property
    def description(self) -> str:
        """
        Description in its file.
        """
    @property
    def grip_length(self) -> float:
        """
        mm, between the arms' ends.
        """
    @property
    def grip_tolerance(self) -> float:
        """
        mm: a larger |stretch| is a lost count or a bad homing.
        """
    @property
    def home(self) -> numpy.ndarray:
        """
        (6,) int32: what the counters read in the home posture.
        """
    @property
    def limits(self) -> riffler.pen_results.PenLimits:
        """
        Workspace, elbow, force, torque, speeds.
        """
    @property
    def name(self) -> str:
        """
        Name of its file.
        """
    @property
    def tip(self) -> str:
        """
        The arm whose end is at the tool's tip.
        """
class PenError(RuntimeError):
    """
    A device does not open. The message gives the reason and the remedy.
    """
class PenState:
    """
    State of the hand in one report: see `PenDevice.state`.
    """
    @property
    def age_s(self) -> float:
        """
        s since it was measured; inf before the first report.
        """
    @property
    def applied(self) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        (force, torque), N and N·mm: of the motors on the hand, if the device reports it; otherwise zero.
        """
    @property
    def buttons(self) -> int:
        """
        Bit 0 is button 1.
        """
    @property
    def counts(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (6,) int32: counters of a pen that has a geometry, in its order, as if homing had preset them.
        """
    @property
    def fault(self) -> int:
        """
        The device's own fault code, or 0.
        """
    @property
    def homed(self) -> bool:
        """
        Whether the pose is certain.
        """
    @property
    def pose(self) -> numpy.ndarray:
        """
        (6,): point and axis of the grip.
        """
    @property
    def powered(self) -> bool:
        """
        Whether the device is ready to push.
        """
    @property
    def sequence(self) -> int:
        """
        Number of the report; 0 before the first.
        """
    @property
    def spin(self) -> float:
        """
        rad, of the grip about its axis.
        """
    @property
    def stretch(self) -> float:
        """
        mm between two measurements of one length.
        """
    @property
    def turning(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) rad/s.
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) mm/s.
        """
class PenDevice:
    """
    An open device: a pen, a puck, a recording. Context manager.

    Its own thread reads reports and writes forces, and reconnects to a device that was unplugged.

    Examples
    --------
    >>> with riffler.pen.open("simulated") as pen:
    ...     pen.kind
    'simulated'
    """
    def __enter__(self) -> typing.Self:
        ...
    def __exit__(self, *args) -> None:
        ...
    def health(self) -> riffler.pen_results.PenHealth:
        """
        The connection, the force, and counts since the start.

        Returns
        -------
        PenHealth

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.health().malformed
        0
        """
    def home(self) -> bool:
        """
        Declares that the device is in its home posture.

        Returns
        -------
        bool
            False for a device that needs no homing.

        Examples
        --------
        >>> riffler.pen.Pointer("mouse").home()
        False
        """
    def push(self, force: numpy.typing.ArrayLike, torque: numpy.typing.ArrayLike = (0, 0, 0)) -> riffler.pen_results.PushResult:
        """
        Pushes for 20 ms.

        Parameters
        ----------
        force : array_like, shape (3,)
            N.
        torque : array_like, shape (3,)
            N·mm about the grip's point.

        Returns
        -------
        PushResult

        Examples
        --------
        >>> pointer = riffler.pen.Pointer("mouse")
        >>> pointer.push((0, 0, 1)).reason
        'the device has no motors for all of it'
        """
    def reset(self) -> None:
        """
        Clears a trip that does not clear itself: the cause is in ``health()``.

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.reset()
        """
    def state(self) -> PenState:
        """
        The newest sample.

        Returns
        -------
        PenState

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.state().pose.shape
        (6,)
        """
    def stop(self) -> bool:
        """
        Ends the force and closes the device.

        Returns
        -------
        bool
            False if the device could not be reached in time.

        Examples
        --------
        >>> pen = riffler.pen.open("simulated")
        >>> pen.stop()
        True
        """
    @property
    def about(self) -> str:
        """
        The device's own description.
        """
    @property
    def geometry(self) -> PenGeometry | None:
        """
        Geometry of a pen of two arms, with the currents that the device allows; None for other devices.
        """
    @property
    def kind(self) -> str:
        """
        Its kind in ``riffler.pen.kinds``.
        """
    @property
    def limits(self) -> dict[str, riffler.pen_results.CoordinateCapability]:
        """
        What the device senses and pushes along "x", "y", "z" and about the axes "a", "b", "c".
        """
    @property
    def priority(self) -> riffler.pen_results.ThreadPriority:
        """
        How the system runs the device's thread: ThreadPriority.
        """
class SimulatedPen(PenDevice):
    """
    A pen without hardware: arms, motors, firmware and cable are simulated, and a hand moves it.

    Examples
    --------
    >>> with riffler.pen.open("simulated") as pen:
    ...     isinstance(pen, riffler.pen.SimulatedPen)
    True
    """
    def aim(self, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, spin: typing.SupportsFloat = 0.0, grip: typing.SupportsFloat = 1.0, buttons: typing.SupportsInt = 0) -> None:
        """
        Moves the hand to a pose, at up to 300 mm/s and 5 rad/s, as far as the arms reach.

        Parameters
        ----------
        pose : array_like, shape (6,)
            Point, mm, and axis.
        spin : float
            rad about the axis.
        grip : float
            1: the hand holds firmly; less: more loosely; 0: not at all.
        buttons : int
            As bits; bit 0 is button 1.

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.aim((0, 0, 0, 0, 0, 1), buttons=1)
        """
    def hang(self, mass: typing.SupportsFloat, hook: typing.SupportsFloat = 15.0) -> None:
        """
        Hangs a weight on the grip by a thread.

        Parameters
        ----------
        mass : float
            kg; 0 takes it off.
        hook : float
            mm from the grip's point towards the tool's tip, along the grip.

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.hang(0.2)
        """
    def lose(self, channel: typing.SupportsInt, counts: typing.SupportsInt) -> None:
        """
        Makes a counter lose counts, one by one: a fault to practise with.

        Parameters
        ----------
        channel : int
            0 to 5.
        counts : int
            Total number of lost counts.

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.lose(0, 20)
        """
    def plug(self) -> None:
        """
        Puts the cable in again; the pen then connects by itself.

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.unplug()
        ...     pen.plug()
        """
    def unplug(self) -> None:
        """
        Pulls the cable out: a fault to practise with.

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.unplug()
        """
    def wander(self) -> None:
        """
        Moves the hand along its own closed curve again.

        Examples
        --------
        >>> with riffler.pen.open("simulated") as pen:
        ...     pen.wander()
        """
    @property
    def truth(self) -> PenGeometry:
        """
        PenGeometry of the simulated arms and motors; ``geometry`` has the values that the host assumes.
        """
class Pointer(PenDevice):
    """
    A tablet or a mouse as a device: `give` passes its events, which become poses.

    Parameters
    ----------
    kind : {"tablet", "mouse"}
        A tablet senses point and axis, a mouse the point only; its axis stands upright on the plane.

    Examples
    --------
    >>> pointer = riffler.pen.Pointer("tablet")
    >>> pointer.give(3, 4, pressure=0.5, time=0.0)
    True
    """
    def __init__(self, kind: str = 'tablet') -> None:
        ...
    def give(self, x: typing.SupportsFloat, y: typing.SupportsFloat, *, pressure: typing.SupportsFloat = 0.0, tilt_x: typing.SupportsFloat = 0.0, tilt_y: typing.SupportsFloat = 0.0, buttons: typing.SupportsInt = 0, time: typing.SupportsFloat) -> bool:
        """
        Gives an event.

        Parameters
        ----------
        x, y : float
            Right and up, in units of the frame.
        pressure : float
            0 to 1.
        tilt_x, tilt_y : float
            rad by which the pen's end leans to the right and up.
        buttons : int
            As bits; bit 0 is button 1.
        time : float
            s of any clock.

        Returns
        -------
        bool
            False if the event is ignored: a number is not finite, or the time is before the last event's.

        Examples
        --------
        >>> riffler.pen.Pointer("mouse").give(3, 4, time=0.0)
        True
        """
    def set_frame(self, *, origin: numpy.typing.ArrayLike = (0, 0, 0), right: numpy.typing.ArrayLike = (1, 0, 0), up: numpy.typing.ArrayLike = (0, 1, 0), scale: typing.SupportsFloat = 1.0, depth: typing.SupportsFloat = 2.0, max_tilt: typing.SupportsFloat = 1.0) -> None:
        """
        Sets the position of the pointer's plane, from the next event on.

        Parameters
        ----------
        origin : array_like, shape (3,)
            mm, of pointer (0, 0).
        right, up : array_like, shape (3,)
            Unit vectors, perpendicular to each other.
        scale : float
            mm for a unit of the pointer.
        depth : float
            mm into the plane at full pressure.
        max_tilt : float
            rad from upright, below pi/2.

        Raises
        ------
        ValueError
            Naming the impossible value; the frame is then unchanged.

        Examples
        --------
        >>> pointer = riffler.pen.Pointer("mouse")
        >>> pointer.set_frame(origin=(0, 0, 10), scale=0.5)
        """
class _PoseFollower:
    """
    Leads the grip of an open pen along a path: pen/pose_follower.hpp.
    """
    def __init__(self, device: PenDevice, times: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wrenches: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, leads: bool = True, gravity: typing.SupportsFloat = 1.0, weight: typing.SupportsFloat = 0.0, hook: typing.SupportsFloat = 0.0) -> None:
        ...
    def alive(self) -> None:
        ...
    def end(self) -> None:
        ...
    def records(self) -> tuple:
        ...
    def stop(self) -> None:
        ...
    @property
    def state(self) -> str:
        ...
    @property
    def time(self) -> float:
        ...
    @property
    def why(self) -> str | None:
        ...
class JournalStroke:
    """
    One stroke of a journal: see `Journal.add_stroke`.
    """
    def __len__(self) -> int:
        ...
    @property
    def amount(self) -> float:
        """
        mm or rad, for brushes.
        """
    @property
    def falloff(self) -> str:
        """
        For brushes.
        """
    @property
    def forces(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        (n, 6) N, N·mm about the grip, as sent to the device for the hand; or None.
        """
    @property
    def mode(self) -> str:
        """
        "remove", "add", "mask", "unmask", "soften", "beside", "build" or a brush: see ``Journal.add_stroke``.
        """
    @property
    def name(self) -> str:
        """
        Name for users.
        """
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6): tip in mm and unit axis; of a hand tool (n, 9), with its forward direction. A copy.
        """
    @property
    def removed(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        (n,) mm³ by the move that ends at the row, or None.
        """
    @property
    def strength(self) -> float:
        """
        0 to 1, for "soften" and brushes.
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        (n,) s, or None.
        """
    @property
    def tolerance(self) -> float:
        """
        mm.
        """
    @property
    def tool(self) -> int:
        """
        Number of the tool.
        """
class Journal:
    """
    Record of a session: stock, tools, strokes as poses, notes.

    Replaying the strokes on the stock gives the session again. Files end in .rjournal.

    Examples
    --------
    >>> journal = riffler.Journal()
    >>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
    >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
    >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)])
    >>> journal.replay().volume < 20 * 20 * 10
    True
    """
    @staticmethod
    def load(path: os.PathLike | str | bytes, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Journal:
        """
        Reads a .rjournal file. One that a crash has cut gives all whole records; ``cut_at`` is where it was cut.

        Parameters
        ----------
        path : path_like
            The file.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        Journal

        Raises
        ------
        FormatError
            Naming the byte of a damaged record that others follow.

        Examples
        --------
        >>> riffler.Journal().save("a.rjournal")
        >>> riffler.Journal.load("a.rjournal")
        <riffler.Journal: 0 strokes>
        """
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def add_note(self, key: str, value: str) -> None:
        """
        Adds one key/value note on where the journal comes from.

        Parameters
        ----------
        key, value : str
            If a key is given twice, the later value counts.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_note("operator", "Ada")
        >>> journal.notes
        {'operator': 'Ada'}
        """
    def add_stroke(self, tool: typing.SupportsInt, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, times: numpy.typing.ArrayLike | None = None, tolerance: typing.SupportsFloat = 0.01, name: str = '', forces: numpy.typing.ArrayLike | None = None, removed: numpy.typing.ArrayLike | None = None, mode: str = 'remove', strength: typing.SupportsFloat = 0.5, amount: typing.SupportsFloat = 0.0, falloff: str = 'smooth') -> None:
        """
        Records a stroke. Replay is exact to the bit for ``carve`` in mode "add" or with a mask only if each carve is one stroke.

        Parameters
        ----------
        tool : int
            Number of an added tool.
        poses : array_like, shape (n, 6)
            Tip in mm and unit axis, n at least 1. For a hand tool (n, 9), as in ``Volume.carve``.
        times : array_like, shape (n,), optional
            s, never falling.
        tolerance : float
            mm, as in ``Volume.carve``.
        name : str
            Name for users.
        forces : array_like, shape (n, 6), optional
            N and N·mm as sent to the device for the hand, about the grip.
        removed : array_like, shape (n,), optional
            mm³ by the move that ends at the row.
        mode : {"remove", "add", "mask", "unmask", "soften", "beside", "build", "clay", "inflate", …}
            What the tool does where it sweeps: "remove" and "add" material, but not where it is protected; "mask" and "unmask":
            protect it, or no longer; "soften": a smoothing dab at each row's tip, as wide as the tool; "beside": remove as a
            Session does next to what is protected; "build": add as a Session does. Any brush of ``Volume.brush``: its dabs at
            the rows, as wide as the tool.
        strength : float
            Of "soften" and brushes, 0 to 1.
        amount : float
            Of brushes, mm or rad.
        falloff : str
            Of brushes.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)], times=(0, 1))
        >>> len(journal.strokes)
        1
        """
    def add_tool(self, number: typing.SupportsInt, tool: Tool | collections.abc.Mapping[str, object] | str) -> None:
        """
        Records a tool. The same number again is allowed for the same tool only.

        Parameters
        ----------
        number : int
            Number by which strokes refer to it.
        tool : Tool, dict or str
            A Tool, its dict or JSON text of it.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> list(journal.tools)
        [1]
        """
    def extend_stroke(self, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, times: numpy.typing.ArrayLike | None = None, forces: numpy.typing.ArrayLike | None = None, removed: numpy.typing.ArrayLike | None = None) -> None:
        """
        Adds rows to the last stroke, with the same columns.

        Parameters
        ----------
        poses : array_like, shape (n, 6)
            Tip in mm and unit axis; (n, 9) for a hand tool.
        times, forces, removed : array_like, optional
            As of ``add_stroke``.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
        >>> journal.extend_stroke([(20, 10, 8, 0, 0, 1)])
        >>> len(journal.strokes[0])
        2
        """
    def program(self, *, feed: typing.SupportsFloat | None = None, spindle: typing.SupportsFloat = 0.0, safe_height: typing.SupportsFloat | None = None, clearance: typing.SupportsFloat = 10.0) -> Program:
        """
        The strokes as a Program, each one cut as in ``Program.from_cl``. The stock counts as occupied.

        Strokes that do not remove are left out: no machine can make them.

        Parameters
        ----------
        feed : float, optional
            mm/min; None: from the times, limited to 1 to 100 000 mm/min.
        spindle : float
            rev/min.
        safe_height : float, optional
            z (mm) above everything; None: ``clearance`` above everything.
        clearance : float
            mm.

        Returns
        -------
        Program

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)])
        >>> program = journal.program(feed=600, spindle=9000)
        >>> program.tools[1].diameter
        6.0
        """
    def redo(self, n: typing.SupportsInt = 1) -> None:
        """
        Redoes the last strokes that were undone, unless a new stroke has begun.

        Parameters
        ----------
        n : int
            Number of strokes.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
        >>> journal.undo()
        >>> journal.redo()
        >>> len(journal.strokes)
        1
        """
    def replay(self, folder: os.PathLike | str | bytes | None = None, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        The stock after the strokes, to the bit as the session left it.

        A row with the same pose as the row before is not a move; a stroke that never moves cuts where it stands if it has two rows
        or more.

        Parameters
        ----------
        folder : path_like, optional
            Folder of the stock's snapshot, for a stock that is not a block.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
        >>> journal.replay().volume
        4000.0
        """
    def replay_with_mask(self, folder: os.PathLike | str | bytes | None = None, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> tuple[Volume, Volume | None]:
        """
        As ``replay``, with the region that is protected at the end.

        Parameters
        ----------
        folder : path_like, optional
            Folder of the snapshots of stock and mask.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        stock : Volume
        mask : Volume or None

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
        >>> stock, mask = journal.replay_with_mask()
        >>> mask is None
        True
        """
    def save(self, path: os.PathLike | str | bytes) -> None:
        """
        Writes the journal: the whole file or none.

        Parameters
        ----------
        path : path_like
            The file.

        Examples
        --------
        >>> riffler.Journal().save("a.rjournal")
        """
    def set_stock(self, lower: numpy.typing.ArrayLike, upper: numpy.typing.ArrayLike, pitch: typing.SupportsFloat, directions: str = 'z', *, snapshot: str = '', mask: str = '') -> None:
        """
        Records the frame of the stock. Call it once.

        Parameters
        ----------
        lower, upper : array_like, shape (3,)
            Corners of its box, mm.
        pitch : float
            mm.
        directions : {"z", "xyz"}
            As of the Volume.
        snapshot : str
            Name of the file with the stock, if it is not a full block.
        mask : str
            Name of the file with the protected region, if any.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
        >>> journal.stock.pitch
        0.5
        """
    def strokes_at(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, tolerance: typing.SupportsFloat = 0.05, progress: collections.abc.Callable[[float], bool | None] | None = None) -> numpy.typing.NDArray[numpy.int32]:
        """
        The stroke that made the surface at each point.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            mm: points on the surface that the strokes leave, such as vertices of its mesh.
        tolerance : float
            mm that a point may be off the surface; a quarter of the pitch fits vertices of a mesh.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        ndarray, shape (n,)
            The place in ``strokes`` of the one that swept along the point, the first if several did; -1 where none did: the
            stock's own surface, and what was smoothed.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)])
        >>> journal.strokes_at([(10, 10, 8), (10, 2, 10)])
        array([ 0, -1], dtype=int32)
        """
    def undo(self, n: typing.SupportsInt = 1) -> None:
        """
        Undoes the last strokes: they no longer count.

        Parameters
        ----------
        n : int
            Number of strokes.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
        >>> journal.undo()
        >>> len(journal.strokes)
        0
        """
    @property
    def cut_at(self) -> int | None:
        """
        Byte at which the file had been cut, or None.
        """
    @property
    def notes(self) -> dict[str, str]:
        """
        Notes on where the journal comes from, by key; the later value of a key given twice.
        """
    @property
    def stock(self) -> riffler.program_results.JournalStock | None:
        """
        Frame and files of the stock, or None.
        """
    @property
    def strokes(self) -> list[JournalStroke]:
        """
        The strokes that count.
        """
    @property
    def tools(self) -> dict[int, dict]:
        """
        Each tool's dict, by number.
        """
class JournalWriter:
    """
    Appends to a journal file, record by record. Context manager.

    Continues an existing file, after cutting off a damaged tail, or begins a new one. Each record is passed to the
    system before the call returns.

    Parameters
    ----------
    path : path_like
        The .rjournal file.
    keep : bool
        False: holds no strokes in memory, for long sessions; ``journal`` cannot be used then.

    Examples
    --------
    >>> with riffler.JournalWriter("a.rjournal") as writer:
    ...     writer.set_stock((0, 0, 0), (20, 20, 10), 0.5)
    ...     writer.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
    ...     writer.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)])
    >>> len(riffler.Journal.load("a.rjournal").strokes)
    1
    """
    def __enter__(self) -> typing.Self:
        ...
    def __exit__(self, *args) -> None:
        ...
    def __init__(self, path: os.PathLike | str | bytes, *, keep: bool = True) -> None:
        ...
    def add_note(self, key: str, value: str) -> None:
        """
        Adds one key/value note on where the journal comes from.

        Parameters
        ----------
        key, value : str
            If a key is given twice, the later value counts.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_note("operator", "Ada")
        >>> journal.notes
        {'operator': 'Ada'}
        """
    def add_stroke(self, tool: typing.SupportsInt, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, times: numpy.typing.ArrayLike | None = None, tolerance: typing.SupportsFloat = 0.01, name: str = '', forces: numpy.typing.ArrayLike | None = None, removed: numpy.typing.ArrayLike | None = None, mode: str = 'remove', strength: typing.SupportsFloat = 0.5, amount: typing.SupportsFloat = 0.0, falloff: str = 'smooth') -> None:
        """
        Records a stroke. Replay is exact to the bit for ``carve`` in mode "add" or with a mask only if each carve is one stroke.

        Parameters
        ----------
        tool : int
            Number of an added tool.
        poses : array_like, shape (n, 6)
            Tip in mm and unit axis, n at least 1. For a hand tool (n, 9), as in ``Volume.carve``.
        times : array_like, shape (n,), optional
            s, never falling.
        tolerance : float
            mm, as in ``Volume.carve``.
        name : str
            Name for users.
        forces : array_like, shape (n, 6), optional
            N and N·mm as sent to the device for the hand, about the grip.
        removed : array_like, shape (n,), optional
            mm³ by the move that ends at the row.
        mode : {"remove", "add", "mask", "unmask", "soften", "beside", "build", "clay", "inflate", …}
            What the tool does where it sweeps: "remove" and "add" material, but not where it is protected; "mask" and "unmask":
            protect it, or no longer; "soften": a smoothing dab at each row's tip, as wide as the tool; "beside": remove as a
            Session does next to what is protected; "build": add as a Session does. Any brush of ``Volume.brush``: its dabs at
            the rows, as wide as the tool.
        strength : float
            Of "soften" and brushes, 0 to 1.
        amount : float
            Of brushes, mm or rad.
        falloff : str
            Of brushes.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)], times=(0, 1))
        >>> len(journal.strokes)
        1
        """
    def add_tool(self, number: typing.SupportsInt, tool: Tool | collections.abc.Mapping[str, object] | str) -> None:
        """
        Records a tool. The same number again is allowed for the same tool only.

        Parameters
        ----------
        number : int
            Number by which strokes refer to it.
        tool : Tool, dict or str
            A Tool, its dict or JSON text of it.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> list(journal.tools)
        [1]
        """
    def close(self) -> None:
        """
        Closes the file; later calls raise RuntimeError.

        Examples
        --------
        >>> writer = riffler.JournalWriter("a.rjournal")
        >>> writer.close()
        """
    def extend_stroke(self, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, times: numpy.typing.ArrayLike | None = None, forces: numpy.typing.ArrayLike | None = None, removed: numpy.typing.ArrayLike | None = None) -> None:
        """
        Adds rows to the last stroke, with the same columns.

        Parameters
        ----------
        poses : array_like, shape (n, 6)
            Tip in mm and unit axis; (n, 9) for a hand tool.
        times, forces, removed : array_like, optional
            As of ``add_stroke``.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
        >>> journal.extend_stroke([(20, 10, 8, 0, 0, 1)])
        >>> len(journal.strokes[0])
        2
        """
    def redo(self, n: typing.SupportsInt = 1) -> None:
        """
        Redoes the last strokes that were undone, unless a new stroke has begun.

        Parameters
        ----------
        n : int
            Number of strokes.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
        >>> journal.undo()
        >>> journal.redo()
        >>> len(journal.strokes)
        1
        """
    def set_stock(self, lower: numpy.typing.ArrayLike, upper: numpy.typing.ArrayLike, pitch: typing.SupportsFloat, directions: str = 'z', *, snapshot: str = '', mask: str = '') -> None:
        """
        Records the frame of the stock. Call it once.

        Parameters
        ----------
        lower, upper : array_like, shape (3,)
            Corners of its box, mm.
        pitch : float
            mm.
        directions : {"z", "xyz"}
            As of the Volume.
        snapshot : str
            Name of the file with the stock, if it is not a full block.
        mask : str
            Name of the file with the protected region, if any.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
        >>> journal.stock.pitch
        0.5
        """
    def sync(self) -> None:
        """
        Waits until everything is on the disk.

        Examples
        --------
        >>> with riffler.JournalWriter("a.rjournal") as writer:
        ...     writer.sync()
        """
    def undo(self, n: typing.SupportsInt = 1) -> None:
        """
        Undoes the last strokes: they no longer count.

        Parameters
        ----------
        n : int
            Number of strokes.

        Examples
        --------
        >>> journal = riffler.Journal()
        >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
        >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1)])
        >>> journal.undo()
        >>> len(journal.strokes)
        0
        """
    @property
    def journal(self) -> Journal:
        """
        A copy of everything in the file.
        """
class Material:
    """
    Properties of a stock's or fixture's material that a hand can feel.

    Parameters
    ----------
    stiffness : float
        N per mm of depth and mm² of surface; for a fixture N per mm³ in the tool.
    removal_constant : float
        N·s/mm³: force for volume removed per second.
    damping : float
        N·s/mm on a cutter in the cut.
    density : float
        g/cm³.

    Examples
    --------
    >>> wood = riffler.Material(removal_constant=0.03, density=0.7)
    >>> wood.mass(1000)
    0.7
    """
    def __init__(self, *, stiffness: typing.SupportsFloat = 1.0, removal_constant: typing.SupportsFloat = 0.05, damping: typing.SupportsFloat = 0.0, density: typing.SupportsFloat = 1.0) -> None:
        ...
    def mass(self, volume: typing.SupportsFloat) -> float:
        """
        Mass of a volume.

        Parameters
        ----------
        volume : float
            mm³.

        Returns
        -------
        float
            g.

        Examples
        --------
        >>> riffler.Material(density=0.7).mass(1000)
        0.7
        """
    @property
    def damping(self) -> float:
        """
        N·s/mm on a cutter in the cut.
        """
    @property
    def density(self) -> float:
        """
        g/cm³.
        """
    @property
    def removal_constant(self) -> float:
        """
        N·s/mm³: force for volume removed per second.
        """
    @property
    def stiffness(self) -> float:
        """
        N per mm of depth and mm² of surface; for a fixture N per mm³ in the tool.
        """
class SessionFrame:
    """
    The steps between two calls of ``Session.frame``, one row for each: see `Session.frame`.

    Forces and torques act on the hand, about the grip's point, in the device's frame; those on the tool act on it, about its
    tip, in the part's.
    """
    def __len__(self) -> int:
        ...
    @property
    def applied(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6): as applied, if the device reports it; otherwise as sent one step before.
        """
    @property
    def cause(self) -> str | None:
        """
        Why the force was removed and what to do, or None.
        """
    @property
    def cutting(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) 1 in strokes, otherwise 0.
        """
    @property
    def depth(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm: largest depth of the tool in what it must not enter.
        """
    @property
    def dropped_ticks(self) -> int:
        """
        Steps since the start that are missing in all frames because frames were too rare; 4096 are kept.
        """
    @property
    def dt(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) s from step to step.
        """
    @property
    def energy(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) N·mm: the passivity account, the energy that may still go to the hand.
        """
    @property
    def force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) N, now.
        """
    @property
    def forces(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6): force (N) and torque (N·mm), as sent to the device.
        """
    @property
    def grip(self) -> numpy.ndarray:
        """
        (6,) now.
        """
    @property
    def grips(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) of the grip, in the device's frame.
        """
    @property
    def held(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) 1 where the tool did not move, because its depth in the obstacles was not found in time.
        """
    @property
    def in_stroke(self) -> bool:
        """
        Whether a stroke was in progress when the loop handed over the frame's tiles.
        """
    @property
    def missed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) 1 where a step was missed and the last force was held.
        """
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) of the tool, at each step's end.
        """
    @property
    def problem(self) -> str | None:
        """
        Why the tool does not cut although the hand asks for it, or None.
        """
    @property
    def removed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm³ removed; added in a session that adds.
        """
    @property
    def starts(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) of the tool, at the start of each step; differs from the pose before after a new placement.
        """
    @property
    def state(self) -> str:
        """
        Force state now: off, homing, ready, ramp, active, degraded or tripped.
        """
    @property
    def step_seconds(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) s of processor time.
        """
    @property
    def strokes(self) -> int:
        """
        Number of strokes begun since the start.
        """
    @property
    def tiles(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (k, 2): number of the grid and of the tile in it, for each tile that changed.
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) s since the start.
        """
    @property
    def tool(self) -> numpy.ndarray:
        """
        (6,) now.
        """
    @property
    def tool_forces(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6): force (N) and torque (N·mm) of the material on the tool, before limits.
        """
    @property
    def torque(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) N·mm, now.
        """
class Session:
    """
    A pen, a tool and a stock: the tool follows the hand and cuts a thousand times a second, and the hand feels it.

    The device's own thread cuts. ``volume`` is the displayed volume: each call of ``frame`` brings it up to date, between steps, and
    nothing else may change it while the session runs. The tool cuts while a button of ``dead_man_mask`` is held and every
    check of the pen passes. Context manager: starts and stops.

    Parameters
    ----------
    volume : Volume
        The stock.
    tool : Tool
        The cutter.
    pen : PenDevice, optional
        From ``riffler.pen.open``, or a ``riffler.pen.Pointer``; None: a Pointer of kind "mouse", then the session's ``pen``.
    obstacles : Collider, optional
        Part and fixtures that the tool does not enter.
    protect : Volume, optional
        Region that must not change, with the lower, upper, pitch and directions of ``volume``; air to the tool.
    mode : {"remove", "add"}
        "add": the cutter adds what it sweeps, over its whole length and within the volume's box. The hand then feels neither
        that nor the stock, only obstacles.
    material : Material, optional
        Material of the stock.
    at : array_like, shape (6,), optional
        Pose of the tool at the start: tip in mm and axis. None: the hand's pose for tablets, mice and recordings, otherwise
        5 mm above the middle of the stock.
    scale : float
        mm of the tool per mm of the hand.
    turn : array_like, shape (3, 3), optional
        Rotation from the hand's frame to the tool's; None: none.
    stiffness, turn_stiffness : float
        Of the coupling between hand and tool, N/mm and N·mm/rad.
    damping, turn_damping : float
        Of the coupling, N·s/mm and N·mm·s/rad.
    tolerance : float
        mm, of the cuts, as in ``Volume.carve``.
    memory : float, optional
        mm of travel over which the resistance is estimated; None: chosen by tool and stock.
    max_force, max_torque, max_power : float
        Largest force (N), torque (N·mm) and power (N·mm/s) given to the hand.
    ramp : float
        s from no force to full force, at the start and after interruptions.
    dead_man_mask, clutch_mask : int
        Buttons, as bits: cut while one is held; move the hand without the tool.
    pivot : float
        mm above the tip, on the tool's axis: the point that the grip leads, about which the hand turns the tool and feels its
        torque. 0: the tip. Without effect for devices in the part's frame.
    touch : bool
        Keep the tool out of the stock while no button of ``dead_man_mask`` is held, so that the hand feels what it carves; the
        button then only cuts. Not with the mode "add".
    touch_force : float
        Largest force of that on the hand, N; its torque is limited in proportion.
    touch_mask : int
        Buttons, as bits, of which one must be held for it; 0: none, so that force acts whenever the checks of the pen pass.
    budget : float, "auto" or None
        s for one step; None: as long as it takes, and steps are deterministic; "auto": 0.0004 for a device with motors, None
        for others.
    undo : int
        Number of strokes that can be undone.

    Raises
    ------
    TypeError, ValueError
        Naming the argument that is wrong.

    Examples
    --------
    >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
    >>> ball = riffler.Tool.ball(diameter=6, length=30)
    >>> with riffler.Session(stock, ball, at=(10, 10, 15, 0, 0, 1), max_force=3.0) as session:
    ...     frame = session.frame()
    >>> frame.in_stroke
    False
    """
    @staticmethod
    def replay(path: os.PathLike | str | bytes, *, progress: collections.abc.Callable[[float], bool | None] | None = None) -> Volume:
        """
        The stock of a session at its end, to the bit. The initial stock must be next to the journal.

        Parameters
        ----------
        path : path_like
            The .rjournal file.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Returns
        -------
        Volume

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
        >>> session.journal("first.rjournal")
        >>> with session:
        ...     frame = session.frame()
        >>> riffler.Session.replay("first.rjournal").to_bytes() == stock.to_bytes()
        True
        """
    def __enter__(self) -> typing.Self:
        ...
    def __exit__(self, *args) -> None:
        ...
    def __init__(self, volume: Volume, tool: Tool, pen: PenDevice | None = None, *, obstacles: Collider | None = None, protect: Volume | None = None, mode: str = 'remove', material: Material | None = None, at: numpy.typing.ArrayLike | None = None, scale: typing.SupportsFloat = 1.0, turn: numpy.typing.ArrayLike | None = None, stiffness: typing.SupportsFloat = 1.0, turn_stiffness: typing.SupportsFloat = 2000.0, damping: typing.SupportsFloat = 0.001, turn_damping: typing.SupportsFloat = 2.0, tolerance: typing.SupportsFloat = 0.01, memory: typing.SupportsFloat | None = None, max_force: typing.SupportsFloat = 5.0, max_torque: typing.SupportsFloat = 300.0, max_power: typing.SupportsFloat = 2000.0, ramp: typing.SupportsFloat = 0.5, dead_man_mask: typing.SupportsInt = 1, clutch_mask: typing.SupportsInt = 2, pivot: typing.SupportsFloat = 0.0, touch: bool = False, touch_force: typing.SupportsFloat = 1.5, touch_mask: typing.SupportsInt = 0, budget: float | typing.Literal['auto'] | None = 'auto', undo: typing.SupportsInt = 64) -> None:
        ...
    def frame(self) -> SessionFrame:
        """
        Brings the volume up to date and returns what happened since the last call.

        Waits for the next step, 3 ms at most.

        Returns
        -------
        SessionFrame

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
        ...     frame = session.frame()
        >>> frame.tiles.shape
        (0, 2)
        """
    def journal(self, path: os.PathLike | str | bytes, *, notes: dict = {}) -> None:
        """
        Records every stroke in a new file: poses, times, forces, what was cut. Call it before ``start``.

        Writes the stock (``NAME-stock.rvol``) and the protected region (``NAME-mask.rvol``) next to it. The file survives
        a crash but for the last second at most, and ``Session.replay`` replays it.

        Parameters
        ----------
        path : path_like
            The .rjournal file.
        notes : dict
            Strings that the journal keeps.

        Raises
        ------
        ValueError
            If one of the files is there already.

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
        >>> session.journal("first.rjournal", notes={"operator": "Ada"})
        >>> with session:
        ...     frame = session.frame()
        >>> riffler.Session.replay("first.rjournal").volume
        4000.0
        """
    def journal_written(self, seconds: typing.SupportsFloat = 2.0) -> bool:
        """
        Waits until all rows that were made so far are in the journal's file, which is some 50 ms behind.

        Parameters
        ----------
        seconds : float
            Longest time to wait.

        Returns
        -------
        bool
            False if some are not.

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
        >>> session.journal_written()
        True
        """
    def redo(self) -> int:
        """
        Redoes undone strokes, unless a new stroke has begun.

        Returns
        -------
        int
            How many strokes were redone.

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
        ...     print(session.redo())
        0
        """
    def reset(self) -> None:
        """
        Clears a trip that does not clear itself: ``SessionFrame.cause`` gives its reason.

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
        ...     session.reset()
        """
    def set_workspace(self, *, scale: typing.SupportsFloat = 1.0, turn: numpy.typing.ArrayLike | None = None, dead_man_mask: typing.SupportsInt = 1, clutch_mask: typing.SupportsInt = 2, pivot: typing.SupportsFloat = 0.0) -> None:
        """
        Changes scale, view or buttons from the next step on. The tool does not jump.

        Parameters
        ----------
        scale : float
            mm of the tool per mm of the hand.
        turn : array_like, shape (3, 3), optional
            Rotation from the hand's frame to the tool's; None: none.
        dead_man_mask, clutch_mask : int
            Buttons, as bits: cut while one is held; move the hand without the tool.
        pivot : float
            mm above the tip, on the tool's axis: the point that the grip leads, about which the hand turns the tool and feels its
            torque. 0: the tip. Without effect for devices in the part's frame.

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
        ...     session.set_workspace(scale=0.5)
        """
    def start(self) -> None:
        """
        Starts sculpting, in the pen's own thread. Call it once.

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
        >>> session.start()
        >>> frame = session.stop()
        """
    def stop(self) -> SessionFrame:
        """
        Ends the force. Everything that was cut is in the volume and in the journal on the disk, if any.

        Returns
        -------
        SessionFrame
            The steps since the last frame.

        Raises
        ------
        RuntimeError
            If the journal is not complete on the disk; the session has stopped.

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> session = riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30))
        >>> session.start()
        >>> session.stop().strokes
        0
        """
    def undo(self) -> int:
        """
        Undoes the last stroke, or the last few if they ended between two frames.

        Returns
        -------
        int
            How many strokes were undone; 0: there is none.

        Raises
        ------
        RuntimeError
            During a stroke.

        Examples
        --------
        >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
        >>> with riffler.Session(stock, riffler.Tool.ball(diameter=6, length=30)) as session:
        ...     print(session.undo())
        0
        """
    @property
    def journal_problem(self) -> str | None:
        """
        Why strokes wait for the disk, or None.
        """
    @property
    def pen(self) -> PenDevice:
        """
        The device.
        """
    @property
    def priority(self) -> riffler.pen_results.ThreadPriority:
        """
        How the system runs the thread of the steps: ThreadPriority.
        """
    @property
    def running(self) -> bool:
        """
        Whether the session was started and not stopped.
        """
    @property
    def trips(self) -> list[riffler.program_results.Trip]:
        """
        Times at which the force was removed, with the reasons.
        """
    @property
    def volume(self) -> Volume:
        """
        The displayed volume.
        """
class PencilPath:
    """
    A curve of ball centres along a part, with the ball's contacts. Immutable.

    Parameters
    ----------
    radius : float
        Radius of the ball, mm.
    centres : array_like, shape (n, 3)
        mm.
    contacts : array_like, shape (n, 2, 3)
        Points of the part that the ball touches, mm.
    normals : array_like, shape (n, 2, 3)
        The part's unit normals there, out of the material.
    closed : bool
        A loop: its last point is joined to its first.

    Examples
    --------
    >>> contacts = [[(x, -1.2, 1.6), (x, 1.2, 1.6)] for x in (0, 10)]
    >>> normals = [[(0, 0.6, 0.8), (0, -0.6, 0.8)]] * 2
    >>> path = riffler.plan.PencilPath(2.0, [(0, 0, 3.2), (10, 0, 3.2)], contacts, normals)
    >>> path.length
    10.0
    """
    def __init__(self, radius: typing.SupportsFloat, centres: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], contacts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], normals: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, closed: bool = False) -> None:
        ...
    def __len__(self) -> int:
        ...
    def axis(self, index: typing.SupportsInt, inclination: typing.SupportsFloat, tilt: typing.SupportsFloat) -> numpy.typing.NDArray[numpy.float64]:
        """
        Unit axis that leans from the frame's z at a point: the inverse of ``lean``.

        cos(tilt) (sin(inclination) x + cos(inclination) z) + sin(tilt) y.

        Parameters
        ----------
        index : int
            Number of the point, from 0.
        inclination, tilt : float
            rad, forward and to the left.

        Returns
        -------
        ndarray, shape (3,)

        Examples
        --------
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
        >>> valley.axis(0, 0.0, 0.0).round(6) + 0.0
        array([0., 0., 1.])
        """
    def divided(self, step: typing.SupportsFloat) -> PencilPath:
        """
        The path with further points, so that keys can be set there: a straight valley has only its ends.

        Parameters
        ----------
        step : float
            mm; points are inserted evenly between two that are further apart.

        Returns
        -------
        PencilPath
            Without axes.

        Examples
        --------
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
        >>> len(valley), len(valley.divided(10))
        (2, 4)
        """
    def lean(self, index: typing.SupportsInt, axis: numpy.typing.ArrayLike) -> tuple[float, float]:
        """
        Inclination and tilt of an axis at a point: the inverse of ``axis``.

        Parameters
        ----------
        index : int
            Number of the point, from 0.
        axis : array_like, shape (3,)
            Unit axis.

        Returns
        -------
        inclination, tilt : float
            rad.

        Examples
        --------
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
        >>> inclination, tilt = valley.lean(0, valley.axis(0, 0.1, 0.2))
        >>> round(inclination, 6), round(tilt, 6)
        (0.1, 0.2)
        """
    def nearest(self, point: numpy.typing.ArrayLike, *, direction: numpy.typing.ArrayLike | None = None) -> riffler.program_results.NearestContact:
        """
        The contact nearest to a point, or to a ray of a pen or mouse.

        Parameters
        ----------
        point : array_like, shape (3,)
            mm.
        direction : array_like, shape (3,), optional
            The ray's direction.

        Returns
        -------
        NearestContact

        Examples
        --------
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
        >>> valley.nearest((1, 12, 2)).index in (0, 1)
        True
        """
    def orient(self, keys: collections.abc.Mapping[int, numpy.typing.ArrayLike], *, interpolation: str = 'smooth', limit: tuple[numpy.typing.ArrayLike, float] | None = None, project: bool = False) -> PencilPath:
        """
        A new path with tool axes at all points, interpolated from some.

        To adjust an interpolated axis, make it a key: ``p.orient({**p.keys, i: axis})``.

        Parameters
        ----------
        keys : dict
            Index of a point, from 0, to unit axis. Axes are constant before the first key and after the last; on a closed path
            they are also interpolated from the last to the first.
        interpolation : {"smooth", "slerp", "linear"}
            "linear": straight between two axes by number of points and made unit, the source's (4.4)-(4.5); "slerp": the great
            circle at constant rate by arc length; "smooth": by arc length with a continuous derivative, at most 1.7 times as
            fast as slerp.
        limit : tuple of axis and angle, optional
            The cone in which the machine's rotary axes keep the tool: unit axis, half angle in rad.
        project : bool
            Moves an axis beyond ``limit`` onto the cone; otherwise it is an error.

        Returns
        -------
        PencilPath

        Raises
        ------
        ValueError
            Naming the first point beyond ``limit``, or the key that is outside the path, not a unit vector, or opposite to the key
            before it.

        Examples
        --------
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
        >>> valley.divided(10).orient({0: (0, 0, 1), 3: (0.6, 0, 0.8)}).axes.shape
        (4, 3)
        """
    def with_axes(self, axes: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, keys: collections.abc.Mapping[int, numpy.typing.ArrayLike] = {}, interpolation: str = '') -> PencilPath:
        """
        A new path with axes that were computed elsewhere.

        Parameters
        ----------
        axes : array_like, shape (n, 3)
            Unit tool axes, tip to spindle.
        keys : dict, optional
            Index to axis; kept with the axes.
        interpolation : str
            Kept likewise.

        Returns
        -------
        PencilPath

        Examples
        --------
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
        >>> valley.with_axes([(0, 0, 1)] * len(valley)).axes
        array([[0., 0., 1.],
               [0., 0., 1.]])
        """
    @property
    def axes(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3): unit tool axes, tip to spindle; (0, 3) until the path is oriented.
        """
    @property
    def centres(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) mm.
        """
    @property
    def closed(self) -> bool:
        """
        A loop: its last point is joined to its first.
        """
    @property
    def contacts(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 2, 3) mm.
        """
    @property
    def frames(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3, 3): the rows x, y, z of the frame at every point.

        x is the feed, z halves the angle between the directions from the contacts to the ball's centre, y = z × x.
        """
    @property
    def interpolation(self) -> str:
        """
        How the axes were interpolated; empty until the path is oriented.
        """
    @property
    def keys(self) -> dict[int, numpy.typing.NDArray[numpy.float64]]:
        """
        The axes that the others were interpolated from, by index.
        """
    @property
    def length(self) -> float:
        """
        mm, with the closing edge.
        """
    @property
    def normals(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 2, 3): unit normals of the part at the contacts, out of the material.
        """
    @property
    def radius(self) -> float:
        """
        Radius of the ball, mm.
        """
class OrientFrame:
    """
    The steps between two calls of ``OrientSession.frame``, one row for each.

    Forces and torques act on the hand, about the grip's point, in the device's frame; those on the tool act on it, about its
    tip, in the part's.

    Examples
    --------
    >>> ball = riffler.Tool.ball(diameter=4, length=20)
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> path = riffler.plan.pencil(part, ball)[0]
    >>> pen = riffler.pen.Pointer("tablet")
    >>> with riffler.OrientSession(path, ball, riffler.Collider(part), pen) as session:
    ...     frame = session.frame()
    >>> frame.touching is None
    True
    """
    def __len__(self) -> int:
        ...
    @property
    def cause(self) -> str | None:
        """
        Why the force was removed and what to do, or None.
        """
    @property
    def changes(self) -> tuple[riffler.program_results.KeyChange, ...]:
        """
        Changes of keys by presses of buttons, in order: KeyChange.
        """
    @property
    def depth(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm: largest depth of the tool in part and fixtures.
        """
    @property
    def dropped_ticks(self) -> int:
        """
        Steps since the start that are missing in all frames because frames were too rare; 4096 are kept.
        """
    @property
    def energy(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) N·mm: the passivity account, the energy that may still go to the hand.
        """
    @property
    def force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) N, now.
        """
    @property
    def forces(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6): force (N) and torque (N·mm), as sent to the device.
        """
    @property
    def grip(self) -> numpy.ndarray:
        """
        (6,) now.
        """
    @property
    def grips(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) of the grip, in the device's frame.
        """
    @property
    def held(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) 1 where the tool did not move, because its depth in the obstacles was not found in time.
        """
    @property
    def missed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) 1 where a step was missed and the last force was held.
        """
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) of the tool, at each step's end.
        """
    @property
    def problem(self) -> str | None:
        """
        Why the tool does not follow the hand, or None.
        """
    @property
    def state(self) -> str:
        """
        Force state now: off, homing, ready, ramp, active, degraded or tripped.
        """
    @property
    def station(self) -> float:
        """
        Present place on the path: a point index with a fraction.
        """
    @property
    def stations(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) places on the path: point indices with fractions.
        """
    @property
    def step_seconds(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) s of processor time.
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) s since the start.
        """
    @property
    def tool(self) -> numpy.ndarray:
        """
        (6,) now.
        """
    @property
    def tool_forces(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6): force (N) and torque (N·mm) of part and fixtures on the tool, before limits.
        """
    @property
    def torque(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) N·mm, now.
        """
    @property
    def touching(self) -> str | None:
        """
        The part of the tool that is deepest in contact now (cutter, shank, holder), fixture (for any part of the tool), or None.
        """
class OrientSession:
    """
    A pen turns a tool on a path, and its buttons set key orientations there: planning by feel.

    The cutter stays on the path, its axis follows the hand, and stops where cutter, shank or holder touch part or fixtures:
    the hand feels a torque away from what is hit, and a weak pull towards the path. Devices without torque get the force of
    the contact instead; those without motors move the tool alone. Context manager: starts and stops.

    Parameters
    ----------
    path : PencilPath
        Path to be oriented. Its keys are the first ones.
    tool : Tool
        Cutter, with shank and holder.
    part : Collider
        Part and fixtures.
    pen : PenDevice
        From ``riffler.pen.open``, or a ``riffler.pen.Pointer``.
    point : int
        Index of the path's point at which the tool starts.
    axis : array_like, shape (3,), optional
        Axis of the tool at the start; None: the path's there, or, if it has none, halfway between the walls that it touches.
    slide : bool
        Whether the tool follows the hand along the path; otherwise it rests at its point.
    interpolation : {"smooth", "slerp", "linear"}
        How axes between keys are found, as in ``PencilPath.orient``.
    limit : (axis, angle), optional
        Cone in which the machine allows keys, rad; a key beyond it is refused.
    reach : float
        mm along the path within which the second button finds a key to delete.
    scale : float
        mm of the tool per mm of the hand.
    turn : array_like, shape (3, 3), optional
        Rotation from the hand's frame to the tool's; None: none.
    stiffness, turn_stiffness : float
        Of the coupling between hand and tool, N/mm and N·mm/rad.
    max_force, max_torque, max_power : float
        Largest force (N), torque (N·mm) and power (N·mm/s) given to the hand.
    ramp : float
        s from no force to full force, at the start and after interruptions.
    set_mask, delete_mask : int
        Buttons, as bits: set a key where the tool is, replacing one at the same point; delete the nearest key.
    dead_man_mask, clutch_mask : int
        Buttons, as bits: force only while one is held (0: always); move the hand without the tool.
    pivot : float
        mm above the tip, on the tool's axis: the point that the grip leads, about which the hand turns the tool and feels its
        torque. 0: the tip. Without effect for devices in the part's frame.
    budget : float, "auto" or None
        s for one step; None: as long as it takes; "auto": 0.0004 for a device with motors, None for others.

    Raises
    ------
    TypeError, ValueError
        Naming the argument that is wrong.

    Examples
    --------
    >>> ball = riffler.Tool.ball(diameter=4, length=20)
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> path = riffler.plan.pencil(part, ball)[0]
    >>> pen = riffler.pen.open("simulated")
    >>> with riffler.OrientSession(path, ball, riffler.Collider(part), pen) as session:
    ...     frame = session.frame()
    >>> session.keys
    {}
    """
    def __enter__(self) -> typing.Self:
        ...
    def __exit__(self, *args) -> None:
        ...
    def __init__(self, path: PencilPath, tool: Tool, part: Collider, pen: PenDevice, *, point: typing.SupportsInt = 0, axis: numpy.typing.ArrayLike | None = None, slide: bool = True, interpolation: str = 'smooth', limit: tuple[numpy.typing.ArrayLike, float] | None = None, reach: typing.SupportsFloat = 2.0, scale: typing.SupportsFloat = 1.0, turn: numpy.typing.ArrayLike | None = None, stiffness: typing.SupportsFloat = 0.3, turn_stiffness: typing.SupportsFloat = 2000.0, max_force: typing.SupportsFloat = 5.0, max_torque: typing.SupportsFloat = 300.0, max_power: typing.SupportsFloat = 2000.0, ramp: typing.SupportsFloat = 0.5, set_mask: typing.SupportsInt = 1, delete_mask: typing.SupportsInt = 2, dead_man_mask: typing.SupportsInt = 0, clutch_mask: typing.SupportsInt = 4, pivot: typing.SupportsFloat = 0.0, budget: float | typing.Literal['auto'] | None = 'auto') -> None:
        ...
    def frame(self) -> OrientFrame:
        """
        Applies the presses since the last call to the keys, and returns what happened.

        Returns
        -------
        OrientFrame

        Raises
        ------
        RuntimeError
            If the session does not run.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=4, length=20)
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> path = riffler.plan.pencil(part, ball)[0]
        >>> pen = riffler.pen.Pointer("tablet")
        >>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
        >>> with session:
        ...     frame = session.frame()
        >>> frame.changes
        ()
        """
    def go_to(self, point: typing.SupportsInt) -> None:
        """
        Moves the tool to a point of the path, with the axis that it has; the hand does not feel a jump.

        Parameters
        ----------
        point : int
            From 0.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=4, length=20)
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> path = riffler.plan.pencil(part, ball)[0]
        >>> pen = riffler.pen.Pointer("tablet")
        >>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
        >>> session.go_to(1)
        """
    def reset(self) -> None:
        """
        Clears a trip that does not clear itself: ``OrientFrame.cause`` gives its reason.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=4, length=20)
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> path = riffler.plan.pencil(part, ball)[0]
        >>> pen = riffler.pen.Pointer("tablet")
        >>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
        >>> session.reset()
        """
    def set_keys(self, keys: collections.abc.Mapping[int, numpy.typing.ArrayLike]) -> None:
        """
        Replaces all keys, also while the session runs.

        Parameters
        ----------
        keys : mapping of int to array_like, shape (3,)
            Point index to axis, as in ``PencilPath.orient``; empty: none.

        Raises
        ------
        ValueError
            Naming the point; nothing is changed then.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=4, length=20)
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> path = riffler.plan.pencil(part, ball)[0]
        >>> pen = riffler.pen.Pointer("tablet")
        >>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
        >>> session.set_keys({0: (0, 0.6, 0.8)})
        >>> session.path.axes[1]
        array([0. , 0.6, 0.8])
        """
    def set_slide(self, slide: bool) -> None:
        """
        Lets the tool follow the hand along the path, or rest at its place.

        Parameters
        ----------
        slide : bool

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=4, length=20)
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> path = riffler.plan.pencil(part, ball)[0]
        >>> pen = riffler.pen.Pointer("tablet")
        >>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
        >>> session.set_slide(False)
        """
    def set_workspace(self, *, scale: typing.SupportsFloat = 1.0, turn: numpy.typing.ArrayLike | None = None, clutch_mask: typing.SupportsInt = 4, pivot: typing.SupportsFloat = 0.0) -> None:
        """
        Changes scale, view or clutch from the next step on. The tool does not jump.

        Parameters
        ----------
        scale : float
            mm of the tool per mm of the hand.
        turn : array_like, shape (3, 3), optional
            Rotation from the hand's frame to the tool's; None: none.
        clutch_mask : int
            Buttons, as bits: move the hand without the tool.
        pivot : float
            mm above the tip, on the tool's axis: the point that the grip leads, about which the hand turns the tool and feels its
            torque. 0: the tip. Without effect for devices in the part's frame.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=4, length=20)
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> path = riffler.plan.pencil(part, ball)[0]
        >>> pen = riffler.pen.Pointer("tablet")
        >>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
        >>> session.set_workspace(scale=0.5)
        """
    def start(self) -> None:
        """
        Starts, in the pen's own thread. Call it once.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=4, length=20)
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> path = riffler.plan.pencil(part, ball)[0]
        >>> pen = riffler.pen.Pointer("tablet")
        >>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
        >>> session.start()
        >>> frame = session.stop()
        """
    def stop(self) -> OrientFrame:
        """
        Ends the force.

        Returns
        -------
        OrientFrame
            The steps since the last frame.

        Examples
        --------
        >>> ball = riffler.Tool.ball(diameter=4, length=20)
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> path = riffler.plan.pencil(part, ball)[0]
        >>> pen = riffler.pen.Pointer("tablet")
        >>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
        >>> session.start()
        >>> session.stop().changes
        ()
        """
    @property
    def keys(self) -> dict[int, numpy.typing.NDArray[numpy.float64]]:
        """
        Point index to axis (3,): the keys after the last frame.
        """
    @property
    def path(self) -> PencilPath:
        """
        PencilPath with axes between the keys; without keys, as given.
        """
    @property
    def pen(self) -> PenDevice:
        """
        The device.
        """
    @property
    def priority(self) -> riffler.pen_results.ThreadPriority:
        """
        How the system runs the thread of the steps: ThreadPriority.
        """
    @property
    def running(self) -> bool:
        """
        Whether the session was started and not stopped.
        """
def _open_pen(what: str, *, geometry: str = 'woodenhaptics', bubble: typing.SupportsFloat = 0.08, exponent: typing.SupportsFloat = 2.0, speed: typing.SupportsFloat = 60.0, turn_rate: typing.SupportsFloat = 1.5, hold_orientation: bool = False, signs: typing.Annotated[collections.abc.Sequence[typing.SupportsInt], "FixedSize(6)"] = [1, 1, 1, 1, 1, 1], gravity: typing.SupportsFloat | None = None, friction: typing.SupportsFloat | None = None, seed: typing.SupportsInt | None = None, real_time: bool = True) -> PenDevice:
    ...
def _pen_devices() -> list[riffler.pen_results.DeviceInfo]:
    ...
def _pen_families() -> dict[str, str]:
    ...
def _pen_real_time() -> riffler.pen_results.ThreadPriority:
    ...
def _pen_text(name: str) -> str:
    ...
def _pen_unavailable() -> dict[str, str]:
    ...
def _pens() -> dict[str, str]:
    ...
def _play_pen(strokes: collections.abc.Sequence[tuple[typing.Annotated[numpy.typing.ArrayLike, numpy.float64], collections.abc.Sequence[typing.SupportsFloat]]], speed: typing.SupportsFloat) -> PenDevice:
    ...
def clear_drafts(path: os.PathLike | str | bytes) -> None:
    """
    Removes drafts of ``path`` that no process has locked: processes that were killed left them.
    """
def clear_passes(part: Mesh, fixtures: collections.abc.Sequence[Mesh], stock: Volume, tool: Tool, *, axis: numpy.typing.ArrayLike, clearance: typing.SupportsFloat, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], kinds: collections.abc.Sequence[typing.SupportsInt], feeds: collections.abc.Sequence[typing.SupportsFloat], tolerance: typing.SupportsFloat, progress: collections.abc.Callable[[float], bool | None] | None) -> riffler.plan.operations.PlannedMoves:
    """
    For riffler.plan.upright.
    """
def contact_locations(tool: Tool, contacts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], normals: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], axes: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], feeds: numpy.typing.ArrayLike | None) -> numpy.typing.NDArray[numpy.float64]:
    ...
def cut_along(part: Mesh, fixtures: collections.abc.Sequence[Mesh], stock: Volume, tool: Tool, *, axis: numpy.typing.ArrayLike, clearance: typing.SupportsFloat, lines: collections.abc.Iterable[numpy.typing.ArrayLike], distance: typing.SupportsFloat, fixture_distance: typing.SupportsFloat | None, tolerance: typing.SupportsFloat, max_lift: typing.SupportsFloat, feed: typing.SupportsFloat, plunge: typing.SupportsFloat, progress: collections.abc.Callable[[float], bool | None] | None) -> riffler.plan.operations.PlannedMoves:
    """
    For riffler.plan.along_poses.
    """
@typing.overload
def cutter_locations(path: PencilPath, tool: Tool, collider: Collider, *, clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, max_lift: typing.SupportsFloat, max_inserted: typing.SupportsInt, progress: collections.abc.Callable[[float], bool | None] | None) -> tuple[numpy.typing.NDArray[numpy.float64], riffler.plan.locations.LocationReport]:
    ...
@typing.overload
def cutter_locations(path: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], tool: Tool, collider: Collider, *, clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, max_lift: typing.SupportsFloat, max_inserted: typing.SupportsInt, progress: collections.abc.Callable[[float], bool | None] | None) -> tuple[numpy.typing.NDArray[numpy.float64], riffler.plan.locations.LocationReport]:
    ...
def draft_prefix(path: os.PathLike | str | bytes) -> pathlib.Path:
    """
    Path with which the names of drafts of ``path`` begin.
    """
def drop(tool: Tool, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], part: Mesh, axis: numpy.typing.ArrayLike, progress: collections.abc.Callable[[float], bool | None] | None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    ...
def engrave(part: Mesh, curves: collections.abc.Iterable[numpy.typing.ArrayLike], tool: Tool, *, depth: typing.SupportsFloat, inclination: typing.SupportsFloat, tilt: typing.SupportsFloat, tolerance: typing.SupportsFloat, turn: typing.SupportsFloat, crease: typing.SupportsFloat, reach: typing.SupportsFloat, progress: collections.abc.Callable[[float], bool | None] | None) -> list:
    """
    For riffler.plan.engrave.
    """
def falloff(name: str, t: typing.SupportsFloat) -> float:
    """
    The falloff of a brush: 1 at its centre, 0 at its radius and beyond.

    Parameters
    ----------
    name : str
        As in ``Volume.brush``.
    t : float
        Distance from the centre as a fraction of the radius.

    Examples
    --------
    >>> riffler.falloff("smooth", 0.5), riffler.falloff("linear", 0.25)
    (0.5, 0.75)
    """
def finish(part: Mesh, fixtures: collections.abc.Sequence[Mesh], stock: Volume, tool: Tool, *, axis: numpy.typing.ArrayLike, clearance: typing.SupportsFloat, pattern: str, cusp: typing.SupportsFloat, tolerance: typing.SupportsFloat, allowance: typing.SupportsFloat, angle: typing.SupportsFloat, min_slope: typing.SupportsFloat, max_slope: typing.SupportsFloat, region: collections.abc.Iterable[numpy.typing.ArrayLike], faces: collections.abc.Sequence[typing.SupportsInt], centre: numpy.typing.ArrayLike | None, climb: bool, feed: typing.SupportsFloat, plunge: typing.SupportsFloat, lead: typing.SupportsFloat | None, rule: str | None, ahead: typing.SupportsFloat, aside: typing.SupportsFloat, target: numpy.typing.ArrayLike, max_tilt: typing.SupportsFloat, max_turn: typing.SupportsFloat, exact: Collider | None, deviation: typing.SupportsFloat, progress: collections.abc.Callable[[float], bool | None] | None) -> riffler.plan.operations.PlannedMoves:
    """
    For riffler.plan.finish.
    """
def finish_patterns() -> list[str]:
    """
    For riffler.plan.finish.
    """
def lift(tool: Tool, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], collider: Collider, *, clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, max_lift: typing.SupportsFloat, max_evaluations: typing.SupportsInt, progress: collections.abc.Callable[[float], bool | None] | None) -> riffler.plan.locations.LiftReport:
    ...
def machine_options(machine: str, *, options: collections.abc.Mapping[str, float | bool | str | collections.abc.Sequence[float]] | None = None) -> list[riffler.program_results.MachineOption]:
    """
    The options that a machine takes, its own first, and those of the code that is written for it.

    Parameters
    ----------
    machine : str
        A name of ``machines``, or the path of a .toml file.
    options : dict, optional
        Given options, which may make others required.

    Returns
    -------
    list of MachineOption

    Raises
    ------
    ValueError
        For an unknown machine, and for wrong options.

    Examples
    --------
    >>> [option.name for option in riffler.machine_options("linuxcnc-xyzac") if option.own]
    ['offset', 'rot_point', 'tool_offset']
    """
def machine_texts(machine: str) -> riffler.program_results.MachineTexts:
    """
    The texts of a machine's file, and the language of its control.

    Parameters
    ----------
    machine : str
        A name of ``machines``, or the path of a .toml file.

    Returns
    -------
    MachineTexts

    Raises
    ------
    ValueError
        For an unknown machine, and a file that cannot be read.

    Examples
    --------
    >>> riffler.machine_texts("heidenhain").extension
    '.h'
    """
def machines() -> dict[str, str]:
    """
    The machines that riffler can write and read programs for, shipped ones and your own.

    A post has its machine's name. Instead of a machine's name you can pass the path of a .toml file that describes one.

    Returns
    -------
    dict
        Name to description.

    Examples
    --------
    >>> "linuxcnc-xyzac" in riffler.machines()
    True
    """
def min_tilt(path: PencilPath, tool: Tool, collider: Collider, *, inclinations: collections.abc.Sequence[typing.SupportsFloat], tilts: collections.abc.Sequence[typing.SupportsFloat], clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, limit: tuple[numpy.typing.ArrayLike, float] | None, max_change: typing.SupportsFloat, smoothness: typing.SupportsFloat, progress: collections.abc.Callable[[float], bool | None] | None) -> tuple[numpy.typing.NDArray[numpy.float64], riffler.plan.orientations.TiltReport]:
    ...
def orientation_maps(path: PencilPath, points: collections.abc.Sequence[typing.SupportsInt], tool: Tool, collider: Collider, *, inclinations: collections.abc.Sequence[typing.SupportsFloat], tilts: collections.abc.Sequence[typing.SupportsFloat], clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, limit: tuple[numpy.typing.ArrayLike, float] | None, progress: collections.abc.Callable[[float], bool | None] | None) -> list[riffler.plan.orientations.MapValues]:
    ...
def outline(part: Mesh, fixtures: collections.abc.Sequence[Mesh], stock: Volume, tool: Tool, *, axis: numpy.typing.ArrayLike, clearance: typing.SupportsFloat, curves: collections.abc.Iterable[numpy.typing.ArrayLike], inside: bool, depth: typing.SupportsFloat, stepdown: typing.SupportsFloat, tabs: typing.SupportsInt, tab_height: typing.SupportsFloat, tab_width: typing.SupportsFloat, allowance: typing.SupportsFloat, tolerance: typing.SupportsFloat, slope: typing.SupportsFloat, climb: bool, feed: typing.SupportsFloat, plunge: typing.SupportsFloat, lead: typing.SupportsFloat | None, progress: collections.abc.Callable[[float], bool | None] | None) -> riffler.plan.operations.PlannedMoves:
    """
    For riffler.plan.outline.
    """
def pencil(part: Mesh, tool: Tool, *, tolerance: typing.SupportsFloat, bitangency_angle: typing.SupportsFloat | None, minimum_length: typing.SupportsFloat, passes: typing.SupportsInt, stepover: typing.SupportsFloat | None, overthickness: typing.SupportsFloat, progress: collections.abc.Callable[[float], bool | None] | None) -> riffler.plan.strategies.pencil.PencilPaths:
    """
    For riffler.plan.pencil.
    """
def read_file(path: os.PathLike | str | bytes) -> bytes:
    """
    The file's bytes. FormatError if there is no file, and for a folder, a pipe or a device.
    """
def replace_file(draft: os.PathLike | str | bytes, path: os.PathLike | str | bytes) -> None:
    """
    Replaces ``path`` with ``draft``, on the same file system, like AtomicFileWriter.
    """
def replaceable(path: os.PathLike | str | bytes) -> pathlib.Path:
    """
    Target of a path after following links. RuntimeError if it is not a regular file.
    """
def require_revolved(tool: Tool, who: str) -> None:
    """
    ValueError for a hand tool, which ``who`` cannot use.
    """
def rough(part: Mesh, fixtures: collections.abc.Sequence[Mesh], stock: Volume, tool: Tool, *, axis: numpy.typing.ArrayLike, clearance: typing.SupportsFloat, stepdown: typing.SupportsFloat, engagement: typing.SupportsFloat, allowance: typing.SupportsFloat, tolerance: typing.SupportsFloat, slope: typing.SupportsFloat, climb: bool, feed: typing.SupportsFloat, plunge: typing.SupportsFloat, depth: typing.SupportsFloat, progress: collections.abc.Callable[[float], bool | None] | None) -> riffler.plan.operations.PlannedMoves:
    """
    For riffler.plan.rough.
    """
def set_threads(n: typing.SupportsInt | None) -> None:
    """
    Sets the number of threads of parallel calls in the whole process. Running calls keep theirs.

    Results are the same bytes for any number.

    Parameters
    ----------
    n : int from 1 to 256, or None
        None: as set by RIFFLER_THREADS, or by the CPU affinity.

    Raises
    ------
    ValueError
        Another number.

    Examples
    --------
    >>> riffler.set_threads(1)
    >>> riffler.threads()
    1
    >>> riffler.set_threads(None)
    """
def stepover_of_scallop(radius: typing.SupportsFloat, height: typing.SupportsFloat) -> float:
    ...
def swarf(path: PencilPath, part: Mesh, tool: Tool, *, side: typing.SupportsInt, height: typing.SupportsFloat | None, tolerance: typing.SupportsFloat, progress: collections.abc.Callable[[float], bool | None] | None) -> riffler.plan.strategies.swarf.Swarf:
    """
    For riffler.plan.swarf.
    """
def then(found: _Found, convert: collections.abc.Callable[[_Found], _Made]) -> _Made:
    """
    convert(found); of a Task, that it will be done by its result().
    """
def threads() -> int:
    """
    Number of threads of a parallel call.

    The number given to `set_threads`, else RIFFLER_THREADS if set, else the number of processors that the process may use.

    Returns
    -------
    int
        1 to 256.

    Examples
    --------
    >>> 1 <= riffler.threads() <= 256
    True
    """
def tip_ball_radius(tool: Tool, name: str) -> float:
    """
    Radius (mm) of the ball at the tip of ``tool``; ValueError naming the argument ``name`` if the tip is not a ball.
    """
def verify(program: Program | collections.abc.Iterable[Program], stock_volume: Volume, part_mesh: Mesh | None = None, fixtures: collections.abc.Iterable[Volume | Mesh] | None = (), *, tools: collections.abc.Mapping[int, Tool] | None = None, tolerance: typing.SupportsFloat = 0.01, gouge_tolerance: typing.SupportsFloat = 0.05, rest_tolerance: typing.SupportsFloat | None = None, rapid_feed: typing.SupportsFloat = 10000.0, machine: str | None = None, machine_options: collections.abc.Mapping[str, float | bool | str | collections.abc.Sequence[float]] | None = None, machine_frame: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[float], bool | None] | None = None) -> VerifyReport:
    """
    Runs a program on a stock and reports faults. The stock is not changed.

    Rapids remove material too, as a crash would. Shank and holder must stay clear of the remaining stock when they come
    there, the whole tool of the fixtures. If the description of a tool ends below material or a fixture above
    or next to it, collisions of the spindle are unknown: a finding "unknown".

    Parameters
    ----------
    program : Program, or an iterable of Programs
        Each of several begins with the row at which the one before ended; only 16 bytes a row of them are kept.
    stock_volume : Volume
        Not changed.
    part_mesh : Mesh, optional
        For gouges and rest material.
    fixtures : list of Volume or Mesh
        Volumes or meshes that the whole tool must stay clear of; a Mesh becomes a Volume at the stock's pitch.
    tools : dict, optional
        Number to Tool; takes the place of the program's own.
    tolerance : float
        mm, of cutting, as in ``Volume.carve``; shallower contact does not count.
    gouge_tolerance : float
        mm under the part's surface from which removed material is a gouge.
    rest_tolerance : float, optional
        mm over the part's surface from which material is a finding; None: rest material is mapped, not judged.
    rapid_feed : float
        mm/min, for the time.
    machine : str, optional
        A name of ``machines`` on which the program is to run: the first row that its axes or their limits cannot hold is a
        finding "machine".
    machine_options : dict, optional
        Options of the machine; those of reading are ignored.
    machine_frame : array_like, shape (4, 4), optional
        Transform from the coordinates of stock and program to those of the program on the machine, if they differ.
    progress : callable, optional
        Called with the finished share, from 0 for each chunk; returning False cancels.

    Returns
    -------
    VerifyReport

    Raises
    ------
    ValueError
        Naming number, row and line of a tool of unknown shape.

    Examples
    --------
    >>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
    >>> ball = riffler.Tool.ball(diameter=6, length=30)
    >>> cut = [(5, 10, 8, 0, 0, 1), (15, 10, 8, 0, 0, 1)]
    >>> program = riffler.Program.from_cl([cut], [ball], feed=600, spindle=9000)
    >>> riffler.verify(program, stock).findings
    []
    """
__compiler__: str
__version__: str
