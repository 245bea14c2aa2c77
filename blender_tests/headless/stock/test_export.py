"""STL in millimetres in any scene units, NC code, recordings."""

from pathlib import Path

import bpy
import mathutils
import numpy as np
import riffler

from support import common


def cut_stock(unit, directions="z"):
    common.scale(unit)
    ob = common.stock(directions=directions)
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=unit)
    bpy.ops.riffler.cut_curve(curve=c.name, depth=2, tool=common.BALL)
    bpy.context.view_layer.objects.active = ob
    return ob


def test_a_surface_is_written_in_the_operators_format_and_not_without_a_name():
    common.scale(1)
    common.stock()
    for name, suffix in (("export_stl", ".stl"), ("export_3mf", ".3mf")):
        for wrong in ("x.obj", "x", "x.ply"):
            path = common.out(wrong)
            call = lambda name=name, path=path: getattr(bpy.ops.riffler, name)(filepath=path, check_existing=False)  # noqa: E731
            text = common.refused(call, f"choose a name that ends with {suffix}, not {wrong}")
            assert not Path(path).exists() and (".obj" in text) == (".obj" in wrong)
        common.refused(
            lambda name=name: getattr(bpy.ops.riffler, name)(filepath="", check_existing=False), "no file was"
        )
    for name in ("export_nc", "export_recording"):
        common.refused(
            lambda name=name: getattr(bpy.ops.riffler, name)(filepath="", check_existing=False), "no file was"
        )


def test_stl_is_in_mm_for_any_units_of_the_scene():
    for unit, system in ((1000.0, "METRIC"), (1.0, "METRIC"), (10.0, "METRIC"), (304.8, "IMPERIAL"), (1.0, "NONE")):
        bpy.ops.wm.read_homefile()
        bpy.context.scene.unit_settings.system = system
        ob = cut_stock(unit)
        path = common.out("units.stl")
        bpy.ops.riffler.export_stl(filepath=path)
        v = common.read_stl(path).reshape(-1, 3)
        assert np.allclose(v.min(0), 0, atol=1e-4) and np.allclose(v.max(0), (40, 30, 20), atol=1e-4), (unit, v.max(0))
        # One direction of rays: walls lie within h / 2.
        assert abs(common.stl_volume(path) / common.content(ob).volume.volume - 1) < 0.03


def test_the_objects_transform_is_applied():
    unit = 10.0
    ob = cut_stock(unit)
    ob.matrix_world = (
        mathutils.Matrix.LocRotScale(
            mathutils.Vector((1, 2, 3)), mathutils.Euler((0, 0, np.pi / 2)), mathutils.Vector((2, 1, 1))
        )
        if hasattr(mathutils.Matrix, "LocRotScale")
        else ob.matrix_world
    )
    bpy.context.view_layer.update()
    path = common.out("placed.stl")
    bpy.ops.riffler.export_stl(filepath=path)
    v = common.read_stl(path).reshape(-1, 3)
    assert np.allclose(v.min(0), (10 - 30, 20, 30), atol=1e-3), v.min(0)
    assert np.allclose(v.max(0), (10, 20 + 80, 50), atol=1e-3), v.max(0)
    bpy.ops.riffler.export_stl(filepath=path, world=False)
    assert np.allclose(common.read_stl(path).reshape(-1, 3).max(0), (40, 30, 20), atol=1e-4)


def test_a_mirrored_object_is_exported_outward():
    ob = cut_stock(1.0)
    ob.scale = (-1, 1, 1)
    bpy.context.view_layer.update()
    path = common.out("mirrored.stl")
    bpy.ops.riffler.export_stl(filepath=path)
    assert common.stl_volume(path) > 22000


def test_the_stl_is_closed():
    for directions in ("z", "xyz"):
        bpy.ops.wm.read_homefile()
        cut_stock(1000.0, directions)
        path = common.out("closed.stl")
        bpy.ops.riffler.export_stl(filepath=path)
        corners, index = np.unique(common.read_stl(path).astype("<f4").reshape(-1, 3), axis=0, return_inverse=True)
        tri = index.reshape(-1, 3)
        assert len(np.unique(np.sort(tri, axis=1), axis=0)) == len(tri)
        edges = np.concatenate([tri[:, [0, 1]], tri[:, [1, 2]], tri[:, [2, 0]]]).astype(np.int64)
        forward = edges[:, 0] * len(corners) + edges[:, 1]
        backward = edges[:, 1] * len(corners) + edges[:, 0]
        assert len(np.unique(forward)) == len(forward)
        assert np.array_equal(np.sort(forward), np.sort(backward))


def spaced(n):
    return f"{n:,}".replace(",", "\u00a0")


