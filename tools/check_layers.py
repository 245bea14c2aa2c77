"""Checks who includes whom: a native topic uses only those above it in RIFFLER_TOPICS, a folder of a topic only those
that FOLDERS names, no file leads back to itself, the core touches neither Python nor what it is judged by, and the
pen's C files touch nothing but each other. A source includes its own header first, which shows that the header stands
alone. A public header (native/include/riffler) includes public headers, the standard library and GLM only. What a
topic's files declare is in the topic's namespace, and no type is defined twice in one namespace (cpp_types.py). The
add-on's rules are in addon_layers.py. Prints every line that breaks a rule and exits 1."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import addon_layers
import cpp_types
from shell import ROOT, StepError, main

# All that a topic's file may say in riffler itself: what others call its types.
GIVEN_TO_ALL = re.compile(r"\s*(?:using \w+::\w+|namespace \w+ = \w+::\w+)\s*$")
# What a topic's file may say outside of every namespace: macros, types of C libraries, specialisations for std.
OUTSIDE = re.compile(r"\s*[A-Z][A-Z_]*\(.*\)\s*$|\s*struct [a-z_]+_\s*$|\s*template <>\s*struct std::", re.S)
# Functions of the C library whose last bit is another one on another system, and what to call in their place.
HYPOT = {"std::hypot(": "geom::hypot"}
OWN = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "expm1", "log", "log2", "log10", "pow", "tanh")
NOT_THE_SAME = HYPOT | {f"std::{name}(": f"base::{name}" for name in OWN} | {"std::cbrt(": "base::pow"}
# Headers of one kind of system, and where they may be used: in the folders posix and windows, of which a build takes
# one, and in what is for Linux alone: the program for makers' libraries, fuzzers and tests.
OF_A_SYSTEM = re.compile(
    r"(?:sys|linux|net|netinet|arpa|asm)/|(?:alloca|dirent|dlfcn|fcntl|glob|grp|ifaddrs|link|malloc|netdb|poll|pthread"
    r"|pwd|sched|semaphore|signal|spawn|strings|syslog|termios|ucontext|unistd|utime|windows|winsock2|io|process)\.h$"
)
OF_SYSTEMS = {"posix", "windows"}
OF_LINUX = {"arm_program", "fuzz", "tests"}
SPEAKS_TO_THREADS = "bindings/take_gil.c"  # in C, since Python ends threads here
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
# Folders outside the topics, and the topics and other such folders they may include. The reference must not share code
# with what it judges; `None` is every topic.
BESIDE: dict[str, tuple[list[str] | None, list[str]]] = {
    "arm_program": (["base", "geom", "pen"], []),
    "reference": (["base", "geom", "tool"], []),
    "bench": (None, ["reference"]),
    "stress": (None, ["reference", "bench"]),
    "fuzz": (None, []),
    "bindings": (None, ["bench", "stress"]),
}
# Folders of one topic: which others of it each may include. A folder that is not here may include all of its topic.
FOLDERS = {
    "dexel": [],
    "dexel/file": ["dexel"],
    "dexel/from_mesh": ["dexel"],
    "dexel/smooth": ["dexel"],
    "mesh": [],
    "mesh/decimate": ["mesh"],
    "mesh/io": ["mesh"],
    "nc": [],
    "nc/machine": ["nc"],
    "nc/read": ["nc", "nc/machine"],
    "nc/write": ["nc", "nc/machine"],
    "plan": [],
    "plan/finish": ["plan"],
    "pen/arms": [],
    "pen/haply": ["pen", "pen/hid", "pen/link", "pen/service"],
    "pen/hid": ["pen/link"],
    "pen/hid/posix": ["pen/hid"],
    "pen/hid/windows": ["pen/hid"],
    "pen/library": ["pen", "pen/hid", "pen/link"],
    "pen/link": [],
    "pen/models": ["pen", "pen/arms", "pen/hid"],
    "pen/service": ["pen/hid", "pen/link"],
    "pen/service/posix": ["pen/hid", "pen/link", "pen/service"],
    "pen/service/windows": ["pen/hid", "pen/link", "pen/service"],
    "pen/simulated": ["pen", "pen/arms", "pen/hid", "pen/link", "pen/models"],
}
# Topics that may include the pen's protocol and firmware.
USES_DEVICE = {"pen"}
# What the pen's C files may include of the standard library: all of it is there without an operating system.
FREESTANDING = {"stddef.h", "stdint.h", "string.h"}
# Where public headers lie, and the folders of other libraries that they may include.
PUBLIC = "native/include/riffler"
PUBLIC_LIBRARIES = {"glm"}


def topics(root: Path) -> list[str]:
    """The order of the topics, as the build has it."""
    match = re.search(r"set\(RIFFLER_TOPICS ([^)]*)\)", (root / "CMakeLists.txt").read_text())
    if not match:
        raise StepError("CMakeLists.txt sets no RIFFLER_TOPICS")
    return match[1].split()


def lines(root: Path, folder: Path, *suffixes: str) -> Iterator[tuple[str, str]]:
    for path in sorted(folder.rglob("*")):
        if path.suffix in suffixes:
            name = path.relative_to(root)
            for number, line in enumerate(path.read_text().splitlines(), 1):
                yield f"{name}:{number}", line


def includes(root: Path, folder: Path) -> Iterator[tuple[str, str, str]]:
    for place, line in lines(root, folder, ".cpp", ".hpp", ".c", ".h"):
        if match := INCLUDE.match(line):
            yield place, match[1], match[2]


def topic_includes(root: Path, topic: str) -> Iterator[tuple[str, str, str]]:
    """Those of a topic's private and public files; "riffler/geom/pose.hpp" is given as "geom/pose.hpp"."""
    for folder in (root / "native" / topic, root / PUBLIC / topic):
        for place, quote, name in includes(root, folder):
            yield place, quote, name.removeprefix("riffler/") if quote == '"' else name


