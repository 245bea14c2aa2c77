"""Verifies a program on its stock: gouges, rapids in material, collisions of holder and fixtures, rest material."""

import hashlib
import json
from dataclasses import dataclass

import bpy
import numpy as np
import riffler
from bpy.props import BoolProperty, EnumProperty, IntProperty

from ..blender import attributes, handlers, meshes, object_surfaces, operator_parts, scene_units
from ..blender.long_work import LongWork
from ..common import colours, poses, units
from ..common.job import ChainJob, ThreadTask
from ..plan import findings, obstacles, plan_store
from ..plan.pure.clearance import check_fixture
from ..sculpt import sculpts
from ..translations import local
from . import programs, properties, simulation
from .pure import finding_titles

MOST = 1000  # rows in the list
CUTS = ("LINE", "TOOL")  # colours by what cut
_last = None  # the last verification: an edited program is verified again only where it differs


@dataclass
class _Kept:
    key: str
    verification: riffler.Verification


class RIFFLER_OT_verify(LongWork, properties.VerifySettings, properties.GivenOptions, bpy.types.Operator):
    """Run the program on its stock and list its errors: gouges, rapids in material, collisions of holder and
    fixtures"""

    bl_idname = "riffler.verify"
    bl_label = "Verify"
    bl_options = {"REGISTER", "UNDO"}
    doing = "Verifying"
    cancelled = "Not verified: nothing has changed"

    hide: BoolProperty(
        name="Hide Other Objects", default=True, description="Hide the objects that would cover the colours"
    )

    @classmethod
    def poll(cls, context):
        return simulation.program_poll(cls, context) and not operator_parts.busy(cls, context)

    def begin(self, context):
        setup = programs.take(context, self)
        self._part, part, held = _around(context, setup)
        for name, mesh in [(self._part, part), *held] if part is not None else held:
            operator_parts.tell_turned(self, name, mesh)
        fixtures = [mesh for _, mesh in held]
        self._setup = setup
        limits = {
            "gouge_tolerance": scene_units.clean(self.gouge) + setup.deepest,
            "rest_tolerance": scene_units.clean(self.rest) or None,
        }
        if part is None:
            limits["rest_tolerance"] = None
        if setup.machine:
            limits.update(machine=setup.machine, machine_options=setup.options, machine_frame=setup.to_machine.tolist())
        steps = [
            lambda _: ThreadTask(lambda progress: _verification(setup, part, fixtures, limits, progress)),
            lambda verification: riffler.submit(riffler.Verification.run, verification, setup.program),
        ]
        if self.coloured in CUTS:
            steps.append(lambda report: ThreadTask(lambda progress: (report, _cuts(setup, report, progress))))
        return ChainJob(*steps)

    def lost(self, context):
        if context.scene.objects.get(self._setup.sculpt) is None:
            return f"Not verified: {self._setup.sculpt} was removed or renamed meanwhile"
        return ""

    def finish(self, context, job):
        report, cuts = job.result if self.coloured in CUTS else (job.result, None)
        setup = self._setup
        settings = context.scene.riffler.verify
        found = report.findings
        findings.write(settings.findings, [_entry(f, setup) for f in found[:MOST]])
        settings.index = -1
        kept = _show_text(settings, setup)
        coloured = self._colour_cuts(context, cuts) if cuts else self._colour(context, report)
        more = " ".join([*report.not_checked, *coloured, *kept])
        if found:
            settings.said = f"{setup.name}: {units.counted(len(found), 'finding')}"
        else:
            settings.said = f"{setup.name}: nothing was found" + ("" if report.passed else ", not all was checked")
        if setup.deepest:
            settings.said += f"; up to {units.trim(setup.deepest)} mm below the part's surface are to be cut"
        notes = " ".join(f"{local(said)}." for said in setup.notes)
        level = {"INFO"} if report.passed and not notes else {"WARNING"}
        self.report(level, " ".join(filter(None, (f"{settings.said}.", notes, more))))
        return {"FINISHED"}

    def _colour(self, context, report):
        """Shows the distances between the part and the remaining stock; returns reasons why not, as sentences."""
        ob, stock = context.scene.objects.get(self._part), context.scene.objects[self._setup.sculpt]
        _clear(context)
        if ob is None or self.coloured == "NONE":
            return []
        if self.coloured == "LEFT":
            mesh, distance = report.stock_deviation()
            ob = _left(context, mesh, stock)
        else:
            distance = np.asarray(report.part_deviation())
            own = ob.type == "MESH" and len(ob.data.vertices) == len(distance)
            if not own or ob.library or ob.data.library:
                why = f"{ob.name} is not coloured, since it is not a plain mesh of this file"
                return [f"{why}: colour Remaining Stock instead."]
        if sculpts.is_sculpt(ob) and ob.data.riffler.shown_within:
            why = f"{ob.name} is not coloured, since it shows only the triangles that its shape needs"
            return [f"{why}: show all of them, or colour Remaining Stock."]
        attributes.show_distance(ob.data, distance, scene_units.clean(self.scale))
        attributes.shade_by_attribute()
        if self.hide:
            part = context.scene.objects[self._part]
            _hide(context, [other for other in (stock, part) if other != ob])
        return []

    def _colour_cuts(self, context, cuts):
        """Shows on the remaining stock which lines or tools cut it; returns no reasons why not."""
        surface, values = cuts
        stock, part = context.scene.objects[self._setup.sculpt], context.scene.objects.get(self._part)
        _clear(context)
        ob = _left(context, surface, stock)
        rows, tools = values[attributes.ROW], values[attributes.TOOL]
        by_line = self.coloured == "LINE"
        shown = colours.of_sequence(rows, len(self._setup.program.poses)) if by_line else colours.of_kinds(tools)
        attributes.show_cuts(ob.data, values, shown)
        attributes.shade_by_attribute()
        if self.hide:
            _hide(context, [other for other in (stock, part) if other is not None])
        return []

    def draw(self, context):
        operator_parts.draw_fields(self, ("source", "gouge", "rest", "coloured", "scale", "hide"))


