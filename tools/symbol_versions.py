"""What the machine code in a wheel needs of the system that it is loaded on: libraries, and versions of glibc's
symbols; and what it shows to other machine code in the same process.

    python tools/symbol_versions.py WHEEL        one line for each library or program in it

Read from the files by pyelftools: `ldd` would answer for this machine, and a wheel for another processor not at all.
"""

from __future__ import annotations

import io
import sys
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from elftools.elf.dynamic import DynamicSection
from elftools.elf.elffile import ELFFile
from elftools.elf.gnuversions import GNUVerNeedSection
from elftools.elf.sections import Symbol, SymbolTableSection

from shell import StepError, main

ELF = b"\x7fELF"


@dataclass(frozen=True)
class Needs:
    """One file's needs: the shared libraries that it names, the versions of symbols that it asks of them, and the
    symbols that it defines for others. A C++ library that is linked statically must not be among these: the loader
    would mix its functions with those of another one in the process."""

    file: str
    libraries: frozenset[str]
    versions: frozenset[str]
    exported: frozenset[str]

    @property
    def glibc(self) -> tuple[int, ...]:
        """The newest version of glibc among them; empty for none."""
        found = [name.removeprefix("GLIBC_") for name in self.versions if name.startswith("GLIBC_")]
        if "PRIVATE" in found:  # of that very build of glibc
            return (sys.maxsize,)
        return max((tuple(map(int, name.split("."))) for name in found), default=())


def needs(name: str, content: bytes) -> Needs:
    file = ELFFile(io.BytesIO(content))
    libraries: set[str] = set()
    versions: set[str] = set()
    exported: set[str] = set()
    for section in file.iter_sections():
        if isinstance(section, DynamicSection):
            libraries |= {tag.needed for tag in section.iter_tags() if tag.entry.d_tag == "DT_NEEDED"}
        if isinstance(section, GNUVerNeedSection):
            versions |= {version.name for _, entries in section.iter_versions() for version in entries}
        if isinstance(section, SymbolTableSection) and section.name == ".dynsym":
            exported |= {symbol.name for symbol in section.iter_symbols() if is_exported(symbol)}
    return Needs(name, frozenset(libraries), frozenset(versions), frozenset(exported))


def is_exported(symbol: Symbol) -> bool:
    shown = symbol["st_other"]["visibility"] in {"STV_DEFAULT", "STV_PROTECTED"}
    return shown and symbol["st_info"]["bind"] != "STB_LOCAL" and symbol["st_shndx"] != "SHN_UNDEF"


def needs_of_wheel(wheel: Path) -> Iterator[Needs]:
    with zipfile.ZipFile(wheel) as archive:
        for name in archive.namelist():
            content = archive.read(name)
            if content.startswith(ELF):
                yield needs(name, content)


def faults(wheel: Path, glibc: tuple[int, ...], from_system: frozenset[str]) -> list[str]:
    """A line for each library that is neither inside nor in `from_system`, and for each file that needs a glibc newer
    than `glibc` or shows more than Python's entry; one line for a wheel without machine code."""
    found = list(needs_of_wheel(wheel))
    if not found:
        return ["there is no machine code inside"]
    inside = {Path(entry.file).name for entry in found}
    lines = []
    for entry in found:
        lines += [
            f"{entry.file} needs {name}, which is not inside" for name in sorted(entry.libraries - inside - from_system)
        ]
        if entry.glibc > glibc:
            lines.append(f"{entry.file} needs glibc {'.'.join(map(str, entry.glibc))}, newer than "
                         f"{'.'.join(map(str, glibc))}")  # fmt: skip
        lines += [f"{entry.file} exports {name}" for name in sorted(entry.exported) if not name.startswith("PyInit_")]
    return lines


def entry() -> None:
    if len(sys.argv) != 2:
        raise StepError("usage: symbol_versions.py WHEEL")
    for found in needs_of_wheel(Path(sys.argv[1])):
        print(f"{found.file}: glibc {'.'.join(map(str, found.glibc))}; {', '.join(sorted(found.libraries))}; "
              f"exports {len(found.exported)} symbols")  # fmt: skip


if __name__ == "__main__":
    main(entry)
