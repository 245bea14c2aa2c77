"""The libraries that the core links, for a target of tools/zig.py: fetched from Debian 12 on every
release, so that a wheel is of the same sources wherever it is built, and compiled by cmake/libraries.

Compiled ones are Debian's unchanged upstream archives; header libraries are Debian's packages, unpacked.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import tarfile
import tempfile
from dataclasses import dataclass
from pathlib import Path

import compiler_cache
import zig
from chroot import mirror
from shell import ROOT, StepError, digest, is_stamped, run, say, write_stamp

RELEASE = "bookworm"
KEYRING = Path("/usr/share/keyrings/debian-archive-keyring.gpg")
CMAKE = ROOT / "cmake" / "libraries"


@dataclass(frozen=True)
class Archive:
    """One file of Debian's: the sources of a library (`source`), or a package of headers."""

    package: str
    file: str
    sha256: str
    source: bool = True


ARCHIVES = {
    "highway": Archive("highway", "highway_1.0.3.orig.tar.gz",
                       "566fc77315878473d9a6bd815f7de78c73734acdcb745c3dde8579560ac5440e"),
    "hidapi": Archive("hidapi", "hidapi_0.13.1.orig.tar.gz",
                      "476a2c9a4dc7d1fc97dd223b84338dbea3809a84caea2dcd887d9778725490e3"),
    "openmesh": Archive("openmesh", "openmesh_9.0.orig.tar.gz",
                        "4df84295f5cca86b1ae8bfee8ff4db5efb6850e4e5b571ad0199147176dea796"),
    "zlib": Archive("zlib", "zlib_1.2.13.dfsg.orig.tar.bz2",
                    "71feb7947e3c00ef125f83b79a4e529bde31171e5babe48b391f06758d1ab0a1"),
    "glm": Archive("libglm-dev", "libglm-dev_0.9.9.8+ds-6_all.deb",
                   "e2a2af0f14f24c07eb53de52b779c4557b6010d5fcc68128ed321c2bedf1ed3a", source=False),
    "tomlplusplus": Archive("libtomlplusplus-dev", "libtomlplusplus-dev_3.3.0+ds-1_amd64.deb",
                            "2779cce0001466dcf60eb6262ff68a888d49f9e30aee80c499d1d4f6f9f6e12e", source=False),
}  # fmt: skip


def build_libraries(target: zig.Target) -> str:
    """Everything in target.libraries; returns a digest of all that they depend on."""
    archives = [f"{archive.file} {archive.sha256}" for archive in ARCHIVES.values()]
    key = digest([*CMAKE.iterdir(), zig.REQUIREMENTS], target.triple, zig.toolchain(target), *archives)
    stamp = target.folder / ".libraries"
    if is_stamped(stamp, key):
        return key
    say(f"libraries for {target.triple}")
    sources = fetched_sources()
    build = target.folder / "libraries-build"
    for folder in (build, target.libraries):
        shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(sources / "headers", target.libraries)
    environment = zig.environment(target)
    install = f"-DCMAKE_INSTALL_PREFIX={target.libraries}"
    run("cmake", "-S", CMAKE, "-B", build, "--log-level=NOTICE", f"-DSOURCES={sources}", install,
        *zig.arguments(target), env=environment)  # fmt: skip
    run("cmake", "--build", build, "--target", "install", env=environment)
    write_stamp(stamp, key)
    return key


def fetched_sources() -> Path:
    """A folder for each library, and `headers` with include/ and share/cmake/. They lie in the user's cache folder,
    which all checkouts share."""
    key = hashlib.sha256("".join(a.sha256 for a in ARCHIVES.values()).encode()).hexdigest()
    folder = compiler_cache.user_caches() / "riffler" / f"libraries-{key[:16]}"
    if folder.is_dir():
        return folder
    if not shutil.which("apt-get"):
        raise StepError("the libraries of these wheels come from Debian's archive: there is no apt-get")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as place:
        download(Path(place))
        unpacked = Path(place, "unpacked")
        for name, archive in ARCHIVES.items():
            unpack(Path(place), archive, unpacked / name)
        shutil.move(unpacked / "glm" / "usr", unpacked / "headers")
        shutil.move(unpacked / "tomlplusplus" / "usr" / "include" / "toml++", unpacked / "headers" / "include")
        if not folder.exists():  # another checkout may have been quicker
            unpacked.rename(folder)
    return folder


def download(place: Path) -> None:
    """All archives, with lists of apt's own in `place`: those of this machine need not have this release's sources."""
    for name in ("lists", "cache"):
        (place / name / "partial").mkdir(parents=True)
    signed = f"[signed-by={KEYRING}] " if KEYRING.is_file() else ""
    lines = (f"{kind} {signed}{mirror()} {RELEASE} main\n" for kind in ("deb", "deb-src"))
    (place / "sources.list").write_text("".join(lines))
    own = {"Dir::Etc::SourceList": place / "sources.list", "Dir::Etc::SourceParts": "/dev/null",
           "Dir::State::Lists": place / "lists", "Dir::Cache": place / "cache", "Acquire::Retries": 3}  # fmt: skip
    apt = ["apt-get", "-q", *(f"-o{name}={value}" for name, value in own.items())]
    if os.geteuid() == 0:
        apt.append("-oAPT::Sandbox::User=root")
    sources = [a.package for a in ARCHIVES.values() if a.source]
    headers = [a.package for a in ARCHIVES.values() if not a.source]
    for words in (["update"], ["source", "--download-only", *sources], ["download", *headers]):
        run(*apt, *words, cwd=place)


def unpack(place: Path, archive: Archive, folder: Path) -> None:
    """The archive's content, without the one folder that an upstream archive begins with."""
    path = place / archive.file
    if not path.is_file():
        raise StepError(f"Debian {RELEASE} has another version of {archive.package} than {archive.file}: "
                        "tools/libraries.py pins it")  # fmt: skip
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != archive.sha256:
        raise StepError(f"{archive.file} has the digest {found}, not the one that tools/libraries.py pins")
    if not archive.source:
        subprocess.run(["dpkg", "-x", path, folder], check=True)
        return
    with tempfile.TemporaryDirectory(dir=place) as temporary:
        with tarfile.open(path) as file:
            file.extractall(temporary, filter="data")
        (root,) = Path(temporary).iterdir()
        folder.parent.mkdir(parents=True, exist_ok=True)
        root.rename(folder)
