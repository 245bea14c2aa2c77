"""What docs/connect-a-pen.md promises of force is what preferences, core and the simulated pen do."""

import ast
import re
import time
from pathlib import Path

import numpy as np
import pytest
import riffler

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "connect-a-pen.md").read_text()
LIMITS = (ROOT / "native/include/riffler/haptics/limits.hpp").read_text()
RAMP = 0.5  # s, as the page says


def told(label):
    """The default of a limit in the page's table."""
    row = re.search(rf"^\| \*{re.escape(label)}\* \|(.*)\|$", PAGE, re.MULTILINE)[1]
    return float(re.search(r"default,? (\d+)", row)[1])


def preference(name):
    """(label, default) of a number in the add-on's preferences."""
    module = ast.parse((ROOT / "addon" / "preferences.py").read_text())
    fields = (node for node in ast.walk(module) if isinstance(node, ast.AnnAssign) and node.target.id == name)
    given = {k.arg: ast.literal_eval(k.value) for k in next(fields).annotation.keywords}
    return given["name"], given["default"]


@pytest.mark.parametrize("name", ["force", "torque", "power"])
def test_a_limit_s_default_is_that_of_the_preferences(name):
    label, default = preference(name)
    assert told(label) == default


def test_the_core_s_own_limits_are_the_same():
    force, torque = re.search(r"Bounds wrench\{(\d+), (\d+)\}", LIMITS).groups()
    power = re.search(r"double power = ([\d']+);", LIMITS)[1].replace("'", "")
    assert (float(force), float(torque), float(power) / 1000) == tuple(
        preference(n)[1] for n in ("force", "torque", "power")
    )


def test_force_rises_over_half_a_second():
    """By the pushing side's clock: never more than the ramp has let through by then, and all of it in the end."""
    assert "Force comes in over half a second" in PAGE
    asked, rows = 1.0, []
    with riffler.pen.open("simulated") as device:
        end = time.monotonic() + 20
        while not device.state().homed and time.monotonic() < end:
            time.sleep(0.01)
        device.aim(device.geometry.forward([device.geometry.home])[0])
        time.sleep(0.5)
        begin = time.monotonic()
        while (not rows or rows[-1][1] < 0.9 * asked) and time.monotonic() < begin + 20:
            device.push([0.0, 0.0, asked])
            applied = float(np.linalg.norm(device.state().applied[:3]))
            rows.append((time.monotonic() - begin, applied))
            time.sleep(0.005)
    seconds, force = np.array(rows).T
    assert force[-1] >= 0.9 * asked, "it never came in"
    assert (force <= asked * seconds / RAMP + 0.02).all()
