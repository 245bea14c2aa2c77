"""The demonstration's recording and the generator that makes it."""

import dataclasses
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import riffler

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT))

from demo import egg, font, strokes  # noqa: E402
from demo.surface import Surface, unit  # noqa: E402

BLENDER = ROOT / ".envs" / "bpy-4.5" / "bin" / "python"


@pytest.fixture(scope="module")
def journal():
    return riffler.Journal.load(ROOT / "demo" / "strokes.rjournal")


def test_letters_stand_between_their_lines_and_run_smoothly():
    for letter, (advance, paths) in font.LETTERS.items():
        for path in paths if letter != "R~" else paths[:-1]:
            points = font.curve(path)
            assert points[:, 0].min() >= -0.16 and points[:, 0].max() <= advance + 0.1, letter
            assert points[:, 1].min() >= -0.02 and points[:, 1].max() <= 1.06, letter
        for path in paths:
            steps = unit(np.diff(font.curve(path), axis=0))
            turns = np.arccos(np.clip((steps[1:] * steps[:-1]).sum(axis=1), -1.0, 1.0))
            assert turns.max() < np.radians(20.0), f"{letter}: {path}"


def test_a_path_that_is_not_cubic_is_refused():
    with pytest.raises(ValueError, match="cubic segments"):
        font.curve("M0 0 C1 1 2 2")


def test_rays_leave_the_egg_where_its_equation_says():
    figure = Surface(*egg.build())
    turn = np.linspace(0.0, 2 * np.pi, 60)
    directions = unit(np.stack([np.cos(turn), np.sin(turn), 0.7 * np.sin(3 * turn)], axis=1))
    points, normals = figure.outermost(np.tile(egg.CENTRE, (60, 1)), directions)
    c, s = np.cos(egg.TURN), np.sin(egg.TURN)
    local = (points - egg.CENTRE) @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    half = np.tile(egg.HALF_AXES + egg.SKIN, (60, 1))
    half[local[:, 2] < 0.0, 2] = egg.LOWER
    assert np.abs(np.linalg.norm(local / half, axis=1) - 1.0).max() < 3e-4  # chords of 160 rings
    exact = unit((local / half**2) @ np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]))
    assert (normals * exact).sum(axis=1).min() > np.cos(0.02)


def test_rays_that_miss_give_nan():
    points, normals = Surface(*egg.build(20, 40)).outermost(np.array([[0.0, 200.0, 0.0]]), np.array([[0.0, 1.0, 0.0]]))
    assert np.isnan(points).all() and np.isnan(normals).all()


def test_the_egg_is_closed_and_has_the_volume_of_its_equation():
    mesh = riffler.Mesh(*egg.build())
    audit = mesh.audit()
    assert all(count == 0 for key, count in dataclasses.asdict(audit).items() if key not in ("components", "volume"))
    a, b, c = egg.HALF_AXES + egg.SKIN
    assert mesh.volume == pytest.approx(2 / 3 * np.pi * a * b * (c + egg.LOWER), rel=1e-3)


def test_the_recording_is_what_a_hand_can_do(journal):
    names = [stroke.name for stroke in journal.strokes]
    assert len(set(names)) == len(names)
    letters = dict.fromkeys(name.split()[1].split(".")[0] for name in names if name.startswith("word"))
    assert "".join(letter[1:] for letter in letters) == "RIFFLER"
    clock = 0.0
    for stroke in journal.strokes:
        assert np.isfinite(stroke.poses).all()
        assert np.abs(np.linalg.norm(stroke.poses[:, 3:], axis=1) - 1.0).max() < 1e-6
        assert stroke.times[0] >= clock and (np.diff(stroke.times) > 0.0).all()
        clock = stroke.times[-1]
        seconds = np.diff(stroke.times)
        assert (np.linalg.norm(np.diff(stroke.poses[:, :3], axis=0), axis=1) / seconds).max() < 80.0  # mm/s
        cosines = (stroke.poses[1:, 3:] * stroke.poses[:-1, 3:]).sum(axis=1)
        assert np.arccos(np.clip(cosines, -1.0, 1.0)).max() < np.radians(4.0)


def test_the_recording_names_tools_that_can_be_made(journal):
    made = {number: riffler.Tool.from_dict(tool) for number, tool in journal.tools.items()}
    assert {stroke.tool for stroke in journal.strokes} <= set(made)
    assert {number: tool.diameter for number, tool in made.items()} == {
        number: tool.diameter for number, tool in strokes.tools().items()
    }


@pytest.mark.skipif(not BLENDER.exists(), reason=f"{BLENDER.relative_to(ROOT)} is not there: run `make demo` once")
def test_the_recording_is_what_the_generator_draws(journal, tmp_path):
    figure = tmp_path / "suzanne.stl"
    subprocess.run([BLENDER, ROOT / "demo" / "suzanne.py", figure], check=True, timeout=120, capture_output=True)
    drawn = strokes.record(Surface.read(figure))
    assert [stroke.name for stroke in drawn] == [stroke.name for stroke in journal.strokes]
    for made, kept in zip(drawn, journal.strokes, strict=True):
        assert made.tool == kept.tool
        np.testing.assert_allclose(made.times, kept.times, atol=2e-5, err_msg=made.name)
        np.testing.assert_allclose(made.poses, kept.poses, atol=2e-5, err_msg=made.name)
