"""Cutter locations are kept for keys that come back, and for no others."""

from dataclasses import dataclass, field

import numpy as np

from addon.plan.pure.resolved import Resolved


@dataclass
class Path:
    centres: np.ndarray
    keys: dict = field(default_factory=dict)
    closed: bool = False
    interpolation: str = "smooth"


LINE, UP, LEANING = np.arange(12.0).reshape(4, 3), np.array((0, 0, 1.0)), np.array((0, 0.6, 0.8))


def test_only_the_same_path_with_the_same_keys_and_surroundings_is_found():
    kept, path, rows = Resolved(), Path(LINE, {0: UP}), np.ones((4, 6))
    kept.put(0, path, rows, "mark")
    assert kept.get(0, Path(LINE, {0: LEANING}), {0: UP + 1e-8}, "mark") == (path, rows)
    assert kept.get(0, Path(LINE, {}, interpolation=""), {0: UP}, "mark") == (path, rows)  # it has no key yet
    for number, other, wanted, mark in (
        (1, path, {0: UP}, "mark"),
        (0, path, {0: UP}, "other"),
        (0, path, {0: LEANING}, "mark"),
        (0, path, {1: UP}, "mark"),
        (0, path, {0: UP, 1: UP}, "mark"),
        (0, Path(LINE + 1), {0: UP}, "mark"),
        (0, Path(LINE[:3]), {0: UP}, "mark"),
        (0, Path(LINE, closed=True), {0: UP}, "mark"),
        (0, Path(LINE, interpolation="slerp"), {0: UP}, "mark"),
    ):
        assert kept.get(number, other, wanted, mark) is None


def test_only_programs_are_kept_and_the_oldest_is_dropped():
    kept = Resolved(count=2, nbytes=1000)
    for rows, mark in ((None, "mark"), (np.empty((0, 6)), "mark"), (np.ones((4, 6)), None)):
        kept.put(0, Path(LINE, {0: UP}), rows, mark)
    assert len(kept) == 0
    paths = [Path(LINE, {k: UP}) for k in range(3)]
    for path in paths:
        kept.put(0, path, np.ones((4, 6)), "mark")  # 192 bytes
    kept.put(0, paths[1], np.zeros((4, 6)), "mark")
    assert len(kept) == 2 and kept.get(0, paths[0], paths[0].keys, "mark") is None
    assert not kept.get(0, paths[0], paths[1].keys, "mark")[1].any()
    kept.put(0, paths[0], np.ones((30, 6)), "mark")  # 1440: the newest alone
    assert len(kept) == 1 and kept.get(0, paths[1], paths[0].keys, "mark")
