"""Whether a plan fits the scene as it is now: its tool the one of the Tool panel, its part what it was when the paths
were found. What is looked at and written is always the plan's tool."""

import riffler

from . import tool_pictures


def tool_of_scene(settings):
    """The riffler.Tool of the Tool panel. ValueError where it is none."""
    return riffler.Tool.from_dict(settings.tool_dict())


def _shape(tool):
    """What two tools are the same by; a name is none of it."""
    return {key: value for key, value in tool.to_dict().items() if key != "name"}


def same_cutter(a, b):
    """True where the paths of one are those of the other, whatever shank and holder they have."""
    return tool_pictures.cutter(_shape(a)) == tool_pictures.cutter(_shape(b))


def tool_note(settings, tool):
    """What is to be said of a plan's tool that is not the panel's, or nothing."""
    try:
        wanted = tool_of_scene(settings)
    except ValueError:
        return ""  # the panel says what is wrong with it
    if _shape(wanted) == _shape(tool):
        return ""
    said = f"Planned with {tool.name}, not with what the Tool panel has"
    if same_cutter(wanted, tool):
        return f"{said}: Use This Tool takes its shank and holder, and keeps the keys"
    return f"{said}, whose cutter needs paths of its own"


def part_note(plan, taken):
    """What is to be said of a part that is not the one that the paths were found on, or nothing. `taken`: a
    surroundings.Taken."""
    if plan.part.get("sha256") in (None, taken.prints[0]):
        return ""
    return f"{taken.who[0]} was moved or changed since its paths were found: move it back, or use Find Again"


def notes(context, plan, taken):
    """All of it, as sentences."""
    said = (tool_note(context.scene.riffler.plan, plan.tool), part_note(plan, taken))
    return [note for note in said if note]
