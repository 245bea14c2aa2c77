"""docs/sculpting.md: settings have the names and defaults of its tables, and buttons their names there."""

import json
import re
from pathlib import Path

import bpy

from support import common

PAGE = Path(common.__file__).resolve().parents[2] / "docs" / "sculpting.md"
TABLE = re.compile(r"^\| setting \| default \| \|\n\|---.*\n((?:\|.*\n)+)", re.MULTILINE)
ROW = re.compile(r"^\| \*([^*]+)\* \| ([^|]+?) \| .+ \|$", re.MULTILINE)


def tables():
    """The rows (label, default) of each table of settings."""
    found = [table[1] for table in TABLE.finditer(PAGE.read_text())]
    rows = [ROW.findall(table) for table in found]
    assert [len(r) for r in rows] == [table.count("\n") for table in found]
    return rows


def fields(group):
    """{label: (property, value)} of a group's fields for panels."""
    shown = [p for p in group.bl_rna.properties if p.description and not p.is_hidden and p.identifier != "name"]
    return {p.name: (p, getattr(group, p.identifier)) for p in shown}


def said(prop, value):
    """A value in the page's form."""
    if value is None or value == set() or (prop.type == "STRING" and not value):
        return "none"
    if prop.type == "BOOLEAN":
        return "on" if value else "off"
    if prop.type == "ENUM":
        return prop.enum_items[value].name
    return f"{value:.4g}"


def test_settings_have_the_names_and_defaults_of_the_tables():
    scene = bpy.context.scene.riffler
    groups = {name: fields(getattr(scene, name)) for name in ("sculpt", "clay", "cut", "result")}
    found = tables()
    assert len(found) == 5
    for rows in found:
        homes = [fields_of for fields_of in groups.values() if {label for label, _ in rows} <= set(fields_of)]
        assert len(homes) == 1, f"no group, or more than one, has {rows}"
        for label, default in rows:
            assert said(*homes[0][label]) == default, f"{label}: {said(*homes[0][label])}, not {default}"
    (strokes,) = [rows for rows in found if ("Stabiliser", "0") in rows]
    assert {label for label, _ in strokes} == set(groups["sculpt"])


def test_buttons_on_the_page_have_their_labels():
    """Bold in the first cell of a line: a button, or a tool. Fixed texts of the add-on have their German, except those
    followed by a number."""
    addon = Path(common.part("registration").__file__).parent
    texts = set(json.loads((addon / "translations" / "de.json").read_text(encoding="utf-8")))
    panels = "".join(path.read_text(encoding="utf-8") for path in addon.rglob("*panel*.py"))
    cells = re.findall(r"^\| (\*\*.+?\*\*) \|", PAGE.read_text(), re.MULTILINE)
    named = [name for cell in cells for name in re.findall(r"\*\*([^*]+)\*\*", cell) if name != "key"]
    assert len(named) > 12
    unknown = [name for name in named if name not in texts and f'"{name}"' not in panels]
    assert not unknown, unknown
