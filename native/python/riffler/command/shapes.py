"""Conversions between files, meshes and volumes that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .. import Mesh, Orientation, Volume, VolumeReport, cad
from ..formats import VOLUMES
from ..mesh_notes import notes_on
from ..results import LostReport
from .console import Console
from .detail import Detail, Written, announce


def read_mesh(
    path: Path, console: Console, *, tolerance: float = 0.01, progress: Callable[[float], None] | None = None
) -> Mesh:
    """A mesh file, or a CAD file within a chord error of ``tolerance`` mm; prints what was mended and assumed of it."""
    if path.suffix.lower() not in cad.EXTENSIONS:
        return Mesh.read(path)
    part = cad.read(path, tolerance=tolerance, progress=progress)
    for note in part.report.notes:
        console.warning(f"{path.name}: {note}")
    return part.mesh


def from_mesh(
    path: Path,
    pitch: float | Callable[[Mesh], float],
    directions: str,
    console: Console,
    step: str,
) -> tuple[Volume, VolumeReport]:
    """The volume of a mesh file and its report; prints repairs and losses. ``pitch`` may be a function of the mesh."""
    with console.step("read") as progress:
        mesh = read_mesh(path, console, progress=progress)
    spacing = pitch(mesh) if callable(pitch) else pitch
    with console.step(step) as progress:
        try:
            volume, report = Volume.from_mesh_with_report(mesh, spacing, directions, progress=progress)
        except ValueError as error:
            raise ValueError(f"{path.name}: {error}") from None
    tell(path.name, report, console)
    return volume, report


def read_exact(path: Path, console: Console) -> cad.CadPart:
    """The part of a CAD file with its exact faces; prints what was mended and assumed of it."""
    if path.suffix.lower() not in cad.EXTENSIONS:
        raise ValueError(
            f"--exact: {path.name} has triangles only; give a file that ends with {', '.join(cad.EXTENSIONS)}"
        )
    part = cad.read(path, exact=True)
    for note in part.report.notes:
        console.warning(f"{path.name}: {note}")
    return part


def read_part(path: Path, console: Console, hollow: bool = False) -> Mesh:
    """The mesh of a file, unchanged, because plans identify a part by its checksum. Prints what riffler turns to use
    the mesh as a solid."""
    mesh = read_mesh(path, console)
    _, report = mesh.orient_with_report(hollow=hollow)
    tell(path.name, report, console)
    return mesh


def to_mesh(volume: Volume, console: Console, out: Path, detail: Detail) -> tuple[Mesh, Written]:
    """The mesh of a volume for the file ``out``. Prints on stderr which material is too thin for a mesh; ValueError if
    all material is."""
    tolerance = detail.of(volume)
    with console.step("mesh") as progress:
        mesh, report = volume.to_mesh_with_report(tolerance=tolerance, progress=progress)
    if len(mesh.triangles):
        tell(out.name, report, console)
        announce(out, len(mesh.triangles), report, tolerance, console)
    elif report.lost_note:
        raise ValueError(f"{out.name} not written: {report.lost_note}")
    else:
        console.warning(f"{out.name}: no material is left, so the mesh has no triangles")
    return mesh, Written(len(mesh.triangles), report.all_triangles, tolerance)


def tell(name: str, report: Orientation | LostReport, console: Console) -> None:
    for note in notes_on(report):
        console.warning(f"{name}: {note}")


def write_mesh(mesh: Mesh, path: Path, console: Console) -> int:
    """Writes the file and returns the number of triangles."""
    with console.step("write"), console.writing(path) as beside:
        mesh.write(beside)
    return len(mesh.triangles)


def write_volume(volume: Volume, path: Path, console: Console) -> None:
    with console.step("write") as progress, console.writing(path) as beside:
        volume.save(beside, progress=progress)


def rays(volume: Volume) -> int:
    return int(volume.rays)


def write_left(volume: Volume, path: Path, console: Console, detail: Detail) -> Written | None:
    """Writes the material that is left as a volume or as its mesh, by the file's suffix. Returns None for a volume."""
    if path.suffix.lower() in VOLUMES:
        write_volume(volume, path, console)
        return None
    mesh, written = to_mesh(volume, console, path, detail)
    write_mesh(mesh, path, console)
    return written
