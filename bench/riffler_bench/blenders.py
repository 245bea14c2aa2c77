"""The Blenders that --blender names, and what a function of ``inside`` gives in one of them."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import riffler

from .measure import Settings
from .report import checkout
from .rivals import LeftOutError, spoken

HOST = Path(__file__).parent / "inside" / "host.py"
WIDTH, HEIGHT = 1400, 950  # of the window


@dataclass(frozen=True)
class Blender:
    """A Python with bpy, or a blender, which has a window too."""

    path: Path
    application: bool

    @property
    def name(self) -> str:
        """Before anything has answered: that of the environment, or of the program."""
        return self.path.name if self.application else self.path.parent.parent.name

    @staticmethod
    def of(path: Path) -> Blender:
        """LeftOutError where nothing answers."""
        try:
            done = subprocess.run([path, "--version"], capture_output=True, text=True, timeout=60, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise LeftOutError(f"{path}: {error}") from None
        return Blender(path, bool(re.search(r"^Blender \d", done.stdout, re.MULTILINE)))

    def run(self, function: str, *, window: bool = False, seconds: float = 900, **arguments: Any) -> dict[str, Any]:
        """What "SCRIPT.FUNCTION" of ``inside`` returns in a process of its own with the add-on of this checkout.
        LeftOutError, with the error's last line, where it fails."""
        addon = folder()
        with tempfile.TemporaryDirectory() as own:
            (Path(own) / "scripts" / "addons").mkdir(parents=True)
            environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
            environment |= {"BLENDER_USER_RESOURCES": own, "BLENDER_USER_SCRIPTS": str(Path(own) / "scripts")}
            # A system's Blender takes the first Python on the PATH for its own; not that of an environment.
            environment["PATH"] = os.pathsep.join([os.defpath, os.environ.get("PATH", "")])
            lend(Path(own) / "lent")
            given = {"paths": [str(Path(own) / "lent")], "addon": str(addon)}
            words = [HOST, "--", function, json.dumps(given | arguments)]
            return spoken([*self._before(window), *words], environment, seconds)

    def _before(self, window: bool) -> list[Any]:
        if not self.application:
            return [self.path]
        if not window:
            return [self.path, "--background", "--factory-startup", "--python"]
        size = ["-p", "0", "0", str(WIDTH), str(HEIGHT)]
        command = [self.path, "--factory-startup", "--enable-event-simulate", *size, "--python"]
        if os.environ.get("DISPLAY"):
            return command
        if shutil.which("xvfb-run") is None:
            raise LeftOutError("there is no display, and no xvfb-run to make one")
        return ["xvfb-run", "-a", "-s", f"-screen 0 {WIDTH}x{HEIGHT}x24", *command]


def found(settings: Settings) -> list[Blender]:
    """In the order that they were named in. LeftOutError where there is none."""
    if not settings.blenders:
        raise LeftOutError("none was named (--blender)")
    return [Blender.of(path) for path in settings.blenders]


def folder() -> Path:
    """The add-on of the checkout that holds this package or the working directory."""
    if (found := checkout()) is None:
        raise LeftOutError("found no add-on next to this package or in the working directory: measure in a checkout")
    return found / "addon"


def lend(place: Path) -> None:
    """riffler alone, without what else is installed where it lies: Blender has its own numpy."""
    package = Path(riffler.__file__).resolve().parent
    place.mkdir()
    for part in (package, package.with_name("riffler.libs")):
        if part.exists():
            (place / part.name).symlink_to(part, target_is_directory=True)
