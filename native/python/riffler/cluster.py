"""Verification on a Dask cluster: free workers simulate slabs of the stock.

The report has the same bytes as that of ``riffler.verify``. The cluster's machines need the same version of riffler
and nothing else of the job: each slab travels with its material, its share of the part and the moves that can touch it.
"""

from __future__ import annotations

import os
import queue
import time
import uuid
from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ._core import (
    Cancelled,
    FormatError,
    Mesh,
    Program,
    SlabWorker,
    Tool,
    VerifyPlan,
    VerifyReport,
    Volume,
    __version__,
)

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["verify"]

MOVES = 1 << 18  # per task, about: 60 MB on the worker; a slab with more moves runs in several tasks
PER_THREAD = 2  # slabs in the cluster for each thread of a worker: one runs and one waits
# A slab may start this many times the cluster's number of slabs ahead of the first unfinished one. The results in
# between stay in memory.
AHEAD = 8
PATIENCE = 5.0  # s: longest wait for the scheduler, and for a first worker
WITHOUT_WORKERS = 60.0  # s: longest wait for a new worker after the last one has died
RETRIES = 2  # of a task that fails; Dask itself moves the tasks of a worker that dies
# A function of the standard library, so that a worker without riffler can report this.
VERSION_OF = "__import__('riffler').__version__"


def verify(
    program: Program | Iterable[Program],
    stock_volume: Volume,
    part_mesh: Mesh | None = None,
    fixtures: Iterable[Volume | Mesh] = (),
    *,
    scheduler: str | Client,
    tools: dict[int, Tool] | None = None,
    tolerance: float = 0.01,
    gouge_tolerance: float = 0.05,
    rest_tolerance: float | None = None,
    rapid_feed: float = 10000.0,
    machine: str | None = None,
    machine_options: Mapping[str, float | bool | str | Sequence[float]] | None = None,
    progress: Callable[[float], object] | None = None,
) -> VerifyReport:
    """``riffler.verify`` on a cluster: same arguments, same report, same bytes.

    Moves wait in a temporary file (TMPDIR); 24 bytes a row of the program stay in memory. If a worker dies, Dask gives
    its slabs to another one. After an error, Ctrl-C, or a ``progress`` that raises or returns False, nothing is left on
    the cluster.

    Parameters
    ----------
    program : Program, or an iterable of Programs
        As for `riffler.verify`.
    stock_volume : Volume
        As for `riffler.verify`.
    part_mesh : Mesh or None
        As for `riffler.verify`.
    fixtures : list of Volume or Mesh
        As for `riffler.verify`.
    scheduler : str or distributed.Client
        The address of a Dask scheduler, such as "tcp://host:8786", or a client of one.
    tools : dict of int to Tool, or None
        As for `riffler.verify`.
    tolerance, gouge_tolerance : float, mm
        As for `riffler.verify`.
    rest_tolerance : float, mm, or None
        As for `riffler.verify`.
    rapid_feed : float, mm/min
        As for `riffler.verify`.
    machine : str or None
        As for `riffler.verify`.
    machine_options : dict or None
        As for `riffler.verify`.
    progress : callable or None
        Called with the finished share; returning False cancels.

    Returns
    -------
    VerifyReport
        The same bytes as from `riffler.verify`.

    Raises
    ------
    ConnectionError
        If there is no scheduler or no worker.
    RuntimeError
        If a worker has another version of riffler, or none; names the worker.
    ValueError
        As for `riffler.verify`, and if the package distributed is missing.
    Cancelled
        ``progress`` returned False.

    Examples
    --------
    >>> import distributed
    >>> tool = riffler.Tool.ball(6, 30)
    >>> passes = [[-5, 5, 8, 0, 0, 1], [25, 5, 8, 0, 0, 1]]
    >>> program = riffler.Program.from_cl([passes], tools=[tool], feed=600, spindle=9000)
    >>> stock = riffler.Volume.block((0, 0, 0), (20, 10, 10), pitch=0.5)
    >>> with distributed.Client(processes=False, n_workers=1, threads_per_worker=1, dashboard_address=None) as client:
    ...     report = riffler.cluster.verify(program, stock, scheduler=client)
    >>> bool(report.removed.sum() > 0)
    True
    """
    told = _Told(progress)
    with _client(scheduler) as client:
        check_versions(client)
        plan = VerifyPlan(
            stock_volume, part_mesh, fixtures, tools=tools, tolerance=tolerance, gouge_tolerance=gouge_tolerance,
            rest_tolerance=rest_tolerance, rapid_feed=rapid_feed, machine=machine,
            machine_options=machine_options, progress=told.part(0, 0.05),
        )  # fmt: skip
        with Spool() as spool:
            sort_moves(program, plan, spool, told)
            with Slabs(client, plan, spool, told.part(0.15, 0.9)) as slabs:
                slabs.run()
    report = plan.finish(progress=told.part(0.9, 1))
    told(1.0)
    return report


