"""The pen: what it is, how its arms move, and how they share a force.

>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.forward([pen.home])  # one pose a row

Pens of your own are ``.toml`` files, given by path or found in the folders of ``RIFFLER_PENS``.
"""

from ._core import PenGeometry, _pens

__all__ = ["PenGeometry", "names"]


def names() -> dict[str, str]:
    """Every pen that has a name, with its description: those that come with riffler, then the user's own."""
    return _pens()
