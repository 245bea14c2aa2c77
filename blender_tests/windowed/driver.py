"""Runs inside Blender's window: runs a script's steps one by one from a timer, as fast as the window draws them.

A script is a generator `steps(screen)`: it yields seconds to wait, or a function to wait for until it is true.
"""

import os
import subprocess
import sys
import time
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent))
import bpy
import pictures
import pixels

from support import common, conditions, harness, report

VERSION = "{}.{}".format(*bpy.app.version)
PATIENCE = 300  # s for one condition; a software renderer on a busy machine is slow
# xdotool's names for keys with other names in Blender.
KEYS = {"ESC": "Escape", "RET": "Return", "SPACE": "space", "TAB": "Tab", "DEL": "Delete", "LEFT_ARROW": "Left",
        "RIGHT_ARROW": "Right", "UP_ARROW": "Up", "DOWN_ARROW": "Down"}  # fmt: skip
BUTTONS = {"LEFTMOUSE": 1, "MIDDLEMOUSE": 2, "RIGHTMOUSE": 3}


class Screen:
    """The window, its 3D view, and a user's actions in them."""

    def __init__(self, out, script):
        self.out, self.script = Path(out), script
        self.at = (0, 0)  # the mouse's last target
        self.pixels = pixels.Pixels()
        self.unlike = []  # differences of pictures; the steps continue, so that all pictures are taken

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

    def areas(self):
        """Kind and box of every area, and of the sidebar in the 3D view, in the form of pictures.judge."""
        w, h = self.window.width, self.window.height
        parts = [(a.type, a) for a in self.window.screen.areas]
        parts += [("SIDEBAR", self.region("UI"))] if self.area.spaces.active.show_region_ui else []
        return [(kind, (p.x / w, 1 - (p.y + p.height) / h, (p.x + p.width) / w, 1 - p.y / h)) for kind, p in parts]

    def draw_smoothly(self, smoothly):
        """Smooth edges, outlines and the floor's grid take a software renderer two thirds of its time: they are used
        only for pictures in documents."""
        system = bpy.context.preferences.system
        system.viewport_aa = "FXAA" if smoothly else "OFF"  # the others draw several times
        system.use_overlay_smooth_wire = smoothly
        for area in self.window.screen.areas:
            if area.type == "VIEW_3D":
                overlay = area.spaces.active.overlay
                overlay.show_outline_selected = overlay.show_floor = smoothly
                overlay.show_axis_x = overlay.show_axis_y = smoothly

    def picture(self, name, vary=()):
        """A picture of the whole display, compared with its reference if there is one: steps to `yield from`. Panels
        that are still moving, and a renderer on a busy computer, get time to match it. vary: kinds of areas, and boxes,
        that may differ each time."""
        yield from self.pixels.fill_again(self.window)
        for pause in (0.5, 1.0, 2.0, 4.0, 0):
            complaint = self._shoot(name, vary)
            if not complaint:
                break
            for area in self.window.screen.areas:
                area.tag_redraw()  # panels move on with each drawing
            yield pause
        self.pixels.kept = False
        if complaint is None:
            report.say(note=f"{self.script}/{name}.png: there are no references for Blender {VERSION}")
        elif complaint:
            accept = f"windowed/pictures.py <its folder's>/pictures-{VERSION}.json {self.script}/{name}"
            self.unlike.append(
                f"{self.script}/{name}.png is not like its reference: {complaint}. If it is right: {accept}"
            )

    def shot(self, name):
        """A picture of the whole display for inspection, without comparison, if there are pixels: steps to `yield
        from`."""
        if pixels.NONE:
            return
        yield from self.pixels.fill_again(self.window)
        self.take(name)
        self.pixels.kept = False

    def take(self, name):
        """Writes what the display shows, and returns it. From outside: Blender's own operator gives a black one from
        4.3 on."""
        path = self.out / self.script / f"{name}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        image = pictures.grab()
        pictures.write(path, image)
        assert path.stat().st_size > 40_000, f"{path} is all but empty"
        return image

    def _shoot(self, name, vary):
        """Returns the result of pictures.check."""
        return pictures.check(self.take(name), self.out, f"{self.script}/{name}", VERSION, self.areas(), vary)

    # A Blender that takes simulated events takes no others: a script sets REAL_EVENTS = True to avoid them, and all
    # events below then come from outside, by xdotool, as from a mouse and a keyboard.

    def xdotool(self, *words):
        assert not bpy.app.use_event_simulate, "without REAL_EVENTS = True, Blender is deaf to xdotool"
        subprocess.run(["xdotool", *map(str, words)], check=True)

    def move(self, x, y):
        """Moves the mouse to window pixels, y up."""
        if bpy.app.use_event_simulate:
            self.window.event_simulate("MOUSEMOVE", "NOTHING", x=int(x), y=int(y))
        else:
            self.xdotool("mousemove", int(x), int(self.window.height - 1 - y))
        self.at = int(x), int(y)

    def button(self, value, name="LEFTMOUSE"):
        """PRESS or RELEASE at the mouse's place."""
        if bpy.app.use_event_simulate:
            self.window.event_simulate(name, value, x=self.at[0], y=self.at[1])
        else:
            self.xdotool("mousedown" if value == "PRESS" else "mouseup", BUTTONS[name])

    def to_view(self):
        """Moves the mouse to the middle of the 3D view."""
        r = self.region()
        self.move(r.x + r.width // 3, r.y + r.height // 2)

    def click(self, x, y):
        self.move(x, y)
        self.button("PRESS")
        self.button("RELEASE")

    def drag(self, points, pause=0.05):
        """A drag through window pixels, with a pause (s) after each event: steps to `yield from`."""
        self.move(*points[0])
        yield pause
        self.button("PRESS")
        yield pause
        for p in points[1:]:
            self.move(*p)
            yield pause
        self.button("RELEASE")
        yield pause

    def key(self, name, **modifiers):
        """By Blender's name for it, with the mouse over the 3D view; modifiers: ctrl, shift, alt = True."""
        if not bpy.app.use_event_simulate:
            self.to_view()
            return self.xdotool(
                "key", "+".join([*(m for m in modifiers if modifiers[m]), KEYS.get(name, name.lower())])
            )
        r = self.region()
        x, y = r.x + r.width // 3, r.y + r.height // 2
        self.window.event_simulate(name, "PRESS", x=x, y=y, **modifiers)
        return self.window.event_simulate(name, "RELEASE", x=x, y=y, **modifiers)


def where(generator):
    """The lines at which a script waits, from the outermost generator to the innermost."""
    lines = []
    while generator is not None and getattr(generator, "gi_frame", None) is not None:
        lines.append(f"{Path(generator.gi_code.co_filename).name}:{generator.gi_frame.f_lineno}")
        generator = generator.gi_yieldfrom
    return " > ".join(lines)


class Play:
    def __init__(self, name, steps, screen):
        self.name, self.generator, self.screen = name, steps(screen), screen
        self.begin = self.since = time.perf_counter()
        self.condition = None

    def in_vain(self, why):
        """The rest of a script that waited in vain: a picture of what stands there, if it can be had, and the end."""
        try:
            yield from self.screen.shot("in-vain")
        finally:
            raise AssertionError(why)

    def __call__(self):
        try:
            self.screen.pixels.tick()
            if self.condition is not None:
                if self.condition():
                    self.condition = None
                elif time.perf_counter() - self.since > PATIENCE:
                    why = conditions.explain(self.condition)
                    why = f"waited {PATIENCE} s in vain at {where(self.generator)} for\n{why}"
                    self.condition, self.generator = None, self.in_vain(why)
                else:
                    return 0.05
            wanted = next(self.generator)
        except StopIteration:
            self.end("failed" if self.screen.unlike else "passed", "\n".join(self.screen.unlike))
        except BaseException:
            self.end("failed", traceback.format_exc())
        self.since = time.perf_counter()
        if callable(wanted):
            self.condition = wanted
            return 0.05
        return wanted

    def end(self, outcome, message):
        seconds = time.perf_counter() - self.begin
        report.say(name=self.name, outcome=outcome, seconds=seconds, processor=report.processor_time(), message=message)
        sys.stdout.flush()
        os._exit(0 if outcome == "passed" else 1)


def rest():
    """Blender's main loop sleeps when idle, except while it takes simulated events: it would keep a core busy. This is
    called once in each of its iterations."""
    time.sleep(0.005)
    return 0.0


def main():
    common.JOB, common.Skip = harness.job, harness.Skip
    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.view.smooth_view = 0
    script = Path(harness.job["files"][0])
    if "\nINSTALL = False\n" not in script.read_text():  # before the script, which may import riffler
        common.MODULE = harness.install()
    module = harness.load(script)
    report.say(start=module.__name__)
    screen = Screen(harness.job["out"], module.__name__)
    screen.draw_smoothly(False)
    play = Play(module.__name__, module.steps, screen)
    if bpy.app.use_event_simulate:
        bpy.app.timers.register(rest, persistent=True)
    bpy.app.timers.register(play, first_interval=2.0, persistent=True)  # a script may open files


try:
    main()
except BaseException:
    report.say(name="driver", outcome="failed", seconds=0, message=traceback.format_exc())
    sys.stdout.flush()
    os._exit(1)
