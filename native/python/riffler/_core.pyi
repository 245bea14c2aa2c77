# Made by `make stubs` from the built module; not to be edited.
from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import os
import pathlib
import typing
__all__: list[str] = ['AtomicFileWriter', 'Cancelled', 'Collider', 'Contact', 'Cut', 'Finding', 'FormatError', 'FrozenSurface', 'Journal', 'JournalStroke', 'JournalWriter', 'Material', 'Mesh', 'Mesher', 'Note', 'PenDevice', 'PenError', 'PenGeometry', 'PenState', 'PencilPath', 'Pointer', 'Program', 'ProgramStream', 'Session', 'SessionFrame', 'SimulatedPen', 'SlabWorker', 'Snapshot', 'Softened', 'Task', 'Tool', 'ToolShape', 'ToolSize', 'Verification', 'VerifyPlan', 'VerifyReport', 'Volume', 'clear_drafts', 'contact_locations', 'cutter_locations', 'draft_prefix', 'drop', 'engrave', 'least_tilt', 'lift', 'machine_options', 'machines', 'orientation_maps', 'pencil', 'read_file', 'replace_file', 'replaceable', 'set_threads', 'stepover_of_scallop', 'swarf', 'then', 'threads', 'tip_ball_radius', 'verify']
class FormatError(ValueError):
    """
    A file that is not what it should be: names the file, the line or byte, and what was expected.
    """
class Cancelled(RuntimeError):
    """
    A long call that its progress callback stopped; the object is as it was before.
    """
class Task:
    """
    A long call on a native thread, which runs no Python: made by the functions of riffler.tasks.

    What the call was given is taken when it is made, volumes by a snapshot; what is done with them afterwards changes
    nothing. A Task that nobody holds any more is cancelled and waited for; so are all when Python ends.
    """
    def __repr__(self) -> str:
        ...
    def cancel(self) -> None:
        """
        Asks the call to end with Cancelled, and does not wait; without effect where it has ended.
        """
    def result(self) -> typing.Any:
        """
        What the call returns, the same object each time; waits for it, other threads go on. Raises what the call raises, Cancelled after ``cancel``. Ctrl-C ends the waiting, not the call.
        """
    @property
    def done(self) -> bool:
        """
        Whether ``result`` is there at once: the call has ended, by itself, by an error or cancelled.
        """
    @property
    def share(self) -> float:
        """
        The finished share, in [0, 1]: never goes back, and 1 only where the call came to its end.
        """
class AtomicFileWriter:
    """
    A file that takes the place of ``path`` at ``commit``.

    Links are followed; permissions and owner of a file that is there are kept; RuntimeError for what is no regular file.
    """
    def __init__(self, path: os.PathLike | str | bytes) -> None:
        ...
    def commit(self) -> None:
        """
        Once.
        """
    def fileno(self) -> int:
        """
        Of the draft, which is written to; -1 after ``commit``.
        """
class Mesh:
    """
    A triangle mesh, mm. It never changes: what changes a mesh returns a new one.

    Mesh(vertices, triangles): (n, 3) numbers and (k, 3) integers, indices of vertices, counter-clockwise seen from outside.
    ValueError naming the argument and the row for a wrong shape, a vertex that is not finite or beyond 1e30, an index out of
    range. Vertices are not welded; files are, when they are read.
    """
    @staticmethod
    def read(path: os.PathLike | str | bytes, *, progress: typing.Any = None) -> Mesh:
        """
        The mesh in a .stl (binary or ASCII), .obj, .ply or .3mf file; equal vertices become one. A .3mf file gives
        all that it says to build, placed, in mm whatever its unit; it needs the package lib3mf. FormatError naming the byte or
        line for a bad file (for .3mf what was expected), among them those with no triangle; ValueError for another extension.
        ``progress`` is called with a share of the part of the file at hand, of .stl and .3mf not after the beginning.
        """
    def __copy__(self) -> Mesh:
        ...
    def __deepcopy__(self, memo: dict) -> Mesh:
        ...
    def __getstate__(self) -> tuple:
        ...
    def __init__(self, vertices: typing.Any, triangles: typing.Any) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    def audit(self, *, progress: typing.Any = None) -> dict:
        """
        A dict of counts, all 0 but the last two for a closed two-manifold without defects:
        open_edges (of one triangle), nonmanifold_edges (of three or more, or of two in the same direction),
        nonmanifold_vertices (whose triangles are not one fan), degenerate (a vertex twice, or area exactly 0),
        duplicates (the vertices of an earlier triangle), folds (edges whose two triangles lie on each other),
        components (pieces connected across edges), volume (mm³, signed).
        """
    def decimate(self, triangles: typing.SupportsInt | None = None, tolerance: typing.SupportsFloat | None = None, *, progress: typing.Any = None) -> Mesh:
        """
        A mesh with fewer triangles: down to `triangles`, or as far as old and new surface stay within `tolerance` (mm) of
        each other, or until the first of both. Closed and two-manifold where this one is; sharp edges and borders stay. The
        vertices are some of the old ones, or where that fits better new ones between them.
        """
    def deviation(self, other: Mesh, *, signed: bool = False, progress: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) float64: how far (mm) each vertex is from the surface of `other`; with signed=True negative inside.
        """
    def oriented(self, report: dict | None = None, *, hollow: bool = False) -> Mesh:
        """
        This mesh as the surface of a solid: the mesh itself, or one in which triangles are turned.

        What takes a mesh as a solid (Volume.from_mesh, Collider, verify, plan.pencil, plan.engrave, deviation with signs) does
        this by itself. In closed pieces orientation is carried over edges that two triangles share, the larger area decides, and
        they then face outwards, but for cavities: pieces within another that are oriented the other way round. Open pieces, and
        pieces with one side only, stay as they are. ``hollow``: leave closed pieces that all face inwards, as
        plans and Collider do: room in endless material.

        ``report``: a dict that is filled with ``turned`` triangles; ``turned_shells``, closed pieces that faced inwards as a
        whole; ``left_out``, repeated triangles that tear the surface open, which name one vertex three times in the result;
        ``one_sided``, pieces like a Möbius strip.
        """
    def smooth(self, iterations: typing.SupportsInt = 10, tolerance: typing.SupportsFloat | None = None, *, feature_angle: typing.SupportsFloat = 0.7, progress: typing.Any = None) -> Mesh:
        """
        A smoother mesh of the same triangles (Taubin) and the same volume; no vertex moves farther than `tolerance`
        (mm) in all. Edges whose sides turn by more than `feature_angle` (rad) stay sharp, and corners stay where they are, as
        do vertices on borders.
        """
    def write(self, path: os.PathLike | str | bytes, progress: typing.Any = None) -> None:
        """
        Writes .stl (binary, coordinates rounded to float32), .obj, .ply (binary) or .3mf (mm, float32 to its last step; needs the package
        lib3mf, which tells no progress), whole or not at all.
        """
    @property
    def area(self) -> float:
        """
        mm².
        """
    @property
    def bounds(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (2, 3) float64, lower and upper corner of the triangles' box. ValueError without triangles.
        """
    @property
    def triangles(self) -> numpy.ndarray:
        """
        (k, 3) int32, read-only, no copy.
        """
    @property
    def vertices(self) -> numpy.ndarray:
        """
        (n, 3) float64, read-only, no copy.
        """
    @property
    def volume(self) -> float:
        """
        mm³, signed; of a closed mesh.
        """
