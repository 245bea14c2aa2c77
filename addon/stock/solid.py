"""New sculpts of exact shapes, with sizes as in Blender's own Add Mesh."""

import math
from collections.abc import Callable
from typing import NamedTuple

import bpy
import numpy as np
import riffler
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, IntProperty
from mathutils import Matrix

from ..blender import operator_parts, scene_units
from ..common import units
from ..common.contents import Content
from ..sculpt import fit, live_registry, sculpt_work, sculpts
from ..translations import local
from . import properties
from .pure import estimate

SHAPES = (
    ("BLOCK", "Block", "A cuboid of material", "CUBE", 0),
    ("SPHERE", "Sphere", "A ball of material, without facets", "MESH_UVSPHERE", 1),
    ("CYLINDER", "Cylinder", "A round bar of material along z, without facets", "MESH_CYLINDER", 2),
)


class _Shape(NamedTuple):
    """A solid about the origin, in mm."""

    size: np.ndarray
    area: float
    make: Callable  # (pitch, directions) → its volume


class RIFFLER_OT_add_solid(bpy.types.Operator):
    """Add a block, sphere or cylinder of material at the 3D cursor, ready to sculpt"""

    bl_idname = "riffler.add_solid"
    bl_label = "Add Solid"
    bl_options = {"REGISTER", "UNDO"}

    shape: EnumProperty(name="Shape", items=SHAPES, default="SPHERE", description="Shape to add")
    size: FloatVectorProperty(
        name="Size",
        default=(2, 2, 2),
        min=0,
        subtype="XYZ_LENGTH",
        description="Size of a block along x, y and z, in Blender units",
    )
    radius: FloatProperty(
        name="Radius",
        default=1,
        min=0,
        subtype="DISTANCE",
        description="Radius of a sphere or cylinder, in Blender units",
    )
    depth: FloatProperty(
        name="Depth", default=2, min=0, subtype="DISTANCE", description="Length of a cylinder along z, in Blender units"
    )
    rays: IntProperty(
        name="Resolution",
        default=180,
        min=2,
        soft_min=50,
        soft_max=1000,
        description="Number of rays along the longest side: more rays give finer details",
    )
    directions: EnumProperty(
        name="Rays",
        items=properties.DIRECTIONS,
        default="xyz",
        description="Directions of the rays that measure the material",
    )

    @classmethod
    def poll(cls, context):
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def execute(self, context):
        kept = fit.Kept(context)
        try:
            self._fit(context)
            name, shape = self.shape.capitalize(), self._shape(context.scene)
            pitch = self._pitch(name, shape.size)
            estimate.check_surface(name, shape.size, shape.area, pitch, "take fewer rays")
            volume = shape.make(pitch, self.directions)
            live_registry.end_all()
            place = Matrix.Translation(context.scene.cursor.location)
            ob = sculpts.new_object(context, name, Content(volume), place)
        except operator_parts.ERRORS as error:
            kept.restore()
            return operator_parts.fail(self, error)
        sculpt_work.tell_made(self, ob)
        return {"FINISHED"}

    def draw(self, context):
        operator_parts.draw_fields(self, ("shape", *_FIELDS[self.shape], "rays", "directions"))
        size = self._shape(context.scene).size
        self.layout.label(text=f"{local('Pitch')}: {units.trim(size.max() / self.rays, 4)} mm", translate=False)

    def _fit(self, context):
        """A solid of metres and a cutter of millimetres do not match: sets the scene's unit and the cutter such that
        the solid can be sculpted."""
        longest = self._shape(context.scene).size.max() / scene_units.mm_per_unit(context.scene)
        if longest > 0:
            side = fit.side(context, longest)
            fit.take_unit(context, side / longest)
            fit.take_cutter(context, fit.cutter(context, side))

    def _shape(self, scene):
        mm = scene_units.mm_per_unit(scene)
        if self.shape == "BLOCK":
            size = np.array([units.clean(s) * mm for s in self.size])
            return _Shape(size, estimate.box_area(size), lambda *rays: riffler.Volume.block(-size / 2, size / 2, *rays))
        r, d = units.clean(self.radius) * mm, units.clean(self.depth) * mm
        if self.shape == "SPHERE":
            return _Shape(
                np.full(3, 2 * r), 4 * math.pi * r**2, lambda *rays: riffler.Volume.sphere((0, 0, 0), r, *rays)
            )
        return _Shape(
            np.array((2 * r, 2 * r, d)),
            2 * math.pi * r * (r + d),
            lambda *rays: riffler.Volume.cylinder((0, 0, 0), r, d, *rays),
        )

    def _pitch(self, name, size):
        """mm. ValueError if a side is 0, or too short for two rays."""
        for field, side in zip(_SIDES[self.shape], size, strict=False):
            if not side > 0:
                raise ValueError(f"{field} is 0: give it a length")
        if size.max() > 0.5 * self.rays * size.min():
            needed = units.format_count(math.ceil(2 * size.max() / size.min()))
            raise ValueError(f"{name} is too thin for {self.rays} rays along its longest side: take {needed} or more")
        return size.max() / self.rays


_FIELDS = {"BLOCK": ("size",), "SPHERE": ("radius",), "CYLINDER": ("radius", "depth")}
_SIDES = {"BLOCK": ("Size X", "Size Y", "Size Z"), "SPHERE": ("Radius",), "CYLINDER": ("Radius", "Radius", "Depth")}
CLASSES = (RIFFLER_OT_add_solid,)
