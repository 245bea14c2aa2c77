"""Blocks of bricks, stages and snapshots of a live sculpt, without Blender."""

import pytest

from addon.common.blocks import Blocks
from addon.common.contents import Snapshots
from addon.sculpt.pure.stages import Stages


@pytest.mark.parametrize("shape", [(1, 1, 1), (4, 4, 4), (33, 20, 7), (1, 300, 1), (16, 16, 16), (2, 2, 500)])
@pytest.mark.parametrize("most", [1, 7, 128])
def test_every_brick_is_in_one_block(shape, most):
    blocks = Blocks(shape, most)
    assert 1 <= len(blocks) <= most
    bricks = [brick for block in range(len(blocks)) for brick in blocks.bricks(block)]
    assert sorted(bricks) == list(range(shape[0] * shape[1] * shape[2]))
    assert all(blocks.of(brick) == block for block in range(len(blocks)) for brick in blocks.bricks(block))


def test_blocks_are_as_fine_as_they_may_be():
    assert len(Blocks((5, 5, 5))) == 125
    assert Blocks((16, 16, 16)).side == (4, 4, 3)
    assert len(Blocks((16, 16, 16))) == 96


def test_stages_report_median_redraw_and_count():
    now = [0.0]
    stages = Stages(keep=3, clock=lambda: now[0])
    for milliseconds in (100, 5, 1, 3):
        with stages.of("cut"):
            now[0] += milliseconds / 1000
        stages.looked()
    assert stages.milliseconds()["cut"] == pytest.approx(3)
    stages.count(bricks=2, chunks=1)
    stages.count(bricks=3)
    assert stages.take_counts() == {"moves": 0, "bricks": 5, "chunks": 1, "triangles": 0, "bytes": 0}
    assert not any(stages.take_counts().values())
    stages.add("draw", 0.5)
    stages.looked()
    assert stages.newest == {"cut": 0.0, "mesh": 0.0, "transfer": 0.0, "draw": 0.5}
    assert stages.per_look()["bricks"] == pytest.approx(5 / 3)  # of the three recorded updates
    assert not any(Stages().per_look().values())
    assert Stages().milliseconds() == dict.fromkeys(("cut", "mesh", "transfer", "draw"), 0.0)


def test_stages_report_how_long_the_hand_waits():
    stages = Stages(keep=3)
    assert stages.lag() == (0.0, 0.0)
    for seconds in (9.0, 0.02, 0.08, 0.03):
        stages.waited(seconds)
    assert stages.lag() == pytest.approx((30, 80))  # of the three recorded ones


def test_snapshots_that_undo_may_ask_for_are_kept():
    kept = Snapshots(most=3)
    for k in range(3):
        kept.put(f"a{k}", k)
    kept.put("b0", "b", replaces="a0")  # a0 was displayed until now: undo may ask for it next
    assert kept.get("a1") is None
    assert (kept.get("a0"), kept.get("a2"), kept.get("b0")) == (0, 2, "b")


def test_the_shown_state_is_never_dropped():
    kept = Snapshots(most=2)
    kept.put("other", "sculpt")
    kept.hold({"other"})
    for k in range(10):
        kept.put(f"a{k}", k, replaces=f"a{k - 1}")
    assert kept.get("other") == "sculpt" and kept.get("a9") == 9 and kept.get("a7") is None
    kept.clear()
    assert len(kept) == 0
