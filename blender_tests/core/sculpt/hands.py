"""A hand with a mouse as Blender receives it: whole pixels, 125 times a second; and a live sculpt without Blender."""

import numpy as np
import riffler

RATE = 125  # Hz: rate of a mouse


class Run:
    """A live sculpt without Blender."""

    def __init__(self, volume):
        self.volume = volume
        self.mesher = riffler.Mesher(volume)
        self.log = []
        self.way = []  # poses of all pieces

    def freeze(self):
        return self.mesher.freeze()

    def show(self):
        self.mesher.update(self.volume)
        self.log.append("show")

    def carve(self, tool, poses, dt=None, mode="remove", new=True):
        self.log.append((mode, new, len(poses)))
        self.poses = poses
        self.way.append(poses if new else poses[1:])
        if mode not in ("remove", "add"):
            return None
        return self.volume.carve(tool, poses, dt=dt, mode=mode)


def way(start, angle, length, bend, speed):
    """Pixels (n, 2) and seconds (n,) of a hand, eight places between two samples: it starts at `angle` (rad), at a
    speed (pixels a second) that rises and falls like a hand's, and turns by `bend` (rad) and back."""
    steps = 8 * RATE
    seconds = np.arange(0, 3 * length / speed, 1 / steps)
    pace = speed * (1 + 0.4 * np.sin(4.4 * seconds))
    along = np.cumsum(pace) / steps
    heading = angle + bend * np.sin(2 * np.pi * along / length)
    steps_to = np.stack([np.cos(heading), np.sin(heading)], axis=1) * (pace / steps)[:, None]
    end = np.searchsorted(along, length)
    return (start + np.cumsum(steps_to, axis=0))[:end], seconds[:end]


def samples(places, seconds):
    """Blender's events of that: rows x, y, pressure, tilts, time, where the mouse has moved to another pixel."""
    told = np.round(places[::8])
    moved = np.r_[True, (np.diff(told, axis=0) != 0).any(axis=1)]
    return [(x, y, 1.0, 0.0, 0.0, t) for (x, y), t in zip(told[moved], seconds[::8][moved], strict=True)]
