"""From a part to NC code by the add-on's operators, one after the other, each timed."""

from pathlib import Path

import bpy
import host
import numpy as np


def plan(part, tool, axis, minimum, folder, post):
    """`part`: an STL in mm; `tool`: of riffler.Tool.to_dict; `axis`: every path's one key, tip to spindle."""
    import json

    import riffler

    mesh = riffler.Mesh.read(part)
    ob = host.plain("Part", np.asarray(mesh.vertices), np.asarray(mesh.triangles))
    scene, operators, times = bpy.context.scene, bpy.ops.riffler, host.Times()
    scene.riffler.plan.part = ob
    store = host.part("bl.plan_store")
    times.of("find", lambda: operators.plan_find(tool=json.dumps(tool), minimum_length=minimum))
    made = store.active(bpy.context)
    count = len(store.plan(made).paths)

    def keys():
        operators.plan_to_timeline()
        operators.plan_least_tilt(paths="ALL", axes="GIVEN", axis=axis)

    times.of("keys", keys)
    found = {"paths": count, "points": sum(map(len, store.plan(made).paths))}
    if not {"plan_resolve", "plan_nc"} <= set(dir(operators)):
        return found | said(times) | {"note": "this add-on writes no NC code from a plan"}
    times.of("locations", lambda: operators.plan_resolve(max_lift=1000.0))
    open_ones = [k for k, cl in enumerate(store.plan(made).cl) if cl is None]
    if open_ones:
        return found | said(times) | {"note": f"{len(open_ones)} paths still collide"}
    file = Path(folder) / "blender.ngc"
    times.of("nc", lambda: operators.plan_nc(filepath=str(file), post=post))
    text = file.read_text()
    return found | said(times) | {"blocks": len(text.splitlines()), "bytes": len(text), "note": ""}


def said(times):
    """Seconds of each step, and of all."""
    wall = {f"{name}_s": values[0] for name, values in times.wall.items()}
    return wall | {"wall_s": sum(wall.values()), "cpu_s": sum(values[0] for values in times.cpu.values())}
