"""Objects that are hidden, disabled, linked, instanced, flat, sheared, scaled, mirrored or modified: every operator
works, or reports the same sentence; and the sentence's remedy works."""

import json
from itertools import product

import bpy
import numpy as np
from mathutils import Matrix

from support import common

SIZE, PIXEL = (400, 300), 0.1


# ---------------------------------------------------------------------- the scene
def scene_file():
    """A sculpt with a cut, a curve, an object with a surface, in a file that is opened for each case; a recording."""
    path, recording = common.out("refusals.blend"), common.out("refusals.rjournal")
    common.scale(1)
    sculpt = common.stock(pitch=2.0, directions="xyz")
    sculpt.name = "Sculpt"
    line = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    common.select(sculpt)
    assert bpy.ops.riffler.cut_curve(curve=line.name, tool=common.FLAT) == {"FINISHED"}
    assert bpy.ops.riffler.export_recording(filepath=recording, check_existing=False) == {"FINISHED"}
    bpy.ops.mesh.primitive_cube_add(size=20, location=(100, 0, 0))
    bpy.context.object.name = "Solid"
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return path


def stroke():
    matrix = np.diag([2 / (SIZE[0] * PIXEL), 2 / (SIZE[1] * PIXEL), -0.01, 1.0])
    matrix[:3, 3] = -(matrix[:3, :3] @ [20, 15, 0])
    text = {"view": {"matrix": matrix.ravel().tolist(), "size": list(SIZE)}, "rows": [[120, 150], [280, 150]]}
    return bpy.ops.riffler.stroke(stroke=json.dumps(text), tool=common.BALL)


def written(name, kind):
    return getattr(bpy.ops.riffler, name)(filepath=common.out(f"refusals.{kind}"), check_existing=False)


CHANGE = {
    "stroke": stroke,
    "pen_sculpt": lambda: bpy.ops.riffler.pen_sculpt(device="simulated", seconds=0.05, gap=500.0) and {"FINISHED"},
    "cut_curve": lambda: bpy.ops.riffler.cut_curve(curve="Line", tool=common.FLAT, depth=1.0),
    "cut_recording": lambda: bpy.ops.riffler.cut_recording(filepath=common.out("refusals.rjournal")),
    "resample": lambda: bpy.ops.riffler.resample(pitch=3.0),
    "room": lambda: bpy.ops.riffler.room(room=2.0),
    "mask_invert": bpy.ops.riffler.mask_invert,
    "to_mesh": bpy.ops.riffler.to_mesh,
}
READ = {
    "export_stl": lambda: written("export_stl", "stl"),
    "export_3mf": lambda: written("export_3mf", "3mf"),
    "export_nc": lambda: written("export_nc", "ngc"),
    "export_recording": lambda: written("export_recording", "again.rjournal"),
}
RUN = {
    "verify": lambda: bpy.ops.riffler.verify(source="CUTS"),
    "simulate": lambda: bpy.ops.riffler.simulate(source="CUTS"),
}
OF_CUTS = {"export_nc", "export_recording", *RUN}  # which edits of the mesh would delete
OF_SCULPTS = CHANGE | READ | RUN
OF_OBJECTS = {
    "new_stock": lambda: bpy.ops.riffler.new_stock(source="OBJECT", pitch=2.0, directions="z"),
    "plan_part": bpy.ops.riffler.plan_part,
    "make_sculpt": lambda: bpy.ops.riffler.make_sculpt(pitch=2.0),
}


# ---------------------------------------------------------------------- the states
def hidden(ob):
    ob.hide_set(True)


def disabled(ob):
    ob.hide_viewport = True


def flat(ob):
    ob.scale = (1, 0, 1)


def scaled(ob):
    ob.scale = (1, 1.5, 1)


def mirrored(ob):
    ob.scale = (-1, 1, 1)


def above(ob, scale, turn=(0, 0, 0)):
    """Its parent is scaled, and has a parent itself."""
    first, second = (bpy.data.objects.new(name, None) for name in ("First", "Second"))
    for new in (first, second):
        bpy.context.collection.objects.link(new)
    second.parent, ob.parent = first, second
    second.scale, ob.rotation_euler = scale, turn


def under_a_flat_one(ob):
    above(ob, (1, 1, 0))


def under_a_scaled_one(ob):
    above(ob, (2, 2, 2))


def sheared(ob):
    above(ob, (1, 3, 1), (0.5, 0.3, 0.2))


