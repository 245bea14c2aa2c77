"""The old names of the Python API, one module per topic."""

from __future__ import annotations

from ..deprecated import Old
from . import geometry, programs

ALL: Old = geometry.OLD.merged(programs.OLD)
