"""A live sculpt: chunks, undo by strokes, and the sculpt afterwards."""

import bpy
import numpy as np
import riffler
from mathutils import Matrix

from support import common
from support.sculpting import (
    BALL,
    corner_numbers,
    is_shown,
    live,
    matches_its_volume,
    nothing_is_left,
    sculpt,
    stroke,
    work,
)


class close_to(float):
    """Equal within a millionth."""

    def __eq__(self, other):
        return abs(other - float(self)) <= 1e-6 * abs(self) + 1e-9

    __hash__ = None


def test_chunks_show_the_volume_and_only_dirty_ones_move():
    name = sculpt(pitch=0.5)  # 32 chunks
    run = work(name)
    is_shown(name)
    assert common.part("sculpt.chunks").is_hidden(bpy.data.objects[name])
    run.stages.take_counts()
    stroke(name, 1)
    counts = run.stages.take_counts()
    assert 0 < counts["chunks"] <= 12 and counts["moves"] == 1
    is_shown(name)
    run.show()
    assert run.stages.take_counts()["bytes"] == 0
    for k in range(20):
        stroke(name, 7 * k, "add" if k % 3 == 0 else "remove")
    is_shown(name)
    assert all(m.validate() is False for m in bpy.data.meshes)
    live().end_all()
    nothing_is_left()
    matches_its_volume(name)


def test_seams_of_added_material_are_sharp_all_along():
    """An edge that is sharp next to one that is smooth looks like crumbs. Beads of the default radius and depth, on a
    ball of 25 mm."""
    radius, depth, ball = 3.0, 0.5, 25.0
    volume = riffler.Volume.empty((-20, -15, 14), (20, 15, 28), 0.25, "xyz")
    volume.carve(riffler.Tool.ball(2 * ball, 2 * ball), [(0, 0, ball, 0, 0, -1)] * 2, mode="add")
    t = np.linspace(-0.5, 0.5, 200)
    for k in range(5):
        normals = np.stack([t, 0.1 * k - 0.2 + 0.05 * np.sin(9 * t + k), np.ones_like(t)], axis=1)
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        poses = np.hstack([(ball + depth) * normals, -normals])
        volume.carve(riffler.Tool.ball(2 * radius, radius), poses, mode="add")
    mesh = volume.to_mesh()
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    ends = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    order = np.lexsort(ends.T)
    first, second = order[0::2] % len(triangles), order[1::2] % len(triangles)
    assert (ends[order[0::2]] == ends[order[1::2]]).all()
    bend = np.degrees(np.arccos(np.clip((normals[first] * normals[second]).sum(axis=1), -1, 1)))
    seams = bend[(bend > 12) & (bend < 60) & (corners[first][:, :, 2].min(axis=1) > 15)]
    undecided = np.abs(seams - np.degrees(common.part("blender.meshes").SHARP_ANGLE)) < 2
    assert len(seams) > 500 and undecided.mean() < 0.08, undecided.mean()
    assert (np.abs(seams - 30) < 2).mean() > 0.2, "the angle that separated them before"


def test_chunks_are_smooth_from_the_start_and_have_the_normals_of_the_whole():
    for detail in ("NEEDED", "ALL"):
        name = sculpt(pitch=0.5)
        bpy.data.objects[name].data.riffler.detail = detail
        run = work(name)
        for k in (None, 1, 7, 14):
            if k is not None:
                stroke(name, k)
            shaded_as_the_whole(run)
        few = detail == "NEEDED" and common.part("blender.versions").OWN_NORMALS
        assert (run.mesher.triangles < 0.1 * run.mesher.all_triangles) == few
        live().end_all()


