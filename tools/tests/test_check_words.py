"""The word check: what it finds in which texts, and a list that only shrinks."""

import pytest

import check_words
from shell import StepError

C = """// Of these the first.
int anew = 0;  // made anew
/* nobody
   waits */
auto* s = "told_not"; auto* t = "it was told so";
char c = '"';  // a way
"""
PYTHON = """'''Used by whoever calls.'''
way = "way"
x = f"goes on {way}"  # what of it
y = 1  # mm, along `way`
"""
MARKDOWN = """# T

```sh
nobody
```
`nobody` is a user.
Of those, nobody.
"""


def found(path, text):
    return sorted((hit.line, hit.word) for hit in check_words.hits_in(path, text))


@pytest.mark.parametrize(
    "path, text, words",
    [
        ("a.cpp", C, [(1, "Of"), (2, "anew"), (3, "nobody"), (5, "told"), (6, "way")]),
        ("a.py", PYTHON, [(1, "whoever"), (3, "goes on"), (3, "what of")]),
        ("a.md", MARKDOWN, [(7, "Of"), (7, "nobody")]),
    ],
)
def test_comments_docstrings_messages_and_documents_are_read_and_no_code(path, text, words):
    assert found(path, text) == words


def test_a_sentence_may_begin_after_a_line_break_but_not_every_line_begins_one():
    assert found("a.hpp", "// Cuts the stock.\n// Of many it takes one,\n// The end\n// Of it.\n") == [(2, "Of")]


@pytest.mark.parametrize("text", ["Of course", "the same way", "all the way", "a way out", "halfway", "one way"])
def test_ordinary_english_passes(text):
    assert found("a.md", text + "\n") == []


def test_more_than_allowed_fails_with_the_places_and_fewer_asks_to_shrink_the_list():
    hits = list(check_words.hits_in("a.md", "nobody and nobody\n"))
    assert check_words.problems(hits, {"a.md": 2}) == []
    assert check_words.problems(hits, {"a.md": 1})[0].startswith("a.md:1: 'nobody'")
    assert "--update" in check_words.problems(hits, {"a.md": 3})[0]
    assert "--update" in check_words.problems([], {"gone.md": 1})[0]


@pytest.fixture
def listed(tmp_path, monkeypatch):
    """The path of a list that does not exist."""
    monkeypatch.setattr(check_words, "ALLOWED", tmp_path / "allowed.txt")
    return check_words.ALLOWED


def test_the_list_shrinks_until_it_is_gone_and_cannot_grow(listed):
    listed.write_text("2 a.md\n1 b.md\n")
    hits = list(check_words.hits_in("a.md", "nobody\n"))
    check_words.update(hits, check_words.read_allowed())
    assert listed.read_text() == "1 a.md\n"
    with pytest.raises(StepError, match=r"only shrink.*a\.md"):
        check_words.update(hits * 2, check_words.read_allowed())
    assert listed.read_text() == "1 a.md\n"
    check_words.update([], check_words.read_allowed())
    assert not listed.exists()


@pytest.mark.parametrize("text", [None, "", "\n"])
def test_without_a_list_or_with_an_empty_one_no_word_is_allowed(listed, text):
    if text is not None:
        listed.write_text(text)
    allowed = check_words.read_allowed()
    hits = list(check_words.hits_in("a.md", "nobody\n"))
    assert allowed == {} and check_words.problems([], allowed) == []
    assert check_words.problems(hits, allowed)[-1] == "a.md: 1 words of the list, 0 allowed"
    with pytest.raises(StepError, match=r"only shrink.*a\.md"):
        check_words.update(hits, allowed)
    check_words.update([], allowed)
    assert not listed.exists()
