"""Turning the tool at a point of a path: conversions between angles and axes, the pointer on a dial or on the tool's
end, numbers typed meanwhile.

Angles are in the path's own frame: the inclination leans an axis forward, about the frame's y, and then the tilt leans
it to the left (riffler.plan.PencilPath.axis). Rays are an origin and a unit direction, in mm.
"""

from __future__ import annotations

import math

import numpy as np
import riffler

from ...common import glyphs, quaternions, units
from . import clearance

INCLINATION, TILT, FREE = HANDLES = ("INCLINATION", "TILT", "FREE")
STEP = math.radians(5)  # step of snapped angles
SLOW = 0.1  # share of a turn in precise mode
STEEP = 0.2  # sine between view and dial below which the pointer moves along the dial instead of around it


def cleaned(angle: float) -> float:
    """Degrees of a single-precision angle (rad), rounded to what was entered."""
    return math.radians(units.clean(math.degrees(angle)))


def axis_at(path, index: int) -> np.ndarray:
    """The unit axis at a point; the animation's, if the path has none yet."""
    return np.array(path.axes[index] if len(path.axes) else path.frames[index][2])


def stand(path, index: int, axis, tool) -> np.ndarray:
    """The pose (6,) of a tool on a point with an axis. ValueError if there is none."""
    part = slice(index, index + 1)
    point = riffler.plan.PencilPath(path.radius, path.centres[part], path.contacts[part], path.normals[part])
    rows, report = riffler.plan.cutter_locations(
        point.with_axes(np.asarray(axis, float)[None]), tool, clearance.nothing(), max_lift=0
    )
    if not len(rows):
        raise ValueError(report.blocked[0][1])
    return np.array(rows[0])


def dial_axis(frame, inclination: float, handle: str) -> np.ndarray:
    """The axis of a dial, right-handed, at this inclination: the dial's angle is then the angle of its name."""
    x, y, z = frame
    if handle == INCLINATION:
        return np.array(y)
    return math.sin(inclination) * z - math.cos(inclination) * x


class Dial:
    """The pointer around an axis through a centre; `turned` is the angle (rad) since the first ray, including full
    turns. `radius`: of the dial, mm."""

    def __init__(self, centre, axis, radius: float, ray):
        self._centre, self._radius, self.turned = np.asarray(centre, float), radius, 0.0
        self._first, self._second, self._axis = glyphs.frame(axis)
        self._steep = abs(ray[1] @ self._axis) < STEEP
        self._last = self._at(ray)

    def move(self, ray, share: float = 1.0) -> float:
        """`share`: weight of the pointer's movement."""
        now = self._at(ray)
        step = now - self._last
        if not self._steep:
            step = math.remainder(step, 2 * math.pi)
        self._last = now
        self.turned += share * step
        return self.turned

    def _at(self, ray) -> float:
        origin, away = ray
        if self._steep:  # along its visible side
            along = np.cross(away, self._axis)
            near = origin + ((self._centre - origin) @ away) * away - self._centre
            return float(near @ along / np.linalg.norm(along)) / self._radius
        facing = away @ self._axis
        if abs(facing) < 1e-6:  # the view turned into the dial's plane meanwhile
            return self._last
        place = origin + ((self._centre - origin) @ self._axis) / facing * away - self._centre
        return math.atan2(place @ self._second, place @ self._first)


class Ball:
    """The pointer on a ball around a centre, which turns the axis with it. It begins at the axis' own end."""

    def __init__(self, centre, axis, radius: float, ray):
        self._centre, self._radius = np.asarray(centre, float), radius
        self._begun = self.axis = np.asarray(axis, float)
        self._held = self._last = self._on(ray, self._begun)

    def move(self, ray) -> np.ndarray:
        """The axis, turned like the pointer, by the shortest rotation."""
        self._last = self._on(ray, self._last)
        w, *v = quaternions.between(self._held, self._last)
        around = np.cross(v, self._begun)
        axis = self._begun + 2 * (w * around + np.cross(v, around))
        self.axis = axis / np.linalg.norm(axis)
        return self.axis

    def _on(self, ray, before) -> np.ndarray:
        """The intersection of the ray with the ball that is nearer to `before`; outside the ball, its edge."""
        origin, away = ray
        near = origin + ((self._centre - origin) @ away) * away - self._centre
        inside = self._radius**2 - near @ near
        if inside <= 0:
            return near / np.linalg.norm(near)
        places = [(near + way * math.sqrt(inside) * away) / self._radius for way in (-1, 1)]
        return max(places, key=lambda place: place @ before)


class Typed:
    """A number being typed: digits, a point, a minus key that changes the sign, and backspace."""

    def __init__(self):
        self._digits, self._sign = "", ""

    def __bool__(self):
        return bool(self._digits or self._sign)

    def __str__(self):
        return self._sign + self._digits

    def take(self, kind: str, character: str) -> bool:
        """Handles an event's type and character; False if it is not part of a number."""
        if kind == "BACK_SPACE":
            self._digits, self._sign = (self._digits[:-1], self._sign) if self._digits else ("", "")
        elif character and character in "0123456789":
            self._digits += character
        elif character in (".", ","):
            self._digits += "" if "." in self._digits else "."
        elif character == "-":
            self._sign = "" if self._sign else "-"
        else:
            return False
        return True

    @property
    def degrees(self) -> float:
        digits = self._digits.strip(".")
        return float(f"{self._sign}{self._digits}") if digits else 0.0


class Turn:
    """One turn by a handle, from where the pointer grabs it; `angles` (inclination, tilt), rad, are the result."""

    def __init__(self, path, index: int, axis, handle: str, ray, radius: float):
        self._path, self._index, self._handle = path, index, handle
        self._begun = self.angles = within(*path.lean(index, axis))
        self.typed = Typed()
        centre = path.centres[index]
        if handle == FREE:
            self._grip = Ball(centre, axis, radius, ray)
        else:
            around = dial_axis(path.frames[index], self._begun[0], handle)
            self._grip = Dial(centre, around, radius, ray)

    @property
    def turned(self) -> bool:
        return self.angles != self._begun

    @property
    def axis(self) -> np.ndarray:
        return np.array(self._path.axis(self._index, *self.angles))

    def move(self, ray, slow: bool = False, snap: bool = False) -> None:
        if self._handle == FREE:
            angles = self._path.lean(self._index, self._grip.move(ray))
        else:
            angles = self._by(self._grip.move(ray, SLOW if slow else 1.0))
        if self.typed:
            return
        if snap:
            angles = [STEP * round(a / STEP) for a in angles]
        self.angles = within(*angles)

    def type(self, kind: str, character: str) -> bool:
        """A typed number (degrees) sets the dial's angle; False if the event is none."""
        if self._handle == FREE or not self.typed.take(kind, character):
            return False
        self.angles = within(*self._by(math.radians(self.typed.degrees)))
        return True

    def _by(self, turned: float) -> tuple[float, float]:
        inclination, tilt = self._begun
        return (inclination + turned, tilt) if self._handle == INCLINATION else (inclination, tilt + turned)


def within(inclination: float, tilt: float) -> tuple[float, float]:
    """The range in which angles name each axis once, where a turn stops: the tilt ends where the tool is horizontal."""
    tilt = min(max(cleaned(tilt), -math.pi / 2), math.pi / 2)
    return cleaned(math.remainder(inclination, 2 * math.pi)), tilt


def said(inclination: float, tilt: float) -> str:
    angles = [units.trim(math.degrees(a), 1) for a in (inclination, tilt)]
    return f"Inclination {angles[0]}°, tilt {angles[1]}°"
