"""CAD files for the tests, and a Python that reads them."""

import functools
import hashlib
import os
import subprocess
import tempfile
from pathlib import Path

from support import common

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "native" / "tests" / "python" / "cad_files.py"
HAS = "import importlib.util, sys; sys.exit(not importlib.util.find_spec('OCP'))"  # importing it takes a second


@functools.cache
def reader():
    """A Python that has the extra: the one in the environment variable, or that of `make setup`."""
    for python in (os.environ.get("RIFFLER_CAD_PYTHON"), ROOT / ".venv" / "bin" / "python"):
        if python and Path(python).exists():
            found = subprocess.run([python, "-c", HAS], capture_output=True, env=plain())
            if found.returncode == 0:
                return str(python)
    raise common.Skip("no Python with cadquery-ocp-novtk: .venv has it after `make setup`")


def plain():
    return {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}


def part(name):
    """Path of a file that native/tests/python/cad_files.py writes, once for all Blenders. Each of several that begin
    at once writes the files; one folder of them stays."""
    out = ROOT / "out" / "blender"
    folder = out / f"cad-{hashlib.sha256(PROGRAM.read_bytes()).hexdigest()[:16]}"
    if not folder.exists():
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=out) as made:
            subprocess.run([reader(), str(PROGRAM), made], check=True, capture_output=True, env=plain())
            try:
                Path(made).rename(folder)
            except OSError:
                assert folder.exists()
    return str(folder / name)


def with_reader():
    os.environ["RIFFLER_CAD_PYTHON"] = reader()
