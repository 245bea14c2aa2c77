"""Why the native core does not load, and the remedy, in words for the user."""

from __future__ import annotations

import os
import platform
import sys
from dataclasses import dataclass, field
from pathlib import Path

# Commands that install numpy for a distribution's Python, by the names in its /etc/os-release.
NUMPY = {
    "debian": "sudo apt install python3-numpy",
    "fedora": "sudo dnf install python3-numpy",
    "arch": "sudo pacman -S python-numpy",
    "suse": "sudo zypper install python3-numpy",
}


@dataclass
class Machine:
    """The facts that decide whether a binary wheel fits."""

    system: str  # "Linux", "Windows", "Darwin"
    release: str
    processor: str
    python: str
    blender: str
    system_python: bool = False  # Blender uses the system's Python, as in distributions
    distribution: list[str] = field(default_factory=list)  # its name, and those of the distributions it derives from

    @classmethod
    def current(cls, blender: str) -> Machine:
        system = platform.system(), platform.release(), platform.machine(), platform.python_version()
        return cls(*system, blender, sys.prefix in ("/usr", "/usr/local"), distribution())


def distribution() -> list[str]:
    try:
        found = platform.freedesktop_os_release()
    except OSError:
        return []
    return [found.get("ID", ""), *found.get("ID_LIKE", "").split()]


def built_for(folder: Path) -> list[str]:
    """The Python versions that a package folder's extension modules were built for, from their names."""
    return sorted(p.name for p in folder.glob("_core*") if p.suffix in (".so", ".pyd"))


def mend(error: BaseException, machine: Machine, found: list[str]) -> list[str]:
    """Remedies that fit the error, the most likely one first."""
    text = f"{type(error).__name__}: {error}"
    tag = "cp" + "".join(machine.python.split(".")[:2])
    steps = []
    if "is in use, this add-on is" in text:
        steps.append("Restart Blender: it still uses the core from before the update.")
        steps.append("If that does not help, another riffler comes first on Python's path: remove it.")
    elif "GLIBC" in text or "CXXABI" in text or "GLIBCXX" in text:
        steps.append("The system's C library is older than the package needs: update the system, or build from source.")
    elif "numpy" in text:
        return _with_numpy(machine)
    elif found and not any(tag in name or f"{machine.python[:4].replace('.', '')}-" in name for name in found):
        steps.append(
            f"The package was built for another Python ({', '.join(found)}); this Blender has {machine.python}."
        )
        steps.append("Install the Riffler zip made for this Blender version.")
    elif "lacks" in text:
        steps.append("Another package named riffler, or an older one, comes first on Python's path: remove it.")
    elif isinstance(error, ModuleNotFoundError):
        steps.append("The package is not there: install Riffler from its zip (the source folder has no native core).")
    elif machine.system == "Darwin":
        steps.append("macOS may have quarantined the file: allow it under System Settings, Privacy & Security.")
    elif machine.system == "Windows":
        steps.append("An older copy may still be in use, or a virus scanner holds the file: restart Blender.")
    if machine.processor.lower() not in ("x86_64", "amd64"):
        steps.append(f"Packages are made for x86-64; this machine is {machine.processor}: build from source.")
    steps.append("Remove Riffler in Preferences, restart Blender, and install the zip again.")
    return steps


def _with_numpy(machine: Machine) -> list[str]:
    """Steps to install numpy alone."""
    if not machine.system_python:
        return ["numpy is missing or too old in this Python: install Blender from blender.org, which includes it."]
    install = next((NUMPY[name] for name in machine.distribution if name in NUMPY), "install its package of numpy")
    return [
        f"numpy is missing or too old in the system's Python, which this Blender uses: {install}",
        "Then restart Blender.",
    ]


def report(error: BaseException, machine: Machine, folders: list[str] | None = None) -> dict:
    """`why` (one line), `facts` and `steps` (lists of lines), `text` (all of it, for the clipboard)."""
    searched = sys.path if folders is None else folders
    found = [name for f in searched if f for name in built_for(Path(f) / "riffler")]
    why = f"{type(error).__name__}: {error}"
    facts = [
        f"System: {machine.system} {machine.release}, {machine.processor}",
        f"Blender: {machine.blender}",
        f"Python: {machine.python}",
        f"Native module found: {', '.join(found) if found else 'none'}",
    ]
    steps = mend(error, machine, found)
    text = "\n".join(["Riffler: the native core did not load", why, *facts, "How to fix it:", *steps])
    return {"why": why, "facts": facts, "steps": steps, "text": text}


def folder(path: Path) -> str:
    """The folder's path, with a note if it does not exist or cannot be written to. Writes nothing."""
    there = next(p for p in (path, *path.parents) if p.is_dir())
    if not os.access(there, os.W_OK):
        return f"{path}, which may not be written"
    return str(path) if there == path else f"{path}, created on demand"


def table(title: str, rows: list[tuple[str, str]]) -> str:
    """A titled table of two columns, names and values."""
    width = max(len(name) for name, _ in rows)
    return "\n".join([title, *(f"{name:{width}}  {text}" for name, text in rows)]) + "\n"


def wrap(text: str, width: int = 44) -> list[str]:
    """Lines for a panel, which does not wrap; long words (paths) are broken."""
    lines, line = [], ""
    for word in text.split():
        while len(word) > width:
            room = width - len(line) - (1 if line else 0)
            if room < 8:
                lines.append(line)
                line, room = "", width
            line = f"{line} {word[:room]}".strip()
            word = word[room:]
        if line and len(line) + 1 + len(word) > width:
            lines.append(line)
            line = word
        else:
            line = f"{line} {word}".strip()
    return [*lines, line] if line else lines
