"""Tests of the add-on in every Blender of this machine, headless and in a window.

    python blender_tests/run.py                       everything
    python blender_tests/run.py --only test_cut       tests whose name contains the text
    python blender_tests/run.py --blender 4.5 --mode source --no-window

Each (Blender, installation mode), and each script of a window, is one process with a time limit; a few run at a time.
Installation modes: the zips that users get (extension from 4.2 on, legacy before), built here from the wheel, and the
source folder. Blender 4.5 tests what depends on the installation mode, from the zip and from the source folder, except
tests that do the same in any place (common.anywhere). Tests whose time is spent in the core (common.core_bound) run in
the oldest and the newest Blender. A Blender that --blender or --mode names runs everything. Ends with the costliest
tests and the numbers of passed, failed and skipped tests, with reasons; exit code 1 if one failed.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import zipfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from support import environments, soak_runs
from support.environments import ROOT, Environment
from support.report import MARK

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT / "addon"))
import package  # noqa: E402 (the zips are built by what builds them for users)

# Processes, of a gigabyte each; windows and pens are idle for half of their time.
AT_ONCE = min(3, 2 * (os.cpu_count() or 1))
FIRST_DISPLAY = int(os.environ.get("FD", "90"))
# The Blender that tests where the add-on is installed: from the zip and from the source folder. Otherwise it repeats
# the newest one, as it takes the same branches of addon/blender/versions.py (core/test_core_bound.py).
OF_INSTALLING = (4, 5)
# Tests that may depend on the add-on's folder and module name; the rest is the same code in both.
OF_THE_PLACE = ("lifecycle", "preferences", "recovery", "operators", "tools", "messages")
# Marks of support/common.py, and where the tests that have them run instead.
LEFT_OUT = {
    "core_bound": "tests that run in {} only, because their time goes into the core",
    "anywhere": "tests that do the same wherever the add-on is installed, which other Blenders run",
}
SLOWEST = 20
END = 8  # lines of a message repeated at the end, where they are read first


def indented(message: str, last: int = 0) -> str:
    return "".join(f"\n      {line}" for line in message.rstrip().splitlines()[-last:])


@dataclass
class Tally:
    passed: int = 0
    times: list[tuple[float, float, str]] = field(default_factory=list)  # processor time, wall time, name
    failed: list[tuple[str, str]] = field(default_factory=list)  # name and message
    skipped: list[str] = field(default_factory=list)
    left: list[str] = field(default_factory=list)  # tests that other Blenders run, by process

    def add(self, where: str, result: dict) -> None:
        name, outcome = f"{where}: {result['name']}", result["outcome"]
        note = ""
        self.times.append((result.get("processor", result["seconds"]), result["seconds"], name))
        if outcome == "passed":
            self.passed += 1
        elif outcome == "skipped":
            self.skipped.append(f"{name}: {result['message']}")
            note = f"  {result['message']}"
        else:
            self.failed.append((name, result["message"]))
            note = indented(result["message"])
        processor = result.get("processor", result["seconds"])
        print(f"  {outcome:8}{processor:7.2f} s in {result['seconds']:7.2f} s  {result['name']}{note}", flush=True)

    def leave(self, where: str, count: int, mark: str, others: str) -> None:
        self.left.append(f"{where}: {LEFT_OUT[mark].format(others)}: {count}")
        print(f"  left out          {self.left[-1]}", flush=True)

    def skip(self, what: str, reason: str) -> None:
        self.skipped.append(f"{what}: {reason}")
        print(f"{what}\n  skipped  {reason}", flush=True)


@dataclass
class Bench:
    """Shared by all runs: the native package to import, the zips, a folder for output."""

    paths: list[str]
    zips: dict[str, str]
    out: Path
    only: str
    timeout: float
    tally: Tally
    measure: bool = False  # measurements that take minutes and decide nothing
    smooth: bool = False  # pictures of tutorials, for the pages

    def run(
        self, environment: Environment, mode: str, files: list[Path], more: dict | None = None, timeout: float = 0
    ) -> None:
        """One process; every result it prints counts, and a test that began and never ended has failed."""
        where = f"{environment.name}, {mode}"
        timeout = max(timeout, self.timeout)
        self.begin(where)
        with tempfile.TemporaryDirectory() as resources:
            job = {
                "mode": mode,
                "zip": self.zips.get(mode, ""),
                "files": [str(f) for f in files],
                "paths": self.paths if mode in ("source", "none") else [],
                "out": str(self.out / where.replace(", ", "-").replace(" ", "-")),
                "repo": str(ROOT),
                "only": self.only,
                **(more or {}),
            }
            path = Path(resources) / "job.json"
            path.write_text(json.dumps(job))
            variables = {
                "RIFFLER_TEST_JOB": str(path),
                "BLENDER_USER_RESOURCES": resources,
                "BLENDER_USER_SCRIPTS": str(Path(resources) / "scripts"),
            }
            (Path(resources) / "scripts" / "addons").mkdir(parents=True)
            done = environment.run(HERE / "support" / "harness.py", variables, timeout)
        self.judge(where, done, timeout)

    def begin(self, where: str) -> None:
        with self.printing:
            print(f"running  {where}", flush=True)

    def judge(self, where: str, done: subprocess.CompletedProcess, timeout: float = 0) -> None:
        with self.printing:
            print(where, flush=True)
            self._count(where, done, timeout)

    def _count(self, where: str, done: subprocess.CompletedProcess, timeout: float) -> None:
        begun, fine = None, True
        for line in done.stdout.splitlines():
            # Blender may leave an unfinished line of its own before ours
            _, mark, text = line.partition(MARK)
            if not mark:
                continue
            message = json.loads(text)
            if "start" in message:
                begun = message["start"]
            elif "note" in message:
                print(f"  note              {message['note']}", flush=True)
            elif "left" in message:
                self.tally.leave(where, message["left"], message["mark"], self.ends)
            elif "figure" in message:
                print(f"  figure            {message['figure']}: {message['value']}", flush=True)
                self.figures.append({"where": where, **message})
            else:
                self.tally.add(where, message)
                fine &= message["outcome"] != "failed"
                begun = None
        if begun or (done.returncode != 0 and fine):
            why = (
                f"time limit of {timeout or self.timeout:.0f} s"
                if done.returncode == 124
                else f"exit code {done.returncode}"
            )
            tail = "\n".join(done.stdout.splitlines()[-25:])
            self.tally.add(
                where, {"name": begun or "process", "outcome": "failed", "seconds": 0, "message": f"{why}\n{tail}"}
            )

    figures: list[dict] = field(default_factory=list)
    ends: str = ""  # the Blenders that run every test
    printing: threading.Lock = field(default_factory=threading.Lock)  # keeps the output of one process together


def native_paths(wheel: Path | None, folder: Path) -> list[str]:
    """The path from which `import riffler` loads the core in runs from source: the unpacked wheel, or a developer's
    build."""
    if wheel is None:
        return [str(ROOT / "native" / "python")]
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return [str(folder)]


def newest_wheel() -> Path | None:
    """For this Python, the one of the Blenders here; ./dist may hold wheels for others, too."""
    name = f"riffler-*-{package.tag(sys.version_info)}-*.whl"
    found = [w for place in ("build/wheel/riffler", "dist") for w in (ROOT / place).glob(name)]
    return max(found, key=lambda w: w.stat().st_mtime, default=None)


def made_zips(folder: Path) -> dict[str, str]:
    """Existing zips, by installation mode."""
    found = {"legacy" if z.stem.endswith("-legacy") else "extension": str(z.resolve()) for z in folder.glob("*.zip")}
    if "extension" not in found:
        raise SystemExit(f"{folder} has no extension zip: make it with `make package`")
    return found


def core_tests(tally: Tally, only: str) -> None:
    """Tests without Blender, by pytest in this Python."""
    print("plain Python", flush=True)
    report = Path(tempfile.mkdtemp()) / "report.xml"
    command = [
        sys.executable,
        "-m",
        "pytest",
        str(HERE / "core"),
        "-q",
        "-p",
        "no:cacheprovider",
        f"--junitxml={report}",
    ]
    done = environments.execute([*command, *(["-k", only] if only else [])], {"PYTHONPATH": str(ROOT)}, 300)
    from xml.etree import ElementTree

    cases = list(ElementTree.parse(report).iter("testcase")) if report.exists() else []
    if not cases and not only:
        message = done.stdout
        tally.add("plain Python", {"name": "pytest", "outcome": "failed", "seconds": 0, "message": message})
    for case in cases:
        problem = next((c for c in case if c.tag in ("failure", "error", "skipped")), None)
        outcome = "passed" if problem is None else "skipped" if problem.tag == "skipped" else "failed"
        message = "" if problem is None else (problem.get("message") if outcome == "skipped" else problem.text)
        name = f"{case.get('classname').split('.')[-1]}.{case.get('name')}"
        tally.add(
            "plain Python", {"name": name, "outcome": outcome, "seconds": float(case.get("time")), "message": message}
        )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="text in the test's name")
    parser.add_argument("--blender", default="", help="text in the Blender's name, as 4.5")
    parser.add_argument("--mode", choices=("source", "extension", "legacy"), help="one way of installing only")
    parser.add_argument("--wheel", type=Path, help="default: the newest in build/wheel/riffler or dist for this Python")
    parser.add_argument("--zips", type=Path, help="folder of zips to test; default: made from the wheel")
    parser.add_argument("--no-window", action="store_true", help="headless only")
    parser.add_argument("--no-headless", action="store_true", help="windows only")
    parser.add_argument("--figures", action="store_true", help="also measure; writes out/blender/figures.json")
    parser.add_argument("--smooth", action="store_true", help="tutorials' pictures with smooth edges, for the pages")
    parser.add_argument("--timeout", type=float, default=1200, help="seconds for one process")
    soak_runs.add_arguments(parser)
    arguments = parser.parse_args()

    tally = Tally()
    out = ROOT / "out" / "blender"
    out.mkdir(parents=True, exist_ok=True)
    wheel = arguments.wheel or newest_wheel()
    with tempfile.TemporaryDirectory() as folder:
        zips = made_zips(arguments.zips) if arguments.zips else {}
        if wheel and not zips:
            package.build([wheel], Path(folder) / "zips")
            zips = made_zips(Path(folder) / "zips")
        paths = native_paths(wheel, Path(folder) / "native")
        bench = Bench(
            paths, zips, out, arguments.only, arguments.timeout, tally, arguments.figures, smooth=arguments.smooth
        )
        if arguments.soak:
            for run in soak_runs.runs(bench, arguments):
                run()
            return close(tally)
        if not arguments.blender and not arguments.mode:
            core_tests(tally, arguments.only)
        if arguments.mode in (None, "extension") and not arguments.only:
            validate(bench)
        if not arguments.only:
            compile_modules(bench, Path(folder) / "compiled", arguments.blender)
        quiet, drawn = [], []
        if not arguments.no_headless:
            quiet += headless(bench, arguments)
            if arguments.mode in (None, "source"):
                quiet += soak_runs.runs(bench, arguments)
        if not arguments.no_window:
            drawn += windowed(bench, arguments)
        runs = mixed(quiet, drawn)
        with ThreadPoolExecutor(1 if arguments.figures else AT_ONCE) as pool:
            list(pool.map(lambda run: run(), runs))
    if bench.figures:
        (out / "figures.json").write_text(json.dumps(bench.figures, indent=1) + "\n")
    return close(tally)


def mixed(quiet: list, drawn: list) -> list:
    """Both lists as one, each in its order and evenly spread: windows wait for half of their time, and processes
    without one use it."""
    places = [(k / len(some), some is drawn, run) for some in (quiet, drawn) for k, run in enumerate(some)]
    return [run for _, _, run in sorted(places, key=lambda place: place[:2])]


def compile_modules(bench: Bench, folder: Path, named: str) -> None:
    """Compiles the Python modules of `blender` once, for all its processes, if the text `named` is in its name.
    Debian's has none compiled, and compiles them at each start where it may not write next to them."""
    application = environments.application()
    if application.missing or named not in application.name:
        return
    environments.compiled = str(folder)
    users = "extension" if application.extensions else "legacy"
    writer = replace(application, variables=environments.bytecode(write=True))
    bench.run(writer, users if users in bench.zips else "source", [])


