"""Starts Blender in a real window on a virtual display and runs a script of steps."""

from __future__ import annotations

import json
import shutil
import tempfile
from pathlib import Path

from support import environments

HERE = Path(__file__).resolve().parent.parent
WIDTH, HEIGHT = 1400, 950


def missing() -> str:
    """Why no window can be opened here, or ""."""
    for program, package in (("xvfb-run", "xvfb"), ("import", "imagemagick"), ("xdotool", "xdotool")):
        if not shutil.which(program):
            return f"there is no `{program}` (package {package})"
    return ""


def run(bench, application, mode: str, script: Path, display: int = 90) -> None:
    """`mode`: how the add-on is installed: "source", or by the zip "extension" or "legacy". `display`: the number from
    which to search for a free one."""
    where = f"{application.name}, window, {mode}, {script.stem}"
    bench.begin(where)
    with tempfile.TemporaryDirectory() as resources:
        job = {
            "mode": mode,
            "zip": bench.zips.get(mode, ""),
            "files": [str(script)],
            "paths": bench.paths if mode == "source" else [],
            "out": str(bench.out),
            "repo": str(environments.ROOT),
            "only": "",
            "size": [WIDTH, HEIGHT],
            "measure": bench.measure,
            "smooth": bench.smooth,
        }
        path = Path(resources) / "job.json"
        path.write_text(json.dumps(job))
        (Path(resources) / "scripts" / "addons").mkdir(parents=True)
        variables = {
            **application.variables,
            "RIFFLER_TEST_JOB": str(path),
            "BLENDER_USER_RESOURCES": resources,
            "BLENDER_USER_SCRIPTS": str(Path(resources) / "scripts"),
            "LIBGL_ALWAYS_SOFTWARE": "1",
        }
        screen = ["xvfb-run", "-a", "-n", str(display), "-s", f"-screen 0 {WIDTH}x{HEIGHT}x24"]
        text = script.read_text()
        if "\nPIXELS = False\n" in text and not (bench.measure or bench.smooth):
            variables["LP_NO_RAST"] = "1"  # windowed/pixels.py
        real = "\nREAL_EVENTS = True\n" in text
        # A script that cannot be loaded ends Blender, which otherwise waits for the time limit.
        blender = [application.command[0], "--factory-startup", "--python-exit-code", "1"]
        blender += [] if real else ["--enable-event-simulate"]
        command = [*screen, *blender, "-p", "0", "0", str(WIDTH), str(HEIGHT)]
        done = environments.execute(
            [*command, "--python", str(HERE / "windowed" / "driver.py")], variables, bench.timeout
        )
        bench.judge(where, done)
