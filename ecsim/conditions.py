"""Conditions over a Plc's devices as one line of text: "D0 > 100 and X1", "not Motor", "S21", "D10:REAL <= 2.5 or (T0 and C0 = 3)".

Bits stand alone; of T and C the contact. Values are compared with = <> < <= > >=; `and`, `or`, `not` and parentheses join them.
Numbers are written as in a program: 100, -5, 2.5, 16#FF.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable
from typing import Any

from .devices import Bits, Device
from .errors import EcsimError
from .plc import Plc
from .values import BOOL

Test = Callable[[], Any]

TOKEN = re.compile(r"\s*(<=|>=|<>|!=|==|[<>=()]|-?\d+#\w+|-?\d+\.\d+|-?\d+(?![\w.])|[^\W\d][\w.]*(?::\w+)?|(?P<wrong>\S))")
COMPARE: dict[str, Callable[[Any, Any], bool]] = {
    "=": operator.eq, "==": operator.eq, "<>": operator.ne, "!=": operator.ne,
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge,
}  # fmt: skip
WORDS = ("and", "or", "not")
DEEPEST = 40  # parentheses and `not`s within one another


def condition(plc: Plc, text: str) -> Callable[[], bool]:
    """A function that tells whether a condition holds at this moment; raises EcsimError for one that cannot be read."""
    return _Reader(plc, text).whole()


class _Reader:
    """Reads one condition from left to right."""

    def __init__(self, plc: Plc, text: str):
        self.plc, self.text = plc, str(text)
        self.words: list[str] = []
        for found in TOKEN.finditer(self.text):
            if found["wrong"]:
                raise self._error(f"{found['wrong']!r} has no meaning here")
            self.words.append(found[1])
        self.at = self.depth = 0

    def _error(self, why: str) -> EcsimError:
        return EcsimError(f"{self.text!r} is no condition: {why}; write one like S21, Start and not X1, or D0 > 100")

    @property
    def _next(self) -> str:
        return self.words[self.at] if self.at < len(self.words) else ""

    def _took(self, *words: str) -> str:
        """The next word if it is one of these, and go on behind it."""
        word = self._next
        if word.lower() not in words or not word:
            return ""
        self.at += 1
        return word.lower()

    def whole(self) -> Callable[[], bool]:
        test = self._either()
        if self._next:
            raise self._error(f"{self._next!r} was not expected")
        return lambda: bool(test())

    def _either(self) -> Test:
        tests = [self._both()]
        while self._took("or"):
            tests.append(self._both())
        return tests[0] if len(tests) == 1 else lambda: any(test() for test in tests)

    def _both(self) -> Test:
        tests = [self._one()]
        while self._took("and"):
            tests.append(self._one())
        return tests[0] if len(tests) == 1 else lambda: all(test() for test in tests)

    def _one(self) -> Test:
        self.depth += 1
        if self.depth > DEEPEST:
            raise self._error(f"it is nested more than {DEEPEST} deep")
        test = self._innermost()
        self.depth -= 1
        return test

    def _innermost(self) -> Test:
        if self._took("not"):
            inner = self._one()
            return lambda: not inner()
        if self._took("("):
            test = self._either()
            if not self._took(")"):
                raise self._error("a parenthesis is not closed")
            return test
        left = self._next
        self.at += 1
        sign = self._took(*COMPARE)
        if not sign:
            return self._bit(left)
        compare, first = COMPARE[sign], self._value(left)
        right = self._next
        self.at += 1
        second = self._value(right)
        return lambda: compare(first(), second())

    def _bit(self, word: str) -> Test:
        if not self._named(word):
            raise self._error(f"{word!r} says nothing by itself, compare it with a value" if word else "something is missing at its end")
        device, kind = self._device(word)
        if isinstance(device, Device) and device.area in ("T", "C") and ":" not in word:
            kind = BOOL
        if kind is not BOOL:
            raise self._error(f"{word} is a value; compare it, as in {word} > 0")
        return self._read(device, kind)

    def _value(self, word: str) -> Test:
        if self._named(word):
            return self._read(*self._device(word))
        try:
            number = float(word) if "." in word else int(word) if "#" not in word else self._based(word)
        except ValueError:
            raise self._error(f"{word!r} is no number" if word else "something is missing at its end") from None
        return lambda: number

    @staticmethod
    def _based(word: str) -> int:
        base, _, digits = word.lstrip("-").partition("#")
        number = int(digits, int(base))
        return -number if word.startswith("-") else number

    @staticmethod
    def _named(word: str) -> bool:
        return bool(word) and (word[0].isalpha() or word[0] == "_") and word.lower() not in WORDS

    def _device(self, word: str) -> tuple[Device | Bits, Any]:
        try:
            return self.plc.memory.parse(word, self.plc._names)
        except EcsimError as error:
            raise EcsimError(f"{self.text!r} is no condition: {error}") from None

    def _read(self, device: Device | Bits, kind: Any) -> Test:
        memory = self.plc.memory
        return lambda: memory.get(device, kind)
