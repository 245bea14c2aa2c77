"""Building blocks of the panels of all features."""

from ..common import diagnosis
from ..translations import local
from . import versions


class Sidebar:
    """Mixin of panels in the artists' tab: sculpting comes first, by bl_order; machining comes last."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Riffler"


def lines(layout, *texts, icon="NONE"):
    column = layout.column(align=True)
    column.scale_y = 0.8
    for k, text in enumerate(texts):
        column.label(text=text, icon=icon if k == 0 else ("BLANK1" if icon != "NONE" else "NONE"))


def give(op, settings, group):
    """Gives a button's operator the panel's settings: the fields of `group`, which both have."""
    for key in group.__annotations__:
        setattr(op, key, getattr(settings, key))


def at_work(layout, context, *operators):
    """True while one of these operators runs. Its progress then replaces the buttons, so that the layout
    does not move."""
    state = context.window_manager.riffler
    if state.running not in {operator.doing for operator in operators}:
        return False
    versions.progress(layout, state)
    layout.label(text=state.text)
    return True


def wrapped(context, text):
    """A text as lines that fit the sidebar, whose labels do not wrap; translated as a whole."""
    width = max(24, int(context.region.width / (7.2 * context.preferences.system.ui_scale)) - 6)
    return diagnosis.wrap(local(text), width)
