"""Results of programs, machines, verifications, journals and sessions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .deprecated import DictResult

__all__ = [
    "JournalStock",
    "KeyChange",
    "MachineOption",
    "MachineTexts",
    "NearestContact",
    "PolePassage",
    "Trip",
    "VerifyStats",
    "WriteReport",
]


@dataclass(frozen=True)
class PolePassage(DictResult):
    """Rows near the singular direction of a machine, where small turns of the tool need large turns of its axes.

    Attributes
    ----------
    first_row, last_row : int
        Rows of the program.
    tool_degrees, rotary_degrees : float
        Angles by which the tool and the rotary axes turn there.
    slowed : float
        Time of the slowest block, as a multiple of its time at the programmed feed.
    """

    first_row: int
    last_row: int
    tool_degrees: float
    rotary_degrees: float
    slowed: float


@dataclass(frozen=True)
class WriteReport(DictResult):
    """Report of ``Program.write``.

    Attributes
    ----------
    blocks : int
        Number of blocks.
    slowed_blocks : int
        Blocks that take longer than at their feed.
    rewinds : list of int
        Rows at which the tool leaves the material because a limit makes an axis turn back.
    pole_passages : list of PolePassage
        Rows near the singular direction.
    """

    blocks: int
    slowed_blocks: int
    rewinds: list[int]
    pole_passages: list[PolePassage]


@dataclass(frozen=True)
class MachineOption(DictResult):
    """One option of a machine or of the code that is written for it.

    Attributes
    ----------
    name : str
        Key of the option in ``options``.
    kind : str
        "number", "positive", "numbers", "range" (two ascending numbers), "flag" (a bool), "word" or "path".
    count : int
        Largest count of numbers.
    unit : str
        "mm", "deg", "mm/min", "deg/min" or "".
    words : list of str
        The values of a word.
    value : float, bool, str, list or None
        Default value; None if there is none.
    needed : bool
        Whether the option is required.
    own : bool
        Whether the option comes from this machine's file; the others belong to many machines.
    about : str
        Description in one sentence.
    """

    name: str
    kind: str
    count: int
    unit: str
    words: list[str]
    value: float | bool | str | Sequence[float] | None
    needed: bool
    own: bool
    about: str


@dataclass(frozen=True)
class MachineTexts:
    """The texts of a machine's file.

    Attributes
    ----------
    description : str
        One line for lists.
    language : str
        The language that its control reads: "rs274", "heidenhain", …
    extension : str
        The usual extension of files in that language, with its dot.
    translations : dict
        By language code, such as "de": a dict from texts of the file and names of its options to their translations.

    Examples
    --------
    >>> riffler.machine_texts("head-head").translations["de"]["pivot_length"]
    'Pivotlänge'
    """

    description: str
    language: str
    extension: str
    translations: dict[str, dict[str, str]]


@dataclass(frozen=True)
class VerifyStats(DictResult):
    """Operation counts of a verification.

    Attributes
    ----------
    moves : int
        (move, slab) pairs that were cut.
    slabs, slabs_kept : int
        Slabs of the stock that were simulated, and those whose results were kept from the run before.
    snapshots_used : int
        Snapshots from which slabs started.
    probes, probed_moves, bisections : int
        Batches tried with shank and holder or on a fixture, moves in them, and bisections of such batches.
    skipped : int
        (move, slab) pairs whose boxes do not overlap.
    """

    moves: int
    slabs: int
    slabs_kept: int
    snapshots_used: int
    probes: int
    probed_moves: int
    bisections: int
    skipped: int


@dataclass(frozen=True, eq=False)
class NearestContact(DictResult):
    """The contact of a path that is nearest to a point or a ray.

    Attributes
    ----------
    index : int
        Number of the path's point.
    side : {0, 1}
        Number of the contact at that point.
    distance : float
        Distance of the contact from the point or ray, mm.
    point, normal : ndarray, shape (3,)
        The contact, mm, and the part's unit normal there.
    """

    index: int
    side: int
    distance: float
    point: NDArray[np.float64]
    normal: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class JournalStock(DictResult):
    """The stock of a journal.

    Attributes
    ----------
    lower, upper : ndarray, shape (3,)
        Corners of the stock's box, mm.
    pitch : float
        Distance between rays, mm.
    directions : str
        "z" or "xyz".
    snapshot : str
        Name of the file with the stock; empty for a full block.
    mask : str
        Name of the file with the protected region; empty if there is none.
    """

    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    pitch: float
    directions: str
    snapshot: str
    mask: str


@dataclass(frozen=True, eq=False)
class KeyChange:
    """Effect of a button press in an OrientSession.

    Examples
    --------
    >>> change = riffler.KeyChange(time=1.5, point=4, axis=(0, 0, 1), deleted=False, refused=None)
    >>> change.point
    4
    """

    time: float
    """Time since the start, s."""
    point: int
    """Point of the path, from 0."""
    axis: NDArray[np.float64]
    """(3,): axis of the key that was set or deleted."""
    deleted: bool
    """Whether the key was deleted."""
    refused: str | None
    """Why nothing was changed, or None."""


class Trip(NamedTuple):
    """One event in which a session removed the force."""

    time: float  #: s since the start
    state: str  #: state of the force from then on
    sentence: str  #: the reason and the remedy
    value: float  #: the measured value
