"""Checks who includes whom: a native topic uses only those above it in RIFFLER_TOPICS, the core touches neither Python
nor what it is judged by, the pen's C files touch nothing but each other, a feature of the add-on imports none after it,
and the add-on's pure modules import no Blender. And a source includes its own header first, which shows that the header
stands alone. Prints every line that breaks a rule and exits 1."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

from shell import ROOT, StepError, main

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
# Folders beside the topics, and which topics and other such folders they may include. The reference must not share code
# with what it judges; `None` is every topic.
BESIDE: dict[str, tuple[list[str] | None, list[str]]] = {
    "reference": (["geom", "tool"], []),
    "bench": (None, ["reference"]),
    "stress": (None, ["reference"]),
    "fuzz": (None, []),
    "bindings": (None, ["bench", "stress"]),
}
# Topics that may include the pen's protocol and firmware.
USES_DEVICE = {"pen"}
# What the pen's C files may include of the standard library: all of it is there without an operating system.
FREESTANDING = {"stddef.h", "stdint.h", "string.h"}
# What only Blender has.
OF_BLENDER = re.compile(r"bpy\w*|bmesh|gpu\w*|mathutils|blf|bl_\w+|rna_\w+|freestyle|idprop")
# Folders of the add-on below every feature, in their order, and those whose modules know no Blender, wherever they are:
# plain Python imports and tests them.
BELOW = ("common", "translations", "blender")
PURE = {"common", "pure", "brushes", "strategies"}


def topics() -> list[str]:
    """The order of the topics, as the build has it."""
    match = re.search(r"set\(RIFFLER_TOPICS ([^)]*)\)", (ROOT / "CMakeLists.txt").read_text())
    if not match:
        raise StepError("CMakeLists.txt sets no RIFFLER_TOPICS")
    return match[1].split()


def lines(folder: Path, *suffixes: str):
    for path in sorted(folder.rglob("*")):
        if path.suffix in suffixes:
            for number, line in enumerate(path.read_text().splitlines(), 1):
                yield f"{path.relative_to(ROOT)}:{number}", line


def includes(folder: Path):
    for place, line in lines(folder, ".cpp", ".hpp", ".c", ".h"):
        if match := INCLUDE.match(line):
            yield place, match[1], match[2]


def core_problems() -> list[str]:
    order = topics()
    problems = []
    for rank, topic in enumerate(order):
        for place, quote, name in includes(ROOT / "native" / topic):
            folder = name.split("/")[0]
            if name == "Python.h" or folder == "pybind11":
                problems.append(f"{place}: the core includes {name}")
            elif folder == "device" and topic in USES_DEVICE:
                continue
            elif quote == '"' and "/" not in name:
                problems.append(f"{place}: write the topic's folder: {topic}/{name}")
            elif quote == '"' and folder not in order[: rank + 1]:
                problems.append(f"{place}: {topic} includes {name}, which is not above it")
    return problems


def beside_problems() -> list[str]:
    order = topics()
    problems = []
    for name, (above, beside) in BESIDE.items():
        allowed = [name, *(order if above is None else above), *beside]
        for place, quote, header in includes(ROOT / "native" / name):
            folder = header.split("/")[0]
            if quote == '"' and "/" in header and folder not in allowed:
                problems.append(
                    f"{place}: {name} includes {header}; of native/ it may use {', '.join(allowed[1:])} only"
                )
    return problems


def device_problems() -> list[str]:
    """A path is taken from the file that includes it, so that the two folders can be copied into a firmware's tree."""
    problems = []
    for folder, above in (("protocol", []), ("firmware", ["../protocol"])):
        for place, quote, name in includes(ROOT / "device" / folder):
            if quote == "<" and name not in FREESTANDING:
                problems.append(f"{place}: {folder} includes <{name}>, which a pen may not have")
            elif quote == '"' and name.rpartition("/")[0] not in ["", *above]:
                problems.append(f"{place}: {folder} includes {name}, which is not above it")
    return problems


def header_problems() -> list[str]:
    """Where sources are compiled one by one, that shows that their headers stand alone (cmake/headers.cmake)."""
    problems = []
    for topic in [*topics(), "reference"]:
        for source in sorted((ROOT / "native" / topic).glob("*.cpp")):
            own = source.with_suffix(".hpp")
            found = [INCLUDE.match(line) for line in source.read_text().splitlines()]
            first = next((match[2] for match in found if match), None)
            if own.exists() and first != f"{topic}/{own.name}":
                problems.append(f"{source.relative_to(ROOT)}: includes {first} before {topic}/{own.name}")
    return problems


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


def addon_problems(addon: Path = ROOT / "addon") -> list[str]:
    """Modules in the add-on's root may import all others; no folder imports them. `()` is the package itself, which has
    the version."""
    order = [*BELOW, *sections(addon)]
    problems = [
        f"{addon.name}/{folder.name} is no section of registration.py"
        for folder in sorted(addon.iterdir())
        if folder.is_dir() and any(folder.rglob("*.py")) and folder.name not in [*order, "_vendor"]
    ]
    for path in sorted(p for folder in order for p in (addon / folder).rglob("*.py")):
        own = path.relative_to(addon).with_suffix("").parts
        rank = order.index(own[0])
        for line, module in imports(addon, path):
            place = f"{addon.name}/{path.relative_to(addon)}:{line}"
            if isinstance(module, str):
                if is_pure(own) and OF_BLENDER.fullmatch(module.partition(".")[0]):
                    problems.append(f"{place}: a pure module imports {module}, which only Blender has")
            elif not is_there(addon, module):
                problems.append(f"{place}: {'.'.join(module)} is not there")
            elif module and module[0] not in order[: rank + 1]:
                problems.append(f"{place}: {own[0]} imports {'.'.join(module)}, which is not before it")
            elif module and is_pure(own) and PURE.isdisjoint(module):
                problems.append(f"{place}: a pure module imports {'.'.join(module)}, which is not pure")
    return problems


def entry() -> None:
    problems = core_problems() + beside_problems() + device_problems() + header_problems() + addon_problems()
    print(
        "\n".join(problems)
        or "layers: every include and import points upwards, every source includes its own header first"
    )
    sys.exit(bool(problems))


if __name__ == "__main__":
    main(entry)
