"""Makes the documents' site: collects them in out/docs as they lie in the project, with the files they link to, adds
the reference from riffler's docstrings, and has MkDocs write out/site. Its warnings are errors: a link that leads
nowhere, a document that mkdocs.yml does not have."""

from __future__ import annotations

import shutil
import time

import check_docs
import reference
from environments import docs_environment
from shell import ROOT, main, run, tool_environment

OUT = ROOT / "out" / "docs"
PAGES = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "examples/README.md")


def collect() -> None:
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    shutil.copytree(ROOT / "docs", OUT / "docs", ignore=shutil.ignore_patterns("__pycache__"))
    for name in PAGES:
        (OUT / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, OUT / name)
    for path in sorted([*map(OUT.joinpath, PAGES), *OUT.glob("docs/*.md")]):
        original = ROOT / path.relative_to(OUT)
        for _, target in check_docs.read(original).links:
            linked = (original.parent / target.partition("#")[0]).resolve()
            copied = OUT / linked.relative_to(ROOT) if linked.is_relative_to(ROOT) else None
            if copied and linked.is_file() and not copied.exists():
                copied.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(linked, copied)


def entry() -> None:
    start = time.monotonic()
    collect()
    names = reference.write(OUT / "docs" / "reference")
    mkdocs = docs_environment() / "bin" / "mkdocs"
    # Material speaks of its successor on every run; that is no warning of ours.
    run(mkdocs, "build", "--strict", env=tool_environment(NO_MKDOCS_2_WARNING="1"))
    print(f"docs: {names} names of the interface, {time.monotonic() - start:.1f} s; read them with", flush=True)
    print("  python3 -m http.server --bind localhost --directory out/site")


if __name__ == "__main__":
    main(entry)
