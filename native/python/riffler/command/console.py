"""Output of commands: a table or JSON on stdout, progress bars and errors on stderr."""

from __future__ import annotations

import io
import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .. import files

Rows = list[tuple[str, str]]


class Console:
    """Results go to stdout, everything else to stderr; with ``--json`` stdout gets one JSON object, result or error."""

    def __init__(self, json_output: bool) -> None:
        self.json_output = json_output
        self.seconds: dict[str, float] = {}
        self.written: str | None = None
        for stream in (sys.stdout, sys.stderr):
            # A terminal without Unicode shows "?" for "³" instead of failing.
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="replace")

    def error(self, message: str) -> None:
        line = " ".join(message.split())
        if self.json_output:
            self._print_json({"error": line})
        else:
            print(f"riffler: {line}", file=sys.stderr)

    def warning(self, message: str) -> None:
        """Prints a note that is not an error on stderr, also with ``--json``."""
        print(f"riffler: {message}", file=sys.stderr)

    def announce(self, message: str) -> None:
        """Prints what is about to happen, if progress is shown."""
        if self._shows_progress():
            print(f"riffler: {message}", file=sys.stderr)

    def result(self, data: Mapping[str, Any], title: str, rows: Rows) -> None:
        """Prints ``data`` as JSON or ``rows`` as a table."""
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

    def table(self, title: str, heads: Iterable[str], rows: Iterable[Iterable[str]], notes: Iterable[str] = ()) -> None:
        """Prints a table of many columns; nothing with ``--json``."""
        if self.json_output:
            return
        from rich import box
        from rich.console import Console as Rich
        from rich.table import Table
        from rich.text import Text

        table = Table(title=Text(title, style="bold"), title_justify="left", box=box.SIMPLE_HEAD, padding=(0, 1))
        for index, head in enumerate(heads):
            table.add_column(Text(head), justify="right" if index else "left", overflow="fold")
        for row in rows:
            table.add_row(*map(Text, row))
        # In a file or a pipe a table is as wide as it needs.
        screen = Rich(file=sys.stdout, highlight=False, width=None if sys.stdout.isatty() else 240)
        screen.print(table)
        for note in notes:
            screen.print(Text(note, style="dim"))
        sys.stdout.flush()

    @contextmanager
    def step(self, name: str) -> Iterator[Callable[[float], None] | None]:
        """Times a step of the work. Yields a callable for its ``progress=``, or None if stderr is not a terminal that
        can redraw a line."""
        start = time.perf_counter()
        if self._shows_progress():
            from rich.console import Console as Rich
            from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

            columns = TextColumn("{task.description:<8}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
            with Progress(*columns, console=Rich(stderr=True), transient=True) as bar:
                task = bar.add_task(name, total=1.0)
                yield lambda share: bar.update(task, completed=share)
        else:
            yield None
        self.seconds[name] = round(time.perf_counter() - start, 6)

    @contextmanager
    def writing(self, out: Path) -> Iterator[Path]:
        """Yields a path to write to. The file there becomes `out` at the end; an error or Ctrl-C removes it.

        The library's writers leave no partial file either, but Python sees a Ctrl-C only after they have returned.
        """

        def written() -> None:
            self.written = out.name

        with files.drafting(out, written) as beside:
            yield beside

    @staticmethod
    def _shows_progress() -> bool:
        return sys.stderr.isatty() and os.environ.get("TERM") not in ("dumb", "unknown")

    @staticmethod
    def _print_json(data: Mapping[str, Any]) -> None:
        json.dump(data, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
        sys.stdout.write("\n")
        sys.stdout.flush()


def number(value: float, unit: str = "") -> str:
    """A number with thin spaces between thousands and at most three decimals: 177 055.254 mm³."""
    text = f"{value:,.3f}".rstrip("0").rstrip(".") if isinstance(value, float) else f"{value:,}"
    return text.replace(",", "\u2009") + (f" {unit}" if unit else "")


def times(seconds: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {value:.3f} s" for name, value in seconds.items())
