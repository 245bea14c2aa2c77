"""What was mended in a mesh, or lost of it, in sentences: for the command line and for Blender."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def _count(n: int, one: str, many: str) -> str:
    return f"{n:,} {one if n == 1 else many}".replace(",", "\u2009")


def notes_on(report: Mapping[str, Any]) -> list[str]:
    """Sentences on what `Mesh.oriented`, `Volume.from_mesh` or `Volume.to_mesh` put into ``report``: triangles and
    shells that were turned, repeated triangles, surfaces of one side, material thinner than the pitch."""
    notes = []
    if n := report.get("turned", 0):
        notes.append(_count(n, "triangle faced", "triangles faced") + " the other way than those around: turned")
    if n := report.get("turned_shells", report.get("flipped_shells", 0)):
        notes.append(_count(n, "shell was", "shells were") + " inside out: turned outwards")
    if n := report.get("left_out", 0):
        notes.append(_count(n, "repeated triangle", "repeated triangles") + " left out")
    if n := report.get("one_sided", 0):
        notes.append(
            _count(n, "piece has", "pieces have")
            + " one side only, like a Möbius strip: what is inside is decided by winding numbers alone"
        )
    if note := report.get("lost_note", ""):
        notes.append(note)
    return notes
