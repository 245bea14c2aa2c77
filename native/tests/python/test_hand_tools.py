"""Hand tools: carving compared with poses that lie densely in time, and what cannot use them."""

import json
from itertools import pairwise

import numpy as np
import pytest
import riffler
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

T = riffler.Tool
TOOLS = {
    "chisel": T.chisel(6, 3, 0.6, 20, skew=0.3),
    "gouge": T.gouge(6, 4, 0.6, 20),
    "v_tool": T.v_tool(1.0, 6, 0.6, 20),
    "knife": T.knife(6, 2, 0.5, 20),
    "convex": T.convex(
        [[(-1, -2, 0), (1, -2, 0), (0, 2, 0), (0, 0, 9)], [(0, 0, 1), (3, 0, 2), (0, 3, 4), (-1, -1, 8)]]
    ),
}
CHISEL = TOOLS["chisel"]
STRAIGHT = [[4, 10, 8, 0, 0, 1, 1, 0, 0], [14, 10, 8, 0, 0, 1, 1, 0, 0]]
UPRIGHT = [[4, 10, 8, 0, 0, 1], [14, 10, 8, 0, 0, 1]]


def block(directions="xyz", pitch=0.4):
    return riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=pitch, directions=directions)


def row(tip, frame):
    return [*tip, *frame[:, 2], *frame[:, 0]]


def frame_of(pose):
    z, x = np.array(pose[3:6], float), np.array(pose[6:9], float)
    z /= np.linalg.norm(z)
    x -= (x @ z) * z
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def path(tip, frame, moves):
    """Rows of poses: each move is a displacement and a rotation vector."""
    rows = [row(tip, frame)]
    for way, turn in moves:
        tip, frame = np.add(tip, way), Rotation.from_rotvec(turn).as_matrix() @ frame
        rows.append(row(tip, frame))
    return np.array(rows)


def leaning(degrees=30):
    return Rotation.from_euler("y", -degrees, degrees=True).as_matrix()


def height_over(hulls, poses, points, step):
    """Height of each point over the nearest body, at poses at most `step` apart: negative inside, outside at most the
    distance."""
    faces = [ConvexHull(corners).equations for corners in hulls]
    reach = max(np.linalg.norm(corners, axis=1).max() for corners in hulls)
    best, places = np.full(len(points), np.inf), np.vstack([points.T, np.ones(len(points))])
    for a, b in pairwise(poses):
        start = frame_of(a)
        turn = Rotation.from_matrix(frame_of(b) @ start.T).as_rotvec()
        way = b[:3] - a[:3]
        n = int(np.ceil((np.linalg.norm(way) + np.linalg.norm(turn) * reach) / step)) + 1
        t = np.linspace(0, 1, n)[:, None]
        frames, tips = Rotation.from_rotvec(t * turn).as_matrix() @ start, a[:3] + t * way
        for equations in faces:
            normals = equations[:, :3] @ frames.transpose(0, 2, 1)
            offsets = equations[:, 3] - np.einsum("nfx,nx->nf", normals, tips)
            for planes in np.concatenate([normals, offsets[:, :, None]], axis=2):
                np.minimum(best, (planes @ places).max(axis=0), out=best)
    return best


def places(volume, tolerance, seed):
    """Points near the ends of spans and random ones, and whether they are solid."""
    random = np.random.default_rng(seed)
    points, solid = [], []
    for w, direction in enumerate("xyz"):
        u, v = (w + 1) % 3, (w + 2) % 3
        counts, spans = volume.intervals(direction)
        ends = np.concatenate([[0], np.cumsum(counts.ravel(), dtype=np.int64)])
        for ray in random.choice(counts.size, 100, replace=False):
            i, j = np.unravel_index(ray, counts.shape)
            mine = spans[ends[ray] : ends[ray + 1]]
            near = (mine.ravel()[:, None] + 3 * tolerance * np.array([-1, 1])).ravel()
            for s in [*near, *random.uniform(0, volume.upper[w], 2)]:
                if not 0 <= s <= volume.upper[w]:
                    continue
                p = np.empty(3)
                p[u], p[v] = (np.array([i, j]) + 0.5) * volume.pitch
                p[w] = s
                points.append(p)
                solid.append(any(low <= s <= high for low, high in mine))
    return np.array(points), np.array(solid)


def check(tool, poses, tolerance=0.02, seed=1):
    """Every place deeper than the tolerance in what is swept is empty, every place farther off is solid."""
    volume = block()
    volume.carve(tool, poses, tolerance=tolerance)
    points, solid = places(volume, tolerance, seed)
    height = height_over(tool.hulls, np.asarray(poses, float), points, 0.2 * tolerance)
    assert not (solid & (height < -1.2 * tolerance)).any()
    assert not (~solid & (height > 1.2 * tolerance)).any()
    return volume


