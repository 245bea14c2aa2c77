"""The table of strategies. Each module of this package lists its strategies in STRATEGIES; there is no other list."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ..._core import Mesh, Tool
from ...arguments import Progress
from ...hints import hinted
from ..model import part_of
from .strategy import Found, Parameter, Strategy

__all__ = ["STRATEGIES", "Found", "Parameter", "Strategy", "find", "of"]


def _found() -> list[Strategy]:
    modules = [importlib.import_module(f"{__name__}.{found.name}") for found in pkgutil.iter_modules(__path__)]
    return sorted((one for module in modules for one in getattr(module, "STRATEGIES", ())), key=lambda s: s.place)


STRATEGIES: dict[str, Strategy] = {strategy.id: strategy for strategy in _found()}


def of(name: str) -> Strategy:
    """The strategy with an id. ValueError if there is none."""
    if name not in STRATEGIES:
        raise ValueError(f"strategy must be one of {', '.join(STRATEGIES)}, not {name!r}")
    return STRATEGIES[name]


@hinted("plan.find")
def find(
    strategy: str,
    part_mesh: Mesh,
    tool: Tool,
    given: Sequence[Any] = (),
    *,
    name: str = "part",
    progress: Progress = None,
    **options: Any,
) -> Found:
    """Plans with one of the strategies, as ``riffler plan`` and Blender do.

    Parameters
    ----------
    strategy : str
        An id of ``STRATEGIES``.
    part_mesh : Mesh
        The part.
    tool : Tool
        The cutter, with shank and holder.
    given : list, optional
        The curves, (n, 3) arrays in mm, or the paths that the strategy starts from, if it needs any.
    name : str
        The part's name, for the plan.
    progress : callable, optional
        Called with the finished share; returning False cancels.
    options : keyword arguments
        The strategy's parameters; a missing one, or None, gets its default.

    Returns
    -------
    Found

    Raises
    ------
    ValueError
        For an unknown strategy, unknown options, and bad input.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> found = riffler.plan.find("pencil", part, riffler.Tool.ball(diameter=4, length=20), tolerance=0.02)
    >>> len(found.plan.paths), found.reason
    (1, '')
    """
    chosen = of(strategy)
    if chosen.needs != "part" and not len(given):
        raise ValueError(f"given: {strategy} needs {chosen.needs}, and there are none")
    wanted = chosen.options(options)
    chosen.check(tool, given)
    found = chosen.run(part_mesh, tool, given, wanted, progress)
    return replace(found, plan=replace(found.plan, part=part_of(part_mesh, name)))
