"""A plan's setup: the part, the fixtures, and the tool with its shank and holder."""

import bpy
import numpy as np
import riffler
from bpy_extras.io_utils import ImportHelper

from ...blender import object_surfaces, operator_parts, refusals
from ...blender.fields import length
from ...common import units
from ...sculpt import live_registry
from .. import fit_check, obstacles, tool_libraries
from ..pure import tool_library
from ..pure.clearance import check_fixture

FIXTURES = "Riffler Fixtures"


def surfaces(context):
    """The selected objects that have a surface."""
    return [ob for ob in context.selected_objects if ob.type in object_surfaces.WITH_SURFACE]


def described(mesh):
    """Assessment of a part before planning: the report's level, and its text."""
    found = riffler.plan.analyse(mesh)
    size = units.format_size(found.bounds[1] - found.bounds[0])
    facts = f"{size}, {units.counted(found.triangles, 'triangle')}"
    return "WARNING" if found.warnings else "INFO", "; ".join([facts, *found.warnings])


def _editable(cls, collection):
    """True if objects can be added to the fixtures' collection and removed."""
    if collection is None or not (collection.library or collection.override_library):
        return True
    return operator_parts.deny(
        cls, f"{collection.name} is linked from another file: choose another collection for fixtures"
    )


class RIFFLER_OT_plan_part(bpy.types.Operator):
    """Make the active object the part: the finished shape, as it lies in the scene"""

    bl_idname = "riffler.plan_part"
    bl_label = "Set Part"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if context.object is None:
            return operator_parts.deny(cls, "Select the object that is the finished part")
        if why := object_surfaces.unfit(context.object, context.scene):
            return operator_parts.deny(cls, why)
        return not operator_parts.busy(cls, context)

    def execute(self, context):
        settings, ob = context.scene.riffler.plan, context.object
        if settings.fixtures is not None and ob in settings.fixtures.all_objects[:]:
            home = settings.fixtures.name
            return operator_parts.fail(self, ValueError(f"{ob.name} is a fixture: take it out of {home} first"))
        try:
            live_registry.end_all()  # the mesh of a live sculpt is not up to date
            mesh = object_surfaces.in_world(context, ob)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        settings.part = ob
        level, text = described(mesh)
        if asked := fit_check.size_question(context.scene):
            level, text = "WARNING", f"{text}; {asked} Choose it in the panel Part and Fixtures"
        self.report({level}, f"{ob.name}: {text}")
        return {"FINISHED"}


class RIFFLER_OT_plan_fixtures_add(bpy.types.Operator):
    """Make the selected objects fixtures, which the tool stays clear of"""

    bl_idname = "riffler.plan_fixtures_add"
    bl_label = "Add Fixtures"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if not (operator_parts.object_mode(cls, context) and _editable(cls, context.scene.riffler.plan.fixtures)):
            return False
        if why := next(filter(None, map(refusals.instance, context.selected_objects)), ""):
            return operator_parts.deny(cls, f"{why} first")
        if not any(ob != context.scene.riffler.plan.part for ob in surfaces(context)):
            return operator_parts.deny(cls, "Select the vise, the clamps: objects with a surface, other than the part")
        return not operator_parts.busy(cls, context)

    def execute(self, context):
        settings = context.scene.riffler.plan
        try:
            for ob in surfaces(context):
                if ob != settings.part:
                    check_fixture(object_surfaces.in_world(context, ob), ob.name)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        if settings.fixtures is None:
            settings.fixtures = bpy.data.collections.new(FIXTURES)
        if settings.fixtures not in context.scene.collection.children_recursive:
            context.scene.collection.children.link(settings.fixtures)
        added = [ob for ob in surfaces(context) if ob != settings.part and settings.fixtures not in ob.users_collection]
        for ob in added:
            settings.fixtures.objects.link(ob)
        try:
            held = obstacles.fixture_objects(settings, settings.part)
        except ValueError as error:  # an invalid object that was added to the collection by other means
            self.report({"WARNING"}, operator_parts.as_sentence(str(error)))
            return {"FINISHED"}
        self.report({"INFO"}, f"{settings.fixtures.name}: {units.counted(len(held), 'object')}")
        return {"FINISHED"}


