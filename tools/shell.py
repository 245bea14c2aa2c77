"""What the tools share: the project's folders, progress lines, commands that must succeed, digests of files."""

from __future__ import annotations

import hashlib
import os
import shlex
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import compiler_cache

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / ".venv"
PYTHON = VENV / "bin" / "python"


def cores() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0))


class StepError(Exception):
    """A step that cannot continue; the text says what to do about it."""


def say(text: str) -> None:
    """One line of progress, in order with the output of the commands around it."""
    print(f"==> {text}", flush=True)


def tool_environment(**extra: str) -> dict[str, str]:
    """The caller's environment with .venv's programs first, and without what would leak other packages in."""
    env = {k: v for k, v in os.environ.items() if k not in {"PYTHONPATH", "PYTHONHOME", "MAKEFLAGS", "MFLAGS"}}
    env["PATH"] = f"{VENV / 'bin'}{os.pathsep}{env.get('PATH', os.defpath)}"
    return compiler_cache.environment() | env | {"PYTHONNOUSERSITE": "1"} | extra


def run(*command: str | Path, env: dict[str, str] | None = None, cwd: Path = ROOT) -> None:
    """Runs a command with its output shown; StepError naming it if it does not succeed."""
    words = [str(word) for word in command]
    sys.stdout.flush()
    try:
        code = subprocess.run(words, env=env or tool_environment(), cwd=cwd, check=False).returncode
    except OSError as error:
        raise StepError(f"cannot run {words[0]}: {error.strerror}") from error
    if code != 0:
        raise StepError(f"failed with exit code {code}: {shlex.join(words)}")


def git(*words: str) -> str:
    """What a git command prints; StepError if it does not succeed."""
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise StepError(f"git {words[0]} failed: {done.stderr.strip()}")
    return done.stdout


def digest(files: Iterable[Path], *words: str) -> str:
    """A digest of names (relative to the project) and contents; changes when a file comes, goes or changes."""
    h = hashlib.sha256("\0".join(words).encode())
    for path in sorted(files):
        content = path.read_bytes()
        h.update(f"\0{path.relative_to(ROOT)}\0{len(content)}\0".encode())
        h.update(content)
    return h.hexdigest()


def is_stamped(stamp: Path, key: str) -> bool:
    """Whether the step that `stamp` stands for was finished for `key`."""
    try:
        return stamp.read_text() == key
    except OSError:
        return False


def write_stamp(stamp: Path, key: str) -> None:
    """The last thing a step does, so an interrupted step has no stamp and is done again."""
    stamp.parent.mkdir(parents=True, exist_ok=True)
    part = stamp.with_name(stamp.name + ".part")
    part.write_text(key)
    part.replace(stamp)


def main(entry) -> None:
    """Runs a tool's entry point: a StepError becomes one message and exit code 1."""
    try:
        entry()
    except StepError as failure:
        print(f"\nerror: {failure}", file=sys.stderr)
        sys.exit(1)
    except KeyboardInterrupt:
        print("\ninterrupted", file=sys.stderr)
        sys.exit(130)
