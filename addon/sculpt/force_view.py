"""Force and torque on the tool while it cuts: two arrows at its tip, and two gauges with their limits.

Draw handlers exist only from `begin` to `end`.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy
import numpy as np

from ..blender import bars, batches, views
from ..common import glyphs, scale, units

FORCE, TORQUE, BEYOND = (0.98, 0.62, 0.12), (0.25, 0.62, 0.98), (0.95, 0.15, 0.12)
LENGTH, WIDTH = 140.0, 6.0  # pixels: length of an arrow at the limit, and width of its shaft
CORNER, BESIDE = (24.0, 60.0), 92.0  # pixels from the region's lower left, next to the toolbar; from gauge to gauge
TALL = 150.0  # pixels: a gauge with its title

kept = batches.Batches()
_in_views = views.InViews()
_shown = None


@dataclass
class Shown:
    """The displayed values; the caller of `begin` updates them."""

    limit: float  # N
    lever: float  # mm: torque is drawn as the force at this distance
    pose: np.ndarray | None = None  # (6,) mm
    force: np.ndarray = field(default_factory=lambda: np.zeros(3))
    torque: np.ndarray = field(default_factory=lambda: np.zeros(3))
    to_world: np.ndarray = field(default_factory=lambda: np.eye(4))

    @property
    def size(self):
        return float(np.linalg.norm(self.force))

    @property
    def moment(self):
        return float(np.linalg.norm(self.torque))


def begin(limit, lever, to_world):
    """A Shown to be updated by the caller, in place of an earlier one."""
    global _shown
    end()
    _shown = Shown(limit, lever, to_world=np.asarray(to_world, float))
    for draw, when in ((_draw_arrows, "POST_VIEW"), (_draw_gauges, "POST_PIXEL")):
        _in_views.add(draw, when)
    return _shown


def foot():
    """Pixels from the region's bottom, at a scale of 1, above which the gauges leave room for others."""
    return CORNER[1] + TALL if _shown is not None else 0.0


def end():
    global _shown
    _shown = None
    _in_views.clear()


def arrows(shown, pixel):
    """[(triangles (n, 3, 3) in world units, colour)]; `pixel`: a pixel's size there."""
    turn = shown.to_world[:3, :3]
    turn = turn / np.linalg.norm(turn[:, 0])
    tip = (shown.to_world @ np.append(shown.pose[:3], 1.0))[:3]
    out = []
    size = shown.size
    if size > 0:
        length = LENGTH * pixel * scale.share(size, 0, shown.limit)
        way = turn @ (shown.force / size) * length
        out.append((glyphs.arrow(tip, tip + way, WIDTH * pixel), FORCE if size <= shown.limit else BEYOND))
    if shown.moment > 0:
        share = scale.share(shown.moment, 0, shown.limit * shown.lever)
        bent = glyphs.arc_arrow(
            tip, turn @ shown.torque, 0.45 * LENGTH * pixel, 1.6 * np.pi * share, 0.7 * WIDTH * pixel
        )
        out.append((bent, TORQUE if share < 1 else BEYOND))
    return out


def _draw_arrows():
    shown, region = _shown, bpy.context.region_data
    if shown is None or shown.pose is None or region is None:
        return
    tip = (shown.to_world @ np.append(shown.pose[:3], 1.0))[:3]
    perspective = np.array(region.perspective_matrix)
    weight = abs(float(perspective[3] @ np.append(tip, 1.0)))
    pixel = 2 * weight / (np.linalg.norm(np.array(region.window_matrix)[0, :3]) * max(bpy.context.region.width, 1))
    towards = np.array(region.view_matrix)[:3, :3]
    signature = (shown.pose.tobytes(), shown.force.tobytes(), shown.torque.tobytes(), perspective.tobytes())
    with batches.state(depth="NONE"):
        for k, (triangles, colour) in enumerate(arrows(shown, pixel)):
            batch = kept.get(f"arrow {k}", signature, lambda t=triangles, c=colour: batches.shaded(t, c, towards))
            batches.draw(batch)


def gauges(shown):
    """The gauges of force and torque."""
    return (
        _gauge(shown.size, shown.limit, FORCE, f"{units.trim(shown.size, 2)} N"),
        _gauge(shown.moment, shown.limit * shown.lever, TORQUE, f"{units.trim(shown.moment, 1)} N·mm"),
    )


def _gauge(value, limit, colour, title):
    fill = colour if value <= limit else BEYOND
    return bars.Bar(title, 0.0, scale.ceiling(1.25 * limit), value=value, fill=(*fill, 1.0), limit=limit)


def _draw_gauges():
    if _shown is not None and bpy.context.region is not None:
        zoom = bpy.context.preferences.system.ui_scale
        toolbar = next((r.width for r in bpy.context.area.regions if r.type == "TOOLS"), 0)
        for k, gauge in enumerate(gauges(_shown)):
            place = toolbar + zoom * (CORNER[0] + k * BESIDE), zoom * CORNER[1]
            bars.draw(kept, gauge, place, zoom, f"gauge {k}")