MOVES = {
    "straight": [((6, 1, -0.5), (0, 0, 0))],
    "turning": [((2, 0.5, 0), (0.1, 0.3, 0.2)), ((2, 0, 0), (-0.2, 0.1, 0.5))],
    "roll only": [((0, 0, 0), "axis")],
    "along the axis": [("axis", (0, 0, 0))],
    "screw": [("axis", "axis")],
    "a turn like rounding": [((3, 0, 0), (0, 0, 1e-12))],
    "a wide turn in place": [((0, 0, 0), (0, 0, 2.5))],
}


@pytest.mark.parametrize("kind", TOOLS)
@pytest.mark.parametrize("moves", MOVES)
def test_carving_keeps_to_dense_poses(kind, moves):
    frame = leaning()
    length = {"turns": 0.9, "ways": 3}
    named = [
        (
            -length["ways"] * frame[:, 2] if way == "axis" else way,
            length["turns"] * frame[:, 2] if turn == "axis" else turn,
        )
        for way, turn in MOVES[moves]
    ]
    volume = check(TOOLS[kind], path((7, 10, 7.5), frame, named))
    assert volume.volume < 4000


def test_a_standing_tool_removes_its_own_body():
    tool = T.convex([np.array(np.meshgrid([-2, 2], [-2, 2], [0, 2])).reshape(3, 8).T])
    for directions in ("z", "xyz"):
        volume = block(directions, 0.5)
        volume.carve(tool, [[10, 10, 5, 0, 0, 1, 1, 0, 0]] * 2)
        assert volume.volume == pytest.approx(4000 - 32, abs=1e-9)


def test_straight_moves_are_exact_for_any_tolerance():
    cuts = [block().carve(CHISEL, STRAIGHT, tolerance=t).removed[0] for t in (1e-4, 1)]
    assert cuts[0] == cuts[1] > 100


def test_adding_and_protecting_work_as_for_other_tools():
    volume = riffler.Volume.empty((0, 0, 0), (20, 20, 10), 0.4, "xyz")
    volume.carve(CHISEL, STRAIGHT, mode="add")
    assert volume.volume == pytest.approx(4000 - carved(STRAIGHT).volume)
    kept = block()
    kept.carve(CHISEL, STRAIGHT, protect=volume)
    assert kept.volume == pytest.approx(4000, abs=1e-6)


def carved(poses, tool=CHISEL, pitch=0.4):
    volume = block(pitch=pitch)
    volume.carve(tool, poses)
    return volume


