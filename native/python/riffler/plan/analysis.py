"""What a part is worth before it is planned on."""

import dataclasses

import numpy as np

from ..mesh_notes import notes_on


def analyse(mesh):
    """A report on a part: ``mesh.audit()`` and what follows from it.

    The audit is that of ``mesh.orient(hollow=True)``, as which plans take the part; its counts of what was turned are
    there, too. Adds to the audit's counts: ``triangles``, ``area`` (mm²), ``bounds`` ((2, 3) mm), ``closed`` (no open
    and no non-manifold edges), ``degenerate_share`` (of the triangles), ``outward`` (True where the normals point out
    of the material, False where they point in; None for open parts, where the volume's sign says nothing), ``units``
    (what the size suggests: "mm", "inch", "m" or "micrometre") and ``warnings``, a list of sentences. ValueError
    without triangles.
    """
    bounds = mesh.bounds
    oriented, repairs = mesh.orient_with_report(hollow=True)
    report = dataclasses.asdict(oriented.audit())
    count = len(mesh.triangles)
    size = float(np.max(bounds[1] - bounds[0]))
    closed = report["open_edges"] == 0 and report["nonmanifold_edges"] == 0
    report.update(
        triangles=count,
        area=mesh.area,
        bounds=bounds,
        closed=closed,
        degenerate_share=report["degenerate"] / count,
        outward=bool(report["volume"] > 0) if closed and report["volume"] != 0 else None,
        **dataclasses.asdict(repairs),
        units=_units_of(size),
    )
    report["warnings"] = list(_warnings(report, size))
    return report


def _units_of(size):
    """Parts that people mill are some 10 mm to 2 m long; what is outside that was probably drawn in another unit."""
    if size < 0.5:
        return "m"
    if size < 8:
        return "inch"
    return "mm" if size < 5000 else "micrometre"


def _warnings(report, size):
    yield from notes_on(report)
    if not report["closed"]:
        yield (
            f"the part is not closed: {report['open_edges']} open and "
            f"{report['nonmanifold_edges']} non-manifold edges; paths end at open ones"
        )
    if report["outward"] is False:
        yield "the normals point into the material: valleys are looked for on the wrong side"
    if report["degenerate"]:
        yield f"{report['degenerate']} of {report['triangles']} triangles have no area; they are used as lines"
    if report["units"] != "mm":
        yield f"the largest side is {size:g}: lengths are taken as mm, but it looks like {report['units']}"
