"""A hint after repeated failures: the network in which one changed line mends the program, without the line.

Single edits are tried on the failing runs. Which come first is read off the program: networks that drive what the broken rule looks at,
and those of steps that were active when it broke.
"""

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from ..assembler import Network, Program, Unit, assemble
from ..devices import Constant, Device
from ..errors import ProgramError
from .edits import Edit, additions, edits
from .exercise import Exercise
from .grade import Stage, runs_of
from .report import Failure, Report
from .run import STEP, Scenario, Trace

SCANS = 1_600_000  # at most, over all edited programs: some 10 s
SECONDS = 20.0  # of the processor at most, for a slow one
MAKING = 1_000  # scans that could be run in the time in which a program is made ready
KEPT = {"X": "X", "Y": "Y", "M": "M", "S": "S", "T": "TB", "C": "CB", "D": "D"}  # area -> where memory keeps its contacts or values
WORDS = ("D",)
COILS = ("Y", "M", "S")
ALL, SOME, NONE = "all", "some", "none"

Progress = Callable[[int, int], Any]


@dataclass(frozen=True)
class Hint:
    """A network of the program and what a changed line in it does: it mends `all`, `some` of what fails, or `none` that was tried does."""

    unit: str
    network: int
    title: str
    lines: tuple[int, int]
    mends: str

    def __str__(self) -> str:
        first, last = self.lines
        where = f"line {first}" if first == last else f"lines {first} to {last}"
        title = f" ({self.title.splitlines()[-1]})" if self.title else ""
        place = f"network {self.network} of {self.unit}{title}, {where}"
        return {
            ALL: f"Look at {place}: one line there makes the difference.",
            SOME: f"Look at {place}: one line there makes a difference, but it is not all that there is to mend.",
            NONE: f"No single line was found that mends the program. Begin with {place}: it has to do with what broke first.",
        }[self.mends]


def hint(exercise: Exercise, report: Report, progress: Progress | None = None) -> str:
    """Where to look, in words; "" when every rule is kept. `progress(done, of)` is called now and then."""
    if report.passed:
        return ""
    if report.compiled is None:
        return "Start with the first of the compiler's messages."
    found = suspect(exercise, report, progress)
    return str(found) if found is not None else "The program does nothing yet. Begin with what the statement asks for first."


def suspect(exercise: Exercise, report: Report, progress: Progress | None = None) -> Hint | None:
    """The network in which to look for the fault of a program that compiles and fails; None for a program without any that could matter."""
    return _Search(exercise, report, progress).run()