def sort_moves(program: Program | Iterable[Program], plan: VerifyPlan, spool: Spool, told: _Told) -> None:
    """Puts the moves of all chunks into the spool. The number of chunks is unknown: each adds half of the remaining
    progress."""
    if not isinstance(program, Program) and not isinstance(program, Iterable):
        raise ValueError("program must be a Program or an iterable of Programs")
    begin, end = 0.05, 0.15
    for chunk in [program] if isinstance(program, Program) else program:
        if not isinstance(chunk, Program):
            raise ValueError("program must be a Program or an iterable of Programs")
        middle = end if chunk is program else (begin + end) / 2
        for slab, moves, packet in plan.add(chunk, progress=told.part(begin, middle)):
            spool.add(slab, moves, packet)
        begin = middle


class _Told:
    """Reports progress to the caller; the share never falls."""

    def __init__(self, progress: Callable[[float], object] | None) -> None:
        self.progress, self.most = progress, 0.0

    def __call__(self, share: float) -> None:
        self.most = max(self.most, share)
        if self.progress is not None and self.progress(self.most) is False:
            raise Cancelled("cancelled")

    def part(self, begin: float, end: float) -> Callable[[float], None]:
        return lambda share: self(begin + share * (end - begin))


# --- the cluster ---------------------------------------------------------------------------------------------------


def library() -> Any:
    """The module distributed, or ValueError if it is missing."""
    try:
        import distributed
    except ImportError as error:
        raise ValueError("a cluster needs the package distributed (pip install riffler[cluster])") from error
    return distributed


@contextmanager
def _client(scheduler: str | Client) -> Iterator[Client]:
    """Yields a client of the scheduler. A client that the caller gave stays open."""
    distributed = library()
    if isinstance(scheduler, distributed.Client):
        client: Client = scheduler  # pyright: ignore[reportAssignmentType]
        if client.asynchronous:
            raise ValueError("scheduler: the Client is asynchronous; give a synchronous one, or an address")
        yield client
        return
    if not isinstance(scheduler, str):
        raise ValueError('scheduler must be an address ("tcp://host:8786") or a distributed.Client')
    try:
        client = distributed.Client(scheduler, timeout=PATIENCE, set_as_default=False, name="riffler")
    except (OSError, ValueError) as error:
        raise ConnectionError(f"no Dask scheduler answers at {scheduler} (start one: dask scheduler)") from error
    with client:
        yield client


def address_of(client: Client) -> str:
    """Address of the client's scheduler."""
    return str(client.scheduler.address)  # pyright: ignore[reportOptionalMemberAccess]


