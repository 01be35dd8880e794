"""A hint after repeated failures: the network in which one changed place mends the program, without the change.

Single edits are tried on the failing runs: slips of the hand, and what repairs may be made of. Each network gets time as it is under
suspicion; what mends all is named at once, else what mends most.
"""

import heapq
import re
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import chain, pairwise, zip_longest
from typing import Any

from ..assembler import Network, Program, Unit, assemble
from ..devices import Device
from ..errors import ProgramError
from .edits import Edit, edits
from .exercise import Exercise
from .grade import Stage, runs_of
from .repairs import Parts, additions, branches, everywhere, exchanges, omissions, orders
from .report import Report
from .rules import Finding, Rule
from .run import Scenario, Trace
from .signals import compressed
from .suspects import suspects

SCANS = 2_500_000  # at most, over all edited programs: some 15 s
SECONDS = 20.0  # of the processor at most, for a slow one
MAKING = 1_000  # scans that could be run in the time in which a program is made ready
LATER, LATEST = 3, 5  # so many times less for repairs in a line, and for whole networks, than for slips of the hand
KEPT = {"X": "X", "Y": "Y", "M": "M", "S": "S", "T": "TB", "C": "CB", "D": "D"}  # area -> where memory keeps its contacts or values
WORDS = ("D",)
COILS = ("Y", "M", "S")
ANYWHERE = 2  # the same for inputs that the program does not look at, in each network alike
FURTHER = 1_000_000  # scans in which a line to be changed is looked for after a network has been found that could be added
SLACK = 1  # so many rules may come up no more in a run, as what they speak of was a part of the fault
CHATTER = 50  # changes of the outputs in two scans that follow one another: more is no way to drive a machine
CLOCKS = ("clock 1 s", "clock 100 ms")  # what may be missing in a network besides what the program names
SECONDS_IN = {"ms": 0.001, "s": 1, "second": 1, "seconds": 1, "min": 60, "minute": 60, "minutes": 60, "hour": 3600, "hours": 3600}
ROUND = tuple(str(digit * power) for power in (1, 10, 100, 1000) for digit in (1, 2, 5))
ALL, SOME, NONE = "all", "some", "none"

QUESTIONS = {  # area of what a network writes -> what to ask
    "Y": "what switches {} ON, and what OFF",
    "T": "when {} begins, and how long it is to take",
    "C": "what {} counts, and how far",
    "D": "when {} changes, and to what",
}

Progress = Callable[[int, int], Any]
Run = tuple[Scenario, dict[str, Any]]
_NUMBER = re.compile(r"(?<![\w.#])(\d+(?:\.\d+)?)\W*([a-z]+)?")


@dataclass(frozen=True)
class Hint:
    """A network of the program and what a changed place in it does: it mends `all`, `some` of what fails, or `none` that was tried does.

    `missing` tells that something is missing behind the network; `look` is what to look at, in words; `others` come under suspicion next.
    """

    unit: str
    network: int
    title: str
    lines: tuple[int, int]
    mends: str
    missing: bool = False
    look: str = ""
    others: tuple[int, ...] = ()

    def __str__(self) -> str:
        first, last = self.lines
        where = f"line {first}" if first == last else f"lines {first} to {last}"
        title = f" ({self.title.splitlines()[-1]})" if self.title else ""
        place = f"network {self.network} of {self.unit}{title}, {where}"
        ask = f" Ask yourself {self.look}." if self.look else ""
        if self.mends == NONE:
            others = f", then with network{'s' * (len(self.others) > 1)} {' and '.join(map(str, self.others))}" if self.others else ""
            return (
                f"No single change was found that mends the program. Begin with {place}: it has to do with what broke first{others}.{ask}"
            )
        all_of_it = "" if self.mends == ALL else ", but it is not all that there is to mend"
        if self.missing:
            return f"Something is missing behind {place}: it makes {'the' if self.mends == ALL else 'a'} difference{all_of_it}.{ask}"
        return f"Look at {place}: a change there makes {'the' if self.mends == ALL else 'a'} difference{all_of_it}.{ask}"


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


