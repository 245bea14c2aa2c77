"""The cost of a new stock, before it is made."""

from __future__ import annotations

import math

from ...common import units

# Bytes of a ray with at most one interval. The native core's tests hold it to this figure.
BYTES_PER_RAY = 24
# Above this many rays the panel warns: a fresh volume of this size takes about 2.4 GB and seconds to display.
MANY_RAYS = 100_000_000

# Largest number of triangles of a sculpt's mesh. Blender's own arrays end at 178 million, after minutes; a size that
# needs more usually comes from confusing metres with millimetres.
MOST_TRIANGLES = 50_000_000


def check_surface(name: str, size, area: float, pitch: float, remedy: str = "take a coarser pitch") -> None:
    """ValueError if a surface of `area` (mm²) is too large to display at `pitch` (mm). It has two triangles for each
    cell that it crosses, and more if it slopes."""
    triangles = 2 * area / pitch**2
    if triangles > MOST_TRIANGLES:
        raise ValueError(
            f"{name} is {units.format_size(size)}, or {units.format_count(round(triangles))} triangles at "
            f"{units.trim(pitch, 4)} mm: {remedy}; or if one unit should be one millimetre, use Scene in Millimetres"
        )


def check_block(size, pitch: float) -> None:
    """ValueError naming the field if a block of `size` (mm) at `pitch` (mm) is invalid, or too large to display."""
    for axis, side in zip("xyz", size, strict=True):
        if not (math.isfinite(side) and side > 0):
            raise ValueError(f"Size along {axis} must be a positive length in mm, not {side:g}")
        if side < pitch:
            raise ValueError(
                f"Size along {axis} is {side:g} mm, less than the pitch of {pitch:g} mm: make it larger, or use a "
                "finer pitch"
            )
    check_surface("The block", size, box_area(size), pitch)


def too_thin(name: str, pitch: float) -> str:
    """The error for a sculpt whose material lies between the rays, so that its mesh would be empty."""
    return f"{name} is too thin for a pitch of {pitch:g} mm: use a finer one"


def shown_area(triangles: int, pitch: float) -> float:
    """Area (mm²) of a surface that has `triangles` at `pitch`, as `check_surface` counts them."""
    return 0.5 * triangles * pitch**2


def box_area(size) -> float:
    """mm²."""
    x, y, z = size
    return 2 * (x * y + y * z + z * x)


def ray_count(size, pitch: float, directions: str) -> int:
    """Rays of a box of `size` (mm): n = max(1, round(extent / pitch)) per axis, as in the volume."""
    if directions not in ("x", "y", "z", "xyz"):
        raise ValueError(f"directions must be x, y, z or xyz, not {directions!r}")
    if not (math.isfinite(pitch) and pitch > 0):
        raise ValueError(f"pitch must be positive, not {pitch}")
    if len(size) != 3 or not all(math.isfinite(s) and s > 0 for s in size):
        raise ValueError(f"size must be three positive lengths, not {tuple(size)}")
    # half up, as in the core: Python's round() rounds half to even
    nx, ny, nz = (max(1, math.floor(s / pitch + 0.5)) for s in size)
    across = {"x": ny * nz, "y": nz * nx, "z": nx * ny}
    return sum(across[d] for d in directions)
