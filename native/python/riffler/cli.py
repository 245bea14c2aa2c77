"""The command line: ``riffler``, or ``python -m riffler``.

Exit status: 0; 1 if a check failed; 2 for bad input; 130 after Ctrl-C. After an error no file is written; the error is
one line on stderr or, with ``--json``, ``{"error": …}`` on stdout.
"""

from __future__ import annotations

import os
import sys
import traceback

from . import Cancelled, __version__
from .command import verbs
from .command.console import Console


def main(argv: list[str] | None = None) -> int:
    """Runs one command; returns the exit status."""
    argv = sys.argv[1:] if argv is None else list(argv)
    console = Console(json_output="--json" in argv)
    try:
        status = dispatch(argv, console)
        sys.stdout.flush()
        return status
    except (KeyboardInterrupt, Cancelled):
        done = f"after {console.written} was written" if console.written else "nothing was written"
        console.error(f"interrupted, {done}")
        return 130
    except BrokenPipeError:
        # The reader has closed our output; keep the interpreter from reporting this at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        if os.environ.get("RIFFLER_TRACEBACK"):
            traceback.print_exc()
        console.error(explain(error))
        return 2


def dispatch(words: list[str], console: Console) -> int:
    """Finds the verb and runs it. For an old name, a note on stderr gives the new one."""
    if words[:1] == ["--version"]:
        console.result({"riffler": __version__}, f"riffler {__version__}", [])
        return 0
    found = verbs.find(words)
    if found.verb is None:
        print(found.help)
        return 0
    if found.old:
        console.warning(f"riffler {found.old} is an old name of riffler {found.verb.path}")
    return found.verb.run(found.rest, console)


def explain(error: Exception) -> str:
    """The error as one line."""
    if isinstance(error, MemoryError):
        return "out of memory; take a coarser pitch or a smaller part"
    if isinstance(error, OSError) and error.strerror:
        return f"{os.path.basename(error.filename)}: {error.strerror}" if error.filename else error.strerror
    if isinstance(error, ValueError | RuntimeError | OSError):
        return str(error)
    return f"{type(error).__name__}: {error} (a defect of riffler: RIFFLER_TRACEBACK=1 shows where)"
