"""Judges a pen's homing, encoders and geometry file by the counts of a stroke."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from .. import pen

STRAY = 0.02  # rad that some joint turns between two kept postures: closer ones add no information
CHANNELS = 6
TOLD = 64  # postures, from all over the stroke, for the diagnosis, which would keep only the last 64


class Postures:
    """Postures of a stroke as counts: each in which some joint has turned since the last kept one."""

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
    """Motion of one joint, in rad."""

    name: str
    low: float
    high: float
    limits: tuple[float, float]
    noticed: float  # smallest loss of counts of this encoder alone that would have shown; 0 if the grip does not fit

    @property
    def share(self) -> float:
        """Share of the joint's range that its motion covered."""
        return (self.high - self.low) / (self.limits[1] - self.limits[0])

    @property
    def beyond(self) -> bool:
        return self.low < self.limits[0] or self.high > self.limits[1]


@dataclass(frozen=True)
class Verdict:
    """Whether all postures give the grip's length. If not: the one change that explains them, with the home and sign
    that the geometry's file then needs."""

    fits: bool
    text: str
    rms: float  # mm, of the stretch
    most: float
    rms_after: float  # with the change
    home: list[int]
    sign: list[int]
    channels: tuple[str, ...] = ()  # the joints at fault


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
    """The simplest explanation: no fault, one counter off or of the wrong sign, or two counters exchanged."""
    names = [c.name for c in geometry.channels]
    home, sign = [c.home for c in geometry.channels], [c.sign for c in geometry.channels]
    stretch = geometry.stretch(counts)
    rms, most = _rms(stretch), float(np.abs(stretch).max())

    def verdict(text: str, after: float = rms, fits: bool = False, channels: tuple[str, ...] = ()) -> Verdict:
        return Verdict(fits, text, rms, most, after, home, sign, channels)

    if most <= geometry.grip_tolerance:
        return verdict("every posture gives the grip's length", fits=True)
    found = geometry.diagnose(counts[np.unique(np.linspace(0, len(counts) - 1, TOLD).round().astype(int))])
    if found.channel is not None and found.counts is not None and found.left is not None:
        k, off = found.channel, round(found.counts)
        home[k] -= off
        return verdict(
            f"{names[k]} reads {abs(off)} counts too {'many' if off > 0 else 'few'}: home again. If another error "
            f"follows, its encoder loses counts (cable, dirt, speed); if the same error follows, the file's home of "
            f"{names[k]} must be {home[k]}, not {home[k] + off}",
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
            "no single counter explains the error: was the pen in its home posture? If it was, the lengths, gears or "
            "encoder lines in the file belong to another pen"
        )
    if len(change) == 1:
        (k,) = change
        sign[k], home[k] = -sign[k], -home[k]
        text = f"{names[k]} counts in the wrong direction: change its sign in the file"
        return verdict(text, after, channels=(names[k],))
    a, b = change
    return verdict(
        f"{names[a]} and {names[b]} are exchanged: their plugs, or their places in the file's order",
        after,
        channels=(names[a], names[b]),
    )


def _wirings(geometry: pen.PenGeometry, counts: np.ndarray, home: list[int]) -> list[tuple[float, tuple[int, ...]]]:
    """For each wrong sign and each pair of exchanged plugs: stretch after its correction, mm, and the channels.

    Neither fault changes the home posture, so the correction changes only the counts since homing.
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
    """The bubble of a puck, from its noise when untouched: 1.5 times the noise plus one step of its sensor (1/350),
    rounded up to a hundredth. `shares` are lengths of deflections, as shares of the full one."""
    most = float(np.max(shares, initial=0.0))
    return min(0.99, float(np.ceil(100 * (1.5 * most + 1 / 350)) / 100))
