"""The jobs by name; each is a module with ``run(settings, progress) -> Report``."""

from . import b5x, b200, decimate, drop, follow, force, haptic, mesh, pencil, pitch, random, s500k, stl, threads

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
    "pencil": pencil,
    "drop": drop,
    "threads": threads,
}
