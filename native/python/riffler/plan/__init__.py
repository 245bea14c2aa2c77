"""Planning: parts looked at, pencil cuts found on a part, tool orientations, cutter locations, and other strategies."""

from .._core import PencilPath
from .analysis import analyse
from .around import fixture_pitch, with_room
from .file import Plan, Texts, dumps, load, loads, part_of, save
from .locations import LocationReport, contact_locations, cutter_locations, drop, lift
from .orientations import FreeOrientations, draw_map, free_orientations, least_tilt
from .pencils import PencilPaths, linked, pencil
from .strategies import Engraved, Swarf, engrave, swarf

__all__ = [
    "Engraved",
    "FreeOrientations",
    "LocationReport",
    "PencilPath",
    "PencilPaths",
    "Plan",
    "Swarf",
    "Texts",
    "analyse",
    "contact_locations",
    "cutter_locations",
    "draw_map",
    "drop",
    "dumps",
    "engrave",
    "fixture_pitch",
    "free_orientations",
    "least_tilt",
    "lift",
    "linked",
    "load",
    "loads",
    "part_of",
    "pencil",
    "save",
    "swarf",
    "with_room",
]
