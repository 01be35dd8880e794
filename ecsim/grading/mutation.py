"""How good the rules of an exercise are: its reference solution with one fault at a time, and which of the faults they catch."""

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from multiprocessing import get_context
from typing import Any

from ..assembler import assemble
from ..errors import EcsimError, ProgramError
from .edits import Edit, edits
from .exercise import Exercise, find_exercise, place_of
from .grade import Stage, runs_of
from .run import STEP, Trace

GOAL = 0.95
MORE = 4  # further drawn runs on which behaviour is compared, beyond those that are graded


@dataclass
class Mutants:
    """What became of the faulty programs: `caught` broke a rule or left one untried, `missed` behave otherwise and keep all rules, `same` behave alike."""

    exercise: str
    caught: list[Edit] = field(default_factory=list)
    missed: list[Edit] = field(default_factory=list)
    same: list[Edit] = field(default_factory=list)
    by_rule: dict[str, int] = field(default_factory=dict)

    @property
    def share(self) -> float:
        """The part that is caught of those that change the machine's behaviour."""
        changed = len(self.caught) + len(self.missed)
        return len(self.caught) / changed if changed else 1.0

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {
            "exercise": self.exercise, "caught": len(self.caught), "missed": [str(edit) for edit in self.missed],
            "same": [str(edit) for edit in self.same], "share": round(self.share, 4), "by_rule": self.by_rule,
        }  # fmt: skip

    def __str__(self) -> str:
        changed = len(self.caught) + len(self.missed)
        lines = [
            f"{self.exercise}: {len(self.caught)} of {changed} faults caught ({100 * self.share:.1f} %), {len(self.same)} change nothing"
        ]
        lines += [f"  missed  {edit}" for edit in self.missed]
        lines += [f"  {count:4} caught by {rule}" for rule, count in sorted(self.by_rule.items(), key=lambda item: -item[1])]
        return "\n".join(lines)


def mutate(exercise: Exercise, workers: int = 1, progress: Callable[[int, int], Any] | None = None) -> Mutants:
    """Put every single edit into the reference solution and see which ones the rules catch. An edit that does not compile is none.

    `progress(done, of)` is called after each. The result is the same with any number of workers, which are processes.
    """
    model = exercise.models[0]
    candidates = list(_compiling(exercise.solution, model))
    found = Mutants(exercise.name)
    for number, (edit, (rule, changed)) in enumerate(zip(candidates, _looked_at(exercise, candidates, workers), strict=True), 1):
        if rule is not None and not changed:
            raise EcsimError(
                f"{exercise.name}: {rule} breaks at {edit}, which changes nothing on the machine; the rule is not about behaviour"
            )
        (found.caught if rule else found.missed if changed else found.same).append(edit)
        if rule:
            found.by_rule[rule] = found.by_rule.get(rule, 0) + 1
        if progress is not None:
            progress(number, len(candidates))
    return found


def _looked_at(exercise: Exercise, candidates: list[Edit], workers: int) -> Iterator[tuple[str | None, bool]]:
    """What becomes of each, in order; here, or in processes that find the exercise by its place."""
    if workers <= 1:
        look = Comparison(exercise)
        yield from (look(edit.text) for edit in candidates)
        return
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=_prepare, initargs=(place_of(exercise),)) as pool:
        yield from pool.map(_look, [edit.text for edit in candidates])


_comparison: "list[Comparison]" = []  # of a worker process, made once


def _prepare(place: str) -> None:
    _comparison.append(Comparison(find_exercise(place)))


def _look(text: str) -> tuple[str | None, bool]:
    return _comparison[0](text)


def _compiling(text: str, model: str) -> Iterator[Edit]:
    for edit in edits(text):
        try:
            assemble(edit.text, model)
        except ProgramError:
            continue
        yield edit


def _behaviour(trace: Trace) -> tuple:
    """What the machine got and did, without the steps of the program."""
    lanes = [lane for lane in trace.places if lane != STEP]
    return (trace.end, *(tuple(trace.lane(lane)) for lane in lanes))


class Comparison:
    """Faulty programs beside the reference: the graded runs, and some more for the behaviour alone."""

    def __init__(self, exercise: Exercise):
        self.exercise, self.model = exercise, exercise.models[0]
        self.runs = list(runs_of(exercise))
        self.graded = len(self.runs)
        self.runs += [run for run in runs_of(exercise, MORE, seed=1) if run not in self.runs]
        original = Stage(exercise, assemble(exercise.solution, self.model))
        self.right = [_behaviour(original.run(*run)[0]) for run in self.runs]

    def __call__(self, text: str) -> tuple[str | None, bool]:
        """The first rule that breaks in the graded runs, or that none of them tries; and whether the behaviour differs in any run."""
        exercise, changed, tried = self.exercise, False, set()
        stage = Stage(exercise, assemble(text, self.model))
        for number, run in enumerate(self.runs):
            trace, _ = stage.run(*run)
            changed = changed or _behaviour(trace) != self.right[number]
            if number >= self.graded:
                if changed:
                    break
                continue
            for rule in exercise.rules:
                if rule.applies(run[0].name):
                    has_tried, finding = rule.judge(trace)
                    if finding is not None:
                        return rule.name, changed
                    if has_tried:
                        tried.add(rule.name)
            if number + 1 == self.graded:
                left = [rule.name for rule in exercise.rules if rule.name not in tried]
                if left:
                    return left[0], changed
        return None, changed
