"""Lists the tests by what they cost: their processor time, which other work on the computer hardly changes."""

import json
import os
import time
from collections import Counter
from pathlib import Path

import pytest

try:
    import resource
except ImportError:  # Windows
    resource = None

COSTLIEST = 30
MARK = "processor"
SPENT = pytest.StashKey[float]()


def processor_time():
    """Seconds of all threads of this process and of its ended children."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN) if resource else None
    return time.process_time() + (children.ru_utime + children.ru_stime if children else 0.0)


def measured(item):
    before = processor_time()
    try:
        return (yield)
    finally:
        item.stash[SPENT] = processor_time() - before


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item):
    return (yield from measured(item))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    return (yield from measured(item))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item):
    return (yield from measured(item))


def pytest_runtest_makereport(item, call):
    """Properties reach the process that collects the reports of several."""
    item.user_properties[:] = [(key, value) for key, value in item.user_properties if key != MARK]
    item.user_properties.append((MARK, item.stash.get(SPENT, 0.0)))


def pytest_collection_modifyitems(config, items):
    """Leaves out the tests that the file RIFFLER_TESTS_LEFT_OUT names: tools/costs.py."""
    if named := os.environ.get("RIFFLER_TESTS_LEFT_OUT"):
        names = set(json.loads(Path(named).read_text()))
        left = [item for item in items if item.nodeid in names]
        items[:] = [item for item in items if item.nodeid not in names]
        config.hook.pytest_deselected(items=left)


def pytest_terminal_summary(terminalreporter):
    spent = Counter()
    for reports in terminalreporter.stats.values():
        for report in reports:
            if isinstance(report, pytest.TestReport):
                spent[report.nodeid, report.when] += dict(report.user_properties).get(MARK, 0.0)
    if not spent:
        return
    tests, files = Counter(), Counter()
    for (name, _), seconds in spent.items():
        tests[name] += seconds
        files[name.split("::")[0]] += seconds
    if costs := os.environ.get("RIFFLER_TEST_COSTS"):
        Path(costs).write_text(json.dumps(tests, indent=0) + "\n")
    terminalreporter.section(
        f"the costliest of {len({n for n, _ in spent})} tests, {sum(spent.values()):.0f} s of processor time"
    )
    for (name, when), seconds in spent.most_common(COSTLIEST):
        if seconds >= 1:
            terminalreporter.line(f"{seconds:8.2f} s {when:8} {name}")
    terminalreporter.section("the costliest files")
    for name, seconds in files.most_common(COSTLIEST):
        if seconds >= 1:
            terminalreporter.line(f"{seconds:8.2f} s {name}")
