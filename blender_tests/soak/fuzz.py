"""All operators of the add-on with valid and invalid settings, in scenes changed by others, in any order.

After each step every sculpt is unchanged, or the result of an operator that returned FINISHED; an operator that
returned CANCELLED has changed nothing; undo, redo and the file restore all states to the byte.
"""

import faulthandler
import io
import sys
import time
import webbrowser
from contextlib import contextmanager, suppress

import bpy
from hypothesis import HealthCheck, Phase, Verbosity, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule, run_state_machine_as_test
from soak import arguments, world

from support import common

STEPS = 30  # of an example; fewer than Blender's undo steps
LONGEST = 30.0  # s for one step: a longer one hangs
OTHERS = {"riffler.recover"}  # may change another sculpt than the active one
MODES = ("REMOVE", "ADD", "SOFTEN", "MASK", "UNMASK")
INDEX = st.integers(0, 1000)


def operators():
    """Operators of all modules that the add-on registers, in a fixed order."""
    found = {c for module in common.part("registration").modules() for c in module.CLASSES}
    found = [c for c in found if issubclass(c, bpy.types.Operator)]
    return sorted(found, key=lambda c: c.bl_idname)


def function(cls):
    group, name = cls.bl_idname.split(".")
    return getattr(getattr(bpy.ops, group), name)


class Heard(io.TextIOBase):
    """Standard error, checked for faults: Blender prints what handlers raise, and continues."""

    def __init__(self, out):
        self.out, self.text = out, ""

    def write(self, text):
        self.text += text
        return self.out.write(text)


