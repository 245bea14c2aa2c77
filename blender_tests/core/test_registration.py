"""The list of modules that the add-on registers, compared with the existing files."""

import ast
import sys
import types
from pathlib import Path

import pytest

import addon
from addon import registration

ADDON = Path(addon.__file__).parent
LISTED = (*(path for section in registration.SECTIONS for path in section.paths()), registration.FALLBACK)


def path_of(name):
    path = ADDON.joinpath(*name.split("."))
    return path.with_suffix(".py") if path.with_suffix(".py").exists() else path / "__init__.py"


def top_level(path):
    """Names that a file defines or assigns, without imported ones."""
    names = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Assign):
            names |= {t.id for t in node.targets if isinstance(t, ast.Name)}
    return names


def test_every_module_of_the_list_names_its_classes():
    assert len(set(LISTED)) == len(LISTED)
    for name in LISTED:
        assert "CLASSES" in top_level(path_of(name)), name


def test_every_module_with_something_to_register_is_listed():
    own = {path_of(name) for name in LISTED} | {ADDON / "registration.py"}
    for path in sorted(ADDON.rglob("*.py")):
        if path not in own and "_vendor" not in path.parts:
            assert not top_level(path) & {"CLASSES", "attach", "detach"}, path


def test_a_module_that_fails_to_attach_is_detached(monkeypatch):
    log = []

    def attach():
        log.append("half of it")
        raise ValueError("in the middle")

    module = types.SimpleNamespace(CLASSES=(), attach=attach, detach=lambda: log.append("taken back"))
    monkeypatch.setitem(sys.modules, "bpy", types.SimpleNamespace())
    monkeypatch.setattr(registration, "_undo", [])
    with pytest.raises(ValueError, match="in the middle"):
        registration._take(module)
    registration.unregister()
    assert log == ["half of it", "taken back"]


def test_attached_modules_are_detached_even_if_another_one_fails(monkeypatch):
    log = []

    def fails():
        log.append("fails")
        raise ValueError("in the middle")

    monkeypatch.setattr(registration, "_undo", [lambda: log.append("first"), fails, lambda: log.append("last")])
    with pytest.raises(ValueError, match="in the middle"):
        registration.unregister()
    assert log == ["last", "fails", "first"] and registration._undo == []
