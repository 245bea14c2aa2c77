"""Converts planned operations to bytes for the .blend, and back.

The bytes are a file in numpy's format npz: the arrays of every operation, and one JSON text with the other data.
"""

from __future__ import annotations

import io
import json
import zipfile
import zlib
from collections.abc import Iterable
from typing import Any

import numpy as np
import riffler
from riffler.plan import Blocked, Operation, OperationReport

from ...common import json_object

VERSION = 1
DAMAGED = "the job's data in this .blend is damaged: use Calculate again"


def encode(operations: Iterable[tuple[str, Operation]]) -> bytes:
    """The bytes of operations with their keys."""
    arrays: dict[str, np.ndarray] = {}
    rows = []
    for k, (key, op) in enumerate(operations):
        arrays |= {f"poses{k}": op.poses, f"kind{k}": op.kind, f"feed{k}": op.feed}
        rows.append({"key": key, **_facts(op)})
    text = json.dumps({"version": VERSION, "operations": rows})
    out = io.BytesIO()
    np.savez_compressed(out, facts=np.frombuffer(text.encode(), np.uint8), **arrays)
    return out.getvalue()


def decode(block: bytes) -> list[tuple[str, Operation]]:
    """The operations with their keys. ValueError if the bytes hold no operations."""
    try:
        with np.load(io.BytesIO(block), allow_pickle=False) as file:
            facts = json_object.loads(file["facts"].tobytes(), "the job")
            if facts.get("version") != VERSION:
                raise ValueError(f"the job's data is of version {facts.get('version')}: update Riffler")
            return [
                (row["key"], _operation(row, file[f"poses{k}"], file[f"kind{k}"], file[f"feed{k}"]))
                for k, row in enumerate(facts["operations"])
            ]
    except (KeyError, TypeError, OSError, EOFError, AttributeError, zipfile.BadZipFile, zlib.error) as error:
        raise ValueError(f"{DAMAGED} ({error})") from error


def _facts(op: Operation) -> dict[str, Any]:
    report = op.report
    blocked = [{"reason": b.reason, "place": [float(x) for x in b.place], "length": b.length} for b in report.blocked]
    return {
        "tool": op.tool.to_dict(),
        "reason": op.reason,
        "spindle": op.spindle,
        "tolerance": op.tolerance,
        "engraved": op.engraved,
        "time_s": report.time_s,
        "cut_mm": report.cut_mm,
        "air_mm": report.air_mm,
        "largest_engagement": report.largest_engagement,
        "blocked": blocked,
        "stats": dict(report.stats),
    }


def _operation(row: dict[str, Any], poses: np.ndarray, kind: np.ndarray, feed: np.ndarray) -> Operation:
    if poses.ndim != 2 or poses.shape[1] != 6 or not len(poses) == len(kind) == len(feed):
        raise ValueError(DAMAGED)
    blocked = tuple(Blocked(b["reason"], np.array(b["place"], float), b["length"]) for b in row["blocked"])
    report = OperationReport(
        row["time_s"], row["cut_mm"], row["air_mm"], row["largest_engagement"], blocked, row["stats"]
    )
    tool = riffler.Tool.from_dict(row["tool"])
    engraved = row.get("engraved", 0.0)  # absent in files of older versions
    return Operation(poses, kind, feed, tool, report, row["reason"], row["spindle"], row["tolerance"], engraved)
