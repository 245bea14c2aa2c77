"""Sets and resets options of a machine."""

import bpy
from bpy.props import EnumProperty, StringProperty

from ...blender import operator_parts, scene_units
from ..machines import MACHINES
from ..pure import machine_fields

HOW = (
    ("GIVE", "Value Shown", "Set the value shown in the field"),
    ("CURSOR", "3D Cursor", "Set the position of the 3D cursor, in mm of the scene"),
    ("UNSET", "Default", "Use the machine's default"),
)


class OfMachine:
    """Mixin with the machine's setting; a subclass has `option`."""

    machine: EnumProperty(name="Machine", items=MACHINES, default="tcp", description="Machine that has the option")

    def fact(self, context):
        """The option's description. ValueError, which lists the options, for an unknown name."""
        listed = {fact.name: fact for fact in machine_fields.facts(self.machine)}
        if self.option not in listed:
            raise ValueError(f"{self.machine} has no option {self.option!r}: it has {', '.join(listed)}")
        return listed[self.option]

    def give(self, context, value=None):
        """Sets the option, by default to the field's value; from then on it is passed on."""
        group, key = context.scene.riffler.machines.of(self.machine), machine_fields.identifier(self.option)
        value = getattr(group, key) if value is None else value
        setattr(group, key, value if isinstance(value, (str, bool, float)) else tuple(value))


class RIFFLER_OT_machine_option(OfMachine, bpy.types.Operator):
    """Set this option of the machine, or reset it to the machine's default"""

    bl_idname = "riffler.machine_option"
    bl_label = "Set Machine Option"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    option: StringProperty(name="Option", description="Name of the option")
    how: EnumProperty(name="How", items=HOW, default="GIVE", description="Whether to set or reset the option")

    @classmethod
    def description(cls, context, properties):
        return next(what for how, _, what in HOW if how == properties.how)

    def execute(self, context):
        try:
            fact = self.fact(context)
            if self.how == "CURSOR" and fact.count != 3:
                raise ValueError(f"{self.option} is not a position: give a number")
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        if self.how == "UNSET":
            context.scene.riffler.machines.of(self.machine).property_unset(machine_fields.identifier(self.option))
        elif self.how == "CURSOR":
            self.give(context, [x * scene_units.mm_per_unit(context.scene) for x in context.scene.cursor.location])
        else:
            self.give(context)
        return {"FINISHED"}


_entries = []  # Blender keeps no reference to the texts of a dynamic enumeration


def _others(self, context):
    """The options that are not set."""
    given = {} if context is None else context.scene.riffler.machines.given(self.machine)
    _entries[:] = [
        (fact.name, machine_fields.label(fact), machine_fields.about(fact), k)
        for k, fact in enumerate(machine_fields.facts(self.machine))
        if fact.name not in given
    ]
    return _entries


class RIFFLER_OT_machine_option_add(OfMachine, bpy.types.Operator):
    """Set one more option of the machine: limits and rates of its axes, or how its code is written"""

    bl_idname = "riffler.machine_option_add"
    bl_label = "Add Machine Option"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    option: EnumProperty(name="Option", items=_others, description="Name of the option")

    def execute(self, context):
        self.give(context)
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_machine_option, RIFFLER_OT_machine_option_add)
