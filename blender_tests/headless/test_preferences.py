"""The add-on's preferences: device, limits, threads and folders are used; keys, menus, the doctor."""

import contextlib
import importlib.util
import json
import shutil
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, leak_check


@contextlib.contextmanager
def preferred(**chosen):
    """Preferences survive a change of file: restores them afterwards."""
    preferences = common.part("blender.preferences_access").preferences  # another object after the add-on was disabled
    before = {name: getattr(preferences(), name) for name in chosen}
    try:
        for name, value in chosen.items():
            setattr(preferences(), name, value)
        yield preferences()
    finally:
        for name, value in before.items():
            setattr(preferences(), name, value)


def folder(name):
    path = Path(common.out(name))
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir()
    return path


def other(device):
    """A device of another kind than the simulated one; none is connected."""
    return next(kind for kind in riffler.pen.kinds() if kind not in ("simulated", device))


def test_the_preferences_are_the_addons_for_every_kind_of_installation():
    found = bpy.context.preferences.addons[common.MODULE].preferences
    assert (
        found == common.part("blender.preferences_access").preferences()
        and type(found).__name__ == "RifflerPreferences"
    )


def test_every_kind_of_device_can_be_chosen_and_is_described_in_german():
    found = bpy.context.preferences.addons[common.MODULE].preferences
    choices = {item.identifier: item for item in found.bl_rna.properties["device"].enum_items}
    assert set(riffler.pen.kinds()) == set(choices) and "haply" in choices
    german = json.loads((Path(common.part("translations").__file__).parent / "de.json").read_text())
    assert all(item.description in german for item in choices.values())


def test_limits_have_the_defaults_of_the_core():
    """The defaults of the native core (native/include/riffler/haptics/limits.hpp): 5 N, 300 N·mm, 2 W."""
    given = common.part("blender.preferences_access").limits()
    assert np.allclose([given["max_force"], given["max_torque"], given["max_power"]], (5, 300, 2000))


@common.core_bound
def test_no_session_passes_more_force_than_allowed():
    """From its journal, which has every step: 0.2 N instead of the default 5."""
    common.scale(1)
    ob = common.stock(size=(60, 60, 20), pitch=0.5, directions="z")
    place = folder("limited")
    with preferred(force=0.2, torque=30.0, power=0.5):
        settings = bpy.context.scene.riffler.pen
        given = common.part("pen.operators").session_options(
            bpy.context, ob, settings, common.part("sculpt.brushes").of("remove")
        )
        assert np.allclose([given["max_force"], given["max_torque"], given["max_power"]], (0.2, 30, 500))
        device = {"device": "simulated", "gap": 0.0, "removal_constant": 0.5}
        forces = []
        for seconds in (4.0, 8.0, 16.0, 32.0):  # a busy computer cuts the force now and then
            bpy.ops.riffler.pen_sculpt(seconds=seconds, tool=common.BALL, record=True, folder=str(place), **device)
            strokes = [s for p in place.glob("*.rjournal") for s in riffler.Journal.load(p).strokes]
            forces = [np.linalg.norm(s.forces[:, :3], axis=1).max() for s in strokes if s.forces is not None and len(s)]
            if forces:
                break
    assert forces, "the simulated hand has cut nothing four times"
    assert 0 < max(forces) <= 0.2 + 1e-6, forces


def test_the_device_is_the_one_of_the_preferences_unless_the_scene_has_another():
    common.scale(1)
    common.stock(size=(10, 10, 5), pitch=0.5)
    assert bpy.context.scene.riffler.pen.device == "preferred"
    kind = other("simulated")
    with preferred(device=kind):
        common.refused(lambda: bpy.ops.riffler.pen_sculpt(seconds=0.1))  # no such device is connected
        assert bpy.ops.riffler.pen_sculpt(seconds=0.1, device="simulated", gap=500.0) == {"CANCELLED"}


def test_the_number_of_threads_follows_the_preference():
    automatic = riffler.threads()
    with preferred(threads=3):
        assert riffler.threads() == 3
        bpy.ops.preferences.addon_disable(module=common.MODULE)
        assert riffler.threads() == automatic
        bpy.ops.preferences.addon_enable(module=common.MODULE)
    assert riffler.threads() == automatic


def test_saved_threads_are_used_again_when_the_addon_is_enabled():
    with preferred(threads=3):
        riffler.set_threads(None)
        common.part("preferences").attach()
        assert riffler.threads() == 3


def test_journals_are_written_into_the_folder_that_was_chosen():
    from support import sculpting

    place = folder("journals")
    with preferred(journals=str(place)):
        sculpting.stroke(sculpting.sculpt(), 1)
        assert len([p for p in place.iterdir() if p.is_dir()]) == 1
        common.part("sculpt.live_registry").end_all()
        common.part("sculpt.persistence").leave()


