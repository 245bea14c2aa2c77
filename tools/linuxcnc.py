"""LinuxCNC's own interpreter, rs274, from Debian's package: unpacked into ./.envs/linuxcnc, not installed, since that
would pull in a desktop. It judges the NC code that the tests write."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from shell import ROOT, is_stamped, say, write_stamp

FOLDER = ROOT / ".envs" / "linuxcnc"
PACKAGES = ["linuxcnc-uspace", "libboost-python1.74.0"]
STAMP = FOLDER / ".riffler-packages"


def linuxcnc() -> None:
    """Makes it, or says why the tests that need it will be left out."""
    key = " ".join(PACKAGES)
    if is_stamped(STAMP, key):
        return
    if not (shutil.which("apt-get") and shutil.which("dpkg")):
        say("no apt-get here: the tests leave LinuxCNC's interpreter out")
        return
    say(f".envs/linuxcnc: {', '.join(PACKAGES)}")
    shutil.rmtree(FOLDER, ignore_errors=True)
    with tempfile.TemporaryDirectory() as folder:
        # apt's own user may have to write there.
        Path(folder).chmod(0o777)
        for repair in (None, ["apt-get", "update", "-q"]):
            if repair and os.geteuid() == 0:
                subprocess.run(repair, check=False)
            if subprocess.run(["apt-get", "download", "-q", *PACKAGES], cwd=folder, check=False).returncode == 0:
                break
        else:
            say("apt-get has no linuxcnc-uspace here: the tests leave LinuxCNC's interpreter out")
            return
        for package in sorted(Path(folder).glob("*.deb")):
            subprocess.run(["dpkg", "-x", package, FOLDER], check=True)
    write_stamp(STAMP, key)
