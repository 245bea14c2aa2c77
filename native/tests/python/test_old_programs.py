"""Old names and forms of programs, plans, journals and sessions give what the new ones give, and warn with those."""

import dataclasses
import json

import numpy as np
import pytest
import riffler
from riffler import deprecated, plan

BALL = riffler.Tool.ball(4, 20)
GRAVER = riffler.Tool.taper(0.2, 0.3, 4, 20)
PART = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
FLAT = riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10)
COLLIDER = riffler.Collider(PART)
(VALLEY,) = plan.pencil(PART, BALL)
UPRIGHT = VALLEY.orient({0: (0, 0, 1)})
LINE = [(5, 10, 10), (25, 10, 10)]
POSES = np.array([(15.0, 10, 2, 0, 0, 1)])
CUT = [(0.0, 0, 5, 0, 0, 1), (20.0, 0, 5, 0, 0, 1)]
PROGRAM = riffler.Program(CUT, 600.0, spindle=9000.0, tools={1: BALL})
STROKE = [(0.0, 10, 8, 0, 0, 1), (20.0, 10, 8, 0, 0, 1)]


@pytest.fixture(autouse=True)
def warns_again():
    deprecated.forget()
    yield
    deprecated.forget()


def journal():
    out = riffler.Journal()
    out.set_stock((0, 0, 0), (20, 20, 10), 0.5)
    out.add_tool(1, BALL)
    out.add_stroke(1, STROKE, times=(0, 1))
    return out


def bits(result):
    """Anything that a call returns, comparable."""
    if isinstance(result, np.ndarray):
        return result.shape, result.tobytes()
    if isinstance(result, tuple | list):
        return [bits(one) for one in result]
    if isinstance(result, riffler.Program | riffler.Volume):
        return result.to_bytes()
    if dataclasses.is_dataclass(result):
        return bits([getattr(result, field.name) for field in dataclasses.fields(result)])
    if isinstance(result, plan.PencilPath):
        return bits([result.centres, result.axes])
    return result