class ToolSize:
    """
    One size of a cutter shape. It means the same in every shape that has it.
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
    A named cutter shape, one row of Tool.shapes().
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
class Tool:
    """
    A cutter with the shank and holder above it; immutable.

    Heights are measured from the tip towards the spindle, lengths in mm, angles in rad. ``length`` includes the
    rounded or conical end. Sizes that are not positive or do not fit raise ValueError naming the size.
    """
    @staticmethod
    def ball(diameter: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        Ball end mill.

        - ``diameter``: diameter of the cylinder above the end, in mm
        - ``length``: cutting length from the tip, in mm
        """
    @staticmethod
    def cone_end(tip_half_angle: typing.SupportsFloat, tip_height: typing.SupportsFloat, half_angle: typing.SupportsFloat, diameter: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        Sharp tip, a first cone, a second cone, then a cylinder.

        - ``tip_half_angle``: angle between the axis and the first cone, in rad
        - ``tip_height``: height of the first cone, in mm
        - ``half_angle``: angle between the axis and the flank, in rad
        - ``diameter``: diameter of the cylinder above the end, in mm
        - ``length``: cutting length from the tip, in mm
        """
    @staticmethod
    def fillet(diameter: typing.SupportsFloat, corner_radius: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        Flat end mill with a rounded edge.

        - ``diameter``: diameter of the cylinder above the end, in mm
        - ``corner_radius``: radius of the rounded edge, in mm
        - ``length``: cutting length from the tip, in mm
        """
    @staticmethod
    def flat(diameter: typing.SupportsFloat, length: typing.SupportsFloat) -> Tool:
        """
        Flat end mill.

        - ``diameter``: diameter of the cylinder above the end, in mm
        - ``length``: cutting length from the tip, in mm
        """
    @staticmethod
    def from_dict(d: dict) -> Tool:
        """
        The tool of a tool library's entry; see to_dict.
        """
    @staticmethod
    def profile(segments: typing.Any, length: typing.SupportsFloat) -> Tool:
        """
        Free profile from the tip (0, 0) upwards: rows (radius, height) are lines, rows (radius, height,
        centre_radius, centre_height) arcs, the shorter way round; a cylinder follows up to ``length``.
        """
    @staticmethod
    def shapes() -> list[ToolShape]:
        """
        The named cutter shapes with their sizes, for forms: those that have a function here but ``profile``.
        """
    @staticmethod
    def taper(tip_radius: typing.SupportsFloat, half_angle: typing.SupportsFloat, diameter: typing.SupportsFloat, length: typing.SupportsFloat, flat_tip: bool = False) -> Tool:
        """
        Cone above a ball tip or a flat one, then a cylinder.

        - ``tip_radius``: radius of the ball or flat at the tip, in mm
        - ``half_angle``: angle between the axis and the flank, in rad
        - ``diameter``: diameter of the cylinder above the end, in mm
        - ``length``: cutting length from the tip, in mm
        - ``flat_tip``: a flat instead of a ball at the tip
        """
    def __eq__(self, arg0: Tool) -> bool:
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
        """
    def outline(self, tolerance: typing.SupportsFloat = 0.01) -> list:
        """
        The outline of cutter, shank and holder together, from the tip upwards, for drawing.

        A list of (part, points): ``"cutter"``, ``"shank"`` or ``"holder"``, and a polyline (n, 2) of radius and height, mm, that
        stays within ``tolerance`` of it. What lies inside of another piece is left out.
        """
    def to_dict(self) -> dict:
        """
        The JSON / TOML form: kind, its sizes, name, shank and holder.
        """
    def with_holder(self, pieces: typing.Any) -> Tool:
        """
        The same tool with a holder of truncated cones (z0, r0, z1, r1).
        """
    def with_margins(self, shank: typing.SupportsFloat = 0.0, holder: typing.SupportsFloat = 0.0) -> Tool:
        """
        The same tool with wider shank and holder, mm: to be planned and checked with, so that these keep clear of the
        part by as much while the cutter touches it. The ends of the holder move as well, those of the shank do not.
        """
    def with_shank(self, pieces: typing.Any) -> Tool:
        """
        The same tool with a shank of truncated cones (z0, r0, z1, r1).
        """
    @property
    def diameter(self) -> float:
        """
        Largest diameter of the cutter, mm.
        """
    @property
    def holder(self) -> list:
        ...
    @property
    def kind(self) -> str:
        ...
    @property
    def length(self) -> float:
        """
        From the tip to the end of the cutter, mm.
        """
    @property
    def name(self) -> str:
        ...
    @property
    def shank(self) -> list:
        ...
class Cut:
    """
    What each move of a carve took away; arrays with one row per move.
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
    The state of a volume at one time; shares its tiles until they are written.
    """
    @property
    def nbytes(self) -> int:
        ...
    @property
    def revision(self) -> int:
        ...
    @property
    def volume(self) -> float:
        ...
class Volume:
    """
    A dexel volume: material as spans along parallel rays.

    ``directions`` is "z" for one grid of rays or "xyz" for three (a tri-dexel volume, which also keeps the surface's
    normals and so its sharp edges). Ray (i, j) of "z" stands at lower + ((i + .5) h, (j + .5) h); "x" rays are indexed
    (y, z), "y" rays (z, x). Lengths in mm.
    """
    @staticmethod
    def block(lower: typing.Any, upper: typing.Any, pitch: typing.SupportsFloat, directions: str = 'z') -> Volume:
        """
        A box full of material. ValueError, before anything is allocated, if it does not fit in memory.
        """
    @staticmethod
    def cylinder(centre: typing.Any, radius: typing.SupportsFloat, height: typing.SupportsFloat, pitch: typing.SupportsFloat, directions: str = 'z', axis: typing.Any = (0, 0, 1), lower: typing.Any = None, upper: typing.Any = None, progress: typing.Any = None) -> Volume:
        """
        A cylinder of material along ``axis``, of any length but 0; ``centre`` is the middle of it. mm.

        Made of exact rays as ``sphere``: the caps are planes, and meet the side at a sharp edge in volumes of three directions.
        Box and errors as there.
        """
    @staticmethod
    def empty(lower: typing.Any, upper: typing.Any, pitch: typing.SupportsFloat, directions: str = 'z') -> Volume:
        """
        The box without material: what is put on (``carve``, ``add``) is all that it has. mm.
        """
    @staticmethod
    def from_bytes(data: collections.abc.Buffer, name: str = 'volume') -> Volume:
        """
        The volume whose to_bytes() these are; ``name`` stands in messages.
        """
    @staticmethod
    def from_mesh(mesh: Mesh, pitch: typing.SupportsFloat, directions: str = 'z', lower: typing.Any = None, upper: typing.Any = None, progress: typing.Any = None, report: dict | None = None) -> Volume:
        """
        The points whose absolute generalized winding number in ``mesh`` exceeds 1/2.

        Covers the mesh's box, or ``lower`` to ``upper`` (clipping what lies outside). Inside-out, overlapping, touching and open
        parts are fine, as are triangles that face the other way than their neighbours and repeated ones (Mesh.oriented); a mesh
        without volume is a ValueError.

        ``report``: a dict that is filled with what was wrong with the mesh, all 0 but ``triangles`` for one that is closed and
        well oriented: ``degenerate`` and ``duplicates``, triangles; ``open_edges`` of one triangle, ``nonmanifold_edges`` of
        three or more, ``inconsistent_edges`` of two that run it in the same direction; ``turned`` triangles, turned to agree with
        their neighbours, ``left_out``, repeated ones that tear the surface open, ``one_sided`` pieces, like a Möbius strip;
        ``openings``, walks along which the surface ends; ``flipped_shells`` that face into the material; of the volume, the shares ``inside_out``, where the
        winding number is negative, and ``overlap``, where it is 2 or more; ``doubtful_rays``, the share of the rays with
        material that end within an opening instead of on the surface; and with ``lost``, ``lost_box``, ``lost_pitch`` and
        ``lost_note`` as by to_mesh(): what rays miss, or a mesh of the volume will lack. Without a report the note is a
        UserWarning.
        """
    @staticmethod
    def load(path: os.PathLike | str | bytes, progress: typing.Any = None) -> Volume:
        """
        Reads a .rvol file; FormatError where it is damaged or not one.
        """
    @staticmethod
    def sphere(centre: typing.Any, radius: typing.SupportsFloat, pitch: typing.SupportsFloat, directions: str = 'z', lower: typing.Any = None, upper: typing.Any = None, progress: typing.Any = None) -> Volume:
        """
        A ball of material around ``centre``, mm, made of exact rays: it has no facets.

        Each end of a span is where its ray crosses the sphere, to the rounding of doubles, and has the sphere's normal. Covers
        the ball's box, or ``lower`` to ``upper``, clipping what lies outside. ValueError where all rays of a direction miss a
        ball that lies in the box: the message has a pitch at which they do not.
        """
    def __copy__(self) -> Volume:
        ...
    def __deepcopy__(self, arg0: dict) -> Volume:
        ...
    def __getstate__(self) -> bytes:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: bytes) -> None:
        ...
    def add(self, other: Volume, progress: typing.Any = None) -> Volume:
        """
        Adds the other volume's material, in place; see subtract.
        """
    def carve(self, tool: Tool, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], tolerance: typing.SupportsFloat = 0.01, dt: typing.Any = None, removal_constant: typing.SupportsFloat = 0.05, progress: typing.Any = None, mode: str = 'remove', protect: Volume = None) -> Cut:
        """
        Takes away what the cutter sweeps along ``poses`` (n, 6): tip xyz, unit axis xyz; n - 1 moves.

        ``tolerance``: mm, for moves that turn the axis; others are exact. ``dt``: s, a number or (n - 1,), asks for force.
        ``removal_constant``: N·s/mm³. Shank and holder never cut. ``progress``: called with the finished share; returning
        False cancels, raises Cancelled and leaves the volume as it was.

        ``mode``: "remove", or "add", which puts material on wherever the cutter sweeps within the volume's box; ``removed`` is
        then what was put on. ``protect``: a volume of the same lower, upper, pitch and directions; what lies in it stays as it
        is, material and air. ValueError if its grid is another.
        """
    def clip(self, point: typing.Any, normal: typing.Any, progress: typing.Any = None) -> Volume:
        """
        Takes away what lies in front of the plane through ``point`` (mm) with ``normal``, of any length, in place: the new face looks out along it. Returns this volume.
        """
    def contains(self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.bool]:
        """
        (n,) bool for ``points`` (n, 3) mm: in the material, by the nearest ray of each direction; of three, two decide.
        """
    def copy(self) -> Volume:
        """
        An independent volume; shares its tiles until one of the two is written.
        """
    def grown(self, lower: typing.Any = None, upper: typing.Any = None, progress: typing.Any = None) -> Volume:
        """
        This volume in a larger box: a new volume with the same spans and normals, bit for bit.

        Rays stay where they stand, and others, without material, are put beside them: each side of the box moves outward by
        whole pitches until it lies at or beyond that of ``lower`` to ``upper`` (mm; default: its own), to 1e-6 of a pitch. A
        side that does already stays. Where a box's size is no whole number of pitches, an upper side may move one pitch more;
        ``volume`` then counts the rays that were last with whole cells. ValueError, before anything is allocated, if the box
        does not fit in memory.
        """
    def intersect(self, other: Volume, progress: typing.Any = None) -> Volume:
        """
        Keeps what both volumes have, in place; see subtract.
        """
    def intervals(self, direction: str) -> tuple:
        """
        (counts (nu, nv) uint32, spans (counts.sum(), 2) [near, far]), rays in C order.
        """
    def normals(self, direction: str) -> numpy.typing.NDArray[numpy.float64]:
        """
        (spans, 2, 3): unit normals at the ends of the spans of ``intervals``; tri-dexel volumes only.
        """
    def parts(self, least: typing.SupportsFloat = 0.0, progress: typing.Any = None) -> list:
        """
        A list of volumes on this one's grid, one for each piece that hangs together, the largest first.

        Spans of neighbouring rays hang together where they overlap. Pieces smaller than ``least`` mm³ stay with the largest.
        The parts' volumes sum to this one's. ValueError for more than 1000 pieces.
        """
    def resampled(self, pitch: typing.SupportsFloat, directions: str | None = None, lower: typing.Any = None, upper: typing.Any = None, progress: typing.Any = None) -> Volume:
        """
        This volume at another pitch, with other directions or in another box (default: its own): a new volume.

        Material outside of the new box is left out. What is resampled is the mesh of ``to_mesh``, so a finer pitch brings no
        detail back. A volume with the same pitch, directions and box is a copy, bit for bit.
        """
    def restore(self, snapshot: Snapshot) -> None:
        """
        Back to a snapshot of this volume.
        """
    def save(self, path: os.PathLike | str | bytes, progress: typing.Any = None) -> None:
        """
        Writes a .rvol file, whole or not at all. Equal volumes are equal files.
        """
    def snapshot(self) -> Snapshot:
        """
        The state to come back to with restore(); costs pointers only.
        """
    def soften(self, centres: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], radius: typing.SupportsFloat, strength: typing.SupportsFloat = 0.5, protect: Volume = None, progress: typing.Any = None) -> Softened:
        """
        Smooths the surface by dabs of a round brush at ``centres`` (n, 3) or (3,), one after the other.

        ``radius``: mm, of the brush; what lies beyond it stays as it is. ``strength``: 0 to 1, the share of the way to the
        smoothed surface at the brush's centre, less towards its rim. A dab levels what is finer than about four pitches and
        moves nothing by more than one pitch; repeat it for more. Planes stay as they are, edges become round, convex places
        lose material and concave ones get some, within the volume's box only.

        Tri-dexel volumes ("xyz") only, whose ends have normals; ValueError for others. ``protect``: a volume of the same lower,
        upper, pitch and directions; what lies in it stays as it is, material and air. ``progress``: called with the finished
        share; returning False cancels, raises Cancelled and leaves the volume as it was.
        """
    def stats(self) -> dict:
        """
        Operation counters since the last call of stats().
        """
    def subtract(self, other: Volume, progress: typing.Any = None) -> Volume:
        """
        Takes the other volume's material away, in place; returns this volume. ValueError unless both have the same lower, upper, pitch and directions.
        """
    def to_bytes(self, progress: typing.Any = None) -> bytes:
        """
        The bytes of the .rvol file.
        """
    def to_mesh(self, progress: typing.Any = None, report: dict | None = None) -> Mesh:
        """
        The surface: closed, outward, two-manifold, and still so in a binary STL.

        ``report``: a dict that is filled with what is no part of it, since it is thinner than the pitch: ``lost`` (mm³),
        ``lost_box``, where, as two corners, or None; ``lost_pitch`` (mm) that keeps it, or None; ``lost_note``, a sentence where
        there is more than crumbs, otherwise empty. Without a report that sentence is a UserWarning.
        """
    @property
    def directions(self) -> str:
        ...
    @property
    def lower(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def nbytes(self) -> int:
        """
        Bytes held, shared tiles counted once.
        """
    @property
    def pitch(self) -> float:
        ...
    @property
    def rays(self) -> int:
        """
        Number of rays, all directions.
        """
    @property
    def revision(self) -> int:
        """
        Changes with the content.
        """
    @property
    def upper(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def volume(self) -> float:
        """
        mm³: lengths of the z rays × their areas (of the only rays, where there are no z rays). An area is h², but for the last rays, whose cells end with the box.
        """
class Softened:
    """
    What each dab of a smooth brush did; arrays with one number per dab.
    """
    def __len__(self) -> int:
        ...
    @property
    def added(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm³ put on.
        """
    @property
    def removed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm³ taken away.
        """
class FrozenSurface:
    """
    The surface of a ``Mesher`` as it was when ``freeze()`` was called, to be picked, whatever becomes of the mesher.
    """
    def pick(self, origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
        """
        The first point of the surface along a ray: ``(distance, point, normal, brick)``, or None.

        ``direction`` may have any length but 0; ``distance`` is in mm. ``normal`` is that of the triangle that was hit, a unit
        vector out of the material: it points along the ray where the ray comes from inside. No ray falls through between
        triangles, and one that touches an edge hits it. With (n, 3) arrays, one ray a row, arrays of n rows: where nothing is
        hit ``distance`` is inf, ``brick`` -1, the rest NaN. ValueError naming the argument and row for what is not finite, or
        zero.
        """
    def stats(self) -> dict:
        """
        What picking took since the last call of stats(): rays, bricks_visited, triangles_tested.
        """
    @property
    def nbytes(self) -> int:
        """
        Bytes of its triangles, of which it shares those of bricks that did not change with the mesher.
        """
    @property
    def triangles(self) -> int:
        ...
class Mesher:
    """
    The mesh of a volume that goes on changing, in bricks of 32 × 32 × 32 cells.

    ``Mesher(volume)`` meshes all of it; ``update(volume)`` meshes again only where it was changed. What a mesher holds is
    always, bit for bit, what ``volume.to_mesh()`` gives. It keeps a snapshot of the volume, which shares its tiles.
    """
    def __init__(self, volume: Volume, progress: typing.Any = None) -> None:
        """
        ``progress``: called with the finished share; returning False cancels and raises Cancelled.
        """
    def freeze(self) -> FrozenSurface:
        """
        The surface as it is now, to be picked while the mesher goes on: a ``FrozenSurface``.

        A stroke that follows the surface on which it began does not climb into its own groove. What did not change since the
        last call is shared; the first call looks at all triangles.
        """
    def mesh(self) -> Mesh:
        """
        The whole mesh, the same as ``to_mesh()`` of the volume.
        """
    def patch(self, bricks: typing.SupportsInt | collections.abc.Sequence[typing.SupportsInt], edges: bool = False, normals: typing.SupportsFloat | None = None) -> tuple:
        """
        (vertices (n, 3) float32, triangles (k, 3) int32) of a brick, empty where nothing is left.

        The brick's own vertices come first, then those of its neighbours that its triangles touch; what two patches share has
        the same coordinates in both, bit for bit. A sequence of bricks gives one patch of them all, without seams between them.

        ``edges=True`` adds edges (e, 2) int32, each once, and of each triangle's corners the edge to the next one, (k, 3)
        int32: Blender's ``.edge_verts`` and ``.corner_edge``. IndexError for a brick that there is not, ValueError for one
        that is there twice.

        ``normals``, an angle in rad, adds normals (3 k, 3) float32 of the triangles' corners on the whole mesh: the mean of the
        triangles around the vertex, in whatever brick, whose normals are within that angle of the corner's own.
        """
    def patches(self) -> list:
        """
        Numbers of the bricks that have triangles, ascending.
        """
    def pick(self, origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
        """
        The first point of the surface along a ray: ``(distance, point, normal, brick)``, or None.

        ``direction`` may have any length but 0; ``distance`` is in mm. ``normal`` is that of the triangle that was hit, a unit
        vector out of the material: it points along the ray where the ray comes from inside. No ray falls through between
        triangles, and one that touches an edge hits it. With (n, 3) arrays, one ray a row, arrays of n rows: where nothing is
        hit ``distance`` is inf, ``brick`` -1, the rest NaN. ValueError naming the argument and row for what is not finite, or
        zero.
        """
    def stats(self) -> dict:
        """
        What picking and freezing took since the last call of stats(): rays, bricks_visited, bricks_prepared (those that had changed), triangles_tested.
        """
    def update(self, volume: Volume) -> list:
        """
        Follows a change of the volume and returns the numbers of the bricks whose patches changed, ascending. ValueError for a volume with another box, pitch or directions.
        """
    @property
    def shape(self) -> tuple:
        """
        Bricks along each axis, with triangles or without: brick n stands at ``numpy.unravel_index(n, shape)``.
        """
    @property
    def triangles(self) -> int:
        ...
class Contact:
    """
    What a tool meets at a pose: forces act on the tool, in the part's frame.
    """
    def __repr__(self) -> str:
        ...
    @property
    def checked(self) -> float:
        """
        Share of the candidate triangles that was looked at; 1 without a budget.
        """
    @property
    def depth(self) -> float:
        """
        mm; 0 where nothing is touched.
        """
    @property
    def force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        N, (3,): out of what is touched.
        """
    @property
    def missed_depth_bound(self) -> float:
        """
        mm: the true depth is at most depth + missed_depth_bound.
        """
    @property
    def parts(self) -> list:
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
    A part and its fixtures, against which tools are held; immutable.

    ``part`` is a Mesh, ``fixtures`` are Volumes, each of its own pitch; empty ones are ignored. ``spacing`` (mm) is
    that of the points on the part that forces are summed over, by default √(area / 100 000). The stiffnesses
    are N per mm of depth and mm² of surface against the cutter and against shank and holder, and N per mm³ of a
    fixture in the tool: one number or Material, or a list of one for each fixture. A pose is 6 numbers: tip, unit axis from the tip to the spindle. Calls may come from
    several threads and release the GIL.
    """
    @staticmethod
    def made(part: Mesh, *, fixtures: collections.abc.Sequence[Volume] = [], spacing: typing.SupportsFloat | None = None, stiffness: typing.SupportsFloat = 1.0, holder_stiffness: typing.SupportsFloat = 10.0, fixture_stiffness: typing.Any = 10.0, progress: typing.Any = None) -> Collider:
        """
        The same as a function, for ``riffler.tasks.collider``. ``progress`` is asked at the beginning
        and at the end only.
        """
    def __init__(self, part: Mesh, *, fixtures: collections.abc.Sequence[Volume] = [], spacing: typing.SupportsFloat | None = None, stiffness: typing.SupportsFloat = 1.0, holder_stiffness: typing.SupportsFloat = 10.0, fixture_stiffness: typing.Any = 10.0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def clearance(self, tool: Tool, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm for poses (n, 6): the least signed distance between the part's surface and the union of cutter, shank
        and holder, negative where they overlap. Fixtures do not count. On all threads.
        """
    def nearest(self, tool: Tool, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        (distance, point, part) for one pose, over part and fixtures: mm, (3,) mm on part or fixture, and what of the
        tool it is next to, or "fixture".
        """
    def query(self, tool: Tool, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], budget_us: typing.SupportsFloat | None = None) -> Contact:
        """
        Force, torque, depth and where they are, as a Contact. After ``budget_us`` microseconds what is left is
        only bounded: see ``checked`` and ``missed_depth_bound``.
        """
    @property
    def spacing(self) -> float:
        """
        Of the points on the part, mm.
        """
class Note:
    """
    What a reader of NC code assumed or passed over.
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
        ...
class ProgramStream:
    """
    What Program.stream gives: an iterator of programs.
    """
    def __iter__(self) -> typing.Any:
        ...
    def __next__(self) -> Program:
        ...
class Program:
    """
    Where the tool goes, how fast and with which tool; immutable.

    One row per move end. Between two rows the tip moves on a line and the axis on the great circle at constant rate, by way
    of the poses in ``via`` where there are any.
    ``tools`` is a dict of the tools whose shape is known, by number; ``provenance`` a dict of strings that the header
    comment of the NC code repeats. Lengths in mm, feed in mm/min at the tip, spindle in rev/min.
    """
    @staticmethod
    def from_bytes(data: bytes) -> Program:
        """
        A program from the bytes of a .rprog file.
        """
    @staticmethod
    def from_cl(cl: collections.abc.Iterable, tools: typing.Any, feed: typing.Any, spindle: typing.Any = 0.0, *, safe_height: typing.SupportsFloat | None = None, clearance: typing.SupportsFloat = 10.0, occupied: typing.Any = None, provenance: typing.Any = None, collider: Collider = None, retract: typing.SupportsFloat | None = None, direction: typing.Any = None, lead_in: typing.SupportsFloat | None = None, contact_tolerance: typing.SupportsFloat = 0.02) -> Program:
        """
        From cutter locations: every (n, 6) array is one cut.

        Its rows become feed moves in order, none merged. Before it a rapid at safe height to above its first point, along the
        tool's axis, and the feed in; after it a rapid out along the axis. ``tools``: one for all arrays or one for each
        (None: tool 1 of unknown shape). ``feed`` (mm/min at the tip) and ``spindle`` (rev/min, negative counter-clockwise): one
        for all, or a list of one for each array; a feed may be an array of one per row.
        ``safe_height``: z (mm) above everything, the clearance plane; by default ``clearance`` (mm) above all tips and
        ``occupied``, a pair of corners around stock, part and fixtures.

        With a ``collider``, its part and fixtures are occupied too, and approaches, retracts and the moves between cuts are
        resolved with cutter, shank and holder: along the tool's axis where that is clear, otherwise by another way, the axis
        kept; such a way is fed, since it may cross stock. ``retract``: mm of the first stretch out of a cut; ``direction``: a
        unit vector, which way that goes. Not given, what is clear is looked for. ``lead_in``: mm before a cut that are fed, what
        is above it being air; not given, all of it is fed. ``contact_tolerance``: mm that a tool may enter part and fixtures by,
        as cuts touch the part. ValueError names the path, the row, the place and the remedy where nothing is clear.
        """
    @staticmethod
    def joined(programs: collections.abc.Sequence[Program]) -> Program:
        """
        One after the other. ValueError where one number stands for tools of two shapes.
        """
    @staticmethod
    def load(path: os.PathLike | str | bytes, progress: typing.Any = None) -> Program:
        """
        Reads a .rprog file; FormatError naming the byte where it is damaged or not one.
        """
    @staticmethod
    def read(path: os.PathLike | str | bytes, machine: str = 'tcp', options: typing.Any = None, *, progress: typing.Any = None) -> Program:
        """
        Reads NC code for ``machine``, a name of machines(), as its control has it: RS-274, APT, Heidenhain's Klartext or Sinumerik.

        Options: those of the machine; ``chord_tolerance`` (mm, default 0.002) for curves; ``axis_tolerance`` (rad): where it is
        given, blocks whose rotary axes leave the great circle by more become several rows, otherwise a block is one row, and the
        poses on its way are in ``via``;
        ``block_delete`` (default True: lines that begin with / are passed over); ``unknown``: "error" or "skip" (what was skipped
        is listed in ``notes`` and ``provenance``); ``cutter_compensation``: "error", "ignore" (points are those of the tool's
        centre) or "offset" (points are the contour's, and the tool's centre goes beside it); ``tool_diameters`` for that, in mm: one
        number, or a dict by the number of the offset D or of the tool; ``units``: "mm" or "inch", before the program says which; ``arc_tolerance`` (mm, default 0.005) by which an arc's
        end may miss its circle; ``g54`` … ``g59``, ``g59_1`` … ``g59_3``, ``g28``, ``g30``: where on the machine work offsets and homes
        lie, three to six numbers; ``subroutines``: a folder of files name.ngc; ``parameters``: a file of LinuxCNC's parameters;
        ``max_turns`` of loops and calls (default 1e6). Poses are in the coordinates in which the first move is
        programmed. FormatError names file, line and block; nothing that is not understood is skipped unasked.
        """
    @staticmethod
    def stream(path: os.PathLike | str | bytes, machine: str = 'tcp', options: typing.Any = None, rows: typing.SupportsFloat = 65536) -> ProgramStream:
        """
        Reads as ``read`` does, in memory that does not grow with the file: an iterator of programs of at most ``rows``
        rows. Each after the first begins with the row at which the one before ended.
        """
    def __getstate__(self) -> bytes:
        ...
    def __init__(self, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], feed: typing.Any, rapid: typing.Any = False, tool: typing.Any = 1, line: typing.Any = 0, spindle: typing.Any = 0.0, tools: typing.Any = None, provenance: typing.Any = None, notes: collections.abc.Sequence[Note] = [], at_machine: typing.Any = False, via: typing.Any = None) -> None:
        """
        From columns: poses (n, 6), everything else one value for all rows or (n,).

        ValueError names the row: not finite, not a unit axis, a feed of 0 where the tip moves, ``at_machine`` with another pose
        than the row before.
        """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: bytes) -> None:
        ...
    def cuts(self) -> list:
        """
        For replay: a list of (tool number, poses (k, 6)), one per run of rows in the part with one tool, rapids and the poses of ``via`` included.
        """
    def followed(self) -> Program:
        """
        With the poses of ``via`` as rows of their own: between its rows the tool moves as the machine moves it.
        """
    def retimed(self, factor: typing.SupportsFloat) -> Program:
        """
        Feeds times ``factor``; rapids as they are.
        """
    def retooled(self, numbers: collections.abc.Mapping[typing.SupportsInt, typing.SupportsInt]) -> Program:
        """
        Tool numbers by a dict old: new; those that are not in it stay. ValueError where two shapes would share one.
        """
    def save(self, path: os.PathLike | str | bytes, progress: typing.Any = None) -> None:
        """
        Writes a .rprog file, whole or not at all: everything to the bit, which NC code cannot keep.

        The same program gives the same bytes.
        """
    def to_bytes(self) -> bytes:
        """
        The bytes of the .rprog file.
        """
    def transformed(self, matrix: typing.Any) -> Program:
        """
        In another clamping: ``matrix`` (4, 4) turns and moves (mm) the part, without scale or mirror.
        """
    def trimmed(self, first: typing.SupportsInt, last: typing.SupportsInt) -> Program:
        """
        Rows [first, last) as a program. The first of them is a rapid; an approach is yours to put before it.
        """
    def write(self, path: os.PathLike | str | bytes, post: str = 'tcp', tolerance: typing.SupportsFloat = 0.01, axis_tolerance: typing.SupportsFloat = 0.00175, options: typing.Any = None, *, collider: Collider = None, stock: Volume = None, contact_tolerance: typing.SupportsFloat = 0.05) -> dict:
        """
        Writes NC code; ``post`` is a name of machines(). The file is whole or not there.

        Every row is the end of a block; more blocks come between two rows where machine axes that move linearly would take the
        tip more than ``tolerance`` (mm) off the straight line or the axis more than ``axis_tolerance`` (rad) off the great
        circle. The same program gives the same bytes.

        Options are the machine's (``rot_point``, ``offset``, ``tool_offset`` of LinuxCNC's tables, named as its pins;
        ``pivot_length`` of heads), and of all: ``tcp`` (False: X Y Z are where the axes stand; True: the tip in part
        coordinates), ``direction`` (``"linuxcnc"`` or ``"iso"``, of tables), ``limits_x`` … ``limits_c`` [low, high], ``rate_x`` …
        ``rate_c``, ``max_rotary`` (deg/min), ``line_numbers``, ``coolant``, ``retract``, ``safe_height``, ``arcs``, ``vectors``: docs/machines.md. Where a
        rotary axis moves beside linear ones that are written as they stand, blocks are under G93, each with F = 1 / minutes: the
        tip's way at the feed, or longer where an axis's rate asks for it.

        With a ``collider`` the machine's own motion is checked, block by block as its axes make it, with cutter, shank and
        holder against part and fixtures; with a ``stock`` (a Volume) it is run on that, as a verification does. What enters them
        by more than ``contact_tolerance`` (mm), a rapid in the stock, or shank or holder in it, is a ValueError with the row, the
        place and the remedy, and nothing is written.

        Returns a dict: ``blocks``; ``slowed_blocks``, longer than their feed asks; ``rewinds``, the rows at which the tool leaves
        the material because a limit asks to turn an axis back; ``pole_passages``, near the singular direction: a list of dicts of
        ``first_row``, ``last_row``, ``tool_degrees``, ``rotary_degrees`` and ``slowed`` (the worst block's time by what its feed
        would take).
        """
    @property
    def at_machine(self) -> numpy.ndarray:
        """
        (n,) bool: rows that end at a position of the machine (G28, G30, G53) whose place in the part is not known. Their pose is that of the row before; the motions there and from there are neither cut nor compared.
        """
    @property
    def feed(self) -> numpy.ndarray:
        """
        (n,) mm/min at the tip; 0 for rapids.
        """
    @property
    def line(self) -> numpy.ndarray:
        """
        (n,) int32 source lines from 1; 0: no source.
        """
    @property
    def notes(self) -> list[Note]:
        """
        What the reader assumed or passed over: a list of Note. Programs that are made of numbers have none.
        """
    @property
    def poses(self) -> numpy.ndarray:
        """
        (n, 6): tip xyz, unit axis xyz (tip to spindle). Read-only view.
        """
    @property
    def provenance(self) -> dict:
        """
        dict of strings.
        """
    @property
    def rapid(self) -> numpy.ndarray:
        """
        (n,) bool.
        """
    @property
    def spindle(self) -> numpy.ndarray:
        """
        (n,) rev/min; negative counter-clockwise, 0 stopped.
        """
    @property
    def tool(self) -> numpy.ndarray:
        """
        (n,) int32 tool numbers; 0: none.
        """
    @property
    def tools(self) -> dict:
        """
        dict: number to Tool, of the tools whose shape is known.
        """
    @property
    def via(self) -> dict:
        """
        dict: row to (k, 6) poses on the way there, where rotary axes that turn evenly take the tool another way than the great circle: by more than 0.002 rad, in programs that were read without ``axis_tolerance``.
        """
