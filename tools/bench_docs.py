"""Puts measured figures into the documents: tables between `<!-- bench JOB/TABLE -->` and `<!-- end -->`, and the plots
that they show from docs/images/bench.

    tools/bench_docs.py out/bench      (a folder that `riffler bench` wrote)

A mark may select a part of its table: `<!-- bench JOB/TABLE rows="REGEX" columns="NAME; NAME" note="no" -->` keeps the
rows in which the regular expression is found, the named columns, and leaves out the text below the table.
"""

from __future__ import annotations

import json
import re
import shutil
import sys
from pathlib import Path

from shell import ROOT, StepError, main

DOCS = ROOT / "docs"
IMAGES = DOCS / "images" / "bench"
BLOCK = re.compile(r"(<!-- bench (\S+)((?: \w+=\"[^\"]*\")*) -->\n)(.*?)(<!-- end -->)", re.DOTALL)
SELECTION = re.compile(r'(\w+)="([^"]*)"')
IMAGE = re.compile(r"\(images/bench/([\w-]+\.png)\)")


def cells(row: str) -> list[str]:
    return [cell.strip() for cell in row.strip().strip("|").split("|")]


def select(name: str, text: str, selection: str) -> str:
    """The part of a table that its mark asks for."""
    given = dict(SELECTION.findall(selection))
    if unknown := given.keys() - {"rows", "columns", "note"}:
        raise StepError(f"{name}: unknown selection {', '.join(sorted(unknown))}")
    table = [line for line in text.splitlines() if line.startswith("|")]
    note = [line for line in text.splitlines() if line and not line.startswith("|")]
    if "columns" in given:
        head, wanted = cells(table[0]), [column.strip() for column in given["columns"].split(";")]
        if missing := [column for column in wanted if column not in head]:
            raise StepError(f"{name}: no column {', '.join(missing)}; there are {'; '.join(head)}")
        kept = [i for i, column in enumerate(head) if column in wanted]
    else:
        kept = range(len(cells(table[0]))) if table else []
    rows = [row for row in table[2:] if re.search(given.get("rows", ""), row)]
    if table and not rows:
        raise StepError(f"{name}: no row matches {given.get('rows', '')!r}")
    lines = [f"| {' | '.join(cells(row)[i] for i in kept)} |" for row in (table[0], *rows)] if table else []
    lines[1:1] = ["|" + "---|" * len(kept)] if table else []
    if note and given.get("note") != "no":
        lines += ["", *note] if table else note
    return "\n".join(lines) + "\n"


def measured(folder: Path) -> dict[str, str]:
    """Every table by its mark; a quick run is not a measurement."""
    tables: dict[str, str] = {}
    for path in sorted(folder.glob("*.md")):
        data = json.loads(path.with_suffix(".json").read_text())
        if data["quick"]:
            raise StepError(f"{path.name} is from a run with --quick: measure it in full")
        if data["problems"]:
            raise StepError(f"{path.name}: {data['problems'][0]}")
        tables |= {name: text for _, name, _, text, _ in BLOCK.findall(path.read_text())}
    if not tables:
        raise StepError(f"{folder}: nothing was measured there")
    return tables


def entry() -> None:
    if len(sys.argv) != 2:
        raise StepError("usage: bench_docs.py FOLDER")
    folder = Path(sys.argv[1])
    tables = measured(folder)
    images: set[str] = set()
    for path in sorted(DOCS.glob("*.md")):
        text = path.read_text()
        new = BLOCK.sub(lambda m: m[1] + (select(m[2], tables[m[2]], m[3]) if m[2] in tables else m[4]) + m[5], text)
        names = [name for _, name, *_ in BLOCK.findall(text)]
        images |= set(IMAGE.findall(text))
        if new != text:
            path.write_text(new)
        for name in names:
            print(f"{path.name}: {name}{'' if name in tables else ': not measured, left as it was'}")
    IMAGES.mkdir(parents=True, exist_ok=True)
    for name in sorted(images):
        if (folder / name).exists():
            shutil.copyfile(folder / name, IMAGES / name)
        print(f"{name}{'' if (folder / name).exists() else ': not drawn, left as it was'}")


if __name__ == "__main__":
    main(entry)
