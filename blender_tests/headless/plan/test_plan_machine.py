"""A machine's options as fields: required ones are asked for, and set ones are used to write, read and verify."""

from pathlib import Path

import bpy
import riffler

from support import common, plans, programs


def machines():
    return bpy.context.scene.riffler.machines


def write(name, **more):
    path = Path(common.out(name))
    path.unlink(missing_ok=True)
    bpy.ops.riffler.plan_nc("EXEC_DEFAULT", filepath=str(path), **more)
    return path


def test_every_option_of_every_machine_is_a_field_with_its_unit():
    fields = common.part("plan.pure.machine_fields")
    for machine in riffler.machines():
        group = machines().of(machine)
        for fact in riffler.machine_options(machine):
            prop = group.bl_rna.properties[fields.identifier(fact.name)]
            assert prop.name.endswith(f"({fact.unit})") if fact.unit else "(" not in prop.name, prop.name
            assert prop.description == fields.about(fact)
        assert machines().given(machine) == {}, "no option is passed on before the user sets it"


def test_a_missing_pivot_is_requested():
    ob = programs.resolved()
    settings = bpy.context.scene.riffler.plan
    settings.post = "linuxcnc-xyzac"
    path = common.out("asked.ngc")
    Path(path).unlink(missing_ok=True)
    common.refused(
        lambda: bpy.ops.riffler.plan_nc("EXEC_DEFAULT", filepath=path),
        "linuxcnc-xyzac: Rot Point (mm) is not set", "in the panel Machine, or take the place of the 3D cursor",
    )  # fmt: skip
    assert not Path(path).exists() and programs.content(ob)
    (missing,) = common.part("plan.pure.machine_fields").missing("linuxcnc-xyzac", {})
    assert missing.name == "rot_point"
    bpy.context.scene.cursor.location = (1, 2, -40)
    bpy.ops.riffler.machine_option(machine="linuxcnc-xyzac", option="rot_point", how="CURSOR")
    assert machines().given("linuxcnc-xyzac") == {"rot_point": [1, 2, -40]}
    mine = write("mine.ngc").read_text().splitlines()
    theirs = write("theirs.ngc", options='{"rot_point": [1, 2, -40]}').read_text().splitlines()
    assert mine == theirs
    bpy.ops.riffler.machine_option(machine="linuxcnc-xyzac", option="rot_point", how="UNSET")
    assert machines().given("linuxcnc-xyzac") == {}
    machines().of("linuxcnc-xyzac").tcp = True  # the control knows the machine: no pivot is needed
    assert write("tip.ngc").exists()


def test_the_scene_s_zero_counts_once_it_is_given():
    programs.resolved()
    bpy.context.scene.riffler.plan.post = "linuxcnc-xyzac"
    bpy.ops.riffler.machine_option(machine="linuxcnc-xyzac", option="rot_point", how="GIVE")
    assert machines().given("linuxcnc-xyzac") == {"rot_point": [0, 0, 0]}
    assert write("zero.ngc").exists()


def test_fields_keep_the_entered_numbers():
    own = machines().of("linuxcnc-xyzac")
    own.rot_point, own.limits_a, own.max_rotary = (0.1, 0, -40.05), (-60, 60), 2000
    own.coolant, own.arcs, own.line_numbers = "flood", True, 10
    assert machines().given("linuxcnc-xyzac") == {
        "rot_point": [0.1, 0, -40.05], "limits_a": [-60, 60], "max_rotary": 2000, "coolant": "flood", "arcs": True,
        "line_numbers": 10,
    }  # fmt: skip
    assert machines().given("linuxcnc-xyzbc") == {}, "each machine has its own"
    programs.resolved()
    text = write("fields.ngc", post="linuxcnc-xyzac").read_text()
    assert "M8\n" in text and "N10 " in text and "N20 " in text


def test_another_machine_takes_its_own_options():
    """An option set for one machine is not passed to the other."""
    programs.resolved()
    machines().of("linuxcnc-xyzac").rot_point = (0, 0, -40)
    bpy.context.scene.riffler.plan.post = "linuxcnc-xyzac"
    assert write("own.ngc", post="tcp").exists()


def test_options_are_added_and_wrong_names_listed():
    assert bpy.ops.riffler.machine_option_add(machine="head-head", option="limits_b") == {"FINISHED"}
    assert machines().given("head-head") == {"limits_b": [-100, 100]}
    common.refused(
        lambda: bpy.ops.riffler.machine_option(machine="tcp", option="pivot"), "tcp has no option 'pivot': it has tcp"
    )
    common.refused(
        lambda: bpy.ops.riffler.machine_option(machine="head-head", option="pivot_length", how="CURSOR"),
        "is not a position",
    )


def test_a_file_is_read_with_the_fields_of_its_machine():
    programs.resolved()
    programs.stock()
    bpy.context.scene.riffler.plan.take(plans.TOOL.to_dict())
    machines().of("linuxcnc-xyzac").rot_point = (0, 0, -40)
    path = write("read.ngc", post="linuxcnc-xyzac")
    assert bpy.ops.riffler.verify(source="FILE", filepath=str(path), machine="linuxcnc-xyzac") == {"FINISHED"}
    assert programs.listed(programs.settings().findings) == []
    machines().of("linuxcnc-xyzac").property_unset("rot_point")
    common.refused(
        lambda: bpy.ops.riffler.verify(source="FILE", filepath=str(path), machine="linuxcnc-xyzac"),
        "Rot Point (mm) is not set",
    )
