"""Commit messages: what passes, and what each fault is called."""

import pytest

from check_commits import faults

BODY = "\n\nThe why."


@pytest.mark.parametrize(
    "subject",
    ["tools: Count words", "nc, verify: Read G68", "docs: Embed a film", "addon/sculpt: Bring back the brush"],
)
def test_an_area_and_an_order_with_a_body_pass(subject):
    assert list(faults(subject + BODY)) == []


@pytest.mark.parametrize(
    "message, words",
    [
        ("Count words" + BODY, "area: Imperative"),
        ("tools: count words" + BODY, "area: Imperative"),
        ("tools: Counted words" + BODY, "not an imperative"),
        ("tools: Counting words" + BODY, "not an imperative"),
        ("tools: Count words." + BODY, "full stop"),
        ("tools: " + "C" * 66 + BODY, "73 characters"),
        ("tools: Count words", "body"),
        ("tools: Count words\nwithout an empty line", "body"),
    ],
)
def test_each_fault_is_named(message, words):
    assert [fault for fault in faults(message) if words in fault], list(faults(message))


def test_a_merge_needs_a_short_subject_only():
    assert list(faults("Merge: words of the core", merge=True)) == []
    assert list(faults("Merge: " + "w" * 80, merge=True))
