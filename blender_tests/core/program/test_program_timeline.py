"""A program's rows on the timeline, and their line numbers."""

import numpy as np
import pytest

from addon.program.pure import program_timeline

UP = (0.0, 0.0, 1.0)


def rows(*tips, axis=UP):
    return np.array([[*tip, *axis] for tip in tips], float)


def test_rows_are_at_the_times_that_their_feeds_give():
    poses = rows((0, 0, 10), (0, 0, 0), (30, 0, 0), (30, 0, 0), (30, 0, 100))
    poses[3, 3:] = (1, 0, 0)
    feed = np.array([0.0, 600, 600, 600, 0])
    rapid = np.array([True, False, False, False, True])
    # 10 mm and 30 mm at 10 mm/s, a quarter turn at 60 degrees a second, 100 mm at 10 m/min
    wanted = [0, 1, 3, 1.5, 0.6]
    duration = program_timeline.seconds(poses, feed, rapid)
    assert np.allclose(duration, wanted)
    along = program_timeline.by_time(duration, 24)
    assert np.allclose(along.frames, 1 + 24 * np.cumsum(wanted)) and (along.first, along.last) == (1, 148)
    assert [along.row_at(f) for f in (-5, 1, 24.9, 25, 96, 97, 1e6)] == [0, 0, 0, 1, 1, 2, 4]
    assert along.frame_of(2) == 97 and along.row_at(along.frame_of(3)) == 3


def test_long_programs_are_played_faster():
    along = program_timeline.by_time(np.full(1001, 3600.0), 24, most=1000)
    assert along.last == 1001 and np.allclose(np.diff(along.frames), 1000 / 1001)


def test_a_plan_s_rows_are_at_the_frames_of_its_paths():
    first, second = rows((0, 0, 0), (5, 0, 0), (9, 0, 0)), rows((0, 20, 0), (7, 20, 0))
    poses = np.vstack([rows((0, 0, 50)), first, rows((9, 0, 50), (0, 20, 50)), second, rows((7, 20, 50))])
    along = program_timeline.of_paths(poses, [(first, np.array([1, 13.5, 22])), (second, np.array([32, 50]))])
    assert list(along.frames[1:4]) == [1, 13.5, 22] and list(along.frames[6:8]) == [32, 50]
    assert along.frames[0] == 0 and 22 < along.frames[4] < along.frames[5] < 32 and along.frames[-1] == 55
    for row in (1, 3, 6, 7):
        assert along.row_at(along.frame_of(row)) == row
    assert along.row_at(13) == 1 and along.row_at(14) == 2
    with pytest.raises(ValueError, match="path 2"):
        program_timeline.of_paths(poses, [(first, np.arange(3)), (second + 1, np.arange(2))])


def test_rows_find_their_lines_among_inserted_lines():
    poses = rows((0, 0, 0), (10, 0, 0), (0, 0, 0), (10, 0, 0))
    read = rows((0, 0, 0), (3, 0, 0), (7, 0, 0), (10, 0, 1e-5), (4, 0, 0), (0, 0, 0), (10, 0, 0))
    numbers = np.array([11, 12, 13, 14, 15, 16, 17])
    assert list(program_timeline.lines(poses, read, numbers)) == [11, 14, 16, 17]
    assert list(program_timeline.lines(poses + 1, read, numbers)) == [0, 0, 0, 0]
    many = rows(*((k, 0, 0) for k in range(500)))
    assert list(program_timeline.lines(many[::100], many, np.arange(500))) == [0, 100, 200, 300, 400]


def test_a_file_that_was_edited_is_where_the_plan_is():
    plan = rows(*((k, 0, 0) for k in range(100)))
    frames = np.linspace(1, 199, 100)
    file = np.repeat(plan, 2, axis=0)[:-1]
    file[1::2, 0] += 0.5  # rows between
    file = np.vstack([rows((0, 0, 40)), file, rows((99, 0, 40))])
    file[61:70, 2] -= 1  # a slip
    along = program_timeline.like_paths(file, [(plan[:50], frames[:50]), (plan[50:], frames[50:])])
    assert np.allclose(along.frames[1:-1], np.arange(1, 200)) and (along.first, along.last) == (0, 204)
    assert program_timeline.like_paths(rows((0, 5, 0), axis=(0, 0, 0)) + file, [(plan, frames)]) is None
    assert program_timeline.like_paths(file[:60], [(plan, frames)]) is None