class Fuzz(RuleBasedStateMachine):
    def __init__(self):
        super().__init__()
        self.heard = sys.stderr
        self.heard.text = ""
        self.at = -1
        self.log("a new example")
        bpy.ops.wm.read_homefile(use_empty=False)
        common.scale(1)
        furnish()
        self.history, self.at = [], -1
        self.push()

    def log(self, what):
        """For analysis after a crash: the last line is the step that crashed. A step that takes too long is ended
        there."""
        faulthandler.dump_traceback_later(LONGEST, exit=True, file=sys.__stderr__)
        with open(common.out("fuzz.log"), "a") as file:
            file.write(f"{time.perf_counter():.2f} {self.at} {what}\n")

    # ------------------------------------------------------------------ the model
    def push(self, message="step"):
        """Makes the last change a step of the history."""
        bpy.ops.ed.undo_push(message=message)
        self.remember()

    def remember(self):
        self.known = world.look()
        del self.history[self.at + 1 :]
        self.history.append(self.known)
        self.at += 1

    @invariant()
    def nothing_is_lost(self):
        assert world.look().volumes() == self.known.volumes()
        assert "Traceback" not in self.heard.text, self.heard.text

    def call(self, cls, chosen, undo=True):
        """One operator; its report and its effect agree."""
        before = world.look()
        what = f"{cls.bl_idname}({', '.join(f'{k}={v!r}' for k, v in chosen.items())})"
        self.log(what)
        try:
            done = function(cls)("EXEC_DEFAULT", undo, **chosen)
        except TypeError:  # Blender's own: there is no such item, number or text
            done = {"CANCELLED"}
        except RuntimeError as error:
            text = str(error)
            assert "Traceback" not in text, f"{what}: {text}"
            assert "context is incorrect" not in text, f"{what}: the poll says no reason"
            assert text.count("Error: ") <= 1, f"{what}: more than one report: {text}"
            done = {"CANCELLED"}
        after = world.look()
        if done != {"FINISHED"}:
            assert after == before, f"{what} did nothing, and\n{before}\nbecame\n{after}"
            return
        self.has_kept(cls, what, before, after)
        if undo and "UNDO" in cls.bl_options:
            self.remember()
        else:
            self.known = after

    @staticmethod
    def has_kept(cls, what, before, after):
        gone = [name for name in before.sculpts if name not in after.sculpts]
        assert not gone, f"{what} has lost {gone}"
        mesh = before.meshes.get(before.active)
        changed = {n for n in before.sculpts if after.sculpts[n] != before.sculpts[n] and before.meshes[n] != mesh}
        assert not changed or cls.bl_idname in OTHERS, f"{what} has changed {changed}"
        same = before.volumes() == after.volumes()
        assert same or "UNDO" in getattr(cls, "bl_options", ()), f"{what} cannot be undone"

    # ------------------------------------------------------------------ what the add-on does
    @rule(which=INDEX, data=st.data())
    def operator(self, which, data):
        cls = operators()[which % len(operators())]
        self.call(cls, data.draw(arguments.settings(function(cls).get_rna_type())))

    @rule(
        mode=st.sampled_from(("REMOVE", "ADD", "SOFTEN", "MASK", "UNMASK")), stroke=st.sampled_from(arguments.STROKES)
    )
    def stroke(self, mode, stroke):
        cls = next(c for c in operators() if c.bl_idname == "riffler.stroke")
        self.call(cls, {"mode": mode, "stroke": stroke, "tool": arguments.TOOLS[0]})

    @rule(which=INDEX, data=st.data())
    def setting(self, which, data):
        """Sets one group of settings of the scene."""
        self.log(f"setting {which}")
        root = bpy.context.scene.riffler
        groups = sorted(
            p.identifier for p in root.bl_rna.properties if p.type == "POINTER" and p.identifier != "rna_type"
        )
        group = getattr(root, groups[which % len(groups)])
        for name, value in data.draw(arguments.settings(group.bl_rna)).items():
            with suppress(TypeError, ValueError):
                setattr(group, name, value)
        self.push()

    # ------------------------------------------------------------------ what others do
    @rule(which=INDEX, alone=st.booleans())
    def select(self, which, alone):
        self.log(f"select {which} {alone}")
        ob = self.chosen(which)
        if ob is None or ob.name not in bpy.context.view_layer.objects:
            return
        for other in bpy.context.view_layer.objects if alone else ():
            other.select_set(False)
        ob.select_set(True)
        bpy.context.view_layer.objects.active = ob
        self.push()

    @rule()
    def select_nothing(self):
        self.log("select nothing")
        for ob in bpy.context.view_layer.objects:
            ob.select_set(False)
        bpy.context.view_layer.objects.active = None
        self.push()

    @rule(which=INDEX, to=st.sampled_from(("scaled", "mirrored", "flat", "sheared", "turned", "far")))
    def place(self, which, to):
        self.log(f"place {which} {to}")
        ob = self.chosen(which)
        if ob is None:
            return
        if to == "sheared":
            above = bpy.data.objects.new("Above", None)
            bpy.context.scene.collection.objects.link(above)
            above.scale, ob.parent, ob.rotation_euler = (1, 3, 1), above, (0.3, 0.4, 0.5)
        else:
            ob.scale = {"scaled": (1, 2, 0.5), "mirrored": (-1, 1, 1), "flat": (1, 1, 0)}.get(to, (1, 1, 1))
            ob.rotation_euler = (0.2, 1.0, 3.0) if to == "turned" else (0, 0, 0)
            ob.location = (1e6, 0, 0) if to == "far" else (0, 0, 0)
        bpy.context.view_layer.update()
        self.push()

    @rule(which=INDEX, name=st.sampled_from(("Renamed", "Stock", "Ä" * 40)))
    def rename(self, which, name):
        self.log(f"rename {which} {name}")
        ob = self.chosen(which)
        if ob is not None:
            ob.name = name
            self.push()

    @rule(which=INDEX)
    def delete(self, which):
        self.log(f"delete {which}")
        ob = self.chosen(which)
        if ob is not None and len(self.known.sculpts) > 1:
            bpy.data.objects.remove(ob)
            self.push()

    @rule(which=INDEX, linked=st.booleans())
    def duplicate(self, which, linked):
        self.log(f"duplicate {which} {linked}")
        ob = self.chosen(which)
        if ob is None or len(bpy.data.objects) > 300:
            return
        copy = ob.copy()
        if ob.data is not None and not linked:
            copy.data = ob.data.copy()
        bpy.context.scene.collection.objects.link(copy)
        self.push()

    @rule(which=INDEX)
    def edit(self, which):
        """Edits a mesh by hand."""
        self.log(f"edit {which}")
        ob = self.chosen(which)
        if ob is not None and ob.type == "MESH" and len(ob.data.vertices):
            ob.data.vertices[0].co.z += 1
            ob.data.update()
            self.push()

    @rule(mode=st.sampled_from(("EDIT", "SCULPT", "WEIGHT_PAINT")), which=INDEX, data=st.data())
    def in_another_mode(self, mode, which, data):
        self.log(f"mode {mode}")
        ob = bpy.context.view_layer.objects.active
        if ob is None or not bpy.ops.object.mode_set.poll():
            return
        try:
            bpy.ops.object.mode_set(mode=mode)
        except (RuntimeError, TypeError):
            return
        cls = operators()[which % len(operators())]
        self.call(cls, data.draw(arguments.settings(function(cls).get_rna_type())), undo=False)
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        self.push()

    @rule(mm=st.sampled_from((1.0, 1000.0, 25.4)))
    def units(self, mm):
        self.log(f"units {mm}")
        common.scale(mm)
        self.push()

    # ------------------------------------------------------------------ time and files
    @rule(back=st.booleans())
    def undo(self, back):
        self.log(f"undo {back}")
        if not 0 <= self.at + (-1 if back else 1) < len(self.history):
            return
        (bpy.ops.ed.undo if back else bpy.ops.ed.redo)()
        self.at += -1 if back else 1
        self.known = self.history[self.at]

    @rule()
    def save_and_reopen(self):
        self.log("save and reopen")
        path = common.out("fuzz.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        assert world.look().volumes() == self.known.volumes(), "saving has changed it"
        bpy.ops.wm.open_mainfile(filepath=path)
        assert world.look().volumes() == self.known.volumes(), "what was opened is not what was saved"
        self.history, self.at = [], -1
        self.push()

    @rule()
    def end(self):
        """As when another tool is chosen."""
        self.log("end")
        common.part("sculpt.live_registry").end_all()

    def chosen(self, which):
        found = [ob for ob in sorted(bpy.data.objects, key=lambda ob: ob.name) if not world.ours(ob)]
        return found[which % len(found)] if found else None

    def teardown(self):
        common.part("sculpt.live_registry").end_all()
        self.nothing_is_lost()
        assert not common.part("sculpt.chunks").shown()


def furnish():
    """A sculpt, and one of each kind of data that operators take by name."""
    common.part("common.packing").FAST = 60.0  # independent of a busy computer
    bpy.data.images.new("Picture", 8, 8)
    common.curve("Line", [(-4, 0, 4), (4, 1, 4)], mm_per_unit=1)
    bpy.ops.mesh.primitive_cone_add(radius1=3, radius2=1, depth=6)
    common.stock(size=(12, 10, 8), pitch=1.0, directions="xyz", origin="CENTRE")


@contextmanager
def heard():
    before, opened = sys.stderr, webbrowser.open
    sys.stderr, webbrowser.open = Heard(before), lambda *_, **__: True
    try:
        yield
    finally:
        sys.stderr, webbrowser.open = before, opened


def test_no_operator_loses_a_volume():
    chosen = common.JOB["soak"]
    phases = (Phase.generate, Phase.shrink) if chosen["long"] else (Phase.generate,)  # a short run reports it at once
    options = settings(
        max_examples=chosen["examples"],
        stateful_step_count=STEPS,
        derandomize=not chosen["long"],
        database=None,
        deadline=None,
        phases=phases,
        verbosity=Verbosity.normal,
        suppress_health_check=list(HealthCheck),
        print_blob=False,
    )
    machine = seeded(chosen["seed"])(Fuzz) if chosen["long"] else Fuzz
    faulthandler.enable(sys.__stderr__)
    with heard():
        try:
            run_state_machine_as_test(machine, settings=options)
        finally:
            faulthandler.cancel_dump_traceback_later()
