"""The plan's machine, and its options as fields: required ones, the machine's own, and others that are set."""

import bpy

from ..blender.panel_parts import lines, wrapped
from ..translations import in_contexts, local
from .operators import machine_options
from .panel import Tab
from .pure import machine_fields


def draw_options(layout, context, name):
    """Draws a machine's options: required ones, its own, others that are set, and a menu to add more."""
    machines = context.scene.riffler.machines
    given = machines.given(name)
    try:
        listed = machine_fields.facts(name, given)
    except ValueError as error:
        listed = machine_fields.facts(name)
        lines(layout, *wrapped(context, f"{error}."), icon="ERROR")
    group, column = machines.of(name), layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    for fact in listed:
        if fact.needed and fact.name not in given:
            _ask(column, context, name, group, fact)
    for fact in listed:
        if fact.name in given or (fact.own and not fact.needed):
            row = _field(column, group, fact)
            if fact.name in given:
                _button(row, name, fact, "UNSET", text="", icon="X")
    op = layout.operator_menu_enum(machine_options.RIFFLER_OT_machine_option_add.bl_idname, "option", icon="ADD")
    op.machine = name


def _field(layout, group, fact):
    """The row of an option's field. The name of a field with a unit is above it, since both do not fit into one row."""
    key = machine_fields.identifier(fact.name)
    if not fact.unit:
        row = layout.row(align=True)
        row.prop(group, key)
        return row
    column = layout.column(align=True)
    column.label(text=machine_fields.label(fact))
    row = column.row(align=True)
    row.use_property_split = False
    row.prop(group, key, text="")
    return row


def _ask(layout, context, name, group, fact):
    box = layout.box()
    needed = local("{} is not set").format(local(machine_fields.label(fact)))
    lines(box, *wrapped(context, f"{needed}: {local(machine_fields.about(fact))}."), icon="ERROR")
    row = box.row(align=True)
    row.use_property_split = False
    row.prop(group, machine_fields.identifier(fact.name), text="")
    row = box.row(align=True)
    if fact.count == 3:
        _button(row, name, fact, "CURSOR", text="3D Cursor", icon="PIVOT_CURSOR")
    _button(row, name, fact, "GIVE", text="Use This", icon="CHECKMARK")


def _button(layout, name, fact, how, **look):
    op = layout.operator(machine_options.RIFFLER_OT_machine_option.bl_idname, **look)
    op.machine, op.option, op.how = name, fact.name, how
    return op


class RIFFLER_PT_plan_machine(Tab, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_plan_machine"
    bl_label = "Machine (mm)"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.riffler.plan
        layout.prop(settings, "post")
        draw_options(layout, context, settings.post)
        layout.prop(settings, "clearance")
        column = layout.column(align=True)
        column.prop(settings, "plane")
        column.prop(settings, "leave")
        column.prop(settings, "retract")
        column.prop(settings, "lead_in")
        column = layout.column(align=True)
        column.prop(settings, "feed")
        column.prop(settings, "spindle")


CLASSES = (RIFFLER_PT_plan_machine,)


def attach():
    found = machine_fields.translations()
    bpy.app.translations.register(__name__, {code: in_contexts(texts) for code, texts in found.items()})


def detach():
    bpy.app.translations.unregister(__name__)
