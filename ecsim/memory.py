"""The devices of one PLC: plain lists of bits and 16-bit numbers, and every rule about reaching them.

Layout: one list an area under the area's name (X, D ...), bits as True and False (CPython tests these two fastest),
registers as signed 16-bit numbers. T and C hold current values, TB and CB contacts. DUE and REST belong to the timers (us), E to instructions that remember a scan before.
The lists keep their identity for as long as nothing is forced, so that generated code may hold them.
"""

from collections.abc import Container, Sequence
from dataclasses import replace
from numbers import Number
from operator import index
from typing import Any

from .devices import Bits, Constant, Device, OperandError
from .errors import RANGE, EcsimError, Fault
from .models import Area, Model
from .values import BOOL, DINT, DWORD, INT, REAL, TYPES, WORD, DataType, join, real_from_words, signed16, split, words_from_real, wrap

_WORDS = Area("", 0, "word")
MAX_FORCED_BITS, MAX_FORCED_WORDS = 128, 16


class Forced(list):
    """An area with forced devices: a write to one of them changes nothing but what `beneath` remembers of it."""

    def __init__(self, values):
        super().__init__(values)
        self.forced: dict[int, int] = {}
        self.beneath: dict[int, int] = {}  # what forced devices would hold otherwise

    def __setitem__(self, key, value):
        if isinstance(key, slice):
            value = list(value)
            for offset, number in enumerate(range(*key.indices(len(self)))):
                if number in self.forced:
                    self.beneath[number] = value[offset]
                    value[offset] = self.forced[number]
        elif key in self.forced:
            self.beneath[key] = value
            return
        super().__setitem__(key, value)

    @property
    def own(self) -> list:
        """The values without what is forced."""
        values = list(self)
        for number, value in self.beneath.items():
            values[number] = value
        return values


