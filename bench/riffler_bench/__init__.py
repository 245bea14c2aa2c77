"""What ``riffler bench`` runs: run time, error and memory of carving and meshing, against rivals and a yardstick.

Every job is a module in ``jobs`` with ``run(settings, progress) -> Report`` and, where it has plots, a function of its
name in ``plots``. Times are processor time on one thread unless a table says otherwise, and are quoted as ratios to the
yardstick (a bare loop over a height map, native/bench/capsule_loop.hpp) measured in the same breath.

The package is a distribution of its own, ``riffler-bench``, and needs the ``riffler`` of its version: its compiled
module reads the objects of that one.
"""

from riffler import __version__ as _installed

from ._bench import __version__

if __version__ != _installed:
    raise ImportError(
        f"riffler-bench {__version__} needs riffler {__version__}, not {_installed}: install both from the same source",
        name=__name__,
    )
