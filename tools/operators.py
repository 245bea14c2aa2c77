"""Writes docs/operators.md: the add-on's operators for scripts, as Blender registers them, and the settings of
the scene that they go by. blender_tests/headless/test_operators.py holds the page against each Blender.

    tools/operators.py

Any Python can run it: it starts itself again in that of Blender 4.5.
"""

from __future__ import annotations

import importlib.util
import math
import os
import sys
import tempfile
from pathlib import Path

from shell import ROOT, StepError, main, run, tool_environment

PAGE = ROOT / "docs" / "operators.md"
BLENDER = ROOT / ".envs" / "bpy-4.5" / "bin" / "python"
ADDON = "riffler_addon"

# Topic → its operators. Every registered one stands in exactly one, which `page` checks.
TOPICS = {
    "Stock and tools": ["new_stock", "add_solid", "fit_pitch", "rebuild", "millimetres", "scene_unit",
                        "tool_preset", "hand_tool_preset"],
    "Sculpting": ["stroke", "stroke_elsewhere", "make_sculpt", "edits_first", "resize", "size_step", "frame", "leave",
                  "cut_curve", "cut_recording", "stroke_add_curves", "stroke_edit", "stroke_move", "stroke_remove",
                  "strokes_restore", "strokes_settle"],
    "Clay": ["resample", "room", "crop", "split", "take_edits", "mask_form", "mask_invert", "mask_clear", "relief"],
    "Devices": ["pen_sculpt", "pen_trace", "pen_stop", "pen_home", "pen_reset"],
    "Meshes and files": ["detail", "to_mesh", "show_deviation", "hide_deviation", "import_cad", "retessellate",
                         "export_stl", "export_3mf", "export_nc", "export_recording"],
    "Recovery and reports": ["recover", "discard_journal", "dismiss", "doctor"],
    "Plans": ["plan_part", "plan_fixtures_add", "plan_fixtures_remove", "plan_tool", "plan_tool_open", "plan_tool_save",
              "plan_use_tool",
              "plan_assembly", "plan_find", "plan_from_strokes", "plan_show", "plan_switch", "plan_delete_paths"],
    "Orientations": ["plan_to_timeline", "plan_key", "plan_key_delete", "plan_key_jump", "plan_least_tilt",
                     "plan_check", "plan_point", "plan_point_key", "plan_turn", "plan_pen", "plan_pointer"],
    "Programs and verification": ["plan_resolve", "plan_nc", "machine_option", "machine_option_add", "simulate",
                                  "simulate_stop", "verify", "verify_clear",
                                  "finding_go"],
    "Jobs": ["machining_stock", "machining_add", "machining_remove", "machining_move", "machining_tool",
             "machining_calculate", "machining_left", "machining_zero", "machining_nc"],
}  # fmt: skip
# Groups of bpy.context.scene.riffler that operators use in addition to their arguments, and the operator whose settings
# a group has, too: those only fill in its button. The other groups have nothing else.
GROUPS = {
    "tool": ("", "The cutter of operators that are not given one."),
    "sculpt": ("", "How strokes are made, and what keeps tools out."),
    "plan": ("plan_find", "What the tab *Riffler Plan* plans on, and with what."),
    "machining": ("machining_stock", "What the panel *Job* machines the part with, and the operations in their order."),
    "verify": ("verify", "The stock that is simulated and verified, and what was found."),
}
OF_WINDOWS = {"rna_type", "check_existing", "filter_glob"}  # nothing that a script would set
HEAD = """\
<!-- Made by `make operators` from the add-on in Blender; not to be edited. -->
# Operators

What the add-on does, a script can ask for: `bpy.ops.riffler.new_stock(size=(60, 60, 20), pitch=0.25)`. There are
examples, which the tests run, in [planning](planning.md#in-blender), [sessions](sessions.md#in-blender) and
[engraving](engrave.md#with-another-tool).

- Lengths are in mm in scenes of any unit, angles in rad; what is in Blender units says so. Objects and pictures
  are given by name.
- What is not given has the default below, not what a panel shows: panels hand their settings to their buttons. The
  cutter, and how strokes are made, are the [scene's](#settings-of-the-scene).
- Sculpts and plans are meant by the active object. Most operators want Object Mode, and nothing long that runs.
- A call returns when all is done. With `"INVOKE_DEFAULT"` as its first argument it works as a button does: long work
  runs in the background and Esc cancels it, files are asked for.
- What is refused, and what fails, is a `RuntimeError` with the words of the status bar, and has changed nothing
  ([troubleshooting](troubleshooting.md)). `{"CANCELLED"}` without an error: there was nothing to do.
- *Refused in an empty scene* is what is missing there; `bpy.ops.riffler.….poll()` says whether anything is now.
"""
INTERNAL = "A panel's button: Blender's search does not list it."
MANY = 4  # entries from which on a list is printed once, and referred to afterwards


