"""Old name of the package riffler_bench, which the distribution riffler-bench has."""

import sys
import warnings

try:
    import riffler_bench
except ModuleNotFoundError as error:
    if error.name != "riffler_bench":
        raise
    raise ModuleNotFoundError(
        "riffler.bench is riffler_bench now, a package of its own: in a checkout, pip install ./bench", name=__name__
    ) from None

warnings.warn("riffler.bench is riffler_bench now", DeprecationWarning, stacklevel=2)
sys.modules[__name__] = riffler_bench
