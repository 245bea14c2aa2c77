"""Another release of Debian in a folder, ./.envs/<suite>: where a newer Blender runs, with the Python it came with.

Nothing of the host is mounted inside: files are copied in and out, and a command there has its own processes, its own
/proc and, but for apt, no network. What apt needs to reach the mirror is copied from the host's own settings.
"""

from __future__ import annotations

import fcntl
import filecmp
import os
import platform
import shlex
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from shell import ROOT, StepError, is_stamped, say, write_stamp

MIRROR = "http://deb.debian.org/debian"
KEYS = Path("/usr/share/keyrings/debian-archive-keyring.gpg")
CERTIFICATES = Path("/etc/ssl/certs/ca-certificates.crt")
# Where the project lies in there.
PROJECT = Path("/riffler")


def impossible() -> str:
    """Why no such folder can be made or used here, or nothing."""
    if platform.system() != "Linux" or platform.machine() != "x86_64":
        return f"a root folder of Debian needs Linux on x86-64, this is {platform.system()} {platform.machine()}"
    if os.geteuid() != 0:
        return "changing the root folder needs root: sudo make test-blenders"
    return ""


@dataclass(frozen=True)
class Chroot:
    """A release and the packages it needs. `frozen_release`: a mirror's copy that stands still may have run out."""

    suite: str
    packages: tuple[str, ...]
    frozen_release: bool = False

    @property
    def root(self) -> Path:
        return ROOT / ".envs" / self.suite

    @property
    def project(self) -> Path:
        return self.root / PROJECT.relative_to("/")

    @contextmanager
    def held(self) -> Iterator[None]:
        """One user at a time: checkouts may share ./.envs."""
        self.root.parent.mkdir(exist_ok=True)
        with self.root.with_name(f".{self.suite}-lock").open("w") as handle:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                say(f"waiting for another user of .envs/{self.suite}")
                fcntl.flock(handle, fcntl.LOCK_EX)
            yield

    def make(self) -> None:
        """Debian's base, then the packages; each only where it is not there yet."""
        base, packages = self.root / ".riffler-base", self.root / ".riffler-packages"
        if not is_stamped(base, self.suite):
            say(f".envs/{self.suite}: Debian {self.suite}")
            remove(self.root)
            self.root.mkdir(parents=True)
            keys = [f"--keyring={KEYS}"] if KEYS.exists() else []
            succeed("debootstrap", "--variant=minbase", *keys, self.suite, str(self.root), mirror())
            write_stamp(base, self.suite)
        self.copy_settings()
        key = " ".join(sorted(self.packages))
        if is_stamped(packages, key):
            return
        say(f".envs/{self.suite}: {len(self.packages)} packages and what they need")
        apt = ["env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-q", "-y", "-oAcquire::Retries=3"]
        self.run(*apt, "update", network=True)
        self.run(*apt, "install", "--no-install-recommends", *self.packages, network=True)
        self.run("apt-get", "clean")
        write_stamp(packages, key)

    def identity(self) -> str:
        """Changes when a package in there does: a compiler, a Python."""
        return (self.root / "var" / "lib" / "dpkg" / "status").read_text()

    def copy_settings(self) -> None:
        """Names, proxies and certificates of the host: what apt there needs to reach the mirror as apt here does."""
        etc = self.root / "etc"
        for name in ("resolv.conf", "hosts"):
            if Path("/etc", name).exists():
                (etc / name).unlink(missing_ok=True)
                shutil.copy(Path("/etc", name), etc / name)
        if CERTIFICATES.exists():
            target = self.root / CERTIFICATES.relative_to("/")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(CERTIFICATES, target)
        lines = apt_settings()
        if self.frozen_release:
            lines.append('Acquire::Check-Valid-Until "false";')
        (etc / "apt" / "apt.conf.d" / "90host").write_text("".join(line + "\n" for line in lines))
        # Half the time of apt goes into making sure that files outlive a power cut; this folder can be made again.
        keep = "".join(f"path-exclude=/usr/share/{name}/*\n" for name in ("doc", "man", "locale"))
        (etc / "dpkg" / "dpkg.cfg.d" / "riffler").write_text(f"force-unsafe-io\n{keep}")
        policy = self.root / "usr" / "sbin" / "policy-rc.d"  # no package starts a service
        policy.write_text("#!/bin/sh\nexit 101\n")
        policy.chmod(0o755)

    def command(self, *words: str, network: bool = False, **variables: str) -> list[str]:
        """What runs `words` in there, in the project's folder, with these variables and none of the caller's."""
        own = {"HOME": "/root", "PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LANG": "C.UTF-8"}
        own |= proxies() if network else {}
        environment = [f"{name}={value}" for name, value in (own | variables).items()]
        place = ["sh", "-c", 'cd "$0" 2>/dev/null; exec "$@"', str(PROJECT)]
        apart = isolation(network)
        if apart:
            apart = [*apart, f"--mount-proc={self.root / 'proc'}"]
        return [*apart, "chroot", str(self.root), "env", "-i", *environment, *place, *words]

    def run(self, *words: str | Path, network: bool = False, **variables: str) -> None:
        succeed(*self.command(*map(str, words), network=network, **variables))

    def put(self, files: Iterable[Path]) -> None:
        """Copies the project's present files; those that changed get the present time, so that builds there see it, and
        files that an earlier call copied and that are gone here are removed."""
        listing = self.project / ".riffler-files"
        wanted = {path.relative_to(ROOT): path for path in files}
        before = set(map(Path, listing.read_text().split("\n"))) if listing.exists() else set()
        for gone in before - wanted.keys():
            (self.project / gone).unlink(missing_ok=True)
        self.project.mkdir(exist_ok=True)
        listing.write_text("\n".join(map(str, sorted(before | wanted.keys()))))
        for name, source in wanted.items():
            target = self.project / name
            if not (target.is_file() and filecmp.cmp(source, target, shallow=False)):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, target)
                target.chmod(source.stat().st_mode & 0o777)
        listing.write_text("\n".join(map(str, sorted(wanted))))