def plain(text: str) -> str:
    """On one line, and not taken for the end of a cell."""
    return " ".join(text.split()).replace("|", "\\|")


def number(value: float) -> str:
    """As it was written: properties are kept in single precision."""
    return str(value) if isinstance(value, int) else f"{value:.7g}"


def quantity(prop, value: float) -> str:
    return f"{math.degrees(value):.6g}°" if prop.subtype == "ANGLE" else number(value)


def limits(prop) -> str:
    """What a number may be, in words; nothing where it may be anything."""
    if prop.type not in ("INT", "FLOAT"):
        return ""
    endless = 2**31 - 1 if prop.type == "INT" else 3e38
    bounds = ["" if abs(end) >= endless else quantity(prop, end) for end in (prop.hard_min, prop.hard_max)]
    low, high = bounds
    return f"{low} to {high}" if low and high else f"{low} or more" if low else f"{high} at most" if high else ""


def kind(prop) -> str:
    names = {"BOOLEAN": "bool", "INT": "int", "FLOAT": "float", "STRING": "str", "COLLECTION": "list"}
    if prop.type == "POINTER":
        return prop.fixed_type.identifier
    if prop.type == "ENUM":
        return "set of str" if prop.is_enum_flag else "str"
    name = names[prop.type]
    count = getattr(prop, "array_length", 0)
    name = f"{count} {name}s" if count else name + {"ANGLE": ", rad", "PIXEL": ", pixels"}.get(prop.subtype, "")
    return f"{name}, {limits(prop)}" if limits(prop) else name


def default(prop) -> str:
    if prop.type in ("POINTER", "COLLECTION"):
        return ""
    if prop.type == "ENUM" and prop.is_enum_flag:
        chosen = [f'"{item.identifier}"' for item in prop.enum_items if item.identifier in prop.default_flag]
        return f"`{{{', '.join(chosen)}}}`" if chosen else "`set()`"
    if prop.type in ("ENUM", "STRING"):
        return f'`"{prop.default}"`'
    if getattr(prop, "array_length", 0):
        return f"`({', '.join(number(value) for value in prop.default_array)})`"
    if prop.type == "BOOLEAN":
        return f"`{prop.default}`"
    if not prop.hard_min <= prop.default <= prop.hard_max:  # it has none: its value is computed
        return ""
    shown = f"`{number(prop.default)}`"
    return f"{shown} ({quantity(prop, prop.default)})" if prop.subtype == "ANGLE" and prop.default else shown


def meaning(prop, where: str, said: dict) -> str:
    """What a panel calls it, its description, and that of each entry that it may be. `said`: long lists, and where they
    were written out."""
    label = f"*{plain(prop.name)}.* " if prop.name != prop.identifier else ""
    lines = [f"{label}{plain(prop.description)}".strip()]
    if prop.type == "COLLECTION":
        fields = dict.fromkeys(field.identifier for field in prop.fixed_type.properties)
        lines.append("Each has " + ", ".join(f"`{field}`" for field in fields if field != "rna_type"))
    entries = [(item.identifier, plain(item.description or item.name)) for item in getattr(prop, "enum_items", ())]
    here = where, prop.identifier
    there = said.setdefault(tuple(entries), here) if len(entries) >= MANY else here
    if there != here:
        return f"{lines[0]}: see `{there[1]}` of [{there[0]}](#{there[0]})"
    lines += [f'`"{name}"`' + (f": {what}" if what != name else "") for name, what in entries]
    return "<br>".join(lines)


