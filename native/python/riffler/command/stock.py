"""Stock on the command line: a block, a sphere, a cylinder, a mesh or a volume."""

from __future__ import annotations

import argparse

import numpy as np

from .. import Volume
from ..formats import PARTS, VOLUMES
from .arguments import ORIGINS, add_directions, add_pitch, input_file, is_solid, length, solid
from .console import Console
from .parser import Parser
from .shapes import from_mesh


def add_stock(parser: Parser) -> None:
    """Adds the options that `stock` reads."""
    parser.add_argument(
        "--stock",
        required=True,
        metavar="STOCK",
        help="WxDxH, sphere:D, cylinder:D:H (along z), or a .stl, .obj, .ply, .3mf, .step, .iges, .brep or .rvol file",
    )
    parser.offer("stock", ("sphere:", "cylinder:"), PARTS + VOLUMES)
    add_pitch(parser, required=False, more=" (a .rvol file has its own)")
    add_directions(parser)
    parser.add_argument(
        "--origin",
        metavar="X,Y,Z",
        help=f"lower corner of a stock of given sizes (default 0,0,0), or one of {', '.join(ORIGINS)}",
    )
    parser.offer("origin", ORIGINS)


def stock(arguments: argparse.Namespace, console: Console) -> Volume:
    """The volume to carve: a block, sphere or cylinder, a mesh or a .rvol file."""
    pitch = None if arguments.pitch is None else length(arguments.pitch, "--pitch")
    if is_solid(arguments.stock):
        kind, lower, upper = solid(arguments.stock, arguments.origin or "corner")
        if pitch is None:
            raise ValueError(f"--pitch is needed for a {kind}")
        with console.step("stock"):
            return _solid(kind, np.array(lower), np.array(upper), pitch, arguments.directions or "xyz")
    path = input_file(arguments.stock, PARTS + VOLUMES)
    if arguments.origin is not None:
        raise ValueError(f"--origin is for stock of given sizes; {path.name} has its own place")
    if path.suffix.lower() in VOLUMES:
        with console.step("stock") as progress:
            volume = Volume.load(path, progress=progress)
        if pitch is not None and pitch != volume.pitch:
            raise ValueError(f"{path.name} has pitch {volume.pitch} mm, not the {pitch} of --pitch")
        if arguments.directions not in (None, volume.directions):
            raise ValueError(f"{path.name} has directions {volume.directions}, not {arguments.directions}")
        return volume
    if pitch is None:
        raise ValueError(f"--pitch is needed for {path.name}")
    return from_mesh(path, pitch, arguments.directions or "xyz", console, "stock")[0]


def _solid(kind: str, lower: np.ndarray, upper: np.ndarray, pitch: float, directions: str) -> Volume:
    """The block, sphere or cylinder that fills the box; the box's corners are kept exactly."""
    if kind == "block":
        return Volume.block(lower, upper, pitch, directions)
    centre, (w, _, h) = 0.5 * (lower + upper), upper - lower
    if kind == "sphere":
        return Volume.sphere(centre, 0.5 * w, pitch, directions, lower=lower, upper=upper)
    return Volume.cylinder(centre, 0.5 * w, h, pitch, directions, lower=lower, upper=upper)
