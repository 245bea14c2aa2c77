"""The size of a part and the unit of its scene; the cutter's sizes as fields; the cutters that find pencil cuts."""

from types import SimpleNamespace

import bpy
import numpy as np
import riffler

from support import common, plans


def settings():
    return bpy.context.scene.riffler.plan


def cube(side, name="Part"):
    """A cube of so many units."""
    h = side / 2
    corners = [(x, y, z) for z in (-h, h) for y in (-h, h) for x in (-h, h)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    bpy.context.view_layer.update()
    return ob


def test_a_part_of_four_metres_is_asked_about():
    """Earlier it was accepted for a ball of 6 mm, and a search began."""
    common.scale(1000.0)
    bpy.context.scene.riffler.plan.take({"kind": "ball", "diameter": 6, "length": 30})
    part, fit = cube(4), common.part("plan.fit_check")
    said = " ".join(common.printed(bpy.ops.riffler.plan_part).split())
    asked = "Part is 4000 mm long, 667 times the tool's diameter: what is one unit of the scene?"
    assert asked in said and "4000 × 4000 × 4000 mm" in said, said
    assert fit.size_question(bpy.context.scene) == asked and settings().part == part
    guess = common.part("plan.pure.size_guess")
    assert (
        guess.likely(4) == "INCH" and guess.likely(40) == "MM" and guess.likely(0.1) == "M" and guess.likely(12) == "CM"
    )
    assert bpy.ops.riffler.scene_unit(unit="INCH") == {"FINISHED"}
    assert abs(bpy.context.scene.unit_settings.scale_length - 0.0254) < 1e-9
    assert fit.size_question(bpy.context.scene) == ""
    size = common.part("blender.object_surfaces").size(part, bpy.context.scene)
    assert np.allclose(size, 4 * 25.4, rtol=1e-6)


def test_an_accepted_large_part_is_not_asked_about_again():
    common.scale(1000.0)
    bpy.context.scene.riffler.plan.take({"kind": "ball", "diameter": 6, "length": 30})
    fit, scene = common.part("plan.fit_check"), bpy.context.scene
    cube(4)
    bpy.ops.riffler.plan_part()
    assert fit.size_question(scene)
    bpy.ops.riffler.scene_unit(unit="M")  # the size is right
    assert fit.size_question(scene) == "" and abs(scene.unit_settings.scale_length - 1) < 1e-9
    cube(5, "Other")
    bpy.ops.riffler.plan_part()
    assert fit.size_question(scene), "another part"


def test_a_part_that_is_smaller_than_the_tool_is_asked_about():
    common.scale(1.0)
    bpy.context.scene.riffler.plan.take({"kind": "ball", "diameter": 6, "length": 30})
    cube(2)
    bpy.ops.riffler.plan_part()
    assert "1/3 of the tool's diameter" in common.part("plan.fit_check").size_question(bpy.context.scene)
    bpy.context.scene.riffler.cutter.diameter = 0.5
    assert common.part("plan.fit_check").size_question(bpy.context.scene) == ""
    cube(60)
    bpy.ops.riffler.plan_part()
    assert common.part("plan.fit_check").size_question(bpy.context.scene) == ""


def test_a_search_waits_for_the_users_answer():
    common.scale(1000.0)
    bpy.context.scene.riffler.plan.take({"kind": "ball", "diameter": 6, "length": 30})
    cube(4)
    bpy.ops.riffler.plan_part()
    said, find = [], common.part("plan.operators.find").RIFFLER_OT_plan_find
    operator = SimpleNamespace(report=lambda level, text: said.append((level, text)))
    assert find.invoke(operator, bpy.context, None) == {"CANCELLED"}  # without a window Blender shows no dialog
    ((level, text),) = said
    assert level == {"ERROR"} and "what is one unit of the scene? Choose it in the panel Part and Fixtures" in text


def test_the_cutter_s_sizes_are_fields():
    scene = bpy.context.scene.riffler
    tool = riffler.Tool.ball(6, 25).with_shank([(25, 3, 40, 3)]).with_holder([(40, 14, 70, 16)]).named("six")
    scene.plan.take(tool.to_dict(), "a file")
    cutter = scene.cutter
    assert (cutter.kind, cutter.diameter, cutter.length) == ("ball", 6, 25)
    cutter.diameter = 8.1
    now = scene.plan.tool_dict()
    assert now["diameter"] == 8.1 and now["name"] == "Ball 8.1 mm" and scene.plan.source == ""
    made = riffler.Tool.from_dict(now)
    assert made.shank == tool.shank and made.holder == tool.holder
    cutter.length = 35
    now = riffler.Tool.from_dict(scene.plan.tool_dict())
    assert now.shank == [(35, 3, 50, 3)] and now.holder == [(50, 14, 80, 16)]
    presets = common.part("common.presets")
    for kind in [*list(presets.SIZES)[1:], "ball"]:
        cutter.kind = kind
        made = riffler.Tool.from_dict(scene.plan.tool_dict())
        assert cutter.kind == made.kind == kind and made.length == 35 and len(made.holder) == 1
        for key in presets.SIZES[kind]:
            assert key in presets.FLAGS or getattr(cutter, key) > 0
    cutter.kind = "fillet"
    cutter.corner_radius = 3
    cutter.diameter = 4
    assert scene.plan.tool_dict()["corner_radius"] == 2, "no wider than the cutter"
    before = dict(scene.plan.tool_dict())
    cutter.corner_radius = 50
    assert scene.plan.tool_dict()["corner_radius"] == 2 and scene.plan.tool_dict() == before
    scene.plan.tool = "no tool"
    assert cutter.diameter > 0
    cutter.diameter = 3
    assert scene.plan.tool == "no tool", "an invalid tool stays, and the panel says so"


def test_a_flat_end_mill_finds_no_pencil_cuts():
    """Earlier its paths were those of a ball of its diameter."""
    common.scale(1.0)
    scene, part = bpy.context.scene.riffler, plans.part_object()
    bpy.context.view_layer.objects.active = part
    bpy.ops.riffler.plan_part()
    scene.plan.take({"kind": "ball", "diameter": 6, "length": 30})
    for kind in ("flat", "fillet", "cone_end"):
        scene.cutter.kind = kind
        common.refused(bpy.ops.riffler.plan_find, "tool", "ball")
        assert common.part("plan.plan_store").in_scene(bpy.context.scene) == []
    scene.cutter.kind = "taper"
    assert bpy.ops.riffler.plan_find() == {"FINISHED"}
