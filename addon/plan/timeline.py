"""A plan on Blender's timeline: the tool with its keyframes, and the motion that drives it.

**Riffler Tool** is the cutter with shank and holder; the keyframes of its rotation are the plan's key orientations.
**Riffler Motion**, an invisible Empty, has the whole motion as an animation; the tool copies its location and rotation
from it, so playing, scrubbing and rendering work without the add-on.

The plan's Empty points to both, and both back to it, by custom properties: those survive every version, renaming and
undo, and copies of all three point to each other. A copy of the tool alone belongs to no plan. The motion cannot be
selected, so a copy of the Empty points to the original's motion, which does not belong to it: that copy is not on the
timeline.
"""

import math

import bpy
import numpy as np

from ..blender import meshes, scene_units, versions
from ..common import quaternions, tool_solid
from .pure import collisions, path_names

TOOL, MOTION, PLAN = "riffler_tool", "riffler_motion", "riffler_plan"
# On the tool: the layout in time, and its paths.
RATE, FIRST, PATHS = "riffler_frames_per_mm", "riffler_first_frame", "riffler_paths"
ROTATION, LOCATION = "rotation_quaternion", "location"
UNIT = "riffler_mm_per_unit"  # on the tool: the scene's value when it was made
# The tool's constraints: switched off while the user turns it, the location only by the add-on.
PLACE, TURN = "Riffler: place", "Riffler: orientation"
CONSTANT, LINEAR = 0, 1
SCALED = 1e-4
TURNED = 1e-5  # difference of a quaternion's components above the error of single precision


def pair(plan_ob):
    """The tool and the motion of a plan on the timeline, otherwise None."""
    tool, ghost = plan_ob.get(TOOL), plan_ob.get(MOTION)
    if not (_is_of(tool, plan_ob) and _is_of(ghost, plan_ob)) or RATE not in tool:
        return None
    return tool, ghost


def _is_of(ob, plan_ob):
    """False for objects of the original that a copy of a plan still points to."""
    return ob is not None and ob.get(PLAN) == plan_ob


def plan_of(ob):
    """The plan whose tool the object is, or None."""
    plan_ob = ob.get(PLAN) if ob is not None else None
    found = pair(plan_ob) if plan_ob is not None else None
    return plan_ob if found and found[0] == ob else None


def placed(ob):
    """True if the object is in a scene: a deleted one stays in the file as long as its plan points to it."""
    named = [scene.objects.get(ob.name) for scene in bpy.data.scenes]
    if ob in named or not any(named):
        return ob in named
    return any(ob in scene.objects[:] for scene in bpy.data.scenes)  # a linked one of that name comes first


def faults(tool, scene):
    """Why a plan's tool is not displayed correctly, with the remedy."""
    if not placed(tool):
        return [f"{tool.name} was deleted: use Plan to Timeline to have it again"]
    if max(abs(size - 1) for size in tool.matrix_world.to_scale()) > SCALED:
        return [f"{tool.name} is scaled, so its displayed size is wrong: use Object > Clear > Scale"]
    mm = scene_units.mm_per_unit(scene)
    if tool.get(UNIT, mm) != mm:
        return [f"The scene's unit has changed: use Plan to Timeline, so that {tool.name} has its real size"]
    return []


def make(context, plan_ob, tool):
    """Makes the missing objects of a plan with a riffler.Tool, and updates the tool's shape in any case."""
    home = plan_ob.users_collection[0] if plan_ob.users_collection else context.collection
    ghost, shown = plan_ob.get(MOTION), plan_ob.get(TOOL)
    if not _is_of(ghost, plan_ob):
        ghost = _empty()
    if not _is_of(shown, plan_ob):
        shown = bpy.data.objects.new("Riffler Tool", bpy.data.meshes.new("Riffler Tool"))
        shown.parent = plan_ob
        shown.data.materials.append(_material())
    for ob in (shown, ghost):
        if not ob.users_collection:  # new, or deleted: the plan keeps objects it refers to
            home.objects.link(ob)
    shown.lock_scale = (True, True, True)
    shown.rotation_mode = ghost.rotation_mode = "QUATERNION"
    _follow(shown, ghost)
    vertices, triangles = tool_solid.solid(tool.outline())
    meshes.fill(shown.data, vertices / scene_units.mm_per_unit(context.scene), triangles)
    shown[UNIT] = scene_units.mm_per_unit(context.scene)
    shown[PLAN] = ghost[PLAN] = plan_ob
    plan_ob[TOOL], plan_ob[MOTION] = shown, ghost
    return shown, ghost


