"""The Blenders on this computer: bpy wheels in .envs/bpy-<version>, and `blender` on the PATH."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
WHEELS = ("4.2", "4.5", "5.0")
compiled = ""  # folder of the compiled modules that all processes of `blender` read


@dataclass
class Environment:
    name: str
    version: tuple[int, ...]
    command: list[str]  # what runs a script; the script's path follows
    missing: str = ""  # why it cannot be used
    variables: dict[str, str] = field(default_factory=dict)  # of every process

    @property
    def extensions(self) -> bool:
        """True if Blender installs extensions with wheels; otherwise it takes the legacy zip."""
        return self.version >= (4, 2)

    def run(self, script: Path, variables: dict[str, str], timeout: float) -> subprocess.CompletedProcess:
        """Runs a script; a timeout ends the whole process group and is return code 124."""
        return execute([*self.command, str(script)], {**self.variables, **variables}, timeout)


def execute(command: list[str], variables: dict[str, str], timeout: float) -> subprocess.CompletedProcess:
    process = subprocess.Popen(
        command,
        env={**os.environ, **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        start_new_session=True,
    )
    try:
        output, _ = process.communicate(timeout=timeout)
        code = process.returncode
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        output, _ = process.communicate()
        code = 124
    return subprocess.CompletedProcess(command, code, output, "")


def wheel(version: str) -> Environment:
    python = ROOT / ".envs" / f"bpy-{version}" / "bin" / "python"
    key = tuple(int(v) for v in version.split("."))
    missing = "" if python.exists() else f"{python.relative_to(ROOT)} is not there: make it with `make envs`"
    return Environment(f"bpy {version}", key, [str(python)], missing)


def bytecode(write: bool) -> dict[str, str]:
    """Variables for a process that reads compiled modules from the common folder, if there is one. Written once only:
    tests replace modules, perhaps twice within the second that tells a source from a newer one."""
    if not compiled:
        return {}
    return {"PYTHONPYCACHEPREFIX": compiled, "PYTHONDONTWRITEBYTECODE": "" if write else "1"}


def application() -> Environment:
    path = shutil.which("blender")
    if not path:
        return Environment("blender", (0,), [], "there is no `blender` on the PATH")
    head = execute([path, "--version"], {}, 60).stdout
    found = re.search(r"Blender (\d+)\.(\d+)(?:\.(\d+))?", head)
    if not found:
        return Environment("blender", (0,), [], f"{path} --version says {head[:80]!r}")
    version = tuple(int(v) for v in found.groups() if v is not None)
    command = [path, "--background", "--factory-startup", "--python-exit-code", "1", "--python"]
    return Environment(f"blender {'.'.join(map(str, version))}", version, command, variables=bytecode(write=False))


def find() -> list[Environment]:
    """Oldest first."""
    return sorted([application(), *(wheel(v) for v in WHEELS)], key=lambda e: e.version)