class RIFFLER_OT_plan_fixtures_remove(bpy.types.Operator):
    """Remove the selected objects from the fixtures; they stay in the scene"""

    bl_idname = "riffler.plan_fixtures_remove"
    bl_label = "Remove Fixtures"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        home = context.scene.riffler.plan.fixtures
        if home is None:
            return operator_parts.deny(cls, "There are no fixtures")
        if not _editable(cls, home):
            return False
        if not any(home in ob.users_collection for ob in context.selected_objects):
            return operator_parts.deny(cls, "Select the fixtures to remove")
        return not operator_parts.busy(cls, context)

    def execute(self, context):
        home = context.scene.riffler.plan.fixtures
        for ob in [ob for ob in context.selected_objects if home in ob.users_collection]:
            if len(ob.users_collection) == 1:
                context.scene.collection.objects.link(ob)
            home.objects.unlink(ob)
        return {"FINISHED"}


class RIFFLER_OT_plan_tool(bpy.types.Operator):
    """Use this tool for planning: cutter, shank and holder"""

    bl_idname = "riffler.plan_tool"
    bl_label = "Use Tool"
    bl_options = {"REGISTER", "UNDO"}

    name: bpy.props.StringProperty(name="Name", description="Name of the tool; empty: the first tool of the file")
    path: bpy.props.StringProperty(name="File", description="A tool file; empty: the presets", subtype="FILE_PATH")
    sculpting: bpy.props.BoolProperty(
        name="Sculpting Cutter", default=False, description="Use the cutter of the Tool panel, and ignore name and file"
    )

    def execute(self, context):
        scene = context.scene.riffler
        path = bpy.path.abspath(self.path) if self.path and not self.sculpting else ""
        try:
            tool = scene.tool.dictionary() if self.sculpting else tool_libraries.tool(self.name, path)
            riffler.Tool.from_dict(tool)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        scene.plan.take(tool, path)
        return {"FINISHED"}


class RIFFLER_OT_plan_tool_open(bpy.types.Operator, ImportHelper):
    """Load a tool from a file (.json, .toml)"""

    bl_idname = "riffler.plan_tool_open"
    bl_label = "Open Tool File"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.json;*.toml", options={"HIDDEN"})
    name: bpy.props.StringProperty(name="Name", description="Name of the tool; empty: the first tool of the file")

    def execute(self, context):
        path = bpy.path.abspath(self.filepath)
        try:
            context.scene.riffler.plan.take(tool_libraries.tool(self.name, path), path)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return {"FINISHED"}


class RIFFLER_OT_plan_tool_save(bpy.types.Operator):
    """Save the plan's tool, with shank and holder, as a file in the tool library"""

    bl_idname = "riffler.plan_tool_save"
    bl_label = "Save Tool"
    bl_options = {"REGISTER", "UNDO"}

    name: bpy.props.StringProperty(
        name="Name", description="Name of the tool and of its file; empty: the tool's current name"
    )
    folder: bpy.props.StringProperty(
        name="Folder",
        subtype="DIR_PATH",
        options={"SKIP_SAVE"},
        description="Folder of the file; empty: the tool library's folder",
    )

    def invoke(self, context, event):
        try:
            self.name = context.scene.riffler.plan.tool_dict().get("name", "")
        except ValueError as error:
            return operator_parts.fail(self, error)
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context):
        settings = context.scene.riffler.plan
        folder = bpy.path.abspath(self.folder) if self.folder else ""
        try:
            folder = folder or tool_libraries.target()
            tool = riffler.Tool.from_dict(settings.tool_dict())
            path = tool_library.write(folder, (tool.named(self.name) if self.name else tool).to_dict())
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        settings.take(tool_libraries.tool("", str(path)), str(path))
        self.report({"INFO"}, f"{path} written")
        return {"FINISHED"}


SHANK, HOLDER = ("shank",), ("holder", "upper", "height")


def sizes_of(tool):
    """The fields of a tool's shank and holder, in mm, by name; without those of missing pieces."""
    sizes = {}
    if tool.shank:
        sizes.update(shank=2 * tool.shank[0][1], reach=tool.shank[-1][2])
    if tool.holder:
        low, high = tool.holder[0], tool.holder[-1]
        sizes.update(reach=low[0], holder=2 * low[1], upper=2 * high[3], height=high[2] - low[0])
    return sizes


