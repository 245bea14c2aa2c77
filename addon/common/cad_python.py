"""Finds a Python that can read CAD files: it must have the packages cadquery-ocp-novtk and numpy. Needs no Blender."""

import os
import shutil
import subprocess
import sys

HAS = "import importlib.util as u, sys; sys.exit(not (u.find_spec('OCP') and u.find_spec('numpy')))"
SECONDS = 20.0  # longest time to wait for one Python's answer
COMMAND = "pip install 'riffler[cad]'"
MISSING = (
    f"no Python with the package cadquery-ocp-novtk was found: install it ({COMMAND}), and choose that Python in "
    "Riffler's preferences"
)


def candidates(environment=os.environ, own=sys.executable):
    """Paths of Pythons in the order of the search: RIFFLER_CAD_PYTHON, Blender's own, those on the PATH."""
    names = (environment.get("RIFFLER_CAD_PYTHON"), own, shutil.which("python3"), shutil.which("python"))
    return list(dict.fromkeys(name for name in names if name))


def has_packages(python, run=subprocess.run):
    """Whether a Python has the packages. Quick, because it does not import them."""
    try:
        return run([python, "-c", HAS], capture_output=True, timeout=SECONDS, check=False).returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        return False


def find(chosen="", among=None, has=has_packages):
    """The user's choice, or the first candidate that has the packages. ValueError, with a remedy, if there is none."""
    if chosen:
        if has(chosen):
            return chosen
        raise ValueError(
            f"{chosen} has no package cadquery-ocp-novtk: install it there ({COMMAND}), or choose another Python"
        )
    for python in candidates() if among is None else among:
        if has(python):
            return python
    raise ValueError(MISSING)
