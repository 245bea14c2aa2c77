"""Collects the documents in out/docs, as they lie in the project, and writes docs/api.md from riffler's docstrings."""

from __future__ import annotations

import inspect
import shutil
from types import ModuleType

from shell import ROOT, main

OUT = ROOT / "out" / "docs"


def signature(thing: object) -> tuple[str, str]:
    """Signature and text of a function. pybind11 writes the signature as the docstring's first line."""
    text = inspect.getdoc(thing) or ""
    name = getattr(thing, "__name__", "")
    first, _, rest = text.partition("\n")
    if first.startswith(f"{name}("):
        return first, rest.strip()
    try:
        return f"{name}{inspect.signature(thing)}", text
    except (TypeError, ValueError):
        return f"{name}(...)", text


def entry_of(name: str, thing: object, level: int) -> list[str]:
    """The Markdown lines of one class, function, module or value."""
    heading = "#" * level
    if inspect.isclass(thing) or isinstance(thing, ModuleType):
        members = getattr(thing, "__all__", None) or [m for m in vars(thing) if not m.startswith("_")]
        lines = [f"{heading} {name}", "", inspect.getdoc(thing) or "", ""]
        for member in members:
            lines += entry_of(member, inspect.getattr_static(thing, member, None) or getattr(thing, member), level + 1)
        return lines
    if isinstance(thing, staticmethod | classmethod):
        thing = thing.__func__
    if isinstance(thing, property):
        return [f"{heading} {name}", "", inspect.getdoc(thing) or "", ""]
    if callable(thing):
        head, text = signature(thing)
        return [f"{heading} {name}", "", f"`{head}`", "", text, ""]
    return [f"{heading} {name}", "", f"`{thing!r}`", ""]


def write_api() -> None:
    import riffler

    lines = ["# riffler: the Python interface", "", inspect.getdoc(riffler) or "", ""]
    for name in riffler.__all__:
        if not name.startswith("__"):
            lines += entry_of(name, getattr(riffler, name), 2)
    (OUT / "docs" / "api.md").write_text("\n".join(lines))


def entry() -> None:
    shutil.rmtree(OUT, ignore_errors=True)
    shutil.copytree(ROOT / "docs", OUT / "docs")
    for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE"):
        shutil.copy(ROOT / name, OUT)
    write_api()
    print(f"docs: collected in {OUT.relative_to(ROOT)}, start at README.md; the Python interface is docs/api.md")


if __name__ == "__main__":
    main(entry)
