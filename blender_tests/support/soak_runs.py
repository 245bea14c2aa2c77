"""The long-running tests: strokes and walks through the history, and operators with random settings.

Short in every run of the tests; `run.py --soak` (`make soak`) runs them alone and long. The strokes' process ends as
Blender does, not by os._exit: a crash at exit is a failure.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import partial
from importlib import metadata
from pathlib import Path

from support import environments
from support.environments import Environment

HERE = Path(__file__).resolve().parent.parent / "soak"
STROKES = {(3, 4), (4, 5)}  # the Blenders used: the oldest, and the one in the middle
FUZZED = {(4, 5)}
LIBRARIES = ("hypothesis", "sortedcontainers")  # pure Python, so that any Blender can run them
SHORT = {"strokes": 500, "undos": 60, "examples": 30}
REPEATED = 150  # strokes of a short run in all but the oldest Blender
LONG = {"strokes": 10_000, "undos": 1000, "examples": 1000}
LIMITS = {False: 900, True: 4 * 3600}  # s for one process of a short run, and of a long one


def add_arguments(parser) -> None:
    parser.add_argument("--soak", action="store_true", help="the long runs only")
    parser.add_argument("--strokes", type=int, help="of a run of strokes")
    parser.add_argument("--undos", type=int, help="steps through the history meanwhile")
    parser.add_argument("--examples", type=int, help="of operators with random settings")
    parser.add_argument("--seed", type=int, default=1, help="of the strokes, and of a long run's examples")


def runs(bench, arguments) -> list[Callable[[], None]]:
    """The processes to be run, in any order."""
    chosen = dict(LONG if arguments.soak else SHORT)
    chosen |= {key: value for key in chosen if (value := getattr(arguments, key)) is not None}
    chosen |= {"seed": arguments.seed, "long": arguments.soak}
    short = arguments.strokes is None and not arguments.soak
    again = {**chosen, "strokes": REPEATED} if short else chosen
    return [
        partial(_run, bench, environment, name, chosen if environment.version[:2] == min(STROKES) else again)
        for environment in environments.find()
        if arguments.blender in environment.name and not environment.missing
        for name in _files(environment)
        if arguments.only in f"soak {name}"
    ]


def _run(bench, environment, name, chosen) -> None:
    with tempfile.TemporaryDirectory() as folder:
        if name == "fuzz.py":
            for library in LIBRARIES:
                _lend(library, Path(folder))
        more = {"paths": [*bench.paths, folder], "soak": chosen, "only": "", "leave": name == "strokes.py"}
        bench.run(environment, "source", [HERE / name], more, LIMITS[chosen["long"]])


def _files(environment: Environment) -> list[str]:
    kind = environment.version[:2]
    return ["strokes.py"] * (kind in STROKES) + ["fuzz.py"] * (kind in FUZZED)


def _lend(name: str, folder: Path) -> None:
    """Makes a library of this Python available to Blender's."""
    found = metadata.distribution(name)
    for top in {file.parts[0] for file in found.files if file.parts[0] not in ("..", "__pycache__")}:
        (folder / top).symlink_to(found.locate_file(top))
