"""Reads NC programs and cutter location files of others, and says how many are read and why the others are not.

tools/corpora.py FOLDER [--reasons N]

Each folder in FOLDER is a corpus. Files of APT statements, those with BEGIN PGM and those with words of Sinumerik
controls are read as such; others for the first machine that has their axes. No options are given.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from pathlib import Path

import riffler

from shell import main

APT = re.compile(r"^\s*(GOTO\s*/|PARTNO|TOOL PATH/|\$\$)", re.MULTILINE)
ISO = re.compile(r"^\s*(%|[:NOGM]\s*\d)", re.MULTILINE | re.IGNORECASE)
SINUMERIK = re.compile(
    r"^%_N_|^;\$PATH=|\bMSG\s*\(|^\s*(N\d+ *)?R\d+ *="
    r"|\b(SUPA|TRAORI|TRAFOOF|MCALL|GOTOF|GOTOB|CYCLE8\d|CR=|G641|G642|DEF REAL|FFWON)\b",
    re.MULTILINE,
)
CONVERSATIONAL = re.compile(r"^\s*\d*\s*BEGIN PGM", re.MULTILINE | re.IGNORECASE)
MACHINES = ("3-axis", "tcp", "linuxcnc-xyzac", "linuxcnc-xyzbc")
PLACE = re.compile(r"^.*?, line \d+: | \[[^\[]*\]$|\d[\d.]*")


def machines(text: str) -> tuple[str, ...]:
    if CONVERSATIONAL.search(text):
        return ("heidenhain", "heidenhain-bc")
    if SINUMERIK.search(re.sub(r"(?m)(^|\s)[(][^)\n]*[)]", " ", text)):
        return ("sinumerik", "sinumerik-bc")
    return ("apt",) if APT.search(text) and not ISO.match(text) else MACHINES


def problem(path: Path) -> str:
    """Why the file is not read, or nothing."""
    first = ""
    for machine in machines(path.read_text(errors="replace")[:100_000]):
        try:
            pivot = {"rot_point": [0, 0, 0]} if machine.startswith("linuxcnc") else {}
            program = riffler.Program.read(path, machine=machine, options=pivot)
        except ValueError as error:
            first = first or str(error)
            if "the machine has no such axis" in str(error):
                continue
            return str(error)
        return "" if len(program) else "no moves"
    return first


def entry() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--reasons", type=int, default=8, metavar="N", help="the most frequent ones of each corpus")
    arguments = parser.parse_args()
    for corpus in sorted(path for path in arguments.folder.iterdir() if path.is_dir() and path.name[0] != "."):
        files = sorted(path for path in corpus.iterdir() if path.is_file() and path.name != "SOURCE.txt")
        problems = [text for path in files if (text := problem(path))]
        print(f"{corpus.name}: {len(files) - len(problems)} of {len(files)} read", flush=True)
        reasons = Counter(PLACE.sub("", PLACE.sub("", text, count=1))[:100] for text in problems)
        for reason, count in reasons.most_common(arguments.reasons):
            print(f"  {count:4} {reason}")
    sys.stdout.flush()


if __name__ == "__main__":
    main(entry)