def sheared_by_a_constraint(ob):
    above(ob, (1, 3, 1))
    target = ob.parent
    ob.parent = None
    ob.rotation_euler = (0.5, 0.3, 0.2)
    ob.constraints.new("CHILD_OF").target = target
    ob.constraints[0].inverse_matrix = Matrix()


def modified(ob):
    ob.modifiers.new("Bend", "SIMPLE_DEFORM")


def linked(ob):
    name = ob.name
    bpy.ops.wm.read_homefile(use_empty=False)
    with bpy.data.libraries.load(common.out("refusals.blend"), link=True) as (_, into):
        into.objects = [name, "Line"]
    for new in into.objects:
        bpy.context.collection.objects.link(new)
    common.scale(1)
    common.select(bpy.data.objects[name])


def overriding(ob):
    linked(ob)
    new = bpy.context.object.override_create(remap_local_usages=True)
    new.data.override_create(remap_local_usages=True)
    common.select(new)


def instanced(ob):
    collection = bpy.data.collections.new("Library")
    for home in ob.users_collection:
        home.objects.unlink(ob)
    collection.objects.link(ob)
    new = bpy.data.objects.new("Instance", None)
    new.instance_type, new.instance_collection = "COLLECTION", collection
    bpy.context.collection.objects.link(new)
    common.select(new)


UNFIT = {
    disabled: "Sculpt is disabled in viewports or in this view layer: enable it in the Outliner",
    flat: "Sculpt is scaled to nothing along an axis: use Object > Clear > Scale",
    under_a_flat_one: "Sculpt is scaled to nothing along an axis: use Object > Parent > Clear and Keep Transformation, "
    "then Object > Clear > Scale",
    sheared: "Sculpt is sheared: use Object > Parent > Clear and Keep Transformation, then Object > Clear > Scale",
    sheared_by_a_constraint: "Sculpt is sheared: take away the constraint that does it",
    instanced: "Instance is an instance of Library: use Object > Apply > Make Instances Real",
}
NOT_LOCAL = {
    linked: "Sculpt is linked from another file: use Object > Relations > Make Local > Selected Objects and Data",
    overriding: "Sculpt overrides data of another file, which keeps no edits: use Object > Relations > Make Local > "
    "Selected Objects and Data",
}
OTHER_SIZE = "Sculpt is scaled or mirrored: its millimetres follow its own axes, not the scene's. To make them equal, "
SCALED = {
    scaled: OTHER_SIZE + "use Object > Clear > Scale",
    mirrored: OTHER_SIZE + "use Object > Clear > Scale",
    under_a_scaled_one: OTHER_SIZE + "use Object > Parent > Clear and Keep Transformation, then Object > Clear > Scale",
}
MODIFIED = {
    modified: "Sculpt has modifiers, which the volume does not include: use Apply Mesh Edits to include them, or "
    "remove them"
}
STATES = UNFIT | NOT_LOCAL | SCALED | MODIFIED
SHEARED_PART = "Sculpt is sheared: use Object > Parent > Clear and Keep Transformation"  # its scale is its own
KNOWN = {*STATES.values(), SHEARED_PART}
LIKE_ONE = ("disabled", "scaled", "sheared", "mirrored", "modifiers", "linked", "overrides", "an instance of")


# ---------------------------------------------------------------------- what the sentences tell to do
def enable():
    bpy.context.object.hide_viewport = False


def no_constraint():
    bpy.context.object.constraints.clear()


def make_real():
    bpy.ops.object.duplicates_make_real()
    common.select(next(ob for ob in bpy.context.selected_objects if ob.type == "MESH"))


STEPS = {
    "enable it in the Outliner": enable,
    "Object > Clear > Scale": lambda: bpy.ops.object.scale_clear(),
    "Object > Parent > Clear and Keep Transformation": lambda: bpy.ops.object.parent_clear(type="CLEAR_KEEP_TRANSFORM"),
    "take away the constraint": no_constraint,
    "Object > Relations > Make Local > Selected Objects and Data": lambda: bpy.ops.object.make_local(
        type="SELECT_OBDATA"
    ),
    "Object > Apply > Make Instances Real": make_real,
    "use Apply Mesh Edits": lambda: bpy.ops.riffler.take_edits(),
    "or remove them": lambda: bpy.context.object.modifiers.clear(),
}


def follow(sentence, other=False):
    """Follows the steps of a sentence, in order; of two alternatives the first or the `other`."""
    found = sorted((sentence.index(step), step) for step in STEPS if step in sentence)
    if any(step.startswith("or ") for _, step in found):
        found = found[1:] if other else found[:1]
    assert found, sentence
    for _, step in found:
        STEPS[step]()
    bpy.context.view_layer.update()


