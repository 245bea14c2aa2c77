"""What panels of every feature are made of."""

from ..common import diagnosis
from ..translations import local
from . import versions


class Sidebar:
    """In the tab of artists: what is sculpted and with what comes first, by bl_order; machining comes last."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Riffler"


def lines(layout, *texts, icon="NONE"):
    column = layout.column(align=True)
    column.scale_y = 0.8
    for k, text in enumerate(texts):
        column.label(text=text, icon=icon if k == 0 else ("BLANK1" if icon != "NONE" else "NONE"))


def give(op, settings, group):
    """A button's operator gets what the panel shows: the fields of `group`, which both have."""
    for key in group.__annotations__:
        setattr(op, key, getattr(settings, key))


def at_work(layout, context, *operators):
    """True where one of these runs, whose progress takes the place of the buttons, so that nothing moves."""
    state = context.window_manager.riffler
    if state.running not in {operator.doing for operator in operators}:
        return False
    versions.progress(layout, state)
    layout.label(text=state.text)
    return True


def wrapped(context, text):
    """The sidebar's labels do not wrap: fitted to its width, and looked up whole."""
    width = max(24, int(context.region.width / (7.2 * context.preferences.system.ui_scale)) - 6)
    return diagnosis.wrap(local(text), width)
