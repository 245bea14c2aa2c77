"""Single paths of a plan: switched on or off, and gone to."""

from dataclasses import replace

import bpy
import numpy as np
from mathutils import Vector

from ..blender import scene_units, views
from ..sculpt import sculpts
from . import path_curves, plan_states, plan_store, replan, timeline


def follow(row):
    """A row was switched on or off by the user: updates the plan."""
    ob = row.id_data
    k = next(k for k, other in enumerate(ob.riffler.plan.rows) if other == row)
    plan = plan_store.plan(ob)
    if row.on == (k in plan.off):
        switch(ob, [k], row.on)


def switch(ob, numbers, on):
    """Switches paths, by their numbers from 0, on or off. ValueError if the plan cannot be changed."""
    off = plan_store.plan(ob).off
    switch_to(ob, off - set(numbers) if on else off | set(numbers))


def switch_to(ob, off):
    """Switches off these paths, and all others on."""
    plan = plan_store.plan(ob)
    if off == plan.off:
        return
    plan_store.write(ob, replace(plan, off=frozenset(off)))
    show(ob)
    views.redraw()  # the colours of their lines change
    plan_states.tell_followers()
    if timeline.pair(ob) is not None:
        replan.sync(bpy.context.scene, ob)


def show(ob):
    """Hides the curves of paths that are off."""
    off = plan_store.plan(ob).off
    if off:
        bpy.context.view_layer.update()  # it does not contain curves made just now
    for k, curve in path_curves.numbered(ob).items():
        if curve.name in bpy.context.view_layer.objects and curve.hide_get() != (k in off):
            curve.hide_set(k in off)


def go(context, ob, k):
    """Selects a path, shows the frame at which it begins, and centres the views on it."""
    if not 0 <= k < len(ob.riffler.plan.rows) or context.mode != "OBJECT":
        return
    plan = plan_store.plan(ob)
    curve = path_curves.numbered(ob).get(k)
    if curve is not None and curve.visible_get():
        sculpts.select_only(context, curve)
    if timeline.pair(ob) is not None and replan.fits(ob, plan):
        timeline.go_to(context.scene, replan.layout_of(ob, plan).tracks[k].first)
    place = Vector(np.mean([plan.paths[k].centres.min(axis=0), plan.paths[k].centres.max(axis=0)], axis=0))
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D" and area.spaces.active.region_3d is not None:
                area.spaces.active.region_3d.view_location = place / scene_units.mm_per_unit(context.scene)