class _Search:
    """Single edits of one failing program, the likeliest first, within a budget of scans."""

    def __init__(self, exercise: Exercise, report: Report, progress: Progress | None):
        self.exercise, self.program, self.progress = exercise, report.compiled, progress
        self.settings = report.settings
        self.spent, self.began = 0, time.process_time()
        scenarios = {scenario.name: scenario for scenario in exercise.scenarios}
        failures = sorted((one.failure for one in report.failed), key=lambda failure: (failure.scan, failure.scenario))
        self.first = failures[0] if failures else None
        failing = [(scenarios[failure.scenario], dict(failure.choices)) for failure in failures]
        self.runs: list[tuple[Scenario, dict[str, Any]]] = []
        for run in [*failing, *runs_of(exercise)]:
            if run not in self.runs:
                self.runs.append(run)
        stage = Stage(exercise, self.program, self.settings)
        self.before = self._whole(stage, self.runs[0])  # what the program does in the run that fails first
        self.broken = [self._breaks(run, self._whole(stage, run)) for run in self.runs]
        self.networks = _ranked(exercise, self.program, report, self.first, self.before if self.first else None)

    def run(self) -> Hint | None:
        """The network of the best edit: the first one that mends everything, else the one that leaves the fewest failures."""
        if not self.networks:
            return None
        best = sum(len(broken) for broken, _ in self.broken) + self._untried(tried for _, tried in self.broken)
        place = near = None
        for at, edit in self._candidates():
            if self.progress is not None:
                self.progress(min(self.spent, SCANS), SCANS)
            if self.spent >= SCANS or time.process_time() - self.began >= SECONDS:
                break
            try:
                mended = assemble(edit.text, self.program.model)
            except ProgramError:
                continue
            self.spent += MAKING
            stage = Stage(self.exercise, mended, self.settings)
            if self.first is not None and not self._gets_past(stage):
                continue
            near = near or at
            left = self._failures(stage)
            if left is not None and left < best:
                best, place = left, at
            if left == 0:
                return self._hint(at, ALL)
        return self._hint(place, SOME) if place is not None else self._hint(near or self.networks[0], NONE)

    def _hint(self, at: tuple[Unit, Network], mends: str) -> Hint:
        unit, network = at
        return Hint(unit.name, network.number, network.title, _lines(unit, network), mends)

    def _candidates(self) -> Iterator[tuple[tuple[Unit, Network], Edit]]:
        """Every edit with its network: slips before what was forgotten, each in the order of the networks."""
        yield from self._by_network(edits(self.program.source))
        yield from self._by_network(additions(self.program.source, *self._devices()))

    def _by_network(self, found: Iterable[Edit]) -> Iterator[tuple[tuple[Unit, Network], Edit]]:
        by_line: dict[int, list[Edit]] = {}
        for edit in found:
            by_line.setdefault(edit.line, []).append(edit)
        for unit, network in self.networks:
            first, last = _lines(unit, network)
            for line in range(first, last + 1):
                yield from (((unit, network), edit) for edit in by_line.get(line, ()))

    def _devices(self) -> tuple[list[str], list[str], list[str]]:
        """The bits that change before the first failure, as contacts; those that a program can write, as coils; words that change."""
        stage = Stage(self.exercise, self.program, self.settings)
        run = stage.begin(*self.runs[0])
        plc = run.plc
        named = plc.in_use(KEPT)
        named += [
            device for device in (plc.memory.parse(name)[0] for name in self.exercise.wiring) if device.area == "X" and device not in named
        ]
        places = [(plc.memory.lists[KEPT[device.area]], device.number) for device in named]
        first, moved = [values[number] for values, number in places], set()
        end = self.first.scan if self.first is not None else run.end
        for scan in range(1, end + 2):
            run.to(scan)
            moved |= {place for place, (values, number) in enumerate(places) if values[number] != first[place]}
        self.spent += end
        moving = [named[place] for place in sorted(moved)]
        contacts, words = ([str(device) for device in moving if (device.area in WORDS) == word] for word in (False, True))
        return contacts, [str(device) for device in named if device.area in COILS], words

    def _whole(self, stage: Stage, run: tuple[Scenario, dict[str, Any]]) -> Trace:
        trace, _ = stage.run(*run)
        self.spent += trace.done
        return trace

    def _gets_past(self, stage: Stage) -> bool:
        """Whether the program behaves otherwise up to the first failure, and nothing is broken there any more."""
        run = stage.begin(*self.runs[0])
        trace = run.to(self.first.scan + 1)
        self.spent += trace.done
        same = sum(scan <= self.first.scan for scan in self.before.scans)
        return trace.rows != self.before.rows[:same] and not self._breaks(self.runs[0], trace)[0]

    def _breaks(self, run: tuple[Scenario, dict[str, Any]], trace: Trace) -> tuple[set[str], set[str]]:
        """The rules that a run breaks, and those that it tries."""
        judged = {rule.name: rule.judge(trace) for rule in self.exercise.rules if rule.applies(run[0].name)}
        return {name for name, one in judged.items() if one.finding is not None}, {name for name, one in judged.items() if one.tried}

    def _failures(self, stage: Stage) -> int | None:
        """How many rules break, counted for each run, and how many are never tried; None when one breaks that was kept before."""
        count, all_tried = 0, []
        for run, (before, _) in zip(self.runs, self.broken, strict=True):
            broken, tried = self._breaks(run, self._whole(stage, run))
            if broken - before:
                return None
            count += len(broken)
            all_tried.append(tried)
        return count + self._untried(all_tried)

    def _untried(self, tried: Iterable[set[str]]) -> int:
        return len(self.exercise.rules) - len(set().union(*tried))


