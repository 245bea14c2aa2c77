"""Volumes as bytes."""

import tempfile
from pathlib import Path

import riffler


def to_bytes(volume):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "volume.rvol"
        volume.save(path)
        return path.read_bytes()


def from_bytes(block):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "volume.rvol"
        path.write_bytes(block)
        return riffler.Volume.load(path)