@dataclass(order=True)
class _Queue:
    """The edits of one kind in one network, and the cost of what was tried of them, weighed by how little it is under suspicion."""

    cost: float
    number: int
    weight: float = field(compare=False)
    place: tuple[Unit, Network] = field(compare=False)
    edits: Iterator[Edit] = field(compare=False)
    missing: bool = field(compare=False, default=False)


@dataclass(frozen=True, order=True)
class _Outcome:
    """What an edit comes to: the greater the better."""

    mends: bool  # all
    helps: bool  # some, and harms nothing
    clean: bool  # it harms nothing in the run that failed first
    gain: int  # rules kept now, less those that are not any more, counted for each run up to the one with harm; 0 for one that mends
    inside: bool  # a network is changed, none is added


class _Search:
    """Single edits of one failing program within a budget of scans."""

    def __init__(self, exercise: Exercise, report: Report, progress: Progress | None):
        self.exercise, self.program, self.progress = exercise, report.compiled, progress
        self.settings = report.settings
        self.spent, self.began = 0, time.process_time()
        scenarios = {scenario.name: scenario for scenario in exercise.scenarios}
        failed = sorted(report.failed, key=lambda one: (one.failure.scan, one.failure.scenario))
        self.first = failed[0].failure if failed else None
        self.rule: Rule | None = next((rule for rule in exercise.rules if failed and rule.name == failed[0].rule), None)
        self.runs: list[Run] = []
        for run in [*((scenarios[one.failure.scenario], dict(one.failure.choices)) for one in failed), *runs_of(exercise)]:
            if run not in self.runs:
                self.runs.append(run)
        stage = Stage(exercise, self.program, self.settings)
        self.before = self._whole(stage, self.runs[0])  # what the program does in the run that fails first
        self.judged = [self._judged(run, self._whole(stage, run)) for run in self.runs]
        self.finding: Finding | None = self.rule.judge(self.before).finding if self.rule is not None else None
        self.networks = suspects(exercise, self.program, self.rule, self.finding, self.before)
        self.order = list(range(len(self.runs)))  # in which an edited program goes through the runs: first the one that fails first

    def run(self) -> Hint | None:
        """The network of the first edit that mends everything, else of the one that comes to most."""
        if not self.networks:
            return None
        best, limit = None, SCANS
        for queue, edit in self._candidates():
            if self.progress is not None:
                self.progress(min(self.spent, SCANS), SCANS)
            if self.spent >= limit or time.process_time() - self.began >= SECONDS:
                break
            outcome = self._outcome(edit.text, not queue.missing)
            if outcome is not None and (outcome.mends or outcome.gain > 0) and (best is None or outcome > best[0]):
                best = outcome, queue
                if outcome.mends and outcome.inside:
                    break
                if outcome.mends:
                    limit = min(limit, self.spent + FURTHER)
        return self._hint(best)

    def _hint(self, best: tuple[_Outcome, _Queue] | None) -> Hint:
        outcome, queue = best or (None, None)
        unit, network = queue.place if queue is not None else self.networks[0]
        mends = NONE if outcome is None or not (outcome.mends or outcome.helps) else ALL if outcome.mends else SOME
        missing = queue is not None and queue.missing and mends != NONE
        others = [other.number for of, other in self.networks[:4] if of is unit and other is not network][:2] if mends == NONE else ()
        return Hint(
            unit.name, network.number, network.title, _lines(unit, network), mends, missing, _look(unit, network, missing), tuple(others)
        )

    # -- what is tried -------------------------------------------------------------------------------------------

    def _candidates(self) -> Iterator[tuple[_Queue, Edit]]:
        """Every edit, each time from the network that has had the least of its share."""
        tried: set[str] = {self.program.source}
        queues = self._queues()
        heapq.heapify(queues)
        while queues:
            queue = heapq.heappop(queues)
            edit = next((edit for edit in queue.edits if edit.text not in tried), None)
            if edit is not None:
                tried.add(edit.text)
                before = self.spent
                yield queue, edit
                queue.cost += queue.weight * (self.spent - before + 1)
                heapq.heappush(queues, queue)

    def _queues(self) -> list[_Queue]:
        text, parts = self.program.source, self._parts()
        groups = self._groups()
        ends = [group[-1][1] for group in groups]
        found = []
        unread = Parts(contacts=[contact for contact in parts.contacts if contact in self.unread])
        kinds: list[tuple[int, bool, bool, Iterable[Edit]]] = [
            (1, True, False, edits(text)),
            (1, True, False, everywhere(text, parts)),
            (LATER, True, False, exchanges(text, parts)),
            (LATER, True, False, additions(text, parts)),
            (LATEST, True, False, orders(text, groups)),
            (LATEST, True, True, omissions(text, ends, parts)),
        ]
        if unread.contacts:  # it may be missing anywhere
            kinds.append((ANYWHERE, False, False, chain(exchanges(text, unread), additions(text, unread))))
            unread = replace(parts, contacts=unread.contacts)
            kinds.append((ANYWHERE, False, True, branches(text, unread)))
            kinds.append((ANYWHERE, False, True, omissions(text, ends, unread)))
        for later, ranked, missing, kind in kinds:
            by_line: dict[int, list[Edit]] = {}
            for edit in kind:
                by_line.setdefault(edit.line, []).append(edit)
            for rank, (unit, network) in enumerate(self.networks, 1):
                first, last = _lines(unit, network)
                lines = [by_line[line] for line in range(first, last + 1) if line in by_line]
                mine = [edit for edits in zip_longest(*lines) for edit in edits if edit is not None]
                if mine:
                    weight = later * (rank if ranked else 1)
                    found.append(_Queue(weight * MAKING, len(found), weight, (unit, network), iter(mine), missing))
        return found

    def _groups(self) -> list[list[tuple[int, int]]]:
        """First and last lines of the networks of each step, and of those outside of steps."""
        groups: dict[tuple, list[tuple[int, int]]] = {}
        for unit in self.program.units:
            for network in unit.networks:
                if unit.instructions[network.start].mnemonic not in ("STL", "RET"):
                    groups.setdefault((unit.name, network.region), []).append(_lines(unit, network))
        return sorted(groups.values())

    def _parts(self) -> Parts:
        """What the program could need: bits that change before the first failure, those not looked at first, then those of the broken rule."""
        stage = Stage(self.exercise, self.program, self.settings)
        run = stage.begin(*self.runs[0])
        plc, model = run.plc, run.plc.model
        named = plc.in_use(KEPT)
        used = set(named)
        wired = [plc.memory.parse(name)[0] for name in self.exercise.wiring]
        named += [device for device in wired if device.area in KEPT and device not in named]
        places = [(plc.memory.lists[KEPT[device.area]], device.number) for device in named]
        first, moved = [values[number] for values, number in places], set()
        end = self.first.scan if self.first is not None else run.end
        for scan in range(1, end + 2):
            run.to(scan)
            moved |= {place for place, (values, number) in enumerate(places) if values[number] != first[place]}
        self.spent += end
        names = {variable.device: name for name, variable in self.program.variables.items()}
        asked = set(self.rule.lanes) if self.rule is not None else set()
        points = {plc.memory.parse(name)[0]: point.name for name, point in self.exercise.wiring.items()}
        moved |= {place for place, device in enumerate(named) if device.area == "X" and device not in used and points.get(device) in asked}
        moving = sorted((named[place] for place in sorted(moved)), key=lambda device: (device in used, points.get(device) not in asked))
        written = lambda devices: [names.get(device, str(device)) for device in devices]
        self.unread = {name for device, name in zip(moving, written(moving), strict=True) if device.area == "X" and device not in used}
        clocks = [str(Device(model.special_bits, model.relays[clock])) for clock in CLOCKS if clock in model.relays]
        return Parts(
            written(device for device in moving if device.area not in WORDS),
            clocks,
            written(device for device in named if device.area in COILS and device.area != "S"),
            written(device for device in named if device.area == "S"),
            written(device for device in moving if device.area in WORDS),
            _numbers(self.program, self.exercise),
        )

    # -- what becomes of it --------------------------------------------------------------------------------------

    def _outcome(self, text: str, inside: bool) -> _Outcome | None:
        """What an edited program comes to; None where it breaks as much as before in the run that failed first."""
        try:
            program = assemble(text, self.program.model)
        except ProgramError:
            return None
        self.spent += MAKING
        stage = Stage(self.exercise, program, self.settings)
        if self.first is not None and not self._gets_past(stage):
            return None
        gain, untried, broken_at_all = 0, {rule.name for rule in self.exercise.rules}, False
        for place, number in enumerate(self.order):
            tried, broken = self.judged[number]
            trace = self._whole(stage, self.runs[number])
            now, breaks = self._judged(self.runs[number], trace)
            more = len(now - breaks) - len(tried - broken)
            if place == 0 and more <= 0 and len(breaks) >= len(broken):
                return None
            if breaks & (tried - broken) or more < -SLACK or self._chatters(trace):
                if place > 1:  # what harm shows in comes sooner from now on
                    self.order.insert(1, self.order.pop(place))
                return _Outcome(False, False, place > 0, gain or more, inside)
            gain += more
            broken_at_all = broken_at_all or bool(breaks)
            untried -= now
        mends = not broken_at_all and not untried
        return _Outcome(mends, gain > 0, True, 0 if mends else gain, inside)

    def _chatters(self, trace: Trace) -> bool:
        """Whether outputs go ON and OFF from scan to scan as no machine is driven."""
        group = next(trace.places[device][0] for device in self.exercise.wiring if device[0] == "Y")
        changes = compressed(zip(trace.scans, (row[group] for row in trace.rows), strict=True))
        return sum(after - scan == 1 for (scan, _), (after, _) in pairwise(changes)) > CHATTER

    def _whole(self, stage: Stage, run: Run) -> Trace:
        trace, _ = stage.run(*run)
        self.spent += trace.done
        return trace

    def _gets_past(self, stage: Stage) -> bool:
        """Whether the program behaves otherwise up to the first failure, and nothing is broken there any more."""
        run = stage.begin(*self.runs[0])
        trace = run.to(self.first.scan + 1)
        self.spent += trace.done
        same = sum(scan <= self.first.scan for scan in self.before.scans)
        return trace.rows != self.before.rows[:same] and not self._judged(self.runs[0], trace)[1]

    def _judged(self, run: Run, trace: Trace) -> tuple[set[str], set[str]]:
        """The rules that a run tries, and those that it breaks."""
        judged = {rule.name: rule.judge(trace) for rule in self.exercise.rules if rule.applies(run[0].name)}
        return {name for name, one in judged.items() if one.tried}, {name for name, one in judged.items() if one.finding is not None}


