"""Old names of meshes, volumes, tools, meshers, colliders and tasks."""

from __future__ import annotations

from ..deprecated import Old

OLD = Old()