def headless(bench: Bench, arguments) -> list[Callable[[], None]]:
    """The processes to be run, in any order."""
    files = sorted((HERE / "headless").rglob("test_*.py"), key=lambda path: path.name)
    usable, runs = [], []
    for environment in environments.find():
        if arguments.blender not in environment.name:
            continue
        if environment.missing:
            bench.tally.skip(environment.name, environment.missing)
            continue
        usable.append(environment)
    ends = usable[:1] + usable[-1:]
    bench.ends = " and ".join(environment.name for environment in ends)
    for environment in usable:
        repeats = environment not in ends and not (arguments.blender or arguments.mode)
        of_installing = repeats and environment.version[:2] == OF_INSTALLING
        more = {"leave_out": ["core_bound", "anywhere"] if of_installing else ["core_bound"] if repeats else []}
        for mode in modes(environment, arguments):
            if mode != "source" and mode not in bench.zips:
                bench.tally.skip(f"{environment.name}, {mode}", "no wheel in build/wheel or dist to make the zip from")
                continue
            chosen = files
            if of_installing:
                chosen = [file for file in files if file.stem.removeprefix("test_") in OF_THE_PLACE]
            runs.append(partial(bench.run, environment, mode, chosen, more))
        if arguments.mode in (None, "source"):
            runs.append(partial(bench.run, environment, "none", [HERE / "broken" / "test_fallback.py"]))
            if arguments.figures:
                runs.append(partial(bench.run, environment, "source", [HERE / "support" / "figures.py"], {"only": ""}))
    if len(usable) > 1 and arguments.mode in (None, "source"):
        runs.append(partial(chain, bench, usable))
    return runs


