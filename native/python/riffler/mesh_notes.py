"""Sentences on repairs of a mesh and lost material, for the command line and Blender."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .results import LostReport, Orientation


def _count(n: int, one: str, many: str) -> str:
    return f"{n:,} {one if n == 1 else many}".replace(",", "\u2009")


def notes_on(report: Orientation | LostReport | Mapping[str, object]) -> list[str]:
    """Sentences on a report of `Mesh.orient_with_report`, `Volume.from_mesh_with_report`, `plan.analyse` or
    `Volume.to_mesh_with_report`: triangles and shells that were turned, repeated triangles, surfaces of one side,
    material thinner than the pitch."""
    facts: Mapping[str, Any] = report if isinstance(report, Mapping) else vars(report)
    notes = []
    if n := facts.get("turned", 0):
        notes.append(_count(n, "triangle faced", "triangles faced") + " opposite to those around: turned")
    if n := facts.get("turned_shells", facts.get("flipped_shells", 0)):
        notes.append(_count(n, "shell was", "shells were") + " inside out: turned outwards")
    if n := facts.get("left_out", 0):
        notes.append(_count(n, "repeated triangle", "repeated triangles") + " left out")
    if n := facts.get("one_sided", 0):
        notes.append(
            _count(n, "piece has", "pieces have")
            + " one side only, like a Möbius strip: what is inside is decided by winding numbers alone"
        )
    if note := facts.get("lost_note", ""):
        notes.append(note)
    return notes
