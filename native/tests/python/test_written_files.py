"""Everything that writes a file: permissions, links, pipes, threads and killed processes."""

import os
import signal
import stat
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
import riffler
from riffler import files, plan

UP = [0.0, 0.0, 1.0]
BALL = riffler.Tool.ball(6, 40)
MESH = riffler.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
PROGRAM = riffler.Program([[0, 0, 5, *UP], [1, 0, 5, *UP]], 100.0, rapid=[True, False], tools={1: BALL})


def a_plan(count=3):
    centres = np.column_stack([np.arange(float(count)), np.zeros(count), np.full(count, 3.0)])
    contacts = np.stack([centres - [0, 0, 3], centres - [3, 0, 0]], axis=1)
    normals = np.broadcast_to([[UP, [1.0, 0, 0]]], (count, 2, 3))
    path = plan.PencilPath(3, centres, contacts, normals)
    return plan.Plan([path], BALL, part={"name": "part", "sha256": "0" * 64}, tolerance=0.01)


def write_journal(path):
    journal = riffler.Journal()
    journal.add_note("a", "b")
    journal.save(path)


WRITERS = {
    ".stl": lambda path: MESH.write(path),
    ".obj": lambda path: MESH.write(path),
    ".ply": lambda path: MESH.write(path),
    ".3mf": lambda path: MESH.write(path),
    ".rvol": lambda path: riffler.Volume.block([0, 0, 0], [1, 1, 1], 0.5).save(path),
    ".rprog": lambda path: PROGRAM.save(path),
    ".ngc": lambda path: PROGRAM.write(path),
    ".rjournal": write_journal,
    ".json": lambda path: plan.save(path, a_plan()),
}


@pytest.fixture(params=WRITERS)
def writer(request):
    if request.param == ".3mf":
        pytest.importorskip("lib3mf")
    return request.param, WRITERS[request.param]


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


def test_a_file_keeps_its_permissions_and_a_new_one_has_the_usual_ones(writer, tmp_path):
    end, write = writer
    path = tmp_path / f"file{end}"
    before = os.umask(0o027)
    try:
        write(path)
        assert mode(path) == 0o640
    finally:
        os.umask(before)
    path.chmod(0o600)
    write(path)
    assert mode(path) == 0o600 and os.listdir(tmp_path) == [path.name]


def test_a_link_is_followed(writer, tmp_path):
    end, write = writer
    target, link = tmp_path / f"target{end}", tmp_path / f"link{end}"
    target.write_bytes(b"old")
    link.symlink_to(target.name)
    write(link)
    assert link.is_symlink() and target.read_bytes() == link.read_bytes() != b"old"


def test_a_pipe_and_a_device_are_refused_and_stay(writer, tmp_path):
    end, write = writer
    pipe, null = tmp_path / f"pipe{end}", tmp_path / f"null{end}"
    os.mkfifo(pipe)
    null.symlink_to("/dev/null")
    for path in (pipe, null):
        with pytest.raises(RuntimeError, match="pipe or a device"):
            write(path)
    assert stat.S_ISFIFO(pipe.stat().st_mode) and stat.S_ISCHR(os.stat("/dev/null").st_mode)
    assert sorted(os.listdir(tmp_path)) == [null.name, pipe.name]


@pytest.mark.parametrize("read", [riffler.Mesh.read, riffler.Volume.load, riffler.Program.read, riffler.Journal.load])
def test_reading_from_a_pipe_does_not_wait(read, tmp_path):
    end = {"Mesh": ".stl", "Volume": ".rvol"}.get(getattr(read, "__qualname__", "").split(".")[0], ".stl")
    os.mkfifo(tmp_path / f"pipe{end}")
    with pytest.raises(riffler.FormatError, match="pipe or a device"):
        read(tmp_path / f"pipe{end}")


def test_saving_on_any_thread_leaves_the_umask_of_the_process(tmp_path):
    pytest.importorskip("lib3mf")
    before, seen = os.umask(0o077), set()
    try:

        def save(k):
            for _ in range(15):
                MESH.write(tmp_path / f"{k}.3mf")
                MESH.write(tmp_path / f"{k}.stl")

        def others():
            while any(t.is_alive() for t in threads):
                path = tmp_path / "other"
                path.write_bytes(b"")
                seen.add(mode(path))
                path.unlink()

        threads = [threading.Thread(target=save, args=(k,)) for k in range(4)]
        for thread in threads:
            thread.start()
        others()
    finally:
        after = os.umask(before)
    assert (seen, after) == ({0o600}, 0o077)


def test_one_path_saved_by_several_threads_is_always_one_of_their_files(tmp_path):
    path, plans = tmp_path / "plan.json", [a_plan(n) for n in (2, 30, 300)]
    plan.save(path, plans[0])
    errors, lengths = [], set()

    def save(one):
        try:
            for _ in range(60):
                plan.save(path, one)
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=save, args=(one,)) for one in plans]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        lengths.add(len(plan.load(path).paths[0]))
    assert not errors and lengths <= {2, 30, 300}
    assert os.listdir(tmp_path) == ["plan.json"]


def test_a_link_that_waits_for_a_draft_is_not_followed(tmp_path):
    victim = tmp_path / "victim"
    victim.write_bytes(b"mine")
    for name in (f".plan.{os.getpid()}.json", ".plan.json.riffler-"):
        (tmp_path / name).symlink_to("victim")
    plan.save(tmp_path / "plan.json", a_plan())
    assert victim.read_bytes() == b"mine"


def test_the_files_of_a_killed_process_are_removed_by_the_next_save(tmp_path):
    script = f"""
        import riffler
        volume = riffler.Volume.block([0, 0, 0], [40, 40, 20], 0.5)
        mesh = volume.to_mesh()
        print("begins", flush=True)
        while True:
            mesh.write({str(tmp_path / "a.stl")!r})
            volume.save({str(tmp_path / "a.rvol")!r})
    """
    for delay in (0.02, 0.11, 0.23):
        process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE)
        process.stdout.readline()
        time.sleep(delay)
        process.send_signal(signal.SIGKILL)
        process.wait()
        process.stdout.close()
    left = {name for name in os.listdir(tmp_path) if name not in ("a.stl", "a.rvol")}
    assert len(left) <= 3  # between the naming of a draft and its rename there are microseconds
    for path in tmp_path.glob("a.*"):
        (riffler.Mesh.read if path.suffix == ".stl" else riffler.Volume.load)(path)


def test_draft_folders_are_removed_after_an_error_and_by_the_next_draft(tmp_path):
    path = tmp_path / "table.csv"
    with pytest.raises(ZeroDivisionError), files.drafting(path) as draft:
        draft.write_text("half")
        raise ZeroDivisionError
    assert os.listdir(tmp_path) == []
    (tmp_path / ".table.csv.riffler-left").mkdir()
    with files.drafting(path) as draft:
        draft.write_text("whole")
    assert os.listdir(tmp_path) == ["table.csv"] and path.read_text() == "whole"
    with pytest.raises(RuntimeError, match="cannot be written"), files.drafting(tmp_path / "none" / "a"):
        pass


def test_a_stream_writes_the_whole_file_or_none(tmp_path):
    path = tmp_path / "a"
    with pytest.raises(ZeroDivisionError), files.writing(path) as stream:
        stream.write(b"half")
        raise ZeroDivisionError
    assert os.listdir(tmp_path) == []
    files.write(path, b"whole")
    assert files.read(path) == b"whole"
