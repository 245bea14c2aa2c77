"""Interrupted sessions: a Blender that is killed, files that an autosave has written, incomplete journals."""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import zlib
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, recovering
from support.sculpting import is_shown, live, matches_its_volume, nothing_is_left, sculpt, stroke, work

MARK = "RIFFLER_TEST "


def keeping():
    return common.part("sculpt.persistence")


@contextmanager
def fresh():
    """Removes what was interrupted before."""
    root = keeping().folder()
    root.mkdir(parents=True, exist_ok=True)
    for path in root.iterdir():
        if not any(getattr(j, "folder", None) == path for j in (*keeping()._open, *keeping()._parked)):
            shutil.rmtree(path)
    keeping().crashed(look=True)
    yield root


def command():
    here = Path(recovering.__file__)
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--background", "--factory-startup", "--python", str(here)]
    return [sys.executable, str(here)]


@contextmanager
def another_blender(what, path=""):
    """Another Blender that sculpts; the yielded function reads its next message."""
    with tempfile.TemporaryDirectory() as resources:
        (Path(resources) / "scripts" / "addons").mkdir(parents=True)
        job = {**common.JOB, "what": what, "path": path, "copies": common.out("copies")}
        job["journals"] = str(keeping().folder())
        (Path(resources) / "job.json").write_text(json.dumps(job))
        variables = {
            "RIFFLER_TEST_JOB": str(Path(resources) / "job.json"),
            "BLENDER_USER_RESOURCES": resources,
            "BLENDER_USER_SCRIPTS": str(Path(resources) / "scripts"),
        }
        child = subprocess.Popen(
            command(), env={**os.environ, **variables}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        lines = []

        def messages():
            for line in child.stdout:
                lines.append(line)
                _, mark, text = line.partition(MARK)
                if mark:
                    yield json.loads(text)
            raise AssertionError("".join(lines[-20:]))

        try:
            yield child, messages()
        finally:
            child.kill()
            child.wait(30)
            child.stdout.close()


_cut_off = {}  # path of a file or "" → the journal that a killed Blender has left, and the rows that it reported


def cut_off(path=""):
    """Like `killed`, with a copy of the first one's journal: a Blender's start takes longer than most tests."""
    if path not in _cut_off:
        said = killed(path)
        _cut_off[path] = kept_journal(f"cut_off-{len(_cut_off)}"), said
        return said
    kept, said = _cut_off[path]
    leave_behind(kept)
    return said


def kept_journal(name):
    """A copy of the only journal that was left behind."""
    (folder,) = {found.folder for found in keeping().crashed(look=True)}
    copy = Path(common.out(name))
    shutil.rmtree(copy, ignore_errors=True)
    return shutil.copytree(folder, copy)


def leave_behind(journal):
    """Puts a copy of a journal where a killed Blender leaves it."""
    root = keeping().folder()
    shutil.copytree(journal, root / f"cut-off-{len(list(root.iterdir()))}")


def killed(path, rows=300):
    """A Blender killed in the middle of a stroke; the rows of it that it reported as carved."""
    with another_blender("stroke", path) as (child, messages):
        said = 0
        for message in messages:
            said = message.get("rows", 0)
            if said >= rows:
                break
        child.send_signal(signal.SIGKILL)
        child.wait(30)
        for line in child.stdout.read().splitlines():
            if MARK in line:
                try:
                    said = json.loads(line.partition(MARK)[2])["rows"]
                except ValueError:  # truncated
                    break
    return said


def is_whole(name, said):
    """Everything reported as carved is there, and perhaps what was carved since."""
    made = common.content(bpy.data.objects[name]).volume.to_bytes()
    found = [r for r in (said, said + recovering.ROWS) if recovering.expected(r).to_bytes() == made]
    assert found, f"not the volume after {said} rows"
    matches_its_volume(name)
    cuts = common.content(bpy.data.objects[name]).cuts
    assert [c.mode for c in cuts] == ["remove", "add", "remove", "remove"]
    assert len(cuts[-1].poses) == found[0] + 1
    return (found[0] - said) / recovering.ROWS


def test_killed_in_mid_stroke_without_a_file_and_recovered_as_a_new_object():
    with fresh() as root:
        assert not bpy.ops.riffler.recover.poll()
        said = cut_off()
        common.scale(1)
        found = keeping().crashed(look=True)
        assert [f.name for f in found] == ["Stock"] and bpy.ops.riffler.recover.poll()
        assert bpy.ops.riffler.recover("EXEC_DEFAULT", True) == {"FINISHED"}
        is_whole("Stock", said)
        assert common.content(bpy.data.objects["Stock"]).mask.volume > 0
        assert not keeping().crashed() and len(list(root.iterdir())) == 1, "the journal waits for the file to be saved"
        bpy.ops.wm.save_as_mainfile(filepath=common.out("recovered.blend"))
        assert not list(root.iterdir())
        bpy.ops.wm.open_mainfile(filepath=common.out("recovered.blend"))
        is_whole("Stock", said)


def test_unsaved_recovered_work_is_offered_again():
    with fresh() as root:
        cut_off()
        common.scale(1)
        keeping().crashed(look=True)
        common.push("before")
        assert bpy.ops.riffler.recover("EXEC_DEFAULT", True) == {"FINISHED"}
        bpy.ops.ed.undo()
        bpy.ops.wm.save_as_mainfile(filepath=common.out("undone.blend"))
        assert len(list(root.iterdir())) == 1 and len(keeping().crashed()) == 1, "the panel does not offer it"
        assert bpy.ops.riffler.recover("EXEC_DEFAULT", True) == {"FINISHED"}
        bpy.ops.wm.open_mainfile(filepath=common.out("undone.blend"))  # without saving
        assert len(list(root.iterdir())) == 1 and len(keeping().crashed(look=True)) == 1


def test_a_recovery_that_fails_leaves_the_journal_to_others():
    with fresh():
        cut_off()
        common.scale(1)
        found = keeping().crashed(look=True)[0]
        stock = found.folder / "stock.rvol"
        whole = stock.read_bytes()
        stock.write_bytes(whole[: len(whole) // 2])
        for _ in range(2):
            common.refused(lambda: bpy.ops.riffler.recover("EXEC_DEFAULT", True), "stock.rvol")
            assert len(keeping().crashed(look=True)) == 1
        stock.write_bytes(whole)
        assert bpy.ops.riffler.recover("EXEC_DEFAULT", True) == {"FINISHED"}
        bpy.ops.wm.save_as_mainfile(filepath=common.out("recovered_late.blend"))


@common.anywhere
def test_killed_in_mid_stroke_and_recovered_into_the_sculpt_of_the_file():
    path = common.out("cut_off.blend")
    with fresh():
        said = cut_off(path)
        bpy.ops.wm.open_mainfile(filepath=path)
        assert len(keeping().crashed()) == 1
        objects = len(bpy.data.objects)
        common.push("opened")
        assert bpy.ops.riffler.recover("EXEC_DEFAULT", True) == {"FINISHED"}
        assert len(bpy.data.objects) == objects
        is_whole("Stock", said)
        bpy.ops.ed.undo()
        assert common.content(bpy.data.objects["Stock"]).volume.volume == 72000
        bpy.ops.ed.redo()
        is_whole("Stock", said)


@common.core_bound
def test_cut_off_in_mid_stroke_of_the_other_modes_and_recovered():
    """One Blender copies its journal in the middle of each stroke, as a crash would leave it."""
    with fresh():
        said = copied("modes")
    for mode in ("add", "soften", "mask"):
        with fresh():
            leave_behind(said[mode]["copy"])
            bpy.ops.wm.read_homefile(use_empty=False)
            common.scale(1)
            keeping().crashed(look=True)
            assert bpy.ops.riffler.recover("EXEC_DEFAULT", True) == {"FINISHED"}
            made = common.content(bpy.data.objects["Stock"])
            volume, mask = recovering.both(said[mode]["rows"], mode)
            assert made.volume.to_bytes() == volume.to_bytes() and made.mask.to_bytes() == mask.to_bytes(), mode
            if mode == "add":  # into the block, where there is no room: only the rows show it
                assert len(made.cuts[-1].poses) - 1 == said[mode]["rows"]
            bpy.ops.wm.save_as_mainfile(filepath=common.out("recovered_mode.blend"))


def copied(what, path=""):
    """Another Blender's reports on the journals that it has copied, by the mode of the stroke it was in."""
    said = {}
    with another_blender(what, path) as (_, messages):
        for message in messages:
            if "rested" in message:
                break
            said[message["mode"]] = message
    return said


_shapes = []


def shapes():
    """What `copied` returns of strokes of hand tools and of brushes with falloff, and the file that they began in."""
    if not _shapes:
        path = common.out("shapes.blend")
        with fresh():
            _shapes.append((copied("shapes", path), path))
    return _shapes[0]


@common.anywhere
def test_cut_off_within_a_stroke_of_a_hand_tool_or_a_brush_and_recovered_to_the_byte():
    copies, _ = shapes()
    for mode in ("hand", "grab"):
        with fresh():
            said = copies[mode]
            leave_behind(said["copy"])
            bpy.ops.wm.read_homefile(use_empty=False)
            common.scale(1)
            keeping().crashed(look=True)
            assert bpy.ops.riffler.recover("EXEC_DEFAULT", True) == {"FINISHED"}
            made = common.content(bpy.data.objects["Stock"])
            assert recovering.digest(made) == said["digest"], mode
            assert made.shaped and len(made.cuts) == 1, "only the first cut is one that a machine can make"
            matches_its_volume("Stock")
            bpy.ops.wm.save_as_mainfile(filepath=common.out("recovered_shapes.blend"))
            bpy.ops.wm.open_mainfile(filepath=common.out("recovered_shapes.blend"))
            assert recovering.digest(common.content(bpy.data.objects["Stock"])) == said["digest"], mode


@common.anywhere
def test_strokes_of_brushes_and_hand_tools_continue_from_the_file_without_the_journal_s_stock():
    said, path = shapes()
    with fresh():
        leave_behind(said["twist"]["copy"])
        (keeping().crashed(look=True)[0].folder / "stock.rvol").unlink()
        bpy.ops.wm.open_mainfile(filepath=path)
        assert bpy.ops.riffler.recover("EXEC_DEFAULT", True) == {"FINISHED"}
        assert recovering.digest(common.content(bpy.data.objects["Stock"])) == said["twist"]["digest"]


@common.anywhere
def test_a_journal_without_its_stock_continues_from_the_file():
    path = common.out("cut_off.blend")
    with fresh():
        said = cut_off(path)
        (keeping().crashed(look=True)[0].folder / "stock.rvol").unlink()
        text = common.refused(lambda: bpy.ops.riffler.recover(), "no stock", "cut_off.blend")
        assert "Stock" in text and len(keeping().crashed(look=True)) == 1
        bpy.ops.wm.open_mainfile(filepath=path)
        bpy.ops.riffler.recover()
        is_whole("Stock", said)


def test_ended_work_leaves_no_journal():
    with fresh() as root, another_blender("end") as (_, messages):
        for message in messages:
            if "rested" in message:
                break
        assert not list(root.iterdir())


@common.core_bound
def test_a_journal_in_use_is_not_recovered_by_another_blender():
    """Another Blender cannot recover a journal in use."""
    with fresh() as root, another_blender("rest") as (child, messages):
        for message in messages:
            if "rested" in message:
                break
        assert len(list(root.iterdir())) == 1 and not keeping().crashed(look=True)
        name = sculpt()
        last = stroke(name, 3)
        assert len(list(root.iterdir())) == 2 and not keeping().crashed(look=True)
        child.kill()
        child.wait(30)
        assert len(keeping().crashed(look=True)) == 1
        lock = common.part("sculpt.pure.journal").Lock(keeping().crashed()[0].folder)
        keeping().crashed()  # as the panel found them
        assert lock.held and not keeping().crashed(look=True)
        lock.release()
        keeping().crashed(look=True)
        bpy.ops.riffler.recover("EXEC_DEFAULT", True)
        recovered = [ob.name for ob in bpy.data.objects if ob.name.startswith("Stock") and ob.name != name]
        assert len(recovered) == 1
        assert common.content(bpy.data.objects[recovered[0]]).volume.to_bytes() == recovering.expected(200).to_bytes()
        assert common.content(bpy.data.objects[name]).volume.to_bytes() == last


def test_damaged_and_newer_journals_are_named_and_kept():
    with fresh() as root:
        cut_off()
        folder = keeping().crashed(look=True)[0].folder
        whole = (folder / "strokes.rjournal").read_bytes()
        newer = bytearray(whole)
        newer[8] = 2
        newer[12:16] = zlib.crc32(bytes(newer[:12])).to_bytes(4, "little")
        damaged = bytearray(whole)
        damaged[len(whole) // 2] ^= 0xFF
        for data, word in ((newer, "version 2"), (damaged, "damaged"), (b"something else", "RIFFLERJ")):
            (folder / "strokes.rjournal").write_bytes(bytes(data))
            text = common.refused(lambda: bpy.ops.riffler.recover(), "is kept", word)
            assert "Stock" in text and len(bpy.data.objects) == 3
            assert (folder / "strokes.rjournal").read_bytes() == bytes(data)
            assert len(keeping().crashed(look=True)) == 1
        # a crash leaves a truncated tail: the complete records count
        (folder / "strokes.rjournal").write_bytes(whole[: len(whole) - 7])
        (folder / "about.json").write_text("{")
        bpy.ops.riffler.recover()
        name = bpy.context.object.name
        made = common.content(bpy.context.object).volume.to_bytes()
        rows = len(common.content(bpy.data.objects[name]).cuts[-1].poses) - 1
        assert made == recovering.expected(rows).to_bytes()
        assert len(list(root.iterdir())) == 1


def test_a_journal_is_discarded_only_on_request():
    with fresh() as root:
        cut_off()
        keeping().crashed(look=True)
        assert len(list(root.iterdir())) == 1
        bpy.ops.wm.read_homefile()
        assert len(list(root.iterdir())) == 1
        assert bpy.ops.riffler.discard_journal() == {"FINISHED"}
        assert not list(root.iterdir()) and not bpy.ops.riffler.recover.poll()
        common.refused(lambda: bpy.ops.riffler.recover(journal="nothing"), "")


def as_autosaved(name):
    """Writes the file like an autosave: unchanged, without a handler."""
    path = common.out(name)
    before = list(bpy.app.handlers.save_pre), list(bpy.app.handlers.save_post)
    for handlers in (bpy.app.handlers.save_pre, bpy.app.handlers.save_post):
        handlers.clear()
    try:
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    finally:
        bpy.app.handlers.save_pre.extend(before[0])
        bpy.app.handlers.save_post.extend(before[1])
    return path


def test_an_autosave_of_a_small_sculpt_has_the_last_stroke():
    packing = common.part("common.packing")
    fast, packing.FAST = packing.FAST, 60.0  # on a busy machine, too
    try:
        autosave_has_the_last_stroke()
    finally:
        packing.FAST = fast


def autosave_has_the_last_stroke():
    name = sculpt()
    for k in range(3):
        work(name).persistence._packing.seconds = 0.0  # independent of other work of this computer
        last = stroke(name, k)
    path = as_autosaved("autosave_small.blend")
    is_shown(name)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert common.content(bpy.data.objects[name]).volume.to_bytes() == last
    assert bpy.data.objects[name].riffler.token == "" == bpy.context.window_manager.riffler.notice
    matches_its_volume(name)
    nothing_is_left()


def test_an_autosave_of_a_large_sculpt_has_the_last_rest_and_reports_it():
    name = sculpt()
    run = work(name)
    run.persistence._packing.nbytes = 1e9
    stroke(name, 1)
    rest = stroke(name, 2)
    run.persistence._packing._stroke -= 100
    while run.persistence.packed != run.token:
        run.rest(run.object)
    run.persistence._packing.nbytes = 1e9
    stroke(name, 3)
    path = as_autosaved("autosave_large.blend")
    bpy.ops.wm.open_mainfile(filepath=path)
    assert common.content(bpy.data.objects[name]).volume.to_bytes() == rest
    assert "as last saved" in bpy.context.window_manager.riffler.notice
    bpy.ops.riffler.dismiss()
    assert bpy.context.window_manager.riffler.notice == ""
    matches_its_volume(name)
    nothing_is_left()


def test_an_autosave_that_was_opened_takes_the_strokes_of_the_journal():
    """Blender dies after the autosave; the autosave is opened, and the session recovered into its sculpt."""
    with fresh() as root:
        name = sculpt()
        run = work(name)
        run.persistence._packing.nbytes = 1e9
        stroke(name, 1)
        path = as_autosaved("autosave_cut_off.blend")
        last = stroke(name, 2)
        folder = run.persistence.journal.folder
        while not run.persistence.journal.settled():
            pass
        kept = root.parent / "kept"
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(folder, kept)  # its state after a crash
        bpy.ops.wm.open_mainfile(filepath=path)
        assert not folder.exists()
        shutil.move(kept, folder)
        keeping().crashed(look=True)
        count = len(bpy.data.objects)
        bpy.ops.riffler.recover("EXEC_DEFAULT", True)
        assert len(bpy.data.objects) == count
        assert common.content(bpy.data.objects[name]).volume.to_bytes() == last
        matches_its_volume(name)


def test_a_sculpt_that_was_changed_since_is_left_unchanged():
    with fresh() as root:
        name = sculpt()
        worked = stroke(name, 1)
        run = work(name)
        while not run.persistence.journal.settled():
            pass
        kept = root.parent / "kept"
        shutil.rmtree(kept, ignore_errors=True)
        folder = shutil.copytree(run.persistence.journal.folder, kept)
        live().end_all()
        common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
        bpy.context.view_layer.objects.active = bpy.data.objects[name]
        bpy.ops.riffler.cut_curve(curve="Line", depth=4, tool=common.FLAT)
        cut = common.content(bpy.data.objects[name]).volume.to_bytes()
        shutil.move(folder, root / "kept")
        assert len(keeping().crashed(look=True)) == 1
        bpy.ops.riffler.recover(journal="kept")
        assert common.content(bpy.data.objects[name]).volume.to_bytes() == cut
        assert bpy.context.object.name != name
        assert common.content(bpy.context.object).volume.to_bytes() == worked


def test_a_folder_that_cannot_be_written_stops_no_hand():
    with fresh():
        pass
    before = keeping().folder
    blocked = Path(common.out("blocked"))
    blocked.write_text("a file where the folder should be")
    try:
        keeping().folder = lambda: blocked
        name = sculpt()
        last = stroke(name, 1)
        run = live().of(bpy.data.objects[name])
        assert run.persistence.journal is None and run.persistence.problem
        assert live().content(bpy.data.objects[name]).volume.to_bytes() == last
        assert keeping().crashed(look=True) == []
        live().end_all()
        matches_its_volume(name)
    finally:
        keeping().folder = before
        blocked.unlink()
        keeping().crashed(look=True)


def test_a_full_disk_ends_the_journal_and_not_the_stroke():
    if not os.path.exists("/dev/full"):
        raise common.Skip("there is no /dev/full")
    with fresh():
        name = sculpt()
        first = stroke(name, 1)
        run = live().of(bpy.data.objects[name])
        begun = run.persistence.journal

        class Full:
            def __getattr__(self, name):
                def write(*args, **more):
                    with open("/dev/full", "wb", buffering=0) as file:
                        file.write(b"x")

                return write

            def close(self):
                pass

        whole, begun._writer = begun._writer, Full()
        second = stroke(name, 2)
        assert "No space left" in begun.problem and "No space left" in run.persistence.problem
        content = begun.state(begun._tokens[-2])
        assert content.volume.to_bytes() == first
        run.persistence._tried -= 100
        stroke(name, 3)  # another journal, now that there is room again
        assert run.persistence.journal is not begun and not run.persistence.problem
        assert run.persistence.journal.state(run.token).volume.to_bytes() == run.volume.to_bytes() != second
        whole.close()


def test_the_next_work_at_the_same_sculpt_needs_no_older_journal():
    with fresh() as root:
        name = sculpt()
        for k in range(3):
            stroke(name, k)
            run = live().of(bpy.data.objects[name])
            while not run.persistence.journal.settled():
                pass
            run.rest(run.object)
            assert len(list(root.iterdir())) == 1
            live().end_all()
            assert len(list(root.iterdir())) == 1, "until the file is saved"
        bpy.ops.wm.save_as_mainfile(filepath=common.out("saved.blend"))
        assert not list(root.iterdir())


@common.core_bound
def test_copies_by_symmetry_and_standing_rows_are_replayed_to_the_byte():
    name = sculpt()
    run = work(name)
    run.maps = common.part("sculpt.pure.symmetry").maps("XY")
    rng = np.random.default_rng(5)
    for mode in ("remove", "add", "mask", "remove", "soften", "unmask", "add"):
        run.begin_stroke()
        at = np.array([15.0, 15, 18, 0, 0, 1])
        for k in range(6):
            rows = [at]
            for _ in range(4):
                step = rng.normal(size=3) * (0 if rng.random() < 0.3 else 1)
                axis = rows[-1][3:] + 0.1 * np.abs(step)
                rows.append(np.r_[rows[-1][:3] + step, axis / np.linalg.norm(axis) if step.any() else axis])
            run.carve(recovering.BALL, np.array(rows), mode=mode, new=k == 0)
            at = rows[-1]
        run.finish_stroke(bpy.context, mode)
    content = run.persistence.journal.state(run.token)
    assert content.volume.to_bytes() == run.volume.to_bytes()
    assert content.mask.to_bytes() == run.mask.to_bytes()
    assert riffler.Journal.load(run.persistence.journal.folder / "strokes.rjournal").stock.snapshot == "stock.rvol"
