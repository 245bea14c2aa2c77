"""The documents' examples for Blender: the operators they call exist with those settings, and each page's examples run
as one script in the scene that the page describes."""

import ast
import re
import tempfile
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, plans, programs

DOCS = Path(common.__file__).resolve().parents[2] / "docs"
MARK = "<!-- not run: it runs in Blender's tests -->"  # the mark of tools/check_docs.py
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks():
    """(page, line of its first line, the line above its fence, text) of each Python example for Blender."""
    for page in sorted(DOCS.glob("*.md")):
        text = page.read_text()
        for found in BLOCK.finditer(text):
            if "bpy." in found[1]:
                before = text[: found.start()].splitlines()
                yield page.name, len(before) + 2, before[-1], found[1]


def calls():
    """(page, the call's text, operator, settings) of each bpy.ops.riffler.… in the examples."""
    for page, _, _, block in blocks():
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.Call) and ast.unparse(node.func).startswith("bpy.ops.riffler."):
                yield page, ast.unparse(node), node.func.attr, node.keywords


def test_operators_accept_the_arguments_of_the_examples():
    found = list(calls())
    assert len(found) > 12
    for page, text, name, given in found:
        where = f"docs/{page}: {text}"
        assert name in dir(bpy.ops.riffler), where
        fields = getattr(bpy.ops.riffler, name).get_rna_type().properties
        for keyword in given:
            assert keyword.arg in fields, f"{where}: {keyword.arg}"
            field = fields[keyword.arg]
            if field.type == "ENUM" and isinstance(keyword.value, ast.Constant):
                assert keyword.value.value in field.enum_items, f"{where}: {keyword.arg}"


def test_a_missing_call_is_detected():
    assert "gone_to_lunch" not in dir(bpy.ops.riffler)


# ---------------------------------------------------------------------- their scripts


def run(page):
    """The page's examples in order, with the page's line numbers."""
    lines = []
    for name, first, _, text in blocks():
        if name == page:
            lines += [""] * (first - 1 - len(lines)) + text.splitlines()
    exec(compile("\n".join(lines), str(DOCS / page), "exec"), {"bpy": bpy})


def saved(folder):
    """The scene has a file, whose folder is //."""
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"))


def engrave(folder):
    """The name is cut along another tool's recording, on a similar stock."""
    common.scale(1)
    saved(folder)
    common.stock(pitch=0.25)
    line = common.curve("Text", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    bpy.ops.riffler.tool_preset(name="Engraver 60°, ball R0.1")
    bpy.ops.riffler.cut_curve(curve=line.name, depth=0.6)
    bpy.ops.riffler.export_recording(filepath=str(folder / "name.rjournal"))
    (first,) = common.content(bpy.context.object).cuts
    ob = common.stock(pitch=0.25)
    bpy.ops.riffler.tool_preset(name="Ball 3 mm")
    run("engrave.md")
    (cut,) = common.content(ob).cuts
    assert cut.tool["diameter"] == 3 != first.tool["diameter"] and np.array_equal(cut.poses, first.poses)


def planning(folder):
    """The step, and a stock with half a millimetre on it: verifying finds the material that no pencil cut removes."""
    common.scale(1)
    plans.part_object().name = "Part"
    programs.stock()
    saved(folder)
    run("planning.md")
    (ob,) = common.part("plan.plan_store").in_scene(bpy.context.scene)
    plan = programs.content(ob)
    assert {72, 100} <= set(plan.paths[0].keys)
    table = {"rot_point": [0, 0, -40]}
    read = riffler.Program.read(folder / "step.ngc", machine="linuxcnc-xyzac", options=table)
    assert max(np.linalg.norm(read.poses - row, axis=1).min() for row in plan.cl[0]) < 2e-4
    assert common.part("program.simulation").active() is None
    settings = programs.settings()
    assert "step.ngc" in settings.said and settings.index == 0 and settings.findings[0].kind == "rest"


def sessions(folder):
    """The simulated hand presses its button for four seconds of eight; a busy computer cuts the force."""
    common.scale(1)
    ob = common.stock(size=(60, 60, 20))
    saved(folder)
    for _ in range(3):
        run("sessions.md")
        common.part("sculpt.live_registry").end_all()
        if cuts := common.content(ob).cuts:
            break
    path = min(folder.glob("Stock *.rjournal"))
    assert len(riffler.Journal.load(path).strokes) == len(cuts) > 0


SCENES = {"engrave.md": engrave, "planning.md": planning, "sessions.md": sessions}


def test_every_example_has_a_scene_and_names_where_it_runs():
    assert {page for page, *_ in blocks()} == set(SCENES)
    for page, first, above, _ in blocks():
        assert above == MARK, f"docs/{page}:{first - 1}: put {MARK} above it"


def in_its_scene(page):
    with tempfile.TemporaryDirectory() as folder:
        SCENES[page](Path(folder))


def test_the_example_of_engraving_runs():
    in_its_scene("engrave.md")


def test_the_examples_of_planning_run():
    in_its_scene("planning.md")


@common.core_bound
def test_the_example_of_sessions_runs():
    in_its_scene("sessions.md")
