"""Checks the types of the Python package, its stub and the examples, as pyright's standard mode does. Settings are in
pyproject.toml; what is imported is looked up in ./.venv.

    tools/check_types.py

Takes 25 s of processor time. What agreed once is not checked again: the user's cache folder remembers a digest of all
that the answer depends on.
"""

from __future__ import annotations

from pathlib import Path

from compiler_cache import user_caches
from environments import REQUIREMENTS, types_environment
from shell import PYTHON, ROOT, StepError, digest, main, run

CHECKED = ("native/python/riffler", "examples")  # as pyproject.toml includes them


def question() -> str:
    """Digest of the sources, the settings, the checker, and the names with versions of the packages in ./.venv, which
    are pinned. Riffler's own are left out: their sources are checked."""
    sources = [path for folder in CHECKED for path in (ROOT / folder).rglob("*.py*") if path.suffix in {".py", ".pyi"}]
    own = [ROOT / "pyproject.toml", REQUIREMENTS / "types.txt", Path(__file__).resolve()]
    packages = {path.name for path in (PYTHON.parents[1] / "lib").glob("python*/site-packages/*.dist-info")}
    return digest([*sources, *own], *sorted(name for name in packages if not name.startswith("riffler")))


def entry() -> None:
    environment = types_environment()
    agreed = user_caches() / "riffler" / "types" / question()
    if agreed.exists():
        print("types: these sources were checked before, and agreed")
        return
    try:
        # The project by name: a pyrightconfig.json above the checkout would come first.
        settings = ROOT / "pyproject.toml"
        run(environment / "bin" / "basedpyright", "--project", settings, "--pythonpath", PYTHON)
    except StepError as failure:
        raise StepError("types do not agree: see above") from failure
    remember(agreed)


def remember(agreed: Path) -> None:
    """Without a folder for caches, the next run checks again."""
    try:
        agreed.parent.mkdir(parents=True, exist_ok=True)
        agreed.touch()
    except OSError as error:
        print(f"types: not remembered, {agreed.parent}: {error.strerror}")


if __name__ == "__main__":
    main(entry)
