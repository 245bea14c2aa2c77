"""Long calls on separate threads: `submit` starts one and returns its `Future`."""

from __future__ import annotations

import atexit
import inspect
import logging
import threading
import weakref
from collections.abc import Callable
from typing import Generic, ParamSpec, Protocol, TypeVar

from . import _core

__all__ = ["Future", "submit"]

P = ParamSpec("P")
R = TypeVar("R")
log = logging.getLogger("riffler")


def submit(function: Callable[P, R], /, *args: P.args, **kwargs: P.kwargs) -> Future[R]:
    """Starts a long call on a separate thread.

    Most long calls of riffler run on a native thread without Python: they copy their arguments at once, volumes
    by a snapshot, and wrong arguments raise an error here. Others (`Volume.carve`, `verify` of an iterable, your
    own functions) run on a Python thread; they can be cancelled if they have a ``progress``.

    Parameters
    ----------
    function : callable
        A function or method, of riffler or your own. The future provides its ``progress``.
    *args, **kwargs
        Its arguments.

    Returns
    -------
    Future
        A future of the function's result.

    Raises
    ------
    ValueError, TypeError
        For wrong arguments of a native call; other calls raise them from `Future.result`.

    Examples
    --------
    >>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
    >>> future = riffler.submit(volume.to_mesh)
    >>> future.result().audit().open_edges, future.progress()
    (0, 1.0)
    """
    call: Callable = _core.Collider.made if function is _core.Collider else function
    if kwargs.get("progress") is None and _can_be_a_task(call):
        own = {k: v for k, v in kwargs.items() if k != "progress"}
        try:
            found = call(*args, **own, progress=_core.Task)
        except _core.NotATask:
            pass
        else:
            return Future(found) if isinstance(found, _core.Task) else Future(_Done(found))
    return Future(_Thread(call, args, kwargs))


def runs_as_task(function: Callable[P, R]) -> Callable[P, R]:
    """Marks a Python function that passes its ``progress`` to one native call and converts with `_core.then`."""
    function.__riffler_task__ = True  # pyright: ignore[reportFunctionMemberAccess]
    return function


def _can_be_a_task(call: Callable) -> bool:
    function = getattr(call, "__func__", call)
    if inspect.isbuiltin(function):
        doc = function.__doc__ or ""
        return doc.partition("\n")[0].find("progress: ") >= 0
    return getattr(function, "__riffler_task__", False)


class Future(Generic[R]):
    """A running or finished call; its interface is that of ``concurrent.futures.Future``, with `progress`.

    A future that the program no longer refers to is cancelled and waited for, unless it has callbacks. When Python
    ends, all futures are cancelled and waited for.

    Examples
    --------
    >>> mesh = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.5).to_mesh()
    >>> future = riffler.submit(mesh.decimate, triangles=100)
    >>> len(future.result(timeout=60).triangles)
    100
    """

    def __init__(self, task: _Running) -> None:
        self._task = task
        self._callbacks: list[Callable[[Future[R]], object]] = []
        self._lock = threading.Lock()
        self._watched = False

    def result(self, timeout: float | None = None) -> R:
        """The call's result, the same object each time. Waits for it; other threads run meanwhile.

        Parameters
        ----------
        timeout : float, s, or None
            Longest time to wait.

        Raises
        ------
        TimeoutError
            If the call has not ended by then.
        Cancelled
            After `cancel`.
        Exception
            An exception of the call.

        Examples
        --------
        >>> riffler.submit(sum, [1, 2]).result()
        3
        """
        self._wait(timeout)
        return self._task.result()  # pyright: ignore[reportReturnType]

    def exception(self, timeout: float | None = None) -> BaseException | None:
        """The call's exception, or None; waits as `result` does.

        Parameters
        ----------
        timeout : float, s, or None
            Longest time to wait.

        Raises
        ------
        TimeoutError
            If the call has not ended by then.

        Examples
        --------
        >>> riffler.submit(int, "x").exception()
        ValueError("invalid literal for int() with base 10: 'x'")
        """
        self._wait(timeout)
        try:
            self._task.result()
        except BaseException as error:
            return error
        return None

    def _wait(self, timeout: float | None) -> None:
        if not self._task.wait(timeout):
            raise TimeoutError(f"the call has not ended after {timeout:g} s ({self.progress():.0%})")

    def done(self) -> bool:
        """Whether the call has ended: with a result, with an error, or cancelled.

        Examples
        --------
        >>> future = riffler.submit(sum, [1, 2])
        >>> result = future.result()
        >>> future.done()
        True
        """
        return self._task.done

    def running(self) -> bool:
        """Whether the call has not ended yet.

        Examples
        --------
        >>> future = riffler.submit(sum, [1, 2])
        >>> result = future.result()
        >>> future.running()
        False
        """
        return not self._task.done

    def cancel(self) -> bool:
        """Asks the call to end with `Cancelled`, and does not wait. Returns False if it has already ended.

        Examples
        --------
        >>> mesh = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.5).to_mesh()
        >>> future = riffler.submit(mesh.smooth, iterations=2_000_000_000)
        >>> future.cancel()
        True
        >>> type(future.exception()).__name__, future.cancelled()
        ('Cancelled', True)
        """
        if self._task.done:
            return False
        self._task.cancel()
        return True

    def cancelled(self) -> bool:
        """Whether the call has ended by `Cancelled`.

        Examples
        --------
        >>> future = riffler.submit(riffler.Volume.block, (0, 0, 0), (4, 3, 2), 0.5)
        >>> future.result().volume, future.cancelled()
        (24.0, False)
        """
        return self._task.done and isinstance(self.exception(), _core.Cancelled)

    def progress(self) -> float:
        """The finished share, in [0, 1]. Never decreases; 1 only if the call has finished.

        Examples
        --------
        >>> future = riffler.submit(riffler.Volume.sphere, (0, 0, 0), 5, pitch=0.5)
        >>> 0 <= future.progress() <= 1
        True
        """
        return self._task.share

    def add_done_callback(self, callback: Callable[[Future[R]], object]) -> None:
        """Calls ``callback(future)`` after the end of the call: on a separate thread, or at once if it has ended.

        Exceptions of callbacks are logged.

        Parameters
        ----------
        callback : callable
            Function that is called with this future.

        Examples
        --------
        >>> seen = []
        >>> future = riffler.submit(sum, [1, 2])
        >>> result = future.result()
        >>> future.add_done_callback(lambda f: seen.append(f.result()))
        >>> seen
        [3]
        """
        with self._lock:
            if not self._task.done or self._watched:
                self._callbacks.append(callback)
                if self._watched:
                    return
                self._watched = True
                threading.Thread(target=self._watch, name="riffler callbacks", daemon=True).start()
                return
        self._call(callback)

    def _watch(self) -> None:
        self._task.wait(None)
        while True:
            with self._lock:
                if not self._callbacks:
                    self._watched = False
                    return
                callback = self._callbacks.pop(0)
            self._call(callback)

    def _call(self, callback: Callable[[Future[R]], object]) -> None:
        try:
            callback(self)
        except Exception:
            log.exception("a callback of %r failed", self)

    def __repr__(self) -> str:
        return f"<riffler.Future: {'done' if self.done() else f'{self.progress():.0%}'}>"


