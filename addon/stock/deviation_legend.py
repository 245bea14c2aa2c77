"""The legend of deviation colours, in views that show them: of the active mesh, or of the verified part."""

import bpy

from ..blender import attributes, bars, batches, views
from ..common import colours

CORNER = (90.0, 40.0)  # pixels from the view's lower right, without the sidebar

CLASSES = ()
kept = batches.Batches()
_in_views = views.InViews()


def mesh_of(context):
    """The mesh whose colours the legend explains, or None."""
    own = context.scene.riffler
    for ob in (context.object, own.verify.left, own.plan.part):
        if ob is not None and ob.type == "MESH" and attributes.shows_distance(ob.data) and ob.visible_get():
            return ob.data
    return None


def bar(mesh):
    scale = float(f"{mesh[attributes.SCALE]:.7g}")
    return bars.Bar("mm", -scale, scale, colours=colours.legend(scale))


def _draw():
    context = bpy.context
    shading = context.space_data.shading
    if shading.type != "SOLID" or shading.color_type != "VERTEX":
        return
    mesh = mesh_of(context)
    if mesh is None:
        return
    zoom = context.preferences.system.ui_scale
    sidebar = next((r.width for r in context.area.regions if r.type == "UI" and r.width > 1), 0)
    place = (context.region.width - sidebar - zoom * CORNER[0], zoom * CORNER[1])
    bars.draw(kept, bar(mesh), place, zoom)


def attach():
    _in_views.add(_draw)


def detach():
    _in_views.clear()
    kept.clear()