def modes(environment: Environment, arguments) -> list[str]:
    """Installation modes that are tested in a Blender."""
    found = ["source", "extension" if environment.extensions else "legacy"]
    if arguments.mode:
        return [mode for mode in found if mode == arguments.mode]
    return found if arguments.blender or environment.version[:2] == OF_INSTALLING else found[1:]


def chain(bench: Bench, usable: list[Environment]) -> None:
    """Each Blender opens what the previous one wrote."""
    with tempfile.TemporaryDirectory() as folder:
        for environment in usable:
            bench.run(environment, "source", [HERE / "chain" / "test_chain.py"], {"chain": folder})


def windowed(bench: Bench, arguments) -> list[Callable[[], None]]:
    """Like `headless`: a process for each script."""
    from support import window

    application = environments.application()
    if arguments.blender not in application.name:
        return []
    if reason := application.missing or window.missing():
        bench.tally.skip("window", reason)
        return []
    users = "extension" if application.extensions else "legacy"
    mode = arguments.mode or (users if users in bench.zips else "source")
    if mode not in ("source", users):
        return []
    chosen = [script for script in longest_first() if arguments.only in script.stem]
    return [
        partial(window.run, bench, application, mode, script, FIRST_DISPLAY + 10 * k) for k, script in enumerate(chosen)
    ]