def _lines(unit: Unit, network: Network) -> tuple[int, int]:
    return unit.instructions[network.start].line, unit.instructions[network.end - 1].line


def _numbers(program: Program, exercise: Exercise) -> list[str]:
    """The numbers of a program, then those of the statement, times in the units of timers."""
    own = [word for one in program.instructions for word in one.written if word.lstrip("-").isdigit()]
    path = exercise.folder / "statement.md"
    asked = []
    for number, unit in _NUMBER.findall(path.read_text(encoding="utf-8") if path.is_file() else ""):
        if unit in SECONDS_IN:
            asked += [float(number) * SECONDS_IN[unit] * tenths for tenths in (10, 100)]
        else:
            asked.append(float(number))
    return list(dict.fromkeys([*own, *(str(round(number)) for number in asked if number == round(number) and number), *ROUND]))


def _look(unit: Unit, network: Network, missing: bool) -> str:
    """What a network is about, as a question."""
    steps = [f"S{number}" for kind, number in network.region if kind == "STL"]
    if missing:
        return f"what else has to happen in step {steps[-1]}" if steps else "what else the program has to do"
    for instruction in reversed(unit.instructions[network.start : network.end]):
        for operand, written in zip(instruction.operands, instruction.written, strict=False):
            if isinstance(operand, Device) and instruction.definition.form != "contact":
                if operand.area == "S":
                    return f"what lets step {steps[-1]} end" if steps else f"when step {written} is set or cleared"
                return QUESTIONS.get(operand.area, QUESTIONS["Y"]).format(written)
    return ""
