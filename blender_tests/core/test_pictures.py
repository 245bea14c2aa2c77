"""Loose comparison of pictures, on pictures made here."""

import importlib.util
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

PLACE = Path(__file__).resolve().parent.parent / "windowed" / "pictures.py"
spec = importlib.util.spec_from_file_location("pictures", PLACE)
pictures = importlib.util.module_from_spec(spec)
spec.loader.exec_module(pictures)

VIEW, PANEL = (0.0, 0.05, 0.8, 1.0), (0.8, 0.0, 1.0, 1.0)
AREAS = [("VIEW_3D", VIEW), ("PROPERTIES", PANEL)]


def window(shift=0, away=0, panel=True, view=True, noise=0.0):
    """A dark window with a bright figure and a panel with lines of text."""
    image = np.full((950, 1400), 0.25)
    if view:
        image[300 + shift + away : 600 + shift + away, 300 + shift : 800 + shift] = 0.7
    if panel:
        for y in range(20, 900, 18):
            image[y + shift : y + shift + 8, 1150 + shift : 1380 : 5] = 0.9
    return np.clip(image + np.random.default_rng(5).normal(0, noise, image.shape), 0, 1)


def complaints(image, vary=()):
    return pictures.judge(pictures.grids(image), pictures.grids(window()), AREAS, vary)


def test_luminance_is_the_mean_of_a_cell_at_any_size():
    image = np.zeros((97, 131))
    image[:, :50] = 1
    expected = [np.mean([x < 50 for x in range(a, b)]) for a, b in
                zip((131 * np.arange(32)) // 32, (131 * np.arange(1, 33)) // 32, strict=True)]  # fmt: skip
    assert np.allclose(pictures.cells(image), np.tile(expected, (20, 1)))


@pytest.mark.parametrize("change", [{}, {"shift": 2}, {"noise": 0.002}])
def test_similar_pictures_pass(change):
    assert complaints(window(**change)) == []


@pytest.mark.parametrize(
    ("change", "kind"), [({"panel": False}, "PROPERTIES"), ({"view": False}, "VIEW_3D"), ({"away": 250}, "VIEW_3D")]
)
def test_missing_or_moved_parts_are_reported_with_their_area(change, kind):
    found = complaints(window(**change))
    assert len(found) == 1 and found[0].startswith(kind)
    assert complaints(window(**change), vary=[kind]) == []
    assert complaints(window(**change), vary=[VIEW, PANEL]) == []


def test_an_empty_picture_fails():
    assert len(complaints(np.zeros((950, 1400)))) == 2


def test_an_area_on_top_is_judged_separately():
    areas = [("VIEW_3D", (0.0, 0.0, 1.0, 1.0)), ("SIDEBAR", PANEL)]
    found, kept = pictures.grids(window(panel=False)), pictures.grids(window())
    assert [c.split(":")[0] for c in pictures.judge(found, kept, areas)] == ["SIDEBAR"]
    assert [c.split(":")[0] for c in pictures.judge(found, kept, areas[:1])] == ["VIEW_3D"]


def test_parts_outside_all_areas_are_not_compared():
    image = window()
    image[:47, :1100] = 1.0  # the bar of menus
    assert complaints(image) == []


def test_a_grid_survives_as_text():
    found = pictures.grids(window(noise=0.05))
    for grid in found.values():
        assert np.abs(pictures.from_text(pictures.to_text(grid)) - grid).max() <= 0.5 / 255


def colours():
    return np.random.default_rng(7).integers(0, 256, (95, 140, 3), dtype=np.uint8)


@pytest.mark.skipif(not shutil.which("convert"), reason="no ImageMagick here")
def test_imagemagick_reads_the_same_pixels_and_luminance(tmp_path):
    pictures.write(tmp_path / "a.png", colours())

    def read(*words):
        command = ["convert", str(tmp_path / "a.png"), *words]
        return np.frombuffer(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout, np.uint8)

    assert np.array_equal(read("-depth", "8", "rgb:-").reshape(colours().shape), colours())
    gray = read("-colorspace", "Gray", "-depth", "8", "gray:-").reshape(95, 140)
    assert np.abs(pictures.gray(colours()) - gray / 255).max() <= 1.001 / 255


def test_a_picture_is_judged_by_the_reference_of_its_name_and_version(tmp_path, monkeypatch):
    monkeypatch.setattr(pictures, "REFERENCES", tmp_path / "references")

    def check(version, **change):
        image = np.repeat(np.rint(window(**change) * 255).astype(np.uint8)[..., None], 3, axis=2)
        return pictures.check(image, tmp_path, "a", version, AREAS)

    assert check("4.3") is None
    monkeypatch.setattr("sys.argv", ["pictures.py", str(tmp_path / "pictures-4.3.json"), "a"])
    pictures.main()
    assert check("4.3") == ""
    assert check("5.2") is None
    assert "PROPERTIES" in check("4.3", panel=False)
