"""Devices behind their maker's program or library, through the command line and Python."""

from __future__ import annotations

import json
import shutil
import subprocess
import time
from pathlib import Path

import pytest
import riffler
from commands import in_shell
from inverse_service import arm, grip, inverse_service


def flat(text: str) -> str:
    """A table's text without its line breaks."""
    return " ".join(text.split())


@pytest.fixture
def haply(tmp_path):
    """Runs a command of riffler with the service's port."""

    def run(service, *words: str):
        return in_shell(*words, cwd=tmp_path, RIFFLER_HAPLY_PORT=str(service.server_address[1]))

    return run


def test_haplys_arms_are_listed(haply):
    with inverse_service(arm("049D"), arm("04BA", in_use=True), grips=(grip("61576"),)) as service:
        data = json.loads(haply(service, "pen", "list", "--json").stdout)
        first, second = (found for found in data["devices"] if found["kind"] == "haply")
        assert (first["path"], first["serial"], first["id"], first["maker"]) == ("haply:049D", "049D", "", "Haply")
        assert first["problem"] is None and "senses x y z a b c, pushes x y z" in first["capability"]
        assert "grip 61576" in first["about"] and "Inverse Service 3.5" in first["about"]
        assert second["problem"] == "busy" and "another program uses the arm" in second["text"]
        assert "haply" not in data["unavailable"] and "haply" in data["kinds"]
        table = flat(haply(service, "pen", "list").stdout)
        assert "inverse3: haply, senses" in table
        assert "haply:049D" in flat(haply(service, "doctor").stdout)
        assert service.forces == [], "a search commands nothing"


def test_the_error_of_a_missing_service_names_what_to_start(haply):
    with inverse_service() as service:
        empty = json.loads(haply(service, "pen", "list", "--json").stdout)
        assert "is it plugged in and switched on?" in empty["unavailable"]["haply"]
    listed = haply(service, "pen", "list")
    assert listed.returncode == 0 and "start Haply Hub or the Inverse Service" in flat(listed.stdout)
    assert "RIFFLER_HAPLY_PORT" in flat(haply(service, "doctor").stdout)
    monitored = haply(service, "pen", "monitor", "haply", "--seconds", "1")
    assert monitored.returncode != 0 and "no program listens" in flat(monitored.stderr)


def test_haplys_arm_is_monitored_without_force(haply):
    with inverse_service(arm("049D"), grips=(grip("61576"),)) as service:
        done = haply(service, "pen", "monitor", "haply", "--seconds", "1", "--json")
        assert done.returncode == 0, done.stderr
        data = json.loads(done.stdout)
        assert data["link"]["reports"] > 50 and data["link"]["malformed"] == 0
        assert data["pose"] == pytest.approx([10, -120, 150, 0, -1, 0])
        assert service.forces and all(force == {"x": 0, "y": 0, "z": 0} for force in service.forces)


def test_haplys_arm_pushes(monkeypatch):
    with inverse_service(arm("049D")) as service:
        monkeypatch.setenv("RIFFLER_HAPLY_PORT", str(service.server_address[1]))
        assert [found.path for found in riffler.pen.devices() if found.kind == "haply"] == ["haply:049D"]
        assert "haply" not in riffler.pen.unavailable()
        with riffler.pen.open("haply:049D") as device:
            assert device.limits["x"].pushes and not device.limits["a"].pushes
            end = time.monotonic() + 20
            while max((force["z"] for force in service.forces), default=0) < 0.5 and time.monotonic() < end:
                answer = device.push([0, 0, 0.5])
                time.sleep(1e-3)
            assert answer.reason is None
            assert device.push([0, 0, 0.5], [1, 0, 0]).reason == "the device has no motors for all of it"
        assert max(force["z"] for force in service.forces) == 0.5
        end = time.monotonic() + 10
        while service.forces[-1]["z"] != 0 and time.monotonic() < end:
            time.sleep(1e-3)
        assert service.forces[-1]["z"] == 0, "closing ends the force"


def test_another_version_is_named(monkeypatch):
    with inverse_service(arm("049D"), version="4.1.0") as service:
        monkeypatch.setenv("RIFFLER_HAPLY_PORT", str(service.server_address[1]))
        with pytest.raises(riffler.pen.PenError, match=r"has version 4\.1; Riffler speaks with 3\.1"):
            riffler.pen.open("haply")


@pytest.fixture(scope="session")
def stubs(tmp_path_factory):
    """Folder with the stubs of makers' libraries, compiled as their users' would be."""
    compiler = shutil.which("c++")
    if compiler is None:
        pytest.skip("no C++ compiler for the stubs of makers' libraries")
    folder, tests = tmp_path_factory.mktemp("stubs"), Path(__file__).parents[1]
    for name in ("dhd", "hd"):
        source = tests / "pen" / "library" / f"stub_{name}.cpp"
        command = [
            compiler,
            "-std=c++20",
            "-shared",
            "-fPIC",
            "-pthread",
            "-I",
            tests,
            source,
            "-o",
            folder / f"{name}.so",
        ]
        subprocess.run(command, check=True)
    return folder


@pytest.mark.parametrize(
    ("kind", "variable", "stub", "name", "pose"),
    [
        ("force-dimension", "RIFFLER_LIBDHD", "dhd.so", "sigma.7", [20, -10, 30, 0, -1, 0]),
        ("touch", "RIFFLER_LIBHD", "hd.so", "Touch", [10, -30, 20, 0, -1, 0]),
    ],
)
def test_arms_behind_a_library_are_listed_and_monitored(stubs, tmp_path, kind, variable, stub, name, pose):
    chosen = {variable: str(stubs / stub)}
    data = json.loads(in_shell("pen", "list", "--json", cwd=tmp_path, **chosen).stdout)
    (found,) = (device for device in data["devices"] if device["kind"] == kind)
    assert found["path"].startswith(kind) and found["name"] == name and found["problem"] is None
    assert "pushes x y z" in found["capability"] and kind not in data["unavailable"]
    assert name in in_shell("doctor", cwd=tmp_path, **chosen).stdout
    done = in_shell("pen", "monitor", found["path"], "--seconds", "0.5", "--json", cwd=tmp_path, **chosen)
    assert done.returncode == 0, done.stderr
    monitored = json.loads(done.stdout)
    assert monitored["pose"] == pytest.approx(pose) and monitored["link"]["reports"] > 20
    assert monitored["link"]["malformed"] == 0


@pytest.mark.parametrize(
    ("kind", "variable", "remedy"),
    [
        ("force-dimension", "RIFFLER_LIBDHD", "install Force Dimension's SDK"),
        ("touch", "RIFFLER_LIBHD", "install 3D Systems' OpenHaptics"),
    ],
)
def test_the_error_of_a_missing_library_names_the_one_to_install(tmp_path, kind, variable, remedy):
    missing = {variable: str(tmp_path / "missing.so")}
    unavailable = json.loads(in_shell("pen", "list", "--json", cwd=tmp_path, **missing).stdout)["unavailable"]
    assert "not installed" in unavailable[kind] and "no such file" in unavailable[kind] and remedy in unavailable[kind]
    assert remedy in flat(in_shell("pen", "list", cwd=tmp_path, **missing).stdout)
    opened = in_shell("pen", "monitor", kind, "--seconds", "1", cwd=tmp_path, **missing)
    assert opened.returncode != 0 and variable in opened.stderr
