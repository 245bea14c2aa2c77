"""Checks the types of the Python package, its stub and the examples, as pyright's standard mode does. Settings are in
pyproject.toml; what is imported is looked up in ./.venv.

    tools/check_types.py
"""

from __future__ import annotations

from environments import types_environment
from shell import PYTHON, ROOT, StepError, main, run


def entry() -> None:
    try:
        # The project by name: a pyrightconfig.json above the checkout would come first.
        settings = ROOT / "pyproject.toml"
        run(types_environment() / "bin" / "basedpyright", "--project", settings, "--pythonpath", PYTHON)
    except StepError as failure:
        raise StepError("types do not agree: see above") from failure


if __name__ == "__main__":
    main(entry)
