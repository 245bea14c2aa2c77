"""docs/troubleshooting.md quotes what the sources say."""

import re

import pytest
from sources import ROOT, spoken

ROWS = re.findall(r"^\| `([^`]+)` \|", (ROOT / "docs" / "troubleshooting.md").read_text(), re.MULTILINE)
ENDS = {".py", ".cpp", ".hpp"}


def sources():
    for folder in ("addon", "native"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in ENDS and "tests" not in path.parts:
                yield spoken(path.read_text())


@pytest.fixture(scope="module")
def texts():
    return list(sources())


def test_the_page_has_messages():
    assert len(ROWS) > 40
    assert len(set(ROWS)) == len(ROWS)


@pytest.mark.parametrize("message", ROWS)
def test_every_quoted_message_still_exists(message, texts):
    words = [part for part in message.split("…") if re.search(r"\w", part)]
    pattern = re.compile(r"[^\n]{0,200}?(?:\n[^\n]{0,200}?){0,3}".join(map(re.escape, words)))
    assert any(pattern.search(text) for text in texts), f"no source says {message!r}"


def test_an_outdated_message_is_detected(texts):
    assert not any("the sculpt has gone to lunch" in text for text in texts)
