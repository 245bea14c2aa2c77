"""What a wheel is made of is all that its build reads."""

import re
import shutil
import subprocess
import tomllib

import pytest

import wheel
from shell import PYTHON, ROOT, VENV, tool_environment


@pytest.mark.parametrize("distribution", [wheel.RIFFLER, wheel.BENCH], ids=lambda it: it.name)
def test_the_sources_of_the_wheel_configure_on_their_own(distribution, tmp_path):
    copy = tmp_path / "copy"
    for path in wheel.sources(distribution):
        target = copy / path.relative_to(ROOT)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, target)
    what = ["-DRIFFLER_PYTHON=OFF", f"-DRIFFLER_BENCH_PYTHON={'ON' if distribution == wheel.BENCH else 'OFF'}"]
    command = [VENV / "bin" / "cmake", "-S", copy, "-B", tmp_path / "build", *what, f"-DPython_EXECUTABLE={PYTHON}"]
    done = subprocess.run(command, capture_output=True, text=True, env=tool_environment(), check=False)
    assert done.returncode == 0, done.stderr


def test_both_distributions_have_the_version_of_the_build():
    """riffler-bench reads the objects of the riffler of its version (riffler_bench/__init__.py)."""
    build = re.search(r"project\(riffler VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    for distribution in (wheel.RIFFLER, wheel.BENCH):
        project = tomllib.loads((distribution.project / "pyproject.toml").read_text())["project"]
        assert project["version"] == build
    assert project["dependencies"] == [f"riffler=={build}"]
