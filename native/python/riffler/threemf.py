"""Reads 3MF files with the 3MF Consortium's lib3mf. ``Mesh.read`` and ``Mesh.write`` come here for ``.3mf``.

lib3mf keeps coordinates in float32. Its C interface fills whole arrays in numpy's storage; its Python classes would
make an object of every vertex.
"""

from __future__ import annotations

import codecs
import ctypes
import io
import locale
import re
import threading
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from . import files, threemf_writer
from ._core import FormatError

# mm in one unit of a file; 3MF has no others.
UNITS = {"MicroMeter": 0.001, "MilliMeter": 1.0, "CentiMeter": 10.0, "Inch": 25.4, "Foot": 304.8, "Meter": 1000.0}
DEEPEST = 64  # components within components
MOST_PLACED = 10_000  # meshes and components: lib3mf takes some 0.3 ms for each
MOST_BYTES = 1 << 32  # unpacked
MOST_TRIANGLES = 50_000_000  # of all copies together; without a bound, some kilobytes could ask for any number
LARGEST = 1e30


def library() -> Any:
    """The module lib3mf, or ValueError if its package is missing."""
    try:
        import lib3mf
    except ImportError as error:
        raise ValueError("a .3mf file needs the package lib3mf (pip install riffler[3mf])") from error
    return lib3mf


class LocaleKeeper:
    """Keeps the process's locale. lib3mf sets the locale of the whole process to "C" when it reads and writes; text in
    other languages would then be misread. The first of several threads stores the locale, the last one restores it.
    """

    def __init__(self) -> None:
        self.lock, self.threads, self.before = threading.Lock(), 0, ""

    def __enter__(self) -> None:
        with self.lock:
            if self.threads == 0:
                self.before = locale.setlocale(locale.LC_ALL)
            self.threads += 1

    def __exit__(self, *_: object) -> None:
        with self.lock:
            self.threads -= 1
            if self.threads == 0:
                locale.setlocale(locale.LC_ALL, self.before)


LOCALE = LocaleKeeper()