def _cuts(setup, report, progress):
    """The remaining stock's surface, and which row, line and tool made each of its faces. Runs off Blender's thread."""
    surface = report.volume.to_mesh()
    corners = np.asarray(surface.vertices)[np.asarray(surface.triangles)]
    pitch = setup.stock.pitch
    rows = np.asarray(setup.program.rows_at(corners.mean(axis=1), tolerance=0.25 * pitch, progress=progress))
    made = rows >= 0
    lines, tools = (np.where(made, np.asarray(column)[rows], -1) for column in (setup.program.line, setup.program.tool))
    return surface, {attributes.ROW: rows, attributes.LINE: lines, attributes.TOOL: tools}


def _show_text(settings, setup):
    """Shows the program's lines in the list; returns notes on the previous text, as sentences."""
    if not setup.text:
        settings.text = None  # lines of another program would mislead
        return []
    settings.text, edited = findings.text_of(settings.text, setup.name, setup.text)
    return [f"The text {edited} was edited and is kept: the lines are in {settings.text.name}."] if edited else []


def _left(context, surface, stock):
    """A new object with the remaining stock, at the stock's place."""
    mesh = bpy.data.meshes.new(f"{stock.name} Left")
    ob = context.scene.riffler.verify.left = bpy.data.objects.new(mesh.name, mesh)
    for collection in stock.users_collection:
        collection.objects.link(ob)
    meshes.fill(mesh, np.asarray(surface.vertices) / sculpts.shown_mm_per_unit(stock.data), surface.triangles)
    ob.matrix_world = stock.matrix_world
    return ob


def _hide(context, objects):
    shown = [ob for ob in objects if ob.name in context.view_layer.objects and not ob.hide_get()]
    context.scene.riffler.verify.hidden = "\n".join(ob.name for ob in shown)
    for ob in shown:
        ob.hide_set(True)


def _clear(context):
    """Removes the colours and the object that was made for them, and shows the objects hidden for them."""
    settings = context.scene.riffler.verify
    for ob in context.scene.objects:
        if ob.type == "MESH" and attributes.SCALE in ob.data and not ob.data.library:
            attributes.hide_colours(ob.data)
            if sculpts.is_sculpt(ob):
                sculpts.show_needed(ob.data)
    attributes.settle()
    for name in settings.hidden.split("\n"):
        ob = context.scene.objects.get(name)
        if ob is not None and ob.name in context.view_layer.objects:
            ob.hide_set(False)
    settings.hidden = ""
    if settings.left is not None:
        mesh = settings.left.data
        bpy.data.objects.remove(settings.left)
        if mesh.users == 0:  # a linked duplicate of it belongs to the user
            bpy.data.meshes.remove(mesh)


