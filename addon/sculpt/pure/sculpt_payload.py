"""A sculpt's data in the .blend, as one block: its volume (the bytes of an .rvol file), its mask, and its cuts.

The header says whether other operations have shaped it, too; older add-ons ignore that.

Layout, little endian: magic (8 bytes), format version and header length (uint32 each), a JSON header, then the bytes of
the volume and of the mask, and the poses (float64) of every cut, in order. Blocks without a mask and with nothing but
cuts are of version 1, which older add-ons read. The content id is a hash of the whole block, so equal content has an
equal id and a damaged block is detected.
"""

from __future__ import annotations

import hashlib
import json
import struct

import numpy as np

from ...common import json_object
from ...common.job import Cut

MAGIC = b"RIFFLERB"
VERSION = 2
_HEAD = struct.Struct("<8sII")


def content_id(block: bytes) -> str:
    return hashlib.blake2b(block, digest_size=16).hexdigest()


def encode(volume: bytes, cuts: list[Cut], mask: bytes = b"", shaped: bool = False) -> bytes:
    rows = [{"tool": c.tool, "tolerance": c.tolerance, "rows": len(c.poses)} for c in cuts]
    header = {"volume": len(volume), "cuts": rows}
    version = 1
    if mask or any(c.mode != "remove" for c in cuts):
        version = 2
        header["mask"] = len(mask)
        for row, cut in zip(rows, cuts, strict=True):
            row["mode"] = cut.mode
    for row in (row for row, cut in zip(rows, cuts, strict=True) if cut.masked):
        row["masked"] = True
    if shaped:
        header["shaped"] = True
    text = json.dumps(header, separators=(",", ":"), ensure_ascii=False).encode()
    poses = [np.ascontiguousarray(c.poses, "<f8").tobytes() for c in cuts]
    return b"".join([_HEAD.pack(MAGIC, version, len(text)), text, volume, mask, *poses])


def decode(block: bytes, identity: str | None = None) -> tuple[memoryview, list[Cut], memoryview, bool]:
    """A view of the volume's bytes, the cuts, a view of the mask's bytes (empty: none), and whether other operations
    have shaped it. ValueError names the problem of a damaged block."""
    if identity is not None and content_id(block) != identity:
        raise ValueError("the sculpt's data in this .blend is damaged: its checksum does not match")
    if len(block) < _HEAD.size or block[:8] != MAGIC:
        raise ValueError("the sculpt's data in this .blend is not Riffler's: its header is another one")
    _, version, size = _HEAD.unpack_from(block)
    if not 1 <= version <= VERSION:
        raise ValueError(
            f"the sculpt's data has format {version}, and this Riffler reads up to {VERSION}: install a newer one"
        )
    try:
        header = json_object.loads(block[_HEAD.size : _HEAD.size + size], "its header")
        at = _HEAD.size + size
        masked = _count(header.get("mask", 0), "mask")
        wanted = at + _count(header["volume"], "volume") + masked
        wanted += sum(48 * _count(c["rows"], "rows") for c in header["cuts"])
        if wanted != len(block):
            raise ValueError(f"{wanted} bytes expected, {len(block)} found")
        volume = memoryview(block)[at : at + header["volume"]]
        at += header["volume"]
        mask = memoryview(block)[at : at + masked]
        at += masked
        cuts = []
        for c in header["cuts"]:
            poses = np.frombuffer(block, "<f8", 6 * c["rows"], at).reshape(-1, 6).copy()
            mode = c.get("mode", "remove")
            sound = isinstance(c["tool"], dict) and type(c["tolerance"]) in (int, float) and isinstance(mode, str)
            if not sound:
                raise ValueError(f"cut {len(cuts)}: a tool, a tolerance and a mode expected")
            cuts.append(Cut(c["tool"], poses, float(c["tolerance"]), mode, bool(c.get("masked"))))
            at += 48 * c["rows"]
    except (AttributeError, KeyError, OverflowError, TypeError, ValueError) as error:
        raise ValueError(f"the sculpt's data in this .blend is not whole: {error}") from error
    return volume, cuts, mask, bool(header.get("shaped"))


def _count(value, name: str) -> int:
    if type(value) is not int or value < 0:
        raise ValueError(f"{name}: a count expected")
    return value