def read(path: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) in mm and triangles (k, 3) of everything in the file's build, as one mesh.

    Applies the transforms of items and components; leaves out those that are support.
    """
    lib, name = library(), Path(path).name
    data = files.read(path)
    check_copies(data, name)
    try:
        model = lib.get_wrapper().CreateModel()
        reader = model.QueryReader("3mf")
        with LOCALE:
            reader.ReadFromBuffer((ctypes.c_uint8 * len(data)).from_buffer_copy(data) if data else [])
        # lib3mf skips unknown elements: a misspelt triangle would be missing, a misspelt unit would be mm. It does not
        # warn of elements in other namespaces, such as slicers' additions.
        if reader.GetWarningCount():
            raise FormatError(f"{name}: {reader.GetWarning(0)[1]} Expected elements of 3MF's core specification")
        pieces = list(Build(lib, model, name).pieces())
        scale = UNITS[model.GetUnit().name]
    except lib.ELib3MFException as error:
        raise FormatError(f"{name}: expected a 3MF package with a model: {said(error)}") from error
    vertices = [vertices for vertices, _ in pieces]
    starts = np.cumsum([0, *(len(v) for v in vertices)])
    triangles = [triangles + start for (_, triangles), start in zip(pieces, starts[:-1], strict=True)]
    if not any(len(t) for t in triangles):
        raise FormatError(f"{name}: zero triangles; expected a build item with a mesh")
    placed = scale * np.concatenate(vertices)
    if not (abs(placed) <= LARGEST).all():
        row = int(np.flatnonzero(~(abs(placed) <= LARGEST).all(1))[0])
        raise FormatError(f"{name}: vertex {row} is not finite or beyond 1e30; expected coordinates in mm")
    return placed, np.concatenate(triangles)


TAG = re.compile(rb"""<(?:[\w.-]+:)?(object|component|item)\b((?:[^>"']|"[^"]*"|'[^']*')*)>""")
ATTRIBUTE = re.compile(rb"""(?:^|[\s:])(id|objectid|path)\s*=\s*(?:"([^"]*)"|'([^']*)')""")


def check_copies(data: bytes, name: str) -> None:
    """FormatError for a package that asks for more copies than can be made.

    lib3mf follows a component while it reads, once for each placement, so it must not read such a file.
    """
    count = copies(tags(data, name), name)
    if count > MOST_PLACED:
        raise FormatError(f"{name}: more than {MOST_PLACED} meshes and components to build, copies counted")


Key = tuple[str, bytes]  # a part of the package and an object's number in it


def tags(data: bytes, name: str) -> tuple[dict[Key, list[Key]], list[Key]]:
    """The components of every object, and the items to build."""
    objects: dict[Key, list[Key]] = {}
    build: list[Key] = []
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > MOST_BYTES:
                raise FormatError(f"{name}: more than {MOST_BYTES} bytes when it is unpacked")
            for part in archive.namelist():
                if not part.lower().endswith(".model"):
                    continue
                text = archive.read(part)
                if b"\0" in text[:4] or text[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):
                    text = text.decode("utf-16", "replace").encode()
                here: list[Key] = []
                for tag, rest in TAG.findall(text):
                    said = {key: a or b for key, a, b in ATTRIBUTE.findall(rest)}
                    other = said.get(b"path", b"").decode("utf-8", "replace").lstrip("/") or part
                    if tag == b"object":
                        here = objects.setdefault((part.lstrip("/"), said.get(b"id", b"")), [])
                    else:
                        (here if tag == b"component" else build).append((other.lstrip("/"), said.get(b"objectid", b"")))
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError) as error:
        raise FormatError(f"{name}: expected a 3MF package with a model: {error}") from error
    return objects, build


def copies(found: tuple[dict[Key, list[Key]], list[Key]], name: str) -> int:
    """Number of meshes and components that the build places."""
    objects, build = found
    count: dict[Key, int] = {}

    def of(start: Key) -> int:
        stack = [start]  # no recursion: chains may be long
        inside = set()
        while stack:
            at = stack[-1]
            waiting = [part for part in objects.get(at, ()) if part not in count]
            if at in count or not waiting:
                count[at] = min(MOST_PLACED + 1, 1 + sum(count[part] for part in objects.get(at, ())))
                inside.discard(stack.pop())
                continue
            inside.add(at)
            if waiting[0] in inside or len(stack) > DEEPEST:
                raise FormatError(f"{name}: components within components, more than {DEEPEST} deep; expected no loop")
            stack.append(waiting[0])
        return count[start]

    return max(sum(map(of, build)), *map(of, objects), 0)


class Build:
    """The build of a file. Reads each mesh once, however often it is placed, and counts copies before making them."""

    def __init__(self, lib: Any, model: Any, name: str) -> None:
        self.lib, self.model, self.name = lib, model, name
        self._meshes: dict[int, tuple[np.ndarray, np.ndarray]] = {}
        self._placed = self._triangles = 0

    def pieces(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yields vertices and triangles of every mesh to build, placed, in the file's unit."""
        iterator = self.model.GetBuildItems()
        while iterator.MoveNext():
            item = iterator.GetCurrent()
            place = matrix(item.GetObjectTransform()) if item.HasObjectTransform() else np.eye(4, 3)
            yield from self._place(item.GetObjectResource(), place, 0)

    def _place(self, thing: Any, place: np.ndarray, depth: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        if depth > DEEPEST:
            raise FormatError(f"{self.name}: components within components, more than {DEEPEST} deep; expected no loop")
        self._placed += 1
        if self._placed > MOST_PLACED:
            raise FormatError(f"{self.name}: more than {MOST_PLACED} meshes and components to build")
        if thing.GetType() in (self.lib.ObjectType.Support, self.lib.ObjectType.SolidSupport):
            return
        if thing.IsMeshObject():
            vertices, triangles = self._mesh(thing.GetResourceID())
            self._triangles += len(triangles)
            if self._triangles > MOST_TRIANGLES:
                raise FormatError(f"{self.name}: more than {MOST_TRIANGLES} triangles to build, copies counted")
            if np.linalg.det(place[:3]) < 0:  # mirrored: the corners' order is reversed
                triangles = triangles[:, ::-1]
            yield vertices @ place[:3] + place[3], triangles
        elif thing.IsComponentsObject():
            parts = self.model.GetComponentsObjectByID(thing.GetResourceID())
            for k in range(parts.GetComponentCount()):
                part = parts.GetComponent(k)
                inner = matrix(part.GetTransform()) if part.HasTransform() else np.eye(4, 3)
                together = np.concatenate([inner[:3] @ place[:3], inner[3:] @ place[:3] + place[3]])
                yield from self._place(part.GetObjectResource(), together, depth + 1)

    def _mesh(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        if number not in self._meshes:
            self._meshes[number] = geometry(self.lib, self.model.GetMeshObjectByID(number))
        return self._meshes[number]


def matrix(transform: Any) -> np.ndarray:
    """(4, 3) matrix of a transform, by which 3MF multiplies the row (x, y, z, 1)."""
    return np.array([list(row) for row in transform.Fields], float)


def geometry(lib: Any, mesh: Any) -> tuple[np.ndarray, np.ndarray]:
    vertices = (lib.Position * mesh.GetVertexCount())()
    triangles = (lib.Triangle * mesh.GetTriangleCount())()
    for call, items in (
        (mesh._wrapper.lib.lib3mf_meshobject_getvertices, vertices),
        (mesh._wrapper.lib.lib3mf_meshobject_gettriangleindices, triangles),
    ):
        needed = ctypes.c_uint64(0)
        mesh._wrapper.checkError(mesh, call(mesh._handle, ctypes.c_uint64(len(items)), needed, items))
    points = np.frombuffer(vertices, np.float32).reshape(-1, 3).astype(float)
    indices = np.frombuffer(triangles, np.uint32).reshape(-1, 3).astype(np.int64)
    return points, indices


def write(path: str, vertices: np.ndarray, triangles: np.ndarray) -> None:
    """Writes one object with one build item, in mm; the whole file or none."""
    threemf_writer.write(path, vertices, triangles)


def said(error: Exception) -> str:
    """The message of an error, or the name of its type if the message is empty."""
    return str(error).strip() or type(error).__name__
