"""What the scripts share: the add-on, clocks, and steps in a window. Needs Blender, and a path that riffler is on.

host.py -- SCRIPT.FUNCTION ARGUMENTS      calls it with the JSON ARGUMENTS, prints what it returns as a line of JSON

ARGUMENTS are the function's own, and those of ``prepare``. A function that is a generator runs in a window, from a
timer: it yields seconds to wait, or a function to wait for until it is true.
"""

import importlib
import json
import os
import statistics
import sys
import time
import traceback
from pathlib import Path

import bpy

ADDON = "riffler_addon"
PATIENCE = 120  # s for one condition in a window


def prepare(paths=(), addon=None):
    """`paths` to import from; `addon`: its folder, which is linked into the user's own and enabled."""
    sys.path[:0] = paths
    bpy.context.preferences.view.show_splash = False
    if addon is None:
        return
    folder = Path(bpy.utils.user_resource("SCRIPTS", path="addons", create=True))
    if not (folder / ADDON).exists():
        (folder / ADDON).symlink_to(addon, target_is_directory=True)
    bpy.ops.preferences.addon_enable(module=ADDON)
    if ADDON not in bpy.context.preferences.addons:
        raise RuntimeError("the add-on was not enabled")
    bpy.context.scene.unit_settings.scale_length = 0.001  # a Blender unit is 1 mm


def part(name):
    """A module of the add-on: part("sculpt.live_registry")."""
    return importlib.import_module(f"{ADDON}.{name}")


def main():
    try:
        name, text = sys.argv[sys.argv.index("--") + 1 :]
        script, _, function = name.partition(".")
        arguments = json.loads(text)
        prepare(arguments.pop("paths", ()), arguments.pop("addon", None))
        result = getattr(importlib.import_module(script), function)(**arguments)
    except BaseException:
        end(None)
    if hasattr(result, "send"):
        bpy.app.timers.register(Steps(result), first_interval=2.0)
    else:
        end(result)


def end(result):
    """Prints it, or the error that is being handled. Some Blenders crash when they end with anything registered."""
    if result is None:
        traceback.print_exc()
    else:
        print("\n" + json.dumps({**result, "version": bpy.app.version_string}))
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(1 if result is None else 0)


class Steps:
    """A generator, step by step, as a timer of Blender's."""

    def __init__(self, generator):
        self.generator, self.condition, self.since = generator, None, time.perf_counter()

    def __call__(self):
        try:
            if self.condition is not None and not self.condition():
                if time.perf_counter() - self.since > PATIENCE:
                    raise TimeoutError(f"waited {PATIENCE} s in vain, line {self.generator.gi_frame.f_lineno}")
                return 0.001
            wanted = next(self.generator)
        except StopIteration as stop:
            end(stop.value)
        except BaseException:
            end(None)
        self.since = time.perf_counter()
        self.condition = wanted if callable(wanted) else None
        return 0.001 if callable(wanted) else wanted


class Times:
    """Wall and processor seconds (of all threads) under a name, call by call."""

    def __init__(self):
        self.wall, self.cpu = {}, {}

    def of(self, name, work):
        wall, cpu = time.perf_counter(), time.process_time()
        result = work()
        self.add(name, time.perf_counter() - wall, time.process_time() - cpu)
        return result

    def add(self, name, wall, cpu):
        self.wall.setdefault(name, []).append(wall)
        self.cpu.setdefault(name, []).append(cpu)

    def medians(self, name):
        return {"wall_s": statistics.median(self.wall[name]), "cpu_s": statistics.median(self.cpu[name])}


def numbers(mesh):
    """Vertices (V, 3) float64 and triangles (F, 3) of a Blender mesh."""
    import numpy as np

    mesh.calc_loop_triangles()
    co = np.empty(3 * len(mesh.vertices), np.float32)
    tri = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.vertices.foreach_get("co", co)
    mesh.loop_triangles.foreach_get("vertices", tri)
    return co.reshape(-1, 3).astype(float), tri.reshape(-1, 3)


def enclosed(co, tri):
    """The volume by the divergence theorem: a judge that shares no code with what is judged."""
    import numpy as np

    a, b, c = (co[tri[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def plain(name, co, tri):
    """A mesh object that is no sculpt, active and alone in the scene."""
    for ob in list(bpy.data.objects):
        bpy.data.objects.remove(ob)
    mesh = bpy.data.meshes.new(name)
    part("blender.meshes").fill(mesh, co, tri)
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    ob.select_set(True)
    bpy.context.view_layer.update()
    return ob


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parent))
    importlib.import_module("host").main()  # under the name by which the scripts import it
