"""Groups the bricks of a lattice into blocks: as fine as a maximal number of objects allows."""

from __future__ import annotations

MOST = 128  # objects: undo costs 0.08 ms for each (docs/decisions.md, decision 53)


def within(shape: tuple[int, int, int], low, high, side: int = 32) -> list[int]:
    """Bricks of `side` rays that a box reaches, from `low` to `high` in rays from the lattice's corner, with a margin
    of some rays, since surfaces are made across brick borders."""
    around = 2
    spans = [
        range(max(0, int((a - around) // side)), min(n, int((b + around) // side) + 1))
        for n, a, b in zip(shape, low, high, strict=True)
    ]
    _, ny, nz = shape
    return [(i * ny + j) * nz + k for i in spans[0] for j in spans[1] for k in spans[2]]


class Blocks:
    """Bricks (i, j, k) of a lattice of `shape`, numbered as in riffler.Mesher, grouped into cuboids."""

    def __init__(self, shape: tuple[int, int, int], most: int = MOST):
        self._shape = shape
        side = [1, 1, 1]
        while self._count(side) > most:
            # the shortest side that can grow grows, so that blocks stay as close to cubes as the lattice allows
            k = min((k for k in range(3) if side[k] < shape[k]), key=lambda k: (side[k], -shape[k]))
            side[k] += 1
        self.side = tuple(side)
        self._blocks = tuple(-(-n // s) for n, s in zip(shape, side, strict=True))

    def __len__(self) -> int:
        return self._blocks[0] * self._blocks[1] * self._blocks[2]

    def _count(self, side) -> int:
        a, b, c = (-(-n // s) for n, s in zip(self._shape, side, strict=True))
        return a * b * c

    def of(self, brick: int) -> int:
        """The block of a brick."""
        _, ny, nz = self._shape
        i, j, k = brick // nz // ny, brick // nz % ny, brick % nz
        a, b, c = (x // s for x, s in zip((i, j, k), self.side, strict=True))
        return (a * self._blocks[1] + b) * self._blocks[2] + c

    def bricks(self, block: int) -> list[int]:
        """The bricks of a block, ascending."""
        _, nb, nc = self._blocks
        first = [x * s for x, s in zip((block // nc // nb, block // nc % nb, block % nc), self.side, strict=True)]
        last = [min(f + s, n) for f, s, n in zip(first, self.side, self._shape, strict=True)]
        _, ny, nz = self._shape
        return [
            (i * ny + j) * nz + k
            for i in range(first[0], last[0])
            for j in range(first[1], last[1])
            for k in range(first[2], last[2])
        ]
