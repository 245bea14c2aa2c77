"""Brushes with falloff in Blender: strokes of scripts, undo and redo, and the journal, to the byte."""

import json

import bpy
import numpy as np
import riffler

from support import common

SIZE = (400, 300)
PIXEL = 0.1  # mm
BRUSHES = ("CLAY", "DIG", "INFLATE", "DEFLATE", "FLATTEN", "SCRAPE", "FILL", "GRAB", "SNAKE_HOOK", "PINCH", "CREASE",
           "RIDGE", "TWIST", "UNTWIST")  # fmt: skip
TILT = np.radians(35)


def part(name):
    return common.part(f"sculpt.{name}")


def view(middle):
    """A view from above that leans back, ten pixels per millimetre. A pull in its plane leads out of the surface."""
    right, up = np.array([1.0, 0, 0]), np.array([0, np.cos(TILT), np.sin(TILT)])
    rows = np.array([right * 2 / (SIZE[0] * PIXEL), up * 2 / (SIZE[1] * PIXEL), -0.01 * np.cross(right, up)])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rows, -rows @ middle
    return {"matrix": matrix.ravel().tolist(), "size": list(SIZE)}


def stroke(ob, *pixels, pressures=(), **more):
    """A stroke through pixels, counted from the middle of the view."""
    rows = [[0.5 * SIZE[0] + x, 0.5 * SIZE[1] + y] for x, y in pixels]
    for row, pressure in zip(rows, pressures, strict=False):
        row.append(pressure)
    text = json.dumps({"view": view(np.array([20.0, 15.0, 8.0])), "rows": rows})
    return bpy.ops.riffler.stroke("EXEC_DEFAULT", True, stroke=text, tool=common.BALL, **more)


def stock(pitch=0.5):
    """A block of 40 × 30 × 8 with a groove, and room above."""
    common.scale(1)
    ob = common.stock(pitch=pitch, directions="xyz")
    settings = bpy.context.scene.riffler.sculpt
    settings.depth, settings.strength, settings.falloff, settings.pressure = 0.6, 0.5, "SMOOTH", "DEPTH"
    settings.mirror, settings.radial, settings.axis, settings.string = set(), 1, "NORMAL", 0.0
    run = part("live_registry").begin(bpy.context, ob)
    run.begin_stroke()
    flat = riffler.Tool.flat(100, 30)
    run.carve(flat, np.array([[20.0, 15, 8, 0, 0, 1], [21, 15, 8, 0, 0, 1]]))
    run.carve(riffler.Tool.ball(3, 30), np.array([[3.0, 16, 7, 0, 0, 1], [37, 15, 7, 0, 0, 1]]))
    assert run.finish_stroke(bpy.context, "room")
    return ob


def run_of(ob):
    return part("live_registry").of(bpy.data.objects[ob])


def test_every_brush_makes_a_stroke_that_undo_redo_and_the_journal_repeat_to_the_byte():
    name = stock(pitch=1.0).name
    for mode in common.fewer(BRUSHES):
        before = run_of(name).volume.to_bytes()
        assert stroke(name, (-60, 0), (-20, 10), (30, 25), (60, 30), mode=mode) == {"FINISHED"}, mode
        run = run_of(name)
        after = run.volume.to_bytes()
        assert after != before, mode
        assert not run.volume.to_mesh().audit().open_edges, mode
        assert run.persistence.journal.state(run.token).volume.to_bytes() == after, mode
        assert not run.cut_off, mode
        bpy.ops.ed.undo()
        assert run_of(name).volume.to_bytes() == before, mode
        bpy.ops.ed.redo()
        assert run_of(name).volume.to_bytes() == after, mode
    run = run_of(name)
    assert run.shaped and len(run.cuts) == 2, "no brush makes NC code"


def test_a_grab_is_one_displacement_for_any_path_of_the_pointer():
    made = []
    for between in ((), ((40, 60), (-70, -30), (0, 80))):
        name = stock().name
        assert stroke(name, (0, 0), *between, (10, 40), mode="GRAB") == {"FINISHED"}
        made.append(run_of(name).volume.to_bytes())
        part("live_registry").end_all()
        bpy.ops.wm.read_homefile()
    assert made[0] == made[1]


def test_clay_follows_depth_pressure_falloff_symmetry_and_mask():
    name = stock().name
    full = run_of(name).volume.volume

    def added(**more):
        assert stroke(name, (-60, -80), (60, -80), mode="CLAY", **more) == {"FINISHED"}
        change = run_of(name).volume.volume - full
        bpy.ops.ed.undo()
        return change

    def settings(**chosen):
        for key, value in chosen.items():
            setattr(bpy.context.scene.riffler.sculpt, key, value)

    plain = added()
    # A pass of 12 mm, 0.6 mm high in its middle: the falloff's integral over the disc and along a line.
    expected = 12 * 0.6 * 0.3 * np.pi * 3**2 / (2 * 3 * 0.5)
    assert abs(plain / expected - 1) < 0.12, (plain, expected)
    assert abs(added(pressures=(0.5, 0.5)) / plain - 0.5) < 0.03
    settings(depth=0.3)
    assert abs(added() / plain - 0.5) < 0.03
    settings(depth=0.6, falloff="SHARPER")
    assert added() < 0.7 * plain
    settings(falloff="SMOOTH", mirror={"Y"})
    assert abs(added() / plain - 2) < 0.03
    settings(mirror=set())
    run = run_of(name)
    run.begin_stroke()
    half = np.array([[0.0, 6, 4, 0, 0, 1], [1.0, 6, 4, 0, 0, 1]])
    run.carve(riffler.Tool.flat(40, 30), half, mode="mask")
    assert run.finish_stroke(bpy.context, "mask")
    assert 0.2 * plain < added() < 0.8 * plain


def test_material_that_leaves_the_box_is_cut_off_with_a_warning():
    name = stock().name
    bpy.context.scene.riffler.sculpt.strength = 1.0
    assert stroke(name, (0, -120), (0, 145), mode="GRAB") == {"FINISHED"}  # 15 mm up, where 12 are free
    assert run_of(name).cut_off
    assert stroke(name, (-60, 40), (60, 40), mode="DIG") == {"FINISHED"}
    assert not run_of(name).cut_off


def test_brushes_are_refused_on_rays_of_one_direction():
    common.scale(1)
    common.stock(pitch=0.5, directions="z")
    common.refused(lambda: stroke("", (0, 0), (20, 0), mode="CLAY"), "three directions", "Change Pitch")
