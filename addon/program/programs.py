"""Programs of a plan, of a file, of a sculpt's cuts; and their form for simulation and verification: in the frame of
the stock, and on the timeline."""

import re
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
import riffler

from ..blender import refusals, scene_units
from ..common import json_object, problems, units
from ..machining import inputs, job_program
from ..plan import fit_check, obstacles, plan_states, plan_store, replan, timeline
from ..plan.pure import machine_fields
from ..sculpt import live_registry, sculpts
from ..stock import cut_program
from .pure import program_timeline
from .pure.program_timeline import ProgramTimeline


# ------------------------------------------------------------------ of a plan
def left_out(plan):
    """A sentence on the paths that are not cut, or ""."""
    bare, off = sorted({*range(len(plan.paths))} - {*plan_store.wanted(plan)} - plan.off), sorted(plan.off)
    have, are = ("has" if len(bare) == 1 else "have"), ("is" if len(bare) == 1 else "are")
    said = [f"{numbered(bare).capitalize()} {have} no keys and {are} not cut"] if bare else []
    said += [f"{numbered(off).capitalize()} {'is' if len(off) == 1 else 'are'} off and not cut"] if off else []
    return ". ".join(said)


def nothing_wanted(plan):
    """Why no path is to be cut."""
    if any(len(path.axes) for path in plan.paths):
        return "Every path with an orientation is off: switch one on in the list of paths"
    return "No path has an orientation: set a key first"


def ready(context, ob, plan):
    """The obstacles.Taken of a plan that is ready for a program. ValueError with the remedy if it is not."""
    if not plan.paths:
        raise ValueError(f"{ob.name} has no paths: find some first")
    if not plan_store.wanted(plan):
        raise ValueError(nothing_wanted(plan))
    taken = obstacles.take(context, ob)
    if moved := fit_check.part_note(plan, taken):
        raise ValueError(moved)
    missing = plan_store.unresolved(plan)
    if missing:
        raise ValueError(
            f"{numbered(missing)} may collide: use Resolve, turn the keys where it finds no solution, or switch "
            "the path off"
        )
    clearance = scene_units.clean(context.scene.riffler.plan.clearance)
    if plan.provenance.get(plan_store.RESOLVED) != taken.fingerprint(plan.tool, clearance):
        raise ValueError(
            "Part, fixtures, tool or clearance have changed since the paths were resolved: use Resolve again"
        )
    return taken


def numbered(paths):
    """“path 3”, “paths 1, 2”, counted from 1, for numbers from 0."""
    shown = ", ".join(str(k + 1) for k in paths[:6]) + (" …" if len(paths) > 6 else "")
    return f"{'path' if len(paths) == 1 else 'paths'} {shown}"


def made_of(context, ob):
    """The last riffler.Program made of a plan; None once the plan, or the panel's links between its paths, have
    changed."""
    mark, program = plan_states.state(ob).program
    return program if mark == _mark(context, ob) else None


def _mark(context, ob):
    links = _links(context.scene.riffler.plan)
    return plan_store.identity(ob), scene_units.clean(context.scene.riffler.plan.clearance), *map(str, links.values())


def of_plan(context, ob, plan, feed, spindle):
    """The riffler.Program of all paths to cut, in order, in the scene's millimetres."""
    taken, chosen = ready(context, ob, plan), plan_store.wanted(plan)
    settings = context.scene.riffler.plan
    collider = taken.result().collider
    provenance = {
        "plan": ob.name,
        "part": f"{taken.who[0]} {taken.prints[0][:16]}",
        "paths": f"{len(chosen)}, {units.trim(sum(plan.paths[k].length for k in chosen), 1)} mm",
        "clearance": f"{units.trim(scene_units.clean(settings.clearance), 4)} mm",
        "plan id": plan_store.identity(ob)[:16],
    }
    how = {"feed": feed, "spindle": spindle, "occupied": taken.bounds, "provenance": provenance}
    how |= {"collider": collider, "contact_tolerance": touch(plan), **_links(settings)}
    try:
        program = riffler.Program.from_cl([plan.cl[k] for k in chosen], tools=[plan.tool] * len(chosen), **how)
    except ValueError as error:
        # The panel's numbers, and the names of its fields.
        text = re.sub(r"^path (\d+)\b", lambda found: f"Path {chosen[int(found[1])] + 1}", str(error))
        raise ValueError(text.replace("safe_height", "Clearance Plane")) from None
    plan_states.state(ob).program = _mark(context, ob), program
    return program


def touch(plan):
    """mm by which a plan's tool may enter part and fixtures: the tolerance of its locations, the same again between
    blocks, rounding, and the depth of its cut."""
    return 3 * (plan.tolerance or 0.01) + plan.deepest


