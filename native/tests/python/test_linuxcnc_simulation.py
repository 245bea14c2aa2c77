"""The programs that LinuxCNC ships for its five-axis simulators, cut from a stock and compared with dense sampling."""

from itertools import pairwise

import numpy as np
import pytest
import riffler
from riffler_bench.swept import dense

import linuxcnc

pytestmark = linuxcnc.needed

DIAMETER, LENGTH, PITCH = 6.0, 60.0, 1.0
STEP = 0.2  # mm between sampled poses


def removed(points, poses):
    """Signed distance of points (n, 3) from the union of the ball cutter at poses (m, 6), negative inside."""
    radius, squares = DIAMETER / 2, np.full(len(points), np.inf)
    places = np.column_stack([points, np.ones(len(points))]).T
    lengths = (points**2).sum(axis=1)
    for tip, axis in zip(poses[:, :3], poses[:, 3:], strict=True):
        centre = tip + radius * axis
        up, away = np.array([[*axis, -axis @ centre], [*(-2 * centre), centre @ centre]]) @ places
        along = np.clip(up, 0, LENGTH - radius)  # the flat top end rounded: it stays above the stock
        np.minimum(squares, lengths + away - along * (2 * up - along), out=squares)
    return np.sqrt(np.maximum(squares, 0)) - radius


def in_material(volume, points):
    """Whether points on the volume's z rays are in material."""
    counts, spans = volume.intervals("z")
    ends = np.cumsum(counts.ravel()).reshape(counts.shape)
    i, j = np.round((points[:, :2] - volume.lower[:2]) / volume.pitch - 0.5).astype(int).T
    return np.array(
        [
            ((spans[ends[a, b] - counts[a, b] : ends[a, b]] - z) * [1, -1] <= 0).all(1).any()
            for a, b, z in zip(i, j, points[:, 2], strict=True)
        ]
    )


def on_rays(volume, n, rng):
    """Random points on the volume's z rays."""
    cells = np.round((volume.upper - volume.lower)[:2] / volume.pitch).astype(int)
    across = volume.lower[:2] + (np.column_stack([rng.integers(0, k, n) for k in cells]) + 0.5) * volume.pitch
    return np.column_stack([across, rng.uniform(volume.lower[2], volume.upper[2], n)])


def swept(program):
    """The poses of all motions in the part: a run of rows ends at a machine position."""
    whole = program.followed()
    away = np.asarray(whole.at_machine)
    ends = [0, *(np.flatnonzero(np.diff(away)) + 1).tolist(), len(whole)]
    runs = [whole.poses[a:b] for a, b in pairwise(ends) if not away[a] and b - a > 1]
    return np.concatenate([dense(run, STEP, STEP / 40)[0] for run in runs])


@pytest.mark.parametrize("name", ["boat-xyzac", "boat-xyzbc", "impeller-7bl-xyzac", "xyzac_switchkins"])
def test_a_stock_is_cut_as_the_cutter_at_all_poses_cuts_it(name):
    program = linuxcnc.demonstration(name)
    tips = program.poses[~program.rapid, :3]
    lower, upper = tips.min(0) - np.array([5, 5, 10]), tips.max(0) + np.array([5, 5, 0])
    stock = riffler.Volume.block(lower, lower + np.ceil((upper - lower) / PITCH) * PITCH, PITCH)
    tool = riffler.Tool.ball(DIAMETER, LENGTH)
    report = riffler.verify(program, stock, tools=dict.fromkeys(np.unique(program.tool).tolist(), tool))
    poses = swept(program)
    points = on_rays(stock, 4000, np.random.default_rng(90))
    near = poses[(np.abs(poses[:, :3] - (lower + upper) / 2) < (upper - lower) / 2 + DIAMETER).all(1)]
    distance = removed(points, near)
    clear = np.abs(distance) > 0.02  # the verification's tolerance and the sampling's scallops
    cut, left = distance < 0, in_material(report.volume, points)
    print(
        name, len(program), clear.mean(), cut[clear].mean(), (left == cut)[clear].sum(), len(near), report.removed.sum()
    )
    assert clear.mean() > 0.99 and 0.05 < cut.mean() < 0.5
    assert (left != cut)[clear].all()
    assert stock.volume - report.volume.volume == pytest.approx(report.removed.sum(), rel=1e-9)
