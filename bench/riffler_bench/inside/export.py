"""Exports a sculpt as a binary STL: with the add-on's operator, from the volume, and with Blender's own, from its mesh;
to the same folder, in turn. Reports time, bytes and facets of each."""

from pathlib import Path

import bpy
import host
import numpy as np
from stroke import HEIGHT, PITCH


def facets(path):
    """(n, 9) float32 corners of a binary STL, each triangle from its least corner on, sorted: read by hand."""
    data = Path(path).read_bytes()
    count = int(np.frombuffer(data, "<u4", 1, 80)[0])
    assert len(data) == 84 + 50 * count
    kind = np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    corners = np.frombuffer(data, kind, count, 84)["v"].astype(np.float32)
    keys = np.lexsort((corners[..., 2], corners[..., 1], corners[..., 0]), axis=1)[:, 0]
    corners = np.take_along_axis(corners, ((keys[:, None] + np.arange(3)) % 3)[..., None], axis=1).reshape(-1, 9)
    return corners[np.lexsort(corners.T)]


def blenders(path):
    """Blender's own exporter: 4.2 has one in C++, and older ones an add-on in Python."""
    if "stl_export" in dir(bpy.ops.wm):
        return "wm.stl_export", lambda: bpy.ops.wm.stl_export(filepath=path, export_selected_objects=True)
    return "export_mesh.stl", lambda: bpy.ops.export_mesh.stl(filepath=path, use_selection=True)


def export(side, folder, repeats):
    for ob in list(bpy.data.objects):
        bpy.data.objects.remove(ob)
    size = (side, side, HEIGHT)
    bpy.ops.riffler.new_stock(source="BLOCK", origin="CENTRE", size=size, pitch=PITCH, directions="xyz")
    bpy.ops.riffler.detail(detail="ALL")  # Blender's own exporter writes the mesh
    ob = bpy.context.object
    ours, theirs = (str(Path(folder) / name) for name in ("riffler.stl", "blender.stl"))
    name, export_theirs = blenders(theirs)
    works = {
        "riffler.export_stl": (ours, lambda: bpy.ops.riffler.export_stl(filepath=ours, detail="ALL")),
        name: (theirs, export_theirs),
    }
    times, rows = host.Times(), []
    for k in range(repeats + 1):
        for key, (path, work) in works.items():
            Path(path).unlink(missing_ok=True)
            assert (times.of(key, work) if k else work()) == {"FINISHED"}
    a, b = (facets(path) for path, _ in works.values())
    for key, (path, _) in works.items():
        rows.append({"operator": key, **times.medians(key), "bytes": Path(path).stat().st_size, "triangles": len(a)})
    return {"rows": rows, "same": bool(np.array_equal(a, b)), "facets": [len(a), len(b)], "mesh": len(ob.data.polygons)}
