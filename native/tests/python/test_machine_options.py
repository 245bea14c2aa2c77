"""What can be given to a machine, of which a panel makes fields: names, kinds, units, values where none is given."""

import numpy as np
import pytest
import riffler

KINDS = {"number", "positive", "numbers", "range", "flag", "word"}
PROGRAM = riffler.Program.from_cl(
    [[[0, 0, 0, 0, 0, 1], [10, 0, 0, 0, 0, 1]]], tools=[riffler.Tool.ball(6, 30)], feed=600
)


def facts(machine, options=None):
    return {fact.name: fact for fact in riffler.machine_options(machine, options=options)}


def some(fact):
    """A value of its kind."""
    if fact.kind == "word":
        return fact.words[-1]
    if fact.kind == "flag":
        return not fact.value
    return {"number": 5, "positive": 500.0, "numbers": [1, 2, 3], "range": [-90, 90]}[fact.kind]


@pytest.mark.parametrize("machine", list(riffler.machines()))
def test_each_option_is_described_and_taken(machine, tmp_path):
    listed = facts(machine)
    needed = {name: some(fact) for name, fact in listed.items() if fact.needed}
    for name, fact in listed.items():
        assert fact.kind in KINDS and fact.about, name
        assert fact.unit in ("", "mm", "deg", "mm/min", "deg/min")
        if fact.kind in ("positive", "range"):
            assert fact.unit, f"{name}: a number of what?"
        given = {**needed, name: some(fact)}
        if machine.startswith(("heidenhain", "sinumerik")) and name == "tcp":
            given[name] = True
        if fact.name == "tcp":  # joints may need more
            given |= {n: some(f) for n, f in facts(machine, given).items() if f.needed}
        PROGRAM.write(tmp_path / "p.nc", post=machine, options=given)
    with pytest.raises(ValueError, match="unknown option 'nonsense'; known: ") as error:
        PROGRAM.write(tmp_path / "q.nc", post=machine, options={**needed, "nonsense": 1})
    named = str(error.value).split("known: ")[1].split(", ")
    others = {"vectors"} if not machine.startswith("heidenhain") else {"retract"}  # of other languages
    others |= {"retract"} if machine == "apt" else set()
    assert sorted(named) == sorted({*listed, *others}), "nothing that can be given is missing from the list"


@pytest.mark.parametrize("machine", list(riffler.machines()))
def test_listed_values_are_the_defaults(machine, tmp_path):
    listed = facts(machine)
    needed = {name: some(fact) for name, fact in listed.items() if fact.needed}
    values = {name: fact.value for name, fact in listed.items() if fact.value is not None}
    PROGRAM.write(tmp_path / "a.nc", post=machine, options=needed)
    PROGRAM.write(tmp_path / "b.nc", post=machine, options={**values, **needed})
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_required_options_depend_on_the_given_ones():
    assert facts("linuxcnc-xyzac")["rot_point"].needed
    assert not facts("linuxcnc-xyzac", {"tcp": True})["rot_point"].needed
    assert not facts("head-head")["pivot_length"].needed
    assert facts("head-head", {"tcp": False})["pivot_length"].needed
    fact = facts("head-head")["pivot_length"]
    assert (fact.kind, fact.count, fact.unit, fact.value) == ("number", 1, "mm", None)
    rotation = facts("linuxcnc-xyzac")["limits_a"]
    assert (rotation.kind, rotation.count, rotation.unit) == ("range", 2, "deg")
    assert facts("linuxcnc-xyzac")["rate_c"].unit == "deg/min" and facts("tcp")["rate_x"].unit == "mm/min"


