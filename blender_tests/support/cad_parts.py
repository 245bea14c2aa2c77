"""CAD files for the tests, and a Python that reads them."""

import os
import subprocess
from pathlib import Path

from support import common

ROOT = Path(__file__).parents[2]


def reader():
    """A Python that has the extra: the one in the environment variable, or that of `make setup`."""
    for python in (os.environ.get("RIFFLER_CAD_PYTHON"), ROOT / ".venv" / "bin" / "python"):
        if python and Path(python).exists():
            found = subprocess.run([python, "-c", "import OCP"], capture_output=True, env=plain())
            if found.returncode == 0:
                return str(python)
    raise common.Skip("no Python with cadquery-ocp-novtk: .venv has it after `make setup`")


def plain():
    return {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}


def part(name):
    """Path of a file that native/tests/python/cad_files.py writes."""
    folder = Path(common.out("cad"))
    if not (folder / name).exists():
        folder.mkdir(parents=True, exist_ok=True)
        program = ROOT / "native" / "tests" / "python" / "cad_files.py"
        subprocess.run([reader(), str(program), str(folder)], check=True, capture_output=True, env=plain())
    return str(folder / name)


def with_reader():
    os.environ["RIFFLER_CAD_PYTHON"] = reader()
