"""Kept strokes: curve objects of a sculpt whose cuts follow them, through riffler.History.

The curves and the list on the sculpt's object decide; the volume is a consequence. After any change of a curve, by
Blender's own tools, a script, undo, or the list's buttons, the volume is cut again, and this is no undo step of its
own: it belongs to the change. A sculpt's state has a token (live_sculpt.py); the list knows the token of the state that
its strokes give. If the sculpt has another one, other operations have changed it, and its strokes are at rest.
"""

import uuid

import bpy
import numpy as np
import riffler
from bpy.props import BoolProperty, CollectionProperty, IntProperty, PointerProperty, StringProperty
from mathutils import Matrix

from ..blender import curve_objects, handlers, meshes, packed_images
from ..common.contents import Content
from . import live_registry, sculpt_store, sculpts, undo_states
from .pure import sculpt_payload
from .pure.stroke_curves import Stroke, chains, fit, sampled_axes
from .pure.stroke_history import StrokeHistory, Wanted

CLASSES = ()
FIT = 0.1  # pitches: largest distance of a kept curve from the stroke that was made
EXACT = 0.02  # pitches: of the poses from the curve
TIE = "Riffler Sculpt"  # name of the constraint by which a curve moves with its sculpt
PAUSE = 1 / 30  # s from a change of a curve to its cut
WAIT = 0.5  # s, while a stroke is made or something renders
ERRORS = (ValueError, OSError, RuntimeError, MemoryError)
MASKED = "Keep Strokes as Curves needs a sculpt without a mask: clear the mask, or turn it off"
CHANGED = "Other operations have changed the sculpt since these strokes"
BORROWED = "The strokes belong to the sculpt that this one is a copy of: use Settle Strokes"
DROPPED = "Other operations had changed the sculpt: the earlier strokes are plain curves now, and part of the sculpt"

_links = {}  # id of a base (packed_images.identity) → _Link
_made = {}  # token of a live state → mark of the strokes that made it, if it was cut again under the same token


def _switched(self, context):
    soon()


class RifflerKeptStroke(bpy.types.PropertyGroup):
    """On a curve object: what its stroke is, without its curve (pure/stroke_curves.py)."""

    text: StringProperty(description="The stroke's tool, mode and axes, as JSON; empty: no stroke")


class RifflerStrokeRow(bpy.types.PropertyGroup):
    key: StringProperty(description="Identifier of the stroke, which stays")
    curve: PointerProperty(type=bpy.types.Object, name="Curve", description="Curve of the stroke")
    on: BoolProperty(name="Enabled", default=True, update=_switched, description="Cut this stroke; off: leave it out")
    problem: StringProperty(description="Why the stroke could not be cut")


class RifflerKeptStrokes(bpy.types.PropertyGroup):
    """On a sculpt's object."""

    rows: CollectionProperty(type=RifflerStrokeRow)
    index: IntProperty(name="Stroke", description="Chosen stroke of the list")
    base: PointerProperty(type=bpy.types.Image, description="The sculpt before its kept strokes")
    token: StringProperty(description="State that the strokes give")
    made: StringProperty(description="Mark of the strokes that the state was made from")


class _Link:
    """The history of a base, and the chains of each curve, by a mark of all that they depend on."""

    def __init__(self, base):
        self.history, self.known = StrokeHistory(base), {}


# ------------------------------------------------------------------ reading
def there(ob):
    return bool(ob.riffler.strokes.rows)


def at_rest(ob):
    """Whether other operations have changed the sculpt since its strokes were cut, or the strokes are another's."""
    return there(ob) and (_token(ob) != ob.riffler.strokes.token or borrowed(ob))


def borrowed(ob):
    """Whether its strokes move with another sculpt, whose copy this is."""
    ties = [tie for row in ob.riffler.strokes.rows if row.curve is not None for tie in row.curve.constraints]
    return any(tie.name == TIE and tie.target not in (None, ob) for tie in ties)


def _token(ob):
    live = live_registry.of(ob)
    return live.token if live is not None else sculpt_store.token(ob.data)


