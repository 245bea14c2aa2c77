"""A stroke of the sculpt tool on a live sculpt: samples become poses, and poses are carved, as the hand moves.

`BrushStroke.text` stores a stroke: the view, the samples, and the samples at which the surface was frozen again. The
same text on the same sculpt makes the same cuts, in a window or in a script.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass

import numpy as np
import riffler

from ...common import hand_tools, json_object
from .. import brushes
from .pull_path import PullMaker
from .reach import outline_of
from .roll import STRING, Roll, lowest
from .stroke_path import Hit, Sample, StrokeMaker, View, settings_for
from .view_rays import ViewRays, cross

NUMBERS = len(Sample._fields)
AROUND = 0.25  # share of the tool's width: the surface's normal is the mean within this distance
# Two rings. A spoke along an edge counts for either of its faces, as a pixel decides: of eight in each ring four did,
# and the normal jumped by 33°. With odd numbers at most one in a ring can; turned by an eighth, none at an axis.
OUTER, INNER = 9, 7
TURN = 2 * np.pi * np.concatenate([(np.arange(n) + 0.125) / n for n in (OUTER, INNER)])
SPOKES, RINGS = np.stack([np.cos(TURN), np.sin(TURN)], axis=1), np.repeat([1.0, 0.5], (OUTER, INNER))


@dataclass(frozen=True)
class Choice:
    """The settings of a stroke."""

    mode: str = "remove"  # id of a brush
    depth: float = 0.5  # mm
    axis: str = "NORMAL"  # NORMAL, VIEW, UP, TILT
    pressure: str = "NONE"  # NONE, DEPTH, FEED
    feed: float = 50.0  # mm/s
    string: float = 0.0  # pixels
    accumulate: bool = False
    strength: float = 0.5  # of brushes: 0 to 1
    falloff: str = "smooth"  # of riffler.falloff
    lean: float = 0.0  # rad, of a hand tool's handle
    turn: float = 0.0  # rad, of its blade out of the direction of the stroke


class BrushStroke:
    """Call `add` with samples and `look` now and then, then `end` once. `run` is a LiveSculpt; `keep_out`: poses (n, 6)
    and seconds (n - 1,) → the same along a collision-free path, or None."""

    def __init__(self, run, tool: dict, sight: ViewRays, choice: Choice, keep_out=None, surface=None):
        """`surface`: what the tool follows; by default the current surface."""
        self.brush = brushes.of(choice.mode)
        self._run, self._sight, self._choice, self._keep_out = run, sight, choice, keep_out
        self.tool = self.brush.cutter(riffler.Tool.from_dict(tool), choice.depth)
        if self.brush.hand:
            self.tool = hand_tools.opened(self.tool, self._lean, choice.depth)
        self.samples: list[Sample] = []
        self.looks: list[int] = []  # number of samples at each update of the surface
        self.removed, self.moves, self.lifted = 0.0, 0, 0
        self.paths: list[list[np.ndarray]] = []  # (n, 6) of the pointer's own tool, without its roll: pieces that join
        self._apart = False  # poses that were kept out separate the last move and the next
        self.pose: np.ndarray | None = None  # (6,) of the tool, mm; (9,) of a hand tool
        self.force = self.torque = np.zeros(3)
        self._pressed = choice.pressure == "DEPTH"
        self._surface = surface or run.freeze()
        self._maker = self._make_maker()
        self._roll = self._make_roll() if self.brush.hand else None

    def add(self, sample: Sample) -> bool:
        """True if something was carved."""
        self.samples.append(sample)
        self._set()
        return self._carve(self._maker.add(sample))

    def end(self) -> bool:
        self._set()
        carved = self._carve(self._maker.end())
        return self._cut(self._roll.end()) or carved if self._roll is not None else carved

    def look(self) -> None:
        """Shows what was carved; with `accumulate` the tool follows the new surface from here on."""
        self._run.show()
        if self._choice.accumulate:
            self.looks.append(len(self.samples))
            self._surface = self._run.freeze()

    def hover(self, x: float, y: float):
        """Preview of a click: the tool's pose and the surface's point and normal (mm); None off the surface.
        Carves nothing; for a brush that makes no stroke."""
        pieces = self._make_maker().add(Sample(x, y))
        found = self._surface.pick(*self._sight.ray(x, y))
        if not pieces or found is None:
            return None
        if self.brush.hand:
            roll = self._make_roll()
            pieces = roll.add(pieces[0]) + roll.end()
        return pieces[0].poses[-1], *found[1:3]

    @property
    def _lean(self) -> float:
        return 0.0 if self._choice.axis == "TILT" else self._choice.lean

    @property
    def heading(self) -> np.ndarray:
        """Where the blade of a click points."""
        return self._sight.basis().up

    @property
    def kept_paths(self) -> list[np.ndarray]:
        """(n, 6) for each part of the stroke: without the descent to the depth, unless it is a click."""
        whole = [np.vstack(parts) for parts in self.paths]
        return [path[1:] if len(path) > 2 else path for path in whole]

    def text(self) -> str:
        rows = [list(s) for s in self.samples]
        view = {"matrix": self._sight.matrix.ravel().tolist(), "size": list(self._sight.size)}
        return json.dumps({"view": view, "rows": rows, "looks": self.looks})

    # ------------------------------------------------------------------ within
    def _set(self) -> None:
        """Gives the sculpt the settings of brushes."""
        choice = self._choice
        self._run.depth, self._run.strength, self._run.falloff = choice.depth, choice.strength, choice.falloff
        self._run.pressure = self.samples[-1].pressure if self._pressed and self.samples else 1.0

    def _make_maker(self) -> StrokeMaker | PullMaker:
        choice, view = self._choice, self._sight.basis()
        diameter, pitch = self.tool.diameter, self._run.volume.pitch
        axis, depth, more = self.brush.path(choice.axis, choice.depth, diameter, pitch)
        if axis == "UP":  # the stock's z, as in a view from above
            view, axis = View(*np.eye(3)), "VIEW"
        if self.brush.puts_on:
            view = View(*(-v for v in view))
        settings = settings_for(
            pitch,
            diameter,
            depth=depth,
            axis=axis,
            pressure=choice.pressure,
            feed=choice.feed,
            string=choice.string,
            **more,
        )
        if self.brush.drags:
            return PullMaker(settings, self._pick, self._sight, self.brush.whole)
        # A dab's centre is on the surface, and so is the tip of a hand tool until Roll holds it.
        outline = np.zeros((1, 2)) if self.brush.falloff or self.brush.hand else outline_of(self.tool)
        return StrokeMaker(settings, outline, self._pick, view)

    def _make_roll(self) -> Roll:
        """A click's blade points up in the view. A pen that gives the axis has its own lean."""
        if not self.tool.hulls:
            raise ValueError(f"{self.tool.name} is no hand tool: it needs a gouge, a V-tool, a chisel or a knife")
        string = max(self._run.volume.pitch, self.tool.diameter * STRING)
        return Roll(string, self.heading, self._lean, self._choice.turn, lowest(self.tool.hulls, self._lean))

    def _pick(self, x: float, y: float) -> Hit | None:
        found = self._surface.pick(*self._sight.ray(x, y))
        if found is None:
            return None
        _, point, normal, _ = found
        point, normal = np.asarray(point), self._around(np.asarray(point), np.asarray(normal))
        # Material is added from within: by the tool's mirror image, whose tip comes out of the surface.
        return Hit(point, -normal if self.brush.puts_on else normal)

    def _around(self, point: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """The surface's normal without the jumps of its facets: the mean at a place and at two rings around it. Rays
        come in from all sides at 45°, so the surface behind an edge counts before the tool reaches it. The mean depends
        on the place only: on a curved surface a mean along the path would lag."""
        spokes = SPOKES @ across(normal)
        far = AROUND * self.tool.diameter * RINGS
        directions = -np.sqrt(0.5) * (spokes + normal)
        distance, _, normals, _ = self._surface.pick(point + far[:, None] * (2 * spokes + normal), directions)
        near = distance <= 2 * np.sqrt(2) * far
        from_outside = (normals * directions).sum(axis=1) < 0  # NaN where nothing was hit
        mean = normal + normals[near & from_outside].sum(axis=0)
        size = np.sqrt(mean @ mean)
        return mean / size if size > 1e-6 else normal

    def _carve(self, pieces) -> bool:
        if self._roll is not None:
            for piece in pieces:
                self._note(piece.poses, piece.new)
            pieces = [rolled for piece in pieces for rolled in self._roll.add(piece)]
        return self._cut(pieces)

    def _cut(self, pieces) -> bool:
        for piece in pieces:
            poses, dt = piece.poses, piece.dt
            if self._keep_out is not None:
                kept = self._keep_out(poses, dt)
                if kept is None:
                    self.lifted += len(poses)
                    self._apart = True
                    continue
                poses, dt = kept
                self.lifted += int((~(poses[:, None] == piece.poses).all(axis=2).any(axis=1)).sum())
            cut = self._run.carve(self.tool, poses, dt=dt, mode=self._choice.mode, new=piece.new or self._apart)
            if self._roll is None:
                self._note(poses, piece.new or self._apart)
            self._apart = False
            self.moves += len(poses) - 1
            self.pose = poses[-1]
            if cut is None:  # no chip
                continue
            self.removed += float(np.sum(cut.removed))
            if len(cut.force):
                self.force, self.torque = np.array(cut.force[-1]), np.array(cut.torque[-1])
        return bool(pieces)

    def _note(self, poses, new) -> None:
        if new or not self.paths:
            self.paths.append([poses])
        else:
            self.paths[-1].append(poses[1:])


def across(normal: np.ndarray) -> np.ndarray:
    """(2, 3) unit vectors perpendicular to a unit vector and to each other."""
    x, y, z = normal.tolist()
    if abs(z) > 0.7:
        size = math.hypot(y, z)
        first = (0.0, z / size, -y / size)
    else:
        size = math.hypot(x, y)
        first = (y / size, -x / size, 0.0)
    return np.array([first, cross((x, y, z), first)])


def read(text: str) -> tuple[ViewRays, list[Sample], list[int]]:
    """Parses BrushStroke.text: view, samples, looks. ValueError naming the problem."""
    try:
        data = json_object.loads(text, "stroke")
        view, rows, looks = data["view"], data["rows"], data.get("looks", [])
        matrix, size = view["matrix"], view["size"]
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"stroke must be JSON with view (matrix, size) and rows: {error}") from error
    if not _numbers(matrix, 16) or not _numbers(size, 2):
        raise ValueError("stroke: view has a matrix of 16 numbers and a size of 2")
    if not isinstance(rows, list) or not rows:
        raise ValueError("stroke: there are no rows")
    for k, row in enumerate(rows):
        if not _numbers(row) or not 2 <= len(row) <= NUMBERS or not np.isfinite(row).all():
            raise ValueError(f"stroke: row {k} is not 2 to {NUMBERS} finite numbers ({', '.join(Sample._fields)})")
    if not _numbers(looks) or any(not 0 <= n <= len(rows) or n != int(n) for n in looks):
        raise ValueError(f"stroke: looks are counts of rows, 0 to {len(rows)}")
    return ViewRays(matrix, size), [Sample(*map(float, row)) for row in rows], sorted(int(n) for n in looks)


def _numbers(values, count=None) -> bool:
    if not isinstance(values, list) or (count is not None and len(values) != count):
        return False
    try:
        return all(isinstance(v, int | float) and not isinstance(v, bool) and math.isfinite(v) for v in values)
    except OverflowError:  # of an integer
        return False


def replay(brush: BrushStroke, samples: list[Sample], looks: list[int]) -> None:
    """Repeats a window's stroke, in one call."""
    waiting = list(looks)
    for sample in samples:
        brush.add(sample)
        while waiting and waiting[0] <= len(brush.samples):
            waiting.pop(0)
            brush.look()
    brush.end()
