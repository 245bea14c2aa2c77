"""What the demonstration measured, as a table."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field

from rich.console import Console
from rich.table import Table
from riffler import Audit
from riffler.job import Result


@dataclass
class Piece:
    """One stock, from figure to STL."""

    name: str
    tools: str
    rows: dict[str, str] = field(default_factory=dict)
    sound: bool = True

    def note(self, what: str, value: str) -> None:
        self.rows[what] = value


def defects(audit: Audit) -> dict[str, int]:
    """The counts of an audit that a sound mesh has at 0."""
    return {key: count for key, count in dataclasses.asdict(audit).items() if key not in ("components", "volume")}


def describe_audit(audit: Audit) -> str:
    wrong = [f"{count} {key.replace('_', ' ')}" for key, count in defects(audit).items() if count]
    return ", ".join(wrong) if wrong else f"all {len(defects(audit))} counts 0"


def show_operations(result: Result) -> None:
    """The operations of a job: lengths, volumes and times."""
    table = Table(title="Operations of the bust", title_justify="left")
    table.add_column("operation")
    for column in ("tool", "cut, m", "removed, mm³", "on the machine, min", "computed in, s"):
        table.add_column(column, justify="right")
    for done in result.operations:
        of = done.operation.report
        table.add_row(done.job.name, done.job.tool.name, f"{of.cut_mm / 1e3:.1f}", f"{done.removed:,.0f}",
                      f"{of.time_s / 60:.1f}", f"{done.seconds:.1f}")  # fmt: skip
    Console().print(table)


def show(pieces: list[Piece], stages: list[tuple[str, float]], files: list[tuple[str, int]]) -> None:
    console = Console()
    table = Table(title="Recorded strokes, carved and replayed, and a bust", title_justify="left")
    table.add_column("")
    for piece in pieces:
        table.add_column(f"{piece.name}\n{piece.tools}", justify="right")
    for what in dict.fromkeys(key for piece in pieces for key in piece.rows):
        table.add_row(what, *(piece.rows.get(what, "") for piece in pieces))
    console.print(table)
    times = Table(title="Time", title_justify="left")
    times.add_column("stage")
    times.add_column("s", justify="right")
    for stage, seconds in stages:
        times.add_row(stage, f"{seconds:.2f}")
    times.add_section()
    times.add_row("all", f"{sum(seconds for _, seconds in stages):.2f}")
    console.print(times)
    written = Table(title="Files", title_justify="left")
    written.add_column("file")
    written.add_column("kB", justify="right")
    for name, size in files:
        written.add_row(name, f"{size / 1e3:,.0f}")
    console.print(written)
