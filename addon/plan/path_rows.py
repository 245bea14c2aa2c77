"""A row for each path of a plan, for lists: its name, length, state, and whether it is on. The plan itself stores which
paths are off (riffler.plan.Plan.off); the rows are updated when it is written."""

from collections import Counter


def update(p, plan, free):
    """Updates the rows of `p` (properties.RifflerPlanObject) from its plan; `free`: numbers of the collision-free
    paths."""
    while len(p.rows) > len(plan.paths):
        p.rows.remove(len(p.rows) - 1)
    while len(p.rows) < len(plan.paths):
        p.rows.add()
    blocked = {item.path for item in p.findings if item.kind == "blocked"}
    for k, (row, path) in enumerate(zip(p.rows, plan.paths, strict=True)):
        state = _state(k, path, plan, free, blocked)
        for key, value in (("name", f"Path {k + 1}"), ("length", path.length), ("state", state)):
            if getattr(row, key) != value:
                setattr(row, key, value)
        if row.on != (k not in plan.off):
            row.on = k not in plan.off


def _state(k, path, plan, free, blocked):
    if k in plan.off:
        return "off"
    if k in free:
        return "free"
    if k in blocked:
        return "blocked"
    return "keyed" if len(path.axes) else "unplanned"


def counts(p):
    """{state: how many paths are in it}."""
    return Counter(row.state for row in p.rows)
