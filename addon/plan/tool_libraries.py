"""The folders of tool libraries, and their tools."""

import riffler

from ..blender import preferences_access
from .pure import tool_library


def folders():
    """Folders of tool files."""
    return preferences_access.folders("tools")


def target():
    """Folder for saving a tool. FileNotFoundError if the chosen folder no longer exists."""
    return preferences_access.target("tools")


def files():
    """The tools of all folders, and a line for each file that cannot be read, and for a chosen folder that no longer
    exists. Our own folder may not exist yet."""
    entries, problems = [], []
    try:
        preferences_access.folder("tools")
    except FileNotFoundError as error:
        problems.append(str(error))
    for folder in folders():
        if folder.is_dir():
            found, bad = tool_library.scan(folder, riffler.Tool.from_dict)
            entries += found
            problems += bad
    return entries, problems


def tool(name, path=""):
    """The dictionary of a tool: from a file, or, if `path` is empty, from the presets. ValueError lists the available
    ones."""
    entries = tool_library.read(path, riffler.Tool.from_dict) if path else tool_library.shipped()
    return dict(tool_library.find(entries, name).tool) if name or not path else dict(entries[0].tool)
