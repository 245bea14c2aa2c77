"""What the command ``riffler bench`` does; its arguments are in riffler/command/bench.py."""

from __future__ import annotations

import argparse
import json
import shutil
from pathlib import Path
from typing import Any

from riffler.command.console import Console

from . import report
from .jobs import JOBS
from .measure import Settings


def run(arguments: argparse.Namespace, console: Console) -> int:
    for name in arguments.jobs:
        if name not in JOBS:
            raise ValueError(f"no job {name!r}; there are {', '.join(JOBS)}")
    names = list(dict.fromkeys(arguments.jobs)) or list(JOBS)
    drawing = None if arguments.no_plots else plotting(console)
    out = Path(arguments.out)
    if arguments.redraw:
        return redraw(out, names, drawing, console)
    given = {key: Path(value) for key in ("models", "rivals", "programs") if (value := getattr(arguments, key))}
    # Not resolved: an environment's Python is a link.
    given["blenders"] = tuple(Path(shutil.which(word) or word).absolute() for word in arguments.blender)
    settings, about = Settings(quick=arguments.quick, **given), report.about()
    out.mkdir(parents=True, exist_ok=True)
    if not console.json_output:
        print(report.describe(about))
    results: dict[str, Any] = {}
    for name in names:
        with console.step(name) as progress:
            result = JOBS[name].run(settings, progress)
        data = result.data(about) | {"quick": settings.quick, "seconds": console.seconds[name]}
        write(out / f"{name}.json", json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n", console)
        write(out / f"{name}.md", result.markdown(about), console)
        for section in result.sections:
            console.table(section.title, (c.head for c in section.columns), section.cells(), section.notes)
        for problem in result.problems:
            console.error(f"{name}: {problem}")
        images = drawing.draw(data, out) if drawing else []
        results[name] = data | {"plots": [str(path) for path in images]}
        if not console.json_output:
            files = ", ".join(path.name for path in (out / f"{name}.json", out / f"{name}.md", *images))
            print(f"{name}: {console.seconds[name]:.1f} s; {files} in {out}\n", flush=True)
    if console.json_output:
        console.result({"jobs": results}, "", [])
    return 1 if any(result["problems"] for result in results.values()) else 0


def plotting(console: Console):
    """The module that draws, or None, with a word about it, where matplotlib is missing."""
    try:
        from . import plots
    except ImportError as error:
        if error.name is None or error.name.partition(".")[0] != "matplotlib":
            raise
        console.warning("no plots: matplotlib is not installed (pip install matplotlib, or --no-plots)")
        return None
    return plots


def redraw(out: Path, names: list[str], drawing, console: Console) -> int:
    if drawing is None:
        raise ValueError("--redraw needs matplotlib and no --no-plots")
    drawn: dict[str, Any] = {}
    for name in names:
        path = out / f"{name}.json"
        if path.exists():
            drawn[name] = [str(image) for image in drawing.draw(json.loads(path.read_text()), out)]
    if not drawn:
        raise ValueError(f"{out}: no results to draw")
    console.result({"plots": drawn}, f"drawn again in {out}", [(k, ", ".join(v)) for k, v in drawn.items()])
    return 0


def write(path: Path, text: str, console: Console) -> None:
    with console.writing(path) as beside:
        beside.write_text(text)