def check_versions(client: Client) -> None:
    """Raises RuntimeError naming the first machine without this version of riffler; the scheduler needs it too, to
    unpack tasks. Raises ConnectionError if there is no worker."""
    address = address_of(client)
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        raise ConnectionError(f"{address} has no workers (start one: dask worker {address} --nthreads 1)") from None
    found: dict[str, Any] = client.run(eval, VERSION_OF, on_error="return")  # pyright: ignore[reportAssignmentType]
    try:
        found[f"the scheduler {address}"] = client.run_on_scheduler(eval, VERSION_OF)
    except ImportError as error:
        found[f"the scheduler {address}"] = error
    for worker, version in found.items():
        _check_version(worker, version)


def _check_version(worker: str, version: str | Exception) -> None:
    if isinstance(version, ImportError):
        raise RuntimeError(f"{worker} has no riffler ({version}): install riffler {__version__} there")
    if isinstance(version, Exception):
        raise RuntimeError(f"{worker} cannot run riffler: {version}") from version
    if version != __version__:
        raise RuntimeError(f"{worker} has riffler {version}, this is {__version__}: install the same version there")


class Context:
    """Data shared by all slabs. A task makes it, so that Dask can make it again; workers send it to each other
    as bytes."""

    def __init__(self, version: str, data: bytes) -> None:
        self.version, self.data = version, data
        self.worker = SlabWorker(data) if version == __version__ else None

    def __reduce__(self) -> tuple[type, tuple[str, bytes]]:
        return Context, (self.version, self.data)


def simulate(context: Context, task: bytes, moves: list[bytes]) -> bytes:
    """Runs one slab, or some of its moves, on a worker."""
    if context.worker is None:  # the worker joined after `check_versions`
        from distributed import get_worker

        raise RuntimeError(
            f"{get_worker().address} has riffler {__version__}, the job needs {context.version}: install the same "
            "version there"
        )
    return context.worker.run(task, moves)


# --- the slabs -----------------------------------------------------------------------------------------------------


class Spool:
    """Packets of moves, slab by slab, in a temporary file that disappears with the process."""

    def __init__(self) -> None:
        import tempfile  # imports hashlib and with it OpenSSL: 3 MB that only clusters need

        self.file = tempfile.TemporaryFile(prefix="riffler-")  # noqa: SIM115
        self.size = 0
        self.total = 0  # moves
        self.places: dict[int, array[int]] = {}  # for each slab: offset, length and moves of each packet

    def __enter__(self) -> Spool:
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def add(self, slab: int, moves: int, packet: bytes) -> None:
        self.file.seek(0, os.SEEK_END)
        self.file.write(packet)
        self.places.setdefault(slab, array("Q")).extend((self.size, len(packet), moves))
        self.size += len(packet)
        self.total += moves

    def slabs(self) -> list[int]:
        return sorted(self.places)

    def pieces(self, slab: int) -> Iterator[tuple[list[bytes], int, bool]]:
        """Yields packets with about MOVES moves, their number of moves, and whether they are the slab's last ones."""
        places, packets, moves = self.places[slab], [], 0
        for k in range(0, len(places), 3):
            self.file.seek(places[k])
            packets.append(self.file.read(places[k + 1]))
            moves += places[k + 2]
            last = k + 3 == len(places)
            if last or moves + places[k + 5] > MOVES:
                yield packets, moves, last
                packets, moves = [], 0


@dataclass
class Traffic:
    """Bytes that a run has moved."""

    tasks: int = 0
    slabs: int = 0
    context: int = 0
    sent: int = 0
    received: int = 0


@dataclass
class Slab:
    """A slab in the cluster."""

    number: int
    pieces: Iterator[tuple[list[bytes], int, bool]]
    future: Future | None = None
    moves: int = 0
    last: bool = False


