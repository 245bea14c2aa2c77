"""Old names keep working; each warns once and names its replacement.

The tables of old names are in `riffler.old`, one module per topic. Old attributes, methods and names of modules get a
descriptor or a module's ``__getattr__``. If a call does not fit, `riffler.hints` translates its old keywords and
positional arguments; calls in today's form cost nothing extra.
"""

from __future__ import annotations

import importlib
import sys
import warnings
from collections.abc import Callable, ItemsView, Iterator, KeysView, Mapping, ValuesView
from dataclasses import dataclass, field, fields, is_dataclass
from typing import ClassVar

_warned: set[str] = set()

Arguments = tuple[tuple, dict]


def warn(old: str, new: str) -> None:
    """Issues a DeprecationWarning at the line outside of riffler that uses ``old``, once for each old name."""
    if old in _warned:
        return
    warnings.warn(f"riffler: {old} is deprecated, use {new}", DeprecationWarning, stacklevel=_depth())
    _warned.add(old)


def forget() -> None:
    """Makes every old name warn again, for tests."""
    _warned.clear()


def _depth() -> int:
    """The ``stacklevel`` at which `warn` blames the first frame that is not riffler's own."""
    frame, depth = sys._getframe(1), 1
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "riffler":
        frame, depth = frame.f_back, depth + 1
    return depth


@dataclass(frozen=True)
class Old:
    """The old names of one topic. Callables are named as users write them, without ``riffler.``: ``Volume.carve``."""

    #: module ("" is riffler itself): old name → new name, or a pair: name to recommend, name that the old one gives
    modules: dict[str, dict[str, str | tuple[str, str]]] = field(default_factory=dict)
    #: class: old attribute or method → new one of the same kind, or "name()": a method in place of an attribute
    attributes: dict[str, dict[str, str]] = field(default_factory=dict)
    #: callable: old keyword → new keyword
    keywords: dict[str, dict[str, str]] = field(default_factory=dict)
    #: callable: today's names of all arguments that were positional, in their order, without ``self``
    positional: dict[str, tuple[str, ...]] = field(default_factory=dict)
    #: callable: today's names of the arguments in their old order, and a function that tells from the positional
    #: arguments (without ``self``) whether a call uses that order
    reordered: dict[str, tuple[tuple[str, ...], Callable[[tuple], bool]]] = field(default_factory=dict)
    #: callable: removed keyword → function (call, args, kwargs) that makes the call in today's form and returns
    #: the old call's result; it issues the warning itself
    adapted: dict[str, dict[str, Callable[[Callable, tuple, dict], object]]] = field(default_factory=dict)

    def merged(self, other: Old) -> Old:
        """The tables of both."""

        def both(a: dict, b: dict) -> dict:
            return a | {k: a[k] | v if k in a and isinstance(v, dict) else v for k, v in b.items()}

        return Old(**{name: both(getattr(self, name), getattr(other, name)) for name in Old.__dataclass_fields__})


class OldAttribute:
    """Descriptor in a class for the old name of an attribute or a method."""

    def __init__(self, owner: str, old: str, new: str) -> None:
        self.owner, self.old, self.new = owner, old, new
        self.__doc__ = f"Deprecated: `{owner}.{new}`."

    def __get__(self, instance: object | None, owner: type) -> object:
        warn(f"{self.owner}.{self.old}", f"{self.owner}.{self.new}")
        found = getattr(owner if instance is None else instance, self.new.removesuffix("()"))
        return found() if instance is not None and self.new.endswith("()") else found


def install(attributes: Mapping[str, Mapping[str, str]], classes: Mapping[str, type]) -> None:
    """Adds the old attributes to the classes."""
    for owner, names in attributes.items():
        for old, new in names.items():
            setattr(classes[owner], old, OldAttribute(owner, old, new))


def module_getattr(module: str, names: Mapping[str, str | tuple[str, str]]) -> Callable[[str], object]:
    """The ``__getattr__`` of a module that had other names. A new name with a dot is looked up from riffler."""

    def getter(attribute: str) -> object:
        if attribute not in names:
            raise AttributeError(f"module {module!r} has no attribute {attribute!r}")
        new = names[attribute]
        prefix = module.removeprefix("riffler").removeprefix(".")
        advice, path = new if isinstance(new, tuple) else (new, new)
        warn(f"{prefix}.{attribute}".lstrip("."), advice if "." in advice or not prefix else f"{prefix}.{advice}")
        path = path if "." in path or not prefix else f"{prefix}.{path}"
        found: object = importlib.import_module("riffler")
        for part in path.split("."):
            found = getattr(found, part)
        return found

    return getter


class DictResult:
    """Base of results that used to be dicts: they can still be read as one.

    ``old_keys`` names the keys that differ from the attribute's name.
    """

    old_keys: ClassVar[Mapping[str, str]] = {}

    def _as_dict(self) -> dict[str, object]:
        names = {f.name: f.name for f in fields(self) if not f.name.startswith("_")} if is_dataclass(self) else {}
        for key, attribute in self.old_keys.items():
            names.pop(attribute, None)
            names[key] = attribute
        return {key: getattr(self, attribute) for key, attribute in names.items()}

    def _read_as_dict(self, use: str, key: object = None) -> dict[str, object]:
        found, name = self._as_dict(), type(self).__name__
        if isinstance(key, str) and key in found:
            if f"{name}.keys()" in _warned:  # dict(result) asks for the keys first
                return found
            warn(f'{name}["{key}"]', f"{name}.{self.old_keys.get(key, key)}")
        else:
            warn(f"{name}{use}", f"the attributes of {name}, or dataclasses.asdict")
        return found

    def __getitem__(self, key: str) -> object:
        if key not in self._as_dict():
            raise KeyError(key)
        return self._read_as_dict("[…]", key)[key]

    def get(self, key: str, default: object = None) -> object:
        return self._read_as_dict(".get()", key).get(key, default)

    def __contains__(self, key: object) -> bool:
        return key in self._read_as_dict(" as a dict")

    def __iter__(self) -> Iterator[str]:
        return iter(self._read_as_dict(" as a dict"))

    def __len__(self) -> int:
        return len(self._read_as_dict(" as a dict"))

    def __bool__(self) -> bool:
        return True

    def keys(self) -> KeysView[str]:
        return self._read_as_dict(".keys()").keys()

    def values(self) -> ValuesView[object]:
        return self._read_as_dict(".values()").values()

    def items(self) -> ItemsView[str, object]:
        return self._read_as_dict(".items()").items()