def _links(settings):
    """Approaches and retracts between cuts, for Program.from_cl; 0 means automatic."""
    return {
        "safe_height": scene_units.clean(settings.plane) or None,
        "retract": scene_units.clean(settings.retract) or None,
        "direction": (0.0, 0.0, 1.0) if settings.leave == "UP" else None,
        "lead_in": scene_units.clean(settings.lead_in) or None,
    }


def write(program, plan, path, post, chosen, collider=None):
    """Writes a plan's program as NC code; returns the result of Program.write. With a `collider` the machine's motion
    is checked: nothing is written that enters part or fixtures."""
    how = {"tolerance": plan.tolerance or 0.01, "options": chosen}
    return program.write(path, post=post, collider=collider, contact_tolerance=touch(plan), **how)


def rewound(written):
    """Notes on where a written program turns an axis back."""
    if not len(written.rewinds):
        return []
    rows = ", ".join(str(int(r)) for r in np.atleast_1d(written.rewinds)[:4])
    return [f"The tool leaves the material to turn an axis back, at rows {rows}"]


def options(scene, machine, text=""):
    """A machine's options: from JSON, or the scene's settings for it. ValueError if the text is invalid, and if a
    required option is missing."""
    if text.strip():
        return json_object.loads(text, 'options, as {"max_rotary": 3600}')
    given = scene.riffler.machines.given(machine)
    machine_fields.check(machine, given)
    return given


# ------------------------------------------------------------------ on a stock
@dataclass
class Setup:
    """A program on its stock. `program`, `stock`: in the stock's frame, mm; `to_world`: (4, 4) from there to the
    scene's mm; `text`: the NC code that the program's line numbers refer to; `plan`: name of the plan's object, or "".
    """

    name: str
    program: riffler.Program
    stock: riffler.Volume
    sculpt: str
    to_world: np.ndarray
    program_timeline: ProgramTimeline
    text: str = ""
    machine: str = ""  # its machine
    options: dict = field(default_factory=dict)
    in_machine: bool = False  # True if the program is in the stock's frame on the machine, not in the scene's
    plan: str = ""
    notes: tuple = ()  # sentences on what the program leaves out
    deepest: float = 0.0  # mm below the part's surface that are meant to be cut
    to_zero: np.ndarray = field(default_factory=lambda: np.eye(4))  # the scene's mm → the program's on the machine

    @property
    def to_machine(self):
        """(4, 4) from the stock's frame to the program's frame on the machine."""
        return np.eye(4) if self.in_machine else self.to_zero @ self.to_world

    @property
    def runs(self):
        """(tool, poses) for ProgramPrefix."""
        return [(self.program.tools[number], poses) for number, poses in self.program.cuts()]


def stock_object(context):
    """The stock of the scene's settings, or the active sculpt, or None."""
    chosen = context.scene.riffler.verify.stock
    return sculpts.in_scene(chosen, context.scene) or sculpts.active(context)


def no_stock(context):
    """Why there is no stock, with the remedy."""
    return refusals.instance(context.object) or "There is no stock: select a sculpt, or make one that the part lies in"


def take(context, wanted):
    """The Setup for `wanted` (properties.ProgramSettings). ValueError, OSError if there is none."""
    live_registry.end_all()
    ob = inputs.stock_of(context.scene) if wanted.source == "JOB" else stock_object(context)
    if ob is None:
        raise ValueError(inputs.NO_STOCK if wanted.source == "JOB" else no_stock(context))
    if wanted.source == "CUTS":
        return _noted(_cuts(context, ob), ob)
    content = live_registry.content(ob)
    found = {"PLAN": _plan, "FILE": _file, "JOB": _job}[wanted.source](context, wanted)
    in_stock = wanted.source == "FILE" and wanted.frame == "STOCK"
    to_world = sculpts.rigid_to_world(context, ob)
    if not in_stock:
        found.program = found.program.transformed(np.linalg.inv(to_world))
    found.in_machine = in_stock
    found.stock, found.sculpt, found.to_world = content.volume.copy(), ob.name, to_world
    return _noted(found, ob)


def _noted(setup, ob):
    setup.notes = tuple(filter(None, (*setup.notes, refusals.modified(ob))))
    return setup


def _new(name, program, where, **more):
    return Setup(name, program, None, "", np.eye(4), where, **more)


def _cuts(context, ob):
    settings, content = context.scene.riffler.nc, live_registry.content(ob)
    v, cuts = content.volume, cut_program.removing(ob.name, content)
    program = cut_program.of_cuts(
        ob.name, cuts, v, scene_units.clean(settings.feed), scene_units.clean(settings.spindle)
    )
    out = _new(f"{ob.name}'s cuts", program, _timed(context.scene, program), machine=settings.post, in_machine=True)
    out.stock = riffler.Volume.block(v.lower, v.upper, v.pitch, v.directions)
    out.sculpt, out.to_world = ob.name, sculpts.rigid_to_world(context, ob)
    out.notes = tuple(cut_program.not_in_cuts(content))
    return out


