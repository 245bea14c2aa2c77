"""The displayed surface of a live sculpt: chunks, filled by a mesher of its volume."""

import riffler

from ..blender import versions
from ..common import blocks


class ShownSurface:
    """`chunks`: chunks.Chunks. `stages` measures the cost. Strokes add to `reached` and `masked` where material and
    mask may have changed since the last update: extents in rays."""

    def __init__(self, chunks, stages, mesher=None):
        self.chunks, self._stages, self._mesher = chunks, stages, mesher
        self._stale = False  # True if the mesher's state differs from the volume
        self.reached, self.masked = [], []

    @property
    def shape(self):
        """Shape of the lattice of bricks."""
        return tuple(self._mesher.shape)

    def outdate(self):
        """The volume was replaced, and the chunks show the new one already."""
        self._stale = True

    def mesher(self, volume):
        """riffler.Mesher of the current volume, made on demand: undo alone does not need it, the next stroke does."""
        if self._mesher is None:
            self._mesher = riffler.Mesher(volume)
        elif self._stale:
            self._mesher.update(volume)
        self._stale = False
        return self._mesher

    def show(self, volume, mask, place):
        """Meshes what has changed since the last update, and fills its chunks. `place`: matrix of the sculpt."""
        with self._stages.of("mesh"):
            mesher = self.mesher(volume)
            bricks = mesher.update(volume)
        for extent in self.masked:  # there the surface is the same, but not its colour
            bricks = sorted({*bricks, *blocks.within(mesher.shape, *extent)})
        bricks = self._with_borders(bricks)
        self.masked, self.reached = [], []
        with self._stages.of("transfer"):
            self.chunks.update(mesher, bricks, mask, self._stages)
            self.chunks.place(place)
        self._stages.looked()

    def _with_borders(self, bricks):
        """Adds bricks with unchanged triangles whose normals at the border to a changed one differ."""
        if not versions.OWN_NORMALS or not len(bricks):
            return bricks
        shape = self._mesher.shape
        swept = {brick for extent in self.reached for brick in blocks.within(shape, *extent)}
        return sorted({*bricks, *(swept & blocks.beside(shape, bricks))})

    def adopt(self, fillings, volume, mask):
        """Blender has restored the chunks' meshes after an undo; fills the rest."""
        stale = self.chunks.adopt(fillings)
        if stale:
            self.chunks.update(self.mesher(volume), stale, mask, self._stages)
