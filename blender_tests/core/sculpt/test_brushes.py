"""The table of brushes: a journal replays the effect of each, and only its own module knows it."""

import importlib
import sys

import numpy as np
import pytest
import riffler

import addon.sculpt.brushes
from addon.common.contents import Content
from addon.sculpt import brushes
from addon.sculpt.pure.journal import LiveJournal
from addon.sculpt.pure.stroke_record import StrokeRecord

BALL = riffler.Tool.ball(6, 30)
BOX = ((0, 0, 0), (40, 30, 10), 0.5, "xyz")
CHISEL = riffler.Tool.chisel(6, 2, 0.5, 30, skew=0.3)
POSES = np.array([[x, 10.0, 8.0, 0, 0, 1] for x in (5.0, 20.0, 35.0)])
EVERY = pytest.mark.parametrize("brush", brushes.BRUSHES.values(), ids=str)


class Sculpt:
    """A live sculpt without Blender: half of the remaining block next to a groove is protected."""

    def __init__(self):
        self.volume = riffler.Volume.block(*BOX)
        self.volume.carve(riffler.Tool.flat(8, 30), POSES + np.array([0, 4.0, 0, 0, 0, 0]))
        self.mask = riffler.Volume.block((0, 0, 0), (20, 30, 10), 0.5, "xyz").grow((0, 0, 0), (40, 30, 10))
        self.strength, self.depth, self.falloff = 0.7, 0.4, "sharp"
        self.pressure, self.step, self.cut_off, self.lost = 1.0, 0.0, False, 0.0

    def bytes(self):
        return self.volume.to_bytes(), self.mask.to_bytes()


def test_the_ids_are_those_of_files_and_scripts():
    old = ["remove", "add", "soften", "mask", "unmask"]
    assert [name for name in brushes.BRUSHES if name in old] == old, "and lists have them in this order"
    assert all(brushes.of(name).journal == name for name in old)
    assert [b.tool for b in brushes.with_tool() if b.id in old] == [
        f"riffler.{n}" for n in ("carve", "add", "smooth", "mask")
    ]
    with pytest.raises(ValueError, match=r"mode must be one of .*remove, .*add, .*, not 'paint'"):
        brushes.of("paint")


@EVERY
def test_a_brush_has_all_that_lists_show(brush):
    assert brush.id and brush.label and brush.description and brush.place
    assert brushes.opposite(brush).id in brushes.BRUSHES
    assert brush.second in ("DEPTH", "STRENGTH") and brush.cuts in ("", "remove", "add")
    assert not (brush.paints and (brush.cuts or brush.shapes or brush.session)), "a mask is not material"
    assert brush.cuts or not brush.session, "a session carves or puts on"
    assert bool(brush.tip) == bool(brush.icon), "a tool has an icon, and nothing else has"
    if not brush.tip:
        assert any(brushes.opposite(other) is brush for other in brushes.with_tool()), "no tool reaches it"


@EVERY
def test_a_journal_replays_exactly_what_a_brush_does(tmp_path, brush):
    sculpt = Sculpt()
    before = sculpt.bytes()
    start = Content(sculpt.volume.copy(), [], sculpt.mask.copy())
    journal, stroke = LiveJournal(tmp_path, start, "t0"), StrokeRecord(start)
    tool = brush.cutter(CHISEL if brush.hand else BALL, 0.5)
    for new, poses in ((True, POSES), (False, POSES[-1:] + np.array([[0.0] * 6, [0, 9.0, 0, 0, 0, 0]]))):
        if brush.hand:
            poses = np.hstack([poses, np.tile([1.0, 0, 0], (len(poses), 1))])
        sculpt.step = brush.step(sculpt, tool, poses, new)
        rows, dt = brush.moves(poses, np.full(len(poses) - 1, 0.1), new)
        brush.apply(sculpt, tool, rows, dt)
        journal.carved(tool.to_dict(), rows, brush.journal, "t1", **brush.options(sculpt, tool))
        brush.record(stroke, 0, tool, rows, new)
    journal.finish("t1")
    assert journal.whole and not journal.problem
    made = journal.state("t1")
    changed = [a != b for a, b in zip(before, sculpt.bytes(), strict=True)]
    assert changed == [not brush.paints, brush.paints]
    assert (made.volume.to_bytes(), made.mask.to_bytes()) == sculpt.bytes()
    assert made.shaped == stroke.shaped == brush.shapes
    cuts = stroke.cuts(masked=True)
    assert [(c.mode, c.tool, c.masked) for c in cuts] == [(c.mode, c.tool, c.masked) for c in made.cuts]
    assert all(np.array_equal(a.poses, b.poses) for a, b in zip(cuts, made.cuts, strict=True))
    assert len(cuts) == bool(brush.cuts)


@pytest.mark.parametrize("falloff", ["smooth", "sharp", "sphere", "constant"])
@pytest.mark.parametrize("step", [0.3, 1.0])
def test_a_pass_of_clay_adds_its_depth_for_any_steps(falloff, step):
    sculpt, clay = Sculpt(), brushes.of("clay")
    sculpt.volume = riffler.Volume.block((0, 0, 0), (40, 30, 12), 0.25, "xyz")
    sculpt.volume.carve(riffler.Tool.flat(90, 30), [(20, 15, 8, 0, 0, 1), (21, 15, 8, 0, 0, 1)])
    sculpt.mask, sculpt.falloff = None, falloff
    poses = np.array([[x, 15.0, 8.0, 0, 0, 1] for x in np.arange(6, 34 + step / 2, step)])
    for k in range(0, len(poses) - 4, 4):  # in pieces, as events of the mouse bring them
        piece = poses[k : k + 5]
        sculpt.step = clay.step(sculpt, BALL, piece, False)
        clay.apply(sculpt, BALL, clay.moves(piece, None, False)[0], None)
    counts, spans = sculpt.volume.intervals("z")
    heights = spans[np.cumsum(counts.ravel()) - 1, 1].reshape(counts.shape) - 8
    assert heights[80, 60] == pytest.approx(sculpt.depth, rel=0.08)  # a rising surface moves away from the dab's centre
    assert heights[:, :40].max() < 1e-9 and not sculpt.cut_off


def test_a_module_in_the_folder_is_all_that_a_brush_needs(tmp_path, monkeypatch):
    (tmp_path / "stipple.py").write_text(
        "from addon.sculpt.brushes.carve import Carve\n\n\nclass Stipple(Carve):\n"
        "    id, place, label, icon, opposite = 'stipple', 15, 'Stipple', 'stipple', ''\n\n\nBRUSHES = (Stipple(),)\n"
    )
    monkeypatch.setattr(addon.sculpt.brushes, "__path__", [*brushes.__path__, str(tmp_path)])
    found = [brush.id for brush in brushes._found()]
    monkeypatch.delitem(sys.modules, "addon.sculpt.brushes.stipple")
    assert found.index("remove") < found.index("stipple") < found.index("add")
    assert importlib.import_module("addon.sculpt.brushes.carve").BRUSHES[0] is brushes.of("remove")


def test_a_brush_without_a_journal_name_makes_the_journal_incomplete(tmp_path):
    journal = LiveJournal(tmp_path, Content(riffler.Volume.block(*BOX)), "t0")
    journal.carved(BALL.to_dict(), POSES, "", "t1")
    assert not journal.whole
