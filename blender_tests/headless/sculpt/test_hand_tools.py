"""Hand tools in Blender: strokes of scripts with the presets, undo and redo, the journal to the byte, refusals."""

import json

import bpy
import numpy as np

from support import common

SIZE, PIXEL = (400, 300), 0.1  # mm
PRESETS = ("Gouge No. 7, 10 mm", "V-Tool 45°, 4 mm", "Skew Chisel 10 mm, 20°", "Carving Knife 12 mm")


def part(name):
    return common.part(f"sculpt.{name}")


def stroke(*places, **more):
    """A stroke through places on the top of the stock (mm), seen from above."""
    matrix = np.diag([2 / (SIZE[0] * PIXEL), 2 / (SIZE[1] * PIXEL), -0.01, 1.0])
    matrix[:3, 3] = -(matrix[:3, :3] @ np.array([20.0, 15, 0]))
    rows = [[0.5 * SIZE[0] + (x - 20) / PIXEL, 0.5 * SIZE[1] + (y - 15) / PIXEL] for x, y in places]
    view = {"matrix": matrix.ravel().tolist(), "size": list(SIZE)}
    text = json.dumps({"view": view, "rows": rows})
    return bpy.ops.riffler.stroke("EXEC_DEFAULT", True, stroke=text, **{"mode": "HAND", **more})


def stock():
    common.scale(1)
    ob = common.stock(pitch=0.5, directions="xyz")
    settings = bpy.context.scene.riffler.sculpt
    settings.depth, settings.mirror, settings.radial, settings.axis, settings.string = 0.8, set(), 1, "NORMAL", 0.0
    settings.fixtures = None
    common.push("stock")
    return ob.name


def run_of(ob):
    return part("live_registry").of(bpy.data.objects[ob])


def test_every_kind_cuts_and_undo_redo_and_the_journal_repeat_it_to_the_byte():
    name = stock()
    bpy.context.scene.riffler.sculpt.mirror = {"Y"}
    for preset in PRESETS:
        assert bpy.ops.riffler.hand_tool_preset(name=preset) == {"FINISHED"}
        run = run_of(name)
        before = None if run is None else run.volume.to_bytes()
        assert stroke((6, 4), (20, 8), (34, 12), (30, 4)) == {"FINISHED"}, preset
        run = run_of(name)
        after = run.volume.to_bytes()
        assert run.volume.volume < 40 * 30 * 20 and not run.volume.to_mesh().audit().open_edges
        assert run.persistence.journal.state(run.token).volume.to_bytes() == after, preset
        assert run.persistence.journal.state(run.token).shaped, "a recovered sculpt does not offer NC code either"
        if before is not None:
            bpy.ops.ed.undo()
            assert run_of(name).volume.to_bytes() == before, preset
            bpy.ops.ed.redo()
            assert run_of(name).volume.to_bytes() == after, preset
    run = run_of(name)
    assert run.shaped and not run.cuts, "no machine makes such cuts"
    counts, spans = run.volume.intervals("z")
    heights = spans[np.cumsum(counts.ravel()) - 1, 1].reshape(counts.shape)
    assert np.allclose(heights, heights[:, ::-1], atol=0.02), "a mirrored skew blade cuts the mirror image"


def test_the_menu_takes_sizes_and_lean_and_a_changed_size_is_custom():
    tool = bpy.context.scene.riffler.hand_tool
    assert bpy.ops.riffler.hand_tool_preset(name="Skew Chisel 10 mm, 20°") == {"FINISHED"}
    assert tool.from_preset()["name"] == "Skew Chisel 10 mm, 20°" and abs(np.degrees(tool.lean) - 70) < 1e-3
    bpy.context.scene.riffler.sculpt.width = 8.0
    assert tool.from_preset() is None and tool.dictionary()["width"] == 8.0
    bpy.ops.riffler.hand_tool_preset(name="Gouge No. 7, 10 mm")
    tool.width = 20.0
    assert tool.radius == 10.0, "a channel is at most half a circle"
    assert bpy.ops.riffler.size_step(field="WIDTH", larger=False) == {"FINISHED"} and abs(tool.width - 18) < 1e-5


def test_fixtures_and_tools_without_an_edge_are_refused():
    name = stock()
    bpy.context.scene.riffler.sculpt.fixtures = bpy.data.collections.new("Clamps")
    common.refused(lambda: stroke((10, 10), (20, 10)), "Hand tools do not avoid fixtures")
    bpy.context.scene.riffler.sculpt.fixtures = None
    common.refused(lambda: stroke((10, 10), (20, 10), tool=common.BALL), "is no hand tool")
    assert run_of(name) is None, "nothing was changed"
