"""The point of a path for a tool that is led along it by hand."""

from addon.plan.pure import orient_run


def test_a_tool_that_trembles_between_two_points_stays_with_one():
    point, seen = 100, []
    for station in [104.48, 104.53, 104.45, 104.56, 104.49, 104.59]:
        point = orient_run.point_at(station, point, 145, closed=False)
        seen.append(point)
    assert seen == [104] * 6
    assert orient_run.point_at(104.61, 104, 145, closed=False) == 105
    assert orient_run.point_at(103.39, 104, 145, closed=False) == 103


def test_a_closed_path_continues_at_its_first_point():
    assert orient_run.point_at(71.7, 0, 72, closed=True) == 0
    assert orient_run.point_at(71.55, 71, 72, closed=True) == 71
    assert orient_run.point_at(71.65, 71, 72, closed=True) == 0
    assert orient_run.point_at(71.3, 0, 72, closed=True) == 71
    assert orient_run.point_at(71.7, 0, 73, closed=False) == 72
