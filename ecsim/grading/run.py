"""A scenario and its run: the program drives the machine while an operator acts, and the lanes are noted at each change."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, Any

from ..errors import EcsimError
from ..plc import Plc
from ..session import Session
from .choices import Choice, chosen
from .rest import Rest
from .signals import Condition, Signal, compressed, condition, intervals

if TYPE_CHECKING:
    from .exercise import Exercise

QUIET = 8
STEP = "Step"  # the lane of the active steps, which charts show and rules leave alone


@dataclass(frozen=True)
class Do:
    """One act of the operator; acts are done one after the other.

    It is done at second `at` of the run, or `after` seconds behind the moment at which `when` holds (now, if it does
    already), or behind the act before it. `set` maps devices, or names of the wiring, to values; with `hold` they go back to 0 after so many
    seconds. `fail` and `mend` switch a fault of machine or sensor in and out ("jammed", "X1 stuck 0"; see `Session.fail`).
    `act(plc, plant)` is for all else, as power off and on. Without any it only waits.
    """

    set: Mapping[str, Any] = field(default_factory=dict)
    at: float | None = None
    when: str | None = None
    after: float = 0.0
    hold: float | None = None
    fail: str = ""
    mend: str = ""
    act: Callable[[Plc, Any], Any] | None = None

    def __post_init__(self):
        if self.at is not None and (self.when is not None or self.after):
            raise EcsimError(f"an act has a time (at={self.at}) or a condition, not both")
        if self.when is not None and condition(self.when).parts:
            raise EcsimError(f"the act waits for {self.when!r}; it can wait for lanes only: wait for ON, then for OFF, in two acts")


@dataclass(frozen=True)
class Scenario:
    """A machine, an operator and a length of time. `name` is short, `words` say what happens.

    `choices` are what may be otherwise, by name. `plant`, `script` and `seconds` may be functions of them:
    `lambda chosen: Conveyor(first=chosen.first)`; `plant` is the exercise's own unless given, None for a scenario in
    which the script sets the inputs by hand. It ends after `seconds` of simulated time, or `tail` seconds after `until`
    holds. `draws` is how often it is graded with drawn choices besides the usual ones; `scan_ms` is the scan's length
    if the exercise's own does not fit.
    """

    name: str
    words: str
    seconds: Any
    script: Any = ()
    choices: Mapping[str, Choice] = field(default_factory=dict)
    plant: Any = ...
    until: str | None = None
    tail: float = 1.0
    draws: int = 4
    scan_ms: float | None = None

    def __post_init__(self):
        if self.until is not None and condition(self.until).parts:
            raise EcsimError(f"the scenario {self.name} ends when {self.until!r} holds; name lanes only there")


@dataclass
class Trace:
    """What the lanes did in one run. Scans count from 0; a scan's row says what stood after it."""

    period_s: float
    end: int  # how many scans there were
    scans: list[int]
    rows: list[tuple[tuple, ...]]
    places: Mapping[str, tuple[int, int]]  # lane -> where it stands in a row
    aliases: Mapping[str, str]  # name of the wiring -> lane
    steps: Sequence[str] = ()  # the devices of the lane `Step`
    cut: bool = False  # it was ended before its time
    done: int = 0  # scans that were worked through, and not passed over
    _lanes: dict[str, Signal] = field(default_factory=dict, repr=False)
    _groups: dict[int, list[tuple[int, tuple]]] = field(default_factory=dict, repr=False)
    _signals: dict[str, Signal] = field(default_factory=dict, repr=False)  # of conditions

    def lane(self, name: str) -> Signal:
        """The changes of one lane: a device, a name of the wiring or a quantity of the plant."""
        lane = self.aliases.get(name, name)
        if lane not in self._lanes:
            if lane not in self.places:
                known = ", ".join([*self.aliases, *(place for place in self.places if place not in self.aliases.values())])
                raise EcsimError(f"there is no lane {name!r} in this exercise; there are {known}")
            group, place = self.places[lane]
            if lane == STEP:
                changes = [
                    (scan, " ".join(step for step, on in zip(self.steps, row, strict=False) if on)) for scan, row in self._group(group)
                ]
            else:
                changes = [(scan, row[place]) for scan, row in self._group(group)]
            self._lanes[lane] = compressed(changes)
        return self._lanes[lane]

    def _group(self, group: int) -> list[tuple[int, tuple]]:
        """The changes of one part of the rows."""
        if group not in self._groups:
            found, last = [], None
            for scan, row in zip(self.scans, self.rows, strict=True):
                now = row[group]
                if now is not last and now != last:
                    found.append((scan, now))
                    last = now
            self._groups[group] = found
        return self._groups[group]

    def signal(self, text: str) -> Signal:
        """A condition as a signal."""
        return condition(text).over(self.lane, self.period_s, self._signals)

    def intervals(self, text: str) -> list[tuple[int, int]]:
        """Where a condition holds: (first scan, first scan behind it)."""
        return intervals(self.signal(text), self.end)

    def seconds(self, scan: int) -> float:
        """When a scan began, in seconds of the run."""
        return round(scan * self.period_s, 6)

    def up_to(self, scan: int) -> "Trace":
        """The same run, ended behind a scan."""
        if scan + 1 >= self.end:
            return self
        count = next((place for place, when in enumerate(self.scans) if when > scan), len(self.scans))
        return Trace(self.period_s, scan + 1, self.scans[:count], self.rows[:count], self.places, self.aliases, self.steps, cut=True)

    @cached_property
    def names(self) -> dict[str, str]:
        """Lane -> its name in the wiring."""
        return {lane: name for name, lane in self.aliases.items()}


