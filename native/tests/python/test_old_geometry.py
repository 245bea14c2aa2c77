"""Old forms of meshes, volumes, tools, meshers and colliders: each warns once, and does what today's form does."""

import warnings

import numpy as np
import pytest
import riffler
from riffler import old

BALL = riffler.Tool.ball(6, 30).with_shank([(30, 3, 60, 3)])
POSES = np.array([[2.0, 10, 8, 0, 0, 1], [18.0, 10, 7, 0, 0, 1]])
MESH = riffler.Volume.sphere((0, 0, 0), 5, 0.5, "xyz").to_mesh()
LOW, HIGH = (0, 0, 0), (20, 20, 10)


def block(directions="xyz"):
    return riffler.Volume.block(LOW, HIGH, 0.5, directions)


def carved():
    volume = block()
    volume.carve(BALL, POSES)
    return volume


def both(old_form, new_form):
    return old_form, new_form


# Callable of the tables: the call in the old form, and in today's.
FORMS = {
    "Mesh.write": both(lambda: MESH.write("old.stl", None), lambda: MESH.write("new.stl")),
    "Mesh.decimate": both(lambda: MESH.decimate(100, 0.5), lambda: MESH.decimate(triangles=100, tolerance=0.5)),
    "Mesh.smooth": both(lambda: MESH.smooth(3, 0.1), lambda: MESH.smooth(iterations=3, tolerance=0.1)),
    "Mesh.orient": both(lambda: MESH.orient(None), lambda: MESH.orient()),
    "Tool.with_margins": both(lambda: BALL.with_margins(0.5, 0), lambda: BALL.with_margins(shank=0.5)),
    "Tool.outline": both(lambda: BALL.outline(0.1), lambda: BALL.outline(tolerance=0.1)),
    "Volume.from_mesh": both(
        lambda: riffler.Volume.from_mesh(MESH, 0.5, "z", (-5, -5, 0), (5, 5, 5), None),
        lambda: riffler.Volume.from_mesh(MESH, 0.5, "z", lower=(-5, -5, 0), upper=(5, 5, 5)),
    ),
    "Volume.to_mesh": both(lambda: carved().to_mesh(None), lambda: carved().to_mesh()),
    "Volume.sphere": both(
        lambda: riffler.Volume.sphere((0, 0, 0), 5, 0.5, "z", (0, 0, 0)),
        lambda: riffler.Volume.sphere((0, 0, 0), 5, 0.5, "z", lower=(0, 0, 0)),
    ),
    "Volume.cylinder": both(
        lambda: riffler.Volume.cylinder((0, 0, 0), 2, 9, 0.5, "z", (1, 0, 0)),
        lambda: riffler.Volume.cylinder((0, 0, 0), 2, 9, 0.5, "z", axis=(1, 0, 0)),
    ),
    "Volume.carve": both(
        lambda: block().carve(BALL, POSES, 0.01, 0.1, 0.05, None, "remove").force,
        lambda: block().carve(BALL, POSES, dt=0.1).force,
    ),
    "Volume.subtract": both(lambda: block().subtract(carved(), None), lambda: block() - carved()),
    "Volume.add": both(lambda: carved().add(block(), None), lambda: carved() | block()),
    "Volume.intersect": both(lambda: block().intersect(carved(), None), lambda: block() & carved()),
    "Volume.save": both(lambda: block().save("old.rvol", None), lambda: block().save("new.rvol")),
    "Volume.load": both(
        lambda: (block().save("a.rvol"), riffler.Volume.load("a.rvol", None))[1],
        lambda: (block().save("a.rvol"), riffler.Volume.load("a.rvol"))[1],
    ),
    "Volume.to_bytes": both(lambda: block().to_bytes(None), lambda: block().to_bytes()),
    "Volume.from_bytes": both(
        lambda: riffler.Volume.from_bytes(block().to_bytes(), "x"),
        lambda: riffler.Volume.from_bytes(block().to_bytes(), name="x"),
    ),
    "Volume.grow": both(lambda: block().grow(LOW, (25, 20, 10), None), lambda: block().grow(LOW, (25, 20, 10))),
    "Volume.clip": both(
        lambda: block().clip((0, 0, 5), (0, 0, 1), None), lambda: block().clip((0, 0, 5), (0, 0, 1))
    ),
    "Volume.parts": both(lambda: carved().parts(1.0), lambda: carved().parts(minimum=1.0)),
    "Volume.resample": both(
        lambda: carved().resample(1.0, "z", LOW, (10, 20, 10)),
        lambda: carved().resample(1.0, "z", lower=LOW, upper=(10, 20, 10)),
    ),
    "Volume.smooth": both(
        lambda: carved().smooth((10, 10, 7), 4, 0.8, None).removed,
        lambda: carved().smooth((10, 10, 7), 4, strength=0.8).removed,
    ),
    "Mesher.__init__": both(lambda: riffler.Mesher(carved(), None).mesh(), lambda: riffler.Mesher(carved()).mesh()),
    "Mesher.patch": both(
        lambda: riffler.Mesher(carved()).patch(0, True).edges,
        lambda: riffler.Mesher(carved()).patch(0, edges=True).edges,
    ),
    "Collider.query": both(
        lambda: riffler.Collider(MESH).query(BALL, [0, 0, 4, 0, 0, 1], None).depth,
        lambda: riffler.Collider(MESH).query(BALL, [0, 0, 4, 0, 0, 1]).depth,
    ),
    "shape.slab": both(
        lambda: riffler.shape.slab(*sheets(), np.ones((2, 3), bool)), lambda: riffler.shape.slab(*sheets())
    ),
}  # fmt: skip


