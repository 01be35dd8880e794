"""Scans in which nothing happens, passed over: a machine that waits for a timer of minutes is graded in no time.

A program that reads neither clocks nor the values of timers does the same in each scan until an input changes or a timer
comes to its preset. Once a scan has left all devices as they were, the ones up to there need not be done: time, timers and the
machine are put forward to it. What is noted of a run is the same as without (tests/grading/test_rest.py).
"""

from typing import Any

from ..devices import Bits, Device
from ..plc import Plc

PLAIN = ("running", "first scan")  # the special relays that a quiet scan does not change
TIMED = frozenset({"now", "scan", "machine", "claim"})  # what makes an instruction depend on more than devices
OWN = frozenset({"T", "DUE", "REST", "E"})


class Rest:
    """When a Plc with its plant may be put forward, and by how many scans."""

    def __init__(self, plc: Plc, plant: Any):
        self.plc, self.plant = plc, plant
        self._program: Any = None
        self._before: tuple | None = None  # scan, devices after it
        self._coils: list[tuple[int, Any]] = []  # timer, preset
        self._possible = False

    def scans(self, most: int) -> int:
        """How many of the next `most` scans change nothing that is seen; an even number, so that what toggles with each scan stays in step."""
        plc = self.plc
        if plc.program is not self._program:
            self._look()
        if not self._possible or plc._awake or plc.inputs.changed or plc.timers.watched or plc.interrupts.queue or not plc.running:
            return 0
        devices = self._devices()
        if self._before != (plc.scans - 1, devices):
            self._before = plc.scans, devices
            return 0
        period = plc.period_us
        until = self.plant.still * 1e6 if self.plant is not None else float("inf")
        lists, now = plc.memory.lists, plc.clock[0]
        for number, preset in self._coils:
            value = lists[preset.area][preset.number] if isinstance(preset, Device) else preset.value
            if lists["DUE"][number] and lists["T"][number] < value:
                until = min(until, lists["DUE"][number] + (value - lists["T"][number] - 1) * plc.timers.bases[number] - now)
        count = min(most, 1 << 40 if until == float("inf") else int(-(-until // period)) - 1)
        return max(0, count - count % 2)

    def pass_over(self, count: int) -> None:
        """Put time and machine forward by so many scans."""
        plc = self.plc
        plc.clock[0] += count * plc.period_us
        plc.scans += count
        plc._asked = plc.clock[0]
        self._before = None

    def _devices(self) -> list:
        """All that a scan may change, but for the values of timers and for special devices, which the program does not look at."""
        lists, first = self.plc.memory.lists, self.plc.model.first_special
        special = {self.plc.model.special_bits, self.plc.model.special_words}
        found = [values[:first] if name in special else values[:] for name, values in lists.items() if name not in OWN]
        return [*found, list(lists["E"])]

    def _look(self) -> None:
        """Whether the program is one that can be at rest, and its coils of timers."""
        plc = self.plc
        self._program, self._coils, self._before = plc.program, [], None
        model = plc.model
        plain = {model.relays[meaning] for meaning in PLAIN}
        self._possible = bool(plc._fixed_us) and (self.plant is None or hasattr(self.plant, "still"))
        for instruction in plc.program.instructions:
            definition = instruction.definition
            if TIMED & set(definition.taken) or definition.form == "command":
                self._possible = False
            coil = definition.operands[:1] and definition.operands[0].kind == "TIMER"
            if coil:
                self._coils.append((instruction.operands[0].number, instruction.operands[1]))
            for spec, operand in zip(definition.operands, instruction.operands, strict=False):
                if not isinstance(operand, Device | Bits):
                    continue
                if operand.index is not None or (operand.area == "T" and spec.type.words and spec.kind != "TIMER"):
                    self._possible = False
                if operand.area in (model.special_bits, model.special_words) and operand.number in model.special(operand.area):
                    self._possible = self._possible and operand.area == model.special_bits and operand.number in plain and not spec.written
                if isinstance(operand, Bits) and operand.area == model.special_bits and model.special(operand.area):
                    self._possible = self._possible and operand.number + 4 * operand.digits <= model.first_special
