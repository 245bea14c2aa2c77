"""Reads STEP, IGES and BREP files: `read` checks the file and then runs the reader in its own process."""

from __future__ import annotations

import math
import os
import re
import stat
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from .._core import FormatError, Surface
from ..arguments import Progress
from ..hints import hinted
from . import process
from .part import CadPart
from .placing import assemble
from .surfaces import surface_of

KINDS = {".step": "step", ".stp": "step", ".iges": "iges", ".igs": "iges", ".brep": "brep"}
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": 25.4, "foot": 304.8, "micrometre": 0.001}
TIMEOUT = 600.0  # s
BORDERS = 1e-4  # mm: of exact faces, as in `Surface.read`
MOST_FACES = 1_000_000
MOST_TRIANGLES = 50_000_000
FACES = re.compile(rb"(?:ADVANCED_FACE|FACE_SURFACE)\s*\(")
SCHEMA = re.compile(rb"FILE_SCHEMA\s*\(\s*\(\s*'([^']{0,200})'")
HEAD = 65536  # bytes at the start of a file that are searched for its header


@hinted("cad.read")
def read(
    path: str | os.PathLike[str],
    *,
    tolerance: float = 0.01,
    exact: bool = False,
    unit: str | None = None,
    timeout: float = TIMEOUT,
    python: str | os.PathLike[str] | None = None,
    progress: Progress = None,
) -> CadPart:
    """Reads a STEP, IGES or BREP file: heals and tessellates all its bodies, in their places and in mm.

    OpenCASCADE (``pip install 'riffler[cad]'``) runs in a separate process, which ends with the call; a file that
    crashes it does no harm to the caller. Adjacent faces are joined. `CadPart.report` lists repairs and assumptions.

    Parameters
    ----------
    path : path_like
        A file with the extension .step, .stp, .iges, .igs or .brep.
    tolerance : float, mm
        Chord error: largest distance of the exact faces from their triangles. `CadReport.deviation` is the measured
        distance; it is not proven.
    exact : bool
        Also returns the exact faces, as `CadPart.surface`, of the same healed bodies. `plan.Setup` then plans on them.
    unit : str, optional
        Unit of the file's numbers, instead of the unit that the file states: "mm", "cm", "m", "inch", "foot" or
        "micrometre".
    timeout : float, s
        Longest time that reading may take.
    python : path_like, optional
        A Python that has the package cadquery-ocp-novtk. By default the one in the environment variable
        RIFFLER_CAD_PYTHON, or else the Python that makes the call.
    progress : callable or None
        Called with the finished share several times a second; returning False cancels.

    Returns
    -------
    CadPart
        The mesh, and the face of each triangle.

    Raises
    ------
    FormatError
        The file has no faces, is damaged, or does not have the format of its extension.
    ValueError
        An argument is wrong, or the package is missing; the message then has the command that installs it.
    TimeoutError
        Reading took longer than ``timeout``.
    riffler.cad.CadReaderError
        The reader's process crashed.
    Cancelled
        ``progress`` returned False.

    Examples
    --------
    >>> part = riffler.cad.read("part.step", tolerance=0.01)
    >>> part.mesh.audit().open_edges, part.report.closed, part.report.unit
    (0, True, 'inch')
    """
    borders = BORDERS if exact else None
    how: dict[str, Any] = {"unit": unit, "timeout": timeout, "python": python, "progress": progress}
    answer, arrays, schema = answer_to(path, tolerance, borders=borders, **how)
    part = assemble(answer, arrays, Path(path).name, schema, float(tolerance), unit)
    return replace(part, surface=surface_of(answer, arrays, Path(path).name)) if exact else part


def read_surface(path: str | os.PathLike[str], tolerance: float, progress: Progress = None, **how: Any) -> Surface:
    """What `Surface.read` returns; ``how``: further arguments of `answer_to`."""
    answer, arrays, _ = answer_to(path, tolerance, borders=tolerance, mesh=False, progress=progress, **how)
    return surface_of(answer, arrays, Path(path).name)


