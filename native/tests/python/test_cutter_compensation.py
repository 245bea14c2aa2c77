"""The path of the tool's centre along a contour, against LinuxCNC's interpreter and against the contour itself."""

import random

import numpy as np
import pytest
import riffler
from commands import riffle
from contours import Contour, dense, distance
from hypothesis import given, settings
from hypothesis import strategies as st

import linuxcnc

OFFSET = {"cutter_compensation": "offset"}
FIXED = settings(derandomize=True, deadline=None, database=None)


def read(folder, text, machine="3-axis", **options):
    file = folder / "p.ngc"
    file.write_text(text)
    return riffler.Program.read(file, machine=machine, options=OFFSET | options)


def path_of(calls):
    """(n, 3): the ends of canonical moves, arcs by points that are 0.02 rad apart."""
    out = [calls[0].end[:3]]
    for call in calls[1:]:
        if call.plane is None:
            out.append(call.end[:3])
            continue
        (u, v), w = call.plane, 3 - sum(call.plane)
        before, after = call.start[[u, v]] - call.centre, call.end[[u, v]] - call.centre
        share = np.linspace(0, 1, max(2, int(abs(call.sweep) / 0.02)) + 1)[1:]
        radius = np.hypot(*before) + share * (np.hypot(*after) - np.hypot(*before))
        angle = np.arctan2(before[1], before[0]) + share * call.sweep
        points = np.empty((len(share), 3))
        points[:, u] = call.centre[0] + radius * np.cos(angle)
        points[:, v] = call.centre[1] + radius * np.sin(angle)
        points[:, w] = call.start[w] + share * (call.end[w] - call.start[w])
        out.extend(points)
    return np.array(out)


def length(path):
    return np.linalg.norm(np.diff(path, axis=0), axis=1).sum()


@linuxcnc.needed
def test_contours_are_offset_as_in_linuxcnc(tmp_path):
    compared = 0
    for seed in range(60):
        rng = random.Random(seed)
        contour = Contour(rng, rng.randint(1, 6), sharp=rng.random() < 0.7)
        text = contour.program(rng.choice(["41", "42"]), rng.choice([0, 1, 4, 6]))
        file = tmp_path / f"{seed}.ngc"
        file.write_text(text)
        try:
            program = riffler.Program.read(file, machine="3-axis", options=OFFSET)
            theirs = path_of(linuxcnc.calls(linuxcnc.output(file, "-b"))[0])
        except (riffler.FormatError, linuxcnc.RefusedError):
            continue  # each refuses gouges that the other does not look for
        compared += 1
        ours = program.poses[:, :3]
        assert distance(dense(theirs, 0.5), ours).max() < 0.005, seed
        assert distance(dense(ours, 0.5), theirs).max() < 0.005, seed
        assert length(ours) == pytest.approx(length(theirs), rel=2e-3, abs=0.01), seed
    assert compared > 35


@linuxcnc.needed
@pytest.mark.parametrize(
    "blocks",
    [
        "G41.1 D4|G3 X8 Y8 J8|G1 Y20|G40",  # begins with an arc
        "G42.1 D4|G3 X8 Y8 R8|G1 Y20|G40|G0 Z5|X0",
        "G18|G41.1 D2|G1 Z8|Z16 X3|G3 Z20 X7 K4|G1 X20|G40 Z0",
        "G20 G41.1 D.1|G1 X1|Y.5|X.2 F9|G21|Y20|G40",
        "G93|G41.1 D2|G1 X10 F5|Y20 F2|G2 X20 Y20 I5 F3|G40|G1 X30 F1",
        "G41.1 D2|G0 X10|Y-10|X20|G40",
        "G41.1 D2|G1 X10|Y10|Z1|G0 Z2|Z0|G1 X0|G40|X-5",
    ],
)
def test_entries_planes_units_and_heights_are_as_on_linuxcnc(tmp_path, blocks):
    text = "G21 G90 G17 G94 F200\nG0 X0 Y0 Z0\n" + blocks.replace("|", "\n") + "\nM2\n"
    program = read(tmp_path, text)
    calls = linuxcnc.calls(linuxcnc.output(tmp_path / "p.ngc", "-b"))[0]
    theirs, ours = path_of(calls), program.poses[:, :3]
    feeds = [call.feed for call in calls[:-1] if not np.isnan(call.feed)]  # under G93 the exit's is of another length
    np.testing.assert_allclose(np.unique(program.feed[:-1][~program.rapid[:-1]]), np.unique(feeds), rtol=1e-5)
    assert distance(dense(theirs, 0.2), ours).max() < 0.005
    assert distance(dense(ours, 0.2), theirs).max() < 0.005
    assert length(ours) == pytest.approx(length(theirs), rel=2e-3)


def turns_less(before, after):
    """Whether the contour turns by less than 120° from one element to the next."""
    into, out = before[-1] - before[-2], after[1] - after[0]
    return into @ out > -0.5 * np.linalg.norm(into) * np.linalg.norm(out)


