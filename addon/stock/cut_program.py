"""The program of a sculpt's cuts, and the parts of the sculpt that no program can make."""

import riffler

from ..common import units


def removing(name, content):
    """The cuts of a sculpt that a machine can make: those that remove material. ValueError if there are none."""
    cuts = [c for c in content.cuts if c.mode == "remove"]
    if not cuts:
        raise ValueError(f"{name} has no cuts yet: carve it first")
    return cuts


def not_in_cuts(content):
    """Sentences on the parts of a sculpt that its `removing` cuts do not make."""
    added = sum(cut.mode != "remove" for cut in content.cuts)
    masked = sum(cut.mode == "remove" and cut.masked for cut in content.cuts)
    said = []
    if added:
        said.append(f"No machine can add material: left out {units.counted(added, 'stroke')} of Add")
    if masked:
        said.append(f"Cuts made with a mask: {masked}. They also cut what it protected")
    if content.shaped:
        said.append("The file has cuts only: no crop, smoothing or relief, and no edits of the mesh")
    return said


def of_cuts(name, cuts, volume, feed, spindle):
    """The program of these cuts of a sculpt, in its own frame."""
    return riffler.Program.from_cl(
        [c.poses for c in cuts],
        tools=[riffler.Tool.from_dict(c.tool) for c in cuts],
        feed=feed,
        spindle=spindle,
        # retracts clear the stock before the first cut
        occupied=(volume.lower, volume.upper),
        provenance={"stock": name},
    )