def answer_to(
    path: str | os.PathLike[str],
    tolerance: float,
    *,
    unit: str | None = None,
    timeout: float = TIMEOUT,
    python: str | os.PathLike[str] | None = None,
    progress: Progress = None,
    borders: float | None = None,
    mesh: bool = True,
) -> tuple[dict[str, Any], dict[str, np.ndarray], str]:
    """The reader's answer, its arrays, and the schema that the file states. With ``borders``, the tolerance of their
    borders (mm), they have the exact faces, and with ``mesh`` the triangles."""
    path = Path(path)
    name = path.name
    kind = KINDS.get(path.suffix.lower())
    if kind is None:
        raise ValueError(f"{name}: a name that ends with {', '.join(KINDS)} expected")
    if not (isinstance(tolerance, int | float) and math.isfinite(tolerance) and tolerance > 0):
        raise ValueError(f"tolerance must be a positive number of mm, not {tolerance!r}")
    if unit is not None and unit not in UNITS:
        raise ValueError(f"unit must be one of {', '.join(UNITS)}, not {unit!r}")
    if not (isinstance(timeout, int | float) and timeout > 0):
        raise ValueError(f"timeout must be a positive number of seconds, not {timeout!r}")
    schema = _check(path, kind)
    request = {
        "path": str(path.resolve()),
        "kind": kind,
        "tolerance": float(tolerance),
        "unit_mm": UNITS[unit] if unit else None,
        "max_triangles": MOST_TRIANGLES,
        "mesh": mesh,
        "borders": None if borders is None else min(float(borders), float(tolerance)),
    }
    timeout = min(float(timeout), 1e7)
    answer, arrays = process.run(request, name, timeout, progress, process.interpreter(python))
    return answer, arrays, schema


# --- checks of the file before the reader starts ----------------------------------------------------------------------


def _check(path: Path, kind: str) -> str:
    """Checks a file and returns the schema that a STEP file states, or the format's name. FormatError if the file is
    not of this kind, or has too many faces."""
    name = path.name
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise FormatError(f"{name}: a file expected, not a folder or a device")
        with open(path, "rb") as stream:
            head = stream.read(HEAD)
    except OSError as error:
        raise FormatError(f"{name}: cannot be read: {error.strerror}") from error
    if not head.strip(b"\0 \t\r\n"):
        raise FormatError(f"{name}: the file is empty; export it again")
    if kind == "step":
        start = head.removeprefix(b"\xef\xbb\xbf").lstrip()
        if start[:2] == b"PK":
            raise FormatError(f"{name}: it is a packed archive; unpack it and read the .step file inside")
        if not start[:13].upper().startswith(b"ISO-10303-21;"):
            raise FormatError(f"{name}: expected a STEP file (ISO 10303-21), which begins with ISO-10303-21;")
        _check_faces(path)
        found = SCHEMA.search(head)
        return found[1].decode("latin-1").split("{")[0].strip() if found else ""
    if kind == "iges":
        line = head.splitlines()[0] if head.splitlines() else b""
        if len(line) < 73 or line[72:73].upper() not in (b"S", b"C", b"B"):
            raise FormatError(f"{name}: expected an IGES file, whose lines have 80 characters with S in column 73")
        return "IGES"
    if b"DBRep_DrawableShape" not in head[:200] and b"CASCADE Topology" not in head[:400]:
        raise FormatError(f"{name}: expected OpenCASCADE's BREP, which begins with DBRep_DrawableShape or its version")
    return "BREP"


def _check_faces(path: Path) -> None:
    count, rest = 0, b""
    with open(path, "rb") as stream:
        while block := stream.read(1 << 22):
            text = rest + block
            count += len(FACES.findall(text))
            rest = text[-32:] if FACES.search(text[-32:]) is None else b""
            if count > MOST_FACES:
                raise FormatError(
                    f"{path.name}: more than {MOST_FACES:,} faces; export the bodies one at a time, without threads, "
                    "lattices and knurls"
                )
