"""The kinds of operations of a job. A new kind is one entry here, and its fields in machining/properties.py."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import riffler


@dataclass(frozen=True)
class OperationKind:
    """A kind of operation. `fields`: its settings in properties.RifflerOperation, which are arguments of `plan`."""

    id: str
    label: str
    description: str
    icon: str
    number: int  # in .blend files: never changed
    fields: tuple[str, ...]
    plan: Callable[..., riffler.plan.Operation]


def finish(setup, tool, *, pattern, slope_from, slope_to, **options):
    return riffler.plan.finish(setup, tool, pattern, slopes=(slope_from, slope_to), **options)


def outline(setup, tool, *, depth, **options):
    return riffler.plan.outline(setup, tool, depth=depth or None, **options)


def drill(setup, tool, *, points, hole_depth, peck, **options):
    return riffler.plan.drill(setup, tool, points, hole_depth, peck or None, **options)


OPERATION_KINDS = (
    OperationKind(
        "ROUGH",
        "Rough",
        "Clear the stock in layers, with a bounded width of cut",
        "ALIGN_JUSTIFY",
        0,
        ("stepdown", "engagement", "allowance", "tolerance", "feed", "spindle"),
        riffler.plan.rough,
    ),
    OperationKind(
        "FINISH",
        "Finish",
        "Cut the part's surface in rows, which leave ridges of a given height",
        "SMOOTHCURVE",
        1,
        (
            "pattern",
            "cusp",
            "angle",
            "slope_from",
            "slope_to",
            "allowance",
            "tolerance",
            "feed",
            "spindle",
        ),
        finish,
    ),
    OperationKind(
        "OUTLINE",
        "Outline",
        "Cut the part out along its silhouette, in layers, with tabs that hold it",
        "MESH_CIRCLE",
        2,
        ("depth", "stepdown", "tabs", "tab_height", "allowance", "tolerance", "feed", "spindle"),
        outline,
    ),
    OperationKind(
        "DRILL",
        "Drill",
        "Drill holes at the origins of objects, in the order of their names",
        "LIGHT_POINT",
        3,
        ("points", "hole_depth", "peck", "tolerance", "feed", "spindle"),
        drill,
    ),
    OperationKind(
        "PENCIL",
        "Pencil",
        "Cut along the valleys that a ball touches on both sides",
        "IPO_EASE_IN",
        4,
        ("passes", "tolerance", "feed", "spindle"),
        riffler.plan.pencil_operation,
    ),
)
KINDS: Mapping[str, OperationKind] = {kind.id: kind for kind in OPERATION_KINDS}
# Initial settings of a new operation of each kind, where they differ from the field's default.
FIRST: Mapping[str, Mapping[str, Any]] = {
    "ROUGH": {"allowance": 0.3, "tolerance": 0.05, "feed": 1200.0},
    "FINISH": {"allowance": 0.0, "tolerance": 0.005, "feed": 1000.0},
    "OUTLINE": {"allowance": 0.0, "tolerance": 0.01, "feed": 1000.0},
    "DRILL": {"tolerance": 0.05, "feed": 200.0, "spindle": 3000.0},
    "PENCIL": {"tolerance": 0.01, "feed": 800.0},
}