def sculpts_with_strokes():
    return [ob for ob in bpy.data.objects if sculpts.is_sculpt(ob) and ob.riffler.strokes.rows]


def sculpt_of(curve):
    """The sculpt with a stroke along this curve object, or None."""
    return next(
        (ob for ob in sculpts_with_strokes() if any(row.curve == curve for row in ob.riffler.strokes.rows)), None
    )


def frame(ob, curve):
    """(4, 4): Blender units of the curve → mm of the sculpt. If the curve is tied to the sculpt, it is the same for any
    place of the sculpt."""
    if curve.parent is not None or [c.name for c in curve.constraints] != [TIE] or curve.constraints[0].target != ob:
        return sculpts.from_object(ob, curve)
    m = meshes.matrix(curve.matrix_basis)
    m[:3] *= sculpts.shown_mm_per_unit(ob.data)
    return m


def tie(ob, curve):
    """Lets a curve without a parent move with the sculpt, from where it is. A child would be displayed at each vertex
    of the sculpt's hidden mesh (chunks.hide)."""
    if curve.parent is not None or curve.constraints:
        return
    curve.matrix_basis = ob.matrix_world.inverted() @ curve.matrix_basis
    made = curve.constraints.new("CHILD_OF")
    made.name, made.target, made.inverse_matrix = TIE, ob, Matrix()


def _link(ob):
    image = ob.riffler.strokes.base
    key = packed_images.identity(image)
    if not key:
        raise ValueError(f"{ob.name}: the sculpt before its strokes is not in this file")
    if key not in _links:
        block, cuts, _, shaped = sculpt_payload.decode(packed_images.read(image, "the strokes' base"), key)
        _links.clear()  # of other sculpts, too: their bases may be large
        _links[key] = _Link(Content(riffler.Volume.from_bytes(block, name=ob.name), cuts, None, shaped))
    return _links[key]


def _wanted(ob, link):
    """The chains of all strokes, and the mark of them all. ValueError names a stroke that cannot be cut."""
    wanted, marks, pitch = [], [], ob.data.riffler.pitch
    for row in ob.riffler.strokes.rows:
        curve = row.curve
        if _lost(row):
            marks.append((row.key, "gone"))
            continue
        try:
            lines = curve_objects.splines(curve, None, frame(ob, curve))
            arrays = [a for s in lines for a in (s.points, s.tilt, s.left, s.right, s.weights) if a is not None]
            kinds = [(s.kind, s.cyclic, s.order, s.endpoint, s.bezier) for s in lines]
            block = b"".join(np.ascontiguousarray(a, float).tobytes() for a in arrays)
            mark = sculpt_payload.content_id(block + repr((kinds, curve.riffler.stroke.text, pitch)).encode())
            if link.known.get(row.key, ("",))[0] != mark:
                made = chains(Stroke.of_text(curve.riffler.stroke.text), lines, pitch, EXACT * pitch)
                link.known[row.key] = mark, made
        except ValueError as error:
            row.problem = f"{curve.name}: {error}"
            raise ValueError(row.problem) from error
        if row.problem:
            row.problem = ""
        marks.append((mark, row.on))
        wanted += [Wanted((row.key, k), mark, chain, row.on) for k, chain in enumerate(link.known[row.key][1])]
    return wanted, sculpt_payload.content_id(repr(marks).encode())


# ------------------------------------------------------------------ cutting again
def sync(ob, token=""):
    """Cuts the sculpt again if its strokes differ from those that it was made from. `token`: of an operator that makes
    an undo step, a new state's. True if something was cut. ValueError names a stroke that cannot be cut; then nothing
    has changed."""
    own = ob.riffler.strokes
    live = live_registry.of(ob)
    if not own.base or at_rest(ob) or ob.library:
        return False
    link = _link(ob)
    wanted, mark = _wanted(ob, link)
    was = _made.get(live.token, own.made) if live is not None else own.made
    if mark == was:
        return False
    link.history.follow(wanted)
    content = link.history.content()
    if live is not None:
        live.recut(content, token)
        _made[live.token] = mark
    else:
        with sculpts.in_object_mode(ob):
            sculpts.commit(ob.data, content, sculpts.shown_mm_per_unit(ob.data), token or own.token)
    if token:
        own.token = token
    own.made = mark
    for k in reversed(range(len(own.rows))):  # a stroke whose curve was deleted is no stroke any more
        if _lost(own.rows[k]):
            own.rows.remove(k)
    return True