def in_core(place: str) -> str:
    """The path within the topics of "native/…/geom/pose.hpp:12": "geom/pose.hpp"."""
    return place.removeprefix(f"{PUBLIC}/").removeprefix("native/").split(":")[0]


def core_problems(root: Path) -> list[str]:
    order = topics(root)
    problems = []
    for rank, topic in enumerate(order):
        for place, quote, name in topic_includes(root, topic):
            folder = name.split("/")[0]
            if name == "Python.h" or folder == "pybind11":
                problems.append(f"{place}: the core includes {name}")
            elif folder == "device" and topic in USES_DEVICE:
                continue
            elif quote == '"' and "/" not in name:
                problems.append(f"{place}: write the topic's folder: {topic}/{name}")
            elif quote == '"' and folder not in order[: rank + 1]:
                problems.append(f"{place}: {topic} includes {name}, which is not above it")
    return problems


def bit_problems(root: Path) -> list[str]:
    """The same bytes on every system. Tests and benchmarks, which only compare, may call what they like."""
    problems = []
    for folder in [*topics(root), PUBLIC.removeprefix("native/"), "reference", "stress", "bindings"]:
        names = HYPOT if folder in {"reference", "stress"} else NOT_THE_SAME
        for place, line in lines(root, root / "native" / folder, ".cpp", ".hpp"):
            problems += [
                f"{place}: {name[:-1]} differs between systems: use {own}"
                for name, own in names.items()
                if name in line
            ]
    return problems


def system_problems(root: Path) -> list[str]:
    """A port to another system has these folders to change, and no others."""
    problems = []
    for place, quote, name in includes(root, root / "native"):
        path = in_core(place).split("/")
        if in_core(place) == SPEAKS_TO_THREADS or path[0] in OF_LINUX or OF_SYSTEMS & set(path):
            continue
        if quote == "<" and OF_A_SYSTEM.match(name):
            problems.append(f"{place}: <{name}> is of one kind of system: call it in native/base/posix and /windows")
        elif quote == '"' and OF_SYSTEMS & set(name.split("/")):
            problems.append(f"{place}: includes {name}, which other systems do not have")
    return problems


def folder_problems(root: Path) -> list[str]:
    problems = []
    for topic in topics(root):
        for place, quote, name in topic_includes(root, topic):
            folder = str(Path(in_core(place)).parent)
            used = name.rpartition("/")[0]
            if quote != '"' or folder not in FOLDERS or used == folder or used.split("/")[0] != topic:
                continue
            if used not in FOLDERS[folder]:
                allowed = ", ".join(FOLDERS[folder]) or "none"
                problems.append(f"{place}: {folder} includes {name}; of its topic's other folders it may use {allowed}")
    return problems


def circle_problems(root: Path) -> list[str]:
    """A header and its source are one here; a -inl.hpp belongs to the sources that include it."""
    used: dict[str, set[str]] = {}
    for topic in topics(root):
        for place, quote, name in topic_includes(root, topic):
            path = in_core(place)
            if quote == '"' and not path.endswith("-inl.hpp"):
                used.setdefault(path.rsplit(".", 1)[0], set()).add(name.rsplit(".", 1)[0])
    problems = []
    done: set[str] = set()

    def visit(file: str, way: list[str]) -> None:
        if file in way:
            problems.append("a circle of files: " + " → ".join([*way[way.index(file) :], file]))
        elif file not in done:
            for other in sorted(used.get(file, set()) - {file}):
                visit(other, [*way, file])
            done.add(file)

    for file in sorted(used):
        visit(file, [])
    return problems


