"""Fields of panels show their names, except those that something else identifies."""

import ast
from pathlib import Path

import addon

ADDON = Path(addon.__file__).parent
SAID_OTHERWISE = {
    ("plan/machine_panel.py", "key"): "a label in the same row",
    ("plan/machine_panel.py", "machine_fields.identifier(fact.name)"): "a label in the same row",
    ("stock/panel.py", "size"): "a line above it",
    ("stock/panel.py", "recording"): "the source that is chosen above it",
    ("plan/paths_panel.py", "on"): "the path's name in the same row",
    ("machining/panel.py", "on"): "the operation's name in the same row",
    ("machining/panel.py", "name"): "it is a name",
    ("plan/panel.py", "part"): "a line above it",
    ("plan/panel.py", "fixtures"): "a line above it",
    ("sculpt/panel.py", "axis"): "the entry that is chosen",
    ("sculpt/panel.py", "falloff"): "the entry that is chosen",
    ("sculpt/panel.py", "kind"): "the entry that is chosen",
}


def unnamed(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "prop":
            text = next((k.value for k in node.keywords if k.arg == "text"), None)
            if isinstance(text, ast.Constant) and text.value == "":
                yield path.relative_to(ADDON).as_posix(), ast.unparse(node.args[1]).strip("'")


def test_a_field_without_its_name_is_explained_otherwise():
    found = {field for path in ADDON.rglob("*panel*.py") for field in unnamed(path)}
    assert found == set(SAID_OTHERWISE)
