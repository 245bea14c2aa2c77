"""Puts measured figures into the documents: tables between `<!-- bench JOB/TABLE -->` and `<!-- end -->`, and the plots
that they show from docs/images/bench.

    tools/bench_docs.py out/bench      (a folder that `riffler bench` wrote)
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
BLOCK = re.compile(r"(<!-- bench (\S+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)
IMAGE = re.compile(r"\(images/bench/([\w-]+\.png)\)")


def measured(folder: Path) -> dict[str, str]:
    """Every table by its mark; a quick run is no measurement."""
    tables: dict[str, str] = {}
    for path in sorted(folder.glob("*.md")):
        data = json.loads(path.with_suffix(".json").read_text())
        if data["quick"]:
            raise StepError(f"{path.name} is from a run with --quick: measure it in full")
        if data["problems"]:
            raise StepError(f"{path.name}: {data['problems'][0]}")
        tables |= {name: text for _, name, text, _ in BLOCK.findall(path.read_text())}
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
        new = BLOCK.sub(lambda m: m[1] + tables.get(m[2], m[3]) + m[4], text)
        names = [name for _, name, _, _ in BLOCK.findall(text)]
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
