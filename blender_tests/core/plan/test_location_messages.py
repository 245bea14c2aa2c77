"""Messages about cutter locations, from a fake report."""

from types import SimpleNamespace

import numpy as np

from addon.plan.pure import location_messages

CENTRES = np.arange(30.0).reshape(10, 3)
CL = np.hstack([CENTRES[[0, 1, 2, 2, 7, 8, 9]], np.tile((0, 0, 1.0), (7, 1))])


def report(**more):
    nothing = {"blocked": [], "unsafe": [], "lift": np.zeros(7), "points": np.array([0, 1, 2, -1, 7, 8, 9])}
    out = SimpleNamespace(**{**nothing, "pieces": ["cutter"] * 7, **more})
    out.lifted, out.inserted = np.flatnonzero(out.lift > 0), np.flatnonzero(out.points < 0)
    return out


def said(**more):
    found = location_messages.ordered(location_messages.entries(1, CENTRES, CL, report(**more)))
    return [(e["kind"], e["point"], e["name"]) for e in found]


def test_inserted_rows_belong_to_the_point_before():
    assert said() == [("inserted", 2, "Path 2, 1 row inserted between its points")]


def test_neighbouring_points_with_one_reason_are_one_line():
    blocked = [(3, "the holder"), (4, "the holder"), (5, "the part"), (6, "the part"), (8, "the part")]
    lines = said(blocked=blocked)[:3]
    assert [line[:2] for line in lines] == [("blocked", 3), ("blocked", 5), ("blocked", 8)]
    assert lines[0][2] == "Path 2, 2 points from 3 on: the holder" and lines[2][2] == "Path 2, point 8: the part"


def test_a_run_of_lifted_rows_is_listed_at_its_highest_row():
    pieces = ["cutter", "shank", "holder", "cutter", "cutter", "cutter", "cutter"]
    lines = said(lift=np.array([0.1, 0.2, 0.5, 0, 0, 0.25, 0]), pieces=pieces)
    assert lines[0] == ("lifted", 2, "Path 2, 3 rows lifted by up to 0.5 mm, off the holder")
    assert lines[1] == ("lifted", 8, "Path 2, 1 row lifted by up to 0.25 mm, off the cutter")
    found = location_messages.entries(1, CENTRES, CL, report(lift=np.array([0.1, 0.2, 0.5, 0, 0, 0, 0])))
    assert found[0]["place"] == tuple(CENTRES[2])


def test_a_lift_by_more_than_the_tolerance_leaves_material():
    some, more = report(lift=np.array([0, 0.009, 0.02, 0.5, 0, 0, 0])), report(lift=np.array([0, 0, 0, 0, 0, 1.25, 0]))
    assert location_messages.left([some], 0.01) == "2 rows are lifted by up to 0.5 mm: material stays"
    assert location_messages.left([some, more], 0.02) == "2 rows are lifted by up to 1.25 mm: material stays"
    assert location_messages.left([more], 0.01) == "1 row is lifted by up to 1.25 mm: material stays"
    assert location_messages.left([some, report()], 0.5) == "" == location_messages.left([], 0.01)


def test_blocked_moves_are_listed_before_lifted_rows():
    lines = said(unsafe=[(3, -0.2, 0.1, "no row frees it")], lift=np.array([1.0, 0, 0, 0, 0, 0, 0]))
    assert [line[0] for line in lines] == ["unsafe", "lifted", "inserted"]
    assert lines[0][1:] == (2, "Path 2, after point 2: no row frees it (-0.2 mm)")
