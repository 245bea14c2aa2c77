"""Between files, meshes and volumes: what several commands do."""

from __future__ import annotations

from pathlib import Path

from .. import Mesh, Volume
from .arguments import VOLUMES
from .console import Console


def from_mesh(
    path: Path, pitch: float, directions: str, console: Console, step: str, report: dict[str, float] | None = None
) -> Volume:
    """The volume of a mesh file; ``report`` is filled as by Volume.from_mesh."""
    with console.step("read"):
        mesh = Mesh.read(path)
    with console.step(step) as progress:
        try:
            return Volume.from_mesh(mesh, pitch, directions, progress=progress, report=report)
        except ValueError as error:
            raise ValueError(f"{path.name}: {error}") from None


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


def write_left(volume: Volume, path: Path, console: Console) -> int | None:
    """What is left, as a volume or as its mesh, by the file's suffix; the number of triangles of a mesh."""
    if path.suffix.lower() in VOLUMES:
        write_volume(volume, path, console)
        return None
    with console.step("mesh") as progress:
        mesh = volume.to_mesh(progress=progress)
    return write_mesh(mesh, path, console)
