"""The point of a plan at the scene's frame, and the tool there: where collisions are checked, and where the tool is
turned by hand and drawn."""

from dataclasses import dataclass

import numpy as np

from ..blender import meshes, scene_units
from ..common import quaternions
from ..sculpt.pure.view_rays import ViewRays
from . import plan_store, replan, timeline
from .pure import tool_rotation

TOOL = "riffler.plan"  # in the toolbar
REACH = 1.7  # distance from the point to the handle at the tool's end, in Blender's gizmo sizes


@dataclass(frozen=True)
class Spot:
    """`path`, `index`: numbers of the path and its point."""

    ob: object
    plan: object
    path: int
    index: int

    @property
    def line(self):
        return self.plan.paths[self.path]

    @property
    def centre(self):
        return self.line.centres[self.index]

    @property
    def axis(self):
        return tool_rotation.axis_at(self.line, self.index)


held = None  # the axis while the user turns the tool, for what is drawn next to it
said = None  # (what the tool touches or is next to, whether it is free) while a device turns it, likewise


def plan_object(context):
    """The plan whose tool is active, or the active plan, or None."""
    return timeline.plan_of(context.object) or plan_store.active(context)


def tool_active(context):
    """True if the plan tool of the toolbar is active in the 3D view."""
    if context.workspace is None or context.mode != "OBJECT":
        return False
    tool = context.workspace.tools.from_space_view3d_mode("OBJECT", create=False)
    return tool is not None and tool.idname == TOOL


def spot(scene, ob, frame=None):
    """The spot of a plan's object at a frame, by default the scene's; None if there is none. ValueError if the plan
    cannot be read."""
    if ob is None or timeline.pair(ob) is None:
        return None
    plan = plan_store.plan(ob)
    layout = replan.layout_of(ob, plan)
    place = layout.place(scene.frame_current_final if frame is None else frame)
    if place is None or place[0] >= len(plan.paths) or place[1] >= len(plan.paths[place[0]]):
        return None
    return Spot(ob, plan, place[0], place[1])


def seen(context):
    """The spot for handles and maps. None if there is none, if it cannot be found, and if the path takes no keys:
    operators report errors, drawing does not."""
    try:
        found = spot(context.scene, plan_object(context))
    except ValueError:
        return None
    return None if found is None or found.path in found.plan.depths else found


def sight(context, region, space):
    """The region's view of the world, in millimetres."""
    mm = scene_units.mm_per_unit(context.scene)
    return ViewRays(
        meshes.matrix(space.perspective_matrix) @ np.diag([1 / mm] * 3 + [1.0]), (region.width, region.height)
    )


def reach(context, view, centre):
    """mm from a point to its handle at the tool's end: the same number of pixels everywhere."""
    preferences = context.preferences
    pixels = REACH * preferences.view.gizmo_size * preferences.system.ui_scale
    return pixels / view.pixels_per_unit(centre)


def hand(scene, spot, pose):
    """Shows the tool at a pose (6,), mm, instead of the animated one, until `release`."""
    tool, ghost = timeline.pair(spot.ob)
    stands = timeline.stands(scene, tool, ghost)
    quat = quaternions.transported(pose[None, 3:], stands)[0]
    timeline.take(tool, pose[:3] / scene_units.mm_per_unit(scene), quat)


def release(scene, ob):
    """Lets the tool follow the animation again."""
    timeline.settle(scene, *timeline.pair(ob), afresh=True)
