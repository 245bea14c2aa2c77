"""What goes out, in ./dist: the wheels with the shared libraries they need inside, and the Blender extension and the
legacy add-on made from them.

One wheel is of this Python; others lie in build/wheels, where `make test-blenders` puts those of newer Blenders.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import wheel
from shell import PYTHON, ROOT, digest, is_stamped, main, run, say

DIST = ROOT / "dist"
OTHERS = ROOT / "build" / "wheels"
STAMP = ".stamp"


def key() -> str:
    """What a wheel in build/wheels must be stamped with to be of the present sources."""
    return digest(wheel.sources())


def other_wheels() -> list[Path]:
    """Those of other Pythons, of the present sources; older ones are named and left out."""
    found = []
    for path in sorted(OTHERS.glob("*/riffler-*.whl")):
        if is_stamped(path.parent / STAMP, key()):
            found.append(path)
        else:
            say(f"{path.relative_to(ROOT)} is of other sources, left out: `make test-blenders` rebuilds it")
    return found


def package() -> list[Path]:
    """Everything in ./dist, and nothing else of ours."""
    others = other_wheels()
    wheels = [wheel.repaired_wheel(wheel.build_wheel()[0], DIST)]
    wheels += [Path(shutil.copy(other, DIST)) for other in others if other.name != wheels[0].name]
    run(PYTHON, "addon/package.py", *(word for w in wheels for word in ("--wheel", w)), "--out", DIST)
    return sorted(path for path in DIST.iterdir() if path.is_file())


def of_this_python(path: Path) -> bool:
    return f"-cp{sys.version_info.major}{sys.version_info.minor}-" in path.name


def entry() -> None:
    made = package()
    say("packages")
    for path in made:
        print(f"{path.stat().st_size:>12,} bytes  dist/{path.name}")


if __name__ == "__main__":
    main(entry)
