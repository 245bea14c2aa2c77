"""Long work on a file that the user chooses first."""

import bpy

from . import operator_parts
from .long_work import LongWork


class FileWork(LongWork):
    """Mixin of operators of long work, placed before ExportHelper or ImportHelper, which is also the `helper`.

    Blender calls `execute` once the file is chosen, and frees the operator after it. So the work, which takes longer,
    runs in a second call of the same operator, which does not ask for a file.
    """

    helper = None

    ask: bpy.props.BoolProperty(
        name="Ask",
        default=True,
        options={"HIDDEN", "SKIP_SAVE"},
        description="With INVOKE_DEFAULT: choose the file first; off: start at once, in the background",
    )
    _asked = False

    def invoke(self, context, event):
        if not self.ask:
            return LongWork.invoke(self, context, event)
        self._asked = True
        return self.helper.invoke(self, context, event)

    def execute(self, context):
        if not self._asked or bpy.app.background or context.window is None:
            return LongWork.execute(self, context)
        self._asked = False
        # an instance has Blender's own form of the name
        call = getattr(bpy.ops.riffler, type(self).bl_idname.partition(".")[2])
        try:
            call("INVOKE_DEFAULT", **{**self.as_keywords(), "ask": False})
        except RuntimeError as error:  # what the second call reported, passed on by Blender
            said = " ".join(line.removeprefix("Error: ") for line in str(error).splitlines())
            return operator_parts.fail(self, RuntimeError(said))
        return {"CANCELLED"}  # this call has nothing to undo
