"""The program of a calculated job, in the scene's frame."""

import numpy as np

from ..blender import scene_units
from . import inputs, job_store
from .pure import job_run

AGAIN = "use Calculate in the panel Job"


def of_scene(context):
    """(riffler.Program, Inputs) of the scene's job. The program is in the scene's frame, mm. ValueError if the job is
    not calculated, or must not run."""
    given, known = inputs.take(context), job_store.operations(context.scene)
    missing = [one.name for one, key in zip(given.wanted, given.keys, strict=True) if key not in known]
    if missing:
        shown = ", ".join(missing[:3]) + (" …" if len(missing) > 3 else "")
        raise ValueError(f"{shown}: not calculated, or part, stock or settings have changed since: {AGAIN}")
    program = job_store.program(given.keys[-1])
    if program is None:
        setup, done = given.setup(), [known[key] for key in given.keys]
        for op in done:
            setup.apply(op)
        program = job_run.checked(setup, given.wanted, done)
        job_store.keep_program(given.keys[-1], program)
    return program.transformed(given.to_world), given


def to_zero(scene):
    """(4, 4): maps the scene's mm to mm from the program's zero."""
    matrix = np.eye(4)
    matrix[:3, 3] = [-scene_units.clean(x) for x in scene.riffler.machining.zero]
    return matrix
