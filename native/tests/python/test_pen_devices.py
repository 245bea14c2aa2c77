"""riffler pen and riffler doctor on machines without devices, and with devices of umockdev; recordings as devices."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import riffler
from commands import ENVIRONMENT, RIFFLER, riffle

virtual = pytest.mark.skipif(
    sys.platform != "linux" or shutil.which("umockdev-run") is None,
    reason="umockdev is not installed (Debian: umockdev)",
)
# A multi-axis controller, six axes of 16 bits in report 1.
PUCK = bytes.fromhex(
    "05010908a101a100850116a2fe265e01751009300931093209330934093595068106c0"
    "a1028503050919012902150025017501950281029 50e8103c0c0".replace(" ", "")
)
# "Raw HID" of a Teensy board.
BOARD = bytes.fromhex("06abff0a0002a101750815002 6ff00954009018102954009029102c0".replace(" ", ""))


def device(number: int, vendor: int, product: int, name: str, descriptor: bytes) -> str:
    """A device of umockdev: the hidraw node, its HID device, its interface, its USB device."""
    usb = f"/devices/pci0000:00/usb1/1-{number + 1}"
    hid = f"{usb}/1-{number + 1}:1.0/0003:{vendor:04X}:{product:04X}.000{number}"
    return (
        f"P: {hid}/hidraw/hidraw{number}\nN: hidraw{number}\nE: DEVNAME=/dev/hidraw{number}\nE: MAJOR=240\n"
        f"E: MINOR={number}\nE: SUBSYSTEM=hidraw\nL: device=../../../{hid.rpartition('/')[2]}\n"
        f"A: dev=240:{number}\\n\n\n"
        f"P: {hid}\nE: SUBSYSTEM=hid\nE: HID_ID=0003:0000{vendor:04X}:0000{product:04X}\nE: HID_NAME={name}\n"
        f"E: HID_UNIQ=\nH: report_descriptor={descriptor.hex().upper()}\n\n"
        f"P: {hid.rpartition('/')[0]}\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n\n"
        f"P: {usb}\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nA: idVendor={vendor:04x}\\n\n"
        f"A: idProduct={product:04x}\\n\nA: product={name}\\n\n\n"
    )


def answers(number: int, descriptor: bytes, features: tuple[bytes, ...] = ()) -> str:
    """Its ioctls."""
    size = struct.pack("<I", len(descriptor))
    lines = [f"@DEV /dev/hidraw{number}", f"HIDIOCGRDESCSIZE 0 {size.hex().upper()}"]
    lines += [f"HIDIOCGRDESC 0 {(size + descriptor.ljust(4096, bytes(1))).hex().upper()}"]
    lines += [f"HIDIOCGFEATURE {len(f)} {f.hex().upper()}" for f in features]
    return "\n".join(lines) + "\n"


def escaped(report: bytes) -> bytes:
    """As scripts of umockdev have them: control characters and ^ after a ^."""
    return b"".join(
        bytes([0x5E, b ^ 0x40 if b != 0x5E else 0x60]) if b < 32 or b == 0x5E else bytes([b]) for b in report
    )


@pytest.fixture
def plugged(tmp_path):
    """Runs a command of riffler where the devices are plugged in: (vendor, product, name, descriptor, *features).

    `says`: reports that the first one sends, one each 20 ms from the start of the process: enough for a computer on
    which Python takes seconds to start.
    """

    def run(*words: str, devices: list[tuple], says: tuple[bytes, ...] = ()) -> subprocess.CompletedProcess:
        command = ["umockdev-run"]
        for number, (vendor, product, name, descriptor, *features) in enumerate(devices):
            described, answered = tmp_path / f"{number}.umockdev", tmp_path / f"{number}.ioctl"
            described.write_text(device(number, vendor, product, name, descriptor))
            answered.write_text(answers(number, descriptor, tuple(features)))
            command += ["-d", str(described), "-i", f"/dev/hidraw{number}={answered}"]
        if says:
            script = tmp_path / "0.script"
            script.write_bytes(b"".join(b"r 20 " + escaped(report) + b"\n" for report in says))
            command += ["-s", f"/dev/hidraw0={script}"]
        command += ["--", *RIFFLER, *words]
        return subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=120, check=False)

    return run


def listed(done: subprocess.CompletedProcess) -> list[dict]:
    assert done.returncode == 0, done.stderr + done.stdout
    return json.loads(done.stdout)["devices"]


def test_kinds_are_listed_while_nothing_is_plugged_in(tmp_path):
    done = riffle("pen", "list", "--json", cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == ""
    assert set(json.loads(done.stdout)["kinds"]) == set(riffler.pen.kinds()) >= {"riffler-pen", "spacemouse", "polhem"}
    assert riffle("pen", cwd=tmp_path).returncode == 2
    assert riffle("pen", "lsit", cwd=tmp_path).returncode == 2


@virtual
def test_a_puck_is_listed_with_what_it_can_do(plugged):
    puck = (0x256F, 0xC631, "SpaceMouse Pro Wireless", PUCK)
    (found,) = listed(plugged("pen", "list", "--json", devices=[puck]))
    assert (found["path"], found["id"], found["kind"]) == ("/dev/hidraw0", "256f:c631", "spacemouse")
    assert found["problem"] is None and "senses" in found["capability"]
    table = plugged("pen", "list", devices=[puck]).stdout
    assert "/dev/hidraw0" in table and "sets speeds; no force" in table


@virtual
def test_one_of_several_pucks_is_chosen_by_number_or_name(plugged):
    """As at a Universal Receiver: one interface for each puck, another without its reports."""
    devices = [
        (0x256F, 0xC652, "Universal Receiver", PUCK),
        (0x256F, 0xC652, "Universal Receiver", PUCK[:6] + b"\xc0"),
        (0x256F, 0xC652, "Universal Receiver", PUCK),
        (0x256F, 0xC635, "SpaceMouse Compact", PUCK),
    ]
    found = listed(plugged("pen", "list", "--json", devices=devices))
    assert [(f["path"], f["choice"]) for f in found if f["choice"]] == [
        ("/dev/hidraw0", "spacemouse:1"), ("/dev/hidraw2", "spacemouse:2"), ("/dev/hidraw3", "spacemouse:3")
    ]  # fmt: skip
    assert '"spacemouse:2", Universal Receiver' in plugged("pen", "list", devices=devices).stdout

    def opened(which):
        return plugged("pen", "calibrate", which, "--yes", "--seconds", "0.3", "--json", devices=devices)

    for which in ("spacemouse", "spacemouse:2", "spacemouse:compact"):
        done = opened(which)
        assert done.returncode == 0 and json.loads(done.stdout)["device"] == "spacemouse", done.stderr

    def refused(which):
        done = opened(which)
        assert done.returncode != 0
        return str(json.loads(done.stdout))

    text = refused("spacemouse:receiver")
    assert "spacemouse:receiver is 2 devices; take the number, the serial number or a part of the name" in text
    assert '2: "Universal Receiver" at /dev/hidraw2' in text
    assert "spacemouse:7: there is no such device" in refused("spacemouse:7")
    (one,) = listed(plugged("pen", "list", "--json", devices=devices[3:]))
    assert one["choice"] is None


@virtual
def test_each_reason_is_reported(plugged):
    identity = (b"\x03RPen" + bytes([7, 0, 0, 1, 0]) + b"riffler".ljust(24, b"\0") + b"12".ljust(16, b"\0")).ljust(50)
    devices = [
        (0x1209, 0x0001, "Riffler pen", PUCK, identity[:50]),
        (0x256F, 0xC635, "SpaceMouse Compact", PUCK[:6] + b"\xc0"),
        (0x16C0, 0x0486, "Teensyduino RawHID", BOARD),
        (0x046D, 0xC31C, "Keyboard", b"\x05\x01\x09\x06\xa1\x01\xc0"),
        (0x1209, 0x0001, "Riffler pen", PUCK),
    ]
    version, descriptor, board, mute = listed(plugged("pen", "list", "--json", devices=devices))
    assert version["problem"] == "other protocol version" and "version 7.0" in version["text"]
    assert descriptor["problem"] == "wrong report descriptor" and "/dev/hidraw1: " in descriptor["text"]
    assert board["kind"] == "polhem" and not board["tried"] and board["problem"] is None
    assert mute["problem"] == "no answer"

    done = plugged("doctor", "--json", devices=devices)
    all_of_them = listed(done)
    assert len(all_of_them) == 5 and all_of_them[3]["kind"] is None and all_of_them[3]["problem"] is None
    table = plugged("doctor", devices=devices).stdout
    assert "/dev/hidraw3" in table and "Keyboard 046d:c31c: can be opened" in table


@virtual
def test_a_pucks_noise_is_measured_and_its_bubble_is_larger(plugged):
    puck = (0x256F, 0xC631, "SpaceMouse Pro Wireless", PUCK)
    noise = tuple(b"\x01" + struct.pack("<6h", 14 * (-1) ** k, 0, 0, 0, 0, 7) for k in range(1000))
    words = "pen", "calibrate", "--yes", "--seconds", "1", "--json"
    done = plugged(*words, devices=[puck], says=noise)
    assert done.returncode == 0, done.stderr
    data = json.loads(done.stdout)
    assert data["device"] == "spacemouse" and data["noise"] == {"moving": 0.04, "turning": 0.02}  # 14 and 7 of 350
    assert data["bubble"] == 0.07
    touched = plugged(
        *words, devices=[puck], says=tuple(b"\x01" + struct.pack("<6h", 300, k, 0, 0, 0, 0) for k in range(999))
    )
    assert touched.returncode == 1 and not json.loads(touched.stdout)["fits"]
    still = json.loads(plugged(*words, devices=[puck]).stdout)
    assert still["bubble"] == 0.01 and still["fits"]


@virtual
def test_a_puck_is_monitored_without_force(plugged):
    puck = (0x256F, 0xC631, "SpaceMouse Pro Wireless", PUCK)
    pushed = tuple(b"\x01" + struct.pack("<6h", 350, 0, 0, 0, 0, k % 2) for k in range(1000))
    done = plugged("pen", "monitor", "--seconds", "1.5", "--json", devices=[puck], says=pushed)
    assert done.returncode == 0, done.stderr
    data = json.loads(done.stdout)
    assert data["link"]["reports"] > 20 and data["pose"][0] > 10 and data["most"]["speed_mm_s"] == 60
    table = plugged("pen", "monitor", "--seconds", "1.5", devices=[puck]).stdout
    assert "connected" in table and "force" not in table


def test_missing_devices_do_not_open():
    with pytest.raises(riffler.pen.PenError, match=r"/dev/hidraw99: no such device"):
        riffler.pen.open("/dev/hidraw99")
    with pytest.raises(riffler.pen.PenError, match=r"/dev/null: not a HID device"):
        riffler.pen.open("/dev/null")
    with pytest.raises(ValueError, match="bubble"):
        riffler.pen.open("spacemouse", bubble=2)


def test_a_recording_opens_as_a_device(tmp_path):
    journal = riffler.Journal()
    journal.set_stock([0, 0, 0], [10, 10, 10], 1)
    journal.add_tool(1, riffler.Tool.ball(2, length=20))
    journal.add_stroke(1, [[0, 0, 5, 0, 0, 1], [9, 0, 5, 0, 0, 1]], times=[0.0, 1e-3])
    path = tmp_path / "a.rjournal"
    journal.save(path)
    with riffler.pen.open(path) as pen:
        assert pen.geometry is None
        assert pen.kind == "recording" and pen.limits["x"].senses == "position" and not pen.limits["x"].pushes
        assert pen.state().sequence == 1
        while pen.health().state != "stopped":
            pass
        state = pen.state()
        np.testing.assert_allclose(state.pose, [9, 0, 5, 0, 0, 1])
        assert state.buttons == 0 and state.age_s == pytest.approx(0, abs=0.1)
        answer = pen.push([0, 0, 1])
        assert answer.reason == "the device has no motors for all of it" and answer.missing_force[2] == 1
        assert pen.push([0, 0, 0]).reason is None
    with pytest.raises(ValueError, match="no option"):
        riffler.pen.open(path, bubble=0.1)
    journal.add_stroke(1, [[0, 0, 5, 0, 0, 1]])
    journal.save(path)
    with pytest.raises(ValueError, match="stroke 1 has no times"):
        riffler.pen.open(path)


def test_a_simulated_pen_opens_moves_and_follows_its_hand():
    def wait(what) -> bool:
        end = time.monotonic() + 20
        while not what() and time.monotonic() < end:
            time.sleep(0.01)
        return what()

    assert "simulated" in riffler.pen.kinds()
    with riffler.pen.open("simulated") as device:
        assert isinstance(device, riffler.pen.SimulatedPen)
        assert device.kind == "simulated"
        assert wait(lambda: device.state().homed)
        goal = device.state().pose.copy()
        goal[:3] += [6.0, 3.0, -4.0]
        device.aim(goal, buttons=1)
        assert wait(lambda: np.allclose(device.state().pose[:3], goal[:3], atol=0.5))
        assert device.state().buttons == 1
        with pytest.raises(ValueError, match="pose must be six numbers"):
            device.aim([1.0, 2.0, 3.0])
        with pytest.raises(ValueError, match="grip must be a number"):
            device.aim(goal, grip=-1)
        device.wander()
        assert wait(lambda: not np.allclose(device.state().pose[:3], goal[:3], atol=3))
    assert device.health().state == "stopped"


def test_a_pen_compensates_weight_and_friction_on_request():
    for option in ("gravity", "friction"):
        with pytest.raises(ValueError, match=f"{option} must be a number between 0"):
            riffler.pen.open("simulated", **{option: 1.5})
    with riffler.pen.open("simulated", gravity=1.0, friction=0.5) as device:
        end = time.monotonic() + 20
        while not device.state().homed and time.monotonic() < end:
            time.sleep(0.01)
        rest = device.state().pose.copy()
        device.aim(rest)
        end = time.monotonic() + 20
        while device.health().force_state != "active" and time.monotonic() < end:
            device.push([0.0, 0.0, 0.0])
            time.sleep(0.005)
        assert device.health().force_state == "active"


def test_a_pointer_becomes_poses():
    tablet = riffler.pen.Pointer("tablet")
    assert isinstance(tablet, riffler.pen.PenDevice)
    assert (tablet.kind, riffler.pen.Pointer(kind="mouse").kind, riffler.pen.Pointer().kind) == (
        "tablet",
        "mouse",
        "tablet",
    )
    assert tablet.limits["b"].senses == "position" and riffler.pen.Pointer("mouse").limits["b"].senses is None
    assert tablet.state().sequence == 0 and tablet.state().age_s == np.inf
    tablet.set_frame(origin=[10, 20, 30], right=[0, 1, 0], up=[0, 0, 1], scale=0.5, depth=4)
    assert tablet.give(6, -2, pressure=0.25, tilt_x=0.2, buttons=5, time=1.0)
    state = tablet.state()
    np.testing.assert_allclose(state.pose[:3], [10 - 1, 20 + 3, 30 - 1])
    np.testing.assert_allclose(state.pose[3:], [np.cos(0.2), np.sin(0.2), 0], atol=1e-15)
    assert (state.buttons, state.homed, state.age_s, state.sequence) == (5, True, 0, 1)
    assert tablet.give(8, -2, pressure=0.25, time=1.5)
    np.testing.assert_allclose(tablet.state().velocity, [0, 2, 0])
    for wrong in ({"time": 1.4}, {"time": np.nan}, {"time": 2, "pressure": np.inf}):
        assert not tablet.give(9, 9, **wrong)
    assert tablet.state().sequence == 2
    assert tablet.push([0, 0, 1]).reason == "the device has no motors for all of it"


def test_a_pointer_refuses_bad_input_and_stays_unchanged():
    with pytest.raises(ValueError, match="tablet, mouse"):
        riffler.pen.Pointer("finger")
    mouse = riffler.pen.Pointer("mouse")
    mouse.set_frame(origin=[1, 2, 3])
    for wrong, word in (
        ({"right": [2, 0, 0]}, "right"),
        ({"up": [1, 0, 0]}, "perpendicular"),
        ({"scale": 0}, "scale"),
        ({"depth": -1}, "depth"),
        ({"max_tilt": 2}, "max_tilt"),
        ({"origin": [np.nan, 0, 0]}, "origin"),
        ({"origin": [1, 2]}, "origin"),
    ):
        with pytest.raises(ValueError, match=word):
            mouse.set_frame(**wrong)
    assert mouse.give(0, 0, time=0)
    np.testing.assert_allclose(mouse.state().pose, [1, 2, 3, 0, 0, 1])


def test_a_pens_counts_are_those_of_its_geometry():
    with riffler.pen.open("simulated") as device:
        geometry = device.geometry
        assert geometry.name == "riffler"
        end = time.monotonic() + 20
        while not device.state().homed and time.monotonic() < end:
            time.sleep(0.01)
        for _ in range(20):
            state = device.state()
            assert state.counts.dtype == np.int32 and state.counts.shape == (6,)
            np.testing.assert_allclose(geometry.forward([state.counts])[0], state.pose, atol=1e-9)
            assert geometry.stretch([state.counts])[0] == pytest.approx(state.stretch, abs=1e-9)
            time.sleep(0.01)
        force, torque = state.applied
        assert force.shape == torque.shape == (3,) and state.powered
        device.lose(1, 100)  # R3
        while abs(device.state().stretch) < 1 and time.monotonic() < end:
            time.sleep(0.01)
        assert abs(device.state().stretch) > 1
        with pytest.raises(ValueError, match="channel must be 0 to 5, not 7"):
            device.lose(7, 1)


def test_an_unplugged_pen_is_named_and_connects_by_itself():
    unplugged = "the simulated pen is unplugged; plug it in again"
    with riffler.pen.open("simulated") as device:
        for pull, state, problem in ((device.unplug, "waiting", unplugged), (device.plug, "connected", None)):
            pull()
            end = time.monotonic() + 20
            while (device.health().state, device.health().problem) != (state, problem) and time.monotonic() < end:
                time.sleep(0.01)
            assert (device.health().state, device.health().problem) == (state, problem)


def test_a_makers_library_is_loaded_by_another_program(monkeypatch):
    """The C library stands for one of another version: the installed program loads it, and this process does not."""
    libc = next(line.split()[-1] for line in Path("/proc/self/maps").read_text().splitlines() if "/libc.so" in line)
    for variable, kind, function in (
        ("RIFFLER_LIBDHD", "force-dimension", "dhdGetDeviceCount"),
        ("RIFFLER_LIBHD", "touch", "hdInitDevice"),
    ):
        monkeypatch.setenv(variable, libc)
        with pytest.raises(riffler.pen.PenError, match=f"it has no function {function}; is it of another version?"):
            riffler.pen.open(kind)


@pytest.mark.skipif(sys.platform != "linux", reason="the program is started on Linux only")
def test_the_program_for_makers_libraries_is_for_riffler_alone():
    program = Path(riffler._core.__file__).with_name("riffler-arm")
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2 and "riffler pen list" in done.stderr
