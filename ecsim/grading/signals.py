"""Signals and conditions: what lanes did over the scans of a run, and what is asked about them in one line of text.

A signal is a list of (scan, value), each holding until the next; the first one stands at scan 0. A condition is an
expression over lanes with `and or not`, comparisons, arithmetic and these functions, where x and y are conditions:

    rise(x), fall(x)    ON for the one scan in which x becomes ON, or OFF
    between(x, y)       ON from the scan in which x is ON to the one in which y is ON (y wins, and that scan is out)
    held(x, seconds)    x has been ON for at least so long
    count(x)            how often x has become ON so far
    taken(v, x)         the value that v had when x last became ON, 0 before
"""

import ast
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from operator import itemgetter
from typing import Any

from ..errors import EcsimError

Signal = list[tuple[int, Any]]


def compressed(changes: Iterable[tuple[int, Any]]) -> Signal:
    """Only what differs from the value before."""
    found: Signal = []
    last = object()
    for scan, value in changes:
        if value != last:
            found.append((scan, value))
            last = value
    return found


def combine(function: Callable, signals: Sequence[Signal]) -> Signal:
    """function(values) of several signals at each of their changes."""
    if not signals:
        return [(0, function())]
    found: Signal = []
    last: Any = object()
    if len(signals) == 1:
        for scan, value in signals[0]:
            result = function(value)
            if result != last:
                found.append((scan, result))
                last = result
        return found
    changes = sorted([(scan, place, value) for place, signal in enumerate(signals) for scan, value in signal], key=itemgetter(0))
    values: list[Any] = [0] * len(signals)
    now = changes[0][0]
    for scan, place, value in changes:
        if scan != now:
            result = function(*values)
            if result != last:
                found.append((now, result))
                last = result
            now = scan
        values[place] = value
    result = function(*values)
    if result != last:
        found.append((now, result))
    return found


def intervals(signal: Signal, end: int) -> list[tuple[int, int]]:
    """Where a signal is ON: (first scan, first scan behind it) in order, the last one cut at `end`."""
    found, began = [], None
    for scan, value in signal:
        if value and began is None:
            began = scan
        elif not value and began is not None:
            found.append((began, scan))
            began = None
    if began is not None and began < end:
        found.append((began, end))
    return found


def rises(signal: Signal) -> list[int]:
    """The scans in which a signal becomes ON; one that is ON from the start has not become so."""
    return [start for start, _ in intervals(signal, signal[-1][0] + 1) if start > 0]


def value_at(signal: Signal, scan: int) -> Any:
    """The value that a signal has in a scan."""
    value = signal[0][1]
    for when, now in signal:
        if when > scan:
            break
        value = now
    return value


# -- the functions --------------------------------------------------------------------------------------------------


def _rise(signal: Signal) -> Signal:
    return [(0, False), *((scan + after, not after) for scan in rises(signal) for after in (0, 1))]


def _fall(signal: Signal) -> Signal:
    return _rise([(scan, not value) for scan, value in signal])


def _between(start: Signal, end: Signal) -> Signal:
    state = False

    def latch(begun: Any, over: Any) -> bool:
        nonlocal state
        state = not over and (state or bool(begun))
        return state

    return combine(latch, [start, end])


def _held(signal: Signal, scans: int) -> Signal:
    found = [(0, False)]
    last = signal[-1][0] + scans + 2
    for start, end in intervals(signal, last):
        if end - start > scans:
            found.append((start + scans, True))
            if end < last:
                found.append((end, False))
    return compressed(found)


def _count(signal: Signal) -> Signal:
    return [(0, 0), *((scan, number) for number, scan in enumerate(rises(signal), 1))]


def _taken(value: Signal, when: Signal) -> Signal:
    return compressed([(0, 0), *((scan, value_at(value, scan)) for scan in rises(when))])


FUNCTIONS: dict[str, tuple[Callable[..., Signal], int, bool]] = {  # name -> what does it, how many signals, whether seconds follow
    "rise": (_rise, 1, False),
    "fall": (_fall, 1, False),
    "between": (_between, 2, False),
    "held": (_held, 1, True),
    "count": (_count, 1, False),
    "taken": (_taken, 2, False),
}

# -- conditions -----------------------------------------------------------------------------------------------------

