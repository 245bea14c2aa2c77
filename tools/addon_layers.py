"""The rules of the add-on's modules: a feature imports none after it in registration.py, and pure modules import no
Blender."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from shell import ROOT, StepError

# What only Blender has.
OF_BLENDER = re.compile(r"bpy\w*|bmesh|gpu\w*|mathutils|blf|bl_\w+|rna_\w+|freestyle|idprop")
# Folders of the add-on below every feature, in their order, and those whose modules know no Blender, wherever they are:
# plain Python imports and tests them.
BELOW = ("common", "translations", "blender")
PURE = {"common", "pure", "brushes", "strategies"}


def sections(addon: Path) -> list[str]:
    """The add-on's features in the order in which registration.py registers them."""
    found: list[str] = []
    for node in ast.parse((addon / "registration.py").read_text()).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "SECTIONS":
            found = [section.args[0].value for section in node.value.elts]
    if not found:
        raise StepError("addon/registration.py has no SECTIONS")
    return [folder for folder in dict.fromkeys(found) if folder and folder not in BELOW]


def imports(addon: Path, path: Path):
    """(line, module) of all that a module imports, also within functions: parts of a path of the add-on, below its
    root, or the name of another package."""
    package = path.relative_to(addon).parent.parts
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.lineno, node.module
        elif isinstance(node, ast.ImportFrom):
            base = (*package[: len(package) - node.level + 1], *(node.module or "").split("."))
            base = tuple(filter(None, base))
            for alias in node.names:
                whole = addon.joinpath(*base, alias.name)
                is_module = whole.is_dir() or whole.with_suffix(".py").exists()
                yield node.lineno, (*base, alias.name) if is_module else base


def is_there(addon: Path, module: tuple[str, ...]) -> bool:
    path = addon.joinpath(*module)
    return path.is_dir() or path.with_suffix(".py").exists()


def is_pure(parts: tuple[str, ...]) -> bool:
    return not PURE.isdisjoint(parts[:-1])


def problems(root: Path = ROOT) -> list[str]:
    """Modules in the add-on's root may import all others; no folder imports them. `()` is the package itself, which has
    the version."""
    addon = root / "addon"
    order = [*BELOW, *sections(addon)]
    found = [
        f"{addon.name}/{folder.name} is not a section of registration.py"
        for folder in sorted(addon.iterdir())
        if folder.is_dir() and any(folder.rglob("*.py")) and folder.name not in [*order, "_vendor"]
    ]
    for path in sorted(p for folder in order for p in (addon / folder).rglob("*.py")):
        name = path.relative_to(addon)
        own = name.with_suffix("").parts
        rank = order.index(own[0])
        for line, module in imports(addon, path):
            place = f"{addon.name}/{name}:{line}"
            if isinstance(module, str):
                if is_pure(own) and OF_BLENDER.fullmatch(module.partition(".")[0]):
                    found.append(f"{place}: a pure module imports {module}, which only Blender has")
            elif not is_there(addon, module):
                found.append(f"{place}: {'.'.join(module)} is not there")
            elif module and module[0] not in order[: rank + 1]:
                found.append(f"{place}: {own[0]} imports {'.'.join(module)}, which is not before it")
            elif module and is_pure(own) and PURE.isdisjoint(module):
                found.append(f"{place}: a pure module imports {'.'.join(module)}, which is not pure")
    return found
