"""Rules: what every correct program does, in words and as a condition over terminals and quantities of the machine.

A rule judges the behaviour alone. It looks at changes, not at each scan, and tells the first moment at which it is
broken. It is `tried` when the situation that it speaks of has come up; what was never tried earns no mark.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ..errors import EcsimError
from .run import Trace
from .signals import condition, rises, value_at


class Finding(NamedTuple):
    """How a rule was broken: known after scan `scan`, from scan `since` to `until` (not included), and in words."""

    scan: int
    since: int
    until: int
    words: str


class Judgement(NamedTuple):
    """What a rule says about a run."""

    tried: bool
    finding: Finding | None = None


@dataclass(frozen=True)
class _Rule:
    name: str  # one word with hyphens: "discharge-closed"
    words: str  # a sentence: "The drain is never open while material is added"

    expected: str = field(default="", kw_only=True)  # the sentence that is shown when it is broken; made from the conditions unless given
    scenarios: tuple[str, ...] = field(default=(), kw_only=True)  # those that it judges; all unless given
    marks: float = field(default=1.0, kw_only=True)

    @property
    def conditions(self) -> tuple[str, ...]:
        """Its conditions as written."""
        return ()

    @property
    def lanes(self) -> tuple[str, ...]:
        """The lanes it looks at, as named in its conditions."""
        return tuple(dict.fromkeys(lane for text in self.conditions for lane in condition(text).lanes))

    @property
    def at_fault(self) -> tuple[str, ...]:
        """The conditions whose lanes are at fault when it is broken; others only tell when it holds."""
        return self.conditions[:1]

    @property
    def marked(self) -> tuple[str, ...]:
        """The lanes that a chart marks: those named outside functions in what is at fault."""
        conditions = [condition(text) for text in self.at_fault]
        direct = dict.fromkeys(name for one in conditions for name in one.names if name not in one.parts)
        return tuple(direct) or self.lanes

    def applies(self, scenario: str) -> bool:
        """Whether it judges a scenario: all of them unless `scenarios` names some."""
        return not self.scenarios or scenario in self.scenarios


@dataclass(frozen=True)
class Never(_Rule):
    """`condition` never holds, but for `grace` scans in a row (1 is what a hand-over between two steps takes, 7.4.1).

    `needs` is a condition that must have come up for the rule to count as tried; without it a program that does nothing
    would earn the mark.
    """

    condition: str
    grace: int = 0
    needs: str = ""

    @property
    def conditions(self) -> tuple[str, ...]:
        return (self.condition, *filter(None, (self.needs,)))

    @property
    def lanes(self) -> tuple[str, ...]:
        return condition(self.condition).lanes

    @property
    def demand(self) -> str:
        if self.expected:
            return self.expected
        return f"Never {self.condition}{f', but for {_scans(self.grace)}' if self.grace else ''}."

    def judge(self, trace: Trace) -> Judgement:
        tried = not self.needs or bool(trace.intervals(self.needs))
        for start, end in trace.intervals(self.condition):
            if end - start > self.grace:
                words = f"{_now(self, trace, start + self.grace)} for {_duration(trace, end - start)}."
                return Judgement(True, Finding(start + self.grace, start, end, words))
        return Judgement(tried)


@dataclass(frozen=True)
class Within(_Rule):
    """Whenever `when` becomes true, `then` holds at some moment within `seconds`, unless `unless` holds before."""

    when: str
    then: str
    seconds: float
    unless: str = ""

    @property
    def conditions(self) -> tuple[str, ...]:
        return (self.then, self.when, *filter(None, (self.unless,)))

    @property
    def demand(self) -> str:
        return self.expected or f"{self.then} within {self.seconds:g} s of {self.when}{f', unless {self.unless}' if self.unless else ''}."

    def judge(self, trace: Trace) -> Judgement:
        begun = rises(trace.signal(self.when))
        allowed = round(self.seconds / trace.period_s)
        answers = trace.intervals(self.then)
        excuses = trace.intervals(self.unless) if self.unless else []
        for start in begun:
            due = start + allowed
            if due >= trace.end or _meets(answers, start, due) or _meets(excuses, start, due):
                continue
            later = next((first for first, _ in answers if first > due), None)
            found = "not at all" if later is None else f"only after {_duration(trace, later - start)}"
            return Judgement(True, Finding(due, start, later or due, f"{self.then} came {found}: {_now(self, trace, due)}."))
        return Judgement(bool(begun))


@dataclass(frozen=True)
class Lasts(_Rule):
    """Each time `condition` holds, it does so for `least` to `most` seconds. Cut short while `unless` holds is no failure."""

    condition: str
    least: float = 0.0
    most: float | None = None
    unless: str = ""

    @property
    def conditions(self) -> tuple[str, ...]:
        return (self.condition, *filter(None, (self.unless,)))

    @property
    def demand(self) -> str:
        if self.expected:
            return self.expected
        most = "" if self.most is None else f" and at most {self.most:g} s"
        return f"{self.condition} for at least {self.least:g} s{most}{f', unless {self.unless}' if self.unless else ''}."

    def judge(self, trace: Trace) -> Judgement:
        times = trace.intervals(self.condition)
        excuse = trace.signal(self.unless) if self.unless else [(0, False)]
        least = round(self.least / trace.period_s)
        most = None if self.most is None else round(self.most / trace.period_s)
        tried = False
        for start, end in times:
            over = end < trace.end
            tried = tried or over
            words = f"{self.condition} held for {_duration(trace, end - start)}."
            if most is not None and end - start > most:
                return Judgement(True, Finding(start + most, start, end, words))
            if over and end - start < least and not value_at(excuse, end):
                return Judgement(True, Finding(end, start, end, words))
        return Judgement(tried)


@dataclass(frozen=True)
class Order(_Rule):
    """The `events`, conditions that become true, come in this order, over and over; `restart` begins anew from the first."""

    events: tuple[str, ...]
    restart: str = ""

    @property
    def conditions(self) -> tuple[str, ...]:
        return (*self.events, *filter(None, (self.restart,)))

    @property
    def at_fault(self) -> tuple[str, ...]:
        return self.events

    @property
    def demand(self) -> str:
        return self.expected or f"{', then '.join(self.events)}."

    def judge(self, trace: Trace) -> Judgement:
        happened = [(scan, 1, place) for place, text in enumerate(self.events) for scan in rises(trace.signal(text))]
        if self.restart:
            happened += [(scan, 0, -1) for scan in rises(trace.signal(self.restart))]
        awaited, before, rounds = 0, 0, 0
        for scan, _, place in sorted(happened):
            if place < 0:
                awaited = 0
            elif place != awaited:
                words = f"{self.events[place]} came where {self.events[awaited]} was due."
                return Judgement(True, Finding(scan, before, scan + 1, words))
            else:
                awaited = (awaited + 1) % len(self.events)
                rounds += awaited == 0
            before = scan
        return Judgement(rounds > 0)


@dataclass(frozen=True)
class Count(_Rule):
    """`event` becomes true `least` to `most` times in each stretch in which `within` holds, in the whole run without it."""

    event: str
    least: int = 0
    most: int | None = None
    within: str = ""

    @property
    def conditions(self) -> tuple[str, ...]:
        return (self.event, *filter(None, (self.within,)))

    @property
    def demand(self) -> str:
        if self.expected:
            return self.expected
        most = "" if self.most is None else f", at most {self.most} times"
        return f"{self.event} at least {_times(self.least)}{most}{f' while {self.within}' if self.within else ''}."

    def judge(self, trace: Trace) -> Judgement:
        happened = rises(trace.signal(self.event))
        stretches = trace.intervals(self.within) if self.within else [(0, trace.end)]
        tried = False
        for start, end in stretches:
            over = end < trace.end if self.within else not trace.cut
            tried = tried or over
            mine = [scan for scan in happened if start <= scan < end]
            if self.most is not None and len(mine) > self.most:
                return Judgement(
                    True, Finding(mine[self.most], start, mine[self.most] + 1, f"{self.event} came for the {_nth(self.most + 1)} time.")
                )
            if over and len(mine) < self.least:
                words = f"{self.event} came {_times(len(mine))} in {_duration(trace, end - start)}."
                return Judgement(True, Finding(min(end, trace.end - 1), mine[-1] if mine else start, end, words))
        return Judgement(tried)


@dataclass(frozen=True)
class Custom(_Rule):
    """What `look(trace)` finds: (scan from which, scan at which it is known, words) for each break, in order of time.

    It must judge the beginning of a run as it judges the whole. `watch` names the lanes that a chart marks.
    """

    look: Callable[[Trace], Iterable[tuple[int, int, str]]]
    watch: tuple[str, ...]
    needs: str = ""

    @property
    def conditions(self) -> tuple[str, ...]:
        return (*self.watch, *filter(None, (self.needs,)))

    @property
    def at_fault(self) -> tuple[str, ...]:
        return self.watch

    @property
    def demand(self) -> str:
        return self.expected or f"{self.words}."

    def judge(self, trace: Trace) -> Judgement:
        for since, scan, words in self.look(trace):
            return Judgement(True, Finding(scan, since, scan + 1, words))
        return Judgement(not self.needs or bool(trace.intervals(self.needs)))


Rule = Never | Within | Lasts | Order | Count | Custom


def check(rules: Iterable[Rule]) -> None:
    """Raise EcsimError for two rules of one name, and for conditions that cannot be read."""
    names: set[str] = set()
    for rule in rules:
        if rule.name in names:
            raise EcsimError(f"two rules have the name {rule.name!r}; give each its own")
        names.add(rule.name)
        for text in rule.conditions:
            condition(text)


# -- words ----------------------------------------------------------------------------------------------------------


def _meets(stretches: list[tuple[int, int]], first: int, last: int) -> bool:
    """Whether something is ON in one of the scans from first to last."""
    return any(start <= last and end > first for start, end in stretches)


def _now(rule: Any, trace: Trace, scan: int) -> str:
    """What the rule's lanes were in a scan: "Gate on, X1 off, weight 2001"."""
    return ", ".join(shown(name, value_at(trace.lane(name), scan)) for name in rule.lanes)


def shown(name: str, value: Any) -> str:
    """A lane's value in words."""
    if isinstance(value, bool):
        return f"{name} {'on' if value else 'off'}"
    if isinstance(value, (tuple, list)):
        return f"{name}: {worded(value) or 'none'}"
    return f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"


def worded(value: Any) -> str:
    """What is no number, in words; of a list the last entry, of what happened on a machine what it was."""
    if isinstance(value, (tuple, list)) and not hasattr(value, "what"):
        return worded(value[-1]) if value else ""
    return str(getattr(value, "what", value))


def _scans(count: int) -> str:
    return "one scan" if count == 1 else f"{count} scans"


def _times(count: int) -> str:
    return {0: "not at all", 1: "once", 2: "twice"}.get(count, f"{count} times")


def _nth(count: int) -> str:
    return f"{count}{ {1: 'st', 2: 'nd', 3: 'rd'}.get(count, 'th') }"


def _duration(trace: Trace, scans: int) -> str:
    seconds = scans * trace.period_s
    if scans <= 20:
        return f"{_scans(scans)} ({seconds:.3f} s)"
    return f"{seconds:.2f} s" if seconds < 300 else f"{seconds / 60:.1f} min"
