"""Handles calls with wrong arguments: translates old forms, and raises a TypeError that names the right arguments for
all others.

Functions of the extension module use this through native/bindings/hints.cpp, functions in Python through `hinted`; both
only after a call has failed, so that correct calls cost nothing. The section Parameters of the function's docstring
says what an argument must be, or else its annotation does.
"""

from __future__ import annotations

import ast
import collections.abc
import difflib
import functools
import inspect
import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import ParamSpec, TypeVar

from . import old
from .deprecated import warn

P = ParamSpec("P")
R = TypeVar("R")
LIMIT = 60  # characters of a value that a message shows


@dataclass(frozen=True)
class Argument:
    """One argument of a callable, from its signature."""

    name: str
    annotation: str = ""
    required: bool = True
    positional: bool = True


# --- callables ------------------------------------------------------------------------------------------------------


def answer_native(name: str, function: Callable, args: tuple, kwargs: dict) -> object:
    """Makes a call that pybind11 refused in today's form, or raises TypeError. native/bindings/hints.cpp calls this."""
    return _answer(name, function, _native_arguments(function.__doc__ or ""), args, kwargs)


def hinted(name: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorates a public function in Python, or a method: ``name`` is what users write, without ``riffler.``."""

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        order = old.ALL.reordered.get(name)

        @functools.wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> R:
            if order is not None and order[1](args):
                args, kwargs = _in_todays_order(name, order[0], args, kwargs)  # pyright: ignore[reportAssignmentType]
            try:
                return function(*args, **kwargs)
            except TypeError as error:
                # Only errors of the call itself are handled, not those of a line in the function.
                if error.__traceback__ is None or error.__traceback__.tb_next is not None:
                    raise
            return _answer(name, function, _python_arguments(function), args, kwargs)  # pyright: ignore

        return call

    return decorate


def _python_arguments(function: Callable) -> list[Argument] | None:
    out = []
    for p in inspect.signature(function).parameters.values():
        if p.kind in (p.VAR_POSITIONAL, p.VAR_KEYWORD):
            return None
        annotation = p.annotation if isinstance(p.annotation, str) else getattr(p.annotation, "__name__", "")
        annotation = "" if p.annotation is p.empty else annotation
        out.append(Argument(p.name, annotation, p.default is p.empty, p.kind != p.KEYWORD_ONLY))
    return out


def _native_arguments(doc: str) -> list[Argument] | None:
    """From pybind11's first line, "name(self: T, a: X, *, b: Y = 1) -> Z"; None for several overloads."""
    line = doc.partition("\n")[0]
    if "(" not in line or "(*args, **kwargs)" in line:
        return None
    out, positional = [], True
    for text in _split(line[line.index("(") + 1 :], ",", stop=")"):
        if text == "*":
            positional = False
        elif text and text != "/":
            name, _, rest = text.partition(":")
            annotation, equals, _ = rest.partition(" = ")
            out.append(Argument(name.strip(), annotation.strip(), not equals, positional))
    return out


def _split(text: str, separator: str, stop: str = "") -> list[str]:
    """The pieces of a text between separators outside brackets and quotes, up to ``stop``."""
    pieces, depth, quote, begin = [], 0, "", 0
    for k, c in enumerate(text):
        if quote:
            quote = "" if c == quote else quote
        elif c in "'\"":
            quote = c
        elif depth == 0 and c in (separator, stop):
            pieces.append(text[begin:k].strip())
            begin = k + 1
            if c == stop:
                return pieces
        elif c in "([{":
            depth += 1
        elif c in ")]}":
            depth -= 1
    return [*pieces, text[begin:].strip()]


# --- old forms ------------------------------------------------------------------------------------------------------


def _answer(name: str, function: Callable, arguments: list[Argument] | None, args: tuple, kwargs: dict) -> object:
    if arguments is not None and (todays := _translated(name, arguments, args, kwargs)) is not None:
        args, kwargs = todays
        for keyword, adapt in old.ALL.adapted.get(name, {}).items():
            if keyword in kwargs:
                return adapt(function, args, kwargs)
        return function(*args, **kwargs)
    raise TypeError(_explain(name, function.__doc__ or "", arguments, args, kwargs)) from None


def _shown(name: str) -> str:
    """``Mesh`` for ``Mesh.__init__``."""
    return name.removesuffix(".__init__")


def _translated(name: str, arguments: list[Argument], args: tuple, kwargs: dict) -> tuple[tuple, dict] | None:
    """The arguments in today's form, with a warning, or None if the call has no old parts."""
    tables, found = old.ALL, False
    first = int(bool(arguments) and arguments[0].name == "self")
    if name in tables.reordered and tables.reordered[name][1](args[first:]):
        rest, kwargs = _in_todays_order(name, tables.reordered[name][0], args[first:], kwargs)
        args, found = args[:first] + rest, True
    renamed = {}
    for keyword, value in kwargs.items():
        new = tables.keywords.get(name, {}).get(keyword, keyword)
        if new != keyword:
            warn(f"{_shown(name)}({keyword}=…)", f"{new}=…")
            found = True
        renamed[new] = value
    allowed = sum(a.positional for a in arguments)
    names = tables.positional.get(name, ())
    if allowed < len(args) <= len(names) + first:
        extra = dict(zip(names[allowed - first :], args[allowed:], strict=False))
        if not extra.keys() & renamed.keys():
            warn(f"{_shown(name)}: {', '.join(extra)} by position", f"{', '.join(f'{k}=…' for k in extra)}")
            args, renamed, found = args[:allowed], extra | renamed, True
    found |= any(keyword in renamed for keyword in tables.adapted.get(name, {}))
    return (args, renamed) if found else None


def _in_todays_order(name: str, order: tuple[str, ...], args: tuple, kwargs: dict) -> tuple[tuple, dict]:
    """The arguments of a call in the old order, as keywords."""
    warn(f"{_shown(name)}({', '.join(order)})", "the order of today's signature, or keywords")
    return (), dict(zip(order, args, strict=False)) | kwargs


# --- messages -------------------------------------------------------------------------------------------------------


def _explain(name: str, doc: str, arguments: list[Argument] | None, args: tuple, kwargs: dict) -> str:
    """A message that names the fault of a call and the right arguments."""
    shown = _shown(name)
    if arguments is None:
        signatures = re.findall(r"^\d+\. \w+(\(.*)$", doc, re.MULTILINE)
        options = "; or ".join(_plain_signature(shown, _native_arguments("f" + s) or []) for s in signatures)
        return f"{shown}: the arguments do not fit {options or 'any form of it'}; got {_listed(args, kwargs)}"
    if arguments and arguments[0].name == "self":
        arguments, args = arguments[1:], args[1:]
    signature = _plain_signature(shown, arguments)
    names = [a.name for a in arguments]
    for keyword in kwargs:
        if keyword not in names:
            near = difflib.get_close_matches(keyword, names, 1, 0.5)
            advice = f"did you mean {near[0]}?" if near else signature
            return f"{shown}: there is no argument {keyword}; {advice}"
    positional = [a for a in arguments if a.positional]
    if len(args) > len(positional):
        many = len(positional)
        return f"{shown}: {many or 'no'} argument{'s' * (many != 1)} by position, not {len(args)}: {signature}"
    given = dict(zip(names, args, strict=False))
    for keyword in kwargs:
        if keyword in given:
            return f"{shown}: {keyword} is given twice, by position and by keyword"
    given |= kwargs
    expected = _documented(doc)
    for a in arguments:
        if a.required and a.name not in given:
            return f"{shown}: {a.name} is missing: {_wanted(a, expected)}"
    for a in arguments:
        if a.name in given and (wrong := _misfit(a.annotation, given[a.name])) is not None:
            place, value = wrong
            return f"{shown}: {a.name}{place} must be {_wanted(a, expected)}; got {_kind(value)}"
    return f"{shown}: the arguments do not fit {signature}; got {_listed(args, kwargs)}"


def _plain_signature(name: str, arguments: list[Argument]) -> str:
    words, starred = [], False
    for a in arguments:
        if a.name == "self":
            continue
        if not a.positional and not starred:
            words.append("*")
            starred = True
        words.append(a.name if a.required else f"{a.name}=…")
    return f"{name}({', '.join(words)})"


def _listed(args: tuple, kwargs: dict) -> str:
    words = [_kind(v) for v in args] + [f"{k}: {_kind(v)}" for k, v in kwargs.items()]
    return ", ".join(words) or "nothing"


def _kind(value: object) -> str:
    """A value's type, and the value if it is short and simple."""
    if value is None:
        return "None"
    shape = getattr(value, "shape", None)
    if isinstance(shape, tuple) and hasattr(value, "dtype"):
        return f"an array of {value.dtype}, shape {shape}"  # pyright: ignore[reportAttributeAccessIssue]
    if isinstance(value, str | int | float | complex | bytes) and len(repr(value)) <= LIMIT:
        return f"{type(value).__name__} {value!r}"
    return type(value).__name__


def _documented(doc: str) -> dict[str, str]:
    """The text after the colon of each argument in the section Parameters of a numpy docstring."""
    section = re.search(r"^ *Parameters\n *-{3,}\n(.*?)(?=^ *\w+\n *-{3,}$|\Z)", doc, re.MULTILINE | re.DOTALL)
    out = {}
    for names, kind in re.findall(r"^ *([\w, ]+?) : (.+)$", section[1] if section else "", re.MULTILINE):
        for name in names.split(","):
            out[name.strip()] = kind.strip()
    return out


PHRASES = {
    "array_like": "an array",
    "path_like": "a path",
    "callable": "a function",
    "float": "a number",
    "int": "a whole number",
    "bool": "True or False",
    "str": "text",
}
OF_ANNOTATIONS = [
    (r"ArrayLike|ndarray|NDArray", "an array of numbers"),
    (r"PathLike", "a path"),
    (r"Progress", "a function of the finished share, or None"),
    (r"Callable", "a function"),
    (r"SupportsFloat|\bfloat\b", "a number"),
    (r"SupportsInt|\bint\b", "a whole number"),
    (r"\bbool\b", "True or False"),
    (r"Sequence|Iterable|list", "a list"),
    (r"Mapping|dict", "a dict"),
    (r"\bstr\b", "text"),
]


def _wanted(argument: Argument, documented: dict[str, str]) -> str:
    """What an argument must be, as a phrase."""
    if argument.name in documented:
        text = re.sub(r", (optional|default[: ].*)$", "", documented[argument.name])
        word = re.match(r"\w*", text)[0]  # pyright: ignore[reportOptionalSubscript]
        if word in PHRASES:
            return PHRASES[word] + text[len(word) :]
        return text if re.match(r"an? |[\"'{\d(]|one |None|list|dict|tuple", text) else f"a {text}"
    for pattern, phrase in OF_ANNOTATIONS:
        if re.search(pattern, argument.annotation):
            return phrase
    words = [a.rpartition(".")[2] for a in _split(argument.annotation, "|")]
    return "a " + " or ".join(words) if argument.annotation else "given"


# --- does a value fit? ----------------------------------------------------------------------------------------------


def _misfit(annotation: str, value: object) -> tuple[str, object] | None:
    """The part of a value that does not fit an annotation, and its place in it; None if all fits, or might fit."""
    alternatives = _split(annotation, "|")
    if any(_fits(one, value) for one in alternatives):
        return None
    for one in alternatives:
        inner = re.fullmatch(r"(?:[\w.]*\.)?(?:Sequence|Iterable|list)\[(.*)\]", one)
        if inner and isinstance(value, list | tuple):
            for k, item in enumerate(value):
                if _misfit(inner[1], item) is not None:
                    return f", number {k},", item
    return "", value


def _fits(annotation: str, value: object) -> bool:
    inner = re.fullmatch(r"(?:[\w.]*\.)?(\w+)(?:\[(.*)\])?", annotation, re.DOTALL)
    if not inner:
        return True
    word, inside = inner[1], inner[2] or ""
    if word == "Annotated":
        return _misfit(_split(inside, ",")[0], value) is None
    if word == "Optional":
        return value is None or _misfit(inside, value) is None
    if word == "Union":
        return any(_misfit(one, value) is None for one in _split(inside, ","))
    if word == "Literal":
        return value in ast.literal_eval(f"({inside},)")
    if word in CHECKS:
        if inside and word in ("Sequence", "Iterable", "list") and isinstance(value, list | tuple):
            return all(_misfit(inside, item) is None for item in value)
        return CHECKS[word](value)
    known = _class(word)
    return known is None or isinstance(value, known)


def _class(name: str) -> type | None:
    import riffler

    for module in (riffler, riffler._core, riffler.plan):
        if isinstance(found := vars(module).get(name), type):
            return found
    return None


def _is_array(value: object) -> bool:
    import numpy as np

    try:
        np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return False
    return value is not None


def _is_number(value: object) -> bool:
    if isinstance(value, str | bytes) or not (hasattr(value, "__float__") or hasattr(value, "__index__")):
        return False
    try:
        float(value)  # pyright: ignore[reportArgumentType]
    except (TypeError, ValueError, OverflowError):
        return False
    return True


CHECKS: dict[str, Callable[[object], bool]] = {
    "None": lambda v: v is None,
    "Any": lambda v: True,
    "object": lambda v: True,
    "ArrayLike": _is_array,
    "NDArray": _is_array,
    "ndarray": _is_array,
    "SupportsFloat": _is_number,
    "float": _is_number,
    "SupportsInt": lambda v: hasattr(v, "__index__"),
    "SupportsIndex": lambda v: hasattr(v, "__index__"),
    "int": lambda v: hasattr(v, "__index__"),
    "bool": lambda v: isinstance(v, bool) or type(v).__name__ in ("bool", "bool_"),
    "str": lambda v: isinstance(v, str),
    "bytes": lambda v: isinstance(v, bytes),
    "Buffer": lambda v: isinstance(v, bytes | bytearray | memoryview) or hasattr(v, "__array_interface__"),
    "PathLike": lambda v: isinstance(v, os.PathLike),
    "Path": lambda v: isinstance(v, os.PathLike),
    "Callable": callable,
    "Progress": lambda v: v is None or callable(v),
    "Sequence": lambda v: isinstance(v, collections.abc.Sequence) and not isinstance(v, str | bytes),
    "Iterable": lambda v: isinstance(v, collections.abc.Iterable),
    "list": lambda v: isinstance(v, list),
    "tuple": lambda v: isinstance(v, tuple),
    "dict": lambda v: isinstance(v, dict),
    "Mapping": lambda v: isinstance(v, collections.abc.Mapping),
}
