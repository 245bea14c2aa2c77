"""What a job hands back: tables of raw figures, which become Markdown, a table on the screen and JSON."""

from __future__ import annotations

import datetime
import os
import platform
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from riffler import __version__
from riffler.command.doctor import cpu

Row = Mapping[str, Any]


@dataclass(frozen=True)
class Column:
    """How one column comes from a row of raw figures; a row that lacks them has an empty cell there."""

    head: str
    key: str
    form: Callable[[Any], str] = str

    def cell(self, row: Row) -> str:
        value = row.get(self.key)
        return "" if value is None else self.form(value)


@dataclass
class Section:
    """One table. ``rows`` are raw figures in the units that their names say."""

    name: str
    title: str
    columns: list[Column]
    rows: list[dict[str, Any]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def row(self, **figures: Any) -> dict[str, Any]:
        self.rows.append({k: v.item() if isinstance(v, np.generic) else v for k, v in figures.items()})
        return self.rows[-1]

    def cells(self) -> list[list[str]]:
        return [[column.cell(row) for column in self.columns] for row in self.rows]

    def markdown(self) -> str:
        """The table under its title; lines that documents take over stand between the marks of its name."""
        lines = ["| " + " | ".join(c.head for c in self.columns) + " |", "|" + "---|" * len(self.columns)]
        lines += ["| " + " | ".join(cells) + " |" for cells in self.cells()]
        for note in self.notes:
            lines += ["", note]
        return "\n".join(lines) + "\n"


@dataclass
class Report:
    """``problems`` are failed checks of correctness, never of time: machines differ."""

    job: str
    settings: dict[str, Any] = field(default_factory=dict)
    sections: list[Section] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)

    def section(self, name: str, title: str, *columns: Column) -> Section:
        self.sections.append(Section(name, title, list(columns)))
        return self.sections[-1]

    def check(self, good: bool, problem: str) -> None:
        if not good:
            self.problems.append(problem)

    def markdown(self, about: Mapping[str, Any]) -> str:
        head = f"# {self.job}\n\n<!-- bench {self.job}/about -->\n{describe(about)}\n<!-- end -->\n"
        parts = [
            f"\n## {s.title}\n\n<!-- bench {self.job}/{s.name} -->\n{s.markdown()}<!-- end -->\n" for s in self.sections
        ]
        bad = [f"\n**Failed:** {problem}\n" for problem in self.problems]
        return head + "".join(parts + bad)

    def data(self, about: Mapping[str, Any]) -> dict[str, Any]:
        sections = {s.name: {"title": s.title, "rows": s.rows, "notes": s.notes} for s in self.sections}
        return {"job": self.job, **about, "settings": self.settings, "problems": self.problems, "sections": sections}


def about() -> dict[str, Any]:
    """The machine and the version, without the machine's name."""
    processor = cpu()
    return {
        "riffler": __version__,
        "commit": commit(),
        "date": datetime.date.today().isoformat(),
        "processor": processor["model"],
        "instruction_set": processor["instruction_set"],
        "cores": len(os.sched_getaffinity(0)),
        "system": platform.platform(),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def describe(about: Mapping[str, Any]) -> str:
    version = f"riffler {about['riffler']}" + (f" ({about['commit']})" if about["commit"] else "")
    machine = f"{about['processor']}, {about['instruction_set']}, {about['cores']} cores"
    return f"{version}, {machine}, Python {about['python']}, {about['date']}"


def checkout() -> Path | None:
    """The checkout that holds this package or the working directory."""
    for folder in (Path(__file__).resolve().parents[2], Path.cwd()):
        if (folder / "native" / "bench").is_dir() and (folder / "addon").is_dir():
            return folder
    return None


def commit() -> str | None:
    """That of the checkout; None elsewhere."""
    folder = checkout()
    if folder is None or not (folder / ".git").exists():
        return None
    command = ["git", "-C", str(folder), "describe", "--always", "--dirty", "--exclude=*"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:
        return None
    return done.stdout.strip() or None


# ---- how figures are written


def micro(seconds: float) -> str:
    """A time of any size in a unit that suits it."""
    for factor, unit in ((1, "s"), (1e3, "ms"), (1e6, "µs")):
        if seconds * factor >= 0.9995:
            return f"{three(seconds * factor)} {unit}"
    return f"{seconds * 1e9:.0f} ns"


def three(value: float) -> str:
    """Three digits, without a power of ten."""
    return f"{value:.0f}" if abs(value) >= 99.95 else f"{value:.3g}"


def ratio(value: float) -> str:
    return f"{three(value)} ×"


def mm(value: float) -> str:
    return f"{value:.2g}"


def percent(value: float) -> str:
    return f"{100 * value:+.3f} %"


def mega(count: float) -> str:
    return f"{three(count / 1e6)} M"


def megabytes(count: float) -> str:
    return f"{three(count / 1e6)} MB"


def grouped(count: float) -> str:
    """A large number in groups of three digits."""
    return f"{count:,.0f}".replace(",", " ")


def pitch(value: float) -> str:
    return f"{value:g}"
