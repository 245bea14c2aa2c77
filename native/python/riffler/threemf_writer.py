"""Writes 3MF files: one mesh in millimetres, as float32. Reading needs lib3mf (threemf.py), which Blender's extension
does not have; writing one mesh takes a zip archive and some XML.

3MF Core Specification 1.3: parts and relationships in 2, units and model in 3.4, meshes in 4.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

import numpy as np

from . import files

TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">\
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>\
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"""
RELATIONS = """<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">\
<Relationship Target="/3D/3dmodel.model" Id="rel0" \
Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"""
MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<metadata name="Application">Riffler</metadata>
<resources><object id="1" type="model" name={name}><mesh>
"""
END = '</mesh></object></resources>\n<build><item objectid="1"/></build>\n</model>\n'
EMPTY = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<metadata name="Application">Riffler</metadata><resources/><build/></model>
"""
ROWS = 50_000  # rows of text at a time, so that writing needs no second copy of the mesh
FAST = 1  # level of zlib: a third more bytes than the usual level, in a quarter of its time
EPOCH = (1980, 1, 1, 0, 0, 0)  # the same mesh gives the same bytes


def write(path, vertices, triangles, name: str = "part") -> None:
    """Writes the file at once; a mesh without triangles gives a model without an object."""
    texts = _model(*_checked(vertices, triangles), name) if len(triangles) else iter([EMPTY])
    for _ in _write(path, texts):
        pass


def count(vertices, triangles) -> int:
    """Number of steps of `pieces`."""
    return -(-len(vertices) // ROWS) - (-len(triangles) // ROWS)


def pieces(path, vertices, triangles, name: str = "part") -> Iterator[None]:
    """Writes the file piece by piece; closing the iterator before its end leaves no file. `vertices` (n, 3) mm,
    `triangles` (k, 3). Nine digits give each float32 back. ValueError for a mesh without triangles and for a vertex
    that no float32 holds."""
    if len(triangles) == 0:
        raise ValueError("the mesh has no triangles; a 3MF file needs at least one")
    yield from _write(path, _model(*_checked(vertices, triangles), name))


def _checked(vertices, triangles):
    with np.errstate(over="ignore"):
        vertices = np.asarray(vertices, np.float32).astype(float)
    if not np.isfinite(vertices).all():
        raise ValueError("the mesh has a vertex that is not finite as float32")
    return vertices, np.asarray(triangles)


def _write(path, texts: Iterator[str]) -> Iterator[None]:
    with files.writing(path) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for part, text in (("[Content_Types].xml", TYPES), ("_rels/.rels", RELATIONS)):
            with _open(archive, part) as stream:
                stream.write(text.encode())
        with _open(archive, "3D/3dmodel.model") as stream:
            for text in texts:
                stream.write(text.encode())
                yield


def _open(archive, name):
    info = zipfile.ZipInfo(name, EPOCH)
    info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
    info._compresslevel = FAST  # pyright: ignore[reportAttributeAccessIssue] (a ZipInfo has no public name for it)
    return archive.open(info, "w", force_zip64=True)


def _model(vertices, triangles, name) -> Iterator[str]:
    """Yields the model's XML in `count` texts and a few short ones."""
    yield MODEL.format(name=quoteattr(name)) + "<vertices>\n"
    yield from _rows('<vertex x="%.9g" y="%.9g" z="%.9g"/>\n', vertices)
    yield "</vertices>\n<triangles>\n"
    yield from _rows('<triangle v1="%d" v2="%d" v3="%d"/>\n', triangles)
    yield "</triangles>\n" + END


def _rows(form: str, rows) -> Iterator[str]:
    for k in range(0, len(rows), ROWS):
        some = rows[k : k + ROWS]
        yield (form * len(some)) % tuple(some.ravel().tolist())
