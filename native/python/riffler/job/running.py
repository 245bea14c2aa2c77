"""Runs a job: plans its operations in order on the in-process stock, then writes and verifies the program."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .. import _core, files, plan
from .._core import Finding, Mesh, Program, VerifyReport, Volume
from ..arguments import Progress
from ..formats import MESHES
from ..plan.setups import ROUNDING
from .model import Job, JobOperation
from .table import JobError

Step = Callable[[str], AbstractContextManager[Progress]]


@dataclass(frozen=True, eq=False)
class Done:
    """One computed operation. ``removed``: volume that it removes, mm³; ``left``: volume of the stock after it, mm³;
    ``seconds``: time of the computation."""

    job: JobOperation
    operation: plan.Operation
    removed: float
    left: float
    seconds: float


@dataclass(frozen=True, eq=False)
class Result:
    """The result of a job: see `riffler.job.run`.

    Attributes
    ----------
    setup : plan.Setup
        The set-up, with the stock that is left.
    stock : Volume
        The stock at the start of the job.
    operations : list of Done
        The computed operations, in order.
    program : Program
        The whole program, in the part's frame.
    report : VerifyReport
        Verification of the written file.
    deviation : tuple of Mesh and ndarray
        The remaining stock, and the distance of its vertices from the part, mm.
    warnings : list of str
        Departures from the job: operations without cuts, places that could not be reached.
    """

    setup: plan.Setup
    stock: Volume
    operations: list[Done]
    program: Program
    report: VerifyReport
    deviation: tuple[Mesh, np.ndarray] | None
    warnings: list[str] = field(default_factory=list)

    @property
    def seconds(self) -> float:
        """Machining time at the programmed feeds."""
        return sum(done.operation.report.time_s for done in self.operations)


@contextmanager
def _silent(name: str) -> Iterator[Progress]:
    yield None


def setup_of(job: Job) -> plan.Setup:
    """The set-up of a job. JobError if part, stock and machine do not fit together."""
    try:
        return plan.Setup(
            job.part,
            job.stock,
            job.fixtures,
            axis=job.axis,
            clearance=job.clearance,
            machine=job.machine,
            origin=job.zero,
        )
    except ValueError as error:
        raise JobError(f"{job.path.name}: {error}") from None


def run(job: Job, *, step: Step = _silent, write: bool = True) -> Result:
    """Computes a job and writes its program. Each operation is planned on the stock that the previous one leaves.

    The draft of the program is read again and verified on the stock. If the verification finds a fault, no file is
    written.

    Parameters
    ----------
    job : Job
        The job, as returned by ``read``.
    step : callable, optional
        Called with the name of each step; returns a context manager, in which the step runs. The manager yields a
        callable that takes the finished share, or None.
    write : bool
        Whether to write the job's files.

    Returns
    -------
    Result

    Raises
    ------
    JobError
        An operation or the verification failed. The message names the operation and its line in the file.

    Examples
    --------
    >>> from pathlib import Path
    >>> riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10).write("hill.stl")
    >>> tool = ["[[tool]]", "number = 1", 'kind = "flat"', "diameter = 6"]
    >>> operation = ["[[operation]]", 'kind = "rough"', "tool = 1"]
    >>> _ = Path("hill.toml").write_text(chr(10).join(['part = "hill.stl"', *tool, *operation]))
    >>> result = riffler.job.run(riffler.job.read("hill.toml"))
    >>> result.report.passed, Path("hill.ngc").exists()
    (True, True)
    """
    setup = setup_of(job)
    operations, warnings = [], list(job.notes)
    for one in job.operations:
        with step(one.name) as progress:
            operations.append(_run_one(setup, one, progress))
        warnings += _warnings(operations[-1])
    ops = [done.operation for done in operations]
    numbers = [done.job.tool.number for done in operations]
    with step("check") as progress:
        try:
            program = plan.program(setup, ops, numbers=numbers, progress=progress)
        except ValueError as error:
            raise JobError(_program_error(job, str(error))) from None
    program = _with_header(program, job)
    if not write:
        report = _verified(job, setup, _moved(program, job.zero), operations, None)
    else:
        with step("write"), files.drafting(job.program) as draft:
            report = _written(job, setup, program, operations, draft)
    deviation = report.stock_deviation()
    if write and job.left is not None:
        with files.drafting(job.left) as draft:
            left = setup.stock
            left.to_mesh(tolerance=left.pitch / 10).write(draft) if job.left.suffix in MESHES else left.save(draft)
    return Result(setup, job.stock, operations, _moved(program, job.zero), report, deviation, warnings)


def _run_one(setup: plan.Setup, one: JobOperation, progress: Progress) -> Done:
    start, before = time.perf_counter(), setup.stock.volume
    try:
        op = one.planner.run(setup, one.tool.tool, progress=progress, **one.options)
        setup.apply(op)
    except ValueError as error:
        raise one.failed(error) from None
    left = setup.stock.volume
    return Done(one, op, before - left, left, time.perf_counter() - start)


def _warnings(done: Done) -> list[str]:
    op, name = done.operation, done.job.name
    out = [] if len(op) else [f"{name}: it cuts nothing: {op.reason}"]
    for one in op.report.blocked:
        at = ", ".join(f"{x:.1f}" for x in one.place)
        length = f": {one.length:.1f} mm left out" if one.length else ""  # left-out areas have no length
        out.append(f"{name}: {one.reason}{length}, the first at ({at})")
    return out


def _program_error(job: Job, message: str) -> str:
    """The error of `plan.program` with the operation's name and line in place of its index."""
    head, _, rest = message.partition("]")
    index = head.removeprefix("operations[")
    if index.isdecimal() and int(index) < len(job.operations):
        one = job.operations[int(index)]
        return f"{one.table.where()} ({one.name}){rest}"
    return f"{job.path.name}: {message}"


