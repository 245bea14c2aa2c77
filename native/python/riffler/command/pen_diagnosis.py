"""What the counts of a pen's stroke say about its homing, its encoders and its geometry's file."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from .. import pen

STRAY = 0.02  # rad that some joint turns between two postures that are kept: closer ones say nothing new
CHANNELS = 6
TOLD = 64  # postures that the diagnosis keeps, the last ones: it is given some from all over the stroke


class Postures:
    """Counts, kept where some joint has turned since the last that were."""

    def __init__(self, geometry: pen.PenGeometry) -> None:
        self.geometry = geometry
        self.kept: list[np.ndarray] = []
        self.stretch: list[float] = []
        self.low, self.high = np.full(CHANNELS, np.inf), np.full(CHANNELS, -np.inf)
        self._stray = np.array([STRAY * c.steps / (2 * np.pi) for c in geometry.channels])

    def add(self, counts: np.ndarray, stretch: float) -> bool:
        if self.kept and not (np.abs(counts - self.kept[-1]) > self._stray).any():
            return False
        self.kept.append(counts)
        self.stretch.append(stretch)
        angles = angles_of(self.geometry, counts)
        self.low, self.high = np.minimum(self.low, angles), np.maximum(self.high, angles)
        return True

    @property
    def counts(self) -> np.ndarray:
        return np.array(self.kept, np.int32).reshape(-1, CHANNELS)


@dataclass(frozen=True)
class Joint:
    """What one joint did, in rad."""

    name: str
    low: float
    high: float
    limits: tuple[float, float]
    noticed: float  # counts of this encoder alone from which on a loss would have shown; 0 where the grip does not fit

    @property
    def share(self) -> float:
        """The share of the range between its limits that it covered."""
        return (self.high - self.low) / (self.limits[1] - self.limits[0])

    @property
    def beyond(self) -> bool:
        return self.low < self.limits[0] or self.high > self.limits[1]


@dataclass(frozen=True)
class Verdict:
    """Whether the grip's length comes out in all postures; if not, the one change that explains them, and home and
    sign of the geometry's file with it."""

    fits: bool
    text: str
    rms: float  # mm, of the stretch
    most: float
    rms_after: float  # with the change
    home: list[int]
    sign: list[int]
    channels: tuple[str, ...] = ()  # the joints that it is about


def angles_of(geometry: pen.PenGeometry, counts: np.ndarray) -> np.ndarray:
    """Angles of one row (rad), in the device's order of channels."""
    return np.array([c.sign * n / c.steps * 2 * np.pi for c, n in zip(geometry.channels, counts, strict=True)])


def joints(postures: Postures) -> list[Joint]:
    geometry = postures.geometry
    noticed = np.min(geometry.noticed_counts(postures.counts), axis=0) if postures.kept else np.full(CHANNELS, np.inf)
    return [
        Joint(c.name, float(low), float(high), (c.low, c.high), float(counts))
        for c, low, high, counts in zip(geometry.channels, postures.low, postures.high, noticed, strict=True)
    ]


def judge(geometry: pen.PenGeometry, counts: np.ndarray) -> Verdict:
    """The simplest explanation: nothing is wrong, one counter is off, has the wrong sign, or two are exchanged."""
    names = [c.name for c in geometry.channels]
    home, sign = [c.home for c in geometry.channels], [c.sign for c in geometry.channels]
    stretch = geometry.stretch(counts)
    rms, most = _rms(stretch), float(np.abs(stretch).max())

    def verdict(text: str, after: float = rms, fits: bool = False, channels: tuple[str, ...] = ()) -> Verdict:
        return Verdict(fits, text, rms, most, after, home, sign, channels)

    if most <= geometry.grip_tolerance:
        return verdict("the grip's length comes out in every posture", fits=True)
    found = geometry.diagnose(counts[np.unique(np.linspace(0, len(counts) - 1, TOLD).round().astype(int))])
    if found.channel is not None and found.counts is not None and found.left is not None:
        k, off = found.channel, round(found.counts)
        home[k] -= off
        return verdict(
            f"{names[k]} reads {abs(off)} counts too {'many' if off > 0 else 'few'}: home again. If it comes back, its "
            f"encoder loses counts (cable, dirt, speed); if it is the same again, the file's home of {names[k]} is "
            f"{home[k]}, not {home[k] + off}",
            found.left,
            channels=(names[k],),
        )
    if found.fault == "unclear":
        return verdict(
            "a counter is off, and the postures are too alike to tell which: lean the pen further, and calibrate again"
        )
    after, change = min(_wirings(geometry, counts, home), key=lambda found: found[0])
    if after > geometry.grip_tolerance / 2:
        return verdict(
            "no single counter explains it: was the pen in its home posture? If it was, the file's lengths, gears or "
            "encoder lines are another pen's"
        )
    if len(change) == 1:
        (k,) = change
        sign[k], home[k] = -sign[k], -home[k]
        text = f"{names[k]} counts in the wrong direction: turn its sign in the file"
        return verdict(text, after, channels=(names[k],))
    a, b = change
    return verdict(
        f"{names[a]} and {names[b]} are exchanged: their plugs, or their places in the file's order",
        after,
        channels=(names[a], names[b]),
    )


def _wirings(geometry: pen.PenGeometry, counts: np.ndarray, home: list[int]) -> list[tuple[float, tuple[int, ...]]]:
    """What each wrong sign, and each pair of exchanged plugs, would leave of the stretch: mm, and the channels.

    Both leave the home posture unchanged, so they turn the counter's change since then.
    """
    gone = counts - np.array(home)
    out: list[tuple[float, tuple[int, ...]]] = []
    for k in range(CHANNELS):
        other = gone.copy()
        other[:, k] *= -1
        out.append((_rms(geometry.stretch(home + other)), (k,)))
    for a, b in combinations(range(CHANNELS), 2):
        other = gone.copy()
        other[:, [a, b]] = other[:, [b, a]]
        out.append((_rms(geometry.stretch(home + other)), (a, b)))
    return out


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def bubble_of(shares: np.ndarray) -> float:
    """The bubble for an untouched puck: half as much again as its noise, and one step of its sensor (1/350),
    rounded up to a hundredth. `shares` are lengths of deflections, as shares of the full one."""
    most = float(np.max(shares, initial=0.0))
    return min(0.99, float(np.ceil(100 * (1.5 * most + 1 / 350)) / 100))