def _drawn_out(pieces, further):
    """A shank whose uppermost piece is `further` mm longer outside the holder. ValueError if none of it is left."""
    *others, (low, radius, high, upper) = pieces
    high = units.clean(high + further)
    if high <= low:
        raise ValueError(
            f"the shank's uppermost piece begins at {low:g} mm: give more reach, or another shank diameter"
        )
    return [*others, (low, radius, high, upper)]


class RIFFLER_OT_plan_assembly(bpy.types.Operator):
    """Define the shank and the holder of the plan's tool, which must not touch the part"""

    bl_idname = "riffler.plan_assembly"
    bl_label = "Shank and Holder"
    bl_options = {"REGISTER", "UNDO"}

    shank: length("Shank Diameter", 6.0, "Diameter of the shank, in mm; 0: no shank")
    reach: length("Reach", 40.0, "Distance from the tip to the holder, in mm")
    holder: length("Holder Diameter", 28.0, "Diameter at the holder's lower end, in mm; 0: no holder")
    upper: length("Upper Diameter", 32.0, "Diameter at the holder's upper end, in mm")
    height: length("Holder Length", 30.0, "Length of the holder, in mm")

    def invoke(self, context, event):
        try:
            tool = riffler.Tool.from_dict(context.scene.riffler.plan.tool_dict())
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        self.shank, self.reach = tool.diameter, tool.length + 15
        for key, value in sizes_of(tool).items():
            setattr(self, key, value)
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, context):
        operator_parts.draw_fields(self, ("shank", "reach", "holder", "upper", "height"))
        try:
            tool = riffler.Tool.from_dict(context.scene.riffler.plan.tool_dict())
        except operator_parts.ERRORS:
            return  # execute reports the error
        sizes = sizes_of(tool)
        if len(tool.shank) > 1 and self.shank and not self._unchanged(sizes, SHANK):
            self.layout.label(text="The shank becomes one piece, as its diameter was changed", icon="INFO")
        if len(tool.holder) > 1 and self.holder and not self._unchanged(sizes, HOLDER):
            self.layout.label(text="The holder becomes one piece, as its sizes were changed", icon="INFO")

    def execute(self, context):
        settings = context.scene.riffler.plan
        try:
            tool = riffler.Tool.from_dict(settings.tool_dict())
            if (self.shank or self.holder) and units.clean(self.reach) <= tool.length:
                raise ValueError(f"the holder must begin above the cutter, whose length is {tool.length:g} mm")
            tool = self._with_pieces(tool)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        settings.take(tool.to_dict())
        return {"FINISHED"}

    def _with_pieces(self, tool):
        """Keeps the pieces of shank and holder whose sizes are unchanged. A changed reach lengthens the shank's
        uppermost piece, and moves the holder."""
        sizes = sizes_of(tool)
        fields = (self.shank, self.reach, self.holder, self.upper, self.height)
        shank, reach, lower, upper, height = map(units.clean, fields)
        further = 0.0 if self._unchanged(sizes, ("reach",)) else reach - sizes.get("reach", reach)
        shanks = [(tool.length, shank / 2, reach, shank / 2)] if shank else []
        if self._unchanged(sizes, SHANK):
            shanks = _drawn_out(tool.shank, further)
        holders = [(reach, lower / 2, reach + height, upper / 2)] if lower else []
        if self._unchanged(sizes, HOLDER):
            holders = [(units.clean(a + further), r, units.clean(b + further), s) for a, r, b, s in tool.holder]
        return tool.with_shank(shanks).with_holder(holders)

    def _unchanged(self, sizes, keys):
        """True if the fields equal the tool's sizes, within single precision."""
        return all(key in sizes and getattr(self, key) == np.float32(sizes[key]) for key in keys)


CLASSES = (
    RIFFLER_OT_plan_part,
    RIFFLER_OT_plan_fixtures_add,
    RIFFLER_OT_plan_fixtures_remove,
    RIFFLER_OT_plan_tool,
    RIFFLER_OT_plan_tool_open,
    RIFFLER_OT_plan_tool_save,
    RIFFLER_OT_plan_assembly,
)
