"""JSON from a .blend or a file, which may contain anything."""

from __future__ import annotations

import json
from typing import Any


def loads(text: str | bytes | memoryview, what: str) -> dict[str, Any]:
    """The object in the text. ValueError, which begins with `what`, if the text is not an object, or is nested
    too deeply."""
    try:
        found = json.loads(bytes(text) if isinstance(text, memoryview) else text)
    except RecursionError:
        raise ValueError(f"{what}: JSON expected, not thousands of brackets in each other") from None
    except ValueError as error:
        raise ValueError(f"{what}: JSON expected: {error}") from None
    if not isinstance(found, dict):
        raise ValueError(f"{what}: a JSON object expected, not {type(found).__name__}")
    return found
