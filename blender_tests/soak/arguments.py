"""Random settings of operators and of the scene, valid and invalid, from Blender's descriptions of them.

New operators and new settings are drawn like all others. Only settings that need a meaningful value to reach the work
behind them (a tool, a stroke), and those whose valid values would take hours, are listed here by name.
"""

import json
import math

import bpy
from hypothesis import strategies as st

from support import common

WRONG = (math.nan, math.inf, -math.inf, -1.0, 0.0, 1e-30, 1e30)
# Ranges of drawn numbers, with the invalid ones: values outside would cause hours or days of regular work.
NUMBERS = {
    "pitch": ((0.5, 3.0), WRONG[:6]),
    "size": ((3.0, 12.0), (math.nan, -1.0, 0.0, 1e-30)),
    "seconds": ((0.0, 0.04), (math.nan, -1.0, 0.0)),
    "radial": ((1, 6), (-1,)),
    "passes": ((1, 2), (-1,)),
    "iterations": ((0, 5), (-1,)),
}
TOOLS = (
    '{"kind": "ball", "diameter": 3.0, "length": 20.0}',
    '{"kind": "flat", "diameter": 2.0, "length": 20.0}',
    '{"kind": "ball", "diameter": 40.0, "length": 60.0}',
    '{"kind": "ball"}',
    '{"kind": "ball", "diameter": NaN, "length": 20.0}',
    '{"kind": "flat", "diameter": -1, "length": 20.0}',
    '{"kind": "spoon", "diameter": 3.0, "length": 20.0}',
    "[1, 2]",
    "{",
)
TEXTS = ("", "missing", "Ä" * 90, "a\nb", "../..")


def stroke(x=0.0, y=0.0, width=6.0, count=3):
    """A stroke seen from above, of `width` mm around a place of the sculpt's frame, as JSON."""
    size, pixel = (200, 200), 0.2
    matrix = [2 / (size[0] * pixel), 0, 0, 0, 0, 2 / (size[1] * pixel), 0, 0, 0, 0, -0.01, 0, 0, 0, 0, 1]
    rows = [[100 + (x + width * k / count) / pixel, 100 + y / pixel, 1.0] for k in range(count)]
    return json.dumps({"view": {"matrix": matrix, "size": list(size)}, "rows": rows})


STROKES = (
    *(stroke(x, y, width) for x in (-4, 1, 3) for y in (0.5, 4) for width in (0, 6)),
    stroke(x=90),
    stroke(x=math.nan),
    stroke(x=1e30),
    stroke(count=0),
    stroke().replace("200]", "0]"),
    '{"view": 1}',
    "[]",
    "{",
)


def names():
    """Names of existing data, without the add-on's internal data."""
    found = (ob.name for data in (bpy.data.objects, bpy.data.images, bpy.data.collections) for ob in data)
    return sorted({name for name in found if not name.startswith((".", "Riffler Chunk", "Riffler Live"))})


def paths():
    """Protects the user's files: all paths are in the tests' folder."""
    return [common.out(n) for n in ("fuzz.stl", "fuzz.ngc", "fuzz.rjournal", "missing/fuzz", ".")]


def value(of):
    """A draw for a property (bpy.types.Property), valid or not, of the type that it takes; None: leave it unset."""
    if of.is_readonly or of.type in ("POINTER", "COLLECTION"):
        return None
    if of.type == "BOOLEAN":
        return _of(of, st.booleans())
    if of.type == "ENUM":
        items = [i.identifier for i in of.enum_items_static] + ["NOWHERE"]
        return st.sets(st.sampled_from(items)) if of.is_enum_flag else st.sampled_from(items)
    if of.type == "STRING":
        return st.sampled_from(_texts(of))
    return _of(of, _number(of))


def _of(of, strategy):
    count = of.array_length
    return st.lists(strategy, min_size=count, max_size=count) if count else strategy


def _number(of):
    default = of.default_array[0] if of.array_length else of.default
    spread = 4 * abs(default) or 4.0
    usual = max(of.hard_min, default - spread), min(of.hard_max, default + spread)
    (low, high), wrong = NUMBERS.get(of.identifier, (usual, WRONG))
    if of.type == "INT":
        wrong = [int(w) for w in wrong if abs(w) < 2**31]
        return st.one_of(st.integers(int(low), int(high)), st.sampled_from(wrong))
    return st.one_of(st.floats(low, high), st.floats(low, high), st.sampled_from(wrong))


def _texts(of):
    if of.identifier == "tool":
        return ["", *TOOLS]
    if of.identifier == "stroke":
        return ["", *STROKES]
    if of.subtype in ("FILE_PATH", "DIR_PATH", "FILE_NAME") or of.identifier in ("filepath", "directory"):
        return ["", *paths()]
    return [*names(), *TEXTS]


def settings(rna):
    """Draws for some of the properties of `rna` (bl_rna)."""
    found = {p.identifier: value(p) for p in rna.properties if p.identifier not in ("rna_type", "name_full")}
    return st.fixed_dictionaries({}, optional={name: draw for name, draw in found.items() if draw is not None})
