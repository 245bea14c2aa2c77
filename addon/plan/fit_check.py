"""Whether a plan fits the scene's current state: whether its tool is the Tool panel's, and its part unchanged since the
paths were found. Checks and NC code always use the plan's tool."""

import riffler

from ..blender import object_surfaces, scene_units
from ..common import units
from . import tool_icons
from .pure import size_guess


def tool_of_scene(settings):
    """The riffler.Tool of the Tool panel. ValueError if it is invalid."""
    return riffler.Tool.from_dict(settings.tool_dict())


def _shape(tool):
    """What makes two tools equal; their names do not count."""
    return {key: value for key, value in tool.to_dict().items() if key != "name"}


def _sized(scene):
    """The part and the unit that a confirmation of its size holds for."""
    return f"{scene.riffler.plan.part.name} {scene_units.mm_per_unit(scene):g}"


def accept_size(scene):
    """Confirms the part's size, so that there is no question about it again."""
    if scene.riffler.plan.part is not None:
        scene.riffler.plan.sized = _sized(scene)


def size_question(scene):
    """The question about the part's size, or "" if it is usual or confirmed."""
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
    """True if the tools have the same cutter, so that paths of one are paths of the other, even with another shank
    or holder."""
    return tool_icons.cutter(_shape(a)) == tool_icons.cutter(_shape(b))


def tool_note(settings, tool):
    """A note if a plan's tool differs from the panel's, or ""."""
    try:
        wanted = tool_of_scene(settings)
    except ValueError:
        return ""  # the panel shows the error
    if _shape(wanted) == _shape(tool):
        return ""
    said = f"Planned with {tool.name}, not with the Tool panel's tool"
    if same_cutter(wanted, tool):
        return f"{said}: Use This Tool takes its shank and holder, and keeps the keys"
    return f"{said}, whose cutter needs paths of its own"


def part_note(plan, taken):
    """A note if a part differs from the one the paths were found on, or "". `taken`: an obstacles.Taken."""
    if plan.part.get("sha256") in (None, taken.prints[0]):
        return ""
    return f"{taken.who[0]} was moved or changed since its paths were found: move it back, or use Find Again"


def notes(context, plan, taken):
    """All notes, as sentences."""
    said = (tool_note(context.scene.riffler.plan, plan.tool), part_note(plan, taken))
    return [note for note in said if note]
