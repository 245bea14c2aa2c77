"""What Blender calls when something has happened: functions by the name of their list in bpy.app.handlers; and when it
is time."""

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
    """Timers that may be running."""
    for function in functions:
        if bpy.app.timers.is_registered(function):
            bpy.app.timers.unregister(function)