class Finding:
    """
    One fault: neighbouring rows of a program with the same kind, tool and fixture.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def fixture(self) -> int | None:
        """
        Which of the fixtures it was, from 0, or None.
        """
    @property
    def kind(self) -> str:
        """
        "rapid", "holder", "shank", "fixture", "gouge", "rest", "spindle" (a feed move into material with a spindle
        that stands), "machine" (the machine cannot hold the row) or "unknown" (it could not be checked).
        """
    @property
    def last_line(self) -> int:
        ...
    @property
    def last_row(self) -> int:
        ...
    @property
    def line(self) -> int:
        """
        Source line of the first row from 1; 0: no source.
        """
    @property
    def member(self) -> str:
        """
        What of the tool it was: cutter, shank, holder, or beyond where its description ends.
        """
    @property
    def message(self) -> str:
        """
        One sentence: what happened and what to do.
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
        ...
    @property
    def value(self) -> float:
        """
        How much, in ``unit``. rapid, spindle: mm³ that all rows took. holder, shank, fixture, unknown: mm³ in
        the way of the worst row (where a slab of the stock has been hit 256 times, only one further hit in sixteen is measured).
        gouge, rest: mm under or over the part's surface.
        """
class VerifyReport:
    """
    What a verification found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        """
        For JSON: passed, findings, not_checked, rows, time, volume, removed (mm³ in sum), stats.
        """
    @property
    def deviation(self) -> typing.Any:
        """
        (mesh of what is left, (vertices,) mm) or None without a part; made when first asked for.

        Distance of each vertex from the part's surface: positive where rest material stands on it, negative in gouges.
        """
    @property
    def findings(self) -> list[Finding]:
        """
        list of Finding, by rows.
        """
    @property
    def not_checked(self) -> list[str]:
        """
        list of sentences: what was not asked for, so does not fail.
        """
    @property
    def part_map(self) -> typing.Any:
        """
        (vertices of the part,) mm, or None without a part; made when first asked for.

        Distance of each vertex of the part from the surface of what is left: positive where material covers it, negative where
        it is missing, -inf where nothing is left at all.
        """
    @property
    def passed(self) -> bool:
        """
        True only where every check that was asked for could be made and found nothing.
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
        (n,) s: the tip's way at its feed, rapids at ``rapid_feed``; where the tip stands still, the axis' angle at
        3600 deg/min. Acceleration and tool changes are left out.
        """
    @property
    def stats(self) -> dict:
        """
        dict of operation counts: ``moves``, (move, slab) pairs cut; ``slabs`` simulated; ``slabs_kept``, whose results
        of the run before were taken; ``snapshots_used``; ``probes``, batches tried with shank and holder or on a fixture, and
        ``probed_moves`` in them; ``bisections`` of such batches; ``skipped``, (move, slab) pairs told apart by boxes alone.
        """
    @property
    def time(self) -> float:
        """
        s, all rows.
        """
    @property
    def volume(self) -> Volume:
        """
        The Volume that is left.
        """
class Verification:
    """
    Verifies a program again and again while it is edited.

    Arguments are those of ``verify``. ``run`` of a program that is like the one before does again only what differs: rows
    before the first difference come from snapshots, and parts of the stock that no differing move can touch stay as they
    are. The report is that of a fresh run, bit for bit.
    """
    def __init__(self, stock_volume: Volume, part_mesh: typing.Any = None, fixtures: typing.Any = (), *, tools: typing.Any = None, tolerance: typing.SupportsFloat = 0.01, gouge_tolerance: typing.SupportsFloat = 0.05, rest_tolerance: typing.SupportsFloat | None = None, rapid_feed: typing.SupportsFloat = 10000.0, machine: str | None = None, machine_options: typing.Any = None, machine_frame: typing.Any = None, progress: typing.Any = None) -> None:
        ...
    def run(self, program: Program, progress: typing.Any = None) -> VerifyReport:
        """
        The VerifyReport of a Program. After an error or Cancelled this is as it was before the call.
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
    def __init__(self, stock_volume: Volume, part_mesh: typing.Any = None, fixtures: typing.Any = (), *, tools: typing.Any = None, tolerance: typing.SupportsFloat = 0.01, gouge_tolerance: typing.SupportsFloat = 0.05, rest_tolerance: typing.SupportsFloat | None = None, rapid_feed: typing.SupportsFloat = 10000.0, machine: str | None = None, machine_options: typing.Any = None, machine_frame: typing.Any = None, progress: typing.Any = None) -> None:
        ...
    def accept(self, slab: typing.SupportsInt, result: bytes, last: bool) -> None:
        """
        A result of SlabWorker.run; ``last``: the slab has no more moves. FormatError for damaged bytes.
        """
    def add(self, program: Program, progress: typing.Any = None) -> list:
        """
        List of (slab, number of moves, bytes) of the chunk: what can touch each slab.
        """
    def context(self) -> bytes:
        """
        What SlabWorker is made of, after the last chunk.
        """
    def finish(self, progress: typing.Any = None) -> VerifyReport:
        """
        The VerifyReport, once all slabs are there.
        """
    def task(self, slab: typing.SupportsInt) -> bytes:
        """
        The slab as it stands.
        """