# --- calls that futures wait for --------------------------------------------------------------------------------------


class _Running(Protocol):
    @property
    def share(self) -> float: ...
    @property
    def done(self) -> bool: ...
    def cancel(self) -> None: ...
    def wait(self, timeout: float | None = None) -> bool: ...
    def result(self) -> object: ...


class _Done:
    """A call whose result was known at once."""

    share, done = 1.0, True

    def __init__(self, found: object) -> None:
        self._found = found

    def cancel(self) -> None:
        """No effect: the call has ended."""

    def wait(self, timeout: float | None = None) -> bool:
        return True

    def result(self) -> object:
        return self._found


class _Outcome:
    """Result of a thread. The thread refers to this and not to the `_Thread`, so that the latter can be dropped."""

    def __init__(self) -> None:
        self.share, self.cancelled = 0.0, False
        self.found: object = None
        self.error: BaseException | None = None

    def report(self, share: float) -> bool:
        self.share = max(self.share, min(share, 1 - 1e-9))
        return not self.cancelled


class _Thread:
    """A call on a Python thread."""

    def __init__(self, call: Callable, args: tuple, kwargs: dict) -> None:
        self._outcome = outcome = _Outcome()
        own = kwargs.get("progress")

        def progress(share: float) -> bool:
            return outcome.report(share) and not (own is not None and own(share) is False)

        if own is not None or _has_progress(call):
            kwargs = kwargs | {"progress": progress}
        self._thread = threading.Thread(
            target=_run,
            args=(outcome, call, args, kwargs),
            name=f"riffler {getattr(call, '__name__', '')}",
            daemon=True,
        )
        self._thread.start()
        _threads.add(self)

    @property
    def share(self) -> float:
        return self._outcome.share

    @property
    def done(self) -> bool:
        return not self._thread.is_alive()

    def cancel(self) -> None:
        self._outcome.cancelled = True

    def wait(self, timeout: float | None = None) -> bool:
        self._thread.join(timeout)
        return self.done

    def result(self) -> object:
        self._thread.join()
        if self._outcome.error is not None:
            raise self._outcome.error
        return self._outcome.found

    def __del__(self) -> None:
        if (outcome := getattr(self, "_outcome", None)) is not None:
            outcome.cancelled = True


def _run(outcome: _Outcome, call: Callable, args: tuple, kwargs: dict) -> None:
    try:
        outcome.found = call(*args, **kwargs)
        outcome.share = 1.0
    except BaseException as error:
        outcome.error = error


def _has_progress(call: Callable) -> bool:
    try:
        return "progress" in inspect.signature(call).parameters
    except (TypeError, ValueError):
        return False


_threads: weakref.WeakSet[_Thread] = weakref.WeakSet()


@atexit.register
def _end_all() -> None:
    """Ends all threads before Python shuts down."""
    running = list(_threads)
    for thread in running:
        thread.cancel()
    for thread in running:
        thread.wait()
