"""Zig's C++ compiler (Clang, LLD and libc++ in one package of PyPI), for targets that this machine's compiler does not
have: a Linux with an older glibc.

It has the headers of each target's C library inside and reads none of this machine's. What it compiles is kept in the
compiler cache; the C++ library that it makes for a target is kept in the user's cache folder.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import compiler_cache
from environments import make_environment
from shell import ROOT, run, tool_environment

HOME = ROOT / ".envs" / "zig"
MATH = ROOT / "cmake" / "zig" / "math.c"
REQUIREMENTS = ROOT / "requirements" / "zig.txt"
PROGRAMS = {"cc": "cc", "c++": "c++", "ar": "ar", "ranlib": "ranlib"}

# All that a Python module shows. libc++ would show its operators new and delete, which another C++ library in the
# process may call, or which may be replaced by those of another.
EXPORTS = "{ global: PyInit_*; local: *; };\n"


LINUX_LINKING = """set(CMAKE_MODULE_LINKER_FLAGS_RELEASE_INIT "-s -Wl,--version-script=FOLDER/exports.map")
set(CMAKE_C_STANDARD_LIBRARIES FOLDER/math.o)
set(CMAKE_CXX_STANDARD_LIBRARIES FOLDER/math.o)"""
WINDOWS_LINKING = """set(CMAKE_MODULE_LINKER_FLAGS_RELEASE_INIT "-s")"""


@dataclass(frozen=True)
class Target:
    """`triple`: as Zig names it, with the C library's version. `system`, `processor`: as CMake names them. `flags`: for
    every source."""

    name: str
    triple: str
    system: str
    processor: str
    flags: tuple[str, ...] = ()

    @property
    def folder(self) -> Path:
        """Everything that is made for this target."""
        return ROOT / "build" / "zig" / self.name

    @property
    def libraries(self) -> Path:
        """Where the libraries are installed that the core links."""
        return self.folder / "libraries"

    @property
    def math(self) -> Path:
        return self.folder / "math.o"

    @property
    def toolchain(self) -> Path:
        return self.folder / "toolchain.cmake"


# 2.28 is what Blender itself needs, 4.2 and later.
LINUX = Target("linux-x86_64", "x86_64-linux-gnu.2.28", "Linux", "x86_64")
# None of the macros of windows.h that take common words.
WINDOWS = Target("windows-x86_64", "x86_64-windows-gnu", "Windows", "x86_64",
                 ("-DWIN32_LEAN_AND_MEAN", "-DNOMINMAX"))  # fmt: skip


def version() -> str:
    """ziglang==… of the requirements."""
    return next(line for line in REQUIREMENTS.read_text().splitlines() if line.startswith("ziglang=="))


def program() -> Path:
    return next((HOME / "lib").glob("python3*/site-packages/ziglang/zig"))


def prepare(target: Target) -> None:
    """Installs Zig, and writes the toolchain's file for CMake with the programs that it names."""
    make_environment(HOME, REQUIREMENTS)
    target.folder.mkdir(parents=True, exist_ok=True)
    for name, command in PROGRAMS.items():
        script = target.folder / name
        options = f" -target {target.triple}" if name in {"cc", "c++"} else ""
        _write(script, f'#!/bin/sh\nexec "{program()}" {command}{options} "$@"\n')
        script.chmod(0o755)
    if target.system == "Linux":
        _write(target.folder / "exports.map", EXPORTS)
        make_math(target)
    if _write(target.toolchain, toolchain(target)):
        for kept in target.folder.glob("*/CMakeCache.txt"):  # it would keep the flags of the old one
            kept.unlink()


def make_math(target: Target) -> None:
    """Compiles cmake/zig/math.c, which every program and module gets."""
    run(target.folder / "cc", "-O2", "-fno-builtin", "-fPIC", "-fvisibility=hidden", "-fno-sanitize=undefined", "-c",
        MATH, "-o", target.math, env=environment(target))  # fmt: skip


def toolchain(target: Target) -> str:
    """Libraries are looked for among the target's own alone: this machine's are of another system."""
    flags = " ".join(target.flags)
    linking = LINUX_LINKING if target.system == "Linux" else WINDOWS_LINKING
    return f"""# Made by tools/zig.py.
set(CMAKE_SYSTEM_NAME {target.system})
set(CMAKE_SYSTEM_PROCESSOR {target.processor})
set(CMAKE_C_COMPILER {target.folder}/cc)
set(CMAKE_CXX_COMPILER {target.folder}/c++)
set(CMAKE_AR {target.folder}/ar CACHE FILEPATH "")
set(CMAKE_RANLIB {target.folder}/ranlib CACHE FILEPATH "")
# Zig adds checks of undefined behaviour to what is not optimised for speed.
set(CMAKE_C_FLAGS_INIT "-fno-sanitize=undefined {flags}")
set(CMAKE_CXX_FLAGS_INIT "-fno-sanitize=undefined {flags}")
foreach(kind EXE SHARED)
  set(CMAKE_${{kind}}_LINKER_FLAGS_RELEASE_INIT "-s")
endforeach()
{linking.replace("FOLDER", str(target.folder))}
set(CMAKE_FIND_ROOT_PATH {target.libraries})
set(CMAKE_PREFIX_PATH {target.libraries})
foreach(kind LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${{kind}} ONLY)
endforeach()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(ENV{{PKG_CONFIG_LIBDIR}} {target.libraries}/lib/pkgconfig)
# The compiler cache knows precompiled headers of GCC alone.
set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
"""


def environment(target: Target) -> dict[str, str]:
    """For CMake and for the compiler cache. The cache takes the scripts for compilers, so it gets Zig's version."""
    # Flags of the caller are for this machine's compiler.
    own = dict.fromkeys(("CFLAGS", "CXXFLAGS", "LDFLAGS", "CPPFLAGS", "CMAKE_ARGS"), "")
    return tool_environment(CMAKE_GENERATOR="Ninja") | own | {
        "ZIG_GLOBAL_CACHE_DIR": str(compiler_cache.user_caches() / "riffler" / "zig"),
        "CCACHE_COMPILERTYPE": "clang",
        "CCACHE_COMPILERCHECK": f"string:{version()} {target.triple}",
        "PKG_CONFIG_LIBDIR": str(target.libraries / "lib" / "pkgconfig"),
    }  # fmt: skip


def arguments(target: Target) -> list[str]:
    """For CMake."""
    return [f"-DCMAKE_TOOLCHAIN_FILE={target.toolchain}", "-DCMAKE_BUILD_TYPE=Release", *compiler_cache.arguments()]


def _write(path: Path, text: str) -> bool:
    """Leaves an equal file alone, since CMake configures again for a newer one. Whether it was another one."""
    if path.is_file() and path.read_text() == text:
        return False
    path.write_text(text)
    return True