def test_journals_are_found_in_the_old_folder_too():
    keeping, chosen = common.part("sculpt.persistence"), common.part("blender.preferences_access")
    own = chosen.target("journals")
    own.mkdir(parents=True, exist_ok=True)
    with preferred(journals=str(folder("new journals"))) as found:
        assert chosen.folders("journals") == [Path(found.journals), own]
        assert keeping.folder() == Path(found.journals) and not keeping.crashed(look=True)
        shutil.copytree(left_in(own), own / "cut off")  # no process holds the copy
        try:
            assert [f.folder for f in keeping.crashed(look=True)] == [own / "cut off"]
        finally:
            shutil.rmtree(own / "cut off")
            keeping.crashed(look=True)


def left_in(place):
    """The folder of a journal with one stroke."""
    from support import sculpting

    with preferred(journals=""):
        name = sculpting.sculpt()
        sculpting.stroke(name, 1)
        journal = common.part("sculpt.live_registry").of(bpy.data.objects[name]).persistence.journal
        while not journal.settled():  # its initial stock is being written
            pass
        assert journal.folder.parent == place
        return journal.folder


def test_a_missing_folder_is_named_and_work_continues():
    from support import sculpting

    gone = str(Path(common.out("")) / "gone")
    libraries = common.part("plan.tool_libraries")
    with preferred(journals=gone, tools=gone):
        name = sculpting.sculpt()
        before = common.content(bpy.data.objects[name]).volume.volume
        sculpting.stroke(name, 1)
        run = common.part("sculpt.live_registry").of(bpy.data.objects[name])
        assert run.volume.volume < before
        assert gone in run.persistence.problem and "preferences" in run.persistence.problem
        common.part("sculpt.live_registry").end_all()
        _, problems = libraries.files()
        assert any(gone in line for line in problems)
        common.refused(lambda: bpy.ops.riffler.plan_tool_save(name="Mine"), gone, "preferences")
    assert not Path(gone).exists()


def test_tools_of_both_folders_are_offered():
    place = folder("shared tools")
    bpy.ops.riffler.plan_tool(name=common.part("common.presets").presets()[0]["name"])
    with preferred(tools=str(place)):
        bpy.ops.riffler.plan_tool_save(name="Everybody's")
        assert len(list(place.iterdir())) == 1
        assert "Everybody's" in [e.name for e in common.part("plan.tool_libraries").files()[0]]


def test_a_folder_relative_to_the_file_becomes_absolute():
    bpy.ops.wm.save_as_mainfile(filepath=common.out("beside.blend"))
    with preferred(tools="//") as found:
        assert Path(found.tools) == Path(common.out("beside.blend")).parent


def test_the_doctor_writes_what_it_finds_into_a_text():
    assert bpy.ops.riffler.doctor() == {"FINISHED"}
    text = bpy.data.texts["Riffler Doctor"].as_string()
    import numpy

    words = ("riffler", riffler.__version__, numpy.__version__, bpy.app.version_string, common.MODULE, "threads")
    for word in (*words, str(common.part("blender.preferences_access").target("tools"))):
        assert word in text, (word, text)
    assert text.count("\nBlender ") == 1
    bpy.ops.riffler.doctor()
    assert [t.name for t in bpy.data.texts] == ["Riffler Doctor"]


def blenders_keys():
    """(keymap, key, ctrl, shift, alt) of every item in Blender's own configuration."""
    for place in bpy.utils.script_paths():
        path = Path(place) / "presets" / "keyconfig" / "keymap_data" / "blender_default.py"
        if path.exists():
            spec = importlib.util.spec_from_file_location("blender_default", path)
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
            for name, _, content in module.generate_keymaps(module.Params(select_mouse="LEFT")):
                for _, key, _ in content["items"]:
                    yield (name, key["type"], *(bool(key.get(m)) for m in ("ctrl", "shift", "alt")))
            return
    raise AssertionError("Blender's keys were not found")


def test_the_keys_are_in_the_addons_configuration_and_take_none_of_blenders():
    keymaps = common.part("keymaps")
    assert len(list(keymaps.users())) == len(keymaps.KEYS)
    own = ("wm.call_menu", "simulate_stop", "pen_stop")
    ours = [line for line in leak_check.keymaps() if any(name in line for name in own)]
    assert len(ours) >= len(keymaps.KEYS)
    taken = set(blenders_keys())
    assert ("Object Mode", "D", False, True, False) in taken  # duplicate
    for key in keymaps.KEYS:
        if key.event["type"] == "ESC":
            name = key.operator.removeprefix("riffler.")
            assert not getattr(bpy.ops.riffler, name).poll(), "Esc is Blender's while nothing runs"
            continue
        event = (key.event["type"], *(key.event.get(m, False) for m in ("ctrl", "shift", "alt")))
        for name in ("Object Mode", "3D View", "3D View Generic", "Object Non-modal", "Window", "Screen", "Frames"):
            assert (name, *event) not in taken, (name, key)


def test_menus_are_drawn_into_blenders():
    drawn = leak_check.menus(common.MODULE)
    assert len(drawn) == 5 and any("VIEW3D_MT_mesh_add" in line for line in drawn), drawn


