"""Only one module of the add-on checks Blender's version."""

import ast
from pathlib import Path

import pytest

import addon

ADDON = Path(addon.__file__).parent
PLACE = ADDON / "blender" / "versions.py"
NAMES = {"version", "version_cycle", "version_file"}


def root(node):
    """The first name of a chain of attributes, calls and indices."""
    while isinstance(node, ast.Attribute | ast.Call | ast.Subscript):
        node = node.func if isinstance(node, ast.Call) else node.value
    return node.id if isinstance(node, ast.Name) else ""


def is_app(node):
    return isinstance(node, ast.Attribute | ast.Name) and getattr(node, "attr", getattr(node, "id", "")) == "app"


def asks(node):
    """True if a node of the syntax tree checks Blender's version, or tries its features."""
    if isinstance(node, ast.Attribute):
        return node.attr in NAMES and is_app(node.value)
    if isinstance(node, ast.ImportFrom):
        return node.module == "bpy.app" and any(n.name in NAMES for n in node.names)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.args:
        name, first = node.func.id, node.args[0]
        if name in ("hasattr", "dir"):
            return root(first) in ("bpy", "context")
        if name == "getattr" and len(node.args) > 1 and is_app(first):
            return isinstance(node.args[1], ast.Constant) and node.args[1].value in NAMES
    return False


def questions(source):
    return [node.lineno for node in ast.walk(ast.parse(source)) if asks(node)]


@pytest.mark.parametrize(
    "source",
    [
        "import bpy\nif bpy.app.version >= (4, 0, 0): pass",
        "from bpy import app\nx = app.version[0]",
        "from bpy.app import version",
        "x = getattr(bpy.app, 'version')",
        "x = hasattr(bpy.types.Mesh, 'shade_flat')",
        "x = hasattr(context.window_manager.keyconfigs, 'addon')",
        "x = 'stl_export' in dir(bpy.ops.wm)",
    ],
)
def test_every_form_of_version_check_is_detected(source):
    assert len(questions(source)) == 1


@pytest.mark.parametrize(
    "source", ["bpy.app.version_string", "hasattr(module, 'attach')", "getattr(bpy.app.handlers, x)"]
)
def test_code_without_version_checks_passes(source):
    assert questions(source) == []


def test_only_one_module_checks_the_version_of_blender():
    files = sorted(ADDON.rglob("*.py"))
    found = {p: questions(p.read_text(encoding="utf-8")) for p in files if "_vendor" not in p.parts}
    assert found.pop(PLACE), "the module itself asks nothing: is it still the one?"
    assert {str(p): lines for p, lines in found.items() if lines} == {}
