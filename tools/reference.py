"""The Python interface as Markdown, one page a topic, from the docstrings of what is public."""

from __future__ import annotations

import ast
import dataclasses
import importlib
import inspect
import itertools
import re
import textwrap
from pathlib import Path
from types import ModuleType

from shell import StepError

# Page: title, and what is on it. Every public name of riffler stands on exactly one, which `write` checks.
PAGES = {
    "volumes": ("Volumes", ["Volume", "Cut", "Smoothed", "Brushed", "falloff", "Snapshot", "VolumeReport",
                            "SurfaceReport", "VolumeCounters", "History", "HistoryStroke", "HistoryStats"]),
    "tools": ("Tools", ["Tool", "ToolShape", "ToolSize"]),
    "meshes": ("Meshes", ["Mesh", "Audit", "Orientation", "Mesher", "Patch", "Hit", "Hits", "FrozenSurface",
                          "Surface", "PickCounters", "shape", "cad"]),
    "contact": ("Contact", ["Collider", "Contact", "Nearest"]),
    "planning": ("Planning", ["plan", "job"]),
    "programs": ("Programs and verification", ["Program", "ProgramStream", "Note", "WriteReport", "PolePassage",
                                               "machines", "machine_options", "MachineOption", "machine_texts",
                                               "MachineTexts", "verify",
                                               "Verification", "VerifyReport", "VerifyStats", "Finding", "Material",
                                               "cluster"]),
    "sessions": ("Sessions and journals", ["Session", "SessionFrame", "OrientSession", "OrientFrame",
                                           "KeyChange", "Trip", "Journal", "JournalStock",
                                           "JournalStroke", "JournalWriter"]),
    "pens": ("Pens", ["pen"]),
    "calls": ("Long calls, threads, errors", ["submit", "Future", "tasks", "threads", "set_threads", "Cancelled",
                                              "FormatError"]),
}  # fmt: skip

# What pybind11 writes for arguments that Python converts, in the caller's words.
PLAIN = [
    (r"typing\.Annotated\[numpy\.typing\.ArrayLike, [\w.]+(, \"[^\"]*\")?\]", "array"),
    (r"typing\.Supports(Float|Int|Index)( \| typing\.Supports(Float|Int|Index))*", lambda m: m[1].lower()),
    (r"\bindex\b(?= [=|,)])", "int"),
    (r"numpy\.typing\.NDArray\[[\w.]+\]", "array"),
    (r"collections\.abc\.", ""),
    (r"riffler\._core\.", ""),
    (r"typing_extensions\.", ""),
    (r"typing\.", ""),
    (r"\(self: \w+(, )?", "("),
]


def signature(name: str, thing: object) -> tuple[str, str]:
    """Signature and text of a function. pybind11 writes the signature as the docstring's first line."""
    text = inspect.getdoc(thing) or ""
    first, _, rest = text.partition("\n")
    if first.startswith(f"{name}("):
        for pattern, plain in PLAIN:
            first = re.sub(pattern, plain, first)
        return first, rest.strip()
    try:
        return f"{name}{inspect.signature(thing)}", text
    except (TypeError, ValueError):
        return f"{name}(…)", text


def folded(head: str) -> str:
    """A long signature with an argument a line; commas within brackets do not end one."""
    if len(head) <= 100:
        return head
    opening, depth, lines = head.index("(") + 1, 0, [""]
    closing = head.rindex(")", 0, head.rfind(" -> ") if " -> " in head else len(head))
    for letter in head[opening:closing]:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            lines.append("")
        else:
            lines[-1] += letter
    return "\n".join([head[:opening], *(f"    {line.strip()}," for line in lines), head[closing:]])


def prose(text: str) -> list[str]:
    """A docstring's text as Markdown: what ``::`` opens is indented as code is; the sections of a numpy docstring are
    lists, its examples are code."""
    out: list[str] = []
    section = ""
    lines = text.splitlines()
    for k, line in enumerate(lines):
        rule = lines[k + 1] if k + 1 < len(lines) else ""
        if rule.startswith("---") and re.fullmatch(r"[A-Z][a-z]+", line):
            section = line
            out += [f"**{line}**", "", *(["```python"] if line == "Examples" and has_code(lines[k + 2 :]) else [])]
        elif line.startswith("---") and k and lines[k - 1] == section:
            continue
        elif section == "Examples" or not section:
            out.append(re.sub(r"::$", ":", line))
        elif line and not line.startswith(" "):
            name, colon, kind = line.partition(" : ")
            out.append(f"- `{name}`{': ' * bool(colon)}{kind}  ")
        else:
            out.append(f"  {line.strip()}" if line else "")
    if section == "Examples" and has_code(lines):
        out.append("```")
    return [*out, ""]