class PenGeometry:
    """
    A pen: its lengths, gears, encoders, motors and limits, and how it moves.

    Two arms, R and L, hold the two ends of a grip. Counts are the six counters in the device's own order (``channels``);
    joints are θ1 θ2 θ3 of R, then of L, in rad. Poses are the grip's pivot and the unit axis along it, away from the tool's
    tip. Arrays have one row per moment.
    """
    @staticmethod
    def load(name: str) -> PenGeometry:
        """
        A pen of ``riffler.pen.names()``, or one that a ``.toml`` file describes. FormatError names the file's line; ValueError the pens there are.
        """
    def capability(self) -> dict:
        """
        What each coordinate senses and pushes: a dict with ``text`` and ``axes``, x y z a b c.
        """
    def converter_steps(self, torques: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        As motor_currents, in the steps of the pen's digital to analogue converter.
        """
    def counts(self, joints: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.int32]:
        """
        (n, 6) int32: the nearest counts of (n, 6) joint angles.
        """
    def diagnose(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> dict:
        """
        Which counter is wrong, from (n, 6) counts of different postures.

        A dict: ``fault`` is "none", "channel" (then ``channel``, the ``counts`` that it reads too many, and ``left``, the mm that
        stay unexplained), "several" (bad homing, or another pen) or "unclear" (move the pen: twelve postures that differ by
        0.02 rad are needed).
        """
    def efforts(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wrenches: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], at: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        Joint torques for a force and a torque on the hand.

        ``wrenches``: (n, 6), about the points ``at`` (n, 3), both in the frame of poses. Returns (n, 6) joint torques in N·mm and
        the (n, 3) torque that cannot be felt.
        """
    def ends(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 2, 3) mm: ends of R and of L in the arms' frame, (2.1) and (2.2).
        """
    def forward(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) poses of (n, 6) counts: (2.3) and (2.4).
        """
    def homed(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], probe: typing.SupportsInt = 0) -> PenGeometry:
        """
        The same pen, homed by its readings instead of presets.

        ``counts``: (1, 6), what the counters read in the home posture, and ``probe`` what the seventh does. Counters may wrap.
        """
    def inverse(self, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        Joint angles of poses.

        Returns (n, 6) joints and a list of pairs, of R and of L: "reached", "too far", "too near", "on axis" (of θ1, or folded),
        "limits" (the angles are beyond the joints' or the elbow's) or "not finite".
        """
    def jacobian(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 2, 3, 3) mm/rad: of R and of L, the derivative of the end's x y z by its θ1 θ2 θ3 (2.7), (2.8).
        """
    def joints(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) joint angles of (n, 6) counts: (2.9).
        """
    def motor_currents(self, torques: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        What the motors are told for (n, 6) joint torques, N·mm.

        Returns (n, 6) int16, mA in the device's order, and (n,) the factor that all six of a row were scaled by so that none
        passes its peak.
        """
    def noticed_counts(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6): how many counts each channel may be off before it shows.

        Whichever way it is off, all other channels being right; infinite where none shows, and 0 in rows that do not fit.
        """
    def probe_angle(self, count: typing.SupportsInt) -> float:
        """
        rad: the grip's rotation about the pose's axis, turns added up, of the seventh counter.
        """
    def split(self, wrenches: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], apart: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        What the arms push with for a force and a torque on the hand.

        ``wrenches``: (n, 6), force in N and torque in N·mm about the grip's pivot; ``apart``: (n, 3), from R's end to L's.
        Returns (n, 2, 3) forces of R and of L, and (n, 3) the torque that cannot be felt: its part along the grip.
        """
    def stretch(self, counts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm: by which the grip comes out longer than it is.
        """
    @property
    def channels(self) -> list:
        """
        The six motors with their encoders, dicts in the device's order.
        """
    @property
    def description(self) -> str:
        """
        What its file says of it.
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
    def limits(self) -> dict:
        """
        Workspace, elbow, force, torque, speeds: a dict; mm, rad, s, N.
        """
    @property
    def name(self) -> str:
        """
        Its file's name.
        """
class PenError(RuntimeError):
    """
    A device that does not open: says exactly why, and what to do.
    """
class PenState:
    """
    Where the hand was, as of one report.
    """
    @property
    def age_s(self) -> float:
        """
        s since it was measured; inf before the first report.
        """
    @property
    def applied(self) -> tuple:
        """
        (force, torque), N and N·mm: what the hand felt of the motors, where the device says so; zero elsewhere.
        """
    @property
    def buttons(self) -> int:
        """
        Bit 0 is button 1.
        """
    @property
    def counts(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (6,) int32: the counters of a pen that has a geometry, in its order, as if homing had preset them.
        """
    @property
    def fault(self) -> int:
        """
        The device's own code, or 0.
        """
    @property
    def homed(self) -> bool:
        """
        Whether the pose is sure.
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
        Of the report; 0 before the first.
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
    A device that is open: a pen, a puck, a recording. Context manager.

    Reports are read, and forces written, in a thread of its own; a device that goes away is looked for until it is back.
    """
    def __enter__(self) -> typing.Any:
        ...
    def __exit__(self, *args) -> None:
        ...
    def health(self) -> dict:
        """
        dict: state, problem, force_state, cause, what was last pushed with, and counts since the start.
        """
    def home(self) -> bool:
        """
        The device stands in its home posture. False where nothing has to be homed.
        """
    def push(self, force: typing.Any, torque: typing.Any = (0, 0, 0)) -> dict:
        """
        Pushes for 20 ms with a force (N) and a
        torque (N·mm) about the grip's point. dict: force, torque that will be felt, missing_force, missing_torque, reason or
        None.
        """
    def reset(self) -> None:
        """
        Clears a trip that does not heal by itself: health()['cause'] says what it was.
        """
    def state(self) -> PenState:
        """
        PenState: the newest sample.
        """
    def stop(self) -> bool:
        """
        No force, and closed. False where the device could not be told in time.
        """
    @property
    def about(self) -> str:
        ...
    @property
    def geometry(self) -> typing.Any:
        """
        PenGeometry of a pen of two arms, with the currents that the device allows; None of everything else.
        """
    @property
    def kind(self) -> str:
        ...
    @property
    def limits(self) -> dict:
        """
        dict: "x", "y", "z" and turns "a", "b", "c", each a dict of senses
        ("position", "rate" or None), pushes, low, high, resolution (mm, rad, or a second of them), peak, continuous (N, N·mm).
        """
class SimulatedPen(PenDevice):
    """
    A pen without hardware: arms, motors, firmware and cable are simulated, and a hand moves it.
    """
    def aim(self, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], *, spin: typing.SupportsFloat = 0.0, grip: typing.SupportsFloat = 1.0, buttons: typing.SupportsInt = 0) -> None:
        """
        The hand goes to `pose`, (6,) point and axis, at up to 300 mm/s and 5 rad/s, as far as the arms reach;
        with `grip` below 1 it holds more loosely, with 0 not at all. `spin` in rad about the axis.
        """
    def lose(self, channel: typing.SupportsInt, counts: typing.SupportsInt) -> None:
        """
        A counter (0 to 5) loses so many counts in all, one by one: a fault to practise with.
        """
    def wander(self) -> None:
        """
        The hand goes round on its own curve again.
        """
class Pointer(PenDevice):
    """
    A tablet or a mouse as a device: whoever gets its events gives them here, and they become poses.

    `kind` is "tablet" (senses point and axis) or "mouse" (the point only; its axis stands upright on the plane).
    """
    def __init__(self, kind: str = 'tablet') -> None:
        ...
    def give(self, x: typing.SupportsFloat, y: typing.SupportsFloat, *, pressure: typing.SupportsFloat = 0.0, tilt_x: typing.SupportsFloat = 0.0, tilt_y: typing.SupportsFloat = 0.0, buttons: typing.SupportsInt = 0, time: typing.SupportsFloat) -> bool:
        """
        An event: right and up in units of the frame, pressure 0 to 1, tilts (rad) by which the pen's end leans to
        the right and up, buttons as bits, time in s of any clock. False, and it is left out, where a number is not finite or the
        time is before the last event's.
        """
    def set_frame(self, *, origin: typing.Any = (0, 0, 0), right: typing.Any = (1, 0, 0), up: typing.Any = (0, 1, 0), scale: typing.SupportsFloat = 1.0, depth: typing.SupportsFloat = 2.0, most_tilt: typing.SupportsFloat = 1.0) -> None:
        """
        Where the pointer's plane lies, from the next event on: `origin`, (3,) mm, of pointer (0, 0); `right` and
        `up`, (3,) unit vectors square to each other; `scale`, mm for a unit of the pointer; `depth`, mm into the plane at full
        pressure; `most_tilt`, rad from upright, below pi/2. ValueError naming what cannot be; the frame is as before then.
        """
class JournalStroke:
    """
    One stroke of a Journal.
    """
    def __len__(self) -> int:
        ...
    @property
    def forces(self) -> typing.Any:
        """
        (n, 6) N, N·mm about the grip: what the device was told to give the hand; or None.
        """
    @property
    def mode(self) -> str:
        """
        "remove", "add", "mask", "unmask", "soften", "beside" or "build".
        """
    @property
    def name(self) -> str:
        ...
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) copy.
        """
    @property
    def removed(self) -> typing.Any:
        """
        (n,) mm³ by the move that ends at the row, or None.
        """
    @property
    def strength(self) -> float:
        """
        0 to 1, of one that softens.
        """
    @property
    def times(self) -> typing.Any:
        """
        (n,) s, or None.
        """
    @property
    def tolerance(self) -> float:
        """
        mm
        """
    @property
    def tool(self) -> int:
        ...
class Journal:
    """
    What a session did: stock, tools, strokes as poses, notes.

    Replaying the strokes on the stock gives the session again. Files end in .rjournal.
    """
    @staticmethod
    def read(path: os.PathLike | str | bytes, *, progress: typing.Any = None) -> Journal:
        """
        Reads a file. One that a crash has cut gives all whole records, and ``cut_at`` says where it was cut; a
        damaged record that others follow is a FormatError naming the byte.
        """
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def add_note(self, key: str, value: str) -> None:
        """
        Provenance.
        """
    def add_stroke(self, tool: typing.SupportsInt, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], times: typing.Any = None, tolerance: typing.SupportsFloat = 0.01, name: str = '', *, forces: typing.Any = None, removed: typing.Any = None, mode: str = 'remove', strength: typing.SupportsFloat = 0.5) -> None:
        """
        A stroke with a tool that was added: poses (n, 6), n ≥ 1; each of the others may be None. times (n,) s that
        never fall; forces (n, 6) N, N·mm that the device was told to give the hand, about the grip; removed (n,) mm³ by the move that
        ends at the row. mode says what the tool does where it sweeps: "remove" and "add" material, but not where it is protected;
        "mask" and "unmask": protect it, or no longer; "soften": a dab of ``strength`` at each row's tip, as wide as the tool;
        "beside": remove as a Session does beside what is protected; "build": put on as a Session does. To replay to the bit what
        was put on, or cut beside a mask, by ``carve``, each carve has to be a stroke.
        """
    def add_tool(self, number: typing.SupportsInt, tool: typing.Any) -> None:
        """
        A Tool, its dict or JSON text. The same number again is allowed for the same tool only.
        """
    def bring_back(self, n: typing.SupportsInt = 1) -> None:
        """
        The last n that were taken back count again: redo. A new stroke ends that.
        """
    def extend_stroke(self, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], times: typing.Any = None, *, forces: typing.Any = None, removed: typing.Any = None) -> None:
        """
        More rows for the last stroke, with the same columns.
        """
    def program(self, feed: typing.SupportsFloat | None = None, spindle: typing.SupportsFloat = 0.0, *, safe_height: typing.SupportsFloat | None = None, clearance: typing.SupportsFloat = 10.0) -> Program:
        """
        The strokes as a Program, each one cut as in Program.from_cl. ``feed`` in mm/min; None: from the times,
        held within 1 to 100 000 mm/min. The stock counts as occupied. Strokes that do not remove are left out: no machine can make
        them.
        """
    def replay(self, folder: os.PathLike | str | bytes | None = None, progress: typing.Any = None, *, with_mask: bool = False) -> typing.Any:
        """
        The Volume that the strokes leave of the stock, to the bit as the session left it: a block, or the snapshot
        in ``folder``. A row that stands where the row before stood is no move; a stroke that never moves cuts where it stands
        if it has two rows or more. ``with_mask``: a tuple of it and the Volume of what is protected, or None.
        """
    def set_stock(self, lower: typing.Any, upper: typing.Any, pitch: typing.SupportsFloat, directions: str = 'z', snapshot: str = '', *, mask: str = '') -> None:
        """
        The frame of the stock, the file name of its snapshot where it is not a full block, and that of what is protected where something is. Once.
        """
    def take_back(self, n: typing.SupportsInt = 1) -> None:
        """
        The last n strokes no longer count: undo.
        """
    def write(self, path: os.PathLike | str | bytes) -> None:
        """
        Writes the whole journal; the file is whole or not there.
        """
    @property
    def cut_at(self) -> int | None:
        """
        Byte at which the file had been cut, or None.
        """
    @property
    def notes(self) -> dict:
        """
        dict of strings; of a key given twice the later value.
        """
    @property
    def stock(self) -> typing.Any:
        """
        dict: lower, upper, pitch, directions, snapshot, mask; or None.
        """
    @property
    def strokes(self) -> list:
        """
        list of JournalStroke: those that count.
        """
    @property
    def tools(self) -> dict:
        """
        dict: number to the tool's dict.
        """
class JournalWriter:
    """
    Appends to a journal file, record by record.

    Goes on with a file that is there, after cutting off a damaged tail, or begins a new one. Each record is handed to the
    system before the call returns. ``keep=False`` holds no strokes in memory, so that ``journal`` cannot be asked for: for
    long sessions. Context manager.
    """
    def __enter__(self) -> typing.Any:
        ...
    def __exit__(self, *args) -> None:
        ...
    def __init__(self, path: os.PathLike | str | bytes, *, keep: bool = True) -> None:
        ...
    def add_note(self, key: str, value: str) -> None:
        """
        Provenance.
        """
    def add_stroke(self, tool: typing.SupportsInt, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], times: typing.Any = None, tolerance: typing.SupportsFloat = 0.01, name: str = '', *, forces: typing.Any = None, removed: typing.Any = None, mode: str = 'remove', strength: typing.SupportsFloat = 0.5) -> None:
        """
        A stroke with a tool that was added: poses (n, 6), n ≥ 1; each of the others may be None. times (n,) s that
        never fall; forces (n, 6) N, N·mm that the device was told to give the hand, about the grip; removed (n,) mm³ by the move that
        ends at the row. mode says what the tool does where it sweeps: "remove" and "add" material, but not where it is protected;
        "mask" and "unmask": protect it, or no longer; "soften": a dab of ``strength`` at each row's tip, as wide as the tool;
        "beside": remove as a Session does beside what is protected; "build": put on as a Session does. To replay to the bit what
        was put on, or cut beside a mask, by ``carve``, each carve has to be a stroke.
        """
    def add_tool(self, number: typing.SupportsInt, tool: typing.Any) -> None:
        """
        A Tool, its dict or JSON text. The same number again is allowed for the same tool only.
        """
    def bring_back(self, n: typing.SupportsInt = 1) -> None:
        """
        The last n that were taken back count again: redo. A new stroke ends that.
        """
    def close(self) -> None:
        """
        Ends writing; calls after it raise RuntimeError.
        """
    def extend_stroke(self, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], times: typing.Any = None, *, forces: typing.Any = None, removed: typing.Any = None) -> None:
        """
        More rows for the last stroke, with the same columns.
        """
    def set_stock(self, lower: typing.Any, upper: typing.Any, pitch: typing.SupportsFloat, directions: str = 'z', snapshot: str = '', *, mask: str = '') -> None:
        """
        The frame of the stock, the file name of its snapshot where it is not a full block, and that of what is protected where something is. Once.
        """
    def sync(self) -> None:
        """
        Waits until the disk has it.
        """
    def take_back(self, n: typing.SupportsInt = 1) -> None:
        """
        The last n strokes no longer count: undo.
        """
    @property
    def journal(self) -> Journal:
        """
        A copy of everything in the file.
        """
