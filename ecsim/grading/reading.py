"""Reading a program: questions about what it will do, answered before it is run. The simulator knows the answers, nobody wrote them down."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Any

from ..errors import EcsimError
from ..plc import Plc
from .choices import usual
from .exercise import Exercise
from .rules import shown
from .run import Run, Scenario, Trace
from .signals import rises, value_at


@dataclass(frozen=True)
class Question(ABC):
    """One question about a run. `name` is what an answer is called by, `hint` where to look when it is wrong."""

    name: str
    words: str
    hint: str

    @abstractmethod
    def answer(self, trace: Trace) -> Any:
        """What the program did."""

    def meets(self, given: Any, trace: Trace) -> bool:
        """Whether an answer is right."""
        return given == self.answer(trace)

    def told(self, trace: Trace) -> str:
        """The answer in words."""
        return str(self.answer(trace))

    def check(self, given: Any) -> str:
        """What is wrong with the form of an answer; nothing when it can be looked at."""
        return "" if isinstance(given, (int, float)) and not isinstance(given, bool) else "a number"


@dataclass(frozen=True)
class Which(Question):
    """Which of some lanes are ON `at` a second of the run, or in the scan in which the condition `at` becomes true: a set of names."""

    at: float | str = 0.0
    among: tuple[str, ...] = ()

    def answer(self, trace: Trace) -> set[str]:
        scan = moment(trace, self.at)
        return {name for name in self.among if value_at(trace.lane(name), scan)}

    def meets(self, given: Any, trace: Trace) -> bool:
        return {str(name).casefold() for name in given} == {name.casefold() for name in self.answer(trace)}

    def told(self, trace: Trace) -> str:
        return ", ".join(name for name in self.among if name in self.answer(trace)) or "none of them"

    def check(self, given: Any) -> str:
        if isinstance(given, (set, list, tuple)) and {str(name).casefold() for name in given} <= {name.casefold() for name in self.among}:
            return ""
        return f"a set of names out of {', '.join(self.among)}"


@dataclass(frozen=True)
class HowLong(Question):
    """For how many seconds a condition holds, the `nth` time that it does so; right within `give` seconds."""

    condition: str = ""
    nth: int = 1
    give: float = 0.1

    def answer(self, trace: Trace) -> float:
        times = trace.intervals(self.condition)
        if len(times) < self.nth:
            raise EcsimError(f"the question {self.name}: {self.condition!r} holds {len(times)} times only")
        start, end = times[self.nth - 1]
        return round((end - start) * trace.period_s, 6)

    def meets(self, given: Any, trace: Trace) -> bool:
        return abs(given - self.answer(trace)) <= self.give + 1e-9

    def told(self, trace: Trace) -> str:
        return f"{self.answer(trace):g} s"


@dataclass(frozen=True)
class HowOften(Question):
    """How often an event, a condition that becomes true, comes in the run."""

    event: str = ""

    def answer(self, trace: Trace) -> int:
        return len(rises(trace.signal(self.event)))


@dataclass(frozen=True)
class What(Question):
    """The value of a lane at a second or an event: a number, or the active steps as one text ("S20")."""

    lane: str = ""
    at: float | str = 0.0

    def answer(self, trace: Trace) -> Any:
        value = value_at(trace.lane(self.lane), moment(trace, self.at))
        return int(value) if isinstance(value, bool) else value

    def meets(self, given: Any, trace: Trace) -> bool:
        asked = self.answer(trace)
        return str(given).strip().casefold() == asked.casefold() if isinstance(asked, str) else given == asked

    def told(self, trace: Trace) -> str:
        return shown(self.lane, self.answer(trace))

    def check(self, given: Any) -> str:
        return "" if isinstance(given, (int, float, str)) else "a number or a text"


def moment(trace: Trace, at: float | str) -> int:
    """A scan: that of a second, or the one in which a condition becomes true for the first time."""
    if not isinstance(at, str):
        return min(trace.end - 1, round(at / trace.period_s))
    found = rises(trace.signal(at))
    if not found:
        raise EcsimError(f"{at!r} does not come about in this run")
    return found[0]


@dataclass(frozen=True)
class Answered:
    """What was said about each question: `right` or not, and in words."""

    rows: tuple[tuple[str, str, bool, str], ...]  # name, question, right, words

    @property
    def right(self) -> bool:
        """Whether all of it is."""
        return all(row[2] for row in self.rows)

    @property
    def score(self) -> tuple[int, int]:
        """How many are right, of how many."""
        return sum(row[2] for row in self.rows), len(self.rows)

    def __str__(self) -> str:
        got, of = self.score
        lines = [f"{'[x]' if right else '[ ]'} {name}: {words}" for name, _, right, words in self.rows]
        return "\n".join([f"{got} of {of} right", *lines])

    __repr__ = __str__

    def _repr_html_(self) -> str:
        got, of = self.score
        rows = "".join(
            f"<tr><td>{'✓' if right else '✕'}</td><td>{escape(question)}</td><td>{escape(words)}</td></tr>"
            for _, question, right, words in self.rows
        )
        return f"<p>{got} of {of} right</p><table>{rows}</table>"


@dataclass(frozen=True)
class Reading:
    """A reading task: the `program` to be read, a scenario of the exercise that it is run in, and questions about that run.

    `check({"name": answer, ...})` tells which answers are right, and where to look for those that are not; `show("name")`
    tells the answer when it is wanted.
    """

    folder: Path
    title: str
    exercise: Exercise
    scenario: Scenario
    questions: Sequence[Question]
    file: str = "program.il"
    plant: Callable[[], Any] | None = field(default=None)

    @property
    def program(self) -> str:
        """The program to be read."""
        return (self.folder / self.file).read_text(encoding="utf-8")

    @property
    def statement(self) -> str:
        """The task, as Markdown, with its questions."""
        asked = "\n".join(f"{place}. **{question.name}**: {question.words}" for place, question in enumerate(self.questions, 1))
        return (self.folder / "statement.md").read_text(encoding="utf-8") + f"\n## Questions\n\n{asked}\n"

    @cached_property
    def trace(self) -> Trace:
        """The run that the questions are about."""
        plc = Plc(self.exercise.models[0], scan_ms=self.scenario.scan_ms or self.exercise.scan_ms)
        plc.load(self.program)
        return Run(self.exercise, plc, self.scenario, usual(self.scenario.choices)).to()

    def check(self, answers: Mapping[str, Any]) -> Answered:
        """Look at some answers or all; raises EcsimError for a question that does not exist, and for an answer of another form."""
        known = {question.name: question for question in self.questions}
        for name, given in answers.items():
            if name not in known:
                raise EcsimError(f"there is no question {name!r}; there are {', '.join(known)}")
            wanted = known[name].check(given)
            if wanted:
                raise EcsimError(f"the answer to {name} is {given!r}; it is to be {wanted}")
        rows = []
        for question in self.questions:
            if question.name not in answers:
                rows.append((question.name, question.words, False, "not answered yet"))
            elif question.meets(answers[question.name], self.trace):
                rows.append((question.name, question.words, True, f"right: {question.told(self.trace)}"))
            else:
                rows.append((question.name, question.words, False, f"not so. {question.hint}"))
        return Answered(tuple(rows))

    def show(self, name: str) -> str:
        """The answer to a question, in words."""
        for question in self.questions:
            if question.name == name:
                return question.told(self.trace)
        raise EcsimError(f"there is no question {name!r}; there are {', '.join(question.name for question in self.questions)}")

    def __repr__(self) -> str:
        return f"<Reading {self.title}: {len(self.questions)} questions>"