@dataclass
class Slabs:
    """Runs all slabs of a plan on the cluster; leaves none there at the end."""

    client: Client
    plan: VerifyPlan
    spool: Spool
    progress: Callable[[float], object]
    traffic: Traffic = field(default_factory=Traffic)

    def __enter__(self) -> Slabs:
        self.name = f"riffler-verify-{uuid.uuid4().hex}"
        self.arrived: queue.SimpleQueue[Future] = queue.SimpleQueue()
        self.active: dict[str, Slab] = {}
        self.waiting = self.spool.slabs()
        self.waiting.reverse()
        self.finished = 0  # moves
        self.threads, self.looked, self.seen = 0, 0.0, time.monotonic()
        self.context: Future | None = None
        return self

    def __exit__(self, *_: object) -> None:
        futures = [slab.future for slab in self.active.values() if slab.future is not None]
        futures += [self.context] if self.context is not None else []
        self.active, self.context = {}, None
        if futures and self.client.status == "running":
            self.client.cancel(futures, force=True)

    def run(self) -> None:
        if not self.waiting:
            return
        data = self.plan.context()
        self.traffic.context = len(data)
        with _large_tasks():
            self.context = self.client.submit(
                Context, __version__, data, key=f"{self.name}-context", pure=False, retries=RETRIES
            )
            del data
            while self.waiting or self.active:
                self.look()
                self.fill()
                with suppress(queue.Empty):
                    self.take(self.arrived.get(timeout=0.5))
                self.progress(self.finished / self.spool.total)

    def look(self) -> None:
        """Updates the number of worker threads. Raises ConnectionError if the scheduler or all workers are lost."""
        now = time.monotonic()
        if now - self.looked < 1:
            return
        self.looked = now
        if self.client.status == "running":
            try:
                threads: dict[str, int] = self.client.nthreads()  # pyright: ignore[reportAssignmentType]
                self.threads = sum(threads.values())
            except OSError:
                self.threads = 0
        else:
            self.threads = 0
        if self.threads > 0:
            self.seen = now
        elif self.client.status == "closed" or now - self.seen > WITHOUT_WORKERS:
            raise ConnectionError(f"{address_of(self.client)}: the scheduler, or its last worker, is gone")

    def fill(self) -> None:
        most = max(1, PER_THREAD * self.threads)
        while self.waiting and len(self.active) < most:
            first = min((slab.number for slab in self.active.values()), default=self.waiting[-1])
            if self.waiting[-1] - first > AHEAD * most:
                return
            number = self.waiting.pop()
            self.traffic.slabs += 1
            self.submit(Slab(number, self.spool.pieces(number)))

    def submit(self, slab: Slab) -> None:
        packets, slab.moves, slab.last = next(slab.pieces)
        task = self.plan.task(slab.number)
        self.traffic.tasks += 1
        self.traffic.sent += len(task) + sum(map(len, packets))
        key = f"{self.name}-{slab.number}-{self.traffic.tasks}"
        slab.future = self.client.submit(
            simulate, self.context, task, packets, key=key, pure=False, retries=RETRIES, priority=-slab.number
        )
        self.active[key] = slab
        slab.future.add_done_callback(self.arrived.put)

    def take(self, future: Future) -> None:
        slab = self.active[str(future.key)]
        result = self.result(future, slab)
        self.traffic.received += len(result)
        self.plan.accept(slab.number, result, slab.last)
        self.finished += slab.moves
        del self.active[str(future.key)]
        slab.future = None
        future.release()
        if not slab.last:
            self.submit(slab)

    def result(self, future: Future, slab: Slab) -> bytes:
        distributed = library()
        try:
            return future.result()
        except distributed.KilledWorker as error:
            raise RuntimeError(
                f"slab {slab.number}: every worker that ran it died, the last one at {error.last_worker.address}; "
                "their logs give the reason (out of memory?)"
            ) from error
        except distributed.CancelledError as error:
            raise ConnectionError(f"{address_of(self.client)}: the scheduler has cancelled the work") from error
        except FormatError as error:
            raise RuntimeError(f"slab {slab.number}: damaged in transit ({error})") from error


@contextmanager
def _large_tasks() -> Iterator[None]:
    """Silences Dask's warning about large tasks. Tasks carry their slabs: data kept on a worker are lost if it dies."""
    from dask import config

    with config.set({"distributed.admin.large-graph-warning-threshold": "1 TB"}):
        yield