class Material:
    """
    What a stock or a fixture is made of, as far as a hand can feel it.
    """
    def __init__(self, *, stiffness: typing.SupportsFloat = 1.0, removal_constant: typing.SupportsFloat = 0.05, damping: typing.SupportsFloat = 0.0, density: typing.SupportsFloat = 1.0) -> None:
        ...
    def mass(self, volume: typing.SupportsFloat) -> float:
        """
        g of so many mm³.
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
    What happened between two calls of ``Session.frame``: one row for each step.

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
        Why the force was taken away and what to do, or None.
        """
    @property
    def cutting(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) 1 in strokes, otherwise 0.
        """
    @property
    def depth(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) mm that the tool is at most in what it must not enter.
        """
    @property
    def dropped_ticks(self) -> int:
        """
        Steps since the start that are in no frame, because frames were too rare: 4096 are kept.
        """
    @property
    def dt(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) s from step to step.
        """
    @property
    def energy(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) N·mm that may go to the hand: the account of passivity.
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
    def in_stroke(self) -> bool:
        ...
    @property
    def missed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) 1 where no step could be made and the force was held over.
        """
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) of the tool, at each step's end.
        """
    @property
    def problem(self) -> str | None:
        """
        Why nothing is cut though the hand wants to, or None.
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
    @property
    def untold(self) -> int:
        """
        Steps since the start that are in no frame, because frames were too rare: 4096 are kept.
        """