def shaded_as_the_whole(run):
    """With all triangles, before 4.5 Blender makes the normals at a chunk's border from the chunk's own triangles;
    before 4.1 triangles at sharp edges are flat, and all others smooth."""
    meshes, versions = common.part("blender.meshes"), common.part("blender.versions")
    objects = [ob for ob in common.part("sculpt.chunks").collection_of(run.mark).objects if "riffler_chunk" in ob]
    filled = [ob.data for ob in objects if len(ob.data.polygons)]
    for mesh in filled:
        smooth = np.empty(len(mesh.polygons), bool)
        mesh.polygons.foreach_get("use_smooth", smooth)
        assert smooth.mean() > (0.8 if versions.SMOOTH_BY_POLYGON else 0.999)
    if not versions.OWN_NORMALS:
        return
    whole = riffler.Mesher(run.volume, tolerance=run.mesher.tolerance)
    patch = whole.patch(whole.patches(), normals=meshes.SHARP_ANGLE)
    known = corner_numbers(patch.vertices / run.mm, patch.triangles)
    order = np.argsort(known)
    known, normals = known[order], np.asarray(patch.normals)[order]
    for mesh in filled:
        shown = common.corner_normals(mesh)
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        own = corner_numbers(common.coordinates(mesh), corners.reshape(-1, 3))
        at = np.minimum(np.searchsorted(known, own), len(known) - 1)
        assert np.array_equal(known[at], own), "a corner of a chunk is none of the whole"
        off = np.linalg.norm(shown - normals[at], axis=1)
        assert np.degrees(off.max()) < 0.01


def test_chunks_hang_on_one_go_where_the_sculpt_goes_and_stay_there_without_it():
    name = sculpt()
    run = work(name)
    chunks = [ob for ob in common.part("sculpt.chunks").collection_of(run.mark).objects if "riffler_chunk" in ob]
    (root,) = [ob for ob in chunks if ob.parent is None]
    assert len(chunks) > 1
    for matrix in (Matrix.Translation((5, 6, 7)), Matrix.Rotation(0.5, 4, "Y")):
        bpy.data.objects[name].matrix_world = matrix
        stroke(name, 1 + int(matrix[0][3]))
        run.show()
        bpy.context.view_layer.update()
        assert all(np.allclose(ob.matrix_world, matrix, atol=1e-6) for ob in chunks)
        if root is not None:
            chunks.remove(root)
            bpy.data.objects.remove(root)
            root = None
    live().end_all()
    nothing_is_left()
    matches_its_volume(name)


def test_work_that_is_ended_is_in_volume_mesh_and_cuts():
    name = sculpt()
    last = [stroke(name, k) for k in range(3)][-1]
    assert common.part("sculpt.sculpts").behind(bpy.data.objects[name].data)  # the mesh is updated later
    live().end_all()
    content = common.content(bpy.data.objects[name])
    assert content.volume.to_bytes() == last
    assert [c.moves for c in content.cuts] == [1, 1, 1]
    matches_its_volume(name)
    nothing_is_left()


def test_the_panel_has_the_facts_of_the_last_stroke():
    name = sculpt()

    def of_the_mesh():
        p = bpy.data.objects[name].data.riffler
        return p.material, p.nbytes, p.cuts, p.moves

    run, before = work(name), of_the_mesh()
    assert run.facts == before
    stroke(name, 1)
    assert run.facts.cuts == 1 and run.facts.material == run.volume.volume < before[0]
    assert run.facts is run.facts, "counted once"
    assert of_the_mesh() == before, "the mesh has to wait"
    bpy.ops.ed.undo()
    run = work(name)
    assert run.facts == before
    stroke(name, 2)
    kept = run.facts
    live().end_all()
    assert np.allclose(of_the_mesh(), kept, rtol=1e-6, atol=0), "of which Blender keeps single floats"


