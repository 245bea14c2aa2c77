"""Old name of the package riffler_bench, which the distribution riffler-bench contains."""

import sys
import warnings

try:
    import riffler_bench
except ModuleNotFoundError as error:
    if error.name != "riffler_bench":
        raise
    raise ModuleNotFoundError(
        "riffler.bench is now the package riffler_bench; in a checkout, pip install ./bench installs it", name=__name__
    ) from None

warnings.warn("riffler.bench is riffler_bench now", DeprecationWarning, stacklevel=2)
sys.modules[__name__] = riffler_bench
