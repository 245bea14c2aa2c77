"""Keys on many paths at once: those of least tilt that are collision-free at every point, or one axis everywhere."""

import math
from dataclasses import replace

import bpy
import numpy as np
import riffler
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, IntProperty

from ...blender import operator_parts, scene_units
from ...common import units
from ...common.job import AfterJob
from .. import findings, fit_check, obstacles, path_curves, plan_states, plan_store, replan, timeline
from ..pure import key_orientations, location_messages, tilt_search
from . import keys
from .plan_work import TimelineWork

PATHS = (
    ("UNKEYED", "Without Keys", "Paths that have no key yet"),
    ("SELECTED", "Selected", "Paths whose curves are selected; their existing keys are replaced"),
    ("FRAME", "At Current Frame", "The path at the current frame; its existing keys are replaced"),
    ("ALL", "All", "All paths; their existing keys are replaced"),
)
AXES = (
    ("LEAST", "Least Tilt", "The collision-free orientations of least tilt from the middle between both walls"),
    (
        "GIVEN",
        "One Axis",
        ("One orientation everywhere, as with a clamped head; Resolve lifts the tool where it collides"),
    ),
)
NAMED = 5  # paths named in a report


class RIFFLER_OT_plan_least_tilt(TimelineWork, bpy.types.Operator):
    """Set few keys on many paths at once, so that the tool is collision-free at every point with the least tilt; paths
    without a free orientation are listed and stay unchanged
    """

    bl_idname = "riffler.plan_least_tilt"
    bl_label = "Keys of Least Tilt"
    doing = "Searching for free keys"
    cancelled = "Search for free keys cancelled: the plan is unchanged"

    paths: EnumProperty(name="Paths", items=PATHS, default="UNKEYED", description="Paths that get keys")
    axes: EnumProperty(name="Axes", items=AXES, default="LEAST", description="Orientation of the tool at the keys")
    count: IntProperty(
        name="Keys per Path",
        default=2,
        min=1,
        max=1000,
        description="Smallest number of keys on a path; more are set where the tool would collide between them",
    )
    axis: FloatVectorProperty(
        name="Axis",
        subtype="XYZ",
        default=(0, 0, 1),
        description=("World direction from the tip to the spindle: the one axis, or the middle of the machine's range"),
    )
    limit: FloatProperty(
        name="Limit",
        subtype="ANGLE",
        default=math.pi,
        min=0.0,
        max=math.pi,
        description="How far the machine can lean the tool from the axis; 180°: anywhere",
    )

    def draw(self, context):
        given, least = ("paths", "axes", "axis"), ("paths", "axes", "count", "axis", "limit")
        operator_parts.draw_fields(self, given if self.axes == "GIVEN" else least)

    def begin(self, context):
        ob, plan = self.take(context)
        if not replan.fits(ob, plan):
            raise ValueError(replan.OTHER_PATHS)
        self._paths = self._chosen(context, ob, plan)
        axis = np.array(self.axis, float)
        if not (np.isfinite(axis).all() and np.any(axis)):
            raise ValueError("axis must be finite and not 0, 0, 0")
        axis /= np.linalg.norm(axis)
        chosen = [plan.paths[k] for k in self._paths]
        self._notes = []  # one axis is not checked for collisions
        if self.axes == "GIVEN":
            return tilt_search.SearchesJob([tilt_search.Given(path, axis) for path in chosen])
        taken, clearance = obstacles.take(context, ob), scene_units.clean(context.scene.riffler.plan.clearance)
        self._notes = fit_check.notes(context, plan, taken)
        sizes = {
            "tool": riffler.plan.with_room(plan.tool, clearance),
            "tolerance": plan.tolerance or 0.01,
            "count": self.count,
            "limit": None if self.limit >= math.pi - 1e-6 else (axis, float(self.limit)),
        }

        def search(near):
            rule = tilt_search.Rule(collider=near.collider, **sizes)
            return tilt_search.SearchesJob([tilt_search.Search(path, rule) for path in chosen])

        return AfterJob(taken, search)

    def _chosen(self, context, ob, plan):
        """Numbers of the paths, from 0. ValueError if there are none."""
        if self.paths == "FRAME":
            layout, frame = replan.layout_of(ob, plan), context.scene.frame_current_final
            if layout.at(frame) is None:
                raise keys.on_no_path(layout, frame)
            plan_store.refuse_turning(plan, layout.at(frame))
            return [layout.at(frame)]
        if self.paths == "SELECTED":
            selected = set(context.selected_objects)
            found = {k for k, c in path_curves.numbered(ob).items() if c in selected}
            if not found:
                raise ValueError("No path is selected: select their curves")
            for k in found:
                plan_store.refuse_turning(plan, k)
            return sorted(k for k in found if k < len(plan.paths))
        on = [k for k in range(len(plan.paths)) if k not in plan.off]
        if not on:
            raise ValueError("Every path is off: switch one on in the list of paths")
        on = [k for k in on if k not in plan.depths]
        found = [k for k in on if self.paths == "ALL" or not plan.paths[k].keys]
        if not found:
            raise ValueError(
                "Every path has keys: choose All to replace them"
                if on
                else "The strategy sets the orientations of every path: none of them takes keys"
            )
        return found

    def finish(self, context, job):
        """Changes the plan and the animation once, for any number of paths."""
        ob, plan = self.ob, plan_store.plan(self.ob)
        paths, cl = list(plan.paths), list(plan.cl) or [None] * len(plan.paths)
        marks = [e for e in findings.read(ob.riffler.plan.findings) if e["path"] not in self._paths]
        without = []
        for k, answer in zip(self._paths, job.answers, strict=True):
            if answer.path is None:
                without.append(k)
                marks.append(
                    location_messages.without_key(k, answer.point, paths[k].centres[answer.point], answer.reason)
                )
            else:
                paths[k], cl[k] = answer.path, None
        if len(without) < len(self._paths):
            tool, layout = timeline.pair(ob)[0], replan.layout_of(ob, plan)
            timeline.write_keys(
                tool, *key_orientations.replaced(layout, [p.keys for p in paths], *timeline.read_keys(tool))
            )
            plan_store.write(ob, replace(plan, paths=paths, cl=cl))
            replan.sync(context.scene, ob)
        findings.write(ob.riffler.plan.findings, location_messages.ordered(marks))
        plan_store.refresh_rows(ob)
        self._say(ob, without)
        return {"FINISHED"}

    def _say(self, ob, without):
        done = len(self._paths) - len(without)
        said = f"{units.counted(done, 'path')} keyed"
        if without:
            named = ", ".join(str(k + 1) for k in without[:NAMED]) + (" …" if len(without) > NAMED else "")
            ones = f"path{'s' * (len(without) > 1)} {named}"
            said += f"; no orientation is free on {len(without)}, listed under NC Code: {ones}"
        problems = [*plan_states.state(ob).problems, *self._notes]
        self.report({"WARNING" if without or problems else "INFO"}, "; ".join([said, *problems]))


CLASSES = (RIFFLER_OT_plan_least_tilt,)
