"""What ``riffler bench`` runs: run time, error and memory of carving and meshing, beside rivals and a yardstick.

Every job is a module in ``jobs`` with ``run(settings, progress) -> Report`` and, where it has plots, a function of its
name in ``plots``. Times are processor time on one thread unless a table says otherwise, and are quoted as ratios to the
yardstick (a bare loop over a height map, native/bench/capsule_loop.hpp) measured in the same breath.
"""
