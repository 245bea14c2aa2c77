"""The scripts of examples/: each runs in an empty folder, draws its picture, and prints a figure that an
independent calculation here gives, too."""

import re
import runpy
from pathlib import Path

import numpy as np
import pytest
import riffler

pytest.importorskip("matplotlib", reason="no pictures: matplotlib is not installed")
from matplotlib import image as images

import linuxcnc

FOLDER = Path(__file__).parents[3] / "examples"
EXAMPLES = sorted(path.stem for path in FOLDER.glob("*.py") if path.stem != "picture")


def numbers(pattern, text):
    """The numbers in the pattern's groups."""
    found = re.search(pattern, text)
    assert found, f"{pattern!r} is not in {text!r}"
    return [float(group.replace(",", "")) for group in found.groups()]


def near(value, wanted, share):
    assert value == pytest.approx(wanted, rel=share), (value, wanted)


def brushes(out):
    """The falloff's integral over the disc: 0.3 of its area."""
    near(numbers(r"one dab of clay: ([\d.]+) mm³", out)[0], 0.3 * np.pi * 49, 2e-3)
    made, said = numbers(r"volume ([-+\d.]+) mm³, the brushes report ([-+\d.]+) mm³", out)
    near(made, said, 1e-3)
    assert "open edges 0, clipped False" in out


def carve_and_force(out):
    """A circle's segment of 2 mm in a circle of 4 mm; force = constant × area × feed."""
    area = 16 * np.arccos(0.5) - 2 * np.sqrt(12)
    (section,) = numbers(r"straight groove ([\d.]+) mm²", out)
    near(section, area, 1e-3)
    near(numbers(r"force ([\d.]+) N in the straight", out)[0], 0.05 * area * 10, 2e-3)


def mesh_to_volume_to_stl(out):
    """Pappus's 2 π² R r²; a bore is the ring's height over a disc, summed up on a fine grid."""
    ring = 2 * np.pi**2 * 20 * 8**2
    near(numbers(r"of the ring ([\d.]+) mm³", out)[0], ring, 3e-3)
    x, y = np.meshgrid(*(np.arange(-3, 3, 0.01) + 0.005,) * 2)
    height = 2 * np.sqrt(64 - (np.hypot(x + 20, y) - 20) ** 2)
    bore = height[np.hypot(x, y) < 3].sum() * 1e-4
    left, edges = numbers(r"triangles, ([\d.]+) mm³, (\d+) open edges", out)
    near(left, ring - 6 * bore, 3e-3)
    assert edges == 0 and riffler.Mesh.read("ring.stl").volume == pytest.approx(left, abs=0.1)


def rough_and_finish(out):
    """A spherical cap on a plate. The ball leaves the fillet of its own radius at the cap's foot, and cusps."""
    cap = np.pi * 8**2 * (3 * 18 - 8) / 3
    part, foot, turn = 60 * 44 * 6 + cap, np.sqrt(18**2 - 10**2), np.arccos(10 / 18)
    fillet = 3**2 * (np.tan(turn / 2) - turn / 2) * 2 * np.pi * (foot + 1)
    rough, finished = (numbers(rf"{name}: .* ([\d.]+) mm³ left", out)[0] for name in ("roughing", "finishing"))
    assert 0.8 * fillet < finished - part < 1.2 * fillet + 0.02 * 60 * 44
    assert part + 0.3 * 60 * 44 < rough < part + (0.3 + 3) * 60 * 44 + 3 * cap
    assert 0.2 < numbers(r"widest cut ([\d.]+)", out)[0] <= 0.4


def verify_program(out):
    """The gouge is the slip of 0.4 mm; the rapid sweeps what the two last rows have left of its track."""
    assert "NOT passed" in out
    assert numbers(r"gouge, line 12 \(.*\): ([\d.]+) mm", out)[0] == pytest.approx(0.4, abs=0.005)
    v = np.arange(-5, 5, 0.001) + 0.0005
    cut = np.fmax(np.sqrt(25 - v**2), np.sqrt(np.clip(25 - (v + 4) ** 2, 0, None)))
    near(numbers(r"rapid, line 18 \(.*\): ([\d.]+) mm³", out)[0], 6 * (15 - cut).sum() * 0.001, 0.01)


