"""Runs the scripts of examples/ in an empty folder and keeps their pictures in docs/images/examples, as WebP files that
examples/README.md shows. native/tests/python/test_examples.py checks what the scripts print.

    tools/examples.py [NAME ...]
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from shell import PYTHON, ROOT, StepError, main, tool_environment

SCRIPTS = ROOT / "examples"
PICTURES = ROOT / "docs" / "images" / "examples"
HELPERS = ("picture",)
MOST = 60_000  # bytes of a picture
TO_WEBP = "import sys; from PIL import Image; Image.open(sys.argv[1]).convert('RGB').save(sys.argv[2], quality=82)"


def entry() -> None:
    names = sys.argv[1:] or sorted(p.stem for p in SCRIPTS.glob("*.py") if p.stem not in HELPERS)
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            run = {"cwd": folder, "env": tool_environment(), "check": True}
            subprocess.run([PYTHON, SCRIPTS / f"{name}.py"], **run)
            picture = PICTURES / f"{name}.webp"
            subprocess.run([PYTHON, "-c", TO_WEBP, Path(folder, f"{name}.png"), picture], **run)
        if (size := picture.stat().st_size) > MOST:
            raise StepError(f"{picture.name} has {size} bytes, {MOST} at most")
        print(f"examples: {picture.relative_to(ROOT)}, {size} bytes", flush=True)


if __name__ == "__main__":
    main(entry)
