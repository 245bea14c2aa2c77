"""The path of a brush that pulls the surface. The pointer moves the brush in the plane that is parallel to the view and
contains the stroke's first point."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from .stroke_path import Hit, Piece, Sample, Settings
from .view_rays import ViewRays


@dataclass
class PullMaker:
    """Like StrokeMaker. A piece leads from the last place to the new one, in steps of the spacing; `whole`: from the
    first place, in one step."""

    settings: Settings
    pick: Callable[[float, float], Hit | None]
    sight: ViewRays
    whole: bool = False
    _first: np.ndarray | None = field(default=None, init=False)  # (6,)
    _last: np.ndarray | None = field(default=None, init=False)
    _string: np.ndarray | None = field(default=None, init=False)  # pixels: the end of the string

    def add(self, sample: Sample) -> list[Piece]:
        if self._first is None:
            hit = self.pick(sample.x, sample.y)
            if hit is None:
                return []
            self._first = self._last = np.concatenate([hit.point, hit.normal])
            self._string = np.array([sample.x, sample.y])
            return [self._piece(np.stack([self._first, self._first]), True)]
        return self._pull(self._pulled(sample))

    def end(self) -> list[Piece]:
        return []

    def _pulled(self, sample: Sample) -> np.ndarray:
        off = np.array([sample.x, sample.y]) - self._string
        way = float(np.linalg.norm(off))
        if way > self.settings.string:
            self._string = self._string + off * (1 - self.settings.string / way)
        return self._string

    def _pull(self, pixel: np.ndarray) -> list[Piece]:
        origin, away = self.sight.ray(*pixel)
        back = self.sight.basis().back
        across = float(away @ back)
        if abs(across) < 1e-6:
            return []
        point = origin + away * (float((self._first[:3] - origin) @ back) / across)
        start = self._first if self.whole else self._last
        way = float(np.linalg.norm(point - start[:3]))
        if not self.whole and way < 0.5 * self.settings.spacing:
            return []
        count = 1 if self.whole else int(np.ceil(way / self.settings.spacing))
        share = np.arange(count + 1)[:, None] / count
        poses = np.hstack([start[:3] + share * (point - start[:3]), np.tile(self._first[3:], (count + 1, 1))])
        self._last = poses[-1]
        return [self._piece(poses, False)]

    def _piece(self, poses: np.ndarray, new: bool) -> Piece:
        way = np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1)
        return Piece(poses, np.maximum(way, 1e-6) / self.settings.feed, new)
