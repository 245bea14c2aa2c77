"""Whether a plan fits the scene as it is now: its tool the one of the Tool panel, its part what it was when the paths
were found. What is looked at and written is always the plan's tool."""

import riffler

from ..blender import object_surfaces, scene_units
from ..common import units
from . import tool_icons
from .pure import size_guess


def tool_of_scene(settings):
    """The riffler.Tool of the Tool panel. ValueError where it is none."""
    return riffler.Tool.from_dict(settings.tool_dict())


def _shape(tool):
    """What two tools are the same by; a name is none of it."""
    return {key: value for key, value in tool.to_dict().items() if key != "name"}


def _sized(scene):
    """The part and the unit that an answer about its size holds for."""
    return f"{scene.riffler.plan.part.name} {scene_units.mm_per_unit(scene):g}"


def accept_size(scene):
    """The part has the size that it should have: it is not asked about again."""
    if scene.riffler.plan.part is not None:
        scene.riffler.plan.sized = _sized(scene)


def size_question(scene):
    """What is to be asked of the part's size, as a text; nothing where it is as parts are, or was said to be right."""
    settings = scene.riffler.plan
    if object_surfaces.unfit(settings.part, scene) or settings.sized == _sized(scene):
        return ""
    try:
        diameter = tool_of_scene(settings).diameter
    except ValueError:
        return ""
    largest = float(max(object_surfaces.size(settings.part, scene)))
    if not size_guess.odd(largest, diameter):
        return ""
    return (
        f"{settings.part.name} is {units.trim(largest, 3)} mm long, {size_guess.ratio(largest, diameter)} the tool's "
        f"diameter: what is one unit of the scene?"
    )


def same_cutter(a, b):
    """True where the paths of one are those of the other, whatever shank and holder they have."""
    return tool_icons.cutter(_shape(a)) == tool_icons.cutter(_shape(b))


def tool_note(settings, tool):
    """What is to be said of a plan's tool that is not the panel's, or nothing."""
    try:
        wanted = tool_of_scene(settings)
    except ValueError:
        return ""  # the panel says what is wrong with it
    if _shape(wanted) == _shape(tool):
        return ""
    said = f"Planned with {tool.name}, not with the Tool panel's tool"
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
