"""``python …/riffler/cad/worker FOLDER PARENT``: reads FOLDER/request.json, writes FOLDER/result.json and arrays.npz.

Lines of JSON on stdout report the stage and the finished share of the work. OpenCASCADE's own messages go to stderr.
"""

from __future__ import annotations

import contextlib
import ctypes
import importlib.util
import json
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

PACKAGE = "riffler_cad_worker"
MEMORY_SHARE = 0.8  # of the computer's memory, as address space
LEAST_MEMORY = 4 << 30  # bytes: libraries and threads reserve address space that they do not use


def main(folder: Path, parent: int) -> int:
    request = json.loads((folder / "request.json").read_text(encoding="utf-8"))
    end_with_parent(parent, request["cpu_seconds"])
    report = reporter(own_stdout())
    try:
        report("import", 0.0)
        result = package().run(request, folder, report)
    except ImportError as error:
        result = {"error": "missing", "message": str(error), "python": sys.executable}
    except MemoryError:
        result = {"error": "memory", "message": "out of memory"}
    draft = folder / "result.part"
    draft.write_text(json.dumps(result), encoding="utf-8")
    draft.replace(folder / "result.json")
    return 0


def package():
    """Imports this folder's package under a separate name, because the caller's riffler may not be importable here."""
    folder = Path(__file__).resolve().parent
    spec = importlib.util.spec_from_file_location(
        PACKAGE, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = module
    spec.loader.exec_module(module)
    return importlib.import_module(f"{PACKAGE}.run")


def own_stdout() -> TextIO:
    """Returns the original stdout, for reports. File descriptor 1, to which libraries print, becomes stderr."""
    stream = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return stream


def reporter(stream: TextIO) -> Callable[[str, float], None]:
    def report(stage: str, share: float) -> None:
        try:
            stream.write(json.dumps({"stage": stage, "share": share}) + "\n")
            stream.flush()
        except OSError:
            os._exit(3)  # the caller has gone

    return report


def end_with_parent(parent: int, cpu_seconds: int) -> None:
    """Makes this process end when its caller is killed: on Linux at once, elsewhere after a limit of processor time.

    OpenCASCADE holds Python's lock for minutes, so a thread that watches the caller would not run. On Linux, this
    process gets at most a share of the computer's memory, and if memory runs out all the same, the system ends this
    process and not the caller.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGKILL, 0, 0, 0)  # PR_SET_PDEATHSIG
        if os.getppid() != parent:
            os._exit(3)
        with contextlib.suppress(OSError):
            Path("/proc/self/oom_score_adj").write_text("1000")
        limit_memory()
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_CPU, (cpu_seconds, cpu_seconds + 5))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def limit_memory() -> None:
    import resource

    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    most = max(LEAST_MEMORY, int(MEMORY_SHARE * memory))
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    if hard == resource.RLIM_INFINITY or most < hard:
        resource.setrlimit(resource.RLIMIT_AS, (most, hard))


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), int(sys.argv[2])))