def succeed(*words: str) -> None:
    """Runs a command with its output shown, in the caller's environment; StepError naming it if it does not succeed."""
    try:
        code = subprocess.run(words, check=False).returncode
    except OSError as error:
        raise StepError(f"cannot run {words[0]}: {error.strerror}") from error
    if code != 0:
        raise StepError(f"failed with exit code {code}: {shlex.join(words)}")


def remove(folder: Path) -> None:
    """Deletes a folder, but never through a mount, which a user may have made by hand."""
    if not folder.exists():
        return
    for line in Path("/proc/self/mounts").read_text().splitlines():
        if Path(line.split()[1].replace("\\040", " ")).is_relative_to(folder.resolve()):
            raise StepError(f"{line.split()[1]} is mounted: unmount it, then delete {folder.relative_to(ROOT)}")
    shutil.rmtree(folder)


@cache
def isolation(network: bool) -> list[str]:
    """Own mounts, processes (they end with the command) and network, so that displays of the same number do not meet.
    Where the kernel forbids it, as in some containers, nothing: then a display is only looked for by number."""
    apart = ["unshare", "--mount", "--ipc", "--pid", "--fork", "--kill-child", *([] if network else ["--net"])]
    probe = subprocess.run([*apart, "true"], capture_output=True, check=False) if shutil.which("unshare") else None
    return apart if probe is not None and probe.returncode == 0 else []


def mirror() -> str:
    """The host's own mirror of Debian."""
    if shutil.which("apt-get"):
        command = ["apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages", "Label: Debian"]
        lines = subprocess.run(command, capture_output=True, text=True, check=False).stdout.split()
        return next((line for line in lines if line.startswith("http")), MIRROR)
    return MIRROR


def apt_settings() -> list[str]:
    """The host's lines about proxies and certificates."""
    if not shutil.which("apt-config"):
        return []
    lines = subprocess.run(["apt-config", "dump"], capture_output=True, text=True, check=False).stdout.splitlines()
    kinds = ("proxy", "cainfo", "verify-peer", "verify-host", "timeout")
    return [
        s
        for s in lines
        if s.lower().startswith(("acquire::http", "acquire::ftp")) and any(k in s.lower() for k in kinds)
    ]


def proxies() -> dict[str, str]:
    return {
        name: value for name, value in os.environ.items() if name.lower() in ("http_proxy", "https_proxy", "no_proxy")
    }
