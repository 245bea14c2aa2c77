"""What an add-on has registered in Blender, which must be nothing once it is disabled.

Blender lists classes, properties, handlers, keymaps, tools and functions drawn in its menus. It does not list draw
handlers, timers and previews: they are recorded when they are made and removed, so a Watch must begin before the add-on
is enabled.
"""

import bpy
import bpy.utils.previews

PREFIX = "riffler"  # prefix of properties, operators and tools


def of(module, function):
    """True if a callback is the add-on's; partial functions and bound methods, too."""
    function = getattr(function, "func", function)
    name = getattr(function, "__module__", None) or ""
    return name == module or name.startswith(f"{module}.")


def subclasses(cls):
    for sub in type.__subclasses__(cls):
        yield sub
        yield from subclasses(sub)


def classes(module):
    """The add-on's own classes that Blender knows."""
    found = {c for c in subclasses(bpy.types.bpy_struct) if of(module, c) and "bl_rna" in vars(c)}
    return [f"class {c.__name__}" for c in found]


def properties():
    """The add-on's properties on any of Blender's types."""
    out = []
    for name in dir(bpy.types):
        rna = getattr(getattr(bpy.types, name), "bl_rna", None)
        out += [f"property {name}.{p}" for p in (rna.properties.keys() if rna else ()) if p.startswith(PREFIX)]
    return out


def handlers(module):
    lists = ((n, getattr(bpy.app.handlers, n)) for n in dir(bpy.app.handlers))
    return [f"handler {n}: {f.__qualname__}" for n, fs in lists if isinstance(fs, list) for f in fs if of(module, f)]


def keymaps():
    configurations = bpy.context.window_manager.keyconfigs
    out = []
    for configuration in {k for k in (configurations.addon, configurations.default) if k is not None}:
        for keymap in configuration.keymaps:
            out += [f"key {i.idname} in {keymap.name}" for i in keymap.keymap_items if _ours(i)]
    return out


def _ours(item):
    """A key of one of the add-on's operators, or of Blender's that opens one of its menus."""
    menu = item.properties is not None and str(getattr(item.properties, "name", "")).startswith(f"{PREFIX.upper()}_")
    return item.idname.startswith(f"{PREFIX}.") or menu


def menus(module):
    """The add-on's functions that draw in Blender's own menus, panels and headers."""
    out = []
    for cls in {c for base in (bpy.types.Menu, bpy.types.Panel, bpy.types.Header) for c in subclasses(base)}:
        drawn = getattr(vars(cls).get("draw"), "_draw_funcs", ())  # the first is the menu's own
        out += [f"menu {cls.__name__}: {f.__qualname__}" for f in drawn[1:] if of(module, f)]
    return out


def tools():
    """The add-on's tools in the toolbars, whose lists hold tools, groups of tools, and functions that make some."""
    from bl_ui.space_toolsystem_toolbar import VIEW3D_PT_tools_active as toolbar

    def flat(items):
        for item in items or ():
            if hasattr(item, "idname"):
                yield item.idname
            elif isinstance(item, tuple | list):
                yield from flat(item)

    return [f"tool {t}" for items in toolbar._tools.values() for t in flat(items) if t.startswith(f"{PREFIX}.")]


class Watch:
    """From `with` on, records the add-on's draw handlers, timers and previews, too."""

    def __init__(self, module):
        self._module = module
        self._drawn, self._timed, self._previews = {}, set(), set()
        self._put_back = []

    def __enter__(self):
        self._watch_drawing(bpy.types.Space)  # the kinds of spaces inherit it
        self._replace(bpy.app.timers, "register", self._watched_timer)
        self._replace(bpy.utils.previews, "new", self._watched_previews)
        self._replace(bpy.utils.previews, "remove", self._watched_removal)
        return self

    def __exit__(self, *_):
        while self._put_back:
            self._put_back.pop()()

    def left(self):
        """One line for each item, sorted."""
        drawn = [f"draw handler {f.__qualname__}" for f in self._drawn.values()]
        timed = [f"timer {f.__qualname__}" for f in self._timed if bpy.app.timers.is_registered(f)]
        previews = ["preview collection" for _ in self._previews]
        listed = classes(self._module) + properties() + handlers(self._module) + keymaps() + tools()
        listed += menus(self._module)
        return sorted(listed + drawn + timed + previews)

    def _replace(self, owner, name, make):
        original = getattr(owner, name)
        setattr(owner, name, make(original))
        self._put_back.append(lambda: setattr(owner, name, original))

    def _watch_drawing(self, space):
        add, remove = vars(space)["draw_handler_add"], vars(space)["draw_handler_remove"]

        def added(cls, function, *rest):
            handle = add.__get__(None, cls)(function, *rest)
            if of(self._module, function):
                self._drawn[handle] = function
            return handle

        def removed(cls, handle, *rest):
            self._drawn.pop(handle, None)
            return remove.__get__(None, cls)(handle, *rest)

        space.draw_handler_add, space.draw_handler_remove = classmethod(added), classmethod(removed)

        def put_back():
            space.draw_handler_add, space.draw_handler_remove = add, remove

        self._put_back.append(put_back)

    def _watched_timer(self, original):
        def register(function, **more):
            if of(self._module, function):
                self._timed.add(function)
            return original(function, **more)

        return register

    def _watched_previews(self, original):
        def new():
            collection = original()
            self._previews.add(id(collection))
            return collection

        return new

    def _watched_removal(self, original):
        def remove(collection):
            self._previews.discard(id(collection))
            return original(collection)

        return remove
