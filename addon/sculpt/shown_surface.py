"""The displayed surface of a live sculpt: chunks, filled by a mesher of its volume.

The chunks have the triangles that the shape needs, or all of them, as surfaces.within says. With a mask they have all,
since faces show it. So a sculpt with its first mask, or without its last, is meshed and filled again as a whole.
"""

import math

import riffler

from ..blender import versions
from ..common import blocks
from . import surfaces


class ShownSurface:
    """`chunks`: chunks.Chunks. `stages` measures the cost. `within`: that of surfaces.within, without a mask. Strokes
    add to `masked` where the mask may have changed since the last update: extents in rays."""

    def __init__(self, chunks, stages, within, mesher=None):
        self.chunks, self._stages, self._within, self._mesher = chunks, stages, within, mesher
        self._stale = False  # True if the mesher's state differs from the volume
        self._refill = False  # True if the chunks were filled with more triangles than the mesher has, or with fewer
        self.masked = []

    @property
    def shape(self):
        """Shape of the lattice of bricks."""
        return tuple(self._mesher.shape)

    def outdate(self):
        """The volume was replaced, and the chunks show the new one already."""
        self._stale, self._refill = True, False

    def mesher(self, volume, mask):
        """riffler.Mesher of the current volume, made on demand: undo alone does not need it, the next stroke does."""
        tolerance = self._within if mask is None else None
        if self._mesher is None or self._mesher.tolerance != tolerance:
            self._refill = self._mesher is not None and not self._stale
            self._mesher = riffler.Mesher(volume, tolerance=tolerance)
        elif self._stale:
            self._mesher.update(volume)
        self._stale = False
        return self._mesher

    def show(self, volume, mask, place):
        """Meshes what has changed since the last update, and fills its chunks. `place`: matrix of the sculpt."""
        with self._stages.of("mesh"):
            mesher = self.mesher(volume, mask)
            bricks = mesher.update(volume, normals=versions.OWN_NORMALS)
        for extent in self.masked:  # there the surface is the same, but not its colour
            bricks = sorted({*bricks, *blocks.within(mesher.shape, *extent)})
        if self._refill:
            bricks = range(math.prod(mesher.shape))
        self.masked, self._refill = [], False
        with self._stages.of("transfer"):
            self.chunks.update(mesher, bricks, mask, self._stages)
            self.chunks.place(place)
        self._stages.looked()

    def adopt(self, fillings, volume, mask):
        """Blender has restored the chunks' meshes after an undo; fills the rest."""
        stale = self.chunks.adopt(fillings)
        if stale:
            self.chunks.update(self.mesher(volume, mask), stale, mask, self._stages)

    def whole(self, volume, mask):
        """The surfaces.Surface of it all, if the triangles are those that the shape needs; None: not known."""
        mesher = self.mesher(volume, mask)
        if mesher.tolerance is None:
            return None
        mesher.update(volume)
        return surfaces.of_mesher(mesher)