def _empty():
    ghost = bpy.data.objects.new("Riffler Motion", None)
    ghost.hide_viewport = ghost.hide_render = ghost.hide_select = True
    return ghost


def _material():
    """Orange, in contrast to the part; one for all tools."""
    found = bpy.data.materials.get(("Riffler Tool", None))
    if found is None:
        found = bpy.data.materials.new("Riffler Tool")
        found.diffuse_color = (0.9, 0.45, 0.1, 1.0)
    return found


def _follow(tool, ghost):
    """Location and rotation separately: while the user turns the tool it stays on its path."""
    for kind, name in (("COPY_LOCATION", PLACE), ("COPY_ROTATION", TURN)):
        constraint = tool.constraints.get(name) or tool.constraints.new(kind)
        constraint.name, constraint.target = name, ghost


# ------------------------------------------------------------------ the scene's frames
def _remapped(scene):
    """Frames of the scene per frame of the animation (Time Stretching); frame_current_final is of the latter."""
    return scene.render.frame_map_new / scene.render.frame_map_old


def go_to(scene, frame):
    """Shows a frame of the animation."""
    frame *= _remapped(scene)
    scene.frame_set(int(frame // 1), subframe=frame % 1)


def show_range(scene, first, last):
    """Makes the scene play these frames of the animation, too."""
    scene.frame_start = min(scene.frame_start, max(0, math.floor(first * _remapped(scene))))
    scene.frame_end = max(scene.frame_end, math.ceil(last * _remapped(scene)))


# ------------------------------------------------------------------ keyframes of the tool
def read_keys(tool):
    """Frames (k,) and quaternions (k, 4) of all keyframes of the tool's rotation; a component without a curve has the
    property's value, as Blender plays it."""
    curves = [_find(tool, ROTATION, i) for i in range(4)]
    frames = np.unique(np.concatenate([np.round(_points(c)[:, 0], 4) for c in curves if c] or [np.empty(0)]))
    values = tool.rotation_quaternion
    quats = [[c.evaluate(f) if c else v for c, v in zip(curves, values, strict=True)] for f in frames]
    return frames, np.array(quats, float).reshape(-1, 4)


def write_keys(tool, frames, quats):
    curves = versions.own_channels(tool, "Riffler Keys")
    for i in range(4):
        _write(curves, ROTATION, i, frames, quats[:, i], np.full(len(frames), LINEAR, np.int32))
    if tool.animation_data.action:
        tool.animation_data.action.update_tag()


# ------------------------------------------------------------------ the animation
def bake(ghost, frames, tips, quats, ends, mm_per_unit):
    """Writes the animation, tips in mm; True if it has changed."""
    rows = {(LOCATION, i): tips[:, i] / mm_per_unit for i in range(3)}
    rows.update({(ROTATION, i): quats[:, i] for i in range(4)})
    kinds = np.full(len(frames), LINEAR, np.int32)
    kinds[ends] = CONSTANT  # the tool jumps to the next path when that begins
    wrong = [key for key, values in rows.items() if not _is(_find(ghost, *key), frames, values, kinds)]
    if wrong:
        curves = versions.own_channels(ghost, "Riffler Motion")
        for key in wrong:
            _write(curves, *key, frames, rows[key], kinds)
        ghost.animation_data.action.update_tag()
    return bool(wrong)


def player(ghost, mm_per_unit):
    """The animation's values as Blender stores them: a function of frames (n,) to tips (n, 3) in mm and quaternions (n,
    4)."""
    curves = {key: _points(_find(ghost, *key)) for key in _all_channels()}

    def play(frames):
        rows = {key: np.interp(frames, points[:, 0], points[:, 1]) for key, points in curves.items()}
        tips = np.stack([rows[LOCATION, i] for i in range(3)], axis=1) * mm_per_unit
        return tips, np.stack([rows[ROTATION, i] for i in range(4)], axis=1)

    return play


def _all_channels():
    return [(LOCATION, i) for i in range(3)] + [(ROTATION, i) for i in range(4)]


def _find(ob, path, index):
    curves = versions.channels(ob)
    return curves.find(path, index=index) if len(curves) else None


def _points(curve):
    xy = np.empty((len(curve.keyframe_points), 2), np.float32)
    curve.keyframe_points.foreach_get("co", xy.ravel())
    return xy.astype(float)


def _is(curve, frames, values, kinds):
    if curve is None or len(curve.keyframe_points) != len(frames):
        return False
    found = np.empty(len(frames), np.int32)
    curve.keyframe_points.foreach_get("interpolation", found)
    wanted = np.stack([frames, values], axis=1).astype(np.float32)
    return np.array_equal(_points(curve), wanted.astype(float)) and np.array_equal(found, kinds)


def _write(curves, path, index, frames, values, kinds):
    """Makes new keyframes: moved ones keep handles and flags of their own."""
    old = curves.find(path, index=index)
    if old:
        curves.remove(old)
    if not len(frames):
        return
    curve = curves.new(path, index=index)
    curve.keyframe_points.add(len(frames))
    xy = np.stack([frames, values], axis=1).astype(np.float32)
    curve.keyframe_points.foreach_set("co", xy.ravel())
    curve.keyframe_points.foreach_set("interpolation", kinds)
    curve.update()


# ------------------------------------------------------------------ the tool while the user turns it
def orientation(ob, frame):
    """The quaternion (4,) of an object's curves at a frame, or None."""
    curves = [_find(ob, ROTATION, i) for i in range(4)]
    return np.array([c.evaluate(frame) for c in curves]) if all(curves) else None


def settle(scene, tool, ghost, afresh=False):
    """Sets the tool's rotation to the motion's axis, with its own twist. Between its keys the tool's own curves differ
    from the motion, so this makes turning it (R) start with the visible orientation, and a keyframe (I) store that. A
    rotation that is neither comes from the user: the tool shows it until the frame changes or a key is set, which calls
    this with `afresh`."""
    frame = scene.frame_current_final
    moved, own = orientation(ghost, frame), orientation(tool, frame)
    if moved is None:
        return
    now = np.array(tool.rotation_quaternion)
    wanted = moved if own is None else quaternions.transported(quaternions.axes_of(moved)[None], own)[0]
    # its curves give shorter quaternions between keys
    right = _near(now, wanted) and abs(np.linalg.norm(now) - 1) < TURNED
    if not right and not afresh and (own is None or not _near(now, own)):
        hold(tool, False)
        return
    if not right:
        tool.rotation_quaternion = wanted
    hold(tool)


def hold(tool, held=True):
    """Lets the tool follow the motion, or, except for its location, its own rotation."""
    for name in (PLACE, TURN) if held else (TURN,):
        _influence(tool, name, float(held))


def take(tool, tip, quat):
    """Puts the tool's tip at a place of the world, in Blender units, with an orientation, until `hold`."""
    inverse = meshes.matrix(tool.parent.matrix_world.inverted()) if tool.parent else np.eye(4)
    tool.location = (inverse @ np.append(tip, 1.0))[:3]
    tool.rotation_quaternion = quat
    for name in (PLACE, TURN):
        _influence(tool, name, 0.0)


def _influence(tool, name, value):
    constraint = tool.constraints.get(name)
    if constraint is not None and constraint.influence != value:
        constraint.influence = value


def stands(scene, tool, ghost):
    """The quaternion (4,) of the tool as displayed."""
    constraint = tool.constraints.get(TURN)
    moved = orientation(ghost, scene.frame_current_final)
    if moved is None or (constraint is not None and constraint.influence == 0):
        return np.array(tool.rotation_quaternion)
    return moved


def _near(a, b):
    a, b = quaternions.unit(a), quaternions.unit(b)
    return min(np.abs(a - b).max(), np.abs(a + b).max()) < TURNED


# ------------------------------------------------------------------ marks
def name_paths(scene, names):
    """Sets timeline markers at the frames at which paths begin: (name, frame); none if `names` is empty. Removes the
    previous ones; other markers stay."""
    ours = [m for m in scene.timeline_markers if path_names.is_name(m.name)]
    if sorted(names) == sorted((m.name, m.frame) for m in ours):
        return
    for marker in ours:
        scene.timeline_markers.remove(marker)
    for name, frame in names:
        scene.timeline_markers.new(name, frame=frame)


def mark(scene, found):
    """Sets timeline markers of collisions: runs of frames. Removes the previous ones; other markers stay."""
    wanted = [(collisions.label(run), run[0]) for run in collisions.merged(found)]
    ours = [m for m in scene.timeline_markers if collisions.is_label(m.name)]
    if sorted(wanted) == sorted((m.name, m.frame) for m in ours):
        return
    for marker in ours:
        scene.timeline_markers.remove(marker)
    for name, frame in wanted:
        scene.timeline_markers.new(name, frame=frame)
