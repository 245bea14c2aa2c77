"""Volumes in memory by content id.

Undo and redo bring back a sculpt's datablock with its id; the volume of that id is either still here (volumes share
their unchanged tiles, so keeping the last ones costs little) or is read from the block again. Nothing refers to a
Blender object, so nothing can go stale.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from typing import Any


@dataclass
class Content:
    """A volume that nobody changes any more, and the cuts that made it."""

    volume: Any
    cuts: list = field(default_factory=list)


class ContentCache:
    def __init__(self, count: int = 32, nbytes: int = 2_000_000_000):
        self._count, self._nbytes = count, nbytes
        self._items: OrderedDict[str, Content] = OrderedDict()

    def __len__(self) -> int:
        return len(self._items)

    def get(self, identity: str) -> Content | None:
        content = self._items.get(identity)
        if content is not None:
            self._items.move_to_end(identity)
        return content

    def put(self, identity: str, content: Content) -> None:
        self._items[identity] = content
        self._items.move_to_end(identity)
        # The sum counts shared tiles once per volume: too much, so the limit errs on the small side.
        while len(self._items) > 1 and (
            len(self._items) > self._count or sum(c.volume.nbytes for c in self._items.values()) > self._nbytes
        ):
            self._items.popitem(last=False)

    def clear(self) -> None:
        self._items.clear()
