"""Base class of strategies. The command line and Blender read their parameters from it."""

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

    Parameters
    ----------
    key : str
        Name of the argument.
    label, help : str
        Label and description for users.
    default : float, int, str or None
        None if omitting it has a meaning, which ``help`` states; a panel then shows 0.
    unit : str
        "mm", "rad" (degrees on the command line and in panels), or "" for a whole number.
    low, high : float
        Range of the field. If ``low`` is 0 or more, a given value must be positive.
    choices : tuple
        (value, label, help) of each choice, if the value is a word.

    Examples
    --------
    >>> riffler.plan.Parameter("reach", "Reach", "Largest distance from the part, in mm", 10.0, low=1e-3).unit
    'mm'
    """

    key: str
    label: str
    help: str
    default: float | str | None
    unit: str = "mm"
    low: float = 0.0
    high: float = 1e5
    choices: tuple[tuple[str, str, str], ...] = ()


@dataclass(frozen=True)
class Found:
    """Result of a strategy: see `find`.

    Attributes
    ----------
    plan : Plan
        The paths.
    reason : str
        Why the plan has no paths; empty if it has some.
    notes : list of str
        Further notes for the user, as sentences.
    """

    plan: Plan
    reason: str = ""
    notes: list[str] = field(default_factory=list)


class Strategy(ABC):
    """A method of finding paths: see `find`.

    A module of this package defines one and lists it in STRATEGIES; ``riffler plan``, the panel of the Blender
    extension and ``riffler.plan.find`` read the table of all strategies (strategies/__init__.py).
    """

    id: ClassVar[str] = ""  # its name in commands and scripts
    place: ClassVar[int] = 0  # position in lists: the smallest first
    label: ClassVar[str] = ""
    action: ClassVar[str] = ""  # text of its button
    description: ClassVar[str] = ""
    summary: ClassVar[str] = ""  # help of the command; begins with a verb
    nothing: ClassVar[str] = "path"  # noun for messages such as "no path found"
    needs: ClassVar[str] = "part"  # in addition to part and tool: "curves", "paths" of a plan, or "part" for nothing
    missing: ClassVar[str] = ""  # what to do in Blender if curves or paths are missing
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
        """Plans, for `find`.

        Parameters
        ----------
        part_mesh : Mesh
            The part.
        tool : Tool
            The cutter.
        given : list
            The curves, (n, 3) arrays in mm, or the paths.
        options : dict
            Every parameter except those that are None.
        progress : callable, optional
            Called with the finished share; returning False cancels.

        Raises
        ------
        ValueError
            Naming the faulty argument. See `find`.

        Examples
        --------
        >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
        >>> pencil = riffler.plan.STRATEGIES["pencil"]
        >>> found = pencil.run(part, riffler.Tool.ball(diameter=4, length=20), [], pencil.options({}))
        >>> len(found.plan.paths)
        1
        """

    def check(self, tool: Tool, given: Sequence[Any]) -> None:  # noqa: B027
        """Raises ValueError for a tool that the strategy cannot use, at once instead of in a long run. See `find`.

        Parameters
        ----------
        tool : Tool
            The cutter.
        given : list
            As for ``run``.

        Examples
        --------
        >>> riffler.plan.STRATEGIES["engrave"].check(riffler.Tool.ball(diameter=1, length=10), [])
        """

    def options(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """The given parameters and the defaults of the others, without those that are None.

        Parameters
        ----------
        given : dict
            Parameters by name.

        Returns
        -------
        dict

        Raises
        ------
        ValueError
            For unknown parameters, and for words that are not among the choices.

        Examples
        --------
        >>> riffler.plan.STRATEGIES["pencil"].options({"passes": 3})
        {'tolerance': 0.01, 'passes': 3}
        """
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
