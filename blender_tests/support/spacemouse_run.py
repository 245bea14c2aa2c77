"""Runs in a Blender of its own, where umockdev has connected a SpaceMouse that is pushed to the right, button 1 held
most of the time: it sculpts through the add-on, or turns a plan's tool, and reports the result. `reported` starts
that."""

import json
import os
import shutil
import struct
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import bpy

from support import common, environments, harness, plans, report

# A multi-axis controller: report 1 has its six axes, of 16 bits each, and report 3 its buttons.
DESCRIPTOR = bytes.fromhex(
    "05010908a101a100850116a2fe265e01751009300931093209330934093595068106c0"
    "a102850305091901290215002501750195028102950e8103c0c0"
)
USB = "/devices/pci0000:00/usb1/1-1"
HID = f"{USB}/1-1:1.0/0003:256F:C631.0001"
DEVICE = f"""\
P: {HID}/hidraw/hidraw0
N: hidraw0
E: DEVNAME=/dev/hidraw0
E: MAJOR=240
E: MINOR=0
E: SUBSYSTEM=hidraw
L: device=../../../{HID.rpartition("/")[2]}
A: dev=240:0\\n

P: {HID}
E: SUBSYSTEM=hid
E: HID_ID=0003:0000256F:0000C631
E: HID_NAME=SpaceMouse Pro Wireless
E: HID_UNIQ=
H: report_descriptor={DESCRIPTOR.hex().upper()}

P: {HID.rpartition("/")[0]}
E: SUBSYSTEM=usb
E: DEVTYPE=usb_interface
A: bInterfaceNumber=00\\n

P: {USB}
E: SUBSYSTEM=usb
E: DEVTYPE=usb_device
A: idVendor=256f\\n
A: idProduct=c631\\n
A: product=SpaceMouse Pro Wireless\\n

"""
FULL = 350  # a puck's value at full deflection
PUSH = 175
START = (-8, 30, 19)  # of the tool: left of the stock, 1 mm below its top
PAUSE = 20  # ms between two reports
DOWN, UP = 80, 20  # reports with button 1 held, and without
LASTS = 60  # s, including Blender's start


def escaped(report):
    """In the form of umockdev's scripts: control characters and ^ after a ^."""
    return b"".join(
        bytes([0x5E, b ^ 0x40 if b != 0x5E else 0x60]) if b < 32 or b == 0x5E else bytes([b]) for b in report
    )


def says():
    """Its reports, as a script of umockdev."""
    for k in range(1000 * LASTS // PAUSE):
        held = k % (DOWN + UP) >= UP
        trembling = k % 2  # the last axis, within the dead zone
        yield b"r %d " % PAUSE + escaped(struct.pack("<BHB6h", 3, held, 1, PUSH, 0, 0, 0, 0, trembling)) + b"\n"


def command(folder):
    """Command that runs this file with this bpy, and with the puck; its description goes into `folder`."""
    size = struct.pack("<I", len(DESCRIPTOR)).hex().upper()
    descriptor = DESCRIPTOR.ljust(4096, b"\0").hex().upper()
    answers = f"@DEV /dev/hidraw0\nHIDIOCGRDESCSIZE 0 {size}\nHIDIOCGRDESC 0 {size}{descriptor}\n"
    (folder / "puck.device").write_text(DEVICE)
    (folder / "puck.ioctl").write_text(answers)
    (folder / "puck.script").write_bytes(b"".join(says()))
    plugged = f"-d {folder}/puck.device -i /dev/hidraw0={folder}/puck.ioctl -s /dev/hidraw0={folder}/puck.script"
    return ["umockdev-run", *plugged.split(), "--", sys.executable, __file__]


def reported(folder, work):
    """What the Blender reports after the work "sculpted" or "planned", in an empty folder. Counts as skipped where it
    cannot run."""
    if bpy.app.binary_path:
        raise common.Skip("an application's jemalloc and umockdev wait for each other; wheels have none")
    if shutil.which("umockdev-run") is None:
        raise common.Skip("umockdev is not installed (Debian: umockdev)")
    (folder / "scripts" / "addons").mkdir(parents=True)
    (folder / "job.json").write_text(json.dumps({**common.JOB, "recordings": str(folder), "work": work}))
    variables = {
        "RIFFLER_TEST_JOB": str(folder / "job.json"),
        "BLENDER_USER_RESOURCES": str(folder),
        "BLENDER_USER_SCRIPTS": str(folder / "scripts"),
    }
    done = environments.execute(command(folder), variables, 120)
    assert report.MARK in done.stdout, done.stdout[-2000:]
    return json.loads(done.stdout.partition(report.MARK)[2].partition("\n")[0])


def main():
    common.JOB, common.MODULE = harness.job, harness.install()
    report.say(**{"sculpted": sculpted, "planned": planned}[harness.job["work"]]())
    sys.stdout.flush()
    os._exit(0)


def planned():
    """Turns the tool of a plan from the middle of its path, for two presses of the button."""
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.riffler.plan.part = plans.part_object()
    bpy.context.scene.frame_set(73)
    begun = list(common.part("plan.plan_store").plan(ob).paths[0].keys)
    said = bpy.ops.riffler.plan_pen(device="spacemouse", seconds=4.0, scale=0.2)
    path = common.part("plan.plan_store").plan(ob).paths[0]
    keys = {k: (*path.centres[k], *axis) for k, axis in path.keys.items() if k not in begun}
    return {"said": list(said), "keys": {str(k): list(map(float, at)) for k, at in sorted(keys.items())}}


def sculpted():
    common.scale(1)
    ob = common.stock(size=(60, 60, 20), pitch=0.5, directions="xyz", origin="CORNER")
    bpy.context.scene.cursor.location = START
    bpy.ops.riffler.pen_sculpt(
        device="spacemouse",
        tool=common.BALL,
        start="CURSOR",
        scale=1.0,
        stiffness=5.0,
        removal_constant=1e-5,
        record=True,
        folder=harness.job["recordings"],
        seconds=5.0,
    )
    common.part("sculpt.live_registry").end_all()
    return {"removed": 60 * 60 * 20 - common.content(ob).volume.volume}


if __name__ == "__main__":
    main()
