"""Planning: analysis of parts, strategies that find paths, tool orientations, cutter locations, plan files."""

from typing import TYPE_CHECKING

from .. import deprecated, old
from .._core import PencilPath
from ..program_results import NearestContact
from .analysis import PartReport, analyse
from .around import fixture_pitch, with_room
from .curves import read_curves
from .drilling import drill
from .engraving import engrave_operation
from .file import Texts, dumps, load, loads, save
from .finishing import PATTERNS, finish
from .locations import (
    BlockedPoint,
    LiftReport,
    LocationReport,
    UnsafeMove,
    contact_locations,
    cutter_locations,
    drop,
    kept_locations,
    lift,
    path_of_poses,
    poses_of,
)
from .model import Plan, part_of
from .operations import Blocked, ExactFit, Operation, OperationReport
from .orientations import FreeOrientations, TiltReport, draw_map, free_orientations, min_tilt
from .outlining import outline
from .path_order import order_paths
from .penciling import pencil_operation
from .programs import program
from .recorded import NoPathError, Recorded, StrokePath, from_recording, path_of_stroke
from .rest import rest_region
from .roughing import rough
from .setups import Setup
from .strategies import STRATEGIES, Found, Parameter, Strategy, find
from .strategies.engrave import Engraved, engrave
from .strategies.pencil import PencilPaths, PencilStats, pencil
from .strategies.swarf import Swarf, swarf
from .swarfing import swarf_operation

__all__ = [
    "PATTERNS",
    "STRATEGIES",
    "Blocked",
    "BlockedPoint",
    "Engraved",
    "ExactFit",
    "Found",
    "FreeOrientations",
    "LiftReport",
    "LocationReport",
    "NearestContact",
    "NoPathError",
    "Operation",
    "OperationReport",
    "Parameter",
    "PartReport",
    "PencilPath",
    "PencilPaths",
    "PencilStats",
    "Plan",
    "Recorded",
    "Setup",
    "Strategy",
    "StrokePath",
    "Swarf",
    "Texts",
    "TiltReport",
    "UnsafeMove",
    "analyse",
    "contact_locations",
    "cutter_locations",
    "draw_map",
    "drill",
    "drop",
    "dumps",
    "engrave",
    "engrave_operation",
    "find",
    "finish",
    "fixture_pitch",
    "free_orientations",
    "from_recording",
    "kept_locations",
    "lift",
    "load",
    "loads",
    "min_tilt",
    "order_paths",
    "outline",
    "part_of",
    "path_of_poses",
    "path_of_stroke",
    "pencil",
    "pencil_operation",
    "poses_of",
    "program",
    "read_curves",
    "rest_region",
    "rough",
    "save",
    "swarf",
    "swarf_operation",
    "with_room",
]

if not TYPE_CHECKING:
    __getattr__ = deprecated.module_getattr("riffler.plan", old.ALL.modules.get("plan", {}))