class Memory:
    """All devices of one PLC."""

    def __init__(self, model: Model):
        self.model = model
        self.lists: dict[str, list] = {}
        for area in model.areas.values():
            self.lists[area.name] = [False if area.kind == "bit" else 0] * area.count
            if area.kind in ("timer", "counter"):
                self.lists[f"{area.name}B"] = [False] * area.count
        timers = model.areas["T"].count
        self.lists["DUE"] = [0] * timers
        self.lists["REST"] = [0] * timers
        self.lists["E"] = []
        self.generation = 0  # counts the replacements of lists, for those who hold them

    def __repr__(self) -> str:
        return f"<Memory of an {self.model.name}>"

    def slots(self, count: int) -> None:
        """Make room for what `count` instructions remember, and forget what there was."""
        self.lists["E"][:] = [False] * count

    # -- reading and writing by name ------------------------------------------------------------------------------

    def parse(self, name: str, names: dict[str, Device] | None = None) -> tuple[Device | Bits, DataType]:
        """The device and type that a name like "D0", "D0:REAL", "T0:BOOL", "K4M0" or a symbol stands for; raises EcsimError."""
        text, _, suffix = str(name).partition(":")
        text = text.strip()
        device = (names or {}).get(text.casefold())
        if device is None:
            try:
                device = self.model.syntax.parse(text)
            except OperandError as error:
                raise EcsimError(f"{error}; {error.hint}" if error.hint else str(error)) from None
        if device is None or isinstance(device, Constant):
            raise EcsimError(f"{text!r} is no device of {self.model.name}; write X0, D100, T5 or a name that the program declares")
        if getattr(device, "index", None) is not None:
            raise EcsimError(f"{text!r} is indexed; name the device itself")
        area = self.model.areas[device.area]
        kind = TYPES.get(suffix.strip().upper()) if suffix else self._usual_type(device)
        if kind is None:
            raise EcsimError(f"{suffix!r} is no type; use {', '.join(TYPES)}")
        if kind not in self.types(device):
            raise EcsimError(f"{text} cannot be had as {kind.name}; it is {', '.join(each.name for each in self.types(device))}")
        if not area.has(device.number):
            raise EcsimError(f"{self.model.name} has no {text} ({area.span})")
        length = 4 * device.digits if isinstance(device, Bits) else kind.words if area.kind == "word" else 1
        if device.number + length > area.end(device.number):
            raise EcsimError(f"{name} reaches beyond the last {device.area} of {self.model.name} ({area.span})")
        return device, kind

    def types(self, device: Device | Bits) -> tuple[DataType, ...]:
        """As what a device can be read and written, the usual type first."""
        if isinstance(device, Bits):
            return (INT, WORD, DINT, DWORD) if device.digits <= 4 else (DINT, DWORD)
        kind = self.model.areas[device.area].kind
        if kind == "bit":
            return (BOOL,)
        if kind == "word":
            return (INT, WORD, DINT, DWORD, REAL)
        return (DINT, DWORD, BOOL) if self._usual_type(device) is DINT else (INT, WORD, BOOL)

    def span(self, device: Device | Bits, kind: DataType) -> tuple[str, range]:
        """Where a device read as `kind` lies: the name of the list, and the numbers in it."""
        if isinstance(device, Bits):
            return device.area, range(device.number, device.number + 4 * device.digits)
        length = kind.words if self.model.areas[device.area].kind == "word" else 1
        return self._list(device, kind), range(device.number, device.number + length)

    def _usual_type(self, device: Device | Bits) -> DataType:
        if isinstance(device, Bits):
            return INT if device.digits <= 4 else DINT
        kind = self.model.areas[device.area].kind
        return BOOL if kind == "bit" else DINT if kind == "counter" and device.number >= self.model.wide_counters else INT

    def get(self, device: Device | Bits, kind: DataType) -> int | float:
        """The value of a device read as `kind`; bits as 0 or 1."""
        if isinstance(device, Bits):
            bits = self.lists[device.area][device.number : device.number + 4 * device.digits]
            value = sum(1 << place for place, bit in enumerate(bits) if bit)
            return wrap(value, kind) if kind.bits == len(bits) else value
        area = self.model.areas[device.area]
        if kind is BOOL:
            return int(self.bits(device.area)[device.number])
        values = self.lists[device.area]
        if area.kind in ("timer", "counter"):
            return values[device.number] if kind.signed else values[device.number] & kind.high
        if kind.words == 1:
            return values[device.number] if kind.signed else values[device.number] & 0xFFFF
        high, low = self._pair(values[device.number], values[device.number + 1])
        if kind is REAL:
            return real_from_words(high, low)
        return join(high, low) if kind.signed else join(high, low) & 0xFFFF_FFFF

    def set(self, device: Device | Bits, kind: DataType, value: int | float | bool) -> None:
        """Write a device as `kind`; raises EcsimError for a value that does not fit."""
        value = self.fitting(device, kind, value)
        if isinstance(device, Bits):
            width = 4 * device.digits
            self.lists[device.area][device.number : device.number + width] = [bool(value >> place & 1) for place in range(width)]
        elif kind is BOOL:
            self.bits(device.area)[device.number] = bool(value)
        elif self.model.areas[device.area].kind == "word" and kind.words == 2:
            words = words_from_real(value) if kind is REAL else split(value)
            self.lists[device.area][device.number : device.number + 2] = self._pair(*words)
        else:
            wide = device.area == "C" and device.number >= self.model.wide_counters
            self.lists[device.area][device.number] = wrap(value, DINT) if wide else signed16(value)

    def fitting(self, device: Device | Bits, kind: DataType, value: Any) -> int | float:
        """`value` as a device of that type can hold it; raises EcsimError when it cannot. Signed and unsigned numbers of its width both fit."""
        if kind is REAL:
            try:
                return float(value if isinstance(value, Number) else None)
            except (TypeError, OverflowError):
                raise EcsimError(f"{device} takes a number, not {value!r:.40}") from None
        if kind is BOOL:
            if value in (0, 1):
                return int(value)
            raise EcsimError(f"{device} is one bit: 0 or 1, not {value!r:.40}")
        try:
            value = index(value)
        except TypeError:
            hint = f"; for REAL write {device}:REAL" if REAL in self.types(device) else ""
            raise EcsimError(f"{device} takes a whole number, not {value!r:.40}{hint}") from None
        width = min(kind.bits, 4 * device.digits) if isinstance(device, Bits) else kind.bits
        low, high = -(1 << kind.bits - 1) if width == kind.bits else 0, (1 << width) - 1
        if not low <= value <= high:
            raise EcsimError(f"{value} does not fit into {device} ({low} to {high})")
        return value

    def _pair(self, first: int, second: int) -> tuple[int, int]:
        """(high, low) from two registers in order of their numbers, and back."""
        return (first, second) if self.model.high_word_first else (second, first)

    def bits(self, area: str) -> list:
        """The list of an area's bits; of T and C the contacts."""
        return self.lists[f"{area}B"] if area in ("T", "C") else self.lists[area]

    def placed(self, operand: Device | Bits, index: int, length: int) -> Device | Bits:
        """An indexed operand as the device that it stands for now, of `length` elements; beyond its area it is Fault(65)."""
        moved = replace(operand, number=operand.number + index, index=None)
        span = 4 * operand.digits if isinstance(operand, Bits) else length
        if not 0 <= moved.number <= self.model.areas[operand.area].end(operand.number) - span:
            raise Fault(RANGE)
        return moved

    # -- reading and writing from outside -------------------------------------------------------------------------

    def send(self, name: str, first: int, count: int) -> list:
        """Read a run of a list as a communication partner sees it: forced devices as the program left them (10.4.12).

        Beyond the last device there are zeros.
        """
        values = self.lists[name]
        run = (values.own if isinstance(values, Forced) else values)[first : first + count]
        return run + [0] * (count - len(run))

    def receive(self, name: str, first: int, values: Sequence) -> None:
        """Write a run of an area's list as a communication partner does: inputs, and what only the system writes, keep their values.

        No error tells of them (10.4: such a write is answered and does nothing). `name` is a list's name: D, SD, TB ...;
        bits come as True and False, registers as signed numbers.
        """
        if name == "X":
            return
        kept = self.model.read_only(name)
        target = self.lists[name]
        for number, value in enumerate(values[: max(0, len(target) - first)], first):
            if number not in kept:
                target[number] = value

    # -- forcing ------------------------------------------------------------------------------------------------

    def force(self, device: Device, kind: DataType, value: int) -> None:
        """Hold a bit or register at a value until it is released; at most 128 bits and 16 words (2.2)."""
        name = self._list(device, kind)
        values = self.lists[name]
        same = [part.forced for part in self.lists.values() if isinstance(part, Forced) and isinstance(part[0], bool) is (kind is BOOL)]
        limit = MAX_FORCED_BITS if kind is BOOL else MAX_FORCED_WORDS
        already = isinstance(values, Forced) and device.number in values.forced
        if sum(map(len, same)) >= limit and not already:
            raise EcsimError(f"{limit} {'bits' if kind is BOOL else 'words'} are forced already; release one first")
        if not isinstance(values, Forced):
            values = self.lists[name] = Forced(values)
            self.generation += 1
        values.beneath.setdefault(device.number, values[device.number])
        values.forced.pop(device.number, None)
        values[device.number] = value = bool(value) if kind is BOOL else signed16(value)
        values.forced[device.number] = value

    @property
    def forces_words(self) -> bool:
        """Whether a register is forced."""
        return any(isinstance(part, Forced) and not isinstance(part[0], bool) for part in self.lists.values())

    def unforce(self, device: Device, kind: DataType) -> None:
        """Release a forced device; it keeps the value until the program or the input writes it."""
        name = self._list(device, kind)
        values = self.lists[name]
        if not isinstance(values, Forced) or device.number not in values.forced:
            raise EcsimError(f"{device} is not forced")
        del values.forced[device.number], values.beneath[device.number]
        if not values.forced:
            self.lists[name] = list(values)
            self.generation += 1

    def forced(self) -> dict[str, int]:
        """Every forced device by name, with its value; the contacts of timers and counters as T0:BOOL."""
        found = {}
        for name, values in self.lists.items():
            if isinstance(values, Forced):
                area, suffix = (name[0], ":BOOL") if name in ("TB", "CB") else (name, "")
                found |= {f"{Device(area, number)}{suffix}": int(value) for number, value in sorted(values.forced.items())}
        return found

    def forces(self) -> dict[str, dict[int, int]]:
        """What is forced, by list: number -> value; `hold` takes it back."""
        return {name: dict(values.forced) for name, values in self.lists.items() if isinstance(values, Forced)}

    def hold(self, forces: dict[str, dict[int, int]]) -> None:
        """Force just this, and nothing else."""
        if forces == self.forces():
            return
        for name, values in self.lists.items():
            if name in forces:
                self.lists[name] = Forced(values)
                self.lists[name].beneath.update({number: values[number] for number in forces[name]})
                self.lists[name].forced.update(forces[name])
            elif isinstance(values, Forced):
                self.lists[name] = list(values)
        self.generation += 1

    @staticmethod
    def _list(device: Device, kind: DataType) -> str:
        """The name of the list that a device of that type lies in."""
        return f"{device.area}B" if kind is BOOL and device.area in ("T", "C") else device.area

    # -- whole areas --------------------------------------------------------------------------------------------

    def clear(self, area: str, keep: Container[int] = ()) -> None:
        """Set an area to 0 but for the numbers to keep; timers and counters with contacts and all."""
        parts = [area]
        if area in ("T", "C"):
            parts.append(f"{area}B")
        if area == "T":
            parts += ["DUE", "REST"]
        for part in parts:
            values = self.lists[part]
            off = False if part in ("TB", "CB") or self.model.areas.get(part, _WORDS).kind == "bit" else 0
            values[:] = [value if number in keep else off for number, value in enumerate(values)] if keep else [off] * len(values)

    def snapshot(self) -> dict[str, tuple]:
        """What every list holds, by name; of forced devices what they would hold otherwise."""
        return {name: tuple(values.own if isinstance(values, Forced) else values) for name, values in self.lists.items()}

    def restore(self, snapshot: dict[str, tuple]) -> None:
        """Put a snapshot back; what is forced stays."""
        for name, values in snapshot.items():
            self.lists[name][:] = values
