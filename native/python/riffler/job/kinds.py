"""The kinds of operations in a job file. For each kind: the function of `riffler.plan` that plans it, and its options.

A new kind is a new entry in KINDS; there is no other list.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from .. import plan
from .table import Table

Reader = Callable[[Table, str], Any]


def _text(table: Table, key: str, *, choices: tuple[str, ...] = ()) -> Any:
    return table.text(key, choices)


def _slopes(table: Table, key: str) -> Any:
    degrees = table.vector(key, 2)
    return None if degrees is None else tuple(math.radians(float(x)) for x in degrees)


def curves(table: Table, key: str) -> Any:
    """Curves, from a file or from lists of points in the job file itself."""
    if isinstance(table.data.get(key), str):
        path = table.file_name(key, plan.curves.FORMATS)
        assert path is not None
        return plan.read_curves(path)
    if not table.has(key):
        return None
    value = table.data[key]
    if not isinstance(value, list) or not all(isinstance(curve, list) for curve in value):
        raise table.error(key, "a file of curves expected, or a list of curves, each a list of points [x, y, z]")
    return [Table(table.file, {key: curve}, table.path).rows(key, 3) for curve in value]


def orientation(table: Table, key: str) -> Any:
    """A rule for axes as plan.finish takes it, with lead and tilt in degrees; a direction of any length as a unit
    vector."""
    value = table.data.get(key)
    if isinstance(value, str):
        return table.text(key, ("normal", "least_tilt"))
    if isinstance(value, dict):
        sub = table.sub(key)
        assert sub is not None
        kinds = [kind for kind in ("towards", "away") if sub.has(kind)]
        if len(kinds) != 1:
            raise table.error(key, "either towards or away expected, as in { towards = [0, 0, 100] }")
        is_point = isinstance(value[kinds[0]], list) and not any(isinstance(one, list) for one in value[kinds[0]])
        target = sub.vector(kinds[0], 3) if is_point else points(sub, kinds[0])
        sub.done()
        return {kinds[0]: target}
    if isinstance(value, list) and len(value) == 2:
        lead = table.vector(key, 2)
        assert lead is not None
        return tuple(math.radians(float(x)) for x in lead)
    return direction(table, key)


def direction(table: Table, key: str) -> Any:
    """The key's unit vector; the file may have any length."""
    vector = table.vector(key, 3)
    if vector is None:
        return None
    length = float(np.linalg.norm(vector))
    if not length > 0:
        raise table.error(key, "a direction expected, as in [0, 0, 1]")
    return vector / length


def points(table: Table, key: str) -> Any:
    """Points, from all curves of a file or from a list in the job file itself."""
    if isinstance(table.data.get(key), str):
        found = curves(table, key)
        return np.concatenate(found)
    return table.rows(key, 3)


NOT_NEGATIVE: Reader = partial(Table.number, low=0)
POSITIVE: Reader = partial(Table.number, above=0)
ANGLE: Reader = Table.angle
FLAG: Reader = Table.flag


@dataclass(frozen=True)
class Kind:
    """One kind. ``options``: how to read the key of each keyword of the function; without the key, the function's
    default applies. ``needed``: required keys, with an example value each."""

    run: Callable[..., plan.Operation]
    options: Mapping[str, Reader]
    needed: Mapping[str, str]
    feeds: tuple[str, ...] = ("feed", "plunge", "spindle")  # from the tool, if the operation does not set them
    orientation: Reader | None = direction  # None: the operation takes none

    def read(self, table: Table) -> dict[str, Any]:
        for key, example in self.needed.items():
            if not table.has(key):
                raise table.missing(key, example)
        more = {} if self.orientation is None else {"orientation": self.orientation}
        found = {key: read(table, key) for key, read in {**self.options, **more}.items()}
        return {key: value for key, value in found.items() if value is not None}


KINDS: dict[str, Kind] = {
    "rough": Kind(
        plan.rough,
        {
            "stepdown": POSITIVE,
            "depth": POSITIVE,
            "engagement": POSITIVE,
            "allowance": NOT_NEGATIVE,
            "tolerance": POSITIVE,
            "slope": ANGLE,
            "climb": FLAG,
        },
        {},
    ),
    "finish": Kind(
        plan.finish,
        {
            "pattern": partial(_text, choices=plan.PATTERNS),
            "cusp": POSITIVE,
            "tolerance": POSITIVE,
            "allowance": NOT_NEGATIVE,
            "angle": ANGLE,
            "slopes": _slopes,
            "region": curves,
            "lead": NOT_NEGATIVE,
            "rest": POSITIVE,
            "max_tilt": ANGLE,
            "max_turn": ANGLE,
        },
        {},
        orientation=orientation,
    ),
    "outline": Kind(
        plan.outline,
        {
            "curves": curves,
            "depth": POSITIVE,
            "inside": FLAG,
            "stepdown": POSITIVE,
            "tabs": Table.whole,
            "tab_height": NOT_NEGATIVE,
            "tab_width": POSITIVE,
            "allowance": NOT_NEGATIVE,
            "tolerance": POSITIVE,
            "slope": ANGLE,
            "climb": FLAG,
            "lead": NOT_NEGATIVE,
        },
        {},
    ),
    "drill": Kind(
        plan.drill,
        {"points": points, "depth": POSITIVE, "peck": POSITIVE, "tolerance": POSITIVE},
        {"points": "[[10, 20, 0]]", "depth": "5"},
        ("feed", "spindle"),
    ),
    "pencil": Kind(
        plan.pencil_operation,
        {
            "tolerance": POSITIVE,
            "passes": partial(Table.whole, low=1),
            "stepover": POSITIVE,
            "scallop": POSITIVE,
            "minimum_length": NOT_NEGATIVE,
            "overthickness": NOT_NEGATIVE,
            "rest": POSITIVE,
        },
        {},
    ),
    "engrave": Kind(
        plan.engrave_operation,
        {"curves": curves, "depth": POSITIVE, "tolerance": POSITIVE, "reach": POSITIVE},
        {"curves": '"letters.obj"'},
        orientation=orientation,
    ),
    "swarf": Kind(
        plan.swarf_operation,
        {
            "side": partial(_text, choices=("better", "first", "second")),
            "height": POSITIVE,
            "tolerance": POSITIVE,
        },
        {},
        orientation=None,
    ),
}
