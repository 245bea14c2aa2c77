"""Explains a condition of a window's script that did not become true: its source and the values in it."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from pathlib import Path

LONGEST = 300  # characters of a value


def explain(condition: Callable[[], object]) -> str:
    """The condition's expression, its result now, and a line for every value in it. Calls the condition again."""
    result, variables = _called(condition)
    lines = [f"the condition is {result} now"]
    expression = _expression(condition)
    if expression is not None:
        lines[0] = f"{ast.unparse(expression)}: {result} now"
        for text, node in _values(expression).items():
            lines.append(f"  {text} = {_result(lambda node=node: _evaluated(node, variables))}")
    local = {name: value for name, value in variables.items() if name not in _globals(condition)}
    lines += [f"  {name}: {_short(value)}" for name, value in local.items()]
    return "\n".join(dict.fromkeys(lines))


def _short(value: object) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}…"


def _result(call: Callable[[], object]) -> str:
    try:
        return _short(call())
    except Exception as error:
        return f"{type(error).__name__}: {error}"


def _globals(condition: Callable) -> dict:
    return getattr(condition, "__globals__", {})


def _called(condition: Callable) -> tuple[str, dict]:
    """The result of a call as text, and the variables of the condition as it returned."""
    code, variables = getattr(condition, "__code__", None), dict(_globals(condition))

    def note(frame, event, _):
        if event == "return" and frame.f_code is code:
            variables.update(frame.f_locals)

    sys.setprofile(note)
    try:
        result = _result(condition)
    finally:
        sys.setprofile(None)
    return result, variables


def _expression(condition: Callable) -> ast.expr | None:
    """What the condition returns: the body of a lambda, or what a function's last statement returns."""
    code = getattr(condition, "__code__", None)
    if code is None:
        return None
    try:
        tree = ast.parse(Path(code.co_filename).read_text())
    except (OSError, SyntaxError):
        return None
    for node in ast.walk(tree):
        if getattr(node, "lineno", None) != code.co_firstlineno:
            continue
        if isinstance(node, ast.Lambda) and code.co_name == "<lambda>":
            return node.body
        if isinstance(node, ast.FunctionDef) and node.name == code.co_name and isinstance(node.body[-1], ast.Return):
            return node.body[-1].value
    return None


def _values(expression: ast.expr) -> dict[str, ast.expr]:
    """The operands of and, or, not, comparisons and arithmetic, and arguments of calls, by their text, in order."""
    shown = not isinstance(expression, ast.BoolOp | ast.Compare | ast.UnaryOp | ast.Constant)
    found = {ast.unparse(expression): expression} if shown else {}
    if isinstance(expression, ast.BoolOp):
        parts = expression.values
    elif isinstance(expression, ast.Compare):
        parts = [expression.left, *expression.comparators]
    elif isinstance(expression, ast.UnaryOp):
        parts = [expression.operand]
    elif isinstance(expression, ast.BinOp):
        parts = [expression.left, expression.right]
    elif isinstance(expression, ast.Call):
        parts = [part for part in expression.args if not isinstance(part, ast.GeneratorExp | ast.Starred)]
    else:
        parts = []
    for part in parts:
        found.update(_values(part))
    return found


def _evaluated(node: ast.expr, variables: dict) -> object:
    return eval(compile(ast.Expression(node), "<condition>", "eval"), dict(variables))
