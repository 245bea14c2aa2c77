"""The zips, from a wheel made here."""

import tomllib
import zipfile

import pytest

from addon import package


def wheel(folder, tag="cp311-cp311-manylinux_2_34_x86_64", version=None):
    path = folder / f"riffler-{version or package.version()}-{tag}.whl"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("riffler/__init__.py", "x = 1")
        archive.writestr("riffler.libs/libz.so", "z")
        archive.writestr("riffler-0.dist-info/METADATA", "")
    return path


def test_the_extension_carries_wheels_and_a_manifest_that_names_them(tmp_path):
    wheels = [wheel(tmp_path), wheel(tmp_path, "cp313-cp313-win_amd64")]
    extension, legacy = package.build(wheels, tmp_path / "dist")
    with zipfile.ZipFile(extension) as archive:
        names = set(archive.namelist())
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
    assert manifest["wheels"] == [f"./wheels/{w.name}" for w in wheels]
    assert manifest["platforms"] == ["linux-x64", "windows-x64"]
    assert {f"wheels/{w.name}" for w in wheels} | {"__init__.py", "common/presets.json", "LICENSE"} <= names
    assert not names & {"package.py", "ruff.toml"} and not any("pycache" in n for n in names)
    with zipfile.ZipFile(legacy) as archive:
        names = set(archive.namelist())
        first = archive.infolist()[0]
    root = package.LEGACY_NAME
    # an update removes this first, instead of overwriting the running core
    assert first.filename == f"{root}/" and first.is_dir()
    assert {
        f"{root}/__init__.py",
        f"{root}/_vendor/riffler/__init__.py",
        f"{root}/_vendor/riffler.libs/libz.so",
    } <= names
    assert all(n.startswith(f"{root}/") for n in names)


def test_the_same_wheel_gives_the_same_bytes(tmp_path):
    w = wheel(tmp_path)
    first = [p.read_bytes() for p in package.build([w], tmp_path / "a")]
    assert first == [p.read_bytes() for p in package.build([w], tmp_path / "b")]


def test_the_legacy_zip_takes_the_wheel_of_its_python_wherever_it_stands(tmp_path):
    mine = wheel(tmp_path)
    others = [wheel(tmp_path, "cp313-cp313-manylinux_2_39_x86_64"), wheel(tmp_path, "cp311-cp311-win_amd64")]
    assert package.legacy_wheel([*others, mine]) == mine
    made = package.build([*others, mine], tmp_path / "dist")
    assert [p.name.endswith("-legacy.zip") for p in made] == [False, True]
    without = package.build(others, tmp_path / "without")
    assert [p.name.endswith("-legacy.zip") for p in without] == [False]


def test_wheels_that_do_not_fit_are_named(tmp_path):
    with pytest.raises(ValueError, match="same Python"):
        package.build([wheel(tmp_path), wheel(tmp_path, "cp311-cp311-linux_x86_64")], tmp_path / "dist")
    with pytest.raises(ValueError, match=r"9\.9\.9"):
        package.build([wheel(tmp_path, version="9.9.9")], tmp_path / "dist")
    with pytest.raises(ValueError, match="not there"):
        package.build([tmp_path / "none.whl"], tmp_path / "dist")
    with pytest.raises(ValueError, match="mips"):
        package.build([wheel(tmp_path, "cp311-cp311-linux_mips")], tmp_path / "dist")
    assert not (tmp_path / "dist").exists() or not list((tmp_path / "dist").iterdir())