def _with_header(program: Program, job: Job) -> Program:
    return Program(
        program.poses,
        program.feed,
        rapid=program.rapid,
        tool=program.tool,
        spindle=program.spindle,
        tools=program.tools,
        provenance={"job": job.name, "part": job.part_file.name},
    )


def _moved(program: Program, by: np.ndarray) -> Program:
    matrix = np.eye(4)
    matrix[:3, 3] = by
    return program.transformed(matrix)


def _written(job: Job, setup: plan.Setup, program: Program, operations: list[Done], draft: Path) -> VerifyReport:
    """Writes the program to a draft, reads it as the machine would, and verifies the program that was read."""
    tolerance = max(done.operation.tolerance for done in operations if len(done.operation))
    try:
        program.write(draft, post=job.machine, tolerance=0.1 * tolerance, options=job.machine_options or None)
        back = Program.read(draft, machine=job.machine, options=job.machine_options or None)
    except ValueError as error:
        raise JobError(f"{job.path.name}, [machine]: {error}") from None
    return _verified(job, setup, _moved(back, job.zero), operations, program.tools)


def _verified(
    job: Job, setup: plan.Setup, program: Program, operations: list[Done], tools: dict | None
) -> VerifyReport:
    ops = [(done.job.tool.number, done.operation) for done in operations if len(done.operation)]
    tolerance = max(op.tolerance for _, op in ops)
    engraved: dict[int, float] = {}
    for number, op in ops:
        engraved[number] = min(op.engraved, engraved.get(number, op.engraved))
    frame = np.eye(4)
    frame[:3, 3] = -job.zero

    def verified(deeper: float) -> VerifyReport:
        return _core.verify(
            program,
            job.stock,
            job.part,
            setup.obstacles,
            tools=tools,
            tolerance=tolerance,
            gouge_tolerance=1.1 * tolerance + deeper + ROUNDING,
            machine=job.machine,
            machine_options=job.machine_options or None,
            machine_frame=frame,
        )

    def is_meant(found: Finding) -> bool:
        return found.kind == "gouge" and found.value <= 1.1 * tolerance + engraved.get(found.tool, 0.0) + ROUNDING

    report = verified(0.0)
    if report.findings and all(map(is_meant, report.findings)):
        report = verified(max(engraved.values()))  # the report of what is not meant
    findings = [found for found in report.findings if not is_meant(found)]
    if findings:
        first = findings[0]
        at = ", ".join(f"{x:.3f}" for x in first.point)
        raise JobError(f"{job.program.name} not written: line {first.line}, at ({at}): {first.message}")
    return report