def pencil_cut(out):
    """A ball of R between walls at right angles: its centre is R √2 above the valley, whose highest point is 4."""
    least, most, highest = numbers(r"contact ([\d.]+) to ([\d.]+) mm; highest centre z ([\d.]+)", out)
    assert least == pytest.approx(3, abs=0.002) == most and highest == pytest.approx(4 + 3 * np.sqrt(2), abs=0.01)
    assert "free of gouges: True" in out and riffler.Program.read("pencil.ngc").poses.shape[1] == 6


def simulated_pen(out):
    """The recording's own stock and its replay differ by what the session says that it removed."""
    steps, removed = numbers(r"(\d+) steps, ([\d.]+) mm³ removed", out)
    stock, left = riffler.Volume.load("pen-stock.rvol"), riffler.Session.replay("pen.rjournal")
    assert removed > 100 and removed == pytest.approx(stock.volume - left.volume, abs=0.06)
    assert steps > 1000 and "the same bytes: True" in out and "state ready" in out
    assert 0 < numbers(r"pressed the tool ([\d.]+) mm into", out)[0] < 1


def own_machine(out):
    """The axis leans by 10 to 30 degrees, which B alone does on this machine."""
    assert "listed as: my mill: head B, table C" in out
    assert numbers(r"B from (\S+) to (\S+) deg", out) == pytest.approx([-30, -10], abs=0.01)
    assert numbers(r"within (\S+) mm", out)[0] < 1e-4


def cluster_run(out):
    """Under a relief whose mean height is known; ridges between the rows leave a little."""
    moves, removed, line = numbers(r"(\d+) moves, ([\d.]+) mm³ removed; rapid in line (\d+)", out)
    x, y = np.meshgrid(np.linspace(0, 80, 801), np.linspace(0, 60, 601))
    near(removed, 80 * 60 * (10 - (7 + 1.5 * np.sin(x / 6) * np.cos(y / 8)).mean()), 0.01)
    assert (moves, line) == (31999, 16101) and "the same on the cluster: True" in out


def decimate_with_tolerance(out):
    found = re.findall(r"tolerance ([\d.]+) mm: (\d+) of (\d+) triangles, moved by ([\d.]+) mm", out)
    rows = np.array(found, float)
    assert len(rows) == 4 and (np.diff(rows[:, 1]) < 0).all() and rows[-1, 1] < rows[-1, 2] / 4
    assert (rows[:, 3] <= rows[:, 0]).all() and (rows[:, 3] > rows[:, 0] / 3).all()


def contact_and_clearance(out):
    """Ball against plane, ball against ball, cylinder against wall: the distances of their centres."""
    for name, tip, nearest in (
        ("far from the ball", None, 4.0),
        ("near it", -17.0, np.hypot(17, 8) - 16),
        ("in it", -12.0, np.hypot(12, 8) - 16),
        ("at the clamp", None, -2.0),
    ):
        part, least, force = numbers(rf"{name}: part (\S+) mm, nearest (\S+) mm \(\w+\), force (\S+) N", out)
        assert least == pytest.approx(nearest, abs=0.01), name
        assert (force > 0) == (nearest < 0) and (tip is None or part == least)


def plan_by_feel(out):
    """The shank of radius 2.5 mm touches the upper edge of the room around the clamp, 7 mm to the side of the ball's
    centre and 24 mm above: 7 cos a - 24 sin a = 2.5. The machine's own interpreter reads the code."""
    assert numbers(r"(\d+) keys", out) == [5]
    touching = np.degrees(np.arccos(2.5 / 25) - np.arctan2(24, 7))
    assert numbers(r"at the clamp the tool ([\d.]+)", out)[0] == pytest.approx(touching, abs=0.5)
    torque, depth = numbers(r"torque up to (\d+) N·mm, the tool at most ([\d.]+) mm deep", out)
    assert 200 < torque <= 301 and depth < 1.2
    assert "verified: True" in out
    if linuxcnc.PROGRAM.exists():
        assert len(linuxcnc.interpreted(Path("by_feel.ngc")).joints) > 50


