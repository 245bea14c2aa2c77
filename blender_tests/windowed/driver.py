"""Runs inside Blender's window: takes a script's steps one by one from a timer, as fast as the window draws them.

A script is a generator `steps(screen)`: it yields seconds to wait, or a function to wait for until it is true.
"""

import os
import subprocess
import sys
import time
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import bpy
import harness

import support

PATIENCE = 120  # s for one condition; a software renderer on a busy machine is slow


class Screen:
    """The window, its 3D view, and what a person would do with them."""

    def __init__(self, out):
        self.out = Path(out)

    @property
    def window(self):
        return bpy.context.window_manager.windows[0]

    @property
    def area(self):
        return next(a for a in self.window.screen.areas if a.type == "VIEW_3D")

    def region(self, kind="WINDOW"):
        return next(r for r in self.area.regions if r.type == kind)

    def override(self):
        return bpy.context.temp_override(window=self.window, area=self.area, region=self.region())

    def shoot(self, name):
        """A picture of the whole display."""
        self.out.mkdir(parents=True, exist_ok=True)
        path = self.out / f"{name}.png"
        subprocess.run(["import", "-window", "root", str(path)], check=True)
        assert path.stat().st_size > 20_000, f"{path} is all but empty"

    def move(self, x, y):
        self.window.event_simulate("MOUSEMOVE", "NOTHING", x=x, y=y)

    def to_view(self):
        """The mouse into the middle of the 3D view."""
        r = self.region()
        self.move(r.x + r.width // 3, r.y + r.height // 2)

    def click(self, x, y):
        self.move(x, y)
        self.window.event_simulate("LEFTMOUSE", "PRESS", x=x, y=y)
        self.window.event_simulate("LEFTMOUSE", "RELEASE", x=x, y=y)

    def key(self, name, **modifiers):
        r = self.region()
        x, y = r.x + r.width // 3, r.y + r.height // 2
        self.window.event_simulate(name, "PRESS", x=x, y=y, **modifiers)
        self.window.event_simulate(name, "RELEASE", x=x, y=y, **modifiers)


class Play:
    def __init__(self, name, generator):
        self.name, self.generator = name, generator
        self.begin = self.since = time.perf_counter()
        self.condition = None

    def __call__(self):
        try:
            if self.condition is not None:
                if self.condition():
                    self.condition = None
                elif time.perf_counter() - self.since > PATIENCE:
                    raise AssertionError(f"waited {PATIENCE} s in vain at line {self.generator.gi_frame.f_lineno}")
                else:
                    return 0.05
            wanted = next(self.generator)
        except StopIteration:
            self.end("passed", "")
        except BaseException:
            self.end("failed", traceback.format_exc())
        self.since = time.perf_counter()
        if callable(wanted):
            self.condition = wanted
            return 0.05
        return wanted

    def end(self, outcome, message):
        seconds = time.perf_counter() - self.begin
        harness.say(name=self.name, outcome=outcome, seconds=seconds, message=message)
        sys.stdout.flush()
        os._exit(0 if outcome == "passed" else 1)


def main():
    support.JOB = harness.job
    bpy.context.preferences.view.show_splash = False
    module = harness.load(harness.job["files"][0])
    if getattr(module, "INSTALL", True):
        support.MODULE = harness.install()
    harness.say(start=module.__name__)
    play = Play(module.__name__, module.steps(Screen(harness.job["out"])))
    bpy.app.timers.register(play, first_interval=2.0)


try:
    main()
except BaseException:
    harness.say(name="driver", outcome="failed", seconds=0, message=traceback.format_exc())
    sys.stdout.flush()
    os._exit(1)