class Run:
    """One scenario under way on a Plc that is switched on anew. It is the recording of its own session."""

    def __init__(self, exercise: "Exercise", plc: Plc, scenario: Scenario, values: Mapping[str, Any]):
        self.plc, self.scenario, self.values = plc, scenario, dict(values)
        plant = exercise.plant() if scenario.plant is ... else chosen(scenario.plant, values)
        self.plant = plant
        self.names = {point.name: device for device, point in exercise.wiring.items()}
        self.session = Session(plc, plant, name=f"{exercise.name}: {scenario.name}", speed=None, record=self)
        self.period_s = plc.period_us / 1e6
        self.end = round(chosen(scenario.seconds, values) / self.period_s)
        self._script = list(chosen(scenario.script, values))
        self._first = plc.scans
        self._generation = plc.memory.generation
        self._look_at(exercise)
        self._awaited: dict[str, _Awaited] = {}  # by text
        self.scans: list[int] = []
        self.rows: list[tuple] = []
        self._last: tuple | None = None
        self._position, self._since = 0, 0  # the act that comes next, and the scan from which it may
        self._due: int | None = None  # the scan before which it is done, None while it waits for its condition
        self._releases: list[tuple[int, tuple[str, ...]]] = []
        self._journal: list[tuple[int, tuple]] = []  # scan -> where the script was before it
        self._until: int | None = None
        self._rest = Rest(self.session)
        self._passed = 0
        self._quiet, self._ask_at = 0, QUIET  # scans without a change, and from how many on it is asked whether scans may be passed over
        plc.run()
        self._plan()
        self._act(0)

    def _look_at(self, exercise: "Exercise") -> None:
        """One getter for each list that lanes come from."""
        plc, lists = self.plc, self.plc.memory.lists
        told = [name for name in self.session._registers if name in self.session.sensors.says]
        groups: dict[tuple[str, bool], list[tuple[str, int]]] = {}
        for name in exercise.wiring:
            device, _ = plc.memory.parse(name)
            groups.setdefault((device.area, name in told), []).append((name, device.number))
        steps = plc.in_use(("S",))
        self.steps = [str(step) for step in steps]
        self.places: dict[str, tuple[int, int]] = {}
        self._looks: list[tuple[Callable, Any]] = []
        self._quantities: list[int] = []  # the group of the machine's quantities
        self._moving: list[int] = []  # what may change while only the machine goes on: those, and what it tells in registers
        for (area, by_machine), devices in groups.items():
            self.places |= {name: (len(self._looks), place) for place, (name, _) in enumerate(devices)}
            self._moving += [len(self._looks)] * by_machine
            self._looks.append((_getter([number for _, number in devices]), lists[area]))
        if self.plant is not None and exercise.quantities:
            self.places |= {name: (len(self._looks), place) for place, name in enumerate(exercise.quantities)}
            self._quantities = [len(self._looks)]
            self._looks.append((_attributes(exercise.quantities), self.plant))
        if steps:
            self.places[STEP] = len(self._looks), 0
            self._looks.append((_getter([step.number for step in steps]), lists["S"]))
        self._moving += self._quantities
        self._apart = _getter([group for group in range(len(self._looks)) if group not in self._moving])

    # -- the run ------------------------------------------------------------------------------------------------

    def to(self, scan: int | None = None) -> Trace:
        """Go on until so many scans are done, to the scenario's end unless given, and tell what was noted."""
        step, plc, first = self.session._step, self.plc, self._first
        cut = scan is not None and scan < self.end
        self._stop_at = scan if cut else self.end
        while plc.scans - first < self._stop_at:
            step()
            if self._quiet >= self._ask_at:
                self._pass_over()
        return Trace(
            self.period_s, self._stop_at, self.scans, self.rows, self.places, self.names, self.steps, cut, self._stop_at - self._passed
        )

    def sample(self) -> None:
        """After each scan: note what has changed, and let the operator act before the next one."""
        now = tuple([look(source) for look, source in self._looks])
        done = self.plc.scans - self._first
        self._quiet += 1
        if now != self._last:
            if self._last is None or self._apart(now) != self._apart(self._last):
                self._quiet, self._ask_at = 0, QUIET
            self._note(done, now)
        if done == self._due or (self._releases and done >= self._releases[0][0]):
            self._act(done)

    def _note(self, done: int, now: tuple) -> None:
        """Something has changed in the last of so many scans: perhaps what the operator waits for, or what ends the run."""
        self._last = now
        self.scans.append(done - 1)
        self.rows.append(now)
        if self._due is None and self._position < len(self._script) and self._holds(self._script[self._position].when):
            self._due = done + self._scans(self._script[self._position].after)
        if self._until is None and self.scenario.until is not None and self._holds(self.scenario.until):
            self._until = done + self._scans(self.scenario.tail)
            self._stop_at = min(self._stop_at, self._until)

    def _pass_over(self) -> None:
        """The program has done nothing for some scans: perhaps it will not for many more."""
        done = self.plc.scans - self._first
        ends = [self._stop_at, *([self._due] if self._due is not None else []), *([self._releases[0][0]] if self._releases else [])]
        count = self._rest.scans(min(ends) - done - 1)
        still = min(count, self._rest.still) if count else 0
        if still:
            self._rest.pass_over(still)
            self._passed += still
            if self.plant is not None:
                self.plant.step(still * self.period_s, self.session._outputs)
            self._quiet = 0
        elif count:
            self._glide(count)
            self._quiet = 0
        elif self._quiet > self._ask_at:  # asked twice, one scan after the other
            self._ask_at = 2 * self._quiet

    def _glide(self, most: int) -> None:
        """The machine goes on alone for so many scans, or until it says what the program looks at, or the operator has something to do."""
        session, first, last = self.session, self.plc.scans - self._first, self._last
        goes_on, step, outputs, seconds = self._rest.listener(), self.plant.step, session._outputs, self.period_s
        done, said, waits = first, session._last_sensors, (self._due, self._stop_at)
        while done < first + most and waits == (self._due, self._stop_at):
            sensors, before = step(seconds, outputs), said
            done, said = done + 1, sensors
            if said is not before and not goes_on(said):
                break
            if said is before and not (done - first) % QUIET and self._rest.still:
                break
            now = last
            for group in self._quantities if said is before else self._moving:
                look, source = self._looks[group]
                found = look(source)
                if found != now[group]:
                    now = (*now[:group], found, *now[group + 1 :])
            if now is not last:
                self._note(done, now)
                last = now
        # The last of these scans is done by the PLC as well: its timers have counted when something changes.
        self._rest.pass_over(done - 1 - first)
        self.plc.turn()
        before, session._last_sensors = session._last_sensors, said
        session._enter(said, self.plc.clock[0], before)
        self.sample()

    def _scans(self, seconds: float) -> int:
        return round(seconds / self.period_s)

    def _plan(self) -> None:
        """When the next act is due."""
        self._due = None
        if self._position < len(self._script):
            do = self._script[self._position]
            if do.at is not None:
                self._due = max(self._since, self._scans(do.at))
            elif do.when is None or self._holds(do.when):
                self._due = self._since + self._scans(do.after)

    def _holds(self, text: str | None) -> bool:
        """Whether a condition over lanes holds now."""
        if text is None or self._last is None:
            return False
        if text not in self._awaited:
            asked: Condition = condition(text)
            places = [self._place(name) for name in asked.names]
            self._awaited[text] = _Awaited(asked.expression, places, _getter([group for group, _ in places]))
        return self._awaited[text].holds(self._last)

    def _place(self, name: str) -> tuple[int, int]:
        """Where a lane stands in a row."""
        lane = self.names.get(name, name)
        if lane not in self.places:
            raise EcsimError(f"the scenario {self.scenario.name} asks for {name!r}; there are {', '.join([*self.names, *self.places])}")
        return self.places[lane]

    def _act(self, done: int) -> None:
        """What the operator does before the scan with this number."""
        self._journal.append((done, (self._position, self._since, self._due, tuple(self._releases))))
        while self._releases and self._releases[0][0] <= done:
            for device in self._releases.pop(0)[1]:
                self.plc[device] = 0
        while self._due is not None and self._due <= done:
            do = self._script[self._position]
            devices = {self.names.get(name, name): value for name, value in do.set.items()}
            self.plc.set(devices)
            if do.hold is not None:
                self._releases = sorted([*self._releases, (done + max(1, self._scans(do.hold)), tuple(devices))])
            if do.fail:
                self.session.sensors.fail(do.fail)
            if do.mend:
                self.session.sensors.mend(do.mend)
            if do.act is not None:
                do.act(self.plc, self.plant)
            self._position, self._since = self._position + 1, done
            self._plan()

    def forget(self, time_us: int) -> None:
        """The session went back to a moment: what was noted, and what the operator did after it, has not happened."""
        done = self.plc.scans - self._first
        while self.scans and self.scans[-1] >= done:
            self.scans.pop()
            self.rows.pop()
        while self._journal and self._journal[-1][0] > done:
            self._position, self._since, self._due, releases = self._journal.pop()[1]
            self._releases = list(releases)
        self._last = self.rows[-1] if self.rows else None


@dataclass
class _Awaited:
    """A condition over lanes that is asked for again and again, mostly without a change."""

    expression: Callable[..., Any]
    places: list[tuple[int, int]]  # of its lanes in a row
    groups: Callable[[tuple], tuple]
    seen: tuple | None = None
    held: bool = False

    def holds(self, row: tuple) -> bool:
        """Whether it holds in a row."""
        seen = self.groups(row)
        if seen != self.seen:
            self.seen, self.held = seen, bool(self.expression(*[row[group][place] for group, place in self.places]))
        return self.held


def _getter(numbers: list[int]) -> Callable[[Sequence], tuple]:
    return itemgetter(*numbers, numbers[0]) if numbers else lambda values: ()


def _attributes(names: Sequence[str]) -> Callable[[Any], tuple]:
    return attrgetter(*names, names[0])
