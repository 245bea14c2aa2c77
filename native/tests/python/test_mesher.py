"""riffler.Mesher: the mesh that follows a volume, as patches and as a whole."""

import numpy as np
import pytest
import riffler

UP = [0.0, 0, 1]


def carved():
    return riffler.Volume.block([0, 0, 0], [30, 24, 12], 0.25, "xyz")


def stroke(volume, x, y):
    volume.carve(riffler.Tool.ball(3, 20), np.array([[x, y, 11, *UP], [x + 1.5, y, 10.8, *UP]]))


def test_follows_a_stroke_and_takes_it_back():
    volume = carved()
    mesher = riffler.Mesher(volume)
    before = volume.snapshot()
    assert mesher.triangles == len(volume.to_mesh().triangles)
    stroke(volume, 8, 7)
    changed = mesher.update(volume)
    assert 0 < len(changed) < len(mesher.patches()) / 2
    whole = volume.to_mesh()
    assert np.array_equal(mesher.mesh().vertices, whole.vertices)
    assert np.array_equal(mesher.mesh().triangles, whole.triangles)
    volume.restore(before)
    assert set(mesher.update(volume)) <= set(changed)
    assert np.array_equal(mesher.mesh().vertices, volume.to_mesh().vertices)
    assert mesher.update(volume) == []


def test_patches_are_the_mesh():
    volume = carved()
    mesher = riffler.Mesher(volume)
    patches = {n: mesher.patch(n) for n in mesher.patches()}
    for x in (5, 9, 20):
        stroke(volume, x, 12)
        for n in mesher.update(volume):
            patches[n] = mesher.patch(n)
    corners = np.concatenate([v[t].reshape(-1, 9) for v, t in patches.values() if len(t)])
    whole = volume.to_mesh()
    expected = whole.vertices[whole.triangles].reshape(-1, 9).astype(np.float32)
    assert corners.dtype == np.float32
    assert np.array_equal(corners[np.lexsort(corners.T)], expected[np.lexsort(expected.T)])


def test_wrong_calls():
    mesher = riffler.Mesher(carved())
    with pytest.raises(ValueError, match="box, pitch and directions"):
        mesher.update(riffler.Volume.block([0, 0, 0], [30, 24, 12], 0.5, "xyz"))
    with pytest.raises(IndexError, match="no brick 1000000"):
        mesher.patch(1_000_000)
    with pytest.raises(riffler.Cancelled):
        riffler.Mesher(carved(), progress=lambda share: False)
