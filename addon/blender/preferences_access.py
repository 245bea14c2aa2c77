"""What the user has chosen in the add-on's preferences (preferences.py), for whoever goes by it."""

from pathlib import Path

import bpy

from . import versions

ROOT = __package__.rpartition(".")[0]  # what Blender knows the add-on by, in whatever way it was installed
MM = 1000.0  # N·mm/s in one watt


def preferences():
    """None where the add-on was registered without being enabled: then everything is as it comes."""
    addon = bpy.context.preferences.addons.get(ROOT)
    return addon.preferences if addon is not None else None


def device():
    """A kind of riffler.pen.kinds."""
    found = preferences()
    return found.device if found is not None else "simulated"


def limits():
    """What no session lets through more than: options of riffler.Session."""
    found = preferences()
    if found is None:
        return {}
    return {"max_force": found.force, "max_torque": found.torque, "max_power": MM * found.power}


def folder(name):
    """The one that was chosen for `name` ("journals", "tools"), or None. FileNotFoundError where it is gone."""
    text = getattr(preferences(), name, "")
    if not text:
        return None
    path = Path(text)
    if not path.is_dir():
        raise FileNotFoundError(f"there is no folder {path}: choose another for {name} in Riffler's preferences")
    return path


def target(name):
    """The one that is written to; our own need not be there yet. FileNotFoundError where the chosen one is gone."""
    return folder(name) or Path(versions.user_folder(name))


def folders(name):
    """All that may hold something, the one that is written to first: what was kept before another was chosen is still
    found. A folder that is gone is left out."""
    own = Path(versions.user_folder(name))
    try:
        first = folder(name)
    except FileNotFoundError:
        first = None
    return [own] if first in (None, own) else [first, own]
