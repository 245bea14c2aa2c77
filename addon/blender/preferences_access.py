"""Read access to the add-on's preferences (preferences.py)."""

from pathlib import Path

import bpy

from . import versions

ROOT = __package__.rpartition(".")[0]  # Blender's name for the add-on, whether extension or legacy add-on
MM = 1000.0  # N·mm/s in one watt


def preferences():
    """None if the add-on was registered without being enabled: then all defaults hold."""
    addon = bpy.context.preferences.addons.get(ROOT)
    return addon.preferences if addon is not None else None


def device():
    """A kind of riffler.pen.kinds."""
    found = preferences()
    return found.device if found is not None else "simulated"


def limits():
    """Limits of every session: options of riffler.Session."""
    found = preferences()
    if found is None:
        return {}
    return {"max_force": found.force, "max_torque": found.torque, "max_power": MM * found.power}


def folder(name):
    """The folder chosen for `name` ("journals", "tools"), or None. FileNotFoundError if it no longer exists."""
    text = getattr(preferences(), name, "")
    if not text:
        return None
    path = Path(text)
    if not path.is_dir():
        raise FileNotFoundError(f"there is no folder {path}: choose another for {name} in Riffler's preferences")
    return path


def cad_python():
    """The path of the Python that reads CAD files, as chosen by the user, or ""."""
    return getattr(preferences(), "cad_python", "")


def target(name):
    """The folder to write to; our own need not exist yet. FileNotFoundError if the chosen one no longer exists."""
    return folder(name) or Path(versions.user_folder(name))


def folders(name):
    """All folders to read from, the one to write to first, so that files from before a change of the preference are
    still found. Folders that no longer exist are left out."""
    own = Path(versions.user_folder(name))
    try:
        first = folder(name)
    except FileNotFoundError:
        first = None
    return [own] if first in (None, own) else [first, own]
