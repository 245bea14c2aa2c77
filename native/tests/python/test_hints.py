"""Calls whose arguments do not fit: one TypeError that names the nearest keyword, or argument, shape and unit."""

import inspect
import pickle

import numpy as np
import pytest
import riffler
from riffler.hints import hinted

BALL = riffler.Tool.ball(6, 30)
POSES = np.array([[0.0, 0, 9, 0, 0, 1], [5.0, 5, 9, 0, 0, 1]])


def volume():
    return riffler.Volume.block([0, 0, 0], [10, 10, 10], 0.5)


def message(call, *args, **kwargs):
    with pytest.raises(TypeError) as caught:
        call(*args, **kwargs)
    return str(caught.value)


def test_a_wrong_keyword_names_the_nearest_right_one():
    assert message(volume().carve, BALL, POSES, tolerence=0.1) == (
        "Volume.carve: there is no argument tolerence; did you mean tolerance?"
    )


def test_an_unknown_keyword_without_a_similar_one_gets_the_signature():
    text = message(volume().carve, BALL, POSES, xyzzy=1)
    assert text.startswith("Volume.carve: there is no argument xyzzy; Volume.carve(tool, poses, ")


def test_a_wrong_keyword_of_a_constructor_and_of_a_static_method():
    assert message(riffler.Mesh, vertexes=[], triangles=[]) == (
        "Mesh: there is no argument vertexes; did you mean vertices?"
    )
    assert message(riffler.Tool.ball, diametre=6, length=30) == (
        "Tool.ball: there is no argument diametre; did you mean diameter?"
    )


def test_a_wrong_type_names_the_argument_and_what_was_given():
    assert message(volume().carve, 6.0, POSES) == "Volume.carve: tool must be a Tool; got float 6.0"
    assert message(volume().carve, None, POSES) == "Volume.carve: tool must be a Tool; got None"
    assert message(volume().carve, BALL, "up") == (
        "Volume.carve: poses must be an array of shape (n, 6), tip in mm and unit axis; got str 'up'"
    )
    assert message(volume().carve, BALL, POSES, tolerance="fine") == (
        "Volume.carve: tolerance must be a number, mm; got str 'fine'"
    )
    assert message(volume().smooth, (1, 2, 3), None) == "Volume.smooth: radius must be a number, mm; got None"
    assert message(riffler.Collider, None) == "Collider: part must be a Mesh or Surface; got None"


def test_a_missing_argument_and_one_given_twice_are_named():
    assert message(volume().carve, BALL).startswith("Volume.carve: poses is missing: an array")
    assert message(volume().carve, BALL, POSES, tool=BALL) == (
        "Volume.carve: tool is given twice, by position and by keyword"
    )


def test_an_item_of_a_list_is_named_by_its_number():
    part = volume().to_mesh()
    text = message(riffler.Collider, part, fixtures=[volume(), part])
    assert "fixtures, number 1, must be" in text and text.endswith("; got Mesh")


def test_an_error_in_a_callback_is_passed_on_unchanged():
    def progress(share):
        return len(share)

    with pytest.raises(TypeError, match="has no len"):
        volume().carve(BALL, POSES, progress=progress)


def test_native_functions_keep_their_signature_help_and_pickle():
    assert list(inspect.signature(riffler.Volume.carve).parameters)[:3] == ["self", "tool", "poses"]
    assert list(inspect.signature(volume().carve).parameters)[:2] == ["tool", "poses"]
    assert list(inspect.signature(riffler.Mesh).parameters) == ["vertices", "triangles"]
    assert inspect.signature(riffler.Tool.ball).parameters["length"].kind.name == "POSITIONAL_OR_KEYWORD"
    assert inspect.signature(riffler.Volume.block).parameters["directions"].default == "z"
    assert riffler.Volume.carve.__doc__.startswith("carve(self: ")
    assert callable(pickle.loads(pickle.dumps(riffler.threads)))
    assert isinstance(pickle.loads(pickle.dumps(BALL)), riffler.Tool)


def test_every_native_function_has_a_signature():
    missing = []
    for name, value in vars(riffler._core).items():
        members = vars(value).items() if isinstance(value, type) else [(None, value)]
        for method, member in members:
            if str(method).startswith("_pybind11"):
                continue
            if callable(member) and type(member).__name__ in ("instancemethod", "builtin_function_or_method"):
                try:
                    inspect.signature(getattr(value, method) if method else member)
                except ValueError:
                    missing.append(f"{name}.{method}")
    assert missing == []


def test_calls_of_a_subclass_get_the_same_hints():
    class Part(riffler.Mesh):
        pass

    assert message(Part, vertices=[], triangels=[]) == "Mesh: there is no argument triangels; did you mean triangles?"
    assert len(Part([], []).triangles) == 0


@hinted("measured")
def measured(tool: riffler.Tool, poses, *, tolerance: float = 0.01) -> float:
    """Rows per tolerance.

    Parameters
    ----------
    tool : Tool
        A cutter.
    poses : array_like of shape (n, 6), tip in mm and unit axis
        Where it goes.
    tolerance : float, mm
        How exact.
    """
    return len(poses) / tolerance


def test_functions_in_python_get_the_same_hints():
    assert measured(BALL, POSES) == 200
    assert message(measured, BALL, POSES, tolerence=1) == (
        "measured: there is no argument tolerence; did you mean tolerance?"
    )
    assert message(measured, BALL) == "measured: poses is missing: an array of shape (n, 6), tip in mm and unit axis"
    assert message(measured, BALL, POSES, 0.1) == (
        "measured: 2 arguments by position, not 3: measured(tool, poses, *, tolerance=…)"
    )
    assert list(inspect.signature(measured).parameters) == ["tool", "poses", "tolerance"]
    assert pickle.loads(pickle.dumps(measured)) is measured


def test_a_type_error_within_a_python_function_is_passed_on_unchanged():
    with pytest.raises(TypeError, match="has no len"):
        measured(BALL, 3.0)
