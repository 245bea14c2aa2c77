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


def finish(setup, tool, *, pattern, slope_from, slope_to, orientation, lead=0.0, tilt=0.0, target=None, **options):
    rule = rule_of(orientation, lead, tilt, target)
    return riffler.plan.finish(setup, tool, pattern, slopes=(slope_from, slope_to), orientation=rule, **options)


def engrave(setup, tool, *, curves, engrave_depth, facing, lead=0.0, tilt=0.0, **options):
    rule = rule_of(facing, lead, tilt, None)
    return riffler.plan.engrave_operation(setup, tool, curves, depth=engrave_depth, orientation=rule, **options)


def swarf(setup, tool, *, wall, wall_height, **options):
    return riffler.plan.swarf_operation(setup, tool, side=wall, height=wall_height or None, **options)


def rule_of(orientation, lead, tilt, target):
    """The argument ``orientation`` of riffler.plan for an entry of properties.ORIENTATIONS."""
    rules = {
        "AXIS": None,
        "NORMAL": "normal",
        "LEAD": (lead, tilt),
        "TOWARDS": {"towards": target},
        "AWAY": {"away": target},
        "LEAST": "least_tilt",
    }
    return rules[orientation]


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
            "orientation",
            "lead",
            "tilt",
            "target",
            "max_tilt",
            "max_turn",
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
    OperationKind(
        "ENGRAVE",
        "Engrave",
        "Cut curves into the part to a depth",
        "GREASEPENCIL",
        5,
        ("curves", "engrave_depth", "facing", "lead", "tilt", "tolerance", "feed", "spindle"),
        engrave,
    ),
    OperationKind(
        "SWARF",
        "Swarf",
        "Cut ruled walls above the part's valleys with the cutter's flank",
        "MOD_SOLIDIFY",
        6,
        ("wall", "wall_height", "tolerance", "feed", "spindle"),
        swarf,
    ),
)
# Fields that other fields need: the other field, and its values.
NEEDS: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "lead": {"orientation": ("LEAD",), "facing": ("LEAD",)},
    "tilt": {"orientation": ("LEAD",), "facing": ("LEAD",)},
    "target": {"orientation": ("TOWARDS", "AWAY")},
    "max_tilt": {"orientation": ("NORMAL", "LEAD", "TOWARDS", "AWAY", "LEAST")},
    "max_turn": {"orientation": ("NORMAL", "LEAD", "TOWARDS", "AWAY", "LEAST")},
}


def fields_of(kind, row):
    """The fields of an operation that count with its other settings. `row`: has the settings as attributes."""
    fields = KINDS[kind].fields

    def counts(field):
        needs = [(other, values) for other, values in NEEDS.get(field, {}).items() if other in fields]
        return all(getattr(row, other) in values for other, values in needs)

    return [field for field in fields if counts(field)]


KINDS: Mapping[str, OperationKind] = {kind.id: kind for kind in OPERATION_KINDS}
# Initial settings of a new operation of each kind, where they differ from the field's default.
FIRST: Mapping[str, Mapping[str, Any]] = {
    "ROUGH": {"allowance": 0.3, "tolerance": 0.05, "feed": 1200.0},
    "FINISH": {"allowance": 0.0, "tolerance": 0.005, "feed": 1000.0},
    "OUTLINE": {"allowance": 0.0, "tolerance": 0.01, "feed": 1000.0},
    "DRILL": {"tolerance": 0.05, "feed": 200.0, "spindle": 3000.0},
    "PENCIL": {"tolerance": 0.01, "feed": 800.0},
    "ENGRAVE": {"tolerance": 0.01, "feed": 500.0},
    "SWARF": {"tolerance": 0.05, "feed": 500.0},
}
