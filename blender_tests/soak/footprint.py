"""A Blender's resources: memory, datablocks, threads, files, and the add-on's caches."""

import gc
import os

import bpy

from support import common

PAGE = os.sysconf("SC_PAGE_SIZE")


def resident():
    """MB of this process in memory."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * PAGE / 1e6


def held():
    """Numbers that stay constant during work of any length, by name."""
    gc.collect()
    keeping, working = common.part("sculpt.persistence"), common.part("sculpt.live_sculpt")
    folder = keeping.folder()
    data = {name: len(found) for name, found in datablocks()}
    return {
        **{name: count for name, count in data.items() if count},
        "live sculpts": len(working.lives),
        "journals": len(keeping._open) + len(keeping._parked),
        "folders of journals": len(list(folder.iterdir())) if folder.is_dir() else 0,
        "handlers": sum(len(fs) for fs in map(_handlers, dir(bpy.app.handlers))),
        "threads": len(os.listdir("/proc/self/task")),
        "open files": len(os.listdir("/proc/self/fd")),
    }


def datablocks():
    for name in dir(bpy.data):
        found = getattr(bpy.data, name)
        if isinstance(found, bpy.types.bpy_prop_collection):
            yield name, found


def _handlers(name):
    found = getattr(bpy.app.handlers, name)
    return found if isinstance(found, list) else ()
