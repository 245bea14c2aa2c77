"""Checks that the machine has the system packages that Riffler needs. Installs them with apt if allowed, else names
them."""

from __future__ import annotations

import ctypes
import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from shell import StepError, say


@dataclass(frozen=True)
class Need:
    """A system package: its name on Debian, its home page for other systems, and a test whether it is installed."""

    what: str
    package: str
    where: str
    found: Callable[[], bool]
    without: str = ""  # what is lost without it; empty where nothing works without it


@cache
def compiler() -> str | None:
    """The C++ compiler that CMake will choose."""
    wanted = os.environ.get("CXX")
    return next((c for c in ([wanted] if wanted else ["c++", "g++", "clang++"]) if shutil.which(c)), None)


def preprocesses(text: str) -> bool:
    """Whether the compiler preprocesses `text` as C++20 without an error."""
    if compiler() is None:
        return False
    command = [compiler(), "-std=c++20", "-x", "c++", "-E", "-o", os.devnull, "-"]
    return subprocess.run(command, input=text, text=True, capture_output=True, check=False).returncode == 0


def header(name: str) -> Callable[[], bool]:
    return lambda: preprocesses(f"#if !__has_include(<{name}>)\n#error missing\n#endif\n")


def program(name: str) -> Callable[[], bool]:
    return lambda: shutil.which(name) is not None


def described(name: str) -> Callable[[], bool]:
    """A test whether pkg-config knows the package."""
    command = ["pkg-config", "--exists", name]
    return lambda: shutil.which("pkg-config") is not None and subprocess.run(command, check=False).returncode == 0


def library(name: str) -> Callable[[], bool]:
    def found() -> bool:
        try:
            ctypes.CDLL(name)
        except OSError:
            return False
        return True

    return found


def python_header() -> bool:
    return Path(sysconfig.get_path("include"), "Python.h").is_file()


def python_environments() -> bool:
    """venv needs ensurepip, or a pip of this interpreter that can install into another one (22.3 and later)."""
    if importlib.util.find_spec("ensurepip") is not None:
        return True
    pip = [sys.executable, "-m", "pip", "--python", sys.executable, "--version"]
    return subprocess.run(pip, capture_output=True, check=False).returncode == 0


def numpy_for_packaged_blender() -> bool:
    """Whether a distribution's Blender finds numpy. It runs the distribution's Python and does not depend on numpy;
    other Blenders include their own."""
    if shutil.which("blender") not in {None, "/usr/bin/blender"}:
        return True
    command = ["/usr/bin/python3", "-c", "import numpy"]
    return subprocess.run(command, env={}, capture_output=True, check=False).returncode == 0


BUILD = [
    Need("a C++20 compiler", "g++", "GCC 12 or Clang 16, or later", lambda: preprocesses("#include <span>\n")),
    Need("pkg-config", "pkg-config", "https://www.freedesktop.org/wiki/Software/pkg-config/", program("pkg-config")),
    Need("GLM headers", "libglm-dev", "https://github.com/g-truc/glm", header("glm/glm.hpp")),
    Need("Highway", "libhwy-dev", "https://github.com/google/highway", header("hwy/highway.h")),
    Need("OpenMesh", "libopenmesh-dev", "https://www.graphics.rwth-aachen.de/software/openmesh/",
         header("OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh")),
    Need("hidapi (hidraw)", "libhidapi-dev", "https://github.com/libusb/hidapi", header("hidapi/hidapi.h")),
    Need("toml++", "libtomlplusplus-dev", "https://marzer.github.io/tomlplusplus", header("toml++/toml.h")),
    Need("zlib headers", "zlib1g-dev", "https://zlib.net", header("zlib.h")),
    Need("Python.h of this Python", "python3-dev", "your Python's development package", python_header),
    Need("ensurepip or pip 22.3", "python3-venv", "https://pip.pypa.io", python_environments),
    Need("ccache", "ccache", "https://ccache.dev", program("ccache"), "every checkout compiles everything itself"),
]  # fmt: skip

# Libraries that the bpy wheels link but do not include (ldd lists them). Every desktop has them.
BLENDER_MODULE = [
    Need(f"shared library {name}", package, "your desktop's X11 and OpenGL packages", library(name))
    for name, package in {
        "libX11.so.6": "libx11-6", "libXrender.so.1": "libxrender1", "libXxf86vm.so.1": "libxxf86vm1",
        "libXfixes.so.3": "libxfixes3", "libXi.so.6": "libxi6", "libXext.so.6": "libxext6", "libXt.so.6": "libxt6",
        "libSM.so.6": "libsm6", "libICE.so.6": "libice6", "libxkbcommon.so.0": "libxkbcommon0", "libGL.so.1": "libgl1",
        "libgomp.so.1": "libgomp1",
    }.items()
]  # fmt: skip

