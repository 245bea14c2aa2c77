"""Writes native/python/riffler/_core.pyi: what editors and type checkers know of the extension module, from the module
that this Python imports. With --check nothing is written, and the exit code is 1 where the file says something else.

    tools/stubs.py [--check]
"""

from __future__ import annotations

import difflib
import re
import sys
import tempfile
from pathlib import Path

from shell import ROOT, StepError, main, run

STUB = ROOT / "native" / "python" / "riffler" / "_core.pyi"
HEAD = "# Made by `make stubs` from the built module; not to be edited.\n"
# What is not of the interface, or differs from one build of it to the next.
FIXES = [
    (r"^__compiler__: str = .*$", "__compiler__: str"),
    (r"^__version__: str = .*$", "__version__: str"),
    (r"(?<=def __next__\(self\) -> )\.\.\.:", "Program:"),  # an iterator that is bound before what it gives
    (r"(?<=def result\(self\) -> )typing\.Any", "object"),  # riffler.Future has the type of what its call returns
    (r"^def then\(.*$", "def then(found: _Found, convert: collections.abc.Callable[[_Found], _Made]) -> _Made:"),
    (r"^import typing$", "import typing\n_Found = typing.TypeVar('_Found')\n_Made = typing.TypeVar('_Made')"),
    (r"(?<=def __eq__\(self, )\w+: \w+", "other: object"),
    (r"(: [A-Z]\w+) = None", r"\1 | None = None"),  # pointers to what may be missing
    (r"(?<=Mapping\[str, )typing\.Any", "object"),  # the generator writes object as Any
    (r"[ \t]+$", ""),
]

# The types are in pybind11's docstrings; the signatures that inspect sees (native/bindings/hints.cpp) have none. Old
# names are left out: an editor offers today's.
GENERATOR = """
import inspect, riffler
for cls in vars(riffler._core).values():
    for name, member in list(vars(cls).items()) if isinstance(cls, type) else []:
        if isinstance(member, riffler.deprecated.OldAttribute):
            delattr(cls, name)
from pybind11_stubgen import main
def refuse(function): raise TypeError
inspect.getfullargspec = refuse
main()
"""


def generate() -> str:
    with tempfile.TemporaryDirectory() as folder:
        # A C++ type in a signature, for want of a binding before it, is an error but for the one that FIXES mends.
        run(sys.executable, "-c", GENERATOR, "riffler._core", "--output-dir", folder, "--exit-code",
            "--ignore-invalid-expressions", "riffler::nc::Program")  # fmt: skip
        text = Path(folder, "riffler", "_core.pyi").read_text()
    for pattern, plain in FIXES:
        text = re.sub(pattern, plain, text, flags=re.MULTILINE)
    return HEAD + text


def entry() -> None:
    made = generate()
    if "--check" not in sys.argv[1:]:
        STUB.write_text(made)
        print(f"{STUB.relative_to(ROOT)}: {len(made.splitlines())} lines")
        return
    kept = STUB.read_text() if STUB.exists() else ""
    if made != kept:
        lines = list(
            difflib.unified_diff(kept.splitlines(), made.splitlines(), "checked in", "built", n=1, lineterm="")
        )
        raise StepError(f"{STUB.relative_to(ROOT)} is not what is built: `make stubs`\n" + "\n".join(lines[:40]))


if __name__ == "__main__":
    main(entry)