def _lines(unit: Unit, network: Network) -> tuple[int, int]:
    return unit.instructions[network.start].line, unit.instructions[network.end - 1].line


# -- which networks come first --------------------------------------------------------------------------------------


class _Uses:
    """What a network reads and writes, by area and number; its steps are read, and left by a transition out of them."""

    def __init__(self, unit: Unit, network: Network):
        self.steps = {("S", number) for kind, number in network.region if kind == "STL"}
        self.read, self.written = set(self.steps), set()
        for instruction in unit.instructions[network.start : network.end]:
            numbers = {
                spec.name: operand.value for spec, operand in zip(instruction.definition.operands, instruction.operands, strict=False)
                if isinstance(operand, Constant)
            }  # fmt: skip
            for spec, operand in zip(instruction.definition.operands, instruction.operands, strict=False):
                if isinstance(operand, Device):
                    length = spec.length(numbers) or 1
                    places = {(operand.area, operand.number + more) for more in range(max(1, length))}
                    if spec.written or instruction.definition.form in ("always", "command"):
                        self.written |= places
                    if spec.read or not spec.written:
                        self.read |= places
        if any(area == "S" for area, _ in self.written):
            self.written |= self.steps


def _ranked(
    exercise: Exercise, program: Program, report: Report, failure: Failure | None, trace: Trace | None
) -> list[tuple[Unit, Network]]:
    """The networks that can have to do with a failure, the likeliest first."""
    places = [(unit, network) for unit in program.units for network in unit.networks]
    uses = [_Uses(*place) for place in places]
    distances = _distances(uses, _looked_at(exercise, report, failure))
    active = _last_active(trace, failure)
    ranks = {}
    for number, use in enumerate(uses):
        since = min((active.get(step, -1) for step in use.steps), default=0) if active is not None else 0
        if since >= 0:
            late = 0 if not use.steps or failure is None or since >= failure.scan - 2 else 1
            ranks[number] = distances.get(number, len(uses)) + late
    return [places[number] for number in sorted(ranks, key=lambda number: (ranks[number], number))]


def _looked_at(exercise: Exercise, report: Report, failure: Failure | None) -> set[tuple[str, int]]:
    """The outputs that the rule of a failure looks at, all outputs where it looks at none."""
    broken = next((one.rule for one in report.failed if one.failure is failure), None)
    rule = next((rule for rule in exercise.rules if rule.name == broken), None)
    names = {point.name: device for device, point in exercise.wiring.items()}
    for lanes in (rule.marked, rule.lanes) if rule is not None else ():
        found = {names.get(lane, lane) for lane in lanes}
        outputs = {device for device in found if device in exercise.wiring and device[0] == "Y"}
        if outputs:
            break
    else:
        outputs = {device for device in exercise.wiring if device[0] == "Y"}
    return {("Y", int(device[1:], 8)) for device in outputs}


def _distances(uses: list[_Uses], wanted: set[tuple[str, int]]) -> dict[int, int]:
    """Number of a network -> how far what it writes is from what is wanted: 0 writes it, 1 writes what such a network reads."""
    found: dict[int, int] = {}
    seen, distance = set(wanted), 0
    while wanted:
        reached = {number for number, use in enumerate(uses) if number not in found and use.written & wanted}
        found |= dict.fromkeys(reached, distance)
        wanted = set().union(*(uses[number].read for number in reached)) - seen
        seen |= wanted
        distance += 1
    return found


def _last_active(trace: Trace | None, failure: Failure | None) -> dict[tuple[str, int], int] | None:
    """Step -> the last scan up to the failure in which it was active; None where steps cannot be seen."""
    if trace is None or STEP not in trace.places:
        return None
    changes = [*trace.lane(STEP), (trace.end, "")]
    last: dict[tuple[str, int], int] = {}
    for (scan, steps), (after, _) in pairwise(changes):
        if scan <= failure.scan:
            last |= {("S", int(step[1:])): min(after - 1, failure.scan) for step in str(steps).split()}
    return last