def table(properties, where: str, said: dict) -> list[str]:
    """One line a property; none where a script has nothing to set."""
    rows = []
    for prop in properties:
        if prop.identifier not in OF_WINDOWS and (prop.description or not prop.is_hidden):
            rows.append(f"| `{prop.identifier}` | {kind(prop)} | {default(prop)} | {meaning(prop, where, said)} |")
    return ["| setting | type | default | |", "|---|---|---|---|", *rows, ""] if rows else []


def refusal(operator) -> str:
    """What is missing in the scene that is open, in the operator's words, or nothing."""
    if operator.poll():
        return ""
    try:
        operator()
    except RuntimeError as error:
        return plain(str(error).partition(".poll()")[2])
    raise StepError(f"{operator.idname_py()}: it was called although its poll refuses")


def of_operator(name: str, said: dict) -> list[str]:
    import bpy

    operator = getattr(bpy.ops.riffler, name)
    rna = operator.get_rna_type()
    registered = bpy.types.Operator.bl_rna_get_subclass_py(rna.identifier)
    about = [f"*{plain(rna.name)}.* {plain(rna.description).rstrip('.')}."]
    if "INTERNAL" in getattr(registered, "bl_options", ()):
        about.append(INTERNAL)
    if why := refusal(operator):
        about.append(f"Refused in an empty scene: *{why}*.")
    return [f"### {name}", "", " ".join(about), "", *table(rna.properties, name, said)]


def of_group(name: str, like: str, what: str, said: dict) -> list[str]:
    import bpy

    settings = getattr(bpy.ops.riffler, like).get_rna_type().properties if like else ()
    base = bpy.types.PropertyGroup.bl_rna.properties
    others = {(prop.identifier, prop.description) for prop in (*settings, *base)}
    own = getattr(bpy.context.scene.riffler, name).bl_rna.properties
    shown = [prop for prop in own if (prop.identifier, prop.description) not in others]
    return [f"### scene.riffler.{name}", "", what, "", *table(shown, name, said)]


def page() -> str:
    """The page, in a Blender that has the add-on. Opens an empty scene."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True)
    placed, registered = [name for names in TOPICS.values() for name in names], dir(bpy.ops.riffler)
    if sorted(placed) != sorted(registered):
        odd = sorted(set(placed) ^ set(registered)) or sorted({n for n in placed if placed.count(n) > 1})
        raise StepError(f"tools/operators.py: riffler.{odd[0]} must stand in exactly one topic, and be registered")
    lines, said = [HEAD], {}
    for topic, names in TOPICS.items():
        lines += [f"## {topic}", ""]
        for name in names:
            lines += of_operator(name, said)
    lines += ["## Settings of the scene", "", "`bpy.context.scene.riffler` has them in groups.", ""]
    for name, (like, what) in GROUPS.items():
        lines += of_group(name, like, what, said)
    return "\n".join(lines)


def enable() -> None:
    """The add-on of this checkout, in folders that are thrown away (BLENDER_USER_RESOURCES)."""
    import bpy

    addons = Path(bpy.utils.user_resource("SCRIPTS", path="addons", create=True))
    (addons / ADDON).symlink_to(ROOT / "addon", target_is_directory=True)
    bpy.ops.preferences.addon_enable(module=ADDON)
    if ADDON not in bpy.context.preferences.addons:
        raise StepError("the add-on was not enabled: the lines above say why")


def entry() -> None:
    if importlib.util.find_spec("bpy") is None:
        if not BLENDER.exists():
            raise StepError(f"{BLENDER.relative_to(ROOT)} is not there: make it with `make envs`")
        with tempfile.TemporaryDirectory() as folder:
            scripts = Path(folder, "scripts")
            (scripts / "addons").mkdir(parents=True)
            own = {"BLENDER_USER_RESOURCES": folder, "BLENDER_USER_SCRIPTS": str(scripts)}
            run(BLENDER, __file__, env=tool_environment(**own))
        return
    try:
        main(write)
    except SystemExit as left:
        code = left.code
    else:
        code = 0
    sys.stdout.flush()
    os._exit(code)  # a bpy wheel may crash or hang as the interpreter ends


def write() -> None:
    enable()
    text = page()
    PAGE.write_text(text)
    count = sum(line.startswith("### ") for line in text.splitlines())
    print(f"{PAGE.relative_to(ROOT)}: {count} operators and groups of settings")


if __name__ == "__main__":
    main(entry)
