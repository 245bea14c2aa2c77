"""Old names keep working: each warns once, at the caller's line, with the name that took its place."""

import dataclasses
import importlib
import warnings
from typing import ClassVar

import pytest
import riffler
from riffler import deprecated, hints, old
from riffler.deprecated import DictResult, Old


@pytest.fixture(autouse=True)
def afresh():
    deprecated.forget()
    yield
    deprecated.forget()


@pytest.fixture
def tables(monkeypatch):
    """Old names of this test's own."""

    def use(**names):
        monkeypatch.setattr(old, "ALL", Old(**names))

    return use


def test_an_old_name_warns_once_at_the_callers_line():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for _ in range(3):
            deprecated.warn("Volume.old", "Volume.new")
    (warning,) = caught
    assert warning.category is DeprecationWarning and warning.filename == __file__
    assert str(warning.message) == "riffler: Volume.old is deprecated, use Volume.new"


def test_old_attributes_and_methods_warn_and_work():
    class Thing:
        size = 3

        def smooth(self, radius):
            return radius

    deprecated.install({"Thing": {"soften": "smooth", "extent": "size"}}, {"Thing": Thing})
    with pytest.warns(DeprecationWarning, match=r"Thing.soften is deprecated, use Thing.smooth"):
        assert Thing().soften(2) == 2
    with pytest.warns(DeprecationWarning, match=r"Thing.extent is deprecated, use Thing.size"):
        assert Thing().extent == 3


def test_an_old_name_of_a_module_warns_and_works():
    getter = deprecated.module_getattr("riffler", {"Cutter": "Tool", "Stock": "plan.PencilPath"})
    with pytest.warns(DeprecationWarning, match="Cutter is deprecated, use Tool"):
        assert getter("Cutter") is riffler.Tool
    with pytest.warns(DeprecationWarning, match=r"Stock is deprecated, use plan.PencilPath"):
        assert getter("Stock") is riffler.plan.PencilPath
    with pytest.raises(AttributeError, match="'riffler' has no attribute 'Nothing'"):
        getter("Nothing")


def test_an_old_keyword_of_a_native_function_warns_and_works(tables):
    tables(keywords={"Tool.ball": {"width": "diameter"}})
    with pytest.warns(DeprecationWarning, match=r"Tool.ball\(width=…\) is deprecated, use diameter=…"):
        assert riffler.Tool.ball(width=6, length=30) == riffler.Tool.ball(6, 30)


def test_an_old_position_of_a_native_function_warns_and_works(tables):
    tables(positional={"Mesh.deviation": ("other", "signed")})
    box = riffler.Volume.block([0, 0, 0], [4, 4, 4], 1.0, "xyz").to_mesh()
    with pytest.warns(DeprecationWarning, match=r"Mesh.deviation: signed by position is deprecated, use signed=…"):
        assert (box.deviation(box, True) == 0).all()


def test_old_forms_of_a_python_function_warn_and_work(tables):
    order = (("tool", "poses"), lambda args: bool(args) and isinstance(args[0], riffler.Tool))
    tables(
        keywords={"lift": {"least": "minimum"}}, positional={"lift": ("poses", "tool", "minimum")},
        reordered={"lift": order},
    )  # fmt: skip

    @hints.hinted("lift")
    def lift(poses, tool, *, minimum=0.0):
        return poses, tool, minimum

    ball = riffler.Tool.ball(6, 30)
    with pytest.warns(DeprecationWarning, match=r"lift\(least=…\) is deprecated, use minimum=…"):
        assert lift([1], ball, least=2) == ([1], ball, 2)
    with pytest.warns(DeprecationWarning, match=r"lift: minimum by position is deprecated, use minimum=…"):
        assert lift([1], ball, 2) == ([1], ball, 2)
    with pytest.warns(DeprecationWarning, match=r"lift\(tool, poses\) is deprecated, use the order of today's"):
        assert lift(ball, [1]) == ([1], ball, 0.0)


def test_a_removed_keyword_is_adapted(tables):
    def fill(call, args, kwargs):
        deprecated.warn("Tool.ball(report=…)", "nothing")
        kwargs.pop("report")["made"] = True
        return call(*args, **kwargs)

    tables(adapted={"Tool.ball": {"report": fill}})
    report = {}
    with pytest.warns(DeprecationWarning, match="report"):
        assert riffler.Tool.ball(6, 30, report=report).diameter == 6
    assert report == {"made": True}


@dataclasses.dataclass(frozen=True)
class Counts(DictResult):
    open_edges: int
    total: float

    old_keys: ClassVar = {"volume": "total"}


def test_a_result_that_was_a_dict_can_be_read_as_one():
    counts = Counts(2, 5.0)
    with pytest.warns(DeprecationWarning, match=r'Counts\["open_edges"\] is deprecated, use Counts.open_edges'):
        assert counts["open_edges"] == 2
    with pytest.warns(DeprecationWarning, match=r'Counts\["volume"\] is deprecated, use Counts.total'):
        assert counts["volume"] == 5.0
    with pytest.warns(DeprecationWarning, match="keys"):
        assert dict(counts) == {"open_edges": 2, "volume": 5.0}
    with pytest.warns(DeprecationWarning, match="items"):
        assert list(counts.items()) == [("open_edges", 2), ("volume", 5.0)]
    with pytest.raises(KeyError):
        counts["closed"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert (counts.open_edges, counts.total) == (2, 5.0)
        assert dataclasses.asdict(counts) == {"open_edges": 2, "total": 5.0}


def _inside(name):
    """A class that riffler.plan, riffler.pen or only the extension module has."""
    return next(vars(m)[name] for m in (riffler.plan, riffler.pen, riffler._core) if name in vars(m))


def test_every_old_name_leads_to_an_existing_one():
    def lookup(path):
        found = riffler
        for part in path.split("."):
            found = getattr(found, part, None) if found is riffler else getattr(found, part)
            found = _inside(part) if found is None else found
        return found

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for module, names in old.ALL.modules.items():
            for new in (name[1] if isinstance(name, tuple) else name for name in names.values()):
                assert lookup(new if "." in new or not module else f"{module}.{new}") is not None
                assert importlib.import_module(f"riffler.{module}".rstrip(".")) is not None
        for owner, names in old.ALL.attributes.items():
            for new in (name.removesuffix("()") for name in names.values()):
                fields = getattr(lookup(owner), "__dataclass_fields__", {})
                assert new in fields or hasattr(lookup(owner), new), f"{owner}.{new}"