def sheets():
    x, y = np.meshgrid(np.arange(3.0), np.arange(4.0), indexing="ij")
    plane = np.stack([x, y, 0 * x], axis=2)
    return plane + np.array([0, 0, 1]), plane


def bits(thing):
    if isinstance(thing, riffler.Mesh):
        return thing.vertices.tobytes(), thing.triangles.tobytes()
    if isinstance(thing, riffler.Volume):
        return thing.to_bytes()
    if isinstance(thing, np.ndarray):
        return thing.tobytes()
    return [bits(one) for one in thing] if isinstance(thing, list | tuple) else thing


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    riffler.deprecated.forget()
    yield
    riffler.deprecated.forget()


def test_every_call_with_an_old_form_is_tested():
    assert set(FORMS) == set(old.geometry.OLD.positional)


@pytest.mark.parametrize("name", FORMS)
def test_old_positional_arguments_warn_and_give_the_same(name):
    before, now = FORMS[name]
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        expected = bits(now())
    shown = name.removesuffix(".__init__").replace(".", r"\.")
    with pytest.warns(DeprecationWarning, match=rf"riffler: {shown}: .* by position is deprecated, use \w+=…"):
        assert bits(before()) == expected
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        assert bits(before()) == expected  # once


def test_renamed_methods_warn_and_give_the_same():
    for call, expected, new in (
        (lambda: carved().grown(upper=(25, 20, 10)), lambda: carved().grow(upper=(25, 20, 10)), "Volume.grow"),
        (lambda: carved().resampled(1.0), lambda: carved().resample(1.0), "Volume.resample"),
        (lambda: carved().soften((9, 9, 7), 3).added, lambda: carved().smooth((9, 9, 7), 3).added, "Volume.smooth"),
        (lambda: carved().parts(least=2), lambda: carved().parts(minimum=2), "minimum=…"),
        (lambda: MESH.oriented(), lambda: MESH.orient(), "Mesh.orient"),
        (lambda: carved().stats().moves, lambda: carved().take_counters().moves, "Volume.take_counters"),
    ):
        with pytest.warns(DeprecationWarning, match=f"use {new}"):
            assert bits(call()) == bits(expected())
    with pytest.warns(DeprecationWarning, match="Softened is deprecated, use Smoothed"):
        assert riffler.Softened is riffler.Smoothed


@pytest.mark.filterwarnings("ignore:riffler. Mesh:DeprecationWarning")
def test_dicts_for_reports_are_still_filled():
    bad = riffler.Mesh(MESH.vertices, MESH.triangles[:, ::-1])
    report = {}
    assert bits(bad.oriented(report)) == bits(bad.orient())
    assert report["turned_shells"] == 1
    report = {}
    with pytest.warns(DeprecationWarning, match="use Volume.to_mesh_with_report"):
        assert bits(carved().to_mesh(report=report)) == bits(carved().to_mesh())
    lost = {"lost": 0, "lost_box": None, "lost_pitch": None, "lost_note": ""}
    assert report == lost | {"all_triangles": len(carved().to_mesh().triangles)}


def test_results_can_still_be_read_as_dicts_and_tuples():
    audit = MESH.audit()
    with pytest.warns(DeprecationWarning, match=r'Audit\["open_edges"\] is deprecated, use Audit.open_edges'):
        assert audit["open_edges"] == 0
    with pytest.warns(DeprecationWarning, match="keys") as caught:
        assert set(dict(audit)) == set(vars(audit))
    assert len(caught) == 1
    patch = riffler.Mesher(carved()).patch(0)
    with pytest.warns(DeprecationWarning, match="Patch as a tuple is deprecated, use its attributes"):
        vertices, triangles = patch
    assert vertices is patch.vertices and triangles is patch.triangles


def test_operators_of_sets_leave_their_operands_or_change_the_first():
    a, b = block(), carved()
    before = bits(a), bits(b)
    assert (a - b).volume == pytest.approx(a.volume - b.volume) and bits(a & b) == bits(b) and bits(a | b) == bits(a)
    assert (bits(a), bits(b)) == before
    same = a
    a -= b
    assert a is same and bits(a) == bits(block() - b)
    a |= b
    assert a is same and bits(a) == before[0]
    a &= b
    assert a is same and bits(a) == bits(b)
    with pytest.raises(TypeError):
        a - 3
    with pytest.raises(ValueError, match="pitch"):
        a | riffler.Volume.block(LOW, HIGH, 1.0, "xyz")


def test_reading_counters_changes_nothing():
    volume = carved()
    assert volume.counters.moves == volume.counters.moves == 1
    volume.carve(BALL, POSES)
    assert volume.counters.moves == 2 and volume.copy().counters.moves == 0
    assert volume.take_counters().moves == 2 and volume.counters.moves == 0
