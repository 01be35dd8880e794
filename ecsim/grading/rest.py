"""Scans in which nothing happens, passed over: a machine that waits for a timer of minutes is graded in no time.

A program that reads neither clocks nor the values of timers does the same in each scan until an input changes or a timer
comes to its preset. Once a scan has left all devices as they were, the ones up to there need not be done: time, timers and the
machine are put forward to it. A register that the machine writes and the program only compares with others, as the weight on a
scale, may change meanwhile as long as every comparison comes out the same: then the machine alone goes on from scan to scan.
What is noted of a run is the same as without (tests/grading/test_rest.py).
"""

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Mapping
from operator import itemgetter
from typing import Any, NamedTuple

from ..assembler import Instruction
from ..devices import Bits, Constant, Device
from ..instructions.compare import COMPARISONS
from ..session import Session
from ..values import INT, signed16

PLAIN = ("running", "first scan")  # the special relays that a quiet scan does not change
TIMED = frozenset({"now", "scan", "machine", "claim"})  # what makes an instruction depend on more than devices
OWN = frozenset({"T", "DUE", "REST", "E"})
FOREVER = 1 << 40


class Gauge(NamedTuple):
    """A register that the machine writes and the program only compares, and with what."""

    name: str
    device: Device
    marks: tuple[Constant | Device, ...]