def test_the_tab_begins_with_what_an_artist_needs_and_machining_comes_last():
    panels = [cls for m in common.part("registration").modules() for cls in m.CLASSES]
    ours = [cls for cls in panels if getattr(cls, "bl_category", "") == "Riffler" and not hasattr(cls, "bl_parent_id")]
    places = {cls.bl_idname.removeprefix("RIFFLER_PT_"): getattr(cls, "bl_order", 0) for cls in ours}
    assert len(set(places.values())) == len(places), places
    order = sorted(places, key=places.get)
    # what was interrupted is above all, while there is something to show
    assert order[:6] == ["recover", "sculpt", "sculpt_tool", "tool", "clay", "stock"], order
    assert order[-2:] == ["cut", "export"], order


def shown():
    """(where, property) of everything that a user can set, and (where, None) of operators."""
    for module in common.part("registration").modules():
        for cls in module.CLASSES:
            if issubclass(cls, bpy.types.Operator):
                rna = getattr(bpy.ops.riffler, cls.bl_idname.partition(".")[2]).get_rna_type()
                yield cls.__name__, None, rna
            elif cls.__name__ == "RifflerPreferences" or (
                issubclass(cls, bpy.types.PropertyGroup) and cls.__name__ in groups()
            ):
                rna = cls.bl_rna
            else:
                continue
            own = {p.identifier for p in rna.properties} - {"rna_type", "name", "bl_idname"}
            own |= {"name"} & set(getattr(cls, "__annotations__", {}))
            for name in sorted(own):
                if not rna.properties[name].is_hidden:
                    yield cls.__name__, rna.properties[name], rna


def groups():
    """Groups of the scene's settings: the data on objects, meshes and the window manager is shown nowhere."""
    own = common.part("properties")
    return {
        p.fixed_type.identifier
        for group in (own.RifflerScene, own.RifflerMachines)
        for p in group.bl_rna.properties
        if p.type == "POINTER" and p.identifier != "rna_type"
    }


def test_every_button_and_setting_has_a_tooltip_in_one_line():
    seen = list(shown())
    assert len(seen) > 150 and len(groups()) >= 9
    bad = [(where, p.identifier if p else "itself") for where, p, rna in seen if not (p or rna).description]
    assert not bad, bad
    bad = [where for where, p, rna in seen if "\n" in (p or rna).description or (p or rna).description.endswith(".")]
    assert not bad, bad


@common.anywhere
def test_every_text_of_the_translations_is_one_of_the_addons():
    """In a class, or literally in the sources (drawn texts, and reasons for refusals)."""
    import ast

    known = {text for s in riffler.plan.STRATEGIES.values() for text in (s.action, s.missing)}
    known |= {tool["name"] for tool in common.part("common.hand_tools").presets()}
    for _, p, rna in shown():
        known |= {(p or rna).name, (p or rna).description}
        if p is not None and p.type == "ENUM":
            known |= {t for item in p.enum_items for t in (item.name, item.description)}
    root = Path(common.part("registration").__file__).parent
    for path in root.rglob("*.py"):
        if "_vendor" not in path.parts:
            known |= {n.value for n in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if is_text(n)}
    table = common.part("translations").table()
    assert set(table) >= {"de"}
    for language, texts in table.items():
        unknown = {text for _, text in texts} - known
        assert not unknown, (language, unknown)
        assert all(said.strip() for said in texts.values()), language


def test_every_shown_text_is_looked_up_in_the_addons_own_words():
    own = common.part("translations").CONTEXT
    for cls in (c for m in common.part("registration").modules() for c in m.CLASSES if hasattr(c, "bl_label")):
        assert cls.bl_translation_context == own, cls
    if "translation_context" not in bpy.props.FloatProperty.__doc__:
        return  # Blender 3.4: fields have none
    others = {p.identifier for _, p, _ in shown() if p is not None and p.translation_context != own}
    assert others <= {"filepath", "check_existing", "filter_glob", "rna_type"}, others  # of its file selector


def is_text(node):
    import ast

    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def test_a_blender_in_german_speaks_german():
    view = bpy.context.preferences.view
    if "de_DE" not in bpy.app.translations.locales:
        raise common.Skip("this Blender was built without languages")
    common.stock(size=(10, 10, 5), pitch=0.5)
    before = view.language
    try:
        view.language = "de_DE"
        view.use_translate_interface = True
        assert bpy.app.translations.pgettext_iface("New Stock", "Operator") == "Neues Rohteil"
        own = common.part("translations").CONTEXT  # in Blender's own catalogue a pitch is a slope
        assert bpy.app.translations.pgettext_iface("Pitch", own) == "Raster"
        assert bpy.app.translations.pgettext_iface("Pivot Length (mm)", own) == "Pivotlänge (mm)"  # a machine's file
        common.refused(bpy.ops.riffler.relief, "Ein Bild wählen")  # reports, which Blender does not look up
    finally:
        view.language = before
