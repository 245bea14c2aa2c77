"""What the add-on registers, in order; taken back in the reverse order."""

from .core import native

_undo = []  # one function per thing that was registered


def register():
    module, error = native.load()
    try:
        if module is None:
            _register_fallback(error)
        else:
            _register_all()
    except Exception:
        unregister()  # half an add-on helps nobody; Blender shows the error
        raise


def _register_fallback(error):
    from .ui import fallback

    fallback.set_error(error)
    _classes(fallback.CLASSES)


def _register_all():
    from . import properties
    from .bl import handlers
    from .operators import cut, export, pen, scene, stock
    from .ui import panels, pen_panel

    _classes(properties.CLASSES)
    properties.attach()
    _undo.append(properties.detach)
    for module in (stock, cut, pen, export, scene, panels, pen_panel):
        _classes(module.CLASSES)
    handlers.attach()
    _undo.append(handlers.detach)
    pen.attach()
    _undo.append(pen.detach)


def _classes(classes):
    import bpy

    for cls in classes:
        bpy.utils.register_class(cls)
        _undo.append(lambda cls=cls: bpy.utils.unregister_class(cls))


def unregister():
    while _undo:
        _undo.pop()()
