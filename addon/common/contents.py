"""Volumes in memory by content id.

Undo and redo restore a sculpt's datablock with its id. The volume of that id is either still in this cache (volumes
share their unchanged tiles, so keeping the last ones costs little), or is read from the datablock again. Nothing refers
to a Blender object, so nothing can go stale.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from typing import Any


@dataclass
class Content:
    """A volume that no longer changes, and the cuts that made it; the mask, a volume on the same grid, or None.
    `shaped`: other operations than cuts have changed it, too; False if unknown."""

    volume: Any
    cuts: list = field(default_factory=list)
    mask: Any = None
    shaped: bool = False

    @property
    def nbytes(self) -> int:
        return self.volume.nbytes + (self.mask.nbytes if self.mask is not None else 0)

    def copy(self) -> Content:
        """A copy with volumes and a list of cuts of its own."""
        mask = None if self.mask is None else self.mask.copy()
        return Content(self.volume.copy(), list(self.cuts), mask, self.shaped)

    def differs(self, volume, mask) -> bool:
        """Whether the volume or the mask has another revision than this one's."""
        return _revision(self.volume) != _revision(volume) or _revision(self.mask) != _revision(mask)


def _revision(volume):
    return None if volume is None else volume.revision


class ContentCache:
    """A cache of objects with `nbytes`; those used last stay."""

    def __init__(self, count: int = 32, nbytes: int = 2_000_000_000):
        self._count, self._nbytes = count, nbytes
        self._items: OrderedDict[str, Any] = OrderedDict()

    def __len__(self) -> int:
        return len(self._items)

    def get(self, identity: str):
        content = self._items.get(identity)
        if content is not None:
            self._items.move_to_end(identity)
        return content

    def put(self, identity: str, content) -> None:
        self._items[identity] = content
        self._items.move_to_end(identity)
        # The sum counts shared tiles once per volume. That overestimates, so the cache stays below its limit.
        while len(self._items) > 1 and (
            len(self._items) > self._count or sum(c.nbytes for c in self._items.values()) > self._nbytes
        ):
            self._items.popitem(last=False)

    def clear(self) -> None:
        self._items.clear()


class Snapshots:
    """States between two packings, which only this session of Blender has, by the token on the object.

    Blender's undo may ask for each state that was shown within its last steps. A state's age counts from the moment
    when another state replaced it, not from its making: a sculpt that rested for a hundred strokes on another one can
    still be undone.
    """

    def __init__(self, most: int = 34):
        self.most = most
        self._items: OrderedDict[str, Any] = OrderedDict()
        self._held: set[str] = set()

    def __len__(self) -> int:
        return len(self._items)

    def get(self, token: str) -> Any:
        return self._items.get(token)

    def hold(self, tokens: set[str]) -> None:
        """The state shown now, which is not dropped."""
        self._held = set(tokens)

    def put(self, token: str, state: Any, replaces: str = "") -> None:
        if replaces in self._items:
            self._items.move_to_end(replaces)
        self._items[token] = state
        self._items.move_to_end(token)
        free = [t for t in self._items if t not in self._held and t != token]
        for old in free[: max(0, len(self._items) - self.most)]:
            del self._items[old]

    def clear(self) -> None:
        self._items.clear()
        self._held.clear()
