"""Exact surfaces: borders from arrays, STEP files against closed forms and OpenCASCADE's own distances, and contact."""

import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import riffler
from cad_reader import shared_import
from commands import riffle

needs_occ = pytest.mark.skipif(find_spec("OCP") is None, reason="the package cadquery-ocp-novtk is not installed")


@pytest.fixture(scope="module", autouse=True)
def one_import():
    """Readers are forked from one process that has imported OpenCASCADE. What a reader does to its caller is tested in
    test_cad.py."""
    if find_spec("OCP") is None:
        yield
        return
    with shared_import(riffler.cad.process):
        yield


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("exact")
    program = Path(__file__).with_name("cad_files.py")
    done = subprocess.run([sys.executable, str(program), str(folder)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    return folder


def plate(trims=None, **more) -> riffler.Surface:
    square = [[[0, 0, 0], [0, 20, 0]], [[20, 0, 0], [20, 20, 0]]]
    return riffler.Surface.nurbs(square, np.ones((2, 2)), [0, 0, 1, 1], [0, 0, 1, 1], 1, 1, trims=trims, **more)


def circle(radius: float, points: int) -> np.ndarray:
    a = 2 * np.pi * np.arange(points) / points
    return 0.5 + radius * np.column_stack([np.cos(a), np.sin(a)])


def test_borders_are_inside_closest_and_mesh():
    surface = plate([circle(0.4, 400), circle(0.2, 300)], name="ring")
    assert surface.names == ["ring"] and riffler.Surface([surface, plate()]).names == ["ring", ""]
    assert surface.inside([[0.5, 0.5], [0.8, 0.5], [0.95, 0.5]]).tolist() == [False, True, False]
    _, _, distance = surface.closest([[10, 10, 0], [10, 10, 3], [17, 10, 2], [20, 10, 0]])
    assert distance == pytest.approx([4, 5, 2, 2], abs=2e-3)
    area = surface.to_mesh(0.01).area
    assert area == pytest.approx(400 * np.pi * (0.16 - 0.04), rel=2e-4)


@pytest.mark.parametrize(
    ("trims", "words"),
    [
        ([[[0, 0], [1, 1]]], "trims, loop 0 has 2 points"),
        ([[[0, 0], [1, 0], [2, 1]]], "trims, loop 0, row 2: .* is not in the domain"),
        ([[[0, 0, 0], [1, 0, 0], [1, 1, 0]]], "trims, loop 0 must be"),
        ([[[0, 0], [0.5, 0.5], [1, 1]]], "nothing is inside"),
        (7, "trims must be a list"),
    ],
)
def test_wrong_borders_are_named(trims, words):
    with pytest.raises(ValueError, match=words):
        plate(trims)


def test_a_collider_has_the_exact_depth_and_refuses_others():
    collider = riffler.Collider(plate([circle(0.4, 2000)]), stiffness=2.0)
    tool = riffler.Tool.ball(6, 30)
    contact = collider.query(tool, [10.1, 10.2, -0.25, 0, 0, 1])
    assert contact.depth == pytest.approx(0.25, abs=1e-6)
    assert contact.missed_depth_bound <= 1e-6
    c = 2.75
    force = 2 * np.pi * (3 * (9 - c * c) - 2 / 3 * (27 - c**3))
    assert contact.force == pytest.approx([0, 0, force], rel=2e-3, abs=2e-3 * force)
    assert collider.clearance(tool, [[10, 10, 1, 0, 0, 1], [21, 10, 0, 0, 0, 1]]) == pytest.approx(
        [1, np.hypot(3, 3) - 3], abs=1e-5
    )
    with pytest.raises(TypeError, match="part must be a Mesh or Surface; got int 3"):
        riffler.Collider(3)


@needs_occ
def test_plans_of_a_file_are_on_its_exact_faces(files, tmp_path):
    part = riffler.cad.read(files / "sphere.step", tolerance=0.05, exact=True)
    assert part.surface is not None and riffler.cad.read(files / "sphere.step").surface is None
    lower, upper = part.mesh.bounds
    setup = riffler.plan.Setup(part, riffler.Volume.block(lower, upper + np.array([0, 0, 1]), 0.5))
    assert 0.005 < setup.deviation < 0.06
    region = [[(-3, -1, 0), (3, -1, 0), (3, 1, 0), (-3, 1, 0)]]
    op = riffler.plan.finish(setup, riffler.Tool.ball(4, 30), cusp=0.05, tolerance=0.003, region=region, lead=0)
    off = np.linalg.norm(op.poses[op.kind == 2, :3] + [0, 0, 2], axis=1) - 9
    assert abs(off).max() < 1e-5 and op.report.exact.before > 0.003
    command = ["plan", "finish"]
    more = ["--tool", "ball:4", "--cusp", "0.3", "--slopes", "0,30", "--exact", "--out", str(tmp_path / "a.ngc")]
    done = riffle(*command, files / "sphere.step", *more, cwd=tmp_path)
    assert done.returncode == 0 and "on exact faces" in done.stdout + done.stderr, done.stderr
    part.mesh.write(tmp_path / "a.stl")
    done = riffle(*command, tmp_path / "a.stl", *more, cwd=tmp_path)
    assert done.returncode != 0 and "--exact: a.stl has triangles only" in done.stderr


@needs_occ
def test_pencil_paths_of_the_command_line_touch_the_exact_faces(files, tmp_path):
    """Around a boss of radius 8 mm on the plane z = 0: the centre of a ball of radius 2 is at radius 10 and z = 2."""
    command = ["plan", "pencil", files / "boss.step", "--tool", "ball:4"]
    off = {}
    for name, more in (("plain", []), ("exact", ["--exact"])):
        out = tmp_path / f"{name}.json"
        done = riffle(*command, *more, "--out", out, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        (path,) = riffler.plan.load(out).paths
        off[name] = max(abs(np.hypot(*path.centres[:, :2].T) - 10).max(), abs(path.centres[:, 2] - 2).max())
        assert ("on exact faces" in done.stdout + done.stderr) == bool(more)
    assert off["plain"] > 1e-4 and off["exact"] < 1e-6, off
    (tmp_path / "a.stl").write_bytes(b"solid a\nendsolid a\n")
    done = riffle(*command[:2], tmp_path / "a.stl", *command[3:], "--exact", "--out", tmp_path / "b.json", cwd=tmp_path)
    assert done.returncode != 0 and "--exact: a.stl has triangles only" in done.stderr


@needs_occ
@pytest.mark.parametrize(
    ("name", "distance"),
    [
        ("sphere.step", lambda p: np.linalg.norm(p, axis=1) - 7),
        ("torus.step", lambda p: np.hypot(np.hypot(p[:, 0], p[:, 1]) - 20, p[:, 2]) - 8),
        ("box.step", None),
        ("inch.stp", None),
    ],
)
def test_step_files_are_exact(files, name, distance):
    surface = riffler.Surface.read(files / name)
    points = np.random.default_rng(1).uniform(-12, 32, (60, 3))
    if distance is None:
        d = np.maximum(np.maximum(-points, points - [30, 20, 10]), 0)
        inside = np.minimum(points, [30, 20, 10] - points).min(axis=1)
        expected = np.where(inside > 0, inside, np.linalg.norm(d, axis=1))
    else:
        expected = abs(distance(points))
    feet, normals, found = surface.closest(points)
    assert found == pytest.approx(expected, abs=1e-8)
    if distance is not None:  # normals point out of the solid
        sign = np.sign(np.einsum("ij,ij->i", points - feet, normals))
        assert (sign == np.sign(distance(points)))[expected > 1e-3].all()


def test_a_session_stops_at_an_exact_surface():
    """The hand goes 2 mm below a plate with a round border, then beyond the border, where nothing is."""
    part, stock = riffler.Collider(plate([circle(0.3, 400)])), riffler.Volume.block((0, 0, -30), (20, 20, -20), 1.0)
    options = {"obstacles": part, "at": (10, 10, 3, 0, 0, 1), "dead_man_mask": 0}
    with (
        riffler.pen.open("simulated") as pen,
        riffler.Session(stock, riffler.Tool.ball(4, 20), pen, **options) as session,
    ):
        end = time.monotonic() + 60
        while not pen.state().homed:
            assert time.monotonic() < end
            time.sleep(0.02)
        home = np.array(pen.state().pose)

        def led(*way):
            """Height of the tip and size of the force, mean of a tenth of a second, once the tool rests."""
            pen.aim(home + np.array([*way, 0, 0, 0]))
            heights, forces = [], []
            while len(heights) < 100 or np.ptp(heights[-5:]) > 0.01 or len(forces) < 5:
                assert time.monotonic() < end
                time.sleep(0.02)
                frame = session.frame()
                if len(frame) and frame.tool is not None:
                    heights.append(frame.tool[2])
                    forces.append(np.linalg.norm(frame.force))
            return np.mean(heights[-5:]), np.mean(forces[-5:])

        height, force = led(0, 0, -5)
        assert -1 < height < 0 and force > 0.2
        height, force = led(9, 0, -5)
        assert height < -1.5 and force < 0.2


@needs_occ
def test_trimmed_faces_have_opencascades_distances(files):
    surface = riffler.Surface.read(files / "milled.step", tolerance=1e-4)
    rows = np.load(files / "milled.npy")
    _, _, found = surface.closest(rows[:, :3])
    assert found == pytest.approx(rows[:, 3], abs=2e-4)
    part = riffler.cad.read(files / "milled.step", tolerance=0.002)
    exact, flat = riffler.Collider(surface), riffler.Collider(part.mesh)
    tool = riffler.Tool.ball(3, 20)
    way = np.random.default_rng(2).normal(size=(40, 3))
    poses = np.column_stack([rows[:40, :3], way / np.linalg.norm(way, axis=1)[:, None]])
    assert exact.clearance(tool, poses) == pytest.approx(flat.clearance(tool, poses), abs=3e-3)


@needs_occ
def test_triangles_and_exact_faces_are_read_in_one_process(files, monkeypatch):
    calls, run = [], riffler.cad.process.run
    monkeypatch.setattr(riffler.cad.process, "run", lambda *arguments: calls.append(arguments) or run(*arguments))
    part = riffler.cad.read(files / "assembly.step", tolerance=0.05, exact=True)
    assert len(calls) == 1 and "convert" in part.report.seconds
    plain, surface = (
        riffler.cad.read(files / "assembly.step", tolerance=0.05),
        riffler.Surface.read(files / "assembly.step"),
    )
    assert plain.mesh.vertices.tobytes() == part.mesh.vertices.tobytes()
    assert plain.mesh.triangles.tobytes() == part.mesh.triangles.tobytes()
    assert part.surface.names == surface.names == [face.name for face in part.faces]
    points = np.add(part.mesh.vertices[::7], (0.3, -0.2, 0.1))
    assert part.surface.closest(points)[2].tobytes() == surface.closest(points)[2].tobytes()


@needs_occ
def test_names_and_places_of_the_file_are_kept(files):
    surface, part = riffler.Surface.read(files / "assembly.step"), riffler.cad.read(files / "assembly.step")
    assert surface.names == [face.name for face in part.faces]
    _, _, distance = surface.closest(part.mesh.vertices)
    assert distance.max() < 1e-3


@needs_occ
def test_a_missing_file_is_named():
    with pytest.raises(riffler.FormatError, match=r"gone.step"):
        riffler.Surface.read("gone.step")
    with pytest.raises(ValueError, match=r"part.stl: a name that ends with"):
        riffler.Surface.read("part.stl")