_ALLOWED = (
    ast.Expression, ast.BoolOp, ast.And, ast.Or, ast.UnaryOp, ast.Not, ast.USub, ast.Compare, ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt,
    ast.GtE, ast.BinOp, ast.Add, ast.Sub, ast.Mult, ast.FloorDiv, ast.Div, ast.Mod, ast.Name, ast.Load, ast.Constant,
)  # fmt: skip


@dataclass(frozen=True)
class Condition:
    """A condition taken apart: an expression over `names`, of which `parts` are functions of other conditions."""

    text: str
    names: tuple[str, ...]  # of lanes and of parts, in the order of the expression's arguments
    parts: dict[str, tuple[str, tuple["Condition", ...], float]]  # name -> function, its conditions, seconds
    expression: Callable[..., Any]

    @property
    def lanes(self) -> tuple[str, ...]:
        """Every lane that the condition looks at, in the order in which they stand in it."""
        found: dict[str, None] = {}
        for name in self.names:
            if name in self.parts:
                found.update(dict.fromkeys(lane for inner in self.parts[name][1] for lane in inner.lanes))
            else:
                found[name] = None
        return tuple(found)

    def over(self, lane: Callable[[str], Signal], period_s: float, known: dict[str, Signal] | None = None) -> Signal:
        """The condition as a signal; `lane` gives the signal of a lane, a scan takes `period_s`. `known` keeps what was made before."""
        known = {} if known is None else known
        if self.text not in known:
            known[self.text] = self._made(lane, period_s, known)
        return known[self.text]

    def _made(self, lane: Callable[[str], Signal], period_s: float, known: dict[str, Signal]) -> Signal:
        signals = []
        for name in self.names:
            if name in self.parts:
                function, inner, seconds = self.parts[name]
                made = [condition.over(lane, period_s, known) for condition in inner]
                do, _, timed = FUNCTIONS[function]
                signals.append(do(*made, *([round(seconds / period_s)] if timed else [])))
            else:
                signals.append(lane(name))
        return combine(self.expression, signals)


@cache
def condition(text: str) -> Condition:
    """Take a condition apart; raises EcsimError that names what cannot be read."""
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError) as error:
        raise EcsimError(f"the condition {text!r} cannot be read: {error}; write one like 'Y0 and not X1'") from None
    return _taken_apart(tree.body, text)


def _taken_apart(tree: ast.expr, text: str) -> Condition:
    parts: dict[str, tuple[str, tuple[Condition, ...], float]] = {}

    class Parts(ast.NodeTransformer):
        def visit_Call(self, node: ast.Call) -> ast.Name:
            name = f"part_{len(parts)}"
            parts[name] = _part(node, text)
            return ast.Name(name, ast.Load())

    body = Parts().visit(tree)
    for node in ast.walk(body):
        if not isinstance(node, _ALLOWED):
            raise EcsimError(f"the condition {text!r} holds {ast.unparse(node)!r}; it may compare, calculate and join lanes, no more")
    names = tuple(dict.fromkeys(node.id for node in ast.walk(body) if isinstance(node, ast.Name)))
    arguments = ast.arguments([], [ast.arg(name) for name in names], None, [], [], None, [])
    function = ast.fix_missing_locations(ast.Expression(ast.Lambda(arguments, body)))
    return Condition(text, names, parts, eval(compile(function, f"<condition {text}>", "eval"), {"__builtins__": {}}))


def _part(node: ast.Call, text: str) -> tuple[str, tuple[Condition, ...], float]:
    name = getattr(node.func, "id", "")
    if name not in FUNCTIONS:
        raise EcsimError(f"the condition {text!r} calls {ast.unparse(node.func)!r}; known are {', '.join(FUNCTIONS)}")
    _, count, timed = FUNCTIONS[name]
    if len(node.args) != count + timed or node.keywords:
        raise EcsimError(f"the condition {text!r}: {name} takes {count} condition{'s' * (count > 1)}{' and seconds' if timed else ''}")
    seconds = 0.0
    if timed:
        last = node.args[-1]
        if not isinstance(last, ast.Constant) or not isinstance(last.value, (int, float)):
            raise EcsimError(f"the condition {text!r}: {name} takes a number of seconds, not {ast.unparse(last)!r}")
        seconds = last.value
    return name, tuple(_taken_apart(argument, ast.unparse(argument)) for argument in node.args[:count]), seconds
