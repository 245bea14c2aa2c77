"""What a command says: a table or JSON on stdout, progress bars and errors on stderr."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

Rows = list[tuple[str, str]]


class Console:
    """Results go to stdout, everything else to stderr; with ``--json`` stdout is one JSON object, errors too."""

    def __init__(self, json_output: bool) -> None:
        self.json_output = json_output
        self.seconds: dict[str, float] = {}
        for stream in (sys.stdout, sys.stderr):
            # A terminal without Unicode shows "?" for "³" instead of failing.
            if hasattr(stream, "reconfigure"):
                stream.reconfigure(errors="replace")

    def error(self, message: str) -> None:
        line = " ".join(message.split())
        if self.json_output:
            self._print_json({"error": line})
        else:
            print(f"riffler: {line}", file=sys.stderr)

    def result(self, data: Mapping[str, Any], title: str, rows: Rows) -> None:
        """``data`` as JSON or ``rows`` as a table."""
        if self.json_output:
            self._print_json(data)
            return
        from rich.console import Console as Rich
        from rich.table import Table
        from rich.text import Text

        table = Table(
            title=Text(title, style="bold"), title_justify="left", show_header=False, box=None, padding=(0, 2)
        )
        table.add_column(style="cyan", no_wrap=True)
        table.add_column(overflow="fold")
        for name, value in rows:
            table.add_row(Text(name), Text(value))
        Rich(file=sys.stdout, highlight=False).print(table)

    @contextmanager
    def step(self, name: str) -> Iterator[Callable[[float], None] | None]:
        """Times a step of the work; yields the callable that its ``progress=`` wants, or None where nobody watches."""
        start = time.perf_counter()
        if sys.stderr.isatty():
            from rich.console import Console as Rich
            from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

            columns = TextColumn("{task.description:<8}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
            with Progress(*columns, console=Rich(stderr=True), transient=True) as bar:
                task = bar.add_task(name, total=1.0)
                yield lambda share: bar.update(task, completed=share)
        else:
            yield None
        self.seconds[name] = round(time.perf_counter() - start, 6)

    @staticmethod
    def _print_json(data: Mapping[str, Any]) -> None:
        json.dump(data, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
        sys.stdout.write("\n")
        sys.stdout.flush()


def number(value: float, unit: str = "") -> str:
    """With thin spaces between thousands and three decimals at most: 177 055.254 mm³."""
    text = f"{value:,.3f}".rstrip("0").rstrip(".") if isinstance(value, float) else f"{value:,}"
    return text.replace(",", "\u2009") + (f" {unit}" if unit else "")


def times(seconds: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {value:.3f} s" for name, value in seconds.items())