def _around(context, setup):
    """The part's name, the part, and the fixtures with their names, in the stock's frame; no part if none is set."""
    plan_ob = context.scene.objects.get(setup.plan) if setup.plan else plan_store.active(context)
    ob = obstacles.part_of(context.scene, plan_ob)
    to_stock = np.linalg.inv(setup.to_world)
    held = [(f.name, _fixture(context, f, to_stock)) for f in obstacles.fixture_objects(context.scene.riffler.plan, ob)]
    if ob is None:
        return "", None, held
    return ob.name, _moved(object_surfaces.in_world(context, ob), to_stock), held


def _fixture(context, ob, to_stock):
    mesh = object_surfaces.in_world(context, ob)
    check_fixture(mesh, ob.name)
    return _moved(mesh, to_stock)


def _moved(mesh, matrix):
    return riffler.Mesh(poses.transform_points(matrix, np.asarray(mesh.vertices)), mesh.triangles)


def _verification(setup, part, fixtures, limits, progress):
    """The previous verification, if stock, surroundings and limits are the same. Runs off Blender's thread."""
    global _last
    digest = hashlib.sha256(setup.stock.to_bytes())
    for mesh in (m for m in (part, *fixtures) if m is not None):
        digest.update(riffler.plan.part_of(mesh, "")["sha256"].encode())
    digest.update(json.dumps([part is None, limits], sort_keys=True).encode())
    if _last is None or _last.key != digest.hexdigest():
        made = riffler.Verification(setup.stock, part, fixtures, progress=progress, **limits)
        _last = _Kept(digest.hexdigest(), made)
    return _last.verification


def _entry(found, setup):
    place = poses.transform_points(setup.to_world, np.asarray(found.point, float)[None])[0]
    row = int(found.row)
    return {
        "name": str(found.message),
        "title": finding_titles.verified(
            local(finding_titles.KINDS[str(found.kind)]), float(found.value) if found.unit else 0.0, place
        ),
        "kind": str(found.kind),
        "row": row,
        "line": int(found.line),
        "frame": float(setup.program_timeline.frame_of(min(row, len(setup.program.poses) - 1))),
        "place": tuple(map(float, place)),
    }


class RIFFLER_OT_finding_go(bpy.types.Operator):
    """Go to the finding: its frame, its place in the view and its line of the NC code"""

    bl_idname = "riffler.finding_go"
    bl_label = "Go to Finding"
    bl_options = {"REGISTER"}  # in Blender a change of frame or view is not an undo step

    of: EnumProperty(
        name="List",
        items=(
            ("VERIFY", "Verified", "Findings of verifying a program"),
            ("PLAN", "Plan", "Findings of resolving a plan"),
        ),
        description="List that has the finding",
    )
    index: IntProperty(name="Number", default=0, min=0, description="Position in the list, from 0")

    @classmethod
    def poll(cls, context):
        if context.scene.riffler.verify.findings or _plan_findings(context):
            return True
        return operator_parts.deny(cls, "There are no findings: use Verify first, or Resolve")

    def execute(self, context):
        settings, plan_ob = context.scene.riffler.verify, plan_store.active(context)
        listed = settings.findings if self.of == "VERIFY" else _plan_findings(context)
        if self.index >= len(listed):
            return operator_parts.fail(
                self, ValueError(f"There is no finding {self.index}: the list has {len(listed)}")
            )
        item = listed[self.index]
        try:
            frame = findings.frame_of(item, plan_ob)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        if self.of == "VERIFY":
            settings.index = self.index
        else:
            plan_ob.riffler.plan.index = self.index
        findings.go(context, item, frame, settings.text if self.of == "VERIFY" else None)
        return {"FINISHED"}


def _plan_findings(context):
    plan_ob = plan_store.active(context)
    return plan_ob.riffler.plan.findings if plan_ob is not None else ()


class RIFFLER_OT_verify_clear(bpy.types.Operator):
    """Remove the list of findings, and the colours of the part"""

    bl_idname = "riffler.verify_clear"
    bl_label = "Clear Findings"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if not context.scene.riffler.verify.said:
            return operator_parts.deny(cls, "Nothing was verified")
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context, simulation=False)

    def execute(self, context):
        settings = context.scene.riffler.verify
        settings.findings.clear()
        settings.said, settings.index = "", -1
        _clear(context)
        return {"FINISHED"}


@bpy.app.handlers.persistent
def _forget(*_):
    global _last
    _last = None


_HANDLERS = {"load_post": _forget}
CLASSES = (RIFFLER_OT_verify, RIFFLER_OT_finding_go, RIFFLER_OT_verify_clear)


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    _forget()
