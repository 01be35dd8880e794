"""Where the devices of a program lie in the other family: timers by class, steps, special devices by meaning, the rest by number."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

from ..assembler import Instruction, Program, Variable
from ..devices import Bits, Constant, Device, IndexedConstant, Name, Operand, Pointer, number_text
from ..devices import Text as Characters
from ..instructions import Definition
from ..models import Model
from ..models.model import By
from .text import Refusal, Text

# Special devices that mean the same in both families.
RELAYS = (
    "running", "first scan", "clock 10 ms", "clock 100 ms", "clock 1 s", "clock 1 min", "zero", "carry", "borrow", "bytewise", "clear signal",
)  # fmt: skip
REGISTERS = ("base frequency", "ramp time")
DOUBLES = ("top frequency",)  # their first number is that of the pair
RUNS = {"capture": 6}
RETENTIVE = frozenset({"FX:OUT T246", "FX:OUT T246 D"})


class Places:
    """The devices of one program, each at its place in the other family. A device that has none is refused where it stands."""

    def __init__(self, program: Program, target: Model, text: Text):
        self.program, self.source, self.target, self.text = program, program.model, target, text
        self.moved: dict[tuple[str, int], Device] = {}
        self.taken: dict[str, set[int]] = {}
        self.used = self._used()
        for (area, number), line in self.used.items():
            if number in self.source.special(area):
                continue  # looked for where it stands: an instruction may have a rule for it
            try:
                self._settle(area, number)
            except Refusal as refusal:
                text.refuse(line, refusal)
        self._whole_pairs()

    def _used(self) -> dict[tuple[str, int], int]:
        """Every device that the program names, with the first line that does."""
        used: dict[tuple[str, int], int] = {}
        for instruction in self.program.instructions:
            for operand in instruction.operands:
                if isinstance(operand, Device):
                    used.setdefault((operand.area, operand.number), instruction.line)
        for variable in self.program.variables.values():
            used.setdefault((variable.device.area, variable.device.number), variable.line)
        return used

    # -- single devices -----------------------------------------------------------------------------------------

    def _settle(self, area: str, number: int) -> None:
        device = Device(area, number)
        if number in self.source.special(area):
            self.moved[area, number] = self._special(area, number)
        elif area in self.source.local_areas and area not in self.target.local_areas:
            raise Refusal(f"{device} belongs to a subroutine alone", f"use another device; {self.target.name} has no such ones")
        elif area == "T":
            self._timer(device)
        elif area == "S":
            self._step(device)
        elif area == "C" and number >= min(self.source.fast_counters):
            self._fast_counter(device)
        elif area == "V":  # an index register of the family that has eight of them
            self._keep(device, Device("Z", number + 8))
        elif area == "Z" and area in self.target.areas and number >= self.target.areas["Z"].count:
            self._keep(device, Device("V", number - self.target.areas["Z"].count))
        else:
            self._same(device)

    def _same(self, device: Device) -> None:
        area = self.target.areas.get(device.area)
        room = area.count if area else 0
        if area and device.area in (self.target.special_bits, self.target.special_words) and self.target.first_special:
            room = area.hole.start if area.hole else self.target.first_special
        if area is None or device.number >= room or (device.area == "C" and device.number >= min(self.target.fast_counters)):
            raise Refusal(
                f"{self.target.name} has no {device}",
                f"it has {area.name}0 to {area.name}{number_text(area.name, room - 1)}" if area else "",
            )
        self._keep(device, device)

    def _keep(self, device: Device, place: Device) -> None:
        self.moved[device.area, device.number] = place
        self.taken.setdefault(place.area, set()).add(place.number)
        if place != device:
            self.text.note(self.used[device.area, device.number], f"{device} becomes {place}")

    def _special(self, area: str, number: int) -> Device:
        source, target = self.source, self.target
        bits = area == source.special_bits
        mine, theirs = (source.relays, target.relays) if bits else (source.registers, target.registers)
        where = target.special_bits if bits else target.special_words
        for meaning in RELAYS if bits else (*REGISTERS, *DOUBLES):
            if meaning in mine and meaning in theirs and number - mine[meaning] in range(2 if meaning in DOUBLES else 1):
                return Device(where, theirs[meaning] + number - mine[meaning])
        if bits:
            for meaning, count in RUNS.items():
                if number - mine.get(meaning, number + 1) in range(count):
                    return Device(where, theirs[meaning] + number - mine[meaning])
            counter = number - mine["counter direction"]
            if counter in range(source.wide_counters, 256):
                self._settle("C", counter)
                return Device(where, theirs["counter direction"] + self.moved["C", counter].number)
        for mine_too, theirs_too in zip(source.pulse_outputs, target.pulse_outputs, strict=False):
            for part in ("stop", "busy") if bits else ("pulses", "position"):
                first = getattr(mine_too, part)
                if number - first in range(1 if bits else 2):
                    return Device(where, getattr(theirs_too, part) + number - first)
        raise Refusal(f"{Device(area, number)} has no counterpart in {target.name}", "do without it, or write that part by hand")

    def _timer(self, device: Device) -> None:
        """A free number of the class that its coil needs: the time unit, and whether it keeps its value."""
        keeps = self._retentive(device)
        base = self.source.timer_base_us(device.number)
        fitting = [range(first, last + 1) for first, last, unit in self.target.timer_bases if unit == base]
        coil = self.target.spelling.get("OUT")
        if isinstance(coil, By):  # the number tells whether a timer keeps its value
            fitting = [numbers for numbers in fitting if (coil.of("T", numbers.start).usual in RETENTIVE) is keeps]
        wanted = [device.number] if any(device.number in numbers for numbers in fitting) else []
        wanted += [number for numbers in fitting for number in numbers]
        others = {number for area, number in self.used if area == "T"}
        free = next((n for n in wanted if n not in self.taken.get("T", ()) and (n == device.number or n not in others)), None)
        if free is None:
            kind = f"{'retentive ' if keeps else ''}timer of {base // 1000} ms"
            raise Refusal(f"{self.target.name} has no free {kind} for {device}", "use another time unit")
        self._keep(device, Device("T", free))

    def _retentive(self, device: Device) -> bool:
        coils = [i.mnemonic for i in self.program.instructions if i.definition.form == "always" and device in i.operands[:1]]
        return any(mnemonic in {"TONR", *RETENTIVE} for mnemonic in coils)

    def _step(self, device: Device) -> None:
        """Its own number where that means the same, else a free one: of an initial step one of those, of others none that tells of faults."""
        initial = device.number < self.source.initial_steps
        room = range(self.target.initial_steps) if initial else range(20, self.target.annunciators.start or self.target.areas["S"].count)
        others = {number for area, number in self.used if area == "S"}
        wanted = [device.number, *(number for number in room if number not in others)]
        free = next((number for number in wanted if number in room and number not in self.taken.get("S", ())), None)
        if free is None:
            raise Refusal(f"{self.target.name} has no place for the step {device}", f"it has S0 to S{room.stop - 1} for such steps")
        self._keep(device, Device("S", free))

    def _fast_counter(self, device: Device) -> None:
        counter = self.source.fast_counters.get(device.number)
        for number, other in self.target.fast_counters.items():
            if counter and (counter.mode, counter.needs) == (other.mode, other.needs):
                self._keep(device, Device("C", number))
                return
        raise Refusal(f"{self.target.name} has no high-speed counter with the inputs of {device}", "choose another one")

    def free(self, area: str, numbers: Iterable[int]) -> Device:
        """A device that the program does not use, for the translation's own needs."""
        taken = self.taken.setdefault(area, set())
        for number in numbers:
            if number not in taken:
                taken.add(number)
                return Device(area, number)
        raise Refusal(f"no {area} is free for what the translation needs")

    # -- operands -------------------------------------------------------------------------------------------------

    def device(self, device: Device | Bits) -> Device | Bits:
        """An operand's device at its place; raises Refusal for one that has none."""
        if isinstance(device, Bits):
            first = self._group(device)
        else:
            if (device.area, device.number) not in self.moved:
                self._settle(device.area, device.number)
            first = self.moved[device.area, device.number]
        if device.index is None:
            return replace(device, number=first.number, **({} if isinstance(device, Bits) else {"area": first.area}))
        index = self._index(device.index_area, device.index)
        if device.area not in ("D", "M", "X", "Y") or first.number != device.number:
            raise Refusal(f"{device} reaches devices that may lie elsewhere", "name each device itself")
        return replace(device, index=index.number, index_area=index.area)

    def _index(self, area: str, number: int) -> Device:
        self.used.setdefault((area, number), 0)
        if (area, number) not in self.moved:
            self._settle(area, number)
        return self.moved[area, number]

    def _group(self, bits: Bits) -> Device:
        """The first device of a group; all of them must lie side by side as before."""
        for number in range(bits.number, bits.number + 4 * bits.digits):
            if (bits.area, number) not in self.moved:
                self.used.setdefault((bits.area, number), 0)
                self._settle(bits.area, number)
        first = self.moved[bits.area, bits.number]
        if any(self.moved[bits.area, bits.number + n] != Device(first.area, first.number + n) for n in range(4 * bits.digits)):
            raise Refusal(f"{bits} is no group of neighbours in {self.target.name}", "take other numbers")
        return first

    def variable(self, variable: Variable) -> Variable:
        """A name with its device at its new place."""
        device = variable.device
        return replace(variable, device=self.moved.get((device.area, device.number), device))

    def operand(self, operand: Operand, written: str, real: bool = False) -> str:
        """An operand as the other family writes it; a name stays a name."""
        if isinstance(operand, Device | Bits):
            place = self.device(operand)
            return written if written in self.program.variables else str(place)
        if isinstance(operand, Constant) and not isinstance(operand, Pointer):
            return constant(operand, self.target, real)
        if isinstance(operand, IndexedConstant):
            raise Refusal(f"{operand} adds a register to a constant", "add it to a register before")
        if isinstance(operand, Name | Characters):
            return operand.text
        raise Refusal(f"{operand} has no counterpart")

    @staticmethod
    def same_widths(instruction: Instruction, row: Definition) -> None:
        """Refuse an instruction whose counterpart reads or writes another number of registers."""
        for spec, other, operand in zip(instruction.definition.operands, row.operands, instruction.operands, strict=False):
            if isinstance(operand, Device) and operand.area in ("D", "SD", "V", "Z") and spec.type.words != other.type.words:
                raise Refusal(
                    f"{operand} is a number of {16 * spec.type.words} bits here and of {16 * other.type.words} bits there",
                    "give a constant",
                )

    # -- 32-bit numbers -------------------------------------------------------------------------------------------

    def _whole_pairs(self) -> None:
        """The families hold the two words of a 32-bit number in different order: none may be used alone."""
        pairs: dict[tuple[str, int], Instruction] = {}
        singles: dict[tuple[str, int], Instruction] = {}
        for instruction in self.program.instructions:
            for first, length, words in numbers_in(instruction):
                if first.area in ("D", "SD"):
                    for number in range(first.number, first.number + (length or 1) * words):
                        (pairs if words == 2 else singles).setdefault((first.area, number), instruction)
        for (area, number), instruction in sorted(singles.items()):
            if (area, number) in pairs:
                other = pairs[area, number]
                self.text.refuse(
                    max(instruction.line, other.line),
                    Refusal(
                        f"{area}{number} is a 16-bit number in line {instruction.line} and part of a 32-bit one in line {other.line}",
                        "the families hold the two words of a 32-bit number in different order; use separate registers",
                    ),
                )
        if pairs:
            first = min(pairs.values(), key=lambda instruction: instruction.line)
            order = "low word" if self.source.high_word_first else "high word"
            self.text.note(first.line, f"32-bit numbers lie in two registers with the {order} first")


def numbers_in(instruction: Instruction) -> Iterator[tuple[Device, int | None, int]]:
    """The numbers that an instruction reads or writes: their first device, how many they are (None: it is told in RUN), words of each."""
    pairs = list(zip(instruction.definition.operands, instruction.operands, strict=False))
    values = {spec.name: operand.value for spec, operand in pairs if isinstance(operand, Constant)}
    for spec, operand in pairs:
        if isinstance(operand, Device) and spec.type.words:
            yield operand, spec.length(values), spec.type.words


def constant(constant: Constant, target: Model, real: bool) -> str:
    """A constant as a family writes it."""
    value = constant.value
    if target.family == "FX":
        if real or isinstance(value, float):
            return f"E{value!r}".replace("e", "") if "e" not in repr(value) else f"E{value:.9f}".rstrip("0")
        above = 0x7FFF < value <= 0xFFFF or value > 0x7FFF_FFFF  # what decimal constants do not reach
        return f"H{value:X}" if constant.unsigned or above else f"K{value}"
    if real or isinstance(value, float):
        return repr(float(value))
    return f"16#{value:X}" if constant.unsigned else str(value)
