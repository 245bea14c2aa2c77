"""The table of strategies. A module here lists its own in STRATEGIES; nothing else has a list of them."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from ..file import part_of
from .strategy import Found, Parameter, Strategy

__all__ = ["STRATEGIES", "Found", "Parameter", "Strategy", "find", "of"]


def _found() -> list[Strategy]:
    modules = [importlib.import_module(f"{__name__}.{found.name}") for found in pkgutil.iter_modules(__path__)]
    return sorted((one for module in modules for one in getattr(module, "STRATEGIES", ())), key=lambda s: s.place)


STRATEGIES: dict[str, Strategy] = {strategy.id: strategy for strategy in _found()}


def of(name: str) -> Strategy:
    """The strategy of an id. ValueError where there is none."""
    if name not in STRATEGIES:
        raise ValueError(f"strategy must be one of {', '.join(STRATEGIES)}, not {name!r}")
    return STRATEGIES[name]


def find(
    strategy: str,
    part_mesh: Any,
    tool: Any,
    given: Sequence[Any] = (),
    *,
    name: str = "part",
    progress: Callable[[float], Any] | None = None,
    **options: Any,
) -> Found:
    """Plans by the strategy of that id, as ``riffler plan`` and Blender do: a ``Found`` with the ``plan``, the
    ``reason`` where it has no paths, and ``notes``.

    ``given``: the curves, (n, 3) arrays in mm, or the paths that the strategy starts from, where it needs some.
    ``name``: the part's, for the plan. ``options``: the strategy's parameters; its default where one is not given, or
    None. ValueError for an unknown strategy, unknown options, and bad input.
    """
    chosen = of(strategy)
    if chosen.needs != "part" and not len(given):
        raise ValueError(f"given: {strategy} needs {chosen.needs}, and there are none")
    wanted = chosen.options(options)
    chosen.check(tool, given)
    found = chosen.run(part_mesh, tool, given, wanted, progress)
    return replace(found, plan=replace(found.plan, part=part_of(part_mesh, name)))