class Rest:
    """When the program of a session may be left out, with its machine put forward or going on alone, and for how many scans."""

    def __init__(self, session: Session):
        self.session, self.plc, self.plant = session, session.plc, session.plant
        self.gauges: list[Gauge] = []
        self._program: Any = None
        self._before: tuple | None = None  # scan, devices after it
        self._coils: list[tuple[int, Any]] = []  # timer, preset
        self._possible = False

    def scans(self, most: int) -> int:
        """For how many of the next `most` scans the program does what it did in the last one, as long as the machine lets it rest."""
        plc = self.plc
        if plc.program is not self._program:
            self._look()
        if not self._possible or plc._awake or plc.inputs.changed or plc.timers.watched or plc.interrupts.queue or not plc.running:
            return 0
        if self.session.sensors.faults:
            return 0
        devices = self._devices()
        if self._before != (plc.scans - 1, devices):
            self._before = plc.scans, devices
            return 0
        lists, now, until = plc.memory.lists, plc.clock[0], FOREVER
        for number, preset in self._coils:
            value = self._value(preset)
            if lists["DUE"][number] and lists["T"][number] < value:
                until = min(until, lists["DUE"][number] + (value - lists["T"][number] - 1) * plc.timers.bases[number] - now)
        return max(0, min(most, self._before_end(until)))

    @property
    def still(self) -> int:
        """For how many scans the machine stands still, where it can tell."""
        seconds = getattr(self.plant, "still", 0.0) if self.plant is not None else float("inf")
        return max(0, self._before_end(min(seconds * 1e6, FOREVER)))

    def _before_end(self, us: float) -> int:
        """How many scans end before so much time has gone by."""
        return int(-(-us // self.plc.period_us)) - 1

    def pass_over(self, count: int) -> None:
        """Put the PLC forward by so many scans, as if it had done them."""
        plc = self.plc
        plc.clock[0] += count * plc.period_us
        plc.scans += count
        plc._asked = plc.clock[0]
        toggle, relays = plc.clocks.toggle, plc.memory.lists[plc.model.special_bits]
        if toggle is not None and count % 2:
            relays[toggle] = not relays[toggle]
        self._before = None

    # -- a machine that goes on by itself -------------------------------------------------------------------------

    def listener(self) -> Callable[[Mapping[str, int]], bool]:
        """What takes up what the machine says now; false where the program would do something else then, and nothing is taken up."""
        lists, said = self.plc.memory.lists, self.session.sensors.says
        gauges = [
            (gauge.name, lists[gauge.device.area], gauge.device.number, *self._range(gauge)) for gauge in self.gauges if gauge.name in said
        ]
        others = [name for name in said if name not in [name for name, *_ in gauges]]
        look = itemgetter(*others, *others[:1]) if others else lambda sensors: ()
        expected, length = look(said), len(said)

        def goes_on(sensors: Mapping[str, int]) -> bool:
            try:
                if len(sensors) != length or look(sensors) != expected:
                    return False
                for name, _, _, low, high in gauges:
                    if type(sensors[name]) is not int or not low <= sensors[name] <= high:
                        return False
            except KeyError:  # it tells something else than before
                return False
            for name, values, number, _, _ in gauges:
                values[number] = sensors[name]
            return True

        return goes_on

    def _range(self, gauge: Gauge) -> tuple[int, int]:
        """From where to where the register may go with every comparison coming out as it does now."""
        value, marks = self._value(gauge.device), self._marks(gauge)
        if value in marks:
            return value, value
        place = bisect_left(marks, value)
        return (marks[place - 1] + 1 if place else -32768), (marks[place] - 1 if place < len(marks) else 32767)

    def _marks(self, gauge: Gauge) -> list[int]:
        return sorted(map(self._value, gauge.marks))

    def _value(self, operand: Constant | Device) -> int:
        return self.plc.memory.lists[operand.area][operand.number] if isinstance(operand, Device) else signed16(operand.value)

    # -- the program ----------------------------------------------------------------------------------------------

    def _devices(self) -> list:
        """All that a scan may change, but for the values of timers and for special devices, which the program does not look at.

        In the place of a gauge stands between which marks it is.
        """
        lists, first = self.plc.memory.lists, self.plc.model.first_special
        special = {self.plc.model.special_bits, self.plc.model.special_words}
        found = {name: values[:first] if name in special else values[:] for name, values in lists.items() if name not in OWN}
        for gauge in self.gauges:
            value, marks = self._value(gauge.device), self._marks(gauge)
            found[gauge.device.area][gauge.device.number] = bisect_left(marks, value) + bisect_right(marks, value)
        return [*found.values(), list(lists["E"])]

    def _look(self) -> None:
        """Whether the program is one that can be at rest, its coils of timers, and what it only compares."""
        plc, session = self.plc, self.session
        self._program, self._coils, self._before = plc.program, [], None
        model = plc.model
        plain = {model.relays[meaning] for meaning in PLAIN}
        self._possible = bool(plc._fixed_us) and not session._counted and not session._signals
        gauges = {name: (device, []) for name, (device, kind) in session._registers.items() if name in session.sensors.says and kind is INT}
        for instruction in plc.program.instructions:
            definition = instruction.definition
            if TIMED & set(definition.taken) or definition.form == "command":
                self._possible = False
            if definition.operands[:1] and definition.operands[0].kind == "TIMER":
                timer, preset = instruction.operands[:2]
                self._coils.append((timer.number, preset))
                self._possible = self._possible and _plain(preset)
            for spec, operand in zip(definition.operands, instruction.operands, strict=False):
                if not isinstance(operand, Device | Bits):
                    continue
                if operand.index is not None or (operand.area == "T" and spec.type.words and spec.kind != "TIMER"):
                    self._possible = False
                if operand.area in (model.special_bits, model.special_words) and operand.number in model.special(operand.area):
                    self._possible = self._possible and operand.area == model.special_bits and operand.number in plain and not spec.written
                if isinstance(operand, Bits) and operand.area == model.special_bits and model.special(operand.area):
                    self._possible = self._possible and operand.number + 4 * operand.digits <= model.first_special
            self._compared(instruction, gauges)
        self.gauges = [Gauge(name, device, tuple(marks)) for name, (device, marks) in gauges.items()]

    @staticmethod
    def _compared(instruction: Instruction, gauges: dict[str, tuple[Device, list]]) -> None:
        """Note what an instruction compares registers with; a register that it does anything else with is no gauge."""
        definition, operands = instruction.definition, instruction.operands
        comparison = definition.form == "contact" and definition.function in _COMPARING and definition.operands[0].type is INT
        numbers = {spec.name: operand.value for spec, operand in zip(definition.operands, operands, strict=False) if _constant(operand)}
        named = [device for device, _ in gauges.values()]
        for place, (spec, operand) in enumerate(zip(definition.operands, operands, strict=False)):
            if not isinstance(operand, Device):
                continue
            length = spec.length(numbers)
            end = float("inf") if length is None else operand.number + length * max(1, spec.type.words)
            for name, (device, marks) in list(gauges.items()):
                if operand.area == device.area and operand.number <= device.number < end:
                    other = operands[1 - place] if comparison else None
                    if other is not None and _plain(other) and other not in named:
                        marks.append(other)
                    else:
                        del gauges[name]


_COMPARING = frozenset(COMPARISONS.values())


def _constant(operand: Any) -> bool:
    return type(operand) is Constant


def _plain(operand: Any) -> bool:
    """Whether an operand is a constant or one register, always the same."""
    return _constant(operand) or (isinstance(operand, Device) and operand.index is None)
