"""Checks the messages of the commits since the one that BEFORE names: "area: Imperative sentence", at most 72
characters without a full stop; an empty line; a body that says why. Merges need no body.

    tools/check_commits.py
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from shell import StepError, git, main

BEFORE = "c41c9cfe093d"  # older messages stay unchanged
LENGTH = 72
SUBJECT = re.compile(r"[a-z][a-z0-9 _/,.-]*: (?P<verb>[A-Z][\w-]*)(?: .*)?")
NOT_IMPERATIVE = re.compile(r"[A-Z][a-z]+(?:ing|ed)")
IMPERATIVE = {"Bring", "Embed", "Feed", "Need", "Seed", "Shed", "Speed", "String", "Proceed", "Exceed"}


def faults(message: str, merge: bool = False) -> Iterator[str]:
    """What is wrong with a message, in plain words."""
    subject, _, rest = message.strip("\n").partition("\n")
    match = SUBJECT.fullmatch(subject)
    if len(subject) > LENGTH:
        yield f"the subject has {len(subject)} characters; at most {LENGTH}"
    if merge:
        return
    if not match:
        yield "the subject must read 'area: Imperative sentence'"
    elif NOT_IMPERATIVE.fullmatch(match["verb"]) and match["verb"] not in IMPERATIVE:
        yield f"{match['verb']!r} is not an imperative: write what the commit does as an order"
    if subject.endswith("."):
        yield "the subject ends without a full stop"
    if not rest.startswith("\n") or not rest.strip():
        yield "an empty line and a body that says why are missing"


def commits() -> Iterator[tuple[str, bool, str]]:
    """Short name, whether it is a merge, and message of every commit since BEFORE."""
    fields = git("log", "-z", "--format=%h%x00%p%x00%B", f"{BEFORE}..HEAD").split("\0")
    for name, parents, message in zip(fields[0::3], fields[1::3], fields[2::3], strict=False):
        yield name, " " in parents, message


def entry() -> None:
    try:
        git("cat-file", "-e", f"{BEFORE}^{{commit}}")
    except StepError:
        print(f"commit messages: not checked, this checkout's history does not reach back to {BEFORE}")
        return
    checked = list(commits())
    wrong = [f"{name}: {fault}" for name, merge, message in checked for fault in faults(message, merge)]
    if wrong:
        raise StepError("commit messages:\n" + "\n".join(wrong))
    print(f"commit messages: {len(checked)} checked")


if __name__ == "__main__":
    main(entry)