def _job(context, wanted):
    program, given = job_program.of_scene(context)
    settings, scene = context.scene.riffler.plan, context.scene
    more = {"machine": settings.post, "options": options(scene, settings.post), "to_zero": job_program.to_zero(scene)}
    return _new(f"{given.names[0]}'s job", program, _timed(scene, program), **more)


def _plan(context, wanted):
    ob = plan_store.active(context)
    if ob is None:
        raise ValueError("There is no plan: select one, or find paths on a part")
    settings, plan = context.scene.riffler.plan, plan_store.plan(ob)
    program = of_plan(context, ob, plan, scene_units.clean(settings.feed), scene_units.clean(settings.spindle))
    where = _timed(context.scene, program)
    if timeline.pair(ob) is not None and replan.fits(ob, plan):
        where = program_timeline.of_paths(program.poses, _played_paths(context, ob, plan))
    chosen = options(context.scene, settings.post)
    program, text = _with_lines(program, plan, settings.post, chosen)
    more = {"machine": settings.post, "options": chosen, "plan": ob.name, "deepest": plan.deepest}
    return _new(ob.name, program, where, text=text, notes=tuple(filter(None, [left_out(plan)])), **more)


def _played_paths(context, ob, plan):
    """[(rows, frames)] of the paths to cut, as a plan plays them on the timeline."""
    replan.sync(context.scene, ob)
    played = [e.motion for e in plan_states.state(ob).motions]
    return [(played[k].poses, played[k].frames) for k in plan_store.wanted(plan) if k < len(played) and len(played[k])]


def _with_lines(program, plan, post, chosen):
    """A plan's program with its rows' line numbers in the NC code, and that code; neither if riffler cannot read the
    machine's language."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "program.ngc"
        write(program, plan, path, post, chosen)
        text = path.read_text(encoding="utf-8", errors="replace")
        try:
            read = riffler.Program.read(path, machine=post, options=_of_reading(chosen))
        except ValueError:
            return program, ""
    lines = program_timeline.lines(program.poses, read.poses, read.line)
    more = {"spindle": program.spindle, "tools": program.tools}
    more |= {"provenance": program.provenance, "notes": program.notes, "at_machine": program.at_machine}
    more |= {"via": program.via}
    more |= {"rapid": program.rapid, "tool": program.tool, "line": lines}
    return riffler.Program(program.poses, program.feed, **more), text


def _of_reading(chosen):
    """The options without those that only control how code is written."""
    written = ("line_numbers", "coolant", "retract", "safe_start", "safe_height", "arcs", "max_rotary")
    return {key: value for key, value in chosen.items() if key not in written and not key.startswith("rate_")}


def _file(context, wanted):
    if not wanted.filepath:
        raise ValueError("Choose an NC file")
    path = Path(bpy.path.abspath(wanted.filepath))
    problems.check_source(path)
    saved = path.suffix.lower() == ".rprog"
    chosen = options(context.scene, wanted.machine, getattr(wanted, "options", ""))
    program = (
        riffler.Program.load(path) if saved else riffler.Program.read(path, machine=wanted.machine, options=chosen)
    )
    if len(program.poses) < 2:
        raise ValueError(f"{path.name} has no moves")
    program = _with_tools(context, program, path.name)
    text = "" if saved else path.read_text(encoding="utf-8", errors="replace")
    where = _played(context, program, wanted) or _timed(context.scene, program)
    return _new(path.name, program, where, text=text, machine=wanted.machine, options=chosen)


def _played(context, program, wanted):
    """The timeline of a file written from the active plan: its rows are at the frames of the plan."""
    ob = plan_store.active(context)
    if wanted.frame != "WORLD" or ob is None or timeline.pair(ob) is None:
        return None
    paths = _played_paths(context, ob, plan_store.plan(ob))
    return program_timeline.like_paths(program.poses, paths) if paths else None


def _with_tools(context, program, name):
    """NC code only numbers its tools: the one of unknown shape is the scene's plan tool."""
    called = sorted({int(n) for n in np.unique(program.tool[1:])} - set(program.tools))
    if len(called) > 1:
        raise ValueError(
            f"{name} calls tools {', '.join(map(str, called))}, and only one can be chosen here: use a .rprog file, "
            "which has their shapes, or one program for each tool"
        )
    if not called:
        return program
    tools = {**program.tools, called[0]: riffler.Tool.from_dict(context.scene.riffler.plan.tool_dict())}
    number = np.where(program.tool == 0, called[0], program.tool) if called[0] else program.tool
    return riffler.Program(
        program.poses, program.feed, rapid=program.rapid, tool=number, line=program.line,
        spindle=program.spindle, tools=tools, provenance=program.provenance, notes=program.notes,
        at_machine=program.at_machine, via=program.via,
    )  # fmt: skip


def _timed(scene, program):
    fps = scene.render.fps / scene.render.fps_base
    return program_timeline.by_time(program_timeline.seconds(program.poses, program.feed, program.rapid), fps)
