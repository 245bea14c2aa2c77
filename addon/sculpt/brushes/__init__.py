"""The table of brushes. A module here lists its brushes in BRUSHES; there is no other list of them."""

import importlib
import pkgutil

from .brush import Brush


def _found():
    modules = [importlib.import_module(f"{__name__}.{found.name}") for found in pkgutil.iter_modules(__path__)]
    return sorted((brush for module in modules for brush in getattr(module, "BRUSHES", ())), key=lambda b: b.place)


BRUSHES: dict[str, Brush] = {brush.id: brush for brush in _found()}


def of(name: str) -> Brush:
    """The brush of an id. ValueError if there is none."""
    if name not in BRUSHES:
        raise ValueError(f"mode must be one of {', '.join(BRUSHES)}, not {name!r}")
    return BRUSHES[name]


def of_tool(identifier: str) -> Brush | None:
    """The brush of a tool in the toolbar, or None."""
    return next((brush for brush in with_tool() if brush.tool == identifier), None)


def active(context) -> Brush | None:
    """The brush whose tool is active in the 3D view, or None."""
    tool = context.workspace.tools.from_space_view3d_mode("OBJECT", create=False) if context.workspace else None
    return of_tool(tool.idname) if tool is not None else None


def of_journal(name: str) -> Brush | None:
    """A brush whose strokes have that name in a journal, or None."""
    return next((brush for brush in BRUSHES.values() if brush.journal == name), None)


def with_tool() -> list[Brush]:
    """The brushes with a tool in the toolbar, in its order."""
    return [brush for brush in BRUSHES.values() if brush.tip]


def opposite(brush: Brush) -> Brush:
    """The brush of the tool with Ctrl held."""
    return of(brush.opposite or brush.id)


def entries(brushes) -> list[tuple[str, str, str]]:
    """(identifier, label, description) of each, for an operator's enum property."""
    return [(brush.id.upper(), brush.label, brush.description) for brush in brushes]