class Session:
    """
    A pen, a tool and a stock: the tool follows the hand and cuts a thousand times a second, and the hand feels it.

    The device's own thread cuts. ``volume`` is what is shown: each call of ``frame`` brings it up to date, between steps, and
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
        Part and fixtures that the tool stays out of.
    protect : Volume, optional
        Region that must not change, with the lower, upper, pitch and directions of ``volume``; air to the tool.
    mode : {"remove", "add"}
        "add": the cutter adds what it sweeps, over its whole length and within the volume's box. The hand then feels neither
        that nor the stock, only obstacles.
    material : Material, optional
        What the stock is made of.
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
    def replay(path: os.PathLike | str | bytes, progress: typing.Any = None) -> typing.Any:
        """
        What the session left of its stock: a Volume, the same to the bit. Its stock lies beside the journal.
        """
    def __enter__(self) -> typing.Any:
        ...
    def __exit__(self, *args) -> None:
        ...
    def __init__(self, volume: Volume, tool: Tool, pen: PenDevice = None, *, obstacles: Collider = None, protect: Volume = None, mode: str = 'remove', material: Material | None = None, at: typing.Any = None, scale: typing.SupportsFloat = 1.0, turn: typing.Any = None, stiffness: typing.SupportsFloat = 1.0, turn_stiffness: typing.SupportsFloat = 2000.0, damping: typing.SupportsFloat = 0.001, turn_damping: typing.SupportsFloat = 2.0, tolerance: typing.SupportsFloat = 0.01, memory: typing.SupportsFloat | None = None, max_force: typing.SupportsFloat = 5.0, max_torque: typing.SupportsFloat = 300.0, max_power: typing.SupportsFloat = 2000.0, ramp: typing.SupportsFloat = 0.5, dead_man_mask: typing.SupportsInt = 1, clutch_mask: typing.SupportsInt = 2, budget: typing.Any = 'auto', undo: typing.SupportsInt = 64) -> None:
        ...
    def frame(self) -> SessionFrame:
        """
        Brings the volume up to date, and tells what happened since the last call: SessionFrame.
        Waits for the next step, 3 ms at most.
        """
    def journal(self, path: os.PathLike | str | bytes, notes: dict = {}) -> None:
        """
        Records every stroke: poses, times, forces, what was
        cut. Before ``start``; a new file, with the stock beside it (``NAME-stock.rvol``), and what is protected
        (``NAME-mask.rvol``). What is in it survives a crash but for the last second at most, and is replayed by
        ``Session.replay``.
        """
    def journal_written(self, seconds: typing.SupportsFloat = 2.0) -> bool:
        """
        Waits until all rows that were made so far are in the journal's file, which is some 50 ms behind. False: not within so many seconds.
        """
    def redo(self) -> int:
        """
        And happened, unless another was begun since.
        """
    def reset(self) -> None:
        """
        Clears a trip that does not heal by itself: the frame's ``cause`` says what it was.
        """
    def set_workspace(self, *, scale: typing.SupportsFloat = 1.0, turn: typing.Any = None, dead_man_mask: typing.SupportsInt = 1, clutch_mask: typing.SupportsInt = 2) -> None:
        """
        Another scale, view or buttons from the next step on. The tool does not jump.
        """
    def start(self) -> None:
        """
        The pen's thread sculpts from now on. Once.
        """
    def stop(self) -> SessionFrame:
        """
        No force any more, and everything that was cut is in the volume and, where there is one, in
        the journal on the disk. SessionFrame: what was not shown yet.
        """
    def undo(self) -> int:
        """
        The last stroke did not happen, or the last few if they ended between two
        frames. How many that were; 0: there is none. RuntimeError in the middle of a stroke.
        """
    @property
    def journal_problem(self) -> typing.Any:
        """
        Why strokes wait for the disk, or None.
        """
    @property
    def pen(self) -> PenDevice:
        """
        The device.
        """
    @property
    def running(self) -> bool:
        ...
    @property
    def trips(self) -> list:
        """
        list of (time s, state, sentence, value): when the force was taken away, and why.
        """
    @property
    def volume(self) -> Volume:
        """
        The one that is shown.
        """
class PencilPath:
    """
    A curve of ball centres along a part, with what the ball touches at each. See riffler.plan. Immutable.
    """
    def __init__(self, radius: typing.SupportsFloat, centres: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], contacts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], normals: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], closed: bool = False) -> None:
        """
        centres (n, 3), contacts (n, 2, 3) mm and normals (n, 2, 3), unit, out of the material.
        """
    def __len__(self) -> int:
        ...
    def axis(self, index: typing.SupportsInt, inclination: typing.SupportsFloat, tilt: typing.SupportsFloat) -> numpy.typing.NDArray[numpy.float64]:
        """
        Unit axis at a point that leans forward by ``inclination`` and to the left by ``tilt``, rad: cos(tilt) (sin(inclination) x + cos(inclination) z) + sin(tilt) y.
        """
    def divided(self, step: typing.SupportsFloat) -> PencilPath:
        """
        With further points, evenly between two that are more than ``step`` mm apart (a straight valley has only its ends), so that keys can be set there. Without axes.
        """
    def lean(self, index: typing.SupportsInt, axis: typing.Any) -> tuple:
        """
        (inclination, tilt) of an axis at a point, rad: the inverse of ``axis``.
        """
    def nearest(self, point: typing.Any, direction: typing.Any = None) -> dict:
        """
        The contact nearest to a point, or to the ray from it in a direction: what a pen or a mouse points at.

        A dict: ``index`` of the path's point, ``side`` (0 or 1) of its two contacts, ``distance`` mm, ``point``, ``normal``.
        """
    def oriented(self, keys: typing.Any, interpolation: str = 'smooth', *, limit: typing.Any = None, project: bool = False) -> PencilPath:
        """
        A new path with tool axes at all points, interpolated from ``keys``: a dict of index (from 0) to unit axis.

        ``interpolation``: ``"linear"``, straight between two axes by number of points and made unit, the source's (4.4)-(4.5);
        ``"slerp"``, the great circle at constant rate by arc length; ``"smooth"``, by arc length with a continuous derivative,
        at most 1.7 times as fast as slerp. Constant before the first key and after the last; on a closed path also from the
        last to the first. To adjust an interpolated axis, make it a key: ``p.oriented({**p.keys, i: axis})``.
        ``limit``: (axis, angle), the cone in which the machine's rotary axes keep the tool; an axis beyond it is a ValueError
        naming the first point, or is moved onto the cone with ``project=True``. ValueError names the point of a key that is
        outside the path, not a unit vector, or opposite to the key before it.
        """
    def with_axes(self, axes: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], keys: typing.Any = {}, interpolation: str = '') -> PencilPath:
        """
        A new path with these axes (n, 3), which came about elsewhere; keys and interpolation are kept beside them.
        """
    @property
    def axes(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3): unit tool axes, tip to spindle; (0, 3) until the path is oriented.
        """
    @property
    def centres(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) mm
        """
    @property
    def closed(self) -> bool:
        """
        A loop: its last point is joined to its first.
        """
    @property
    def contacts(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 2, 3) mm
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
        How; empty until the path is oriented.
        """
    @property
    def keys(self) -> dict:
        """
        dict: index to axis, of what the axes were interpolated from.
        """
    @property
    def length(self) -> float:
        """
        mm, of the closing edge too.
        """
    @property
    def normals(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 2, 3): unit normals of the part at the contacts, out of the material.
        """
    @property
    def radius(self) -> float:
        """
        Of the ball, mm.
        """
def _open_pen(what: str, *, geometry: str = 'woodenhaptics', bubble: typing.SupportsFloat = 0.08, exponent: typing.SupportsFloat = 2.0, speed: typing.SupportsFloat = 60.0, turn_rate: typing.SupportsFloat = 1.5, hold_orientation: bool = False, signs: typing.Annotated[collections.abc.Sequence[typing.SupportsInt], "FixedSize(6)"] = [1, 1, 1, 1, 1, 1], gravity: typing.SupportsFloat = 0.0, friction: typing.SupportsFloat = 0.0) -> PenDevice:
    ...
def _pen_devices() -> list:
    ...
def _pen_families() -> dict:
    ...
def _pens() -> dict:
    ...
def _play_pen(strokes: collections.abc.Sequence[tuple[typing.Annotated[numpy.typing.ArrayLike, numpy.float64], collections.abc.Sequence[typing.SupportsFloat]]], speed: typing.SupportsFloat) -> PenDevice:
    ...
def clear_drafts(path: os.PathLike | str | bytes) -> None:
    """
    Removes drafts of ``path`` that nobody has locked: processes that were killed left them.
    """
def contact_locations(tool: Tool, contacts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], normals: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], axes: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], feeds: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
    ...
@typing.overload
def cutter_locations(path: PencilPath, tool: Tool, collider: Collider, *, clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, max_lift: typing.SupportsFloat, max_inserted: typing.SupportsInt, progress: typing.Any) -> dict:
    ...
@typing.overload
def cutter_locations(path: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], tool: Tool, collider: Collider, *, clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, max_lift: typing.SupportsFloat, max_inserted: typing.SupportsInt, progress: typing.Any) -> dict:
    ...
def draft_prefix(path: os.PathLike | str | bytes) -> pathlib.Path:
    """
    Path with which the names of drafts of ``path`` begin.
    """
def drop(tool: Tool, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], part: Mesh, axis: typing.Any, progress: typing.Any) -> tuple:
    ...
def engrave(part: Mesh, curves: collections.abc.Sequence, tool: Tool, *, depth: typing.SupportsFloat, inclination: typing.SupportsFloat, tilt: typing.SupportsFloat, tolerance: typing.SupportsFloat, turn: typing.SupportsFloat, crease: typing.SupportsFloat, reach: typing.SupportsFloat, progress: typing.Any) -> list:
    """
    For riffler.plan.engrave.
    """
def least_tilt(path: PencilPath, tool: Tool, collider: Collider, *, inclinations: collections.abc.Sequence[typing.SupportsFloat], tilts: collections.abc.Sequence[typing.SupportsFloat], clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, limit: typing.Any, max_change: typing.SupportsFloat, smoothness: typing.SupportsFloat, progress: typing.Any) -> dict:
    ...
def lift(tool: Tool, poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], collider: Collider, *, clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, max_lift: typing.SupportsFloat, max_evaluations: typing.SupportsInt, progress: typing.Any) -> dict:
    ...
def machine_options(machine: str, options: typing.Any = None) -> list:
    """
    The options that a machine takes, its own first, and those of the code that is written for it: a list of dicts.

    ``name``; ``kind``: "number", "positive", "numbers", "range" (two that grow), "flag" (a bool) or "word"; ``count`` of
    numbers; ``unit``: "mm", "deg", "mm/min", "deg/min" or ""; ``words``: of which it is one; ``value``: where it is not
    given, None where there is none then; ``needed``: it must be given, with these ``options``; ``own``: of this machine's
    file, the others are of many; ``about``: one sentence.
    ValueError for a machine that is not known, and for options that are wrong.
    """
def machines() -> dict:
    """
    Machines that programs are written for and read from, ours and your own: name to description. A post has its machine's name; the path of a .toml file that describes one will do as well.
    """
def orientation_maps(path: PencilPath, points: collections.abc.Sequence[typing.SupportsInt], tool: Tool, collider: Collider, *, inclinations: collections.abc.Sequence[typing.SupportsFloat], tilts: collections.abc.Sequence[typing.SupportsFloat], clearance: typing.SupportsFloat, tolerance: typing.SupportsFloat, limit: typing.Any, progress: typing.Any) -> list:
    ...
def pencil(part: Mesh, tool: Tool, *, tolerance: typing.SupportsFloat, bitangency_angle: typing.SupportsFloat | None, minimum_length: typing.SupportsFloat, passes: typing.SupportsInt, stepover: typing.SupportsFloat | None, overthickness: typing.SupportsFloat, progress: typing.Any) -> dict:
    """
    For riffler.plan.pencil.
    """
def read_file(path: os.PathLike | str | bytes) -> bytes:
    """
    The file's bytes. FormatError where there is none, and for a folder, a pipe or a device.
    """
def replace_file(draft: os.PathLike | str | bytes, path: os.PathLike | str | bytes) -> None:
    """
    ``draft``, on the same file system, takes the place of ``path`` as an AtomicFileWriter's does.
    """
def replaceable(path: os.PathLike | str | bytes) -> pathlib.Path:
    """
    Where a path leads, links followed. RuntimeError for what is no regular file.
    """
def set_threads(n: typing.SupportsInt | None) -> None:
    """
    Says how many threads parallel calls use from now on, in all of the process; those that run keep theirs.

    ``n``: 1 to 256, or None: RIFFLER_THREADS decides again, or the CPU affinity. Results are the same bytes for any number.
    ValueError for others.
    """
def stepover_of_scallop(radius: typing.SupportsFloat, height: typing.SupportsFloat) -> float:
    ...
def swarf(path: PencilPath, part: Mesh, tool: Tool, *, side: typing.SupportsInt, height: typing.SupportsFloat | None, tolerance: typing.SupportsFloat, progress: typing.Any) -> dict:
    """
    For riffler.plan.swarf.
    """
def then(found: typing.Any, convert: typing.Any) -> typing.Any:
    """
    convert(found); of a Task, that it will be done by its result().
    """
def threads() -> int:
    """
    Threads that a parallel call uses: what set_threads() says, else RIFFLER_THREADS where that is set, else as many as the process may run on.
    """
def tip_ball_radius(tool: Tool, name: str) -> float:
    """
    Radius (mm) of the ball at the tip of ``tool``; ValueError naming the argument ``name`` where there is none.
    """
def verify(program: typing.Any, stock_volume: Volume, part_mesh: typing.Any = None, fixtures: typing.Any = (), *, tools: typing.Any = None, tolerance: typing.SupportsFloat = 0.01, gouge_tolerance: typing.SupportsFloat = 0.05, rest_tolerance: typing.SupportsFloat | None = None, rapid_feed: typing.SupportsFloat = 10000.0, machine: str | None = None, machine_options: typing.Any = None, machine_frame: typing.Any = None, progress: typing.Any = None) -> VerifyReport:
    """
    Runs a program on a stock and reports what goes wrong; the stock is not changed.

    ``program``: a Program, or an iterable of Programs, each of which begins with the row at which the one before ended;
    nothing is kept of them but 16 bytes a row. ``part_mesh``: Mesh, for gouges and rest material. ``fixtures``: list of
    Volume or Mesh (which becomes a Volume at the stock's pitch). ``tools``: dict of number to Tool, before the program's own.

    ``tolerance`` (mm): of cutting, as in Volume.carve; contact that is less deep is none. ``gouge_tolerance`` (mm): what is
    taken from the part deeper under its surface is a gouge. ``rest_tolerance`` (mm): what stands higher on the part is a
    finding; None: rest material is mapped, not judged. ``rapid_feed``: mm/min, for the time. ``machine``: a name of
    machines() on which it is to run, with ``machine_options`` (those of reading are passed over): the first row that its axes or their limits cannot hold is a
    finding "machine". ``machine_frame``: (4, 4), from the coordinates of stock and program to those in which the machine has the
    program, where they are others.

    Rapids are cut too: a crash takes material. Shank and holder must stay clear of what is left of the stock when they come
    there, the whole tool of the fixtures. Where the description of a tool ends below material or a fixture that stands above
    or beside it, nobody knows what the spindle meets: a finding "unknown". ValueError naming number, row and line of a tool
    whose shape is not known. ``progress``: called with the finished share, of each chunk anew; returning False cancels.
    """
__compiler__: str
__version__: str