def edit(ob):
    """Cuts again after an operator has changed list or curves. ValueError: the caller undoes its change."""
    if at_rest(ob):
        raise ValueError(BORROWED if borrowed(ob) else CHANGED)
    return sync(ob, uuid.uuid4().hex)


def begin(ob, content):
    """Makes ready for another stroke on the sculpt's content: with a new base, if its strokes do not give it. Returns
    how many strokes of an older list are no strokes any more."""
    own = ob.riffler.strokes
    if own.base and _token(ob) == own.token and not borrowed(ob):
        return 0
    dropped = new_base(ob, content)
    own.token = _token(ob)
    return dropped


def restore(ob):
    """Makes the sculpt what its strokes give, without the changes since then. ValueError if they cannot be cut."""
    if borrowed(ob):
        raise ValueError(BORROWED)
    own = ob.riffler.strokes
    token, made, own.token, own.made = own.token, own.made, _token(ob), ""
    _made.pop(own.token, None)
    try:
        sync(ob, uuid.uuid4().hex)
    except ERRORS:
        own.token, own.made = token, made
        raise


def new_base(ob, content):
    """Begins a list of strokes on this content. Returns how many strokes of an older list are no strokes any more."""
    own = ob.riffler.strokes
    dropped = forget(ob)
    image = own.base
    if image is None or image.library or any(o != ob and o.riffler.strokes.base == image for o in bpy.data.objects):
        image = own.base = packed_images.new(f"{ob.name} base")
    block = sculpt_payload.encode(content.volume.to_bytes(), content.cuts, b"", content.shaped)
    packed_images.write(image, block, sculpt_payload.content_id(block))
    own.made = sculpt_payload.content_id(repr([]).encode())
    return dropped


def forget(ob):
    """Ends the list: its curves are plain curves, and their cuts part of the sculpt."""
    own = ob.riffler.strokes
    count, others = len(own.rows), borrowed(ob)
    for row in own.rows:
        if row.curve is not None and not others:
            row.curve.riffler.stroke.text = ""
    own.rows.clear()
    own.base, own.token, own.made = None, "", ""
    return count


# ------------------------------------------------------------------ keeping
def check(run):
    """ValueError if the strokes of a live sculpt cannot be kept."""
    if run.mask is not None:
        raise ValueError(MASKED)


def keep(context, run, made, choice):
    """Keeps a stroke that a live sculpt has just made, `made` a BrushStroke, before it is finished: the sculpt is cut
    along the curve in its place. Returns how many older strokes are no strokes any more."""
    ob, own, begin = run.object, run.object.riffler.strokes, run.stroke.begin
    dropped = new_base(ob, begin) if not own.base or run.token != own.token or borrowed(ob) else 0
    brush, pitch = made.brush, run.volume.pitch
    lines = [fit(path[:, :3], FIT * pitch)[0] for path in made.kept_paths]
    stroke = Stroke(
        made.tool.to_dict(),
        "add" if brush.cuts == "add" else "remove",
        brush.hand,
        lean=0.0 if choice.axis == "TILT" else choice.lean,
        turn=choice.turn,
        heading=tuple(made.heading),
        axes=tuple(sampled_axes(path) for path in made.kept_paths),
        maps=tuple(run.maps) if len(run.maps) > 1 else (),
        centre=tuple(map(float, run.centre)),
    )
    curve = _curve_object(context, ob, f"{ob.name} {brush.label}", lines)
    add_row(ob, curve, stroke)
    try:
        link = _link(ob)
        wanted, mark = _wanted(ob, link)
        link.history.follow(wanted)
    except ERRORS:
        drop_last(ob)
        raise
    new = [w.chain for w in wanted if w.key[0] == own.rows[-1].key]
    tools = [riffler.Tool.from_dict(chain.tool) for chain in new]
    run.exchange(link.history.volume)
    for k, (tool, chain) in enumerate(zip(tools, new, strict=True)):
        run.persistence.carved(chain.tool, chain.poses, brush.journal, run.stroke.token, strength=run.strength)
        brush.record(run.stroke, k, tool, chain.poses, True)
    own.token, own.made = run.stroke.token, mark
    return dropped


