"""Tables of a job file: reads values by key, with errors that name file, line, table and key."""

from __future__ import annotations

import difflib
import math
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import files
from . import lines


class JobError(ValueError):
    """An error in a job file. The message names line, table and key, and a remedy."""


class JobFile:
    """A TOML file with the line numbers of its keys. JobError if the text is not valid TOML."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            text = files.read(path).decode()
            self.data = tomllib.loads(text)
        except UnicodeDecodeError as error:
            raise JobError(f"{path.name}: not in UTF-8: {error.reason} at byte {error.start}") from None
        except tomllib.TOMLDecodeError as error:
            raise JobError(f"{path.name}: {error}") from None
        self.lines = lines.lines_of(text)

    @property
    def table(self) -> Table:
        return Table(self, self.data, ())


class Table:
    """One table of a job file. Each method reads one key; `done` raises an error for keys that no method has read."""

    def __init__(self, file: JobFile, data: Mapping[str, Any], path: lines.Path) -> None:
        self.file, self.data, self.path = file, data, path
        self.known: list[str] = []

    @property
    def name(self) -> str:
        """The table's name in messages, such as ``[[tool]] 2``, counted from 1."""
        words = [str(word) for word in self.path if isinstance(word, str)]
        if not words:
            return "the file"
        index = [word for word in self.path if isinstance(word, int)]
        return f"[[{'.'.join(words)}]] {index[-1] + 1}" if index else f"[{'.'.join(words)}]"

    def where(self, key: str = "") -> str:
        """A place in messages, such as ``job.toml, line 12, [stock] pitch``; the table's line if the key has none."""
        path = (*self.path, key) if key else self.path
        while path and path not in self.file.lines:
            path = path[:-1]
        line = f", line {self.file.lines[path]}" if path else ""
        place = f", {self.name}" if self.path else ""
        return f"{self.file.path.name}{line}{place}{' ' if place and key else ', ' if key else ''}{key}"

    def error(self, key: str, message: str) -> JobError:
        return JobError(f"{self.where(key)}: {message}")

    def has(self, key: str) -> bool:
        self.known.append(key)
        return key in self.data

    def missing(self, key: str, example: str) -> JobError:
        return JobError(f"{self.where()}: {key} is missing; add a line such as {key} = {example}")

    def done(self) -> None:
        """JobError for an unknown key; the message names the nearest known key."""
        for key in self.data:
            if key not in self.known:
                near = difflib.get_close_matches(key, self.known, 1, 0.6)
                hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(dict.fromkeys(self.known))}"
                raise self.error(key, f"unknown key; {hint}")

    def number(self, key: str, *, low: float = -math.inf, above: float | None = None) -> float | None:
        """The key's number; None if the table does not have the key."""
        if not self.has(key):
            return None
        return self._number(key, self.data[key], key, low, above)

    def angle(self, key: str) -> float | None:
        """The key's angle in rad; the file has degrees."""
        value = self.number(key)
        return None if value is None else math.radians(value)

    def whole(self, key: str, low: int = 0) -> int | None:
        if not self.has(key):
            return None
        value = self.data[key]
        if isinstance(value, bool) or not isinstance(value, int) or value < low:
            raise self.error(key, f"a whole number from {low} expected, not {value!r}")
        return value

    def flag(self, key: str) -> bool | None:
        if not self.has(key):
            return None
        if not isinstance(self.data[key], bool):
            raise self.error(key, f"true or false expected, not {self.data[key]!r}")
        return self.data[key]

    def text(self, key: str, choices: Iterable[str] = ()) -> str | None:
        if not self.has(key):
            return None
        value, known = self.data[key], list(choices)
        if not isinstance(value, str) or not value:
            raise self.error(key, f"a text in quotes expected, not {value!r}")
        if known and value not in known:
            near = difflib.get_close_matches(value, known, 1, 0.6)
            raise self.error(
                key, f"{', '.join(known)} expected, not {value!r}{f'; did you mean {near[0]}?' if near else ''}"
            )
        return value

    def file_name(self, key: str, suffixes: Sequence[str], *, exists: bool = True) -> Path | None:
        """The path of a file; relative names start from the folder of the job file."""
        text = self.text(key)
        if text is None:
            return None
        path = self.file.path.parent / text
        if path.suffix.lower() not in suffixes:
            raise self.error(key, f"{text}: a file that ends with {' or '.join(suffixes)} expected")
        if exists and not path.is_file():
            raise self.error(key, f"no such file: {path}; names are taken from the job file's folder")
        if not exists and not path.parent.is_dir():
            raise self.error(key, f"there is no folder {path.parent}; make it first")
        return path

    def vector(self, key: str, size: int) -> NDArray[np.float64] | None:
        if not self.has(key):
            return None
        return self._vector(key, self.data[key], size)

    def rows(self, key: str, size: int) -> NDArray[np.float64] | None:
        """The key's list of lists of ``size`` numbers, as an array."""
        if not self.has(key):
            return None
        value = self.data[key]
        if not isinstance(value, list):
            raise self.error(key, f"a list of lists of {size} numbers expected")
        return np.array([self._vector(key, row, size) for row in value]).reshape(-1, size)

    def sub(self, key: str) -> Table | None:
        """A table within this one."""
        if not self.has(key):
            return None
        if not isinstance(self.data[key], dict):
            raise self.error(key, f"a table expected: write a line [{'.'.join(map(str, (*self.path, key)))}]")
        return Table(self.file, self.data[key], (*self.path, key))

    def subs(self, key: str) -> list[Table]:
        """The tables of an array, ``[[key]]``."""
        if not self.has(key):
            return []
        value = self.data[key]
        if not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
            raise self.error(key, f"tables expected, each after a line [[{key}]]")
        return [Table(self.file, one, (*self.path, key, k)) for k, one in enumerate(value)]

    def _number(self, key: str, value: Any, what: str, low: float = -math.inf, above: float | None = None) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise self.error(key, f"{'a number' if what == key else what} expected, not {value!r}")
        if above is not None and not value > above:
            raise self.error(key, f"must be more than {above:g}, not {value:g}")
        if value < low:
            raise self.error(key, f"must be at least {low:g}, not {value:g}")
        return float(value)

    def _vector(self, key: str, value: Any, size: int) -> NDArray[np.float64]:
        if not isinstance(value, list) or len(value) != size:
            raise self.error(key, f"{size} numbers expected, as in [{', '.join(['0'] * size)}], not {value!r}")
        return np.array([self._number(key, one, f"{size} numbers") for one in value])
