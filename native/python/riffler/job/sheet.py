"""Writes the set-up sheet of a job: one HTML page that needs no other files."""

from __future__ import annotations

import html
import importlib.util
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .. import files
from .._core import Mesh, Tool, __version__
from .model import Job
from .running import Done, Result

SCALE = 0.5  # mm, largest range of the colours: they show errors of the surface, not the stock left around the part
STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #22262b; max-width: 62em; margin: 2em auto; padding: 0 1em; }
h1 { margin-bottom: 0; } h2 { margin-top: 2em; border-bottom: 1px solid #ccc8bd; padding-bottom: .2em; }
table { border-collapse: collapse; margin: .6em 0; } td, th { padding: .25em .9em .25em 0; text-align: left;
vertical-align: top; border-bottom: 1px solid #e9e6de; } th { font-weight: 600; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
img { max-width: 100%; } .warning { background: #fff3d6; border-left: 4px solid #d08c2a; padding: .4em .8em;
margin: .4em 0; }
.good { background: #e6f1e8; border-left: 4px solid #3f7d4f; padding: .4em .8em; }
.two { display: flex; flex-wrap: wrap;
gap: 1em; } .two > * { flex: 1 1 24em; } figure { margin: 0; } figcaption { color: #5b6770; font-size: .9em; }
@media print { body { max-width: none; } h2 { break-after: avoid; } figure, table { break-inside: avoid; } }
"""


def write_sheet(job: Job, result: Result, path: Path | None = None) -> Path:
    """Writes the set-up sheet of a job that has run: one HTML page, with pictures if matplotlib is installed.

    Parameters
    ----------
    job : Job
        The job.
    result : Result
        The result that ``run`` returned.
    path : path_like, optional
        The file to write; by default the job's ``sheet``.

    Returns
    -------
    Path
        The written file.

    Examples
    --------
    >>> from pathlib import Path
    >>> riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10).write("hill.stl")
    >>> tool = ["[[tool]]", "number = 1", 'kind = "flat"', "diameter = 6"]
    >>> operation = ["[[operation]]", 'kind = "rough"', "tool = 1"]
    >>> _ = Path("hill.toml").write_text(chr(10).join(['part = "hill.stl"', *tool, *operation]))
    >>> job = riffler.job.read("hill.toml")
    >>> riffler.job.write_sheet(job, riffler.job.run(job)).name
    'hill.html'
    """
    target = job.sheet if path is None else Path(path)
    files.write(target, page(job, result).encode())
    return target


def page(job: Job, result: Result) -> str:
    """The sheet's HTML."""
    pictures = _pictures(job, result)
    body = [
        f"<h1>{_text(job.name)}</h1>",
        f"<p>{_text(job.program.name)}, {_time(result.seconds)} at the programmed feeds</p>",
        '<p class="good">Simulated from the written file: no rapid in material, no collision, no gouge.</p>',
        *(f'<p class="warning">{_text(one)}</p>' for one in result.warnings),
        '<div class="two">',
        pictures.get("setup", ""),
        _setup(job),
        "</div>",
        "<h2>Tools</h2>",
        _tools(job, result),
        "<h2>Operations</h2>",
        _operations(result),
        *(part for k, done in enumerate(result.operations) for part in _operation(k, done, pictures)),
        "<h2>Result</h2>",
        '<div class="two">',
        pictures.get("deviation", ""),
        _result(result),
        "</div>",
        f"<p><small>Riffler {_text(__version__)}; lengths in mm, feeds in mm/min.</small></p>",
    ]
    head = f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{_text(job.name)}</title>'
    return f"{head}<style>{STYLE}</style></head><body>\n" + "\n".join(body) + "\n</body></html>\n"


def _pictures(job: Job, result: Result) -> dict[str, str]:
    """HTML figures by name; empty without matplotlib."""
    if importlib.util.find_spec("matplotlib") is None:
        return {}
    from . import pictures

    setup = result.setup
    first = pictures.mesh_of(result.stock)
    view = pictures.View([first, job.part, *setup.obstacles])
    out = {
        "setup": _figure(
            pictures.draw_setup(view, job.part, first, setup.obstacles, job.zero),
            "The part in its stock, with the fixtures; the arrows stand in the program's zero.",
        )
    }
    close = pictures.View([first])
    for k, done in enumerate(result.operations):
        if len(done.operation):
            following = next((one.operation for one in result.operations[k + 1 :]), None)
            left = setup.stock if following is None else setup.stock_before(following)
            image = pictures.draw_operation(close, pictures.mesh_of(left), done.operation)
            out[f"operation {k}"] = _figure(image, "What is left after it, and its moves.")
    if result.deviation is not None and len(result.deviation[0].triangles):
        mesh, distance = result.deviation
        finite = np.abs(distance[np.isfinite(distance)])
        scale = float(np.clip(np.quantile(finite, 0.95) if len(finite) else 0.0, 0.01, SCALE))
        out["deviation"] = _figure(
            pictures.draw_deviation(close, mesh, distance, scale),
            "What is left, coloured by its distance from the part.",
        )
    return out


def _setup(job: Job) -> str:
    stock, fixtures = job.stock, ", ".join(path.name for path in job.fixture_files) or "none"
    return _table(
        [
            ("part", f"{job.part_file.name}, {_box(job.part)}"),
            ("stock", f"{_sizes(stock.lower, stock.upper)} from {_place(stock.lower)} to {_place(stock.upper)}"),
            ("fixtures", fixtures),
            ("machine", job.machine),
            ("axis", _place(job.axis)),
            ("program's zero", f"{_place(job.zero)} of the part's frame"),
            ("zero above the stock's underside", f"{job.zero[2] - stock.lower[2]:.3f}"),
            ("clearance", f"{job.clearance:g} above everything"),
        ]
    )


def _tools(job: Job, result: Result) -> str:
    used = {done.job.tool.number: 0.0 for done in result.operations}
    deepest: dict[int, float] = {}
    for done in result.operations:
        number, op = done.job.tool.number, done.operation
        used[number] += op.report.time_s
        if len(op):
            height = (op.poses[:, :3] - job.zero) @ op.poses[0, 3:]
            deepest[number] = min(deepest.get(number, np.inf), float(height.min()))
    rows = []
    for number, seconds in sorted(used.items()):
        tool = job.tools[number]
        flutes = "" if tool.flutes is None else str(tool.flutes)
        lowest = f"{deepest[number]:.3f}" if number in deepest else ""
        rows.append(
            [f"T{number}", tool.name, shape(tool.tool), f"{tool.tool.length:g}", flutes, lowest, _time(seconds)]
        )
    heads = ["number", "name", "cutter", "cutting length", "flutes", "lowest tip", "time"]
    return _wide(heads, rows, numbers={3, 4, 5, 6})


def shape(tool: Tool) -> str:
    """A short text, such as ``ball Ø6, with holder``."""
    rods = [what for what in ("shank", "holder") if getattr(tool, what)]
    return f"{tool.kind} Ø{tool.diameter:g}{', with ' + ' and '.join(rods) if rods else ''}"


def _operations(result: Result) -> str:
    rows = []
    axes = [_direction(done.operation.poses[0, 3:]) if len(done.operation) else "" for done in result.operations]
    tilted = len(set(axes) - {""}) > 1
    for k, done in enumerate(result.operations):
        op, report = done.operation, done.operation.report
        feed = op.feed[op.kind == 2]
        rows.append(
            [
                str(k + 1),
                done.job.name,
                f"T{done.job.tool.number}",
                *([axes[k]] if tilted else []),
                f"{feed.max():g}" if len(feed) else "",
                f"{op.spindle:g}",
                f"{report.cut_mm:.0f}",
                f"{report.air_mm:.0f}",
                f"{done.removed:.0f}",
                _time(report.time_s),
            ]
        )
    more = ["tool axis"] if tilted else []
    heads = ["", "operation", "tool", *more, "feed", "rev/min", "cut", "in air", "mm³ removed", "time"]
    rows.append(["", "all", *[""] * (len(heads) - 3), _time(result.seconds)])
    return _wide(heads, rows, numbers=set(range(3 + len(more), len(heads))))


def _operation(k: int, done: Done, pictures: dict[str, str]) -> list[str]:
    op, report = done.operation, done.operation.report
    head = f"<h3>{k + 1}. {_text(done.job.name)}</h3>"
    if not len(op):
        return [head, f'<p class="warning">It cuts nothing: {_text(op.reason)}</p>']
    options = ", ".join(f"{key} = {_value(value)}" for key, value in done.job.table.data.items() if key != "name")
    rows = [("asked", options)]
    if report.largest_engagement is not None:
        rows.append(("widest cut", f"{report.largest_engagement:.3f} of the diameter"))
    rows += [(key, str(value)) for key, value in report.stats.items()]
    rows += [
        ("not reached", f"{one.length:.1f} mm from ({', '.join(f'{x:.1f}' for x in one.place)}): {one.reason}")
        for one in report.blocked
    ]
    return [head, '<div class="two">', pictures.get(f"operation {k}", ""), _table(rows), "</div>"]


def _result(result: Result) -> str:
    rows = [
        ("stock at the beginning", f"{result.stock.volume:.0f} mm³"),
        ("left", f"{result.setup.stock.volume:.0f} mm³"),
        ("time of the simulated file", _time(result.report.time)),
    ]
    if result.deviation is not None:
        distance = result.deviation[1][np.isfinite(result.deviation[1])]
        if len(distance):
            rows += [
                ("highest over the part", f"{distance.max():.3f}"),
                ("deepest under the part", f"{max(0.0, -distance.min()):.3f}"),
            ]
    rows += [("not checked", one) for one in result.report.not_checked]
    return _table(rows)


def _table(rows: Iterable[tuple[str, str]]) -> str:
    lines = "".join(f"<tr><th>{_text(name)}</th><td>{_text(value)}</td></tr>" for name, value in rows)
    return f"<div><table>{lines}</table></div>"


def _wide(heads: list[str], rows: list[list[str]], numbers: set[int]) -> str:
    def cells(row: list[str], tag: str) -> str:
        return "".join(
            f"<{tag}{' class=n' if k in numbers else ''}>{_text(value)}</{tag}>" for k, value in enumerate(row)
        )

    lines = "".join(f"<tr>{cells(row, 'td')}</tr>" for row in rows)
    return f"<table><tr>{cells(heads, 'th')}</tr>{lines}</table>"


def _figure(image: str, caption: str) -> str:
    return (
        f'<figure><img alt="{_text(caption)}" src="data:image/png;base64,{image}">'
        f"<figcaption>{_text(caption)}</figcaption></figure>"
    )


def _text(value: str) -> str:
    return html.escape(value, quote=True)


def _value(value: object) -> str:
    text = str(value).lower() if isinstance(value, bool) else str(value)
    return text if len(text) < 60 else f"{text[:57]}…"


def _time(seconds: float) -> str:
    minutes = int(seconds // 60)
    return f"{minutes // 60} h {minutes % 60:02} min" if minutes >= 60 else f"{minutes} min {seconds % 60:02.0f} s"


def _box(part: Mesh) -> str:
    lower, upper = part.bounds
    return f"{_sizes(lower, upper)} from {_place(lower)} to {_place(upper)}"


def _sizes(lower: np.ndarray, upper: np.ndarray) -> str:
    return " × ".join(f"{x:.4g}" for x in upper - lower)


def _direction(axis: np.ndarray) -> str:
    return f"({', '.join(f'{x + 0.0:.3g}' for x in axis.round(6))})"


def _place(point: np.ndarray) -> str:
    return f"({', '.join(f'{x:.5g}' for x in point)})"
