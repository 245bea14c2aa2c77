"""Plans a job's operations in order, each on the stock that the previous one leaves."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import riffler
from riffler.plan import Operation

from ...common import units
from .operation_kinds import KINDS

APPLIED = 0.1  # share of an operation's progress for cutting the in-process stock
CHECKED = 0.1  # share of the whole progress for simulating the program


@dataclass(frozen=True)
class Wanted:
    """An operation to plan: kind, tool in the form of riffler.Tool.to_dict, and settings."""

    name: str
    kind: str
    tool: Mapping[str, Any]
    options: Mapping[str, Any]

    def plan(self, setup: riffler.plan.Setup, progress: Callable[[float], bool] | None = None) -> Operation:
        tool = riffler.Tool.from_dict(dict(self.tool))
        return KINDS[self.kind].plan(setup, tool, **self.options, progress=progress)


def keys_of(base: str, wanted: Sequence[Wanted]) -> list[str]:
    """A key for each operation, from `base` and all operations up to this one. Equal keys mean equal results."""
    out = []
    for one in wanted:
        text = json.dumps([base, one.kind, one.tool, one.options], sort_keys=True)
        base = hashlib.blake2b(text.encode(), digest_size=16).hexdigest()
        out.append(base)
    return out


@dataclass(frozen=True)
class JobResult:
    """The result of `calculate`. `operations`: keys and operations, in order; `problem`: why further operations are
    missing, or why the program must not run; `program`: the whole program in the set-up's frame, if it may run."""

    operations: tuple[tuple[str, Operation], ...]
    problem: str = ""
    program: riffler.Program | None = None


def calculate(
    setup: riffler.plan.Setup,
    wanted: Sequence[Wanted],
    keys: Sequence[str],
    known: Mapping[str, Operation],
    progress: Callable[[float], bool],
) -> JobResult:
    """Plans the operations whose keys are not in `known`, each on the stock that the previous ones leave, and simulates
    the program of all operations."""
    done: list[tuple[str, Operation]] = []
    share = (1 - CHECKED) / max(1, len(wanted))
    for k, (one, key) in enumerate(zip(wanted, keys, strict=True)):
        begin = k * share
        try:
            op = known.get(key)
            if op is None:
                op = one.plan(setup, lambda s, b=begin: progress(b + (1 - APPLIED) * share * s))
            setup.apply(op, lambda s, b=begin: progress(b + share * (1 - APPLIED + APPLIED * s)))
        except ValueError as error:
            return JobResult(tuple(done), f"{one.name}: {error}")
        done.append((key, op))
    if not any(len(op) for _, op in done):
        return JobResult(tuple(done))
    try:
        program = checked(setup, wanted, [op for _, op in done], lambda s: progress(1 - CHECKED + CHECKED * s))
    except ValueError as error:
        return JobResult(tuple(done), str(error))
    return JobResult(tuple(done), "", program)


def checked(
    setup: riffler.plan.Setup,
    wanted: Sequence[Wanted],
    operations: Sequence[Operation],
    progress: Callable[[float], bool] | None = None,
) -> riffler.Program:
    """The program of applied operations, simulated on the stock. ValueError naming the operation if it must not run."""
    try:
        return riffler.plan.program(setup, operations, progress=progress)
    except ValueError as error:
        text = str(error)
        for k, one in enumerate(wanted):
            text = text.replace(f"operations[{k}]", one.name)
        raise ValueError(text) from None


def said(op: Operation) -> str:
    """A sentence on what an operation leaves undone, or ""."""
    if not len(op):
        return op.reason
    if not op.report.blocked:
        return ""
    first = op.report.blocked[0]
    at = ", ".join(units.trim(float(x), 1) for x in first.place)
    count = units.counted(len(op.report.blocked), "place")
    return f"{count} not reached, the first at ({at}): {first.reason}"
