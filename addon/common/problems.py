"""The system's errors in our words: the file, the problem, the remedy."""

from __future__ import annotations

import errno
import os
from pathlib import Path

REMEDIES = {
    errno.EACCES: "it may not be read or written: choose another place, or change its permissions",
    errno.EPERM: "it may not be read or written: choose another place, or change its permissions",
    errno.EROFS: "the disk can only be read: choose another place",
    errno.ENOSPC: "the disk is full: make room, or choose another place",
    errno.ENOENT: "there is no such file or folder: choose another",
    errno.ENOTDIR: "there is no such folder: choose another",
    errno.EISDIR: "it is a folder: choose a file",
}


def said(error: BaseException) -> str:
    """One line for the user, never empty."""
    if isinstance(error, OSError) and error.filename and error.errno in REMEDIES:
        return f"{error.filename}: {REMEDIES[error.errno]}"
    if isinstance(error, MemoryError) and str(error) in ("", "std::bad_alloc"):
        return "there is not enough memory: take a coarser pitch, or close other programs"
    return str(error) or type(error).__name__


def capitalised(text: str, names=()) -> str:
    """A message with a capital first letter. `names` and names of files stay unchanged."""
    word = text.partition(" ")[0].rstrip(":")
    if not (word.isalpha() and word.islower()) or any(name and text.startswith(name) for name in names):
        return text
    return text[0].upper() + text[1:]


def check_target(path, suffix: str = "") -> None:
    """Call before writing a file: ValueError if it cannot be written. `suffix`: the required end of its name."""
    if not str(path):
        raise ValueError("no file was chosen: give one a name")
    path = Path(path)
    if path.is_dir():
        raise ValueError(f"{path} is a folder: give the file a name")
    if not path.parent.is_dir():
        raise ValueError(f"there is no folder {path.parent} for {path.name}: choose another")
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise ValueError(f"{path} may not be written: choose another folder")
    if suffix and path.suffix.lower() != suffix:
        raise ValueError(f"choose a name that ends with {suffix}, not {path.name}")


def check_source(path) -> None:
    """Call before reading a file: ValueError if it cannot be read."""
    if not str(path):
        raise ValueError("no file was chosen: choose one")
    path = Path(path)
    if not path.is_file():
        raise ValueError(f"there is no file {path}: choose another")
    if not os.access(path, os.R_OK):
        raise ValueError(f"{path} may not be read: choose another, or change its permissions")
