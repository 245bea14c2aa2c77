"""Measure run time, error and memory; exit status 1 if a result is wrong (never for being slow).

riffler bench                    every job: about half an hour
riffler bench b5x force          some of them
riffler bench --quick            all of them, coarser, within a minute

Writes JSON, Markdown and plots of each job into --out. Rivals that are not there are named as left out.
"""

from __future__ import annotations

import argparse
import json
import shutil
from pathlib import Path
from typing import Any

from .console import Console

HELP = "measure run time, error and memory"
NAMES = (
    *("b200", "b5x", "s500k", "haptic", "force", "pitch", "mesh", "follow", "random", "stl", "decimate"),
    *("col", "pencil", "drop", "gouge", "nc", "threads", "verify", "cluster", "blender"),
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    jobs = f"{', '.join(NAMES)}; all of them if none is named"
    parser.add_argument("jobs", nargs="*", metavar="JOB", help=jobs)
    parser.add_argument("--quick", action="store_true", help="coarser and shorter: does everything work?")
    parser.add_argument("--out", default="riffler-bench", metavar="DIR", help="default riffler-bench")
    parser.add_argument("--no-plots", action="store_true", help="figures only; plots need matplotlib")
    parser.add_argument("--redraw", action="store_true", help="measure nothing, draw the plots of --out again")
    parser.add_argument("--models", metavar="DIR", help=".stl files for the jobs stl, pencil, drop and gouge")
    what = "a Python with bpy, or a blender, to measure the add-on in and as a rival; may be given again"
    parser.add_argument("--blender", metavar="PROGRAM", action="append", default=[], help=what)
    parser.add_argument("--rivals", metavar="PYTHON", help="a Python with the libraries of requirements/rivals.txt")
    parser.add_argument(
        "--programs", metavar="DIR", help="the folder of the built native/bench: OpenVDB, FCL and Coal as rivals"
    )


def run(arguments: argparse.Namespace, console: Console) -> int:
    from ..bench import report
    from ..bench.jobs import JOBS
    from ..bench.measure import Settings

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
        from ..bench import plots
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
