"""Raises pictures on a sculpt or engraves them."""

from dataclasses import replace

import bpy
import numpy as np
import riffler
from bpy.props import StringProperty
from riffler import shape

from ..blender import scene_units
from ..common import units
from ..common.job import PiecesJob
from ..sculpt.sculpt_work import SculptWork
from ..translations import local
from . import object_volumes, properties
from .pure import relief_heights

BANDS, OTHERS = 8, 6  # number of pieces of the search for the surface; and of all other work
FINEST = 1500  # places along a side: more than the rays can resolve would be wasted
SLIGHT = 0.01  # pitches: invisible amount clipped by the box
REACH = 2.0  # pitches by which a relief overlaps the material it joins


class RIFFLER_OT_relief(properties.ReliefSettings, SculptWork, bpy.types.Operator):
    """Raise a picture on the sculpt, or engrave it: light areas are high, or deep"""

    bl_idname = "riffler.relief"
    bl_label = "Emboss Picture"
    doing = "Embossing"
    cancelled = "Not embossed: the sculpt is unchanged"

    image: StringProperty(name="Picture", description="Name of an image in this file")
    place: StringProperty(
        name="Place", description="Object whose local plane z = 0 holds the picture, seen from its +z side"
    )

    def begin(self, context):
        ob, self._before = self.take(context)
        image = bpy.data.images.get(self.image)
        if image is None:
            raise ValueError("choose a picture" if not self.image else f"there is no picture {self.image!r}")
        place = object_volumes.chosen(
            context, self.place, {"MESH", "EMPTY"}, "a place for the picture, a plane or an empty,"
        )
        # Blender's data is read now; the work itself does not access it
        pieces = self._form(
            self._before.volume, object_volumes.pixels(image), object_volumes.axes(ob, place), place.name
        )
        return PiecesJob(pieces, BANDS + OTHERS)

    def finish(self, context, job):
        before, form = self._before, job.result
        volume = before.volume.copy()
        if before.mask is not None:
            form.subtract(before.mask)
        volume.add(form) if self.mode == "RAISE" else volume.subtract(form)
        self.keep(replace(before, volume=volume, shaped=True))
        self._tell_change(abs(volume.volume - before.volume.volume))
        return {"FINISHED"}

    def _tell_change(self, changed):
        if self.mode == "RAISE" and not changed:
            why = "the stock's box is full there, or protected. Engrave the picture inverted, or use Grow Box"
            self.report({"WARNING"}, f"Nothing was added: {why}")
            return
        if self._cut_off:
            self.report(
                {"WARNING"}, local("The picture was cut off at the stock's box: use Grow Box in Clay to enlarge it")
            )
        what = "Added" if self.mode == "RAISE" else "Removed"
        self.report({"INFO"} if changed > 0 else {"WARNING"}, f"{what} {units.format_volume(changed)}")

    def _form(self, volume, pixels, axes, place):
        """Makes the material to add or remove, a volume, in pieces (PiecesJob)."""
        heights = relief_heights.luminance(pixels)
        yield
        heights = 1 - heights if self.invert else heights
        width, depth = scene_units.clean(self.width), scene_units.clean(self.depth)
        points, up = _grid(axes, np.array([width, width * heights.shape[0] / heights.shape[1]]), volume.pitch)
        heights = relief_heights.fitted(heights, points.shape[1], points.shape[0]).T
        yield
        found = np.ones(points.shape[:2], bool)
        if self.follow:
            points, found = yield from _dropped(volume, points, up)
            if not found.any():
                raise ValueError(f"the picture's place, {place}, does not lie over the sculpt")
        yield
        raised = 1.0 if self.mode == "RAISE" else -1.0
        top, bottom, cells = relief_heights.draped(points, found, up, heights, raised * depth, REACH * volume.pitch)
        self._cut_off = self.mode == "RAISE" and relief_heights.leaves(
            top, heights * depth, volume.lower, volume.upper, SLIGHT * volume.pitch
        )
        if not cells.any():
            raise ValueError("the sculpt falls too steeply under the picture: turn its place")
        yield
        surface = shape.slab(top, bottom, cells=cells)
        form = yield object_volumes.task_of(surface, volume)
        return form

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop_search(self, "image", bpy.data, "images")
        layout.prop_search(self, "place", bpy.data, "objects")
        for key in properties.ReliefSettings.__annotations__:
            layout.prop(self, key)


def _grid(axes, size, pitch):
    """Places of a picture of that size in the plane of `axes` (object_volumes.axes), (right, up, 3) mm in the sculpt's
    frame, and its unit normal."""
    origin, right, top, up = axes
    count = np.clip(np.ceil(size / (0.5 * pitch)).astype(int) + 1, 2, FINEST)
    x, y = (np.linspace(-0.5 * s, 0.5 * s, n) for s, n in zip(size, count, strict=True))
    return origin + x[:, None, None] * right + y[None, :, None] * top, up


def _dropped(volume, points, up):
    """The places projected onto the volume's surface, seen from above, and which of them hit it. Yields."""
    surface = riffler.Mesher(volume).freeze()
    yield
    far = float(np.linalg.norm(volume.upper - volume.lower)) + float(np.abs(points).max())
    bands = []
    for some in np.array_split(points.reshape(-1, 3), BANDS):
        origins = some + far * up
        distance, *_ = surface.pick(origins, np.tile(-up, (len(origins), 1)))
        bands.append(origins - np.where(np.isfinite(distance), distance, np.nan)[:, None] * up)
        yield
    places = np.vstack(bands).reshape(points.shape)
    return places, np.isfinite(places).all(axis=2)


CLASSES = (RIFFLER_OT_relief,)
