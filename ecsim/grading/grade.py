"""Grading: a program runs through all scenarios, usual and drawn; every rule judges every run; a failure is made as short as it can be."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..assembler import Program
from ..errors import WATCHDOG, EcsimError, ProgramError
from ..plc import Plc
from ..project import Project
from ..sensors import Sensors
from ..session import Session, plant_state, restore_plant
from .chart import chart_of
from .choices import draw, simpler, usual
from .exercise import Exercise
from .report import FAILED, PASSED, UNTRIED, Failure, Report, Verdict
from .rules import Finding, Rule
from .run import Run, Scenario, Trace

SHORTENING = 80_000  # scans at most to find the shortest failing run of all rules together: half a second
PATIENCE = 3  # a program that the watchdog has stopped in so many runs is not tried any further: each costs seconds
BEHIND_S = 3.0  # so long a run goes on behind its failure, for the chart


class Stage:
    """A program on its PLC, which is cold at the beginning of every run. A project's system block comes with it; the scan is the exercise's."""

    def __init__(self, exercise: Exercise, program: Program, settings: Project | None = None):
        self.exercise, self.program = exercise, program
        self.download = program if settings is None else replace(settings, files={"": program.source}, scan_ms=None, passwords=None)
        self.runs = 0
        self.simulated_s = 0.0
        self._cold: dict[float, tuple[Plc, dict]] = {}  # by the length of a scan

    def begin(self, scenario: Scenario, values: Mapping[str, Any]) -> Run:
        """A run at its beginning."""
        scan_ms = scenario.scan_ms or self.exercise.scan_ms
        if scan_ms not in self._cold:
            plc = Plc(self.program.model, scan_ms=scan_ms)
            plc.load(self.download)
            self._cold[scan_ms] = plc, plc.snapshot()
        plc, cold = self._cold[scan_ms]
        plc.restore(cold)
        return Run(self.exercise, plc, scenario, values)

    def run(self, scenario: Scenario, values: Mapping[str, Any], scans: int | None = None) -> tuple[Trace, Plc]:
        """What the lanes did in a whole run, or in its first scans; and the PLC as it stands then."""
        run = self.begin(scenario, values)
        trace = run.to(scans)
        self.runs += 1
        self.simulated_s += trace.end * trace.period_s
        return trace, run.plc


@dataclass
class Broken:
    """The earliest failure of a rule so far."""

    rule: Rule
    scenario: Scenario
    values: dict[str, Any]
    finding: Finding
    trace: Trace

    @property
    def second(self) -> float:
        return self.finding.scan * self.trace.period_s


def runs_of(exercise: Exercise, more: int = 0, seed: int = 0) -> Iterator[tuple[Scenario, dict[str, Any]]]:
    """Every scenario with its usual choices, then with drawn ones; `more` draws for each beyond its own. The same for every program."""
    for scenario in exercise.scenarios:
        yield scenario, usual(scenario.choices)
    for scenario in exercise.scenarios:
        for number in range(scenario.draws + more if scenario.choices else 0):
            yield scenario, draw(scenario.choices, f"{exercise.name}/{scenario.name}/{seed}/{number}")


def grade(
    exercise: Exercise, program: "str | Path | Project | Program", model: str | None = None, *, more: int = 0, seed: int = 0
) -> Report:
    """Judge a program by what the machine does under it. `program` is a text, a path, a Project or a Program; it need not compile.

    `more` draws so many further runs of each scenario, from `seed`, to look for a failure. A program that cannot be read raises EcsimError.
    """
    began = time.perf_counter()
    written = program if isinstance(program, Program) else Project.of(program)
    source = written.source if isinstance(written, Program) else "\n".join(written.files.values())
    name = "" if isinstance(written, Program) else written.name
    settings = None if isinstance(written, Program) or (written.system is None and written.io is None) else written
    model = written.model.name if isinstance(written, Program) else model or written.model or exercise.models[0]
    if model not in exercise.models:
        raise EcsimError(f"the exercise {exercise.name} is for {' and '.join(exercise.models)}, not for {model}")
    report = Report(exercise.name, exercise.title, model, name, source, [], task=exercise, settings=settings)
    try:
        compiled = written if isinstance(written, Program) else written.compile(model)
    except ProgramError as error:
        report.problems = [str(problem) for problem in error.problems]
        report.reason = "The program does not compile."
        report.verdicts = untried(exercise)
        return report
    report.compiled = compiled
    stage = Stage(exercise, compiled, settings)
    tried, broken, report.notes = judge(stage, runs_of(exercise, more, seed))
    if not report.notes:
        shorten(stage, broken)
    for rule in exercise.rules:
        failure = _failure(stage, broken[rule.name]) if rule.name in broken else None
        state = FAILED if failure else PASSED if rule.name in tried else UNTRIED
        report.verdicts.append(Verdict(rule.name, rule.words, state, rule.marks, failure))
    report.runs, report.simulated_s = stage.runs, round(stage.simulated_s, 3)
    report.took_s = round(time.perf_counter() - began, 3)
    return report


def untried(exercise: Exercise) -> list[Verdict]:
    """A verdict on each rule for a program that was never run."""
    return [Verdict(rule.name, rule.words, UNTRIED, rule.marks) for rule in exercise.rules]


def judge(stage: Stage, runs: Iterator[tuple[Scenario, dict[str, Any]]]) -> tuple[set[str], dict[str, Broken], list[str]]:
    """Which rules were tried in these runs, which were broken and how at the earliest, and what the PLC reported."""
    tried: set[str] = set()
    broken: dict[str, Broken] = {}
    notes: dict[str, None] = {}
    stopped = 0
    for scenario, values in runs:
        if stopped >= PATIENCE:
            notes["It was not tried any further."] = None
            break
        mine = [rule for rule in stage.exercise.rules if rule.applies(scenario.name)]
        trace, plc = stage.run(scenario, values)
        if not plc.running:
            stopped += plc.system_error == WATCHDOG
            notes.update(dict.fromkeys(f"The PLC went to STOP in the scenario {scenario.name!r}: {error}." for error in plc.errors))
        for rule in mine:
            has_tried, finding = rule.judge(trace)
            if has_tried:
                tried.add(rule.name)
            if finding is not None:
                new = Broken(rule, scenario, values, finding, trace)
                if rule.name not in broken or new.second < broken[rule.name].second:
                    broken[rule.name] = new
    return tried, broken, list(notes)


def shorten(stage: Stage, broken: dict[str, Broken], budget: int = SHORTENING) -> None:
    """Make the choices of each failure simpler as long as the rule still breaks, and no later."""
    for name in broken:
        best, again = broken[name], True
        tried = [best.values]  # the usual values can be made simpler too: without this they would come again and again
        while again:
            again = False
            for values in simpler(best.scenario.choices, best.values):
                if values in tried:
                    continue
                cost = best.finding.scan + 1
                if budget < 2 * cost:  # a shortened run is repeated for its chart
                    break
                budget -= cost
                tried.append(values)
                trace, _ = stage.run(best.scenario, values, best.finding.scan + 1)
                finding = best.rule.judge(trace).finding
                if finding is not None:
                    best, again = Broken(best.rule, best.scenario, values, finding, trace), True
                    break
        budget -= best.finding.scan + 1 if best.trace.cut else 0
        broken[name] = best


def _failure(stage: Stage, broken: Broken) -> Failure:
    """A failure as the report tells it, with its chart."""
    rule, trace, finding = broken.rule, broken.trace, broken.finding
    if trace.cut:  # the shortened run ends at the failure: let it go on a little
        behind = broken.finding.scan + 1 + round(BEHIND_S / trace.period_s)
        trace, _ = stage.run(broken.scenario, broken.values, behind)
        finding = rule.judge(trace).finding
    return Failure(
        broken.scenario.name, broken.scenario.words, broken.values, finding.scan, trace.seconds(finding.scan), rule.demand, finding.words,
        chart_of(trace, rule, finding),
    )  # fmt: skip


# -- replay ---------------------------------------------------------------------------------------------------------


class Operated:
    """A plant together with the operator of its scenario, who acts between the scans as he did when it was graded.

    It looks and behaves like the plant itself, in any session.
    """

    _own = frozenset({"_run", "_plant", "_sensors"})

    def __init__(self, run: Run):
        self._run, self._plant, self._sensors = run, run.plant, dict(run.plant.inputs) if hasattr(run.plant, "inputs") else {}

    @property
    def sensors(self) -> Sensors:
        """The faults of its sensors, which the operator switches too."""
        return self._run.session.sensors

    def step(self, seconds: float, outputs: Mapping[str, int]) -> Mapping[str, int]:
        """Move the machine, then let the operator act. A step of no time only tells what the sensors said last."""
        if seconds > 0 or not self._sensors:
            self._sensors = self._plant.step(seconds, outputs)
        if seconds > 0:
            self._run.sample()
        return self._sensors

    def state(self) -> Any:
        """Everything that changes, as a value; `restore` takes it back."""
        return plant_state(self._plant), self._sensors

    def restore(self, state: Any) -> None:
        """Make the machine what it was, and take back what the operator has done since."""
        plant, self._sensors = state
        restore_plant(self._plant, plant)
        self._run.forget(self._run.plc.clock[0])

    def __getattr__(self, name: str) -> Any:
        return getattr(self._plant, name)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self._own:
            object.__setattr__(self, name, value)
        else:
            setattr(self._plant, name, value)


@dataclass
class Replay:
    """The machine as it was shortly before a rule broke. `session` is paused; it goes on with the operator's acts of the scenario.

    A lab takes `plc` and `plant`: `Lab(replay.plc, plant=replay.plant, picture=replay.picture, autostart=False)`.
    """

    plc: Plc
    plant: Operated
    session: Session
    failure: Failure
    seconds: float  # how long before the failure this is
    picture: Any = None

    def __repr__(self) -> str:
        return f"<Replay: {self.seconds:.2f} s before {self.failure.second:.3f} s of {self.failure.scenario}>"


def replay(exercise: Exercise, program: Program, failure: Failure, seconds: float = 2.0, settings: Project | None = None) -> Replay:
    """Run a failing scenario again, with the settings that the program came with, up to `seconds` before its failure."""
    scenario = next(one for one in exercise.scenarios if one.name == failure.scenario)
    run = Stage(exercise, program, settings).begin(scenario, failure.choices)
    start = max(0, failure.scan - round(seconds / run.period_s))
    run.to(start)
    plant = Operated(run)
    session = Session(run.plc, plant, name="replay", speed=1.0)
    return Replay(run.plc, plant, session, failure, round((failure.scan - start) * run.period_s, 6), exercise.picture)
