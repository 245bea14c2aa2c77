"""Old names of meshes, volumes, tools, meshers, colliders and tasks."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

from ..deprecated import Old, warn


def _filling(name: str) -> Callable[[Callable, tuple, dict], object]:
    """Makes a call with ``report={}`` through the function that returns the report."""

    def call(function: Callable, args: tuple, kwargs: dict) -> object:
        from .. import _core

        report = kwargs.pop("report")
        if report is None:
            return function(*args, **kwargs)
        if not isinstance(report, dict):
            raise TypeError(f"{name}: report must be a dict; got {type(report).__name__}")
        warn(f"{name}(report=…)", f"{name}_with_report")
        owner, _, method = name.partition(".")

        def fill(found: tuple[object, object]) -> object:
            result, facts = found
            report.update(dataclasses.asdict(facts))  # pyright: ignore[reportArgumentType]
            return result

        return _core.then(getattr(getattr(_core, owner), f"{method}_with_report")(*args, **kwargs), fill)

    return call


BOX = ("lower", "upper")

OLD = Old(
    modules={"": {"Softened": "Smoothed", "Task": ("Future", "_core.Task")}},
    attributes={
        "Mesh": {"oriented": "orient"},
        "Volume": {
            "soften": "smooth",
            "grown": "grow",
            "resampled": "resample",
            "stats": "take_counters",
        },
        "Mesher": {"stats": "take_counters"},
        "FrozenSurface": {"stats": "take_counters"},
    },
    keywords={"Volume.parts": {"least": "minimum"}},
    positional={
        "Mesh.write": ("path", "progress"),
        "Mesh.decimate": ("triangles", "tolerance"),
        "Mesh.smooth": ("iterations", "tolerance"),
        "Mesh.orient": ("report",),
        "Tool.with_margins": ("shank", "holder"),
        "Tool.outline": ("tolerance",),
        "Volume.from_mesh": ("mesh", "pitch", "directions", *BOX, "progress", "report"),
        "Volume.to_mesh": ("progress", "report"),
        "Volume.sphere": ("centre", "radius", "pitch", "directions", *BOX, "progress"),
        "Volume.cylinder": ("centre", "radius", "height", "pitch", "directions", "axis", *BOX, "progress"),
        "Volume.carve": (
            "tool", "poses", "tolerance", "dt", "removal_constant", "progress", "mode", "protect"
        ),
        "Volume.subtract": ("other", "progress"),
        "Volume.add": ("other", "progress"),
        "Volume.intersect": ("other", "progress"),
        "Volume.save": ("path", "progress"),
        "Volume.load": ("path", "progress"),
        "Volume.to_bytes": ("progress",),
        "Volume.from_bytes": ("data", "name"),
        "Volume.grow": (*BOX, "progress"),
        "Volume.clip": ("point", "normal", "progress"),
        "Volume.parts": ("minimum", "progress"),
        "Volume.resample": ("pitch", "directions", *BOX, "progress"),
        "Volume.smooth": ("centres", "radius", "strength", "protect", "progress"),
        "Mesher.__init__": ("volume", "progress"),
        "Mesher.patch": ("bricks", "edges", "normals"),
        "Collider.query": ("tool", "pose", "budget_us"),
        "shape.slab": ("top", "bottom", "cells"),
    },
    adapted={
        "Mesh.orient": {"report": _filling("Mesh.orient")},
        "Volume.from_mesh": {"report": _filling("Volume.from_mesh")},
        "Volume.to_mesh": {"report": _filling("Volume.to_mesh")},
    },
)  # fmt: skip
