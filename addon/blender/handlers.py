"""Registration of functions with bpy.app.handlers, by the names of its lists, and of timers."""

import bpy


def listen(functions):
    for name, function in functions.items():
        getattr(bpy.app.handlers, name).append(function)


def ignore(functions):
    for name, function in functions.items():
        listed = getattr(bpy.app.handlers, name)
        if function in listed:
            listed.remove(function)


def stop(*functions):
    """Unregisters timers that may be running."""
    for function in functions:
        if bpy.app.timers.is_registered(function):
            bpy.app.timers.unregister(function)