def test_triangles_are_where_the_shape_needs_them_or_all():
    common.scale(1)
    ob = cut_stock(1.0, "xyz")
    all_triangles = len(common.content(ob).volume.to_mesh().triangles)
    pitch = common.content(ob).volume.pitch
    sizes = {}
    for name, settings, tolerance in (
        ("all", {"detail": "ALL"}, None),
        ("tenth", {}, 0.1 * pitch),
        ("near", {"tolerance": 0.002}, 0.002),
    ):
        path = common.out(f"{name}.stl")
        said = common.printed(
            lambda path=path, settings=settings: bpy.ops.riffler.export_stl(filepath=path, **settings)
        )
        sizes[name] = len(common.read_stl(path))
        assert f"{spaced(sizes[name])} triangles, " in said
        assert Path(path).stat().st_size == 84 + 50 * sizes[name]
        assert ("within" in said) == (tolerance is not None)
        if tolerance is not None:
            assert f"within {tolerance:g} mm of all {spaced(all_triangles)} triangles, " in said
    assert sizes["all"] == all_triangles > 10 * sizes["near"] > 10 * sizes["tenth"] > 0
    full, few = (riffler.Mesh.read(common.out(f"{name}.stl")) for name in ("all", "tenth"))
    assert np.abs(few.deviation(full)).max() < 1e-4 and np.abs(full.deviation(few)).max() < 0.1 * pitch + 1e-4


def test_a_changed_scene_scale_changes_the_export_and_is_reported():
    ob = cut_stock(1000.0)
    common.scale(1)
    path = common.out("shrunk.stl")
    bpy.ops.riffler.export_stl(filepath=path)  # as displayed: 0.04 units of 1 mm
    assert np.allclose(common.read_stl(path).reshape(-1, 3).max(0), (0.04, 0.03, 0.02), rtol=1e-4)
    bpy.ops.riffler.rebuild()
    bpy.ops.riffler.export_stl(filepath=path)
    assert np.allclose(common.read_stl(path).reshape(-1, 3).max(0), (40, 30, 20), rtol=1e-4)
    assert np.allclose(ob.dimensions, (40, 30, 20), rtol=1e-4)


def test_a_path_that_cannot_be_written_is_named():
    cut_stock(1.0)
    common.refused(lambda: bpy.ops.riffler.export_stl(filepath="/nowhere/at/all.stl"), "all.stl")


def test_an_empty_sculpt_is_not_exported():
    common.scale(1)
    common.stock(size=(10, 10, 10))
    c = common.curve("Line", [(-5, 5, -1), (15, 5, -1)], mm_per_unit=1)
    bpy.ops.riffler.cut_curve(curve=c.name, tool='{"kind": "flat", "diameter": 60, "length": 80}')
    for kind in ("stl", "3mf"):
        path = Path(common.out(f"nothing.{kind}"))
        path.unlink(missing_ok=True)
        common.refused(
            lambda path=path, kind=kind: getattr(bpy.ops.riffler, f"export_{kind}")(filepath=str(path)),
            "no material left",
        )
        assert not path.exists()


def numbers(path, letter):
    import re

    text = re.sub(r"\(.*?\)|;.*", "", Path(path).read_text())
    return [float(m) for m in re.findall(rf"{letter}(-?[\d.]+)", text)]


def test_nc_code_holds_the_cuts():
    for post in ("3-axis", "tcp"):
        bpy.ops.wm.read_homefile()
        cut_stock(1.0)
        path = common.out(f"cut-{post}.ngc")
        bpy.ops.riffler.export_nc(filepath=path, post=post, feed=450, spindle=9000)
        text = Path(path).read_text()
        assert "G21" in text and ("M2" in text or "M30" in text)
        assert {10.0, 30.0} <= set(numbers(path, "X")) and 18.0 in numbers(path, "Z")
        assert 450.0 in numbers(path, "F") and 9000.0 in numbers(path, "S")


def test_nc_code_needs_cuts_and_upright_tools_for_three_axes():
    common.scale(1)
    common.stock()
    path = Path(common.out("none.ngc"))
    path.unlink(missing_ok=True)
    common.refused(lambda: bpy.ops.riffler.export_nc(filepath=str(path)), "no cuts")
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1, tilt=[0.3, 0.3])
    bpy.ops.riffler.cut_curve(curve=c.name, depth=1, axis="TILT", tool=common.BALL)
    common.refused(lambda: bpy.ops.riffler.export_nc(filepath=str(path), post="3-axis"))
    assert not path.exists()
    bpy.ops.riffler.export_nc(filepath=str(path), post="tcp")
    assert path.exists()


def test_a_recording_makes_the_same_sculpt_again():
    ob = cut_stock(1.0)
    c = common.curve("Other", [(10, 5, 20), (30, 25, 18)], mm_per_unit=1, tilt=[0.2, -0.2])
    bpy.ops.riffler.cut_curve(curve=c.name, depth=1, axis="TILT", tool=common.FLAT)
    path = common.out("strokes.rjournal")
    bpy.ops.riffler.export_recording(filepath=path)
    first = common.content(ob)
    bpy.ops.riffler.new_stock(source="RECORDING", recording=path)
    again = bpy.context.object
    assert again != ob and common.content(again).volume.volume == 24000
    bpy.ops.riffler.cut_recording(filepath=path)
    second = common.content(again)
    assert common.same(common.shape(first.volume), common.shape(second.volume))
    assert [c.tool for c in first.cuts] == [c.tool for c in second.cuts]
    assert all(np.array_equal(a.poses, b.poses) for a, b in zip(first.cuts, second.cuts, strict=True))


