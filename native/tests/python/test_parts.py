"""Imperfect parts: triangles that disagree, thin walls, borders that are not a whole number of pitches."""

import warnings

import numpy as np
import pytest
import riffler
from commands import riffle

TRIANGLES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4)]
TRIANGLES += [(2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def box(lower, upper, turned=()):
    corners = np.array([lower, upper], float)
    vertices = [[corners[k >> a & 1][a] for a in range(3)] for k in range(8)]
    triangles = np.array(TRIANGLES)
    triangles[list(turned)] = triangles[list(turned)][:, ::-1]
    return riffler.Mesh(vertices, triangles)


def joined(a, b):
    triangles = np.vstack([a.triangles, np.asarray(b.triangles) + len(a.vertices)])
    return riffler.Mesh(np.vstack([a.vertices, b.vertices]), triangles)


HALF = (0, 2, 4, 6, 8, 10)
CUBE = box((0, 0, 0), (10, 10, 10))
BALL = riffler.Tool.ball(4, 20)


def test_turned_triangles_are_turned_back():
    bad = box((0, 0, 0), (10, 10, 10), HALF)
    mesh, report = bad.orient_with_report()
    assert mesh.volume == bad.orient().volume == pytest.approx(1000)
    assert report == riffler.Orientation(turned=6, turned_shells=0, left_out=0, one_sided=0)
    assert CUBE.orient() is CUBE
    volume, found = riffler.Volume.from_mesh_with_report(bad, 0.5, "xyz")
    assert volume.volume == pytest.approx(1000)
    assert found.turned == 6 and found.lost == 0 and found.lost_note == ""


def test_a_turned_part_gives_the_same_results_as_the_right_one():
    bad = box((0, 0, 0), (10, 10, 10), HALF)
    assert len(riffler.plan.pencil(bad, BALL)) == 0
    assert np.allclose(CUBE.deviation(box((2, 2, 2), (8, 8, 8), HALF), signed=True) > 0, True)
    assert np.allclose(box((2, 2, 2), (8, 8, 8)).deviation(bad, signed=True), -2)
    poses = np.array([[5, 5, 5, 0, 0, 1.0], [5, 5, 9, 0, 0, 1], [20, 5, 5, 0, 0, 1]])
    assert np.allclose(riffler.Collider(bad).clearance(BALL, poses), riffler.Collider(CUBE).clearance(BALL, poses))
    program = riffler.Program.from_cl([np.array([[-5, 5, 6, 0, 0, 1], [15, 5, 6, 0, 0, 1.0]])], tools=[BALL], feed=600)
    stock = riffler.Volume.block((0, 0, 0), (10, 10, 10), 0.5)

    def found(part):
        return [(f.kind, f.value) for f in riffler.verify(program, stock.copy(), part).findings]

    assert found(bad) == found(CUBE) and any(kind == "gouge" for kind, _ in found(bad))
    said = riffler.plan.analyse(bad)
    assert said.turned == 6 and said.closed and "6 triangles faced opposite to those around" in said.warnings[0]


@pytest.mark.parametrize("pitch", [1, 0.37, 3.7, 9.9, 0.5])
@pytest.mark.parametrize("size", [(10.4, 10.49, 10.51), (0.4, 10, 10), (10.5, 7.5, 3.5), (10, 10, 10)])
def test_boxes_are_exact_at_any_pitch(size, pitch):
    lower = np.array([0.1, -3, 7])
    upper = lower + size
    exact = pytest.approx(np.prod(upper - lower), rel=1e-9)
    for directions in ("x", "y", "z", "xyz"):
        assert riffler.Volume.block(lower, upper, pitch, directions).volume == exact
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of what a mesh would lack
            assert riffler.Volume.from_mesh(box(lower, upper), pitch, directions).volume == exact


def test_removed_equals_the_loss_of_volume():
    for directions in ("x", "y", "z", "xyz"):
        v = riffler.Volume.block((0, 0, 0), (10.4, 10.49, 10.51), 1, directions)
        steps = [[-2, 1, 9.3], [12, 9, 8.1], [9.9, 10.2, 9], [10.2, 10.4, 3], [5, 5, 11], [10.4, 5, 10]]
        poses = np.hstack([steps, np.tile([0, 0, 1.0], (6, 1))])
        poses[3, 3:] = 0.6, 0, 0.8
        before = v.volume
        cut = v.carve(BALL, poses, dt=0.1)
        assert cut.removed.sum() == pytest.approx(before - v.volume, rel=1e-12)
        assert (cut.removed[:2] > 0).all() and np.isfinite(cut.force).all()


def test_force_follows_the_removed_volume():
    # A face mill over all of a block: the force is that of the volume taken.
    mill = riffler.Tool.flat(60, 20)
    poses = np.array([[5, 5, 10, 0, 0, 1.0], [5, 5, 9, 0, 0, 1]])
    v = riffler.Volume.block((0, 0, 0), (10.4, 10.49, 10), 1)
    cut = v.carve(mill, poses, dt=0.5)
    assert cut.removed[0] == pytest.approx(10.4 * 10.49)
    assert cut.force[0] == pytest.approx([0, 0, 0.05 * 10.4 * 10.49 / 0.5])
    assert cut.torque[0, :2] == pytest.approx([cut.force[0, 2] * 0.245, -cut.force[0, 2] * 0.2], abs=0.6)


def test_lost_thin_material_is_reported():
    plate = box((0, 0, 0), (50, 50, 0.3))
    tray = riffler.Volume.block((0, 0, 0), (50, 50, 10), 1, "xyz")
    mill = riffler.Tool.flat(200, 20)
    tray.carve(mill, np.array([[25, 25, 12, 0, 0, 1.0], [25, 25, 0.3, 0, 0, 1]]))
    assert tray.volume == pytest.approx(750)
    mesh, report = tray.to_mesh_with_report()
    assert len(mesh.triangles) == 0
    assert report.lost == pytest.approx(750) and report.lost_pitch == pytest.approx(0.29)
    assert np.allclose(report.lost_box, [[0, 0, 0], [50, 50, 0.3]])
    with pytest.warns(UserWarning, match="nothing of the 750 mm³"):
        tray.to_mesh()
    # The pitch that is named keeps it.
    fine = riffler.Volume.from_mesh(plate, report.lost_pitch, "xyz")
    assert fine.to_mesh().volume == pytest.approx(750, rel=0.01)
    # Part of a body: a fin of 0.2 mm on a block.
    body = joined(box((0, 0, 0), (20, 20, 5)), box((9.7, 0, 5), (9.9, 20, 15)))
    _, found = riffler.Volume.from_mesh_with_report(body, 1, "xyz")
    assert found.lost == pytest.approx(40, rel=0.1) and "a pitch of 0.19 mm keeps it" in found.lost_note
    with pytest.warns(UserWarning, match="thinner than the pitch of 1 mm"):
        riffler.Volume.from_mesh(body, 1, "xyz")
    # A wire between all rays.
    wire = joined(box((0, 0, 0), (1, 1, 1)), box((3.1, 3.1, 0), (3.3, 3.3, 300)))
    with pytest.warns(UserWarning, match=r"the rays miss 12 mm³"):
        riffler.Volume.from_mesh(wire, 1)


def test_round_and_thick_parts_get_no_note():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        a = np.linspace(0, np.pi, 40)
        rings = np.array([[np.sin(p) * np.cos(q), np.sin(p) * np.sin(q), np.cos(p)] for p in a for q in 2 * a[:-1]])
        quads = [(i, j, i + 1, (j + 1) % 39) for i in range(39) for j in range(39)]
        triangles = [
            t
            for i, j, k, m in quads
            for t in ((i * 39 + j, k * 39 + j, i * 39 + m), (i * 39 + m, k * 39 + j, k * 39 + m))
        ]
        ball = riffler.Mesh(10 * rings + 0.123, triangles)
        for pitch in (2, 1, 0.4):
            for directions in ("z", "xyz"):
                v = riffler.Volume.from_mesh(ball, pitch, directions)
                v.carve(BALL, np.array([[-20, 0, 5, 0, 0, 1.0], [20, 3, 5, 0, 0.6, 0.8]]))
                v.to_mesh()
        riffler.Volume.from_mesh(joined(CUBE, box((1, 1, 1), (11, 11, 11))), 0.5).to_mesh()
        riffler.Volume.block((0, 0, 0), (10, 10, 10), 0.5, "xyz").to_mesh()


def write_parts(folder):
    joined(box((0, 0, 0), (20, 20, 5)), box((9.7, 0, 5), (9.9, 20, 15))).write(folder / "fin.stl")
    box((0, 0, 0), (20, 20, 10), HALF).write(folder / "turned.stl")
    (folder / "p.ngc").write_text("G21 G90 G94 F600\nG0 X-30 Y10 Z9\nG1 X50\nM2\n")
    (folder / "down.ngc").write_text("G21 G90 G94 F600\nG0 X25 Y25 Z20\nG1 Z0.3\nM2\n")


CARVE = ("--pitch", 1, "--tool", "ball:4:30", "--program", "p.ngc", "--out", "out.stl")


def test_commands_report_lost_material(tmp_path):
    write_parts(tmp_path)
    tray = ("--stock", "50x50x10", "--pitch", 1, "--tool", "flat:200:30", "--program", "down.ngc", "--out")
    done = riffle("volume", "carve", *tray, "out.stl", cwd=tmp_path)
    assert done.returncode == 2 and "nothing of the 750 mm³" in done.stderr and "0.29 mm keeps it" in done.stderr
    assert not (tmp_path / "out.stl").exists()
    done = riffle("volume", "carve", *tray, "out.rvol", cwd=tmp_path)
    assert done.returncode == 0
    done = riffle("volume", "to-mesh", "out.rvol", "--out", "out.stl", cwd=tmp_path)
    assert done.returncode == 2 and not (tmp_path / "out.stl").exists()
    done = riffle("volume", "from-mesh", "fin.stl", "--pitch", 1, "--out", "fin.rvol", cwd=tmp_path)
    assert done.returncode == 0 and "thinner than the pitch of 1 mm" in done.stderr
    done = riffle("volume", "carve", "--stock", "fin.stl", *CARVE, cwd=tmp_path)
    assert done.returncode == 0 and "a pitch of 0.19 mm keeps it" in done.stderr


def test_commands_report_turned_triangles(tmp_path):
    write_parts(tmp_path)
    done = riffle("volume", "carve", "--stock", "turned.stl", *CARVE, cwd=tmp_path)
    assert done.returncode == 0 and "turned.stl: 6 triangles faced opposite to those around" in done.stderr
    done = riffle(
        "nc", "verify", "p.ngc", "--stock", "20x20x10", "--pitch", 1, "--tool", "ball:4:30",
        "--part", "turned.stl", "--fixture", "turned.stl", cwd=tmp_path,
    )  # fmt: skip
    assert done.stderr.count("turned.stl: 6 triangles faced opposite to those around") == 2
    done = riffle("plan", "pencil", "turned.stl", "--tool", "ball:4", "--out", "plan.json", cwd=tmp_path)
    assert done.returncode == 0 and "6 triangles" in done.stderr and " 0: " in done.stdout


def test_a_stock_without_any_material_left_is_reported(tmp_path):
    (tmp_path / "p.ngc").write_text("G21 G90 G94 F600\nG0 X-300 Y10 Z-1\nG1 X300\nM2\n")
    done = riffle(
        "volume", "carve", "--stock", "20x20x10", "--pitch", 1, "--tool", "flat:100:30", "--program", "p.ngc",
        "--out", "out.stl", cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0 and "no material is left" in done.stderr
