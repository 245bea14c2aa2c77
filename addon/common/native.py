"""The import of the native core, which may fail on a user's computer, and the reason."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

from .. import VERSION

# Names in the native package that the add-on uses: with an older riffler on the path, the import fails instead of an
# operator later.
NEEDED = ("Tool", "Volume", "Mesh", "Program", "Journal", "Session", "Mesher", "Material", "Task")


def vendored() -> Path | None:
    """The folder in which the legacy zip (Blender before 4.2, which installs no wheels) carries the package."""
    folder = Path(__file__).resolve().parent.parent / "_vendor"
    return folder if (folder / "riffler").is_dir() else None


def load():
    """(module, None) or (None, the exception)."""
    folder = vendored()
    if folder and str(folder) not in sys.path:
        sys.path.insert(0, str(folder))
    try:
        module = importlib.import_module("riffler")
        _check(module)
    except Exception as error:  # a broken binary may raise anything; the panel shows it
        _forget()
        return None, error
    return module, None


def _check(module):
    """ImportError if the core is not the one this add-on was made with: an update in a running Blender loads the new
    add-on, but the old core stays loaded."""
    where = getattr(module, "__file__", None) or list(getattr(module, "__path__", []))
    found = getattr(module, "__version__", VERSION)
    if found != VERSION:
        raise ImportError(f"riffler {found} is in use, this add-on is {VERSION}: {where}")
    missing = [name for name in NEEDED if not hasattr(module, name)]
    if missing:
        raise ImportError(f"the package riffler at {where} lacks {', '.join(missing)}")


def _forget():
    """Lets Python search for the package again, unless its binary is loaded: a process cannot load a second one."""
    if "riffler._core" in sys.modules:
        return
    for name in [n for n in sys.modules if n == "riffler" or n.startswith("riffler.")]:
        del sys.modules[name]
