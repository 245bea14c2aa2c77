"""Settings of each machine: a group of fields for each, made from the core's description of the machine's options.
Fields that the user has not set are not passed on."""

import bpy
import riffler
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, PointerProperty

from ..blender.fields import stored_number
from .pure import machine_fields

MACHINES = tuple((m, m, what, "NONE", stored_number(m)) for m, what in riffler.machines().items())
FIRST = {"positive": 1000.0, "range": (-100.0, 100.0)}  # initial values of such fields


def _field(fact):
    how = {"name": machine_fields.label(fact), "description": machine_fields.about(fact)}
    kind, value = fact.kind, fact.value
    if value is None:
        value = FIRST.get(kind, (0.0,) * fact.count if fact.count > 1 else 0.0)
    if kind == "flag":
        return BoolProperty(default=value, **how)
    if kind == "word":
        return EnumProperty(items=[(word, word, "") for word in fact.words], default=value, **how)
    how |= {"default": value, "precision": 3, "min": 1e-3 if kind == "positive" else -1e6, "max": 1e6}
    return FloatVectorProperty(size=fact.count, **how) if fact.count > 1 else FloatProperty(**how)


def _facts(machine):
    """The options, or None for a user's file that cannot be read; using that machine reports the error."""
    try:
        return machine_fields.facts(machine)
    except ValueError:
        return ()


def _group(machine):
    own = {machine_fields.identifier(fact.name): _field(fact) for fact in _facts(machine)}
    name = f"RifflerMachine_{machine_fields.machine_identifier(machine)}"
    return type(name, (bpy.types.PropertyGroup,), {"__annotations__": own, "__module__": __name__})


GROUPS = {machine: _group(machine) for machine, *_ in MACHINES}
globals().update({group.__name__: group for group in GROUPS.values()})  # registration finds classes by their names


class RifflerMachines(bpy.types.PropertyGroup):
    """Settings on a scene: a group for each machine, by its identifier."""

    __annotations__ = {
        machine_fields.machine_identifier(m): PointerProperty(type=GROUPS[m], name=m, description=what)
        for m, _, what, *_ in MACHINES
    }

    def of(self, machine):
        """The group of a machine."""
        return getattr(self, machine_fields.machine_identifier(machine))

    def given(self, machine):
        """The options of a machine that the user has set, as riffler takes them."""
        own, found = self.of(machine), {}
        for fact in _facts(machine):
            key = machine_fields.identifier(fact.name)
            if own.is_property_set(key):
                found[fact.name] = machine_fields.value(fact, getattr(own, key))
        return found