def add_row(ob, curve, stroke):
    curve.riffler.stroke.text = stroke.text()
    own = ob.riffler.strokes
    row = own.rows.add()
    row.key, row.curve = uuid.uuid4().hex, curve
    own.index = len(own.rows) - 1
    return row


def drop_last(ob):
    """Removes the newest stroke and its curve: it has changed nothing."""
    own = ob.riffler.strokes
    curve = own.rows[-1].curve
    own.rows.remove(len(own.rows) - 1)
    if curve is not None:
        bpy.data.curves.remove(curve.data)


def _curve_object(context, ob, name, lines):
    """A curve object of splines in mm of the sculpt, its child."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    unit = sculpts.shown_mm_per_unit(ob.data)
    for line in lines:
        spline = data.splines.new(line.kind)
        spline.points.add(len(line.points) - 1)
        spline.points.foreach_set("co", np.c_[line.points / unit, np.ones(len(line.points))].ravel())
        if line.kind == "NURBS":
            spline.order_u, spline.use_endpoint_u = line.order, True
    curve = bpy.data.objects.new(name, data)
    curve.show_in_front = True
    collection_of(context, ob).objects.link(curve)
    curve.matrix_basis = ob.matrix_world
    tie(ob, curve)
    curve.matrix_basis = Matrix()  # without the rounding of the product
    return curve


def collection_of(context, ob):
    """The collection of the sculpt's curves, made if there is none: that of its first curve."""
    for row in ob.riffler.strokes.rows:
        if row.curve is not None and row.curve.users_collection:
            return row.curve.users_collection[0]
    made = bpy.data.collections.new(f"{ob.name} Strokes")
    context.scene.collection.children.link(made)
    return made


# ------------------------------------------------------------------ what Blender tells
def soon():
    """Cuts again after a change: in a window a moment later, without one at once."""
    if bpy.app.background:
        _due()
    elif not bpy.app.timers.is_registered(_due):
        bpy.app.timers.register(_due, first_interval=PAUSE)


def _due():
    """Timer function."""
    if bpy.app.is_job_running("RENDER") or any(live.in_stroke for live in live_registry.awake()):
        return WAIT
    for ob in sculpts_with_strokes():
        try:
            sync(ob)
        except ERRORS as error:
            undo_states.tell(str(error))
    return None


@bpy.app.handlers.persistent
def _on_update(scene, depsgraph):
    if depsgraph.mode == "RENDER":
        return
    changed = [update.id.original for update in depsgraph.updates]
    of_curves = (isinstance(c, bpy.types.Curve | bpy.types.Scene) or getattr(c, "type", "") == "CURVE" for c in changed)
    if any(of_curves) and sculpts_with_strokes():
        soon()


def _lost(row):
    """Whether the stroke's curve was deleted: the list alone still refers to it."""
    return row.curve is None or not row.curve.users_collection


@bpy.app.handlers.persistent
def _on_history(*_):
    if sculpts_with_strokes():
        soon()


@bpy.app.handlers.persistent
def _on_load(*_):
    _links.clear()
    _made.clear()


@bpy.app.handlers.persistent
def _on_save(*_):
    if not bpy.app.background and bpy.app.timers.is_registered(_due):
        _due()


_HANDLERS = {
    "depsgraph_update_post": _on_update,
    "undo_post": _on_history,
    "redo_post": _on_history,
    "load_post": _on_load,
    "save_pre": _on_save,
}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    handlers.stop(_due)
    _on_load()
