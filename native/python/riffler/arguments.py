"""Types of arguments that many calls take, and `then`, which converts results that may be tasks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias, TypeVar, cast

from numpy.typing import ArrayLike

from . import _core

#: Called with the finished share, 0 to 1; returning False cancels the call.
Progress: TypeAlias = Callable[[float], bool | None] | None

#: (axis, angle): a cone about a unit axis, with its half angle in rad.
Cone: TypeAlias = tuple[ArrayLike, float]

#: Options of machines and posts, by name.
Options: TypeAlias = Mapping[str, float | bool | str | Sequence[float]]

T = TypeVar("T")
R = TypeVar("R")


def then(found: T, convert: Callable[[T], R]) -> R:
    """``convert(found)``; for a task, a task whose result is converted."""
    return cast(R, _core.then(found, convert))