def test_the_bytes_do_not_depend_on_threads_or_on_how_a_stroke_is_divided():
    poses = path((4, 10, 8), leaning(), [((0.6, 0, -0.02), (0, 0.01, 0.03 * (-1) ** (k // 7))) for k in range(20)])
    before = riffler.threads()
    try:
        whole = []
        for threads in (1, 3):
            riffler.set_threads(threads)
            whole.append(carved(poses, TOOLS["gouge"], 0.15).to_bytes())
    finally:
        riffler.set_threads(before)
    pieces = block(pitch=0.15)
    for k in range(20):
        pieces.carve(TOOLS["gouge"], poses[k : k + 2])
    assert whole[0] == whole[1] == pieces.to_bytes()


def test_a_tool_reads_back():
    for kind, tool in TOOLS.items():
        again = T.from_dict(json.loads(json.dumps(tool.to_dict())))
        assert again == tool and again.kind == kind
        assert all(np.array_equal(a, b) for a, b in zip(again.hulls, tool.hulls, strict=True))
    assert T.ball(6, 30).hulls == []


CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
BODIES = {
    r"hulls\[0\]: the body is flat": lambda: T.convex([[(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]]),
    r"hulls\[1\]: the body is flat": lambda: T.convex([CORNERS, [(0, 0, 0), (1, 1, 1), (2, 2, 2), (3, 3, 3)]]),
    "a body needs four points or more, not 3": lambda: T.convex([CORNERS[:3]]),
    "at most 128 points, not 200": lambda: T.convex([np.random.default_rng(1).normal(size=(200, 3))]),
    r"hulls\[0\] must have the shape": lambda: T.convex([[(0, 0), (1, 1)]]),
    r"hulls\[0\], row 3: not finite": lambda: T.convex([[*CORNERS[:3], (0, 0, np.nan)]]),
    "hulls: give one list": lambda: T.convex([]),
    "width must be positive": lambda: T.chisel(-6, 3, 0.6, 20),  # would be inside out
    "thickness must be positive": lambda: T.knife(6, -2, 0.5, 20),
    "bevel must lie between 0 and a right angle": lambda: T.chisel(6, 3, 1.7, 20),
    "width must not be more than twice the radius": lambda: T.gouge(9, 4, 0.6, 20),
    "angle must lie between 0 and a half turn": lambda: T.v_tool(3.2, 6, 0.6, 20),
    "length must be more than the ground end needs": lambda: T.chisel(6, 3, 0.1, 20),
}


@pytest.mark.parametrize("message", BODIES)
def test_bad_bodies_are_refused(message):
    with pytest.raises(ValueError, match=message):
        BODIES[message]()


POSES = {
    "row 1: the tool is a half turn from the row before": [STRAIGHT[0], [14, 10, 8, 0, 0, 1, -1, 0, 0]],
    "row 1: the forward direction must be square to the axis": [STRAIGHT[0], [14, 10, 8, 0, 0, 1, 0.8, 0, 0.6]],
    "row 0: the forward direction must be a unit vector": [[14, 10, 8, 0, 0, 1, 2, 0, 0]],
    "row 0: the axis must be a unit vector": [[14, 10, 8, 0, 0, 2, 1, 0, 0]],
    "row 0: not finite": [[np.nan, 10, 8, 0, 0, 1, 1, 0, 0]],
    r'the hand tool "chisel 6" needs the shape \(n, 9\)': UPRIGHT,
}


@pytest.mark.parametrize("message", POSES)
def test_bad_poses_change_nothing(message):
    volume = block()
    before = volume.to_bytes()
    with pytest.raises(ValueError, match=message):
        volume.carve(CHISEL, POSES[message])
    assert volume.to_bytes() == before
    history = riffler.History(volume)
    with pytest.raises(ValueError, match=message):
        history.add(CHISEL, POSES[message])
    assert history.ids == [] and history.volume.to_bytes() == before


def test_a_tool_of_revolution_takes_no_forward_direction():
    with pytest.raises(ValueError, match=r'the tool "ball 6" is a body of revolution and needs the shape \(n, 6\)'):
        block().carve(T.ball(6, 30), STRAIGHT)


def test_a_history_of_hand_tools_gives_the_bytes_of_a_replay():
    history = riffler.History(block())
    turning = path((4, 6, 8), leaning(), [((5, 3, 0), (0, 0.2, 0.3)), ((4, 3, 0), (0.1, 0, -0.4))])
    first = history.add(CHISEL, turning)
    second = history.add(T.ball(6, 30), UPRIGHT, mode="add")
    third = history.add(TOOLS["gouge"], STRAIGHT, tolerance=0.005)
    for edit in (
        lambda: history.replace(first, poses=turning + np.array([0, 2, 0, 0, 0, 0, 0, 0, 0])),
        lambda: history.move(third, before=first),
        lambda: history.replace(second, tool=TOOLS["knife"], poses=STRAIGHT),
        lambda: history.enable(first, False),
        lambda: history.enable(first),
    ):
        edit()
        volume = history.base
        for s in map(history.stroke, history.ids):
            if s.enabled:
                volume.carve(s.tool, s.poses, mode=s.mode, tolerance=s.tolerance)
        assert history.volume.to_bytes() == volume.to_bytes()
    assert history.stroke(first).poses.shape == (3, 9) and history.stats().stroke_bytes > 0
    with pytest.raises(ValueError, match="needs nine numbers"):
        history.replace(history.add(T.ball(6, 30), UPRIGHT), tool=CHISEL)


def test_a_journal_keeps_the_roll(tmp_path):
    turning = path((4, 6, 8), leaning(), [((5, 3, 0), (0, 0.2, 0.3)), ((0, 0, 0), (0, 0, 0.2))])
    with riffler.JournalWriter(tmp_path / "a.rjournal") as writer:
        writer.set_stock((0, 0, 0), (20, 20, 10), 0.4, "xyz")
        writer.add_tool(1, CHISEL)
        writer.add_tool(2, T.ball(6, 30))
        writer.add_stroke(1, turning[:1], times=[0.0])
        writer.extend_stroke(turning[1:], times=[1.0, 2.0])
        writer.add_stroke(2, UPRIGHT)
        for message, number, poses in (
            (r"poses: tool 1 is a hand tool and needs the shape \(n, 9\)", 1, UPRIGHT),
            (r"poses: tool 2 is a body of revolution and needs the shape \(n, 6\)", 2, STRAIGHT),
            ("poses, row 1: the forward direction must be square", 1, POSES[list(POSES)[1]]),
        ):
            with pytest.raises(ValueError, match=message):
                writer.add_stroke(number, poses)
        with pytest.raises(ValueError, match="forward for a stroke that has none"):
            writer.extend_stroke(STRAIGHT)
    journal = riffler.Journal.load(tmp_path / "a.rjournal")
    assert np.array_equal(journal.strokes[0].poses, turning) and journal.strokes[1].poses.shape == (2, 6)
    volume = block()
    volume.carve(CHISEL, turning)
    volume.carve(T.ball(6, 30), UPRIGHT)
    assert journal.replay().to_bytes() == volume.to_bytes()
    journal.save(tmp_path / "b.rjournal")
    assert riffler.Journal.load(tmp_path / "b.rjournal").replay().to_bytes() == volume.to_bytes()
    for refuses, call in (
        ("tool 1: a program", lambda: journal.program(feed=600)),
        ("tool 1: the search for the stroke", lambda: journal.strokes_at([(10, 10, 8)])),
        ("recording, tool 1: a plan", lambda: riffler.plan.from_recording(journal, tool=1)),
    ):
        with pytest.raises(ValueError, match=f'{refuses}.* cannot use the hand tool "chisel 6"'):
            call()


PART = riffler.Volume.block((0, 0, 0), (20, 20, 10), 1, "xyz").to_mesh()
COLLIDER = riffler.Collider(PART)
(VALLEY,) = riffler.plan.pencil(
    riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5), T.ball(4, 20)
)
POINTS = [[10.0, 10, 10]]
UPS = [[0.0, 0, 1]]
REFUSING = {
    "a collider": lambda: COLLIDER.query(CHISEL, UPRIGHT[0]),
    "a collider ": lambda: COLLIDER.clearance(CHISEL, UPRIGHT),
    "a collider  ": lambda: COLLIDER.nearest(CHISEL, UPRIGHT[0]),
    "tools: a program": lambda: riffler.Program.from_cl([UPRIGHT], tools=[CHISEL], feed=600),
    "tools: a program ": lambda: riffler.Program(UPRIGHT, 600, tools={1: CHISEL}),
    "tools: a program  ": lambda: riffler.verify(riffler.Program(UPRIGHT, 600), block(), tools={1: CHISEL}),
    "a session": lambda: riffler.Session(block(), CHISEL),
    "tool: a plan": lambda: riffler.plan.Plan([VALLEY], CHISEL),
    "plan.pencil": lambda: riffler.plan.pencil(PART, CHISEL),
    "plan.engrave": lambda: riffler.plan.engrave([[(5, 5, 10), (15, 5, 10)]], CHISEL, PART, depth=1),
    "plan.swarf": lambda: riffler.plan.swarf(VALLEY, CHISEL, PART),
    "plan.contact_locations": lambda: riffler.plan.contact_locations(POINTS, UPS, UPS, CHISEL),
    "plan.drop": lambda: riffler.plan.drop(POINTS, CHISEL, PART),
    "plan.lift": lambda: riffler.plan.lift(UPRIGHT, CHISEL, COLLIDER),
    "plan.cutter_locations": lambda: riffler.plan.cutter_locations(VALLEY, CHISEL, COLLIDER),
    "plan.free_orientations": lambda: riffler.plan.free_orientations(VALLEY, CHISEL, COLLIDER, index=0),
    "plan.min_tilt": lambda: riffler.plan.min_tilt(VALLEY, CHISEL, COLLIDER),
    "plan.path_of_stroke": lambda: riffler.plan.path_of_stroke(UPRIGHT, CHISEL),
    "plan.finish": lambda: riffler.plan.finish(riffler.plan.Setup(PART, block("z")), CHISEL, feed=600, spindle=9000),
    "plan.rough": lambda: riffler.plan.rough(riffler.plan.Setup(PART, block("z")), CHISEL),
    "with_shank": lambda: CHISEL.with_shank([(20, 3, 40, 3)]),
}


@pytest.mark.parametrize("who", REFUSING)
def test_calls_that_cannot_use_a_hand_tool_refuse_it(who):
    with pytest.raises(ValueError) as error:
        REFUSING[who]()
    message = str(error.value)
    assert f'{who.strip()} cannot use the hand tool "chisel 6"' in message
    assert "use a ball, a flat or another tool with a profile" in message


def test_commands_refuse_a_hand_tool(tmp_path):
    from riffler.command import tools

    (tmp_path / "chisel.json").write_text(json.dumps(CHISEL.to_dict()))
    with pytest.raises(ValueError, match='"chisel 6" is a hand tool, and commands cut with tools of revolution'):
        tools.parse(str(tmp_path / "chisel.json"))
