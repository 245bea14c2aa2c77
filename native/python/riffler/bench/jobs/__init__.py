"""The jobs by name; each is a module with ``run(settings, progress) -> Report``."""

from . import b5x, b200, force, haptic, mesh, models, pitch, random, s500k, threads

JOBS = {
    "b200": b200,
    "b5x": b5x,
    "s500k": s500k,
    "haptic": haptic,
    "force": force,
    "pitch": pitch,
    "mesh": mesh,
    "random": random,
    "models": models,
    "threads": threads,
}
