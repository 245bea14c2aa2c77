"""What the project's sources say, for tests that hold the documents to it."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[3]


def spoken(text):
    """A source's text with literals joined that lie side by side, over ends of lines too, in Python and in C++."""
    return re.sub(r'"\s*(?:\n\s*)?f?"', "", text)
