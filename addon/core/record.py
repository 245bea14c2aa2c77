"""What a sculpt keeps in the .blend: its volume (the bytes of an .rvol file) and the cuts that made it, as one block.

Layout, little endian: magic (8 bytes), format version and header length (uint32 each), a JSON header, then the volume's
bytes and every cut's poses (float64) in order. The content id is a hash of the whole block, so equal content has an
equal id and a block that was damaged does not pass for what was written.
"""

from __future__ import annotations

import hashlib
import json
import struct

import numpy as np

from .job import Cut

MAGIC = b"RIFFLERB"
VERSION = 1
_HEAD = struct.Struct("<8sII")


def content_id(block: bytes) -> str:
    return hashlib.blake2b(block, digest_size=16).hexdigest()


def encode(volume: bytes, cuts: list[Cut]) -> bytes:
    rows = [{"tool": c.tool, "tolerance": c.tolerance, "rows": len(c.poses)} for c in cuts]
    header = {"volume": len(volume), "cuts": rows}
    text = json.dumps(header, separators=(",", ":"), ensure_ascii=False).encode()
    poses = [np.ascontiguousarray(c.poses, "<f8").tobytes() for c in cuts]
    return b"".join([_HEAD.pack(MAGIC, VERSION, len(text)), text, volume, *poses])


def decode(block: bytes, identity: str | None = None) -> tuple[memoryview, list[Cut]]:
    """A view of the volume's bytes, and the cuts. ValueError says what is wrong with a block that is not whole."""
    if identity is not None and content_id(block) != identity:
        raise ValueError("the sculpt's data in this .blend is damaged: its checksum is another one")
    if len(block) < _HEAD.size or block[:8] != MAGIC:
        raise ValueError("the sculpt's data in this .blend does not begin as Riffler's does")
    _, version, size = _HEAD.unpack_from(block)
    if version != VERSION:
        raise ValueError(
            f"the sculpt's data has format {version}, and this Riffler reads {VERSION}: install a newer one"
        )
    try:
        header = json.loads(block[_HEAD.size : _HEAD.size + size])
        at = _HEAD.size + size
        wanted = at + header["volume"] + sum(48 * c["rows"] for c in header["cuts"])
        if wanted != len(block):
            raise ValueError(f"{wanted} bytes expected, {len(block)} found")
        volume = memoryview(block)[at : at + header["volume"]]
        at += header["volume"]
        cuts = []
        for c in header["cuts"]:
            poses = np.frombuffer(block, "<f8", 6 * c["rows"], at).reshape(-1, 6).copy()
            cuts.append(Cut(c["tool"], poses, c["tolerance"]))
            at += 48 * c["rows"]
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"the sculpt's data in this .blend is not whole: {error}") from error
    return volume, cuts