# Only pkg-config finds umockdev's headers: they are in a folder of their own.
UMOCKDEV = Need("umockdev", "umockdev", "https://github.com/martinpitt/umockdev", program("umockdev-wrapper"))
CPP_TESTS = [
    Need("GoogleTest", "libgtest-dev", "https://github.com/google/googletest", header("gtest/gtest.h")),
    Need("pkg-config of umockdev", "libumockdev-dev", UMOCKDEV.where, described("umockdev-1.0")),
    UMOCKDEV,
]  # fmt: skip

BLENDER_WINDOW = [
    Need("Blender with a window", "blender", "https://www.blender.org/download/", program("blender")),
    Need("numpy for that Blender", "python3-numpy", "https://numpy.org", numpy_for_packaged_blender),
    Need("a virtual display: xvfb-run", "xvfb", "your X server's packages", program("xvfb-run")),
    Need("xauth", "xauth", "your X server's packages", program("xauth")),
    Need("OpenGL in software", "libgl1-mesa-dri", "https://mesa3d.org", library("libGLX_mesa.so.0")),
    Need("EGL", "libegl1", "https://mesa3d.org", library("libEGL.so.1")),
    Need("ImageMagick's import", "imagemagick", "https://imagemagick.org", program("import")),
    Need("xdotool", "xdotool", "https://github.com/jordansissel/xdotool", program("xdotool")),
]
CHROOTS = [Need("debootstrap", "debootstrap", "https://wiki.debian.org/Debootstrap", program("debootstrap"))]

# Libraries that LinuxCNC's interpreter links and tools/linuxcnc.py does not unpack with it.
LINUXCNC = [
    Need("shared library of Python 3.11", "libpython3.11", "your Python's packages", library("libpython3.11.so.1.0")),
    Need("libedit", "libedit2", "https://thrysoee.dk/editline", library("libedit.so.2")),
    Need("libtirpc", "libtirpc3", "https://sourceforge.net/projects/libtirpc", library("libtirpc.so.3")),
]

BENCH = [
    Need("Google Benchmark", "libbenchmark-dev", "https://github.com/google/benchmark", header("benchmark/benchmark.h"))
]


def require(needs: list[Need]) -> None:
    """Ensures that all packages are installed. As root on Debian and its derivatives, apt installs them; otherwise
    raises StepError with the exact list. Names missing optional packages and what is lost without them."""
    missing = [need for need in needs if not need.found()]
    if not missing:
        return
    packages = sorted({need.package for need in missing})
    if os.geteuid() == 0 and shutil.which("apt-get"):
        apt_install(packages)
        compiler.cache_clear()
        missing = [need for need in missing if not need.found()]
    for need in missing:
        if need.without:
            say(f"there is no {need.what} (Debian: {need.package}, elsewhere: {need.where}): {need.without}")
    missing = [need for need in missing if not need.without]
    if not missing:
        return
    packages = sorted({need.package for need in missing})
    lines = [f"  {need.what:<34} Debian: {need.package:<18} elsewhere: {need.where}" for need in missing]
    hint = f"\nOn Debian or Ubuntu, as root:\n  apt-get install --no-install-recommends {' '.join(packages)}"
    raise StepError("this machine lacks\n" + "\n".join(lines) + hint)


def apt_install(packages: list[str]) -> None:
    """Installs; where that fails, repairs an interrupted dpkg, refreshes the lists and tries twice more."""
    say(f"apt-get install {' '.join(packages)}")
    env = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
    options = ["-q", "-y", "--no-install-recommends", "-oDpkg::Use-Pty=0", "-oAcquire::Retries=3"]
    options += ["-oDPkg::Lock::Timeout=600"]
    install = ["apt-get", "install", *options, *packages]
    for repair in [[], ["apt-get", "update", "-q"], ["apt-get", "install", "-f", *options]]:
        if repair:
            subprocess.run(["dpkg", "--configure", "-a"], env=env, check=False)
            subprocess.run(repair, env=env, check=False)
        if subprocess.run(install, env=env, check=False).returncode == 0:
            return
    say("apt-get did not install everything")
