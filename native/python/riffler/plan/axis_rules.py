"""Rules for tool axes that change along the cuts of an operation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import radians
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .setups import Setup

MAX_TILT = radians(60)  # default of max_tilt
MAX_TURN = 0.1  # default of max_turn, rad/mm
FORMS = (
    'a direction of three numbers from tip to spindle, "normal", (lead, tilt) in rad, {"towards": point or curve}, '
    '{"away": point or curve}, or "least_tilt"'
)


@dataclass(frozen=True, eq=False)
class AxisRule:
    """A rule: ``kind`` is "lean", "towards", "away" or "least_tilt"; ``target`` (n, 3) mm: a point, or a curve."""

    kind: str
    lead: float = 0.0
    tilt: float = 0.0
    target: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 3)))


def axis_rule(orientation: Any) -> AxisRule | None:
    """The rule that an argument ``orientation`` states; None for None and for a direction.

    Raises ValueError, which lists the possible forms, for anything else.
    """
    if orientation is None:
        return None
    if isinstance(orientation, str):
        if orientation == "normal":
            return AxisRule("lean")
        if orientation == "least_tilt":
            return AxisRule("least_tilt")
    elif isinstance(orientation, Mapping):
        if len(orientation) == 1 and (kind := next(iter(orientation))) in ("towards", "away"):
            return AxisRule(kind, target=_target(orientation[kind], kind))
    elif (numbers := _numbers(orientation)) is not None:
        if numbers.shape == (3,):
            return None
        if numbers.shape == (2,):
            return AxisRule("lean", float(numbers[0]), float(numbers[1]))
    raise ValueError(f"orientation must be {FORMS}, not {orientation!r}")


def rule_arguments(rule: AxisRule | None, max_tilt: float = MAX_TILT, max_turn: float = MAX_TURN) -> dict[str, Any]:
    """The arguments of the core for a rule, or for none."""
    named = rule or AxisRule("lean")
    return {
        "rule": None if rule is None else rule.kind,
        "ahead": named.lead,
        "aside": named.tilt,
        "target": named.target,
        "max_tilt": float(max_tilt),
        "max_turn": float(max_turn),
    }


def require_rotary(setup: Setup) -> None:
    """ValueError if the set-up's machine cannot turn the tool."""
    if setup.machine == "3-axis":
        raise ValueError(
            "orientation: machine 3-axis holds the tool along z; name a machine with rotary axes, or leave out the rule"
        )


def _target(value: ArrayLike, kind: str) -> NDArray[np.float64]:
    points = _numbers(value)
    if points is None or points.shape[-1:] != (3,) or points.ndim > 2 or not points.size:
        raise ValueError(f"orientation: {kind} needs a point of three numbers, or a curve of such points (k, 3), in mm")
    return points.reshape(-1, 3)


def _numbers(value: Any) -> NDArray[np.float64] | None:
    try:
        numbers = np.array(value, dtype=float)
    except (TypeError, ValueError):
        return None
    return numbers if numbers.ndim else None
