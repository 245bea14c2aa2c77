"""Builds the two zips that users install, from wheels that are already built:

    python addon/package.py --wheel dist/riffler-….whl [--wheel …] --out dist

riffler-<version>.zip           extension for Blender from 4.2 on, of the Pythons and platforms whose wheels go in: with
                                that for Python 3.11 alone it is for 4.2 to 5.0
riffler-<version>-legacy.zip    add-on for Blender 3.x, with the package of the wheel for Python 3.11 (Debian 12's)
                                unpacked inside; not made without such a wheel

The bytes depend on the sources and the wheels only: fixed times, sorted names.
"""

from __future__ import annotations

import argparse
import re
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
NOT_SHIPPED = {"package.py", "ruff.toml"}
# Folder of the legacy add-on. It is imported by this name, so it cannot be `riffler`, the native package's name.
LEGACY_NAME = "riffler_addon"
LEGACY_PYTHON = (3, 11)
FIXED = (2020, 1, 1, 0, 0, 0)  # the time stamp of all entries
# The pipeline's names for prefixes of a wheel's platform tag.
PLATFORMS = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64", "arm64": "arm64"}


def sources() -> list[Path]:
    """The files of this folder that are shipped: as with Blender's own tool no hidden ones, such as linters' caches."""
    files = (p.relative_to(HERE) for p in HERE.rglob("*") if p.is_file())
    shown = (p for p in files if not any(part.startswith(".") for part in p.parts))
    return sorted(p for p in shown if p.suffix != ".pyc" and p.name not in NOT_SHIPPED)


def tag(python: tuple[int, ...]) -> str:
    """cp311-cp311 for (3, 11): the tag of a Python version in our wheels' names."""
    return f"cp{python[0]}{python[1]}-cp{python[0]}{python[1]}"


def legacy_wheel(wheels: list[Path]) -> Path | None:
    """The wheel that the legacy add-on unpacks: it can hold only one, and Blender does not choose."""
    fitting = [w for w in wheels if f"-{tag(LEGACY_PYTHON)}-" in w.name and platform_of(w).startswith("linux")]
    return next(iter(fitting), None)


def platform_of(wheel: Path) -> str:
    """linux-x64 for riffler-0.1.0-cp311-cp311-manylinux_2_34_x86_64.whl."""
    parts = wheel.stem.split("-")
    if wheel.suffix != ".whl" or len(parts) < 5:
        raise ValueError(f"{wheel.name} is not the name of a wheel")
    tag = parts[-1].split(".")[0].lower()
    system = "windows" if tag.startswith("win") else "macos" if tag.startswith("macosx") else "linux"
    machine = next((PLATFORMS[m] for m in PLATFORMS if tag.endswith(m)), None)
    if machine is None:
        raise ValueError(f"{wheel.name}: unknown machine in the platform tag {tag}")
    return f"{system}-{machine}"


def manifest(wheels: list[Path]) -> str:
    text = (HERE / "blender_manifest.toml").read_text(encoding="utf-8")
    quoted = ", ".join(f'"{p}"' for p in sorted({platform_of(w) for w in wheels}))
    listed = "".join(f'  "./wheels/{w.name}",\n' for w in wheels)
    lines = f"platforms = [{quoted}]\nwheels = [\n{listed}]\n"
    comment = re.compile(r"^# package\.py adds.*\n", re.MULTILINE)
    if len(comment.findall(text)) != 1:
        raise ValueError("blender_manifest.toml has lost the line that package.py replaces")
    return comment.sub(lambda _: lines, text)


def version() -> str:
    text = (HERE / "blender_manifest.toml").read_text(encoding="utf-8")
    return re.search(r'^version = "(.+)"$', text, re.MULTILINE).group(1)


def check_versions(wheels: list[Path]) -> None:
    """ValueError unless the manifest, bl_info and every wheel have the same version."""
    expected = version()
    info = re.search(r'"version": \((\d+), (\d+), (\d+)\)', (HERE / "__init__.py").read_text(encoding="utf-8"))
    found = {"bl_info in __init__.py": ".".join(info.groups()), **{w.name: w.name.split("-")[1] for w in wheels}}
    for where, other in found.items():
        if other != expected:
            raise ValueError(f"{where} has version {other}, blender_manifest.toml {expected}")


def check_choice(wheels: list[Path]) -> None:
    """Blender takes the wheel for its Python and system: there may be only one for each."""
    seen: dict[tuple[str, str], Path] = {}
    for wheel in wheels:
        python = "-".join(wheel.stem.split("-")[2:4])
        other = seen.setdefault((python, platform_of(wheel)), wheel)
        if other is not wheel:
            raise ValueError(f"{wheel.name} and {other.name} are for the same Python and system")


def write_zip(path: Path, entries: dict[str, bytes], folder: str = "") -> None:
    """`folder`: a folder that gets an entry of its own, before all others."""
    part = path.with_suffix(".part")
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
        if folder:
            info = zipfile.ZipInfo(f"{folder}/", FIXED)
            info.external_attr = 0o40755 << 16 | 0x10
            archive.writestr(info, b"")
        for name in sorted(entries):
            info = zipfile.ZipInfo(name, FIXED)
            info.compress_type = zipfile.ZIP_STORED if name.endswith(".whl") else zipfile.ZIP_DEFLATED
            info.external_attr = 0o644 << 16
            archive.writestr(info, entries[name])
    part.replace(path)


def build_extension(wheels: list[Path], out: Path) -> Path:
    entries = {p.as_posix(): (HERE / p).read_bytes() for p in sources()}
    entries["blender_manifest.toml"] = manifest(wheels).encode()
    entries["LICENSE"] = (HERE.parent / "LICENSE").read_bytes()
    entries |= {f"wheels/{w.name}": w.read_bytes() for w in wheels}
    path = out / f"riffler-{version()}.zip"
    write_zip(path, entries)
    return path


def build_legacy(wheel: Path, out: Path) -> Path:
    entries = {p.as_posix(): (HERE / p).read_bytes() for p in sources() if p.name != "blender_manifest.toml"}
    entries["LICENSE"] = (HERE.parent / "LICENSE").read_bytes()
    with zipfile.ZipFile(wheel) as archive:
        # auditwheel puts shared libraries next to the package, in riffler.libs
        for name in archive.namelist():
            if name.startswith(("riffler/", "riffler.libs/")) and not name.endswith("/"):
                entries[f"_vendor/{name}"] = archive.read(name)
    path = out / f"riffler-{version()}-legacy.zip"
    # Blender removes the old folder if an entry of the zip names it. Otherwise it overwrites the file of the running
    # core, and crashes.
    write_zip(path, {f"{LEGACY_NAME}/{name}": data for name, data in entries.items()}, folder=LEGACY_NAME)
    return path


def build(wheels: list[Path], out: Path) -> list[Path]:
    """Writes the zips into `out`; ValueError names what does not fit."""
    for wheel in wheels:
        if not wheel.is_file():
            raise ValueError(f"{wheel} is not there")
    check_versions(wheels)
    check_choice(wheels)
    out.mkdir(parents=True, exist_ok=True)
    wheel = legacy_wheel(wheels)
    return [build_extension(wheels, out), *([build_legacy(wheel, out)] if wheel else [])]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, action="append", required=True, help="may be given several times")
    parser.add_argument("--out", type=Path, default=Path("dist"))
    arguments = parser.parse_args()
    try:
        for path in build(arguments.wheel, arguments.out):
            print(f"{path} ({path.stat().st_size:,} bytes)")
    except (ValueError, OSError) as error:
        print(f"package.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
