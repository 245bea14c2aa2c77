"""The jobs by name; each is a module with ``run(settings, progress) -> Report``."""

from . import (
    b5x,
    b200,
    col,
    decimate,
    drop,
    follow,
    force,
    gouge,
    haptic,
    mesh,
    pencil,
    pitch,
    random,
    s500k,
    stl,
    threads,
)  # fmt: skip

JOBS = {
    "b200": b200,
    "b5x": b5x,
    "s500k": s500k,
    "haptic": haptic,
    "force": force,
    "pitch": pitch,
    "mesh": mesh,
    "follow": follow,
    "random": random,
    "stl": stl,
    "decimate": decimate,
    "col": col,
    "pencil": pencil,
    "drop": drop,
    "gouge": gouge,
    "threads": threads,
}
