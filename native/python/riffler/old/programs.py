"""Old names of programs, machines, verification, planning, journals, sessions and pens."""

from __future__ import annotations

from collections.abc import Callable

from .._core import Journal, Mesh, Tool
from ..deprecated import Old, warn


def _has(place: int, kind: type) -> Callable[[tuple], bool]:
    """Whether the positional argument with that number is of a type."""
    return lambda args: len(args) > place and isinstance(args[place], kind)


def _replay_with_mask(call: Callable, args: tuple, kwargs: dict) -> object:
    """Makes a call of ``Journal.replay(…, with_mask=…)``, which returned volume and mask, or the volume alone."""
    warn("Journal.replay(with_mask=…)", "Journal.replay_with_mask")
    return Journal.replay_with_mask(*args, **kwargs) if kwargs.pop("with_mask") else call(*args, **kwargs)


_STROKES = {
    "add_stroke": ("tool", "poses", "times", "tolerance", "name"),
    "extend_stroke": ("poses", "times"),
    "set_stock": ("lower", "upper", "pitch", "directions", "snapshot"),
}

OLD = Old(
    modules={
        "plan": {"least_tilt": "min_tilt", "linked": "order_paths"},
    },
    attributes={
        "Journal": {"read": "load", "write": "save", "take_back": "undo", "bring_back": "redo"},
        "JournalWriter": {"take_back": "undo", "bring_back": "redo"},
        "LocationReport": {"least_clearance": "min_clearance"},
        "PencilPath": {"oriented": "orient"},
        "Program": {"retimed": "scale_feeds", "retooled": "renumber_tools"},
        "SessionFrame": {"untold": "dropped_ticks"},
        "VerifyReport": {"deviation": "stock_deviation()", "part_map": "part_deviation()"},
    },
    keywords={
        "Pointer.set_frame": {"most_tilt": "max_tilt"},
    },
    positional={
        **{f"{owner}.{name}": names for owner in ("Journal", "JournalWriter") for name, names in _STROKES.items()},
        "Journal.program": ("feed", "spindle"),
        "Journal.replay": ("folder", "progress"),
        "PenGeometry.homed": ("counts", "probe"),
        "PencilPath.__init__": ("radius", "centres", "contacts", "normals", "closed"),
        "PencilPath.nearest": ("point", "direction"),
        "PencilPath.orient": ("keys", "interpolation"),
        "PencilPath.with_axes": ("axes", "keys", "interpolation"),
        "Program.__init__": (
            "poses", "feed", "rapid", "tool", "line", "spindle", "tools", "provenance", "notes", "at_machine", "via",
        ),
        "Program.from_cl": ("cl", "tools", "feed", "spindle"),
        "Program.load": ("path", "progress"),
        "Program.read": ("path", "machine", "options"),
        "Program.save": ("path", "progress"),
        "Program.stream": ("path", "machine", "options", "rows"),
        "Program.write": ("path", "post", "tolerance", "axis_tolerance", "options"),
        "Session.journal": ("path", "notes"),
        "Session.replay": ("path", "progress"),
        "Verification.run": ("program", "progress"),
        "machine_options": ("machine", "options"),
        "plan.cutter_locations": ("path", "tool", "collider", "clearance"),
        "plan.draw_map": ("orientations", "axes"),
        "plan.dumps": ("plan", "texts"),
        "plan.loads": ("data", "name"),
        "plan.order_paths": ("paths", "start"),
        "plan.path_of_poses": ("poses", "contacts", "normals", "height"),
        "plan.pencil": ("part_mesh", "tool", "tolerance", "passes", "progress"),
    },
    adapted={
        "Journal.replay": {"with_mask": _replay_with_mask},
    },
    reordered={
        "plan.contact_locations": (("tool", "contacts", "normals", "axes", "feeds"), _has(0, Tool)),
        "plan.drop": (("tool", "points", "part_mesh", "axis", "progress"), _has(0, Tool)),
        "plan.engrave": (("part_mesh", "curves", "tool", "depth", "progress"), _has(0, Mesh)),
        "plan.free_orientations": (("path", "index", "tool", "collider"), _has(2, Tool)),
        "plan.kept_locations": (("path", "depth", "tool", "collider", "clearance"), _has(2, Tool)),
        "plan.lift": (("tool", "poses", "collider", "clearance"), _has(0, Tool)),
        "plan.swarf": (("path", "part_mesh", "tool", "side", "progress"), _has(1, Mesh)),
    },
)  # fmt: skip
