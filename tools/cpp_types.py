"""What the C++ sources say at the scope of a namespace, and which types they define there. Reads text, not a
compiler's tree: the sources are formatted by clang-format, and no macro of theirs opens a scope, but for Highway's
HWY_NAMESPACE."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

# Not code: literals, comments, lines of the preprocessor.
NO_CODE = re.compile(
    r'R"(?P<tag>[^()\s\\]{0,16})\(.*?\)(?P=tag)"'
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|(?<![0-9a-fA-F])'(?:[^'\\\n]|\\.)+'"
    r"|//[^\n]*|/\*.*?\*/"
    r"|^[ \t]*#(?:[^\n\\]|\\.)*",
    re.S | re.M,
)
TEMPLATE = re.compile(r"\s*template\s*<(?:[^<>]|<[^<>]*>)*>")
NAMESPACE = re.compile(r"\s*(?:inline\s+)?namespace(?:\s+([\w:]+))?\s*$")
TYPE = re.compile(
    r"\s*(?:class|struct|union|enum(?:\s+class|\s+struct)?)\s+(?:alignas\([^)]*\)\s+)?"
    r"([\w:]+)\s*(?:final\b\s*)?(?::.*)?$",
    re.S,
)
ALIAS = re.compile(r"\s*using\s+(\w+)\s*=")


def statements(text: str) -> Iterator[tuple[list[str], str, str]]:
    """Each statement, and each head of a block, outside of classes and functions: the names of the namespaces around it
    ("" for unnamed ones), its text, and `;` or `{`. Heads of namespaces are left out."""
    code = NO_CODE.sub(" ", text)
    scopes: list[str | None] = []  # of each open brace the namespace; None if it is not a namespace
    start = 0
    for at, char in enumerate(code):
        if char not in "{};":
            continue
        head = code[start:at]
        start = at + 1
        if char == "}":
            if scopes:
                scopes.pop()
        elif char == "{" and (match := NAMESPACE.match(head)):
            scopes.append(match[1] or "")
        else:
            if None not in scopes:
                yield [scope for scope in scopes if scope is not None], head, char
            if char == "{":
                scopes.append(None)


def defined(text: str) -> Iterator[tuple[str, str]]:
    """Namespace and name of each type and alias that `text` defines outside of unnamed namespaces, classes and
    functions. Specialisations of templates are not new types."""
    for spaces, head, char in statements(text):
        match = (ALIAS if char == ";" else TYPE).match(TEMPLATE.sub("", head))
        if match and "" not in spaces and "::" not in match[1]:
            yield "::".join(spaces), match[1]


def definitions(folder: Path) -> dict[str, list[str]]:
    """Files of `folder`, relative to it, by the qualified name of each type that they define."""
    found: dict[str, list[str]] = {}
    for path in sorted(folder.rglob("*.?pp")):
        for space, name in defined(path.read_text()):
            found.setdefault(f"{space}::{name}", []).append(str(path.relative_to(folder)))
    return found
