"""Planning: parts looked at, strategies that find paths, tool orientations, cutter locations, plans as files."""

from .._core import PencilPath
from .analysis import analyse
from .around import fixture_pitch, with_room
from .curves import read_curves
from .file import Plan, Texts, dumps, load, loads, part_of, save
from .locations import (
    LocationReport,
    contact_locations,
    cutter_locations,
    drop,
    kept_locations,
    lift,
    path_of_poses,
    poses_of,
)
from .orientations import FreeOrientations, draw_map, free_orientations, least_tilt
from .path_order import linked
from .strategies import STRATEGIES, Found, Parameter, Strategy, find
from .strategies.engrave import Engraved, engrave
from .strategies.pencil import PencilPaths, pencil
from .strategies.swarf import Swarf, swarf

__all__ = [
    "STRATEGIES",
    "Engraved",
    "Found",
    "FreeOrientations",
    "LocationReport",
    "Parameter",
    "PencilPath",
    "PencilPaths",
    "Plan",
    "Strategy",
    "Swarf",
    "Texts",
    "analyse",
    "contact_locations",
    "cutter_locations",
    "draw_map",
    "drop",
    "dumps",
    "engrave",
    "find",
    "fixture_pitch",
    "free_orientations",
    "kept_locations",
    "least_tilt",
    "lift",
    "linked",
    "load",
    "loads",
    "part_of",
    "path_of_poses",
    "pencil",
    "poses_of",
    "read_curves",
    "save",
    "swarf",
    "with_room",
]
