"""Free choices of a scenario: what a machine or an operator may do otherwise. Each has a usual value, can be drawn, and can be made simpler."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from types import SimpleNamespace
from typing import Any, Protocol

from ..errors import EcsimError

ENDS = 0.2  # how often a draw takes one of the two ends, where machines like to fail


class Choice(Protocol):
    """One free choice. Its values are numbers, texts and lists of them, so that a report can keep them."""

    usual: Any

    def draw(self, random: Random) -> Any: ...

    def simpler(self, value: Any) -> Iterator[Any]:
        """Values nearer to the usual one, the nearest first."""


@dataclass(frozen=True)
class Between:
    """A number from `low` to `high` with so many digits behind the point (0: a whole number); `usual` is `low` unless given."""

    low: float
    high: float
    usual: float | None = None
    digits: int = 2

    def __post_init__(self):
        if self.usual is None:
            object.__setattr__(self, "usual", self.low)
        if not self.low <= self.usual <= self.high:
            raise EcsimError(f"Between({self.low}, {self.high}): the usual value {self.usual} lies outside")

    def draw(self, random: Random) -> float:
        if random.random() < ENDS:
            return random.choice((self.low, self.high))
        return self._rounded(random.uniform(self.low, self.high))

    def simpler(self, value: float) -> Iterator[float]:
        seen = {value}
        for nearer in (self.usual, self._rounded((self.usual + value) / 2), self._rounded(self.usual + 0.9 * (value - self.usual))):
            if nearer not in seen:
                seen.add(nearer)
                yield nearer

    def _rounded(self, value: float) -> float:
        return round(value, self.digits) if self.digits else round(value)


class OneOf:
    """One of some values; the first is the usual one, and an earlier one is simpler."""

    def __init__(self, *options: Any):
        if not options:
            raise EcsimError("OneOf() needs values to choose from")
        self.options, self.usual = options, options[0]

    def draw(self, random: Random) -> Any:
        return random.choice(self.options)

    def simpler(self, value: Any) -> Iterator[Any]:
        yield from self.options[: self.options.index(value)]

    def __repr__(self) -> str:
        return f"OneOf({', '.join(map(repr, self.options))})"


@dataclass(frozen=True)
class Several:
    """A list of `least` to `most` values of another choice; `usual` is `least` times its usual value unless given."""

    each: Choice
    least: int
    most: int
    usual: Sequence[Any] | None = None

    def __post_init__(self):
        if not 0 <= self.least <= self.most:
            raise EcsimError(f"Several(..., {self.least}, {self.most}): give the least number first, from 0 on")
        object.__setattr__(self, "usual", [self.each.usual] * self.least if self.usual is None else list(self.usual))

    def draw(self, random: Random) -> list[Any]:
        return [self.each.draw(random) for _ in range(random.randint(self.least, self.most))]

    def simpler(self, value: Sequence[Any]) -> Iterator[list[Any]]:
        if len(value) > self.least:
            for place in reversed(range(len(value))):
                yield [*value[:place], *value[place + 1 :]]
        for place, one in enumerate(value):
            for nearer in self.each.simpler(one):
                yield [*value[:place], nearer, *value[place + 1 :]]


def usual(choices: Mapping[str, Choice]) -> dict[str, Any]:
    """Every choice at its usual value."""
    return {name: choice.usual for name, choice in choices.items()}


def draw(choices: Mapping[str, Choice], seed: str) -> dict[str, Any]:
    """A value of each choice; the same seed gives the same values on every machine."""
    random = Random(seed)
    return {name: choice.draw(random) for name, choice in choices.items()}


def simpler(choices: Mapping[str, Choice], values: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """The values with all at their usual, then with one of them made simpler."""
    if values != usual(choices):
        yield usual(choices)
    for name, choice in choices.items():
        for nearer in choice.simpler(values[name]):
            yield {**values, name: nearer}


def chosen(what: Any, values: Mapping[str, Any]) -> Any:
    """What a scenario says, as these choices make it: a function is called with them as attributes, anything else stands as it is."""
    return what(SimpleNamespace(**values)) if callable(what) else what
