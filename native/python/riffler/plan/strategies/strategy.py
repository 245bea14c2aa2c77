"""What a strategy is. Command line and Blender read its parameters from here."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from ..._core import Mesh, Tool
from ...arguments import Progress
from ..model import Plan


@dataclass(frozen=True)
class Parameter:
    """One setting of a strategy: an option of the command line, a field of a panel.

    ``key``: its name as an argument. ``default``: None where leaving it out means something, which ``help`` says; a
    panel shows 0 then. ``unit``: ``"mm"``, ``"rad"`` (degrees on the command line and in panels), or ``""`` for a whole
    number. ``low``, ``high``: what a field can be set to; with ``low`` from 0 on a value that is given must be
    positive. ``choices``: (value, label, help) of each, for a word.
    """

    key: str
    label: str
    help: str
    default: Any
    unit: str = "mm"
    low: float = 0.0
    high: float = 1e5
    choices: tuple[tuple[str, str, str], ...] = ()


@dataclass(frozen=True)
class Found:
    """What a strategy has found.

    Attributes
    ----------
    plan : Plan
        The paths.
    reason : str
        Why it has no paths; empty where it has some.
    notes : list of str
        What else the user should know, as sentences.
    """

    plan: Plan
    reason: str = ""
    notes: list[str] = field(default_factory=list)


class Strategy(ABC):
    """How paths come about. A module of this package defines one and lists it in STRATEGIES; ``riffler plan``, the
    panel of the Blender extension and ``riffler.plan.find`` read the table of them all (strategies/__init__.py)."""

    id: ClassVar[str] = ""  # its name in commands and scripts
    place: ClassVar[int] = 0  # in lists: the smallest first
    label: ClassVar[str] = ""
    action: ClassVar[str] = ""  # what its button says
    description: ClassVar[str] = ""
    summary: ClassVar[str] = ""  # of the command, a verb in front
    nothing: ClassVar[str] = "path"  # what there is none of, where nothing was found
    needs: ClassVar[str] = "part"  # beside part and tool: "curves", "paths" of a plan, or "part" for nothing
    missing: ClassVar[str] = ""  # what to do in Blender where curves or paths are missing
    parameters: ClassVar[tuple[Parameter, ...]] = ()

    @abstractmethod
    def run(
        self,
        part_mesh: Mesh,
        tool: Tool,
        given: Sequence[Any],
        options: Mapping[str, Any],
        progress: Progress = None,
    ) -> Found:
        """``given``: the curves, (n, 3) arrays in mm, or the paths. ``options`` has every parameter but those that are
        None. ValueError for bad input, naming it."""

    def check(self, tool: Tool, given: Sequence[Any]) -> None:  # noqa: B027
        """ValueError for a tool that it cannot do with: known at once, before a long run."""

    def options(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """All parameters with their defaults, without those that are None. ValueError for unknown ones and for words
        that are none of the choices."""
        known = {p.key: p for p in self.parameters}
        if strange := [key for key in given if key not in known]:
            raise ValueError(f"{strange[0]}: {self.id} has {', '.join(known)}")
        out = {key: p.default for key, p in known.items()} | dict(given)
        for key, p in known.items():
            words = [value for value, _, _ in p.choices]
            if words and out[key] not in words:
                raise ValueError(f"{key} must be one of {', '.join(words)}, not {out[key]!r}")
        return {key: value for key, value in out.items() if value is not None}


def share_of(progress: Progress, k: int, n: int) -> Progress:
    """The progress of piece ``k`` of ``n``."""
    return None if progress is None else lambda share: progress((k + share) / n)