def engrave_on_a_dome(out):
    """The farthest point of the curves is 29 mm from the axis of a ball of 60 mm."""
    least, most = numbers(r"tips ([\d.]+) to ([\d.]+) mm deep", out)
    assert 0.6 == pytest.approx(least, abs=0.003) == pytest.approx(most, abs=0.003)
    assert numbers(r"leans by up to ([\d.]+) deg", out)[0] == pytest.approx(np.degrees(np.arctan(29 / 60)), abs=0.15)


def journal_and_replay(out):
    """The NC code, which has been through text, leaves the same of another block."""
    assert "the same bytes: True" in out and numbers(r"(\d+) strokes, (\d+) rows", out) == [2, 400]
    program = riffler.Program.read("strokes.ngc", machine="3-axis")
    tools = {1: riffler.Tool.ball(6, 30), 2: riffler.Tool.flat(4, 30)}
    left = riffler.verify(program, riffler.Volume.block((0, 0, 0), (70, 50, 12), 0.25, "xyz"), tools=tools).volume
    assert numbers(r"replayed ([\d.]+) mm³", out)[0] == pytest.approx(left.volume, abs=0.2)


def smooth_and_mask(out):
    """Rows of R 3 mm, 4 mm apart, on rays that are 0.2 mm from a ridge and from a row's middle at the least."""
    before, after, masked = numbers(r"ridges ([\d.]+) mm .*, ([\d.]+) mm after, .* mask ([\d.]+) mm", out)
    assert before == pytest.approx(np.sqrt(9 - 0.2**2) - np.sqrt(9 - 1.8**2), abs=0.001)
    assert after < before / 10 and masked == 0


def scan_with_holes(out):
    """Three holes that planes would close take three caps from the ball."""
    ball, h = 4 / 3 * np.pi * 20**3, 20 * (1 - np.cos([0.30, 0.22, 0.16]))
    caps = (np.pi * h**2 * (60 - h) / 3).sum()
    volume, edges = numbers(r"stock: (\d+) mm³, (\d+) open edges", out)
    assert ball - 2.5 * caps < volume < ball and edges == 0
    assert numbers(r"scan: (\d+) openings", out) == [3]


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_draws_its_picture_and_its_figure_is_right(name, tmp_path, monkeypatch, capsys):
    if name == "cluster_run":
        pytest.importorskip("distributed", reason="no clusters: distributed is not installed")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(FOLDER))
    monkeypatch.setenv("RIFFLER_MACHINES", "")  # so that what the example sets is gone after it
    runpy.run_path(str(FOLDER / f"{name}.py"), run_name="__main__")
    out = capsys.readouterr().out
    assert out.endswith(f"{name}.png written\n")
    pixels = images.imread(f"{name}.png")[..., :3]
    assert min(pixels.shape[:2]) > 250 and len(np.unique((pixels * 15).astype(int) @ (256, 16, 1))) > 20
    globals()[name](out)


def test_every_example_is_short_and_shown_with_its_picture():
    page = (FOLDER / "README.md").read_text()
    assert 12 <= len(EXAMPLES) <= 16
    for name in EXAMPLES:
        text = (FOLDER / f"{name}.py").read_text()
        assert len(text.splitlines()) <= 64 and "\n\nShows: " in text, name
        assert f"]({name}.py)" in page and f"docs/images/examples/{name}.webp)" in page, name
        size = (FOLDER.parent / "docs" / "images" / "examples" / f"{name}.webp").stat().st_size
        assert size <= 60_000, (name, size)
