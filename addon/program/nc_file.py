"""The part that operators which write NC code share: the file's suffix and the file browser."""

from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper

from ..blender import operator_parts
from ..plan.pure import machine_fields
from . import programs
from .properties import GivenOptions


class WritesNc(GivenOptions, ExportHelper):
    """Mixin; a subclass has the field `post`, `_take_settings(context)`, which takes the scene's settings where none
    were given, and `_stem(context)`, the name that the file browser offers."""

    filter_glob: StringProperty(default=machine_fields.file_filter("*.nc;*.tap"), options={"HIDDEN"})

    @property
    def filename_ext(self):
        return machine_fields.extension(self.post)

    def invoke(self, context, event):
        self._take_settings(context)
        try:
            programs.options(context.scene, self.post, self.options)
        except ValueError as error:  # reported before the user chooses a file
            return operator_parts.fail(self, error)
        if not self.filepath:
            self.filepath = self._stem(context) + self.filename_ext
        return super().invoke(context, event)