def beside_problems(root: Path) -> list[str]:
    order = topics(root)
    problems = []
    for name, (above, beside) in BESIDE.items():
        allowed = [name, *(order if above is None else above), *beside]
        for place, quote, header in includes(root, root / "native" / name):
            folder = header.removeprefix("riffler/").split("/")[0]
            if quote == '"' and "/" in header and folder not in allowed:
                problems.append(
                    f"{place}: {name} includes {header}; of native/ it may use {', '.join(allowed[1:])} only"
                )
    return problems


def device_problems(root: Path) -> list[str]:
    """A path is taken from the file that includes it, so that the two folders can be copied into a firmware's tree."""
    problems = []
    for folder, above in (("protocol", []), ("firmware", ["../protocol"])):
        for place, quote, name in includes(root, root / "device" / folder):
            if quote == "<" and name not in FREESTANDING:
                problems.append(f"{place}: {folder} includes <{name}>, which a pen may not have")
            elif quote == '"' and name.rpartition("/")[0] not in ["", *above]:
                problems.append(f"{place}: {folder} includes {name}, which is not above it")
    return problems


def header_problems(root: Path) -> list[str]:
    """Where sources are compiled one by one, that shows that their headers stand alone (cmake/headers.cmake)."""
    problems = []
    for topic in [*topics(root), "reference"]:
        for source in sorted((root / "native" / topic).rglob("*.cpp")):
            own = source.relative_to(root / "native").with_suffix(".hpp")
            public = (root / PUBLIC / own).exists()
            found = [INCLUDE.match(line) for line in source.read_text().splitlines()]
            first = next((match[2] for match in found if match), None)
            name = f"riffler/{own}" if public else str(own)
            if (public or (root / "native" / own).exists()) and first != name:
                problems.append(f"{source.relative_to(root)}: includes {first} before {name}")
    return problems


def public_problems(root: Path) -> list[str]:
    """What is installed needs nothing that is not."""
    problems = []
    for header in sorted((root / PUBLIC).rglob("*.hpp")):
        if (root / "native" / header.relative_to(root / PUBLIC)).exists():
            problems.append(f"{header.relative_to(root)}: there is a private header of that name too")
    for place, quote, name in includes(root, root / PUBLIC):
        if quote == '"' and not (root / "native" / "include" / name).exists():
            problems.append(f"{place}: a public header includes {name}, which is private")
        elif quote == "<" and ("/" in name or name.endswith(".h")) and name.split("/")[0] not in PUBLIC_LIBRARIES:
            problems.append(f"{place}: a public header includes <{name}>, of another library than GLM")
    return problems


def namespace_problems(root: Path) -> list[str]:
    problems = []
    for topic in [*topics(root), "reference"]:
        for path in sorted([*(root / "native" / topic).rglob("*.?pp"), *(root / PUBLIC / topic).rglob("*.?pp")]):
            for spaces, head, _ in cpp_types.statements(path.read_text()):
                space = "::".join(filter(None, spaces))
                if not head.strip():  # what is left of a type or a list in braces
                    continue
                if space == "riffler":
                    right = "" not in spaces and GIVEN_TO_ALL.match(head)
                elif not space:
                    right = not spaces and OUTSIDE.match(head)
                else:
                    right = f"{space}::".startswith(f"riffler::{topic}::")
                if not right:
                    said = " ".join(head.split())[:60]
                    problems.append(f"{path.relative_to(root)}: outside of namespace riffler::{topic}: {said}")
    return problems


def type_problems(root: Path) -> list[str]:
    return [
        f"{name} is defined twice: {', '.join(places)}"
        for name, places in cpp_types.definitions(root / "native").items()
        if len(places) > 1
    ]


CHECKS = [
    core_problems,
    bit_problems,
    system_problems,
    folder_problems,
    circle_problems,
    beside_problems,
    device_problems,
    header_problems,
    public_problems,
    namespace_problems,
    type_problems,
    addon_layers.problems,
]


def entry() -> None:
    problems = [problem for check in CHECKS for problem in check(ROOT)]
    print("\n".join(problems) or "layers: every include and import points upwards, no circles, no type defined twice")
    sys.exit(bool(problems))


if __name__ == "__main__":
    main(entry)
