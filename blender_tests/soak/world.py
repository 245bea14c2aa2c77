"""The data in Blender that an operator must leave unchanged if it reports that it did nothing."""

import hashlib
from dataclasses import dataclass

import bpy

from support import common


@dataclass(frozen=True)
class World:
    sculpts: dict  # name → hash of volume and mask, count of cuts
    meshes: dict  # name of a sculpt → hash of its mesh: linked copies share one
    objects: tuple
    collections: tuple
    selected: tuple
    active: str

    def volumes(self):
        return dict(sorted(self.sculpts.items()))


def ours(thing):
    """True for objects that represent a live sculpt only."""
    chunks = common.part("sculpt.chunks")
    return chunks.MARK in thing or (getattr(thing, "data", None) is not None and chunks.MARK in thing.data)


def look():
    live, chunks, sculpts = (common.part(f"sculpt.{name}") for name in ("live_registry", "chunks", "sculpts"))
    selected = {ob.name for ob in bpy.context.view_layer.objects if ob.select_get() and not ours(ob)}
    for ob in bpy.data.objects:  # hidden during a session, and restored after it
        if live.of(ob) is not None and chunks.collection_of(ob.riffler.mark)["selected"]:
            selected.add(ob.name)
    found = [ob for ob in bpy.data.objects if sculpts.is_sculpt(ob)]
    active = bpy.context.view_layer.objects.active
    return World(
        {ob.name: _content(live.content(ob)) for ob in found},
        {ob.name: ob.data.name for ob in found},
        tuple(sorted(ob.name for ob in bpy.data.objects if not ours(ob))),
        tuple(sorted(c.name for c in bpy.data.collections if not ours(c))),
        tuple(sorted(selected)),
        active.name if active is not None else "",
    )


def _content(content):
    mask = content.mask.to_bytes() if content.mask is not None else b""
    return hashlib.sha256(content.volume.to_bytes() + b"/" + mask).hexdigest()[:16], len(content.cuts)