@common.core_bound
def test_a_recording_is_cut_with_another_tool():
    """A ball's path followed by a flat end: a slot as wide as the tool, with a half disc at either end."""
    common.scale(1)
    common.stock(pitch=0.25)
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    bpy.ops.riffler.cut_curve(curve=c.name, depth=1, tool=common.BALL)
    path = common.out("ball.rjournal")
    bpy.ops.riffler.export_recording(filepath=path)
    slot = 20 * 6 + np.pi * 9
    bpy.context.scene.riffler.tool.kind, bpy.context.scene.riffler.tool.diameter = "flat", 6.0
    for given in ({"other": True}, {"tool": common.FLAT}):
        again = common.stock(pitch=0.25)
        bpy.ops.riffler.cut_recording(filepath=path, **given)
        removed = 24000 - common.content(again).volume.volume
        assert abs(removed / slot - 1) < 0.01, (removed, slot)
        assert [cut.tool["kind"] for cut in common.content(again).cuts] == ["flat"]


def test_files_that_are_no_recordings_are_named():
    common.scale(1)
    ob = common.stock()
    path = Path(common.out("bad.rjournal"))
    path.write_bytes(b"hello")
    common.refused(lambda: bpy.ops.riffler.cut_recording(filepath=str(path)), "bad.rjournal")
    common.refused(lambda: bpy.ops.riffler.cut_recording(filepath=str(path) + "x"), "bad.rjournalx")
    common.refused(lambda: bpy.ops.riffler.new_stock(source="RECORDING", recording=str(path)), "bad.rjournal")
    assert common.content(ob).volume.volume == 24000


def written():
    """The warnings of NC code and of a recording."""
    said = common.printed(lambda: bpy.ops.riffler.export_nc(filepath=common.out("left.ngc")))
    again = common.printed(lambda: bpy.ops.riffler.export_recording(filepath=common.out("left.rjournal")))
    assert [line for line in again.splitlines() if "Warning" in line] == [
        line for line in said.splitlines() if "Warning" in line
    ]
    return said


@common.core_bound
def test_code_of_masked_cuts_warns_that_it_cuts_protected_material():
    from support import sculpting

    ob = cut_stock(1.0, "xyz")
    assert "Warning" not in written()
    bpy.ops.mesh.primitive_cube_add(size=10, location=(20, 15, 20))
    form = bpy.context.object
    common.select(ob)
    bpy.ops.riffler.mask_form(form=form.name)
    assert "Warning" not in written()  # nothing has been cut with it yet
    c = common.curve("Across", [(5, 15, 16), (35, 15, 16)], mm_per_unit=1)
    common.select(ob)
    bpy.ops.riffler.cut_curve(curve=c.name, tool=common.BALL)
    assert "with a mask: 1." in written()
    for look in (bpy.ops.riffler.verify, bpy.ops.riffler.simulate):  # users of the program are warned, too
        assert "with a mask: 1." in common.printed(lambda look=look: look(source="CUTS"))
    bpy.ops.riffler.simulate_stop()
    sculpting.stroke(ob.name, 2)
    assert "with a mask: 2." in written()
    sculpting.live().end_all()
    common.part("sculpt.sculpt_store").clear_cache()  # as in another session
    assert "with a mask: 2." in written() and "smoothing" not in written()
    assert [cut.masked for cut in common.content(ob).cuts] == [False, True, True]


def test_code_of_a_sculpt_shaped_by_other_means_names_what_it_lacks():
    from support import sculpting

    name = sculpting.sculpt(size=(60, 60, 20))
    sculpting.stroke(name, 1)
    assert "Warning" not in written()
    run = sculpting.work(name)
    run.begin_stroke()
    run.carve(sculpting.BALL, np.array([[20.0, 9, 20, 0, 0, 1], [30.0, 9, 20, 0, 0, 1]]), mode="soften")
    run.cancel_stroke()
    sculpting.stroke(name, 2)
    assert "Warning" not in written()
    run.begin_stroke()
    run.carve(sculpting.BALL, np.array([[20.0, 9, 20, 0, 0, 1], [30.0, 9, 20, 0, 0, 1]]), mode="soften")
    assert run.finish_stroke(bpy.context, "smooth")
    assert "smoothing" in written()
    bpy.ops.ed.undo()
    assert "Warning" not in written()
    sculpting.live().end_all()
    assert bpy.ops.riffler.crop(point=(50, 0, 0), normal=(1, 0, 0)) == {"FINISHED"}
    common.part("sculpt.sculpt_store").clear_cache()
    bpy.ops.riffler.resample(pitch=1.0)
    assert "smoothing" in written()