# ---------------------------------------------------------------------- the matrix
def prepared(path, state, name="Sculpt"):
    bpy.ops.wm.open_mainfile(filepath=path)
    common.select(bpy.data.objects[name])
    if state is not None:
        state(bpy.context.object)
    bpy.context.view_layer.update()


def outcome(call):
    """Whether it has finished, and its report."""
    error = ""
    done = set()

    def attempt():
        nonlocal error, done
        try:
            done = call()
        except RuntimeError as raised:
            error = str(raised)

    said = common.printed(attempt)
    return done == {"FINISHED"}, f"{said}\n{error}"


def sentences(said):
    """The known sentences in the reports, of any object; other text that sounds like one stays unchanged."""
    known = {sentence.replace("Sculpt", name) for sentence in KNOWN for name in ("Sculpt", "Solid", "Line")}
    found = {sentence for sentence in known if sentence in said}
    found = {sentence for sentence in found if not any(sentence in other and sentence != other for other in found)}
    for sentence in found:
        said = said.replace(sentence, "")
    return found | {line for line in said.splitlines() if any(word in line for word in LIKE_ONE)}


def wanted(name, state):
    """Whether the operator works on a sculpt in that state, and its report."""
    if state in UNFIT:
        return False, {UNFIT[state]}
    if state in NOT_LOCAL:
        return (True, set()) if name in READ or name in RUN else (False, {NOT_LOCAL[state]})
    if state in SCALED:
        return name not in RUN, {SCALED[state]}
    return True, {MODIFIED[state]}


def test_every_sculpt_operator_reports_a_state_alike_and_the_remedy_helps():
    cases = common.fewer(product(OF_SCULPTS.items(), STATES))
    assert {name for (name, _), _ in cases} == set(OF_SCULPTS) and {state for _, state in cases} == set(STATES)
    path = scene_file()
    wrong = []
    for (name, call), state in cases:
        case = f"{name}, {state.__name__}"
        prepared(path, state)
        done, said = outcome(call)
        works, sentence = wanted(name, state)
        if done != works or sentences(said) != sentence:
            wrong.append(f"{case}: {done} {said.strip()}")
            continue
        if not sentence:
            continue
        if done:  # the warning's remedy is applied to the reporting object
            prepared(path, state)
        follow(*sentence, other=name in OF_CUTS)
        done, said = outcome(call)
        if not done or sentences(said):
            wrong.append(f"{case}, after its remedy: {done} {said.strip()}")
    assert not wrong, "\n".join(wrong)


def test_a_hidden_sculpt_works_like_any_other():
    path = scene_file()
    for name, call in OF_SCULPTS.items():
        prepared(path, hidden)
        done, said = outcome(call)
        assert done and not sentences(said), (name, said)


def test_stock_and_parts_are_made_of_objects_in_any_state_or_name_it():
    path = scene_file()
    refused = {
        state: STATES[state].replace("Sculpt", "Solid") for state in (disabled, flat, under_a_flat_one, instanced)
    }
    of_parts = {
        sheared: SHEARED_PART.replace("Sculpt", "Solid"),
        sheared_by_a_constraint: UNFIT[sheared_by_a_constraint].replace("Sculpt", "Solid"),
    }
    for (name, call), state in product(OF_OBJECTS.items(), [*STATES, hidden]):
        if (name, state) == ("make_sculpt", hidden):
            continue  # it acts on the object under the pointer
        sentence = refused.get(state) or (of_parts.get(state) if name == "plan_part" else None)
        prepared(path, state, "Solid")
        done, said = outcome(call)
        case = (name, state.__name__, said)
        assert (not done and sentences(said) == {sentence}) if sentence else (done and not sentences(said)), case
        if sentence:
            follow(sentence)
            done, said = outcome(call)
            assert done and not sentences(said), case


def test_a_disabled_object_that_should_cut_a_sculpt_is_named():
    path = scene_file()
    calls = {"Line": CHANGE["cut_curve"], "Solid": lambda: bpy.ops.riffler.mask_form(form="Solid")}
    for name, call in calls.items():
        prepared(path, None)
        disabled(bpy.data.objects[name])
        done, said = outcome(call)
        assert not done and sentences(said) == {UNFIT[disabled].replace("Sculpt", name)}, said
        bpy.data.objects[name].hide_viewport = False
        done, said = outcome(call)
        assert done and not sentences(said), said