def test_a_users_machine_lists_its_own_options_first(tmp_path, monkeypatch):
    monkeypatch.setenv("RIFFLER_MACHINES", str(tmp_path))
    (tmp_path / "mill.toml").write_text(
        'description = "mill"\nwords = "joints"\n[options]\n'
        'table = { value = [1, 2, 3], about = "where the axes cross" }\nraised = 5\n'
        'pivot = { needed = "joints", about = "mm to the pivot" }\n'
        '[[rotary]]\nletter = "C"\ncarries = "part"\naxis = [0, 0, 1]\n'
        "at = { table = [1, 1, 1], raised = [0, 0, 1], pivot = [0, 0, 1] }\n"
    )
    listed = riffler.machine_options("mill")
    assert [fact.name for fact in listed[:3]] == ["pivot", "raised", "table"]
    assert listed[0].needed and listed[1].value == 5 and listed[2].value == [1, 2, 3]
    assert listed[2].about == "where the axes cross"
    with pytest.raises(ValueError, match="option pivot must be given: mm to the pivot"):
        PROGRAM.write(tmp_path / "p.nc", post="mill")
    (tmp_path / "mill.toml").write_text(
        'description = "mill"\n[options]\ntable = { value = 5, needed = "joints", about = "x" }\n'
    )
    with pytest.raises(riffler.FormatError, match=r"mill.toml, line 3: an option with a value is not needed"):
        riffler.machine_options("mill")


def test_a_machine_s_file_has_its_texts_and_its_control_s_language(tmp_path):
    extensions = {"rs274": ".ngc", "heidenhain": ".h", "sinumerik": ".mpf", "apt": ".apt"}
    for machine, description in riffler.machines().items():
        texts = riffler.machine_texts(machine)
        assert texts.description == description
        assert texts.extension == extensions[texts.language]
        assert texts.translations["de"][description], machine
        own = {fact.name for fact in riffler.machine_options(machine) if fact.own}
        assert own <= set(texts.translations["de"]), machine
    file = tmp_path / "mill.toml"
    file.write_text('description = "mill"\ncontrol = "apt"\n[translations.fr]\ndescription = "fraiseuse"\n')
    texts = riffler.machine_texts(str(file))
    assert (texts.extension, texts.translations) == (".apt", {"fr": {"mill": "fraiseuse"}})
    file.write_text('description = "mill"\n[translations.fr]\nhauteur = 3\n')
    with pytest.raises(riffler.FormatError, match=r"mill.toml, line 3: translations: there is no option hauteur"):
        riffler.machine_texts(str(file))
    with pytest.raises(ValueError, match="unknown machine lathe"):
        riffler.machine_texts("lathe")


def test_wrong_machines_and_options_are_value_errors():
    with pytest.raises(ValueError, match="lathe"):
        riffler.machine_options("lathe")
    with pytest.raises(ValueError, match="rot_point must be three finite numbers"):
        riffler.machine_options("linuxcnc-xyzac", options={"rot_point": np.nan})
    with pytest.raises(ValueError, match="unknown option 'pivot'; known: "):
        riffler.machine_options("tcp", options={"pivot": 3})


@pytest.mark.parametrize(
    "machine, wrong, meant",
    [
        ("tcp", "max_rotaryy", "max_rotary"),
        ("tcp", "safe-height", "safe_height"),
        ("linuxcnc-xyzac", "rotpoint", "rot_point"),
        ("head-table", "limits_q", "limits_x"),
        ("heidenhain", "vector", "vectors"),
    ],
)
def test_a_misspelt_option_is_answered_with_the_nearest_one(machine, wrong, meant, tmp_path):
    file, needed = tmp_path / "p.nc", {name: some(fact) for name, fact in facts(machine).items() if fact.needed}
    PROGRAM.write(file, post=machine, options=needed)
    for call in (
        lambda: riffler.machine_options(machine, options={wrong: 1}),
        lambda: PROGRAM.write(tmp_path / "q.nc", post=machine, options={**needed, wrong: 1}),
        lambda: riffler.Program.read(file, machine=machine, options={**needed, wrong: 1}),
    ):
        with pytest.raises(ValueError, match=rf"{machine}: unknown option '{wrong}'; did you mean {meant}\? known: "):
            call()
    with pytest.raises(ValueError, match=r"unknown \w+ tpc; did you mean tcp\? known: "):
        riffler.machine_options("tpc")
