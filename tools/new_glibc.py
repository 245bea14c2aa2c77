"""Lets auditwheel name wheels that are built with a newer glibc than it has heard of.

auditwheel knows for each glibc which symbols a system with it has, up to the newest at its own release, and refuses a
wheel that needs more. An unstable release is ahead of that. What its libraries offer can be read from themselves, and a
tag manylinux_2_N says no more than that glibc 2.N is needed (PEP 600).
"""

from __future__ import annotations

import json
import re
from pathlib import Path

POLICIES = Path("policy", "manylinux-policy.json")
LIBRARIES = ("libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1")
VERSION = re.compile(rb"\0(GLIBCXX|GLIBC|CXXABI|GCC)_(\d+(?:\.\d+)+)(?=\0)")


def offered(libraries: Path) -> dict[str, set[str]]:
    """The versions of symbols that the system's own libraries in this folder define."""
    found: dict[str, set[str]] = {}
    for name in LIBRARIES:
        for kind, version in VERSION.findall((libraries / name).read_bytes()):
            found.setdefault(kind.decode(), set()).add(version.decode())
    return found


def minor_of(policy: dict) -> int:
    """41 of manylinux_2_41."""
    return int(policy["name"].rpartition("_")[2])


def teach(auditwheel: Path, libraries: Path, machine: str = "x86_64") -> str:
    """Adds a policy for the glibc of `libraries` to the package in the folder `auditwheel`, if it is newer than those
    that are there; returns the policy's name, or nothing."""
    path = auditwheel / POLICIES
    policies = json.loads(path.read_text())
    minor = max(int(v.split(".")[1]) for v in offered(libraries)["GLIBC"] if v.startswith("2."))
    newest = max((p for p in policies if p["name"].startswith("manylinux_2_")), key=minor_of)
    if minor_of(newest) >= minor:
        return ""
    versions = {kind: set(of) for kind, of in newest["symbol_versions"][machine].items()}
    for kind, of in offered(libraries).items():
        versions.setdefault(kind, set()).update(of)
    policy = newest | {
        "name": f"manylinux_2_{minor}",
        "priority": newest["priority"] - 1,  # the fewer systems, the lower
        "symbol_versions": {machine: {kind: sorted(of) for kind, of in versions.items()}},
    }
    path.write_text(json.dumps([*policies, policy]))
    return policy["name"]
