"""What goes out, in ./dist: the wheel with the shared libraries it needs inside, and the Blender extension and the
legacy add-on made from it."""

from __future__ import annotations

import subprocess
import tempfile
import zipfile
from pathlib import Path

from shell import PYTHON, ROOT, StepError, main, run, say
from wheel import build_wheel

DIST = ROOT / "dist"
# Every Linux has these; anything else that the module links must lie inside the wheel.
SYSTEM_LIBRARIES = ("linux-vdso.so", "libstdc++.so", "libgcc_s.so", "libc.so", "libm.so", "libz.so", "/lib64/ld-linux",
                    "libpthread.so", "libdl.so", "librt.so")  # fmt: skip


def repaired_wheel(wheel: Path) -> Path:
    """The wheel as auditwheel leaves it: libraries that a system may lack are inside and found there."""
    with tempfile.TemporaryDirectory(dir=wheel.parent) as folder:
        run(PYTHON, "-m", "auditwheel", "repair", "--wheel-dir", folder, wheel)
        repaired = next(Path(folder).glob("riffler-*.whl"))
        check_self_contained(repaired)
        for old in DIST.glob("riffler-*.whl"):
            old.unlink()
        return repaired.rename(DIST / repaired.name)


def check_self_contained(wheel: Path) -> None:
    """StepError if a module in the wheel takes a library from outside that a system may lack."""
    with tempfile.TemporaryDirectory() as folder:
        zipfile.ZipFile(wheel).extractall(folder)
        for module in Path(folder).rglob("*.so*"):
            listing = subprocess.run(["ldd", module], capture_output=True, text=True, check=True).stdout
            for line in listing.splitlines():
                name, _, found = (part.strip() for part in line.partition("=>"))
                if not (name.startswith(SYSTEM_LIBRARIES) or found.startswith(str(Path(folder).resolve()))):
                    raise StepError(f"{wheel.name}: {module.name} needs {name}, which is not inside ({found})")


def entry() -> None:
    DIST.mkdir(exist_ok=True)
    wheel = repaired_wheel(build_wheel()[0])
    run(PYTHON, "addon/package.py", "--wheel", wheel, "--out", DIST)
    say("packages")
    for path in sorted(DIST.iterdir()):
        print(f"{path.stat().st_size:>12,} bytes  dist/{path.name}")


if __name__ == "__main__":
    main(entry)
