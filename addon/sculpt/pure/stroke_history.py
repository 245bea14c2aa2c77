"""riffler.History of a sculpt's kept strokes: follows the list of strokes by the fewest edits."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import riffler

from ...common.contents import Content
from ...common.job import Cut
from .stroke_curves import Chain


class Wanted(NamedTuple):
    """A chain of the list. `key` is unique and stays; another `mark` means another tool, path or mode."""

    key: tuple
    mark: str
    chain: Chain
    on: bool = True


class StrokeHistory:
    """The strokes on `base`, a Content without a mask, which nothing changes any more."""

    def __init__(self, base: Content):
        if base.mask is not None:
            raise ValueError("a history of strokes needs a base without a mask")
        self.base, self._history = base, riffler.History(base.volume)
        self._now: list[Wanted] = []
        self._ids: dict[tuple, int] = {}

    @property
    def volume(self):
        return self._history.volume

    @property
    def stats(self):
        """Statistics of the last edit."""
        return self._history.stats()

    def follow(self, wanted: list[Wanted]) -> list[Chain]:
        """Edits the history until it has these chains in this order. Returns the chains that were added, changed or
        removed. ValueError of a chain that cannot be carved; earlier edits stay, and the next call continues."""
        before, changed = {w.key: w for w in self._now}, []
        keys = {w.key for w in wanted}
        for old in [w for w in self._now if w.key not in keys]:
            self._history.remove(self._ids[old.key])
            del self._ids[old.key]
            self._now.remove(old)
            changed.append(old.chain)
        for k, new in enumerate(wanted):
            old = before.get(new.key)
            if old is None:
                changed.append(new.chain)
                self._insert(k, new)
                continue
            if self._now[k].key != new.key:
                self._history.move(self._ids[new.key], before=self._ids[self._now[k].key])
                self._now.remove(old)
                self._now.insert(k, old)
                changed.append(old.chain)
            if old.mark != new.mark:
                tool = riffler.Tool.from_dict(new.chain.tool)
                changed += [old.chain, new.chain]
                self._history.replace(self._ids[new.key], tool=tool, poses=new.chain.poses, mode=new.chain.mode)
                self._now[k] = new._replace(on=old.on)
            if old.on != new.on:
                changed.append(new.chain)
                self._history.enable(self._ids[new.key], new.on)
            self._now[k] = new
        return changed

    def _insert(self, k, new):
        tool, chain = riffler.Tool.from_dict(new.chain.tool), new.chain
        if k < len(self._now):
            at = self._ids[self._now[k].key]
            made = self._history.insert(tool, chain.poses, before=at, mode=chain.mode)
        else:
            made = self._history.add(tool, chain.poses, mode=chain.mode)
        self._ids[new.key] = made
        self._now.insert(k, new._replace(on=True))
        if not new.on:
            self._history.enable(made, False)
        self._now[k] = new

    def content(self) -> Content:
        """The result: its cuts are those of the base and of the enabled strokes of tools of revolution."""
        on = [w.chain for w in self._now if w.on]
        cuts = [Cut(c.tool, np.asarray(c.poses), mode=c.mode) for c in on if c.poses.shape[1] == 6]
        shaped = self.base.shaped or len(cuts) < len(on)
        return Content(self._history.volume, [*self.base.cuts, *cuts], None, shaped)
