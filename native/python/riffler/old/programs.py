"""Old names of programs, machines, verification, planning, journals, sessions and pens."""

from __future__ import annotations

from ..deprecated import Old

OLD = Old(
    attributes={
        "SessionFrame": {"untold": "dropped_ticks"},
    },
)
