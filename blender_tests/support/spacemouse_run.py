"""Runs in a Blender of its own, where umockdev has connected a SpaceMouse that is pushed to the right, button 1 held
most of the time: it sculpts through the add-on, and reports the result. `command` is the command line for that."""

import os
import struct
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import bpy

from support import common, harness, report

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


def main():
    common.JOB, common.MODULE = harness.job, harness.install()
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
    report.say(removed=60 * 60 * 20 - common.content(ob).volume.volume)
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