def has_code(lines: list[str]) -> bool:
    return any(line.startswith(">>> ") for line in lines)


def fields_of(cls: type) -> list[str]:
    """A dataclass's or named tuple's attributes, with the text that stands below each in its source."""
    body = ast.parse(textwrap.dedent(inspect.getsource(cls))).body[0]
    assert isinstance(body, ast.ClassDef)
    out = []
    for field, text in itertools.pairwise([*body.body, ast.Pass()]):
        if isinstance(field, ast.AnnAssign):
            says = isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
            out.append(f"- `{ast.unparse(field.target)}`: {inspect.cleandoc(str(text.value.value)) if says else ''}")
    return [*out, ""] if out else []


def members_of(thing: type | ModuleType) -> list[str]:
    """A module without ``__all__`` has what it defines itself, not what it imports."""
    public = [name for name, value in vars(thing).items() if not name.startswith("_") and not is_old(value)]
    if inspect.isclass(thing) and (dataclasses.is_dataclass(thing) or issubclass(thing, tuple)):
        public = [name for name in public if callable(vars(thing)[name]) and name not in dir(tuple)]
    if isinstance(thing, ModuleType):
        own = [name for name in public if getattr(vars(thing)[name], "__module__", None) == thing.__name__]
        return list(getattr(thing, "__all__", own))
    return public


def is_old(value: object) -> bool:
    """Old names are in no document."""
    return type(value).__name__ == "OldAttribute"


def entry_of(name: str, thing: object, level: int, within: str = "") -> list[str]:
    """The Markdown lines of one class, function, module or value."""
    heading = f"{'#' * min(level, 5)} {within}{name}"
    if inspect.isclass(thing) or isinstance(thing, ModuleType):
        lines = [heading, "", *prose(inspect.getdoc(thing) or "")]
        prefix = f"{name}." if inspect.isclass(thing) else ""
        if inspect.isclass(thing) and (dataclasses.is_dataclass(thing) or issubclass(thing, tuple)):
            lines += fields_of(thing)
        plain = []
        for member in members_of(thing):
            found = inspect.getattr_static(thing, member, None)
            found = getattr(thing, member) if found is None else found
            if isinstance(found, property) and not inspect.getdoc(found):
                plain.append(f"`{member}`")
            else:
                lines += entry_of(member, found, level + 1, prefix)
        return [*lines, *([f"What speaks for itself: {', '.join(plain)}.", ""] if plain else [])]
    if isinstance(thing, staticmethod | classmethod):
        thing = thing.__func__
    if isinstance(thing, property):
        return [heading, "", *prose(inspect.getdoc(thing) or "")]
    if callable(thing):
        head, text = signature(name, thing)
        return [heading, "", "```python", folded(head), "```", "", *prose(text)]
    return [heading, "", f"`{thing!r}`", ""]


def write(folder: Path) -> int:
    """Writes the pages and their index; the number of names on them."""
    import riffler

    public = {name for name in riffler.__all__ if not name.startswith("__")}
    placed = [name for _, names in PAGES.values() for name in names if not name.startswith("riffler.")]
    if sorted(placed) != sorted(public):
        odd = sorted(set(placed) ^ public) or sorted({n for n in placed if placed.count(n) > 1})
        raise StepError(f"tools/reference.py: {odd[0]!r} must stand on exactly one page, and be public")
    folder.mkdir(parents=True)
    index = ["# Reference", "", *prose(inspect.getdoc(riffler) or ""), "| page | names |", "|---|---|"]
    for page, (title, names) in PAGES.items():
        lines = [f"# {title}", ""]
        for name in names:
            thing = importlib.import_module(name) if name.startswith("riffler.") else getattr(riffler, name)
            shown = thing.__name__ if isinstance(thing, ModuleType) else name
            lines += entry_of(shown, thing, 2)
        (folder / f"{page}.md").write_text("\n".join(lines))
        listed = ", ".join(f"`{name.removeprefix('riffler.')}`" for name in names)
        index.append(f"| [{title}]({page}.md) | {listed} |")
    (folder / "index.md").write_text("\n".join([*index, ""]))
    return len(placed)
