"""Pencil cuts: where a ball touches a part at two places at once."""

from ... import _core
from ..file import Plan
from .strategy import Found, Parameter, Strategy


class PencilPaths(list):
    """A list of ``PencilPath``; what was done to find them stands beside it.

    ``ends``: a pair for each path, ``"part"``, ``"corner"``, ``"faded"``, ``"loop"``, ``"cut"``, ``"joined"`` where
    another path continues or, for passes beside a valley, ``"pass"``; ``rest_area``: mm² that the tool's ball cannot
    reach; ``rest_areas``: (k,) the same for each triangle; ``reference_area``, ``reference_areas``: the same for the
    ball of ``reference_tool`` (or of ``overthickness``), what there is to be machined; without one those of the tool;
    ``stats``: counters; ``reason``: why there are no paths, empty where there are some.
    """

    def __init__(self, found):
        super().__init__(found["paths"])
        self.ends = found["ends"]
        self.rest_area = found["rest_area"]
        self.rest_areas = found["rest_areas"]
        self.reference_area = found["reference_area"]
        self.reference_areas = found["reference_areas"]
        self.stats = found["stats"]
        self.reason = found["reason"]


def pencil(
    part_mesh,
    tool,
    tolerance=0.01,
    passes=1,
    progress=None,
    *,
    bitangency_angle=None,
    minimum_length=0.0,
    stepover=None,
    scallop=None,
    overthickness=0.0,
    reference_tool=None,
):
    """The valleys of ``part_mesh`` for the ball at the tool's tip, as ``PencilPaths``.

    The curves of ball centres along which the ball touches the part at two places at once and enters it nowhere. A
    valley counts where the ball's gap to its bottom exceeds ``tolerance`` (mm), to which the curves are traced; if
    ``bitangency_angle`` (rad) is given, instead where the directions to both contacts differ by at least that. Paths
    shorter than ``minimum_length`` (mm) are dropped.

    With ``passes`` above 1 each valley is followed by passes - 1 curves on either side, ``stepover`` (mm) apart or as
    far as leaves ridges of ``scallop`` (mm; the tolerance, if neither is given) on a plane; there both contacts are the
    one point that the ball touches.

    ``overthickness`` (mm) adds what a ball whose radius is larger by that much leaves behind: its valleys, with the
    tool's ball laid into them, where that has none of its own, as in blends of its own radius or a larger one.
    ``reference_tool``, a larger one that has been there before, does the same for what its ball could not reach: rest
    machining, corners included.

    ``progress`` is called with the finished share and cancels by returning False. ValueError for an empty mesh, for
    sizes that are not positive and finite, and for a tool or reference tool whose tip is no ball.
    """
    if stepover is not None and scallop is not None:
        raise ValueError("stepover and scallop: only one of them")
    radius = _core.tip_ball_radius(tool, "tool")
    if scallop is not None:
        if not 0 < scallop <= radius:
            raise ValueError(f"scallop must be positive and at most the ball's radius, not {scallop}")
        stepover = _core.stepover_of_scallop(radius, scallop)
    if reference_tool is not None:
        larger = _core.tip_ball_radius(reference_tool, "reference_tool")
        if larger <= radius:
            raise ValueError(f"reference_tool must have a ball larger than {2 * radius:g} mm, not {2 * larger:g}")
        overthickness = max(overthickness, larger - radius)
    found = _core.pencil(
        part_mesh,
        tool,
        tolerance=tolerance,
        bitangency_angle=bitangency_angle,
        minimum_length=minimum_length,
        passes=passes,
        stepover=stepover,
        overthickness=overthickness,
        progress=progress,
    )
    return _core.then(found, PencilPaths)


class Pencil(Strategy):
    id, place, label, action = "pencil", 10, "Pencil Cuts", "Find Pencil Cuts"
    description = "Valleys of the part that a ball of the cutter's diameter touches on both sides"
    summary = "find the valleys that a ball touches on both sides"
    nothing = "pencil cut"
    parameters = (
        Parameter(
            "tolerance",
            "Tolerance",
            "Of the paths, in mm; a valley that is no deeper below the ball is taken for a faceted one",
            0.01,
            low=1e-4,
            high=10.0,
        ),
        Parameter("minimum_length", "Shortest", "Paths that are shorter are left out, in mm", None),
        Parameter(
            "passes",
            "Passes",
            "1: along each valley only; each one more adds a path on either side of it",
            1,
            "",
            low=1,
            high=100,
        ),
        Parameter("stepover", "Stepover", "Between two passes, in mm; 0: what leaves ridges of the tolerance", None),
    )

    def check(self, tool, given):
        _core.tip_ball_radius(tool, "tool")

    def run(self, part_mesh, tool, given, options, progress=None):
        paths = pencil(part_mesh, tool, progress=progress, **options)
        return Found(Plan(list(paths), tool, tolerance=options["tolerance"]), reason=getattr(paths, "reason", ""))


STRATEGIES = (Pencil(),)
