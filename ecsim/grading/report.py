"""The report on a graded program: a verdict on each rule, the marks, and for a broken rule the moment at which it broke."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ..errors import EcsimError
from .chart import Chart

if TYPE_CHECKING:
    from ..assembler import Program
    from ..project import Project
    from .exercise import Exercise
    from .grade import Replay

PASSED, FAILED, UNTRIED = "passed", "failed", "untried"


@dataclass(frozen=True)
class Failure:
    """How a rule was broken: in which scenario with which choices, at which scan and second of it, and in words."""

    scenario: str
    happening: str  # the scenario in words
    choices: Mapping[str, Any]
    scan: int
    second: float
    expected: str
    found: str
    chart: Chart


@dataclass(frozen=True)
class Verdict:
    """What became of one rule; `state` is passed, failed or untried (what it speaks of never came up: no mark)."""

    rule: str
    words: str
    state: str
    marks: float  # what the rule is worth
    failure: Failure | None = None

    @property
    def passed(self) -> bool:
        return self.state == PASSED


@dataclass
class Report:
    """How a program did on an exercise. Shows itself in a notebook, prints as text, `as_dict` is plain data.

    `problems` are the compiler's, one text each; `reason` says why a program was not graded to its end.
    """

    exercise: str
    title: str
    model: str
    program: str  # its name
    source: str
    verdicts: list[Verdict]
    problems: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    reason: str = ""
    runs: int = 0
    simulated_s: float = 0.0
    took_s: float = 0.0
    hint: str = ""
    task: "Exercise | None" = field(default=None, repr=False, compare=False)
    compiled: "Program | None" = field(default=None, repr=False, compare=False)
    settings: "Project | None" = field(default=None, repr=False, compare=False)  # what came with the program, if anything

    @property
    def passed(self) -> bool:
        """Whether every rule is kept."""
        return all(verdict.passed for verdict in self.verdicts)

    @property
    def marks(self) -> float:
        """The sum over the rules that are kept."""
        return sum(verdict.marks for verdict in self.verdicts if verdict.passed)

    @property
    def out_of(self) -> float:
        """The most marks that there are."""
        return sum(verdict.marks for verdict in self.verdicts)

    @property
    def failed(self) -> list[Verdict]:
        """The rules that were broken."""
        return [verdict for verdict in self.verdicts if verdict.state == FAILED]

    def __getitem__(self, rule: str) -> Verdict:
        for verdict in self.verdicts:
            if verdict.rule == rule:
                return verdict
        raise EcsimError(f"there is no rule {rule!r}; there are {', '.join(verdict.rule for verdict in self.verdicts)}")

    def replay(self, rule: "str | Failure | None" = None, seconds: float = 2.0) -> "Replay":
        """The machine shortly before a rule broke, the first broken one unless named: its PLC, plant and session, paused."""
        from .grade import replay

        if self.task is None or self.compiled is None:
            raise EcsimError("this report was read from a file, or its program does not compile; grade the program to replay it")
        failures = [verdict.failure for verdict in self.failed]
        if not failures:
            raise EcsimError("no rule was broken; there is nothing to replay")
        failure = failures[0] if rule is None else rule if isinstance(rule, Failure) else self[rule].failure
        if failure is None:
            raise EcsimError(f"the rule {rule!r} was not broken; broken are {', '.join(verdict.rule for verdict in self.failed)}")
        return replay(self.task, self.compiled, failure, seconds, self.settings)

    # -- as data, as text, as a page ----------------------------------------------------------------------------

    def as_dict(self, charts: bool = True) -> dict[str, Any]:
        """Plain data: what JSON can hold. The marks are the same on every machine, `took_s` is not."""
        verdicts = []
        for verdict in self.verdicts:
            one: dict[str, Any] = {"rule": verdict.rule, "words": verdict.words, "state": verdict.state, "marks": verdict.marks}
            if verdict.failure is not None:
                failure = verdict.failure
                one["failure"] = {
                    "scenario": failure.scenario, "happening": failure.happening, "choices": dict(failure.choices), "scan": failure.scan,
                    "second": failure.second, "expected": failure.expected, "found": failure.found,
                }  # fmt: skip
                if charts:
                    one["failure"]["chart"] = failure.chart.as_dict()
            verdicts.append(one)
        return {
            "exercise": self.exercise, "title": self.title, "model": self.model, "program": self.program, "passed": self.passed,
            "marks": self.marks, "out_of": self.out_of, "verdicts": verdicts, "problems": self.problems, "notes": self.notes,
            "reason": self.reason, "hint": self.hint, "runs": self.runs, "simulated_s": self.simulated_s, "took_s": self.took_s,
        }  # fmt: skip

    def as_json(self, charts: bool = True) -> str:
        """The same as a text of JSON."""
        return json.dumps(self.as_dict(charts), indent=1, ensure_ascii=False)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> "Report":
        """The report that `as_dict` gave, charts included."""
        verdicts = []
        for one in data["verdicts"]:
            failure = one.get("failure")
            if failure is not None:
                failure = Failure(**{**failure, "chart": Chart.from_dict(failure["chart"])})
            verdicts.append(Verdict(one["rule"], one["words"], one["state"], one["marks"], failure))
        plain = {key: data[key] for key in ("exercise", "title", "model", "program", "problems", "notes", "reason", "hint", "runs")}
        return cls(**plain, simulated_s=data["simulated_s"], took_s=data["took_s"], verdicts=verdicts, source="")

    def __str__(self) -> str:
        kept = sum(verdict.passed for verdict in self.verdicts)
        lines = [f"{self.title}: {kept} of {len(self.verdicts)} rules, {self.marks:g} of {self.out_of:g} marks"]
        lines += [self.reason] if self.reason else []
        lines += self.problems
        for verdict in self.verdicts if not self.problems else []:
            lines.append(f"{ {PASSED: '[x]', FAILED: '[ ]', UNTRIED: '[-]'}[verdict.state] } {verdict.words}")
            if verdict.failure is not None:
                failure = verdict.failure
                lines += [
                    f"    expected  {failure.expected}",
                    f"    found     {failure.found}",
                    f"    when      {failure.second:.3f} s into the scenario {failure.scenario!r}: {failure.happening}{_with(failure.choices)}",
                    *(f"    {line}" for line in str(failure.chart).splitlines()),
                ]
            elif verdict.state == UNTRIED:
                lines.append("    it was never put to the test: the program did not come so far")
        lines += [f"note: {note}" for note in self.notes]
        lines += [f"hint: {self.hint}"] if self.hint else []
        lines.append(f"tried in {self.runs} runs, {duration(self.simulated_s)} of the machine's time")
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<Report on {self.program or 'a program'} for {self.exercise}: {self.marks:g} of {self.out_of:g} marks>"

    def _repr_html_(self) -> str:
        from .page import panel

        return panel(self)


def _with(choices: Mapping[str, Any]) -> str:
    return f" ({', '.join(f'{name} {value}' for name, value in choices.items())})" if choices else ""


def duration(seconds: float) -> str:
    """A length of time in words: 12.3 s, 5.2 min, 31 h."""
    if seconds < 120:
        return f"{seconds:.1f} s"
    return f"{seconds / 60:.1f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
