"""Fields of panels have their names beside them, but for those of which something else says what they are."""

import ast
from pathlib import Path

import addon

UI = Path(addon.__file__).parent / "ui"
SAID_OTHERWISE = {
    ("machine_panel.py", "key"): "a label in the same row",
    ("machine_panel.py", "fields.identifier(fact['name'])"): "a label in the same row",
    ("panels.py", "size"): "a line above it",
    ("panels.py", "recording"): "the source that is chosen above it",
    ("paths_panel.py", "on"): "the path's name in the same row",
    ("plan_panel.py", "part"): "a line above it",
    ("plan_panel.py", "fixtures"): "a line above it",
    ("sculpt_panel.py", "axis"): "the entry that is chosen",
    ("sculpt_panel.py", "kind"): "the entry that is chosen",
}


def unnamed(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "prop":
            text = next((k.value for k in node.keywords if k.arg == "text"), None)
            if isinstance(text, ast.Constant) and text.value == "":
                yield path.name, ast.unparse(node.args[1]).strip("'")


def test_a_field_without_its_name_is_one_that_says_otherwise_what_it_is():
    found = {field for path in UI.glob("*.py") for field in unnamed(path)}
    assert found == set(SAID_OTHERWISE)
