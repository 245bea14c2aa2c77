"""Counts words that make comments, docstrings, messages and documents hard to read. A file may have as many as
tools/words_allowed.txt lists, and none if the list does not name it. Counts may only shrink.

    tools/check_words.py                   fails where a file has more of them than allowed, or fewer: shrink the list
    tools/check_words.py --update          shrinks the list, and removes an empty one; refuses to let it grow
    tools/check_words.py --show [PATH ...] prints each one: file, line, what to write instead

What to write: name the thing, then say what it does; active voice, present tense, one idea a sentence.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from shell import ROOT, StepError, git, main

ALLOWED = ROOT / "tools" / "words_allowed.txt"
# Each pattern to find, and the words to write instead.
WORDS = {
    r"(?:^|(?<=[.:!?] ))Of (?!course)": "the subject first: 'Of the moves that …' -> 'Moves that …'",
    r"\banew\b": "again",
    r"\b(?:who|what|which|when|where)ever\b": "the component or the user by name",
    r"\b(?:nobody|somebody)\b": "no caller, no user, another thread …",
    r"\bwho (?:asks|waits|wants|needs|goes|reads|writes|calls|looks)\b": "the component by name, or 'to …'",
    r"\b(?:told|untold)\b": "given, passed, reported, known",
    r"\b(?:is|are|was|were|be|been|not) said\b": "reported, stated",
    r"\bwhat of\b": "the part that",
    r"\bas (?:it is|they are)\b": "unchanged",
    r"\ba shade\b": "slightly",
    r"\bgo(?:es)? on\b": "continues",
    r"\bbesides?\b": "next to, compared with, at the same time as, also",
    r"(?<!same )(?<!one )(?<!two )(?<!all the )(?<!half )(?<!by )\bways?\b(?! out\b)": "path, distance, method …",
}
PATTERN = re.compile("|".join(f"({pattern})" for pattern in WORDS), re.MULTILINE)
ADVICE = tuple(WORDS.values())
# Third-party texts, generated files, and the files of this check.
EXEMPT = re.compile(r"tools/(tests/test_)?check_words\.py|third_party/.*|LICENSE.*|.*\.pyi|docs/operators\.md")
C_TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)
# Comments and strings as Python's tokenizer finds them, in a fifth of its time. A string's prefix is a group.
PYTHON_TOKEN = re.compile(
    r"#[^\n]*|([a-zA-Z]{0,2})("
    r'"""(?:\\.|[^\\])*?"""' + r"|'''(?:\\.|[^\\])*?'''" + r'|"(?:\\.|[^"\\\n])*"' + r"|'(?:\\.|[^'\\\n])*')",
    re.DOTALL,
)
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Hit:
    path: str
    line: int
    word: str
    advice: str


def tracked() -> list[str]:
    """Every file of the project: tracked files, and new ones that are not ignored."""
    names = git("ls-files", "--cached", "--others", "--exclude-standard").splitlines()
    return [name for name in names if (ROOT / name).is_file()]


def blank(text: str) -> str:
    """The same number of empty lines, so that line numbers agree."""
    return re.sub(r"[^\n]", " ", text)


def without_code(text: str) -> str:
    """The same text with spaces between backticks, because names are not prose."""
    return re.sub(r"`[^`\n]*`", lambda m: "`" + " " * (len(m[0]) - 2) + "`", text)


def prose_of_markdown(text: str) -> Iterator[tuple[int, str]]:
    yield 1, FENCE.sub(lambda m: blank(m[0]), text)


def joined(comments: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Joins comments on consecutive lines, because a sentence may span lines."""
    start, lines = 0, []
    for line, comment in comments:
        if lines and line != start + len(lines):
            yield start, "\n".join(lines)
            lines = []
        start = start if lines else line
        lines.append(comment)
    if lines:
        yield start, "\n".join(lines)


def prose_of_c(text: str) -> Iterator[tuple[int, str]]:
    """Comments, and string literals with a space."""
    tokens = [(text.count("\n", 0, match.start()) + 1, match[0]) for match in C_TOKEN.finditer(text)]
    yield from joined((line, token.lstrip("/!< ")) for line, token in tokens if token.startswith("//"))
    for line, token in tokens:
        if token.startswith("/*") or (token[0] == '"' and " " in token):
            yield line, token.strip('"')


