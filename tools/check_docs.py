"""Checks the Markdown documents: relative links and anchors lead somewhere, every picture of docs/images is shown,
Python examples and `riffler` command lines run. All ```python blocks of a document run as one script, then the lines of
its ```sh blocks that start with `riffler`, in an empty folder. A block under the line `<!-- not run: reason -->` is
left out, and the reason printed; Blender's run in blender_tests/headless/test_documents.py. A block under the line
`<!-- file: path -->` is a part of that file, word for word: its tests run it.

    tools/check_docs.py [FILE ...]
"""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import traceback
from dataclasses import dataclass, field
from pathlib import Path

from shell import PYTHON, ROOT, main, tool_environment

LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
FENCE = re.compile(r"^(\s*)(```+|~~~+)\s*(\w*)")
NOT_RUN = re.compile(r"<!--\s*not run:\s*(.+?)\s*-->")
QUOTED = re.compile(r"<!--\s*file:\s*(\S+)\s*-->")
CODE = re.compile(r"`[^`]*`")
SECONDS = 300


@dataclass
class Document:
    """A Markdown file taken apart."""

    path: Path
    links: list[tuple[int, str]] = field(default_factory=list)
    anchors: set[str] = field(default_factory=set)
    python: list[str] = field(default_factory=list)  # as many lines as the file has, so that line numbers agree
    commands: list[tuple[int, str]] = field(default_factory=list)
    blocks: int = 0
    skipped: list[tuple[int, str]] = field(default_factory=list)
    quotes: list[tuple[int, str, list[str]]] = field(default_factory=list)  # line, file, what is quoted of it

    @property
    def name(self) -> str:
        return str(self.path.relative_to(ROOT))


def slug(heading: str) -> str:
    """The anchor that GitHub gives a heading."""
    text = re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading.strip().lower())
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def read(path: Path) -> Document:
    document = Document(path)
    fence = language = None
    quote: list[str] | None = None
    previous = ""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        document.python.append("")
        match = FENCE.match(line)
        if fence is None and match:
            fence, language = match[2], match[3]
            if above := NOT_RUN.search(previous):
                document.skipped.append((number, above[1]))
                language = None
            if above := QUOTED.search(previous):
                quote = []
                document.quotes.append((number, above[1], quote))
            document.blocks += language == "python"
        elif fence is not None and match and match[2].startswith(fence) and not match[3]:
            fence = language = quote = None
        elif fence is not None:
            if quote is not None:
                quote.append(line)
            if language == "python":
                document.python[-1] = line
            elif language == "sh" and line.startswith("riffler "):
                document.commands.append((number, line))
        else:
            if line.startswith("#"):
                document.anchors.add(slug(line.lstrip("#")))
            document.links += ((number, target) for target in LINK.findall(CODE.sub("", line)))
        previous = line
    return document


def link_problems(document: Document, documents: dict[Path, Document]) -> list[str]:
    problems = []
    for number, target in document.links:
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        path = (document.path.parent / name).resolve() if name else document.path
        if not path.exists():
            problems.append(f"{document.name}:{number}: {target}: no such file")
        elif anchor and path in documents and anchor not in documents[path].anchors:
            problems.append(f"{document.name}:{number}: {target}: no such heading")
    return problems


def quote_problems(document: Document) -> list[str]:
    problems = []
    for number, name, lines in document.quotes:
        path = ROOT / name
        if not path.is_file():
            problems.append(f"{document.name}:{number}: {name}: no such file")
        elif "\n" + "\n".join(lines) + "\n" not in "\n" + path.read_text():
            problems.append(f"{document.name}:{number}: this is not what stands in {name}")
    return problems


def picture_problems(documents: dict[Path, Document]) -> list[str]:
    shown = {(d.path.parent / target).resolve() for d in documents.values() for _, target in d.links}
    pictures = sorted(f for f in (ROOT / "docs" / "images").rglob("*") if f.is_file())
    return [f"{path.relative_to(ROOT)}: no document shows it" for path in pictures if path not in shown]


def run_command(line: str, folder: str) -> tuple[int, str]:
    """Runs a command line of riffler in a child of this process, which has imported riffler: starting one that imports
    it takes 0.2 s. Returns its exit code, and what it printed."""
    from riffler import cli

    sys.stdout.flush()
    with tempfile.TemporaryFile("w+") as printed:
        child = os.fork()
        if child == 0:
            status = 1
            try:
                signal.alarm(SECONDS)  # ends the child
                os.chdir(folder)
                os.dup2(printed.fileno(), 1), os.dup2(printed.fileno(), 2)
                sys.stdout, sys.stderr = (os.fdopen(fd, "w", buffering=1, closefd=False) for fd in (1, 2))
                os.environ |= tool_environment()
                status = cli.main(shlex.split(line)[1:])
            except SystemExit as end:
                status = end.code if isinstance(end.code, int) else end.code is not None
            except BaseException:
                traceback.print_exc()
            finally:
                sys.stdout.flush(), sys.stderr.flush()
                os._exit(status)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        printed.seek(0)
        return code, printed.read()


def run_script(name: str, folder: str) -> tuple[int, str]:
    done = subprocess.run([PYTHON, name], cwd=folder, env=tool_environment(), timeout=SECONDS, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)  # fmt: skip
    return done.returncode, done.stdout


def example_problems(document: Document) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        steps = []
        if document.blocks:
            script = Path(folder, document.path.name + ".py")
            script.write_text("\n".join(document.python))
            steps.append((f"{document.name}: its Python examples", run_script, script.name))
        steps += ((f"{document.name}:{number}: {line}", run_command, line) for number, line in document.commands)
        for what, run, argument in steps:
            code, printed = run(argument, folder)
            if code != 0:
                return [f"{what}: exit code {code}\n{printed}"]
    return []


def entry() -> None:
    every = [ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")]
    every += (path for folder in ("docs", "addon", "device", "examples") for path in (ROOT / folder).rglob("*.md"))
    documents = {path: read(path) for path in sorted(every)}
    wanted = [Path(name).resolve() for name in sys.argv[1:]] or list(documents)
    problems = [] if sys.argv[1:] else picture_problems(documents)
    for path in wanted:
        document = documents[path]
        problems += link_problems(document, documents) + quote_problems(document) + example_problems(document)
        for number, reason in document.skipped:
            print(f"{document.name}:{number}: not run: {reason}")
    print("\n".join(problems))
    chosen = [documents[path] for path in wanted]
    print(
        f"docs: {len(chosen)} documents, {sum(len(d.links) for d in chosen)} links, "
        f"{sum(d.blocks for d in chosen)} Python examples, {sum(len(d.commands) for d in chosen)} command lines, "
        f"{sum(len(d.quotes) for d in chosen)} quoted files: "
        + (f"{len(problems)} PROBLEMS" if problems else "all right")
    )
    sys.exit(bool(problems))


if __name__ == "__main__":
    main(entry)