@FIXED
@given(seed=st.integers(0, 2**32), diameter=st.sampled_from([0.5, 1.0, 4.0, 6.0]), left=st.booleans())
def test_the_tool_touches_each_element_and_enters_none_of_its_neighbours(tmp_path_factory, seed, diameter, left):
    rng = random.Random(seed)
    contour = Contour(rng, rng.randint(2, 7), sharp=rng.random() < 0.6)
    try:
        program = read(tmp_path_factory.mktemp("nc"), contour.program("41" if left else "42", diameter))
    except riffler.FormatError as e:
        assert "cutter compensation by" in str(e)
        return
    moving = [k for k, points in enumerate(contour.points) if points is not None]
    radius, near = diameter / 2, 10  # 0.1 mm of an element
    for row in range(1, len(program)):
        block = program.line[row] - Contour.FIRST_LINE
        if block not in moving or program.rapid[row]:
            continue  # a rapid goes straight past a corner, as on LinuxCNC
        at, own = moving.index(block), contour.points[block]
        way = dense(program.poses[row - 1 : row + 1, :2], 0.2)
        apart = distance(way, own)
        assert apart.max() < radius + 0.005
        # About the corner before it the tool may meet the far end of an arc that comes back.
        corner = np.abs(np.linalg.norm(way - own[0], axis=1) - radius).max() < 0.005
        assert corner or apart.min() > radius - 0.005
        if len(own) < near:
            continue
        # Close to a corner that does not fold back, both elements: farther from it the contour may cross itself.
        if at > 0 and turns_less(before := contour.points[moving[at - 1]], own):
            by = way[distance(way, own[:near]) < apart + 1e-9]
            assert not len(by) or distance(by, before[-near:]).min() > radius - 0.005
        if not corner and at + 1 < len(moving) and turns_less(own, after := contour.points[moving[at + 1]]):
            by = way[distance(way, own[-near:]) < apart + 1e-9]
            assert not len(by) or distance(by, after[:near]).min() > radius - 0.005


def test_diameters_are_taken_from_python_and_from_the_command_line(tmp_path):
    text = "G21 G90 T3 M6\nG0 X-20 Y0 Z0\nG41 {}\nG1 X0 F100\nX10\nG40\nG0 X20\nM2\n"

    def offset(word, diameters):
        return read(tmp_path, text.format(word), tool_diameters=diameters).poses[1, 1]

    assert offset("", {3: 8}) == offset("", {"3": 8.0}) == offset("", [3, 8, 4, 2]) == offset("D9", 8) == 4
    assert offset("D4", {3: 8, 4: 2}) == 1
    for wrong, why in [
        ({3: "wide"}, "numbers only"),
        ([3, 8, 4], "in pairs"),
        ({3: 8, "3": 2}, "twice"),
        (True, "finite"),
    ]:
        with pytest.raises(ValueError, match=why):
            offset("", wrong)
    with pytest.raises(riffler.FormatError, match=r"offset D5 is not known: .* \{'tool_diameters': \{5: 6\}\}"):
        offset("D5", {3: 8})
    out = tmp_path / "out.ngc"
    how = ["--machine", "3-axis", "--machine-option", "cutter_compensation=offset"]
    how += ["--machine-option", "tool_diameters=3:8,5:2", "--post", "3-axis", "--out", out]
    done = riffle("nc", "post", tmp_path / "p.ngc", *how, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "offsets the path by the radius of offset D5, 1 mm" in done.stderr
    assert "Y1.00000" in out.read_text()


def test_the_remedies_of_the_refusal_work(tmp_path):
    text = "G21 G90\nG0 X-20 Y0 Z0\nG41 D1\nG1 X0 F100\nX10\nG40\nG0 X20\nM2\n"
    file = tmp_path / "p.ngc"
    file.write_text(text)
    with pytest.raises(riffler.FormatError) as refused:
        riffler.Program.read(file)
    said = str(refused.value)
    offset, ignore = {"cutter_compensation": "offset", "tool_diameters": 6}, {"cutter_compensation": "ignore"}
    assert str(offset) in said
    assert str(ignore) in said
    assert riffler.Program.read(file, options=offset).poses[1, 1] == 3
    assert riffler.Program.read(file, options=ignore).poses[1, 1] == 0


def test_a_stream_has_the_same_rows(tmp_path):
    contour = Contour(random.Random(3), 6, sharp=False)
    program = read(tmp_path, contour.program("41", 0.5))
    chunks = list(riffler.Program.stream(tmp_path / "p.ngc", machine="3-axis", options=OFFSET, rows=7))
    poses = np.concatenate([chunks[0].poses, *[chunk.poses[1:] for chunk in chunks[1:]]])
    np.testing.assert_array_equal(poses, program.poses)