def prose_of_python(text: str) -> Iterator[tuple[int, str]]:
    """Comments, and string literals with a space, docstrings included."""
    tokens = [(text.count("\n", 0, match.start()) + 1, match) for match in PYTHON_TOKEN.finditer(text)]
    yield from joined((line, match[0].lstrip("# ")) for line, match in tokens if match[2] is None)
    for line, match in tokens:
        if match[2] is not None and " " in match[2]:
            literal = re.sub(r"^(?:\"\"\"|'''|\"|')", "", match[2])
            yield line, re.sub(r"\{[^{}]*\}", "{}", literal) if "f" in match[1].lower() else literal


PROSE = {".md": prose_of_markdown, ".py": prose_of_python} | dict.fromkeys((".c", ".h", ".cpp", ".hpp"), prose_of_c)


def hits_in(path: str, text: str) -> Iterator[Hit]:
    for first, prose in PROSE[Path(path).suffix](text):
        # One space for each line break, so that a sentence's start is seen across lines.
        flat = without_code(prose.replace("\n", " ") if not path.endswith(".md") else prose)
        for match in PATTERN.finditer(flat):
            yield Hit(path, first + prose.count("\n", 0, match.start()), match[0].strip(), ADVICE[match.lastindex - 1])


def hits(paths: list[str]) -> list[Hit]:
    return [hit for path in paths for hit in hits_in(path, (ROOT / path).read_text())]


def checked(names: list[str]) -> list[str]:
    """The project's files with prose in the named folders, or everywhere."""
    return sorted(
        name
        for name in tracked()
        if Path(name).suffix in PROSE
        and not EXEMPT.fullmatch(name)
        and (not names or any(name == n or name.startswith(n.rstrip("/") + "/") for n in names))
    )


def read_allowed() -> dict[str, int]:
    lines = ALLOWED.read_text().splitlines() if ALLOWED.exists() else []
    return {path: int(count) for count, path in (line.split(maxsplit=1) for line in lines if line)}


def counts(found: list[Hit]) -> dict[str, int]:
    result: dict[str, int] = {}
    for hit in found:
        result[hit.path] = result.get(hit.path, 0) + 1
    return result


def problems(found: list[Hit], allowed: dict[str, int]) -> list[str]:
    """Reasons why the check fails. For a file with more words than allowed, lists all of them."""
    result = []
    now = counts(found)
    for path in sorted(now.keys() | allowed.keys()):
        have, may = now.get(path, 0), allowed.get(path, 0)
        if have > may:
            result += [f"{h.path}:{h.line}: {h.word!r}: {h.advice}" for h in found if h.path == path]
            result.append(f"{path}: {have} words of the list, {may} allowed")
        elif have < may:
            result.append(f"{path}: {have} words of the list, {may} allowed: tools/check_words.py --update")
    return result


def update(found: list[Hit], allowed: dict[str, int]) -> None:
    now = counts(found)
    if grown := [path for path, count in now.items() if count > allowed.get(path, 0)]:
        raise StepError("the list may only shrink; more words than allowed in " + ", ".join(sorted(grown)))
    if now:
        ALLOWED.write_text("".join(f"{count} {path}\n" for path, count in sorted(now.items())))
    else:
        ALLOWED.unlink(missing_ok=True)


def entry() -> None:
    match sys.argv[1:]:
        case ["--show", *names]:
            for hit in hits(checked(names)):
                print(f"{hit.path}:{hit.line}: {hit.word!r}: {hit.advice}")
        case ["--update"]:
            update(hits(checked([])), read_allowed())
        case []:
            found = hits(checked([]))
            if wrong := problems(found, read_allowed()):
                raise StepError("\n".join(wrong))
            print(f"{len(found)} words of the list are left in the project's text")
        case _:
            raise StepError("usage: check_words.py [--update | --show [PATH ...]]")


if __name__ == "__main__":
    main(entry)
