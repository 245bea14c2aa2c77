"""Finds the line numbers of tables and keys in a TOML text, which `tomllib` does not report."""

from __future__ import annotations

import re

Path = tuple[str | int, ...]

_WORD = r"""(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')"""
_NAME = rf"{_WORD}(?:\s*\.\s*{_WORD})*"
_HEADER = re.compile(rf"\s*(\[\[?)\s*({_NAME})\s*\]")
_KEY = re.compile(rf"\s*({_NAME})\s*=")


def lines_of(text: str) -> dict[Path, int]:
    """The line number, from 1, of each table and each key by its path, such as ("tool", 0, "diameter"). Keys of inline
    tables have no line of their own."""
    out: dict[Path, int] = {}
    counts: dict[Path, int] = {}
    table: Path = ()
    state = _State()
    for number, line in enumerate(text.splitlines(), 1):
        if not state.inside:
            if header := _HEADER.match(line):
                words = _words(header[2])
                table = _within(words[:-1], counts)
                if header[1] == "[[":
                    name = (*table, words[-1])
                    table = (*name, counts.get(name, 0))
                    counts[name] = counts.get(name, 0) + 1
                else:
                    table = (*table, words[-1])
                out.setdefault(table, number)
                continue
            if key := _KEY.match(line):
                for end in range(1, len(words := _words(key[1])) + 1):
                    out.setdefault((*table, *words[:end]), number)
        state.read(line)
    return out


def _words(name: str) -> list[str]:
    return [word.strip("\"'") for word in re.findall(_WORD, name)]


def _within(words: list[str], counts: dict[Path, int]) -> Path:
    """The path of the tables that a header names; for an array of tables it is the path of the last table so far."""
    path: Path = ()
    for word in words:
        path = (*path, word)
        if path in counts:
            path = (*path, counts[path] - 1)
    return path


class _State:
    """Tracks whether a line begins inside an array or inside a text of several lines."""

    def __init__(self) -> None:
        self.depth = 0
        self.quote = ""

    @property
    def inside(self) -> bool:
        return bool(self.depth or self.quote)

    def read(self, line: str) -> None:
        k = 0
        while k < len(line):
            if self.quote:
                if line[k] == "\\" and self.quote[0] == '"':
                    k += 1
                elif line.startswith(self.quote, k):
                    k += len(self.quote) - 1
                    self.quote = ""
            elif line[k] in "\"'":
                self.quote = line[k] * (3 if line.startswith(line[k] * 3, k) else 1)
                k += len(self.quote) - 1
            elif line[k] == "#":
                break
            else:
                self.depth += (line[k] in "[{") - (line[k] in "]}")
            k += 1
        if len(self.quote) == 1:
            self.quote = ""
