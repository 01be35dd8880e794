"""Operands: each word of a statement resolved and held against its row of the instruction's operand table (3.3.2)."""

from difflib import get_close_matches

from ..devices import Bits, Constant, Device, IndexedConstant, Name, Operand, OperandError, Pointer, Text, number_text
from ..instructions.signature import OperandSpec
from ..models import Model
from ..values import REAL, REAL_MAX, wrap
from .hints import special_device
from .program import Variable
from .reader import shown

CLOCK_PARTS = 7  # registers of date, time and weekday


class Refused(Exception):
    """An operand does not fit; the message says why, `hint` what would, `section` where the manual says so."""

    def __init__(self, message: str, hint: str = "", section: str = "3.3.2"):
        super().__init__(message)
        self.message, self.hint, self.section = message, hint, section


class Misplaced(Refused):
    """An operand of a kind that does not belong there; `hint` says which do."""


class Resolver:
    """Resolves the words of one program for its model, with its global variables."""

    def __init__(self, model: Model, variables: dict[str, Variable]):
        self.model = model
        self.variables = variables
        self._by_fold = {name.casefold(): variable for name, variable in variables.items()}
        self._checked: dict[tuple[int, str], Operand] = {}

    def resolve(self, text: str, local: dict[str, Variable]) -> Operand:
        """The operand that a word stands for: a constant, a device, a global name, or `#NAME` of the unit's own variables."""
        if text.startswith("#"):
            variable = local.get(text[1:].casefold())
            if variable is None:
                known = ", ".join(f"#{v.name}" for v in local.values())
                raise Refused(
                    f"{shown(text)} is not declared here",
                    f"this unit has {known}" if known else "only subroutines have variables of their own",
                    "4.4.3",
                )
            return variable.device
        try:
            operand = self.model.syntax.parse(text)
        except OperandError as error:
            raise Refused(str(error), error.hint, "3.2") from None
        if operand is None:
            variable = self._by_fold.get(text.casefold())
            if variable is None:
                raise Refused(f"{shown(text)} is neither a device of {self.model.name} nor a declared name", self._instead(text), "")
            return variable.device
        return operand

    def _instead(self, text: str) -> str:
        """What to write for a word that is declared nowhere: perhaps it is spelled as elsewhere, or mistyped."""
        prefix, digits = text[:1].upper(), text[1:]
        special = special_device(text, self.model)
        if special:
            return special
        if self._means(written := f"K{text}"):
            return f"constants are written {written} here"
        if prefix in ("K", "H") and self._means(written := digits if prefix == "K" else f"16#{digits}"):
            return f"constants are written {written} here"
        if self._means(written := text.strip(";()")):
            return f"write {written}"
        close = get_close_matches(text.casefold()[:40], self._by_fold, 1, 0.75)
        return f"did you mean {self._by_fold[close[0]].name}?" if close else "declare it between VAR_GLOBAL and END_VAR: NAME AT DEVICE"

    def _means(self, text: str) -> bool:
        """Whether a word is an operand or a declared name."""
        try:
            return text.casefold() in self._by_fold or self.model.syntax.parse(text) is not None
        except OperandError:
            return False

    def operand(self, spec: OperandSpec, text: str, local: dict[str, Variable]) -> Operand:
        """The operand for one place of an instruction; raises Refused when it does not fit there."""
        key = (id(spec), text)
        operand = self._checked.get(key)
        if operand is not None:
            return operand
        if spec.kind == "ROUTINE":
            return Name(text)
        if spec.kind == "TEXT":
            return self._text(spec, text)
        operand = self.resolve(text, local)
        if text.startswith("#"):
            self._local_type(spec, text, local)
        self.check(spec, operand, text)
        if not text.startswith("#"):
            self._checked[key] = operand
        return operand

    @staticmethod
    def _text(spec: OperandSpec, text: str) -> Text:
        """Characters as they are typed; they need no quotes."""
        if len(text) > spec.span:
            raise Refused(f"{shown(text)} has {len(text)} characters", f"{spec.name} takes {spec.span} at most", "")
        strange = next((character for character in text if not "!" <= character <= "~"), None)
        if strange is not None:
            raise Refused(f"{spec.name}: {shown(strange)} is no character of ASCII", "from ! (16#21) to ~ (16#7E)", "")
        return Text(text)

    def _local_type(self, spec: OperandSpec, text: str, local: dict[str, Variable]) -> None:
        kind = local[text[1:].casefold()].type
        if kind.bits != spec.type.bits or (kind is REAL) != (spec.type is REAL):
            raise Refused(f"{spec.name} = {text} is {kind.name}", f"{spec.name} needs {spec.type.name}", "4.4.3")

    def check(self, spec: OperandSpec, operand: Operand, text: str) -> None:
        """Hold an operand against its row: kind of device, type, range, index, whether it may be written."""
        if isinstance(operand, Constant):
            self._constant(spec, operand, text)
        elif isinstance(operand, IndexedConstant):
            self._constant(spec, Constant(operand.value, operand.text), text)
            if not spec.indexed or not spec.plain:
                raise Refused(f"{shown(text)}: {spec.name} cannot be indexed", "write the number itself", "3.2.2")
            self._index_register(operand)
        elif isinstance(operand, Bits):
            self._area(spec, f"Kn{operand.area}", text)
            self._digits(spec, operand, text)
            self._number(operand.area, operand.number, 4 * operand.digits, text)
            self._index(spec, operand, text)
            if spec.written and not spec.maybe:
                self._writable(operand, 4 * operand.digits, text)
        else:
            self._area(spec, operand.area, text)
            self._number(
                operand.area,
                operand.number,
                self._length(spec, operand.area),
                text,
            )
            if operand.area == "C" and spec.type.words:
                self._counter_width(spec, operand, text)
            if spec.range and not spec.plain:
                self._device_range(spec, operand, text)
            self._index(spec, operand, text)
            if spec.written and not spec.maybe:
                self._writable(operand, max(1, spec.type.words), text)

    def _length(self, spec: OperandSpec, area: str) -> int:
        """How many elements of an area an operand's value takes."""
        one = area in self.model.index_pairs or self.model.areas[area].kind in ("bit", "timer", "counter")
        return 1 if one else max(1, spec.type.words)

    def areas(self, spec: OperandSpec) -> tuple[str, ...]:
        """Where an operand may lie on the model; a 32-bit number in index registers is named by the register of its low word."""
        low = {high: low for low, high in self.model.index_pairs.items()}
        if spec.type.words >= 2 and low:
            areas = [low.get(area, area) for area in spec.order if area not in low or not (spec.type is REAL or spec.span)]
        else:
            areas = list(spec.order)
        return tuple(area for area in areas if not area.removeprefix("Kn").isupper() or area.removeprefix("Kn") in self.model.areas)

    def span(self, spec: OperandSpec, operand: Device | Bits, length: int | None, text: str) -> None:
        """Hold the elements from an operand on, if their number is known, against the last device."""
        if length is None or length < 1 or operand.index is not None:
            return
        room = self.model.areas[operand.area]
        if isinstance(operand, Bits):
            length = 4 * operand.digits * (1 if spec.first else length)
        elif room.kind == "word":
            length *= spec.type.words
        narrow = operand.area == "C" and spec.type.words == 1  # the counters behind the last one have 32 bits
        last = (self.model.wide_counters if narrow else room.end(operand.number)) - 1
        if operand.number + length - 1 > last:
            name = f"{operand.area}{number_text(operand.area, last)}"
            raise Refused(f"{shown(text)} reaches beyond {name}", f"it is the first of {length} {operand.area} devices", "3.2")

    def _area(self, spec: OperandSpec, area: str, text: str) -> None:
        if area not in self.areas(spec):
            what = "is read only" if spec.written and area in ("KnX", "X") else f"cannot be {spec.name}"
            raise Misplaced(f"{shown(text)} {what}", self.may_be(spec))

    def may_be(self, *specs: OperandSpec) -> str:
        """What may stand for an operand, in any of the forms that are open."""
        return f"{specs[0].name} ({specs[0].type.name}) may be {self._allowed(*specs)}"

    def _allowed(self, *specs: OperandSpec) -> str:
        """The areas of an operand that the model has, in words."""
        words = list(dict.fromkeys(word for spec in specs for word in self._kinds(spec)))
        return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"

    def _kinds(self, spec: OperandSpec) -> list[str]:
        pointer = self.model.syntax.pointers.get(spec.kind)
        if pointer:
            return [f"a pointer, {pointer}{spec.range[0] if spec.range else 1}"]
        return ["a constant" if area == "const" else area for area in self.areas(spec)]

    def _constant(self, spec: OperandSpec, constant: Constant, text: str) -> None:
        if "const" not in spec.areas:
            what = "pointer" if isinstance(constant, Pointer) else "constant"
            raise Misplaced(f"the {what} {shown(text)} cannot be {spec.name}", self.may_be(spec))
        value = constant.value
        pointer = constant.letter if isinstance(constant, Pointer) else ""
        if pointer != self.model.syntax.pointers.get(spec.kind, ""):
            raise Refused(f"{shown(text)} cannot be {spec.name}", f"{spec.name} is {self._allowed(spec)}", "")
        if spec.type is REAL:
            if abs(value) > REAL_MAX:
                raise Refused(f"{spec.name} = {shown(text)} is out of range", "REAL goes to 3.402823E+38", "3.3.3")
            return
        if not isinstance(value, int):
            raise Refused(f"{spec.name} = {shown(text)} is no whole number", f"{spec.name} is {spec.type.name}", "3.3.3")
        signed = self.model.syntax.signed_decimals and not constant.unsigned
        least, most = -(1 << spec.type.bits - 1), (1 << spec.type.bits - signed) - 1
        fits = least <= value <= most
        if spec.range:
            low, high = spec.range
            if not (fits and low <= wrap(value, spec.type) <= high):
                raise Refused(
                    f"{spec.name} = {shown(text)} is out of range", f"{spec.name} goes from {pointer}{low} to {pointer}{high}", ""
                )
        elif not fits:
            more = f", or to H{(1 << spec.type.bits) - 1:X} in hexadecimal" if signed else ""
            raise Refused(
                f"{spec.name} = {shown(text)} does not fit into {spec.type.bits} bits",
                f"constants go from {least} to {most} here{more}",
                "3.3.3",
            )

    def _digits(self, spec: OperandSpec, bits: Bits, text: str) -> None:
        if spec.type.words == 1 and bits.digits > 4:
            raise Refused(f"{shown(text)} is too wide for {spec.name} ({spec.type.name})", "K1 to K4 for 16 bits")
        if spec.type.words == 2 and bits.digits < self.model.least_wide_digits:
            raise Refused(f"{shown(text)} is too narrow for {spec.name} ({spec.type.name})", "K5 to K8 for 32 bits")
        if spec.whole and 4 * bits.digits != spec.type.bits:
            raise Refused(
                f"{shown(text)} is too narrow for {spec.name}", f"a Kn string has the full width here, K{spec.type.bits // 4}", ""
            )

    def _number(self, area: str, number: int, length: int, text: str) -> None:
        room = self.model.areas[area]
        if not room.has(number):
            name = f"{area}{number_text(area, number)}"
            raise Refused(f"{self.model.name} has no {name} ({room.span})", special_device(name, self.model), "3.1")
        if number + length > room.end(number):
            last = f"{area}{number_text(area, room.end(number) - 1)}"
            raise Refused(
                f"{shown(text)} reaches beyond {last}, the last {area} of {self.model.name}", f"it takes {length} {area} devices", "3.2"
            )

    def _counter_width(self, spec: OperandSpec, device: Device, text: str) -> None:
        wide = device.number >= self.model.wide_counters
        if wide and spec.type.words == 1:
            raise Refused(f"{text} holds 32 bits, {spec.name} ({spec.type.name}) takes 16", f"use C0 to C{self.model.wide_counters - 1}")
        if not wide and spec.type.words == 2:
            raise Refused(
                f"{text} holds 16 bits, {spec.name} ({spec.type.name}) takes 32",
                f"use C{self.model.wide_counters} to C{self.model.areas['C'].count - 1}",
            )

    def _device_range(self, spec: OperandSpec, device: Device, text: str) -> None:
        low, high = self.model.operand_ranges.get(spec.kind, spec.range)
        if not low <= device.number <= high:
            raise Refused(f"{text} cannot be {spec.name}", f"{spec.name} goes from {device.area}{low} to {device.area}{high}", "")

    def _index(self, spec: OperandSpec, operand: Device | Bits, text: str) -> None:
        if operand.index is None:
            return
        if operand.area in self.model.index_pairs or operand.area in self.model.index_pairs.values():
            raise Refused(f"{shown(text)}: an index register cannot be indexed itself", "name the register", "3.2.2")
        if not spec.indexed:
            raise Refused(f"{shown(text)}: {spec.name} cannot be indexed", "name the device itself", "3.2.2")
        if operand.number in self.model.special(operand.area):
            raise Refused(f"{shown(text)}: special relays and registers cannot be indexed", "name the device itself", "3.2.2")
        self._index_register(operand)

    def _index_register(self, operand: Device | Bits | IndexedConstant) -> None:
        if operand.index >= self.model.areas[operand.index_area].count:
            raise Refused(
                f"{self.model.name} has no {operand.index_area}{operand.index} ({self.model.areas[operand.index_area].span})", "", "3.2.2"
            )

    def _writable(self, device: Device | Bits, length: int, text: str) -> None:
        model = self.model
        fixed, first = model.read_only(device.area), model.registers.get("clock", model.areas[model.special_words].count)
        if any(number in fixed for number in range(device.number, device.number + length)):
            clock = device.area == model.special_words and 0 <= device.number - first < CLOCK_PARTS
            raise Refused(
                f"{text} is read only",
                "the system writes it, programs only read it" + ("; TWR sets the clock" if clock else ""),
                "3.1.9" if device.area == model.special_bits else "3.1.10",
            )
