"""Runs inside a Blender: installs the add-on as the job says, runs test functions, prints one JSON line per result.

The job is a JSON file named by RIFFLER_TEST_JOB: `mode` (source, extension, legacy, none), `zip`, `files`, `paths`
(for sys.path), `out`, `repo`, `only`, `leave_out` (marks of tests: "core_bound", "anywhere"). Leaves by os._exit,
unless the job has `leave`: a bpy wheel in which a test has left classes or handlers registered crashes (4.2) or hangs
(4.5) when the interpreter ends.
"""

import importlib
import importlib.machinery
import importlib.util
import json
import os
import sys
import sysconfig
import time
import traceback
from pathlib import Path

os.environ.pop("PYTHONPYCACHEPREFIX", None)  # other interpreters that a test starts have modules of their own
job = json.loads(Path(os.environ["RIFFLER_TEST_JOB"]).read_text())
sys.path[:0] = [*job["paths"], str(Path(__file__).resolve().parent.parent)]

import bpy  # noqa: E402 (paths first)

from support.report import processor_time, say  # noqa: E402

UNPACKED = 10**9  # s since 1970: what a test replaces later is newer


class Skip(Exception):  # noqa: N818 (it is no error)
    """Raised by a test that cannot run here; its text is the reason."""


def install():
    """Installs and enables the add-on; returns its module name."""
    mode = job["mode"]
    if mode == "none":
        return ""
    if mode in ("extension", "legacy"):
        sys.meta_path.insert(0, OnlyInstalled())
    if mode == "extension":
        bpy.ops.extensions.package_install_files(
            filepath=job["zip"], repo="user_default", enable_on_install=True, overwrite=True
        )
        name = "bl_ext.user_default.riffler"
    else:
        name = "riffler_addon"
        if mode == "legacy":
            bpy.ops.preferences.addon_install(filepath=job["zip"], overwrite=True)
        folder = Path(bpy.utils.user_resource("SCRIPTS", path="addons", create=True)) / name
        if mode == "source" and not folder.exists():
            folder.symlink_to(Path(job["repo"]) / "addon", target_is_directory=True)
        share_compiled(folder)
        bpy.ops.preferences.addon_enable(module=name)
    # The operators return FINISHED even if nothing was installed.
    if name not in bpy.context.preferences.addons:
        raise RuntimeError(f"{name} was not enabled")
    return name


def share_compiled(folder):
    """Lets the add-on's modules be read compiled from the common folder (environments.bytecode), if there is one. Each
    process installs the add-on under a path of its own, where none of them would be found."""
    if not sys.pycache_prefix:
        return
    place = Path(sys.pycache_prefix, *folder.parts[1:])  # where Python looks: importlib.util.cache_from_source
    if not place.exists():
        common = Path(sys.pycache_prefix, f"riffler_addon-{job['mode']}")
        common.mkdir(exist_ok=True)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.symlink_to(common, target_is_directory=True)
    if not folder.is_symlink():  # unpacked: a source's time tells an outdated module, and was that of unpacking
        for path in folder.rglob("*.py"):
            os.utime(path, (UNPACKED, UNPACKED))


class OnlyInstalled:
    """Finds `riffler` anywhere except in this Python's own packages, where a developer may have it, too."""

    def find_spec(self, name, path=None, target=None):
        if name != "riffler":
            return None
        own = {sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}
        return importlib.machinery.PathFinder.find_spec(name, [p for p in sys.path if p not in own])


def load(path):
    spec = importlib.util.spec_from_file_location(Path(path).stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run_test(name, function):
    say(start=name)
    begin, worked = time.perf_counter(), processor_time()
    outcome, message = "passed", ""
    try:
        bpy.ops.wm.read_homefile(use_empty=False)
        function()
    except Skip as reason:
        outcome, message = "skipped", str(reason)
    except Exception:
        outcome, message = "failed", traceback.format_exc()
    seconds, worked = time.perf_counter() - begin, processor_time() - worked
    say(name=name, outcome=outcome, seconds=seconds, processor=worked, message=message)
    return outcome != "failed"


def main():
    from support import common

    common.JOB = job
    common.Skip = Skip
    try:
        common.MODULE = install()
    except Exception:
        say(name="install", outcome="failed", seconds=0, message=traceback.format_exc())
        return 1
    fine, left = True, {}
    for path in job["files"]:
        module = load(path)
        tests = [(n, f) for n, f in vars(module).items() if n.startswith("test_") and callable(f)]
        for name, function in tests:
            if job["only"] not in f"{module.__name__}.{name}":
                continue
            mark = next((mark for mark in job.get("leave_out", ()) if hasattr(function, mark)), None)
            if mark:
                left[mark] = left.get(mark, 0) + 1
            else:
                fine &= run_test(f"{module.__name__}.{name}", function)
    for mark, count in left.items():
        say(left=count, mark=mark)
    return 0 if fine else 1


if __name__ == "__main__":
    try:
        code = main()
    except BaseException:
        say(name="harness", outcome="failed", seconds=0, message=traceback.format_exc())
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    if code or not job.get("leave"):
        os._exit(code)
