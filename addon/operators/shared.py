"""What the operators have in common."""

from ..bl import sculpts


def sculpt_poll(cls, context):
    """True where the active object is a sculpt that can be changed; otherwise the button's tooltip says why not."""
    ob = sculpts.active(context)
    if ob is None:
        return deny(cls, "Select a sculpt first, or make a new stock")
    if ob.mode != "OBJECT":
        return deny(cls, "Leave Edit Mode or Sculpt Mode first")
    if ob.library or ob.data.library:
        return deny(cls, "The sculpt is linked from another file: make it local first")
    if context.window_manager.riffler.running:
        return deny(cls, "A cut is running: Esc cancels it")
    return True


def deny(cls, message):
    cls.poll_message_set(message)
    return False


def fail(operator, error):
    """One clear message instead of a traceback; the operator is cancelled."""
    operator.report({"ERROR"}, str(error) or type(error).__name__)
    return {"CANCELLED"}