FORMS = {
    "lift": (lambda: plan.lift(BALL, POSES, COLLIDER), lambda: plan.lift(POSES, BALL, COLLIDER), "plan.lift"),
    "drop": (lambda: plan.drop(BALL, POSES[:, :3], PART), lambda: plan.drop(POSES[:, :3], BALL, PART), "plan.drop"),
    "drop_axis": (
        lambda: plan.drop(BALL, POSES[:, :3], PART, (0, 0, 1)),
        lambda: plan.drop(POSES[:, :3], BALL, PART, axis=(0, 0, 1)),
        "plan.drop",
    ),
    "swarf": (lambda: plan.swarf(VALLEY, PART, BALL, 1), lambda: plan.swarf(VALLEY, BALL, PART, side=1), "plan.swarf"),
    "engrave": (
        lambda: plan.engrave(FLAT, [LINE], GRAVER, 0.3),
        lambda: plan.engrave([LINE], GRAVER, FLAT, depth=0.3),
        "plan.engrave",
    ),
    "contact_locations": (
        lambda: plan.contact_locations(BALL, [(1, 2, 3)], [(0, 0, 1)], [(0, 0, 1)]),
        lambda: plan.contact_locations([(1, 2, 3)], [(0, 0, 1)], [(0, 0, 1)], BALL),
        "plan.contact_locations",
    ),
    "free_orientations": (
        lambda: plan.free_orientations(VALLEY, 0, BALL, COLLIDER),
        lambda: plan.free_orientations(VALLEY, BALL, COLLIDER, index=0),
        "plan.free_orientations",
    ),
    "kept_locations": (
        lambda: plan.kept_locations(UPRIGHT, 0.3, BALL, COLLIDER),
        lambda: plan.kept_locations(UPRIGHT, BALL, COLLIDER, depth=0.3),
        "plan.kept_locations",
    ),
    "cutter_locations": (
        lambda: plan.cutter_locations(UPRIGHT, BALL, COLLIDER, 0.1),
        lambda: plan.cutter_locations(UPRIGHT, BALL, COLLIDER, clearance=0.1),
        "clearance=…",
    ),
    "pencil": (
        lambda: plan.pencil(PART, BALL, 0.02, 2),
        lambda: plan.pencil(PART, BALL, tolerance=0.02, passes=2),
        "tolerance=…, passes=…",
    ),
    "least_tilt": (
        lambda: plan.least_tilt(VALLEY, BALL, COLLIDER),
        lambda: plan.min_tilt(VALLEY, BALL, COLLIDER),
        "plan.min_tilt",
    ),
    "linked": (lambda: plan.linked([VALLEY]), lambda: plan.order_paths([VALLEY]), "plan.order_paths"),
    "oriented": (
        lambda: VALLEY.oriented({0: (0, 0, 1)}, interpolation="slerp"),
        lambda: VALLEY.orient({0: (0, 0, 1)}, interpolation="slerp"),
        "PencilPath.orient",
    ),
    "interpolation": (
        lambda: VALLEY.orient({0: (0, 0, 1)}, "slerp"),
        lambda: VALLEY.orient({0: (0, 0, 1)}, interpolation="slerp"),
        "interpolation=…",
    ),
    "retimed": (lambda: PROGRAM.retimed(2), lambda: PROGRAM.scale_feeds(2), "Program.scale_feeds"),
    "retooled": (lambda: PROGRAM.retooled({1: 7}), lambda: PROGRAM.renumber_tools({1: 7}), "Program.renumber_tools"),
    "program": (
        lambda: riffler.Program(CUT, 600.0, False, 3),
        lambda: riffler.Program(CUT, 600.0, rapid=False, tool=3),
        "rapid=…, tool=…",
    ),
    "from_cl": (
        lambda: riffler.Program.from_cl([CUT], [BALL], 600, 9000),
        lambda: riffler.Program.from_cl([CUT], [BALL], feed=600, spindle=9000),
        "feed=…, spindle=…",
    ),
    "machine_options": (
        lambda: riffler.machine_options("tcp", {}),
        lambda: riffler.machine_options("tcp", options={}),
        "options=…",
    ),
    "replay": (
        lambda: journal().replay(None, lambda share: None),
        lambda: journal().replay(None, progress=lambda share: None),
        "progress=…",
    ),
    "with_mask": (
        lambda: journal().replay(with_mask=True)[0],
        lambda: journal().replay_with_mask()[0],
        "Journal.replay_with_mask",
    ),
    "without_mask": (
        lambda: journal().replay(with_mask=False), lambda: journal().replay(), "Journal.replay_with_mask",
    ),
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_an_old_form_gives_the_same_and_names_the_new_one(form):
    old, new, named = FORMS[form]
    with pytest.warns(DeprecationWarning) as caught:
        found = old()
    assert named in " ".join(str(w.message) for w in caught)
    assert {w.filename for w in caught} == {__file__}
    assert bits(found) == bits(new())


def test_old_names_of_journals_warn_and_work(tmp_path):
    made = journal()
    with pytest.warns(DeprecationWarning, match=r"Journal.write is deprecated, use Journal.save"):
        made.write(tmp_path / "a.rjournal")
    with pytest.warns(DeprecationWarning, match=r"Journal.read is deprecated, use Journal.load"):
        assert len(riffler.Journal.read(tmp_path / "a.rjournal").strokes) == 1
    with pytest.warns(DeprecationWarning, match=r"Journal.undo"):
        made.take_back()
    with pytest.warns(DeprecationWarning, match=r"Journal.redo"):
        made.bring_back(1)
    with pytest.warns(DeprecationWarning, match=r'JournalStock\["pitch"\] is deprecated, use JournalStock.pitch'):
        assert made.stock["pitch"] == 0.5
    with pytest.warns(DeprecationWarning, match="times by position"):
        made.add_stroke(1, STROKE, (1, 2))
    assert made.strokes[1].times.tolist() == [1, 2]


def test_old_positions_of_programs_and_their_files_warn_and_work(tmp_path):
    with pytest.warns(DeprecationWarning, match=r"Program.write: post by position is deprecated, use post=…"):
        PROGRAM.write(tmp_path / "a.ngc", "3-axis")
    with pytest.warns(DeprecationWarning, match=r"Program.read: machine by position is deprecated, use machine=…"):
        read = riffler.Program.read(tmp_path / "a.ngc", "3-axis")
    assert np.allclose(read.poses[-1], CUT[-1])
    PROGRAM.save(tmp_path / "a.rprog")
    shares = []
    with pytest.warns(DeprecationWarning, match="progress by position"):
        riffler.Program.load(tmp_path / "a.rprog", shares.append)
    assert shares[-1] == 1


def test_results_that_were_dicts_can_still_be_read_as_one(tmp_path):
    written = PROGRAM.write(tmp_path / "a.ngc", post="3-axis")
    with pytest.warns(DeprecationWarning, match=r'WriteReport\["blocks"\] is deprecated, use WriteReport.blocks'):
        assert written["blocks"] == written.blocks > 0
    with pytest.warns(DeprecationWarning):
        assert dict(written) == dataclasses.asdict(written)
    assert json.loads(json.dumps(dataclasses.asdict(written)))["rewinds"] == []
    _, lifted = plan.lift(POSES, BALL, COLLIDER)
    with pytest.warns(DeprecationWarning, match=r"LiftReport.free"):
        assert lifted["free"] is lifted.free
    for frozen, name in ((written, "blocks"), (lifted, "free"), (VALLEY.nearest((1, 12, 2)), "index")):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(frozen, name, 1)


def test_wrong_arguments_name_the_right_ones():
    with pytest.raises(TypeError, match=r"plan.lift: there is no argument clearence; did you mean clearance\?"):
        plan.lift(POSES, BALL, COLLIDER, clearence=1)
    with pytest.raises(TypeError, match=r"Program.write: there is no argument tolerence; did you mean tolerance\?"):
        PROGRAM.write("a.ngc", tolerence=0.1)
    with pytest.raises(TypeError, match=r"Session: max_force must be a number; got str 'hard'"):
        riffler.Session(riffler.Volume.block((0, 0, 0), (9, 9, 9), 1), BALL, max_force="hard")
    with pytest.raises(TypeError, match=r"plan.cutter_locations: collider is missing: a Collider"):
        plan.cutter_locations(UPRIGHT, BALL)


def test_old_forms_of_pens_warn_and_work():
    pointer = riffler.pen.Pointer("mouse")
    with pytest.warns(DeprecationWarning, match=r"Pointer.set_frame\(most_tilt=…\) is deprecated, use max_tilt=…"):
        pointer.set_frame(most_tilt=0.5)
    with pytest.warns(DeprecationWarning, match=r'CoordinateCapability\["senses"\]'):
        assert pointer.limits["x"]["senses"] == "position"
    assert pointer.limits["a"].senses is None and pointer.limits["a"].sensing == "none"
    with pytest.warns(DeprecationWarning, match=r'PenHealth\["problem"\] is deprecated, use PenHealth.problem'):
        assert pointer.health()["problem"] is None
    with pytest.warns(DeprecationWarning, match=r"PushResult.reason"):
        assert "no motors" in pointer.push((0, 0, 1))["reason"]
    pen = riffler.pen.PenGeometry.load("riffler")
    with pytest.warns(DeprecationWarning, match=r"PenLimits.lower"):
        assert pen.limits["lower"].shape == (3,)
    with pytest.warns(DeprecationWarning, match=r"PenChannel.name"):
        assert pen.channels[0]["name"] == pen.channels[0].name
    with pytest.warns(DeprecationWarning):
        assert "channel" not in pen.diagnose([pen.home])
    with pytest.warns(DeprecationWarning, match="probe by position"):
        assert pen.homed([pen.home], 0).name == "riffler"


def test_an_old_analysis_is_read_as_a_dict():
    report = plan.analyse(FLAT)
    with pytest.warns(DeprecationWarning, match=r"PartReport.closed"):
        assert report["closed"] is True