def longest_first() -> list[Path]:
    """The scripts of windows, so that none is left over for the end: those that wait for Blender's autosave, a minute
    in which other processes have the cores, then the tutorials, then the others."""
    scripts = sorted((HERE / "windowed").glob("tutorial_*.py")) + sorted((HERE / "windowed").glob("window_*.py"))
    return sorted(scripts, key=lambda script: "auto_save_time" not in script.read_text())


def validate(bench: Bench) -> None:
    """Checks the extension with Blender's own tool, from `blender` if it has extensions, or from the newest bpy wheel:
    it is accepted, and a build of its content has the same files."""
    scripts = "lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
    command = [[sys.executable, str(path)] for path in sorted(ROOT.glob(f".envs/bpy-*/{scripts}"))]
    application = environments.application()
    if application.extensions:
        command.append([application.command[0], "--command", "extension"])
    if not command or "extension" not in bench.zips:
        bench.tally.skip("extension zip, Blender's tool", "no wheel" if command else "no Blender with extensions")
        return

    def judge(name: str, done: subprocess.CompletedProcess, wrong: str = "") -> None:
        outcome = "passed" if done.returncode == 0 and not wrong else "failed"
        message = f"{done.stdout}{wrong}"
        bench.tally.add("extension zip", {"name": name, "outcome": outcome, "seconds": 0, "message": message})

    print("extension zip", flush=True)
    ours = bench.zips["extension"]
    judge("validate", environments.execute([*command[-1], "validate", ours], {}, 60))
    with tempfile.TemporaryDirectory() as folder:
        content, theirs = Path(folder) / "content", Path(folder) / "theirs.zip"
        with zipfile.ZipFile(ours) as archive:
            archive.extractall(content)
            names = sorted(name for name in archive.namelist() if not name.endswith("/"))
        words = ["build", "--source-dir", str(content), "--output-filepath", str(theirs)]
        done = environments.execute([*command[-1], *words], {}, 120)
        built = sorted(zipfile.ZipFile(theirs).namelist()) if theirs.exists() else []
        judge("build", done, "" if built == names else f"other files: {sorted({*built} ^ {*names})[:9]}")


def close(tally: Tally) -> int:
    worked, waited = (sum(times[k] for times in tally.times) for k in (0, 1))
    print(
        f"\nthe costliest of {len(tally.times)} tests, which took {worked:.0f} s of processor time and {waited:.0f} s"
    )
    for processor, seconds, name in sorted(tally.times, reverse=True)[:SLOWEST]:
        print(f"  {processor:7.2f} s in {seconds:7.2f} s  {name}")
    print(f"\n{tally.passed} passed, {len(tally.failed)} failed, {len(tally.skipped)} skipped")
    for line in tally.left:
        print(f"  left out {line}")
    for line in tally.skipped:
        print(f"  skipped  {line}")
    for name, message in tally.failed:
        print(f"  failed   {name}{indented(message, END)}")
    return 1 if tally.failed or not tally.passed else 0


if __name__ == "__main__":
    sys.exit(main())
