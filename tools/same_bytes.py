"""Whether two builds of riffler compute the same bytes: a compiler, a C++ library or a processor must change no result.

    python tools/same_bytes.py WHEEL        compares the wheel with the riffler that is installed in .venv

Each build runs in a process of its own: journals of native/tests/scenes replayed, their meshes, a mesh with fewer
triangles, a volume made from it, and forces of a stroke. A line for each result that differs, and exit code 1.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from shell import PYTHON, ROOT, StepError, main

SCENES = ROOT / "native" / "tests" / "scenes"
# Printed by the riffler that this Python finds: a digest of each result by its name, and where that riffler lies.
PROGRAM = """
import hashlib, json, sys
from pathlib import Path
import numpy as np
import riffler

def digest(*parts):
    parts = (part if isinstance(part, bytes) else np.ascontiguousarray(part).tobytes() for part in parts)
    return hashlib.sha256(b"".join(parts)).hexdigest()

found = {}
for path in sorted(Path(sys.argv[1]).glob("*.rjournal")):
    volume = riffler.Journal.load(path).replay(path.parent)
    found[path.stem] = digest(volume.to_bytes())
    if volume.directions == "xyz":
        mesh = volume.to_mesh()
        found[path.stem + ", meshed"] = digest(mesh.vertices, mesh.triangles)
        coarse = volume.to_mesh(tolerance=0.02).decimate(tolerance=0.02)
        found[path.stem + ", decimated"] = digest(coarse.vertices, coarse.triangles)
block = riffler.Volume.block((0, 0, 0), (60, 40, 20), 0.5, "xyz")
angle = np.linspace(0, 9, 200)
tips = np.c_[30 + 2 * angle * np.cos(angle), 20 + angle * np.sin(angle), 15 - angle / 3]
axes = np.c_[0.3 * np.sin(angle), 0.2 * np.cos(3 * angle), np.ones_like(angle)]
poses = np.hstack([tips, axes / np.linalg.norm(axes, axis=1, keepdims=True)])
result = block.carve(riffler.Tool.ball(6, 40), poses, dt=0.01)
found["stroke"] = digest(block.to_bytes(), result.removed, result.force, result.torque)
part = block.to_mesh()
again = riffler.Volume.from_mesh(part, pitch=0.7, directions="xyz")
found["from a mesh"] = digest(again.to_bytes())
print(json.dumps({"riffler": riffler.__file__, "found": found}))
"""


def results(folder: Path | None) -> dict[str, str]:
    """The digests of the riffler in this folder, or of that in .venv."""
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | {"PYTHONNOUSERSITE": "1"}
    if folder is not None:
        environment["PYTHONPATH"] = str(folder)
    command = [PYTHON, "-W", "ignore", "-c", PROGRAM, SCENES]
    done = subprocess.run(command, env=environment, cwd="/", capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise StepError(f"riffler of {folder or '.venv'} fails:\n{done.stderr}")
    answer = json.loads(done.stdout)
    if folder is not None and not Path(answer["riffler"]).is_relative_to(folder.resolve()):
        raise StepError(f"{answer['riffler']} was used, not that in {folder}")
    return answer["found"]


def differences(ours: dict[str, str], others: dict[str, str]) -> list[str]:
    """The names of results that are not the same in both, or in one of them alone."""
    return sorted(name for name in ours.keys() | others.keys() if ours.get(name) != others.get(name))


def compare(wheel: Path) -> int:
    """How many results agree; StepError with the names of those that do not."""
    with tempfile.TemporaryDirectory() as folder:
        zipfile.ZipFile(wheel).extractall(folder)
        theirs = results(Path(folder))
    if wrong := differences(results(None), theirs):
        raise StepError(f"{wheel.name} computes other bytes than the riffler in .venv: {', '.join(wrong)}")
    return len(theirs)


def entry() -> None:
    if len(sys.argv) != 2:
        raise StepError("usage: same_bytes.py WHEEL")
    print(f"{compare(Path(sys.argv[1]))} results agree to the byte")


if __name__ == "__main__":
    main(entry)
