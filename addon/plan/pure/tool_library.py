"""Tool libraries: the presets, and files (*.json, *.toml) in folders. A file holds one tool, in the form of
riffler.Tool.to_dict, or several: a list in JSON, [[tools]] in TOML.

A bad file affects neither the others nor a displayed list: its error is returned together with the tools.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path

from riffler import files

from ...common import json_object, presets

SUFFIXES = (".json", ".toml")
_TOML_TABLE = re.compile(r"^\s*\[\[\s*tools\s*\]\]", re.MULTILINE)


@dataclass(frozen=True)
class Entry:
    """A tool of a library; `path` is None for the presets."""

    tool: dict
    path: Path | None = None

    @property
    def name(self) -> str:
        return self.tool["name"]


def shipped() -> list[Entry]:
    return [Entry(tool) for tool in presets.presets()]


def scan(folder: Path, make_tool) -> tuple[list[Entry], list[str]]:
    """The tools of a folder's files by file name, and a line for each file that could not be read. `make_tool` makes a
    tool from a dictionary and raises ValueError if it cannot."""
    try:
        found = sorted(p for p in Path(folder).iterdir() if p.suffix.lower() in SUFFIXES and not p.name.startswith("."))
    except OSError as error:
        return [], [f"{folder}: {error.strerror}"]
    entries, problems = [], []
    for path in found:
        try:
            entries += read(path, make_tool)
        except ValueError as error:
            problems.append(str(error))
    return entries, problems


def read(path, make_tool) -> list[Entry]:
    """The tools of one file. ValueError names the file, the line, and the problem."""
    path = Path(path)
    try:
        text = files.read(path).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{path.name}: byte {error.start} is not UTF-8") from None
    except ValueError as error:
        raise ValueError(f"{error}: choose a tool file in {path.parent}") from None
    rows = _toml(text, path) if path.suffix.lower() == ".toml" else _json(text, path)
    if not rows:
        raise ValueError(f"{path.name}: there is no tool in it")
    return [Entry(_tool(row, f"{path.name}, line {line}", path.stem, make_tool), path) for row, line in rows]


def find(entries: list[Entry], name: str) -> Entry:
    for entry in entries:
        if entry.name == name:
            return entry
    where = entries[0].path.name if entries and entries[0].path else "the presets"
    raise ValueError(f"{where}: there is no tool {name!r}, only {', '.join(e.name for e in entries)}")


def write(folder, tool: dict) -> Path:
    """Writes a tool into a folder, which is made if needed, as a file named after it. The file is written whole or not
    at all; an existing one is overwritten only if it holds a tool of the same name. ValueError with the remedy if it
    cannot be written."""
    target = Path(folder) / f"{file_name(tool['name'])}.json"
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.exists() and not _holds(target, tool["name"]):
            raise ValueError(f"{target} is there already: give the tool another name")
        files.write(target, (json.dumps(tool, indent=1, ensure_ascii=False) + "\n").encode())
    except OSError as error:
        raise ValueError(f"{folder}: {error.strerror}: choose a folder that can be written") from None
    except RuntimeError as error:
        raise ValueError(f"{folder}: {error}: choose a folder that can be written") from None
    return target


def file_name(name: str) -> str:
    """A tool's file name, valid on any file system."""
    return "".join(c if c.isalnum() or c in " -_.°" else "_" for c in name).strip(" .") or "tool"


def _holds(path: Path, name: str) -> bool:
    try:
        return json_object.loads(files.read(path), path.name)["name"] == name
    except (ValueError, KeyError):
        return False


def _tool(row, place: str, name: str, make_tool) -> dict:
    if not isinstance(row, dict):
        raise ValueError(f"{place}: a tool, a table of its sizes, expected")
    row = {"name": name, **row}  # the tool in a file of one may have the file's name
    if not isinstance(row["name"], str) or not row["name"]:
        raise ValueError(f"{place}: name: a text expected")
    try:
        make_tool(row)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{place}: {str(error).splitlines()[0]}") from None
    return row


def _json(text: str, path: Path) -> list[tuple[object, int]]:
    """Each tool with its line."""
    try:
        data = json.loads(text, parse_constant=_no_constant)
        if isinstance(data, list):
            return list(zip(data, _lines_of_elements(text), strict=True))
        return [(data, 1 + text.count("\n", 0, _past_space(text, 0)))]
    except json.JSONDecodeError as error:
        raise ValueError(f"{path.name}, line {error.lineno}: {error.msg}") from None
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path.name}: {error}") from None


def _no_constant(name: str):
    raise ValueError(f"{name} is not a number in JSON")


def _lines_of_elements(text: str) -> list[int]:
    """The lines on which the elements of a list begin. The text is valid: it has been parsed."""
    decode = json.JSONDecoder().raw_decode
    at = _past_space(text, 0) + 1
    lines = []
    while text[at := _past_space(text, at)] != "]":
        lines.append(1 + text.count("\n", 0, at))
        _, at = decode(text, at)
        at = _past_space(text, at)
        at += text[at] == ","
    return lines


def _past_space(text: str, at: int) -> int:
    while at < len(text) and text[at] in " \t\r\n":
        at += 1
    return at


def _toml(text: str, path: Path) -> list[tuple[object, int]]:
    import tomllib  # Python 3.11; few users have such files

    try:
        data = tomllib.loads(text)
    except RecursionError:
        raise ValueError(f"{path.name}: thousands of brackets in each other") from None
    except ValueError as error:  # its text ends with line and column
        raise ValueError(f"{path.name}: {error}") from None
    if "tools" not in data:
        return [(data, 1)] if data else []
    listed = data["tools"] if isinstance(data["tools"], list) else [data["tools"]]
    lines = [1 + text.count("\n", 0, m.end()) for m in _TOML_TABLE.finditer(text)]
    return list(zip(listed, lines, strict=True)) if len(lines) == len(listed) else [(tool, 1) for tool in listed]