def test_live_work_replaces_damaged_data_of_the_file():
    name = sculpt()
    last = stroke(name, 1)
    image = bpy.data.objects[name].data.riffler.store
    block = bytearray(image.packed_file.data)
    block[len(block) // 2] ^= 0xFF
    image.pack(data=bytes(block), data_len=len(block))
    common.part("sculpt.sculpt_store").clear_cache()
    live().end_all()
    assert common.content(bpy.data.objects[name]).volume.to_bytes() == last
    nothing_is_left()


def refused(call, *words):
    try:
        call()
    except ValueError as error:
        assert all(word in str(error) for word in words), error
        return
    raise AssertionError("no message was shown")


def test_edit_mode_has_the_strokes_and_keeps_them():
    """Like the workspace Modeling, which calls no operator of ours."""
    for packed in (False, True):
        name = sculpt()
        last = stroke(name, 1)
        run, ob = work(name), bpy.data.objects[name]
        if packed:
            run.persistence.look(ob, common.content(ob), run.token)
        with bpy.context.temp_override(active_object=ob, object=ob, selected_objects=[ob]):
            bpy.ops.object.mode_set(mode="EDIT")
        run.look(0.0)
        assert ob.mode == "EDIT" and not common.part("sculpt.live_sculpt").lives
        nothing_is_left()
        with bpy.context.temp_override(active_object=ob, object=ob, selected_objects=[ob]):
            bpy.ops.object.mode_set(mode="OBJECT")
        assert common.content(ob).volume.to_bytes() == last
        matches_its_volume(name)
        bpy.data.objects.remove(ob)


def test_chunks_that_cannot_be_filled_are_not_packed():
    name = sculpt()
    run, ob = work(name), bpy.data.objects[name]
    stroke(name, 1)
    before = common.part("sculpt.sculpt_store").identity(ob.data)
    with bpy.context.temp_override(active_object=ob, object=ob, selected_objects=[ob]):
        bpy.ops.object.mode_set(mode="EDIT")
    refused(run.commit, "Edit Mode: leave it first")
    assert common.part("sculpt.sculpt_store").identity(ob.data) == before
    run.end()


def test_linked_duplicates_share_their_strokes():
    name = sculpt()
    ob = bpy.data.objects[name]
    other = bpy.data.objects.new("Other", ob.data)
    bpy.context.scene.collection.objects.link(other)
    common.push("linked")
    stroke(name, 1)
    stroke("Other", 2)
    last = stroke(name, 3)
    live().end_all()
    content = common.content(ob)
    assert content.volume.to_bytes() == last and len(content.cuts) == 3
    matches_its_volume(name)
    nothing_is_left()


def test_a_duplicate_has_the_state_in_which_it_was_made():
    name = sculpt()
    made = stroke(name, 1)
    ob = bpy.data.objects[name]
    copy = ob.copy()
    copy.data = ob.data.copy()
    bpy.context.scene.collection.objects.link(copy)
    common.push("copy")
    last = stroke(name, 2)
    live().end_all()
    assert common.content(copy).volume.to_bytes() == made != last
    assert common.content(ob).volume.to_bytes() == last


def test_a_sheared_sculpt_is_refused_with_the_remedy():
    name = sculpt()
    ob, above = bpy.data.objects[name], bpy.data.objects.new("Above", None)
    bpy.context.scene.collection.objects.link(above)
    above.scale, ob.parent, ob.rotation_euler.z = (2, 1, 1), above, 0.6
    bpy.context.view_layer.update()
    refused(lambda: work(name), f"{name} is sheared", "Clear and Keep Transformation", "Clear > Scale")
    nothing_is_left()


def test_a_stroke_that_changes_nothing_is_none_and_a_cancelled_one_leaves_no_trace():
    name = sculpt()
    run = work(name)
    before = run.volume.to_bytes()
    run.begin_stroke()
    assert not run.finish_stroke(bpy.context)
    run.carve(BALL, np.array([[10.0, 10, 15, 0, 0, 1], [40, 10, 15, 0, 0, 1]]))
    run.show()
    run.cancel_stroke()
    assert run.volume.to_bytes() == before and run.cuts == []
    is_shown(name)
    live().end_all()
    matches_its_volume(name)


def test_any_walk_through_undo_and_redo_shows_the_state_that_was_made():
    name = sculpt()
    states = [work(name).volume.to_bytes()]
    states += [stroke(name, k, ("remove", "add")[k % 4 == 3]) for k in range(8)]
    at, rng = 8, np.random.default_rng(4)
    for _ in range(30):
        if (rng.random() < 0.5 and at > 1) or at == 8:
            bpy.ops.ed.undo()
            at -= 1
        else:
            bpy.ops.ed.redo()
            at += 1
        assert live().of(bpy.data.objects[name]).volume.to_bytes() == states[at], at
        is_shown(name)
    while at < 8:
        bpy.ops.ed.redo()
        at += 1
    bpy.ops.ed.undo()
    states[8:] = [stroke(name, 11)]
    is_shown(name)
    live().end_all()
    assert common.content(bpy.data.objects[name]).volume.to_bytes() == states[8]


def test_undo_fills_no_chunk_again():
    name = sculpt()
    for k in range(4):
        stroke(name, k)
    run = work(name)
    run.stages.take_counts()
    for _ in range(3):
        bpy.ops.ed.undo()
    for _ in range(3):
        bpy.ops.ed.redo()
    assert live().of(bpy.data.objects[name]) is run
    assert run.stages.take_counts()["chunks"] == 0
    is_shown(name)


def test_chunks_that_undo_has_not_restored_are_filled_again():
    name = sculpt()
    for k, stale in enumerate((slice(1), slice(-1, None), slice(None))):
        stroke(name, k)
        run = work(name)
        found = common.part("sculpt.chunks").collection_of(bpy.data.objects[name].riffler.mark).objects
        shown = {ob["riffler_chunk"]: ob.data for ob in found if "riffler_chunk" in ob and len(ob.data.polygons)}
        assert len(shown) > 2
        blocks = sorted(shown)[stale]
        for block in blocks:
            shown[block].clear_geometry()
            shown[block]["riffler_filling"] = 0
        run.stages.take_counts()
        assert run.follow()
        assert run.stages.take_counts()["chunks"] == len(blocks)
        is_shown(name)


def test_undo_past_the_beginning_ends_the_work_and_redo_continues_it():
    name = sculpt()
    before = common.content(bpy.data.objects[name]).volume.to_bytes()
    first, second = stroke(name, 0), stroke(name, 1)
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert live().of(bpy.data.objects[name]) is None
    assert common.content(bpy.data.objects[name]).volume.to_bytes() == before
    matches_its_volume(name)
    bpy.ops.ed.redo()
    assert live().of(bpy.data.objects[name]).volume.to_bytes() == first
    is_shown(name)
    bpy.ops.ed.redo()
    assert live().of(bpy.data.objects[name]).volume.to_bytes() == second
    live().end_all()
    matches_its_volume(name)


def test_undo_after_the_end_brings_the_work_back():
    name = sculpt()
    first, second = stroke(name, 0), stroke(name, 1)
    live().end_all()
    bpy.data.objects[name].location.x = 5
    common.push("moved")
    bpy.ops.ed.undo()
    assert live().of(bpy.data.objects[name]).volume.to_bytes() == second
    is_shown(name)
    bpy.ops.ed.undo()
    assert live().of(bpy.data.objects[name]).volume.to_bytes() == first
    third = stroke(name, 2)
    is_shown(name)
    live().end_all()
    assert common.content(bpy.data.objects[name]).volume.to_bytes() == third != second
    matches_its_volume(name)
    nothing_is_left()


def test_strokes_before_and_after_growing_the_box_are_undone_and_replayed_to_the_byte():
    name = sculpt()

    def now():
        ob = bpy.data.objects[name]
        run = live().of(ob)
        return (common.content(ob) if run is None else run).volume.to_bytes()

    made = [now(), stroke(name, 0)]
    common.select(bpy.data.objects[name])
    assert bpy.ops.riffler.room("EXEC_DEFAULT", True, room=3.0) == {"FINISHED"}
    made += [now(), stroke(name, 1, "add"), stroke(name, 2)]
    run = live().of(bpy.data.objects[name])
    assert run.persistence.journal.state(run.token).volume.to_bytes() == made[-1]
    for state in made[-2::-1]:
        bpy.ops.ed.undo()
        assert now() == state
    for state in made[1:]:
        bpy.ops.ed.redo()
        assert now() == state
    live().end_all()
    matches_its_volume(name)


def test_two_sculpts_are_sculpted_and_undone_in_turn():
    a, b = sculpt("A"), sculpt("B")
    done = []
    for k in range(6):
        which = (a, b)[k % 2]
        stroke(which, k)
        done.append(
            {n: live().of(bpy.data.objects[n]).volume.to_bytes() for n in (a, b) if live().of(bpy.data.objects[n])}
        )
    for k in range(4, 0, -1):
        bpy.ops.ed.undo()
        for n, state in done[k].items():
            assert live().of(bpy.data.objects[n]).volume.to_bytes() == state, (k, n)
            is_shown(n)
    live().end_all()
    for n in (a, b):
        assert common.content(bpy.data.objects[n]).volume.to_bytes() == done[1][n]
        matches_its_volume(n)
    nothing_is_left()


def test_a_saved_file_has_the_last_stroke_and_opens_without_chunks():
    name = sculpt()
    last = stroke(name, 3)
    path = common.out("live.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    nothing_is_left()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert common.content(bpy.data.objects[name]).volume.to_bytes() == last
    matches_its_volume(name)
    nothing_is_left()


def test_a_file_that_cannot_be_opened_loses_no_work():
    name = sculpt()
    stroke(name, 2)
    last = stroke(name, 3)
    broken = common.out("broken.blend")
    with open(broken, "wb") as file:
        file.write(b"no .blend at all")
    for k, path in enumerate((broken, common.out("there_is_none.blend"))):
        common.refused(lambda path=path: bpy.ops.wm.open_mainfile(filepath=path))
        assert live().content(bpy.data.objects[name]).volume.to_bytes() == last
        live().end_all()  # if the add-on was notified of the other file, it has ended already
        assert common.content(bpy.data.objects[name]).volume.to_bytes() == last
        matches_its_volume(name)
        nothing_is_left()
        last = stroke(name, 5 + k)  # and it continues


def outlines():
    views = common.part("sculpt.chunks").views()
    return [space.shading.show_object_outline for _, _, space in views]


def test_outlines_are_restored_at_every_end_of_the_work():
    """No undo restores a view's settings."""
    views = [space.shading for _, _, space in common.part("sculpt.chunks").views()]
    for shading, on in zip(views, [True, False] * len(views), strict=False):
        shading.show_object_outline = on
    before = outlines()
    assert any(before), "this scene has no 3D view that could draw outlines"
    name = sculpt()
    for _ in range(2):
        stroke(name, 1)
        assert not any(outlines())
        bpy.ops.ed.undo()
        assert outlines() == before
        bpy.ops.ed.redo()
        assert not any(outlines())
        bpy.ops.ed.undo()
    stroke(name, 1)
    live().end_all()
    assert outlines() == before


def test_deleting_chunks_ends_the_work_and_shows_the_sculpt():
    name = sculpt()
    last = stroke(name, 1)
    before = outlines()
    for collection in [c for c in bpy.data.collections if common.part("sculpt.chunks").MARK in c]:
        for ob in list(collection.objects):
            bpy.data.objects.remove(ob)
        bpy.data.collections.remove(collection)
    live().end_all()
    ob = bpy.data.objects[name]
    assert not ob.hide_get() and common.content(ob).volume.to_bytes() == last
    matches_its_volume(name)
    assert all(now or not was for now, was in zip(outlines(), before, strict=True))


def test_a_hidden_sculpt_stays_hidden():
    name = sculpt()
    ob, scene = bpy.data.objects[name], bpy.context.scene
    other = scene.view_layers.new("Other")
    ob.hide_set(True, view_layer=other)
    common.push("hidden")
    stroke(name, 1)
    live().end_all()
    ob = bpy.data.objects[name]
    assert not ob.hide_get() and ob.hide_get(view_layer=scene.view_layers["Other"])
    scene.view_layers.remove(scene.view_layers["Other"])


def test_a_copy_of_a_chunk_belongs_to_the_user():
    """In the collection or outside it, with a mesh of its own or without one. The display objects themselves are
    removed, wherever they were moved."""
    name = sculpt(directions="z")
    bpy.data.objects[name].location.x = 5
    bpy.context.view_layer.update()
    stroke(name, 1)
    chunks = common.part("sculpt.chunks")
    ours = chunks.collection_of(bpy.data.objects[name].riffler.mark)
    first, second = [ob for ob in ours.objects if len(ob.data.polygons) and ob.parent is not None][:2]
    elsewhere = bpy.context.scene.collection
    copies = set()
    for of, linked, home in ((first, True, ours), (second, False, ours), (first, False, elsewhere)):
        copy = of.copy()
        copy.data = of.data if linked else of.data.copy()
        home.objects.link(copy)
        copies.add(copy.name)
    bpy.context.view_layer.update()
    ours.objects.unlink(second)
    elsewhere.objects.link(second)
    gone = {ob.name for ob in bpy.data.objects if chunks.is_own(ob)}
    assert {first.name, second.name} < gone and not gone & copies
    live().end_all()
    nothing_is_left()
    bpy.context.view_layer.update()
    assert not gone & set(bpy.data.objects.keys())
    for copy in copies:
        ob = bpy.context.scene.objects[copy]
        assert len(ob.data.polygons) and ob.matrix_world.translation.x == 5, copy
    matches_its_volume(name)


def test_a_full_copy_of_the_scene_leaves_no_chunks():
    name = sculpt(directions="z")
    stroke(name, 1)
    bpy.ops.scene.new(type="FULL_COPY")
    live().end_all()
    nothing_is_left()
    assert not [ob.name for ob in bpy.data.objects if ob.name.startswith("Riffler Chunk")]


def test_operators_on_the_sculpt_get_the_shown_state():
    name = sculpt()
    last = stroke(name, 3)
    path = common.out("live.stl")
    bpy.context.view_layer.objects.active = bpy.data.objects[name]
    assert bpy.ops.riffler.export_stl(filepath=path, detail="ALL") == {"FINISHED"}
    volume = live().of(bpy.data.objects[name]).volume
    assert riffler.Mesh.read(path).volume == close_to(volume.to_mesh().volume)
    assert volume.to_bytes() == last
    assert bpy.ops.riffler.rebuild() == {"FINISHED"}
    nothing_is_left()
    matches_its_volume(name)


def test_a_sculpt_that_is_removed_takes_its_work_with_it():
    name = sculpt()
    stroke(name, 1)
    bpy.data.objects.remove(bpy.data.objects[name])
    live().end_all()
    nothing_is_left()


def test_symmetry_cuts_copies_and_keeps_them_as_cuts():
    symmetry = common.part("sculpt.pure.symmetry")
    name = sculpt()
    run = work(name)
    run.maps = symmetry.maps("XY")
    run.begin_stroke()
    poses = np.array([[10.0, 10, 18, 0, 0, 1], [20, 10, 18, 0, 0, 1], [24, 14, 18, 0, 0, 1]])
    run.carve(BALL, poses[:2])
    run.carve(BALL, poses[1:], new=False)
    run.finish_stroke(bpy.context, "four")
    assert [c.moves for c in run.cuts] == [2, 2, 2, 2]
    again = common.content(bpy.data.objects[name]).volume.copy()
    for cut in run.cuts:
        again.carve(riffler.Tool.from_dict(cut.tool), cut.poses)
    assert again.volume == close_to(run.volume.volume)
    live().end_all()


def test_smoothing_removes_roughness_keeps_masked_material_and_is_undone():
    name = sculpt()
    for k in range(6):
        stroke(name, 2 * k)
    run = work(name)
    rough = run.volume.to_bytes()
    run.strength = 1.0
    dabs = np.array([[x, 30.0, 19, 0, 0, 1] for x in np.arange(12.0, 48, 2)])
    run.begin_stroke()
    assert run.carve(riffler.Tool.ball(16, 30), dabs, mode="soften") is None
    assert run.finish_stroke(bpy.context, "smooth")
    smooth = run.volume.to_bytes()
    assert smooth != rough and not run.volume.to_mesh().audit().open_edges
    is_shown(name)
    bpy.ops.ed.undo()
    assert live().of(bpy.data.objects[name]).volume.to_bytes() == rough
    run = work(name)
    run.begin_stroke()
    run.carve(riffler.Tool.ball(60, 60), np.array([[30.0, 30, -5, 0, 0, 1], [30, 30.1, -5, 0, 0, 1]]), mode="mask")
    run.carve(riffler.Tool.ball(16, 30), dabs, mode="soften")
    kept = run.mask.copy().intersect(run.volume).to_bytes()
    assert run.mask.copy().intersect(riffler.Volume.from_bytes(rough)).to_bytes() == kept
    run.cancel_stroke()
    assert run.volume.to_bytes() == rough


def test_taking_away_a_mask_that_is_not_there_is_no_stroke():
    name = sculpt()
    run = work(name)
    run.begin_stroke()
    assert run.carve(BALL, np.array([[8.0, 9, 18, 0, 0, 1], [50, 9, 18, 0, 0, 1]]), mode="unmask") is None
    assert run.mask is None and not run.finish_stroke(bpy.context, "unmask")
    run.end()
    assert common.content(bpy.data.objects[name]).mask is None


def test_a_mask_protects_is_saved_and_undone():
    name = sculpt()
    run = work(name)
    run.begin_stroke()
    run.carve(BALL, np.array([[30.0, 5, 16, 0, 0, 1], [30, 55, 16, 0, 0, 1]]), mode="mask")
    assert run.finish_stroke(bpy.context, "mask") and run.cuts == []
    protected = run.mask.to_bytes()
    full = run.volume.volume
    stroke(name, 2)
    kept = run.volume.copy().intersect(run.mask).volume
    assert kept == close_to(run.mask.volume)
    assert run.volume.volume < full
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert live().of(bpy.data.objects[name]) is None or live().of(bpy.data.objects[name]).mask is None
    bpy.ops.ed.redo()
    assert live().of(bpy.data.objects[name]).mask.to_bytes() == protected
    path = common.out("mask.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert common.content(bpy.data.objects[name]).mask.to_bytes() == protected


def covered(name_or_mesh):
    """Area shares of faces with the mask's material: of a sculpt's chunks, or of one mesh."""
    if isinstance(name_or_mesh, str):
        found = [ob.data for ob in common.part("sculpt.chunks").collection_of(work(name_or_mesh).mark).objects]
    else:
        found = [name_or_mesh]
    total = masked = 0.0
    for mesh in found:
        slots = [m.name if m else "" for m in mesh.materials]
        for polygon in mesh.polygons:
            total += polygon.area
            if slots and slots[polygon.material_index] == "Riffler Mask":
                masked += polygon.area
    return masked / total


def test_protected_material_is_shown_while_painting_and_afterwards():
    name = sculpt(size=(40, 30, 20))
    run = work(name)
    assert covered(name) == 0
    run.begin_stroke()
    run.carve(riffler.Tool.flat(20, 60), np.array([[20.0, 15, -5, 0, 0, 1], [20, 15.001, -5, 0, 0, 1]]), mode="mask")
    run.stages.take_counts()
    assert run.finish_stroke(bpy.context, "mask")
    # two discs of 10 mm radius on a block of 40 × 30 × 20
    share = 2 * np.pi * 100 / (2 * (1200 + 800 + 600))
    assert abs(covered(name) - share) < 0.03
    run.begin_stroke()
    run.carve(riffler.Tool.flat(20, 60), np.array([[5.0, 5, -5, 0, 0, 1], [5, 5.001, -5, 0, 0, 1]]), mode="mask")
    run.show()
    assert covered(name) > share + 0.05
    run.cancel_stroke()
    assert abs(covered(name) - share) < 0.03
    live().end_all()
    mesh = bpy.data.objects[name].data
    assert abs(covered(mesh) - share) < 0.03
    common.select(bpy.data.objects[name])
    bpy.ops.riffler.mask_clear()
    assert covered(mesh) == 0
