"""Operands as Python source: how a device is read and written in generated code, and the functions that code calls."""

import sys
from array import array
from struct import Struct, pack, unpack

from ..devices import Bits, Constant, Device, IndexedConstant, Operand, Text
from ..errors import OPERAND, RANGE, Fault
from ..memory import Memory
from ..models import Model
from ..values import BOOL, REAL, WORD, DataType, join, real_from_words, signed16, single, split, words_from_real

# REAL[0] and HALF[0], HALF[1] are one piece of scratch memory, seen as a single and as two registers: the fastest way between the two.
ROUNDED = "REAL[0]"
FEW = ("2", "3", "4")  # spans of so many pairs are written one by one
BEYOND = 0x7F80  # high words of singles from here on are an infinity or no number
_HIGH, _LOW = ("HALF[1]", "HALF[0]") if sys.byteorder == "little" else ("HALF[0]", "HALF[1]")


class Access:
    """Writes the source that reads and writes the operands of one model."""

    def __init__(self, model: Model):
        self.model = model

    def bits(self, area: str) -> str:
        """The list that holds an area's bits."""
        return f"{area}B" if area in ("T", "C") else area

    def limits(self, kind: DataType, area: str, number: int = 0) -> tuple[int, int]:
        """First and last+1 number that an indexed operand, or a span, from a number on may reach."""
        count = self.model.areas[area].end(number)
        if area == "C" and kind.words:
            return (0, self.model.wide_counters) if kind.words == 1 else (self.model.wide_counters, count)
        return 0, count

    @staticmethod
    def index(operand: Device | Bits) -> str:
        """The source of an indexed operand's number."""
        return f"{operand.number} + {operand.index_area}[{operand.index}]"

    def place(self, operand: Device | Bits) -> str:
        """The source of an operand's number, indexed or not."""
        return str(operand.number) if operand.index is None else self.index(operand)

    def can_fault(self, operand: Operand) -> bool:
        """Whether reaching the operand can end as error 65."""
        return getattr(operand, "index", None) is not None and not isinstance(operand, IndexedConstant)

    # -- reading ------------------------------------------------------------------------------------------------

    def load(self, kind: DataType, operand: Operand) -> str:
        """An expression, safe to stand anywhere, for the value of an operand read as `kind`."""
        if isinstance(operand, Constant):
            return self.constant(kind, operand)
        if isinstance(operand, IndexedConstant):
            return self._indexed_constant(kind, operand)
        if isinstance(operand, Bits):
            return self._load_bits(kind, operand)
        if operand.index is not None:
            return self._load_indexed(kind, operand)
        area, number = operand.area, operand.number
        if kind is BOOL:
            return f"{self.bits(area)}[{number}]"
        if kind.words == 1 or area in ("T", "C"):
            text = f"{area}[{number}]"
            return text if kind.signed else f"({text} & {kind.high})"
        return self._wide(kind, *self.words(area, number))

    @staticmethod
    def constant(kind: DataType, constant: Constant) -> str:
        """A constant as the type reads it: 16#FFFF is -1 as INT and 65535 as WORD."""
        value = constant.value
        if kind is REAL:
            return f"({single(float(value))!r})"
        value &= (1 << kind.bits) - 1 if kind.bits > 1 else 1
        if value > kind.high:
            value -= 1 << kind.bits
        return f"({value})" if value < 0 else str(value)

    @staticmethod
    def _indexed_constant(kind: DataType, constant: IndexedConstant) -> str:
        """The sum, as a register of the type holds it."""
        half, full = 1 << kind.bits - 1, (1 << kind.bits) - 1
        total = f"{constant.value} + {constant.index_area}[{constant.index}]"
        return f"(({total} + {half} & {full}) - {half})" if kind.signed else f"({total} & {full})"

    def _pair(self, first: str, second: str) -> tuple[str, str]:
        return (first, second) if self.model.high_word_first else (second, first)

    def words(self, area: str, number: int) -> tuple[str, str]:
        """The source of the high and the low word of a 32-bit number."""
        above = self.model.index_pairs.get(area)
        if above is not None:
            return f"{above}[{number}]", f"{area}[{number}]"
        return self._pair(f"{area}[{number}]", f"{area}[{number + 1}]")

    def fetch(self, kind: DataType, operand: Operand, name: str) -> list[str]:
        """Statements that give `name` the value of an operand; for a REAL faster than `load`."""
        if kind is not REAL or not isinstance(operand, Device) or operand.index is not None:
            return [f"{name} = {self.load(kind, operand)}"]
        first, second = self._pair(_HIGH, _LOW)
        area, number = operand.area, operand.number
        return [f"{first} = {area}[{number}]", f"{second} = {area}[{number + 1}]", f"{name} = {ROUNDED}"]

    @staticmethod
    def _wide(kind: DataType, high: str, low: str) -> str:
        if kind is REAL:
            return f"real_of(halves({high}, {low}))[0]"
        if kind.signed:
            return f"({high} << 16 | {low} & 65535)"
        return f"(({high} & 65535) << 16 | {low} & 65535)"

    def compare(self, kind: DataType, first: Operand, relation: str, second: Operand) -> str | None:
        """An expression that compares two 32-bit operands register by register, None for operands that are no pairs."""
        pairs = self._halves(kind, first), self._halves(kind, second)
        if None in pairs or all(isinstance(operand, Constant) for operand in (first, second)):
            return None
        (high, low), (other_high, other_low) = pairs
        if relation == "==":
            text = f"({high} == {other_high} and {low} == {other_low})"
        elif relation == "!=":
            text = f"({high} != {other_high} or {low} != {other_low})"
        else:  # the high words decide if they differ
            text = f"({high} - {other_high} or ({low} & 65535) - ({other_low} & 65535)) {relation} 0"
        if kind is not REAL:
            return text
        # Positive singles have the order of their registers; all others are compared as the numbers that they are.
        numbers = f"{self.load(kind, first)} {relation} {self.load(kind, second)}"
        return f"({text} if 0 <= {high} < {BEYOND} > {other_high} >= 0 else {numbers})"

    def _halves(self, kind: DataType, operand: Operand) -> tuple[str, str] | None:
        """The source of a 32-bit operand's high and low word, if it has them as registers hold them."""
        if isinstance(operand, Constant):
            high, low = words_from_real(float(operand.value)) if kind is REAL else split(operand.value)
            return str(high), str(low)
        if not isinstance(operand, Device) or operand.index is not None or operand.area in ("T", "C"):
            return None
        return self.words(operand.area, operand.number)

    def _load_bits(self, kind: DataType, bits: Bits) -> str:
        width = 4 * bits.digits
        if bits.index is not None:
            high = self.limits(kind, bits.area, bits.number)[1]
            return f"at_bits({bits.area}, {self.index(bits)}, {width}, {high}, {kind.signed and width == kind.bits})"
        parts = [f"{bits.area}[{bits.number + place}]" + (f" << {place}" if place else "") for place in range(width)]
        text = " | ".join(parts)
        if kind.signed and width == kind.bits:
            return f"(({text}) - ({bits.area}[{bits.number + width - 1}] << {width}))"
        return f"({text})"

    def _load_indexed(self, kind: DataType, device: Device) -> str:
        low, high = self.limits(kind, device.area, device.number)
        values = self.bits(device.area) if kind is BOOL else device.area
        if kind.words == 2 and device.area not in ("T", "C"):
            return f"at_{kind.name.lower()}({values}, {self.index(device)}, {high})"
        text = f"at({values}, {self.index(device)}, {low}, {high})"
        return text if kind is BOOL or kind.signed else f"({text} & {kind.high})"

    # -- writing ------------------------------------------------------------------------------------------------

    def store(self, kind: DataType, operand: Device | Bits, text: str) -> list[str]:
        """Statements that write `text`, a name or an expression that stands once, of the signed range of `kind`'s width."""
        if isinstance(operand, Bits):
            width = 4 * operand.digits
            if operand.index is not None:
                return [
                    f"put_bits({operand.area}, {self.index(operand)}, {width}, {self.limits(kind, operand.area, operand.number)[1]}, {text})"
                ]
            return [f"{operand.area}[{operand.number}:{operand.number + width}] = bits_of({text}, {width})"]
        if operand.index is not None:
            return self._store_indexed(kind, operand, text)
        area, number = operand.area, operand.number
        if kind is BOOL:
            return [f"{self.bits(area)}[{number}] = {text}"]
        if kind.words == 1 or area in ("T", "C"):
            return [f"{area}[{number}] = {text}"]
        high, low = self.words(area, number)
        if kind is REAL:
            return [*([] if text == ROUNDED else [f"{ROUNDED} = {text}"]), f"{high} = {_HIGH}", f"{low} = {_LOW}"]
        name = text if text.isidentifier() else "wide"
        return [*([] if text == name else [f"{name} = {text}"]), f"{high} = {name} >> 16", f"{low} = ({name} & 65535 ^ 32768) - 32768"]

    @staticmethod
    def round(name: str) -> list[str]:
        """Statements that round a float to a single, beyond the largest one an infinity; afterwards ROUNDED is the result too."""
        return [f"{ROUNDED} = {name}", f"{name} = {ROUNDED}"]

    def _store_indexed(self, kind: DataType, device: Device, text: str) -> list[str]:
        low, high = self.limits(kind, device.area, device.number)
        values = self.bits(device.area) if kind is BOOL else device.area
        guard = {self.model.special_bits: "READ_ONLY_BITS", self.model.special_words: "READ_ONLY_WORDS"}.get(device.area, "()")
        if kind.words == 2 and device.area not in ("T", "C"):
            return [f"put_{'real' if kind is REAL else 'dint'}({values}, {self.index(device)}, {high}, {text}, {guard})"]
        return [f"put({values}, {self.index(device)}, {low}, {high}, {text}, {guard})"]

    def reset(self, operand: Device) -> list[str]:
        """Statements that turn a bit OFF; of a timer or counter they clear the value too (5.1.17)."""
        number = operand.number
        lines = [f"{self.bits(operand.area)}[{number}] = False"]
        if operand.area == "T":
            lines.append(f"T[{number}] = DUE[{number}] = REST[{number}] = 0")
        elif operand.area == "C":
            lines.append(f"C[{number}] = 0")
        return lines

    def whole(self, operand: Device, name: str, text: str) -> list[str]:
        """The statement that gives a pair of registers, and `name`, the 16-bit integer `text` as a REAL."""
        high, low = self.words(operand.area, operand.number)
        return [f"{high}, {low}, {name} = SINGLES[{text}]"]

    @staticmethod
    def copy(source: Device, target: Device) -> list[str]:
        """The statement that moves a pair of registers as it stands."""
        to, of = f"{target.area}[{{}}]".format, f"{source.area}[{{}}]".format
        return [f"{to(target.number)}, {to(target.number + 1)} = {of(source.number)}, {of(source.number + 1)}"]

    # -- spans --------------------------------------------------------------------------------------------------

    def load_span(self, kind: DataType, operand: Operand, count: str) -> str:
        """An expression for a list of `count` values from an operand on."""
        if isinstance(operand, Text):
            return f"{list(operand.text.encode('ascii').ljust(int(count), bytes(1)))}"
        if isinstance(operand, Constant | IndexedConstant):  # it holds one element, whatever the count
            return f"[{self.load(kind, operand)}][:counted({count})]"
        _, high = self.limits(kind, operand.area, operand.number)
        number = self.place(operand)
        if isinstance(operand, Bits):
            return f"span_bits({operand.area}, {number}, {4 * operand.digits}, {count}, {high}, {kind.signed and 4 * operand.digits == kind.bits})"
        values = self.bits(operand.area) if kind is BOOL else operand.area
        if self._plain_block(kind, operand, count) and (kind is BOOL or kind.signed):
            return f"{values}[{number}:{operand.number + int(count)}]"
        if kind.words == 2 and operand.area not in ("T", "C"):
            return f"span_{kind.name.lower()}({values}, {number}, {count}, {high})"
        text = f"span({values}, {number}, {count}, {high})"
        return text if kind is BOOL or kind.signed else f"[word & {kind.high} for word in {text}]"

    def _plain_block(self, kind: DataType, device: Device, count: str) -> bool:
        """Whether a span is a slice of one list, known while compiling, that needs no check."""
        if device.index is not None or not count.isdigit() or device.area in (self.model.special_bits, self.model.special_words):
            return False
        return (kind.words < 2 or device.area in ("T", "C")) and device.number + int(count) <= self.limits(
            kind, device.area, device.number
        )[1]

    def store_span(self, kind: DataType, operand: Device | Bits, text: str, resets: bool, count: str = "") -> list[str]:
        """Statements that write a list of values, `count` if that is known, each in the signed range of `kind`'s width, from an operand on."""
        _, high = self.limits(kind, operand.area, operand.number)
        number = self.place(operand)
        if isinstance(operand, Bits):
            return [f"put_span_bits({operand.area}, {number}, {4 * operand.digits}, {text}, {high})"]
        if resets and operand.area in ("T", "C"):
            return [f"reset_span({operand.area!r}, {number}, {text}, {high})"]
        values = self.bits(operand.area) if kind is BOOL else operand.area
        if self._plain_block(kind, operand, count):
            return [f"{values}[{number}:{operand.number + int(count)}] = {text}"]
        if kind.words == 2 and self._plain_block(WORD, operand, f"{2 * int(count)}" if count in FEW else ""):
            pairs = [(f"pair_{place}", Device(operand.area, operand.number + 2 * place)) for place in range(int(count))]
            names = ", ".join(name for name, _ in pairs)
            return [f"{names} = {text}", *(line for name, device in pairs for line in self.store(kind, device, name))]
        guard = {self.model.special_bits: "READ_ONLY_BITS", self.model.special_words: "READ_ONLY_WORDS"}.get(operand.area, "()")
        if kind.words == 2 and operand.area not in ("T", "C"):
            return [f"put_span_{'real' if kind is REAL else 'dint'}({values}, {number}, {text}, {high}, {guard})"]
        return [f"put_span({values}, {number}, {text}, {high}, {guard})"]


def functions(memory: Memory) -> dict[str, object]:
    """What generated code calls to reach memory where a plain list access is not enough; a bad number raises Fault(65)."""
    model, lists = memory.model, memory.lists
    first = 0 if model.high_word_first else 1
    order = ">" if model.high_word_first else "<"  # of words, and so of bytes: each register is packed and unpacked the same way
    half = memoryview(array("h", (0, 0)))

    def at(values, number, low, high):
        if low <= number < high:
            return values[number]
        raise Fault(RANGE)

    def pair(values, number, high):
        if 0 <= number < high - 1:
            return values[number + first], values[number + 1 - first]
        raise Fault(RANGE)

    def at_dint(values, number, high):
        return join(*pair(values, number, high))

    def at_dword(values, number, high):
        return join(*pair(values, number, high)) & 0xFFFF_FFFF

    def at_real(values, number, high):
        return real_from_words(*pair(values, number, high))

    def at_bits(values, number, width, high, signed):
        if not 0 <= number <= high - width:
            raise Fault(RANGE)
        value = 0
        for bit in reversed(values[number : number + width]):
            value = value << 1 | bit
        return value - (1 << width) if signed and values[number + width - 1] else value

    def bits_of(value, width):
        return [value >> place & 1 == 1 for place in range(width)]

    def put(values, number, low, high, value, guard):
        if not low <= number < high or number in guard:
            raise Fault(RANGE)
        values[number] = value

    def put_pair(values, number, high, words, guard):
        if not 0 <= number < high - 1 or number in guard or number + 1 in guard:
            raise Fault(RANGE)
        values[number + first], values[number + 1 - first] = words

    def put_dint(values, number, high, value, guard):
        put_pair(values, number, high, split(value), guard)

    def put_real(values, number, high, value, guard):
        put_pair(values, number, high, words_from_real(value), guard)

    def put_bits(values, number, width, high, value):
        if not 0 <= number <= high - width:
            raise Fault(RANGE)
        values[number : number + width] = bits_of(value, width)

    def counted(count):
        if count < 0:
            raise Fault(OPERAND)
        return count

    def span(values, number, count, high):
        if not 0 <= number <= high - counted(count):
            raise Fault(RANGE)
        return values[number : number + count]

    def span_pairs(values, number, count, high, letter):
        words = span(values, number, 2 * count, high)
        return list(unpack(f"{order}{count}{letter}", pack(f"{order}{2 * count}h", *words)))

    def span_dint(values, number, count, high):
        return span_pairs(values, number, count, high, "i")

    def span_dword(values, number, count, high):
        return span_pairs(values, number, count, high, "I")

    def span_real(values, number, count, high):
        return span_pairs(values, number, count, high, "f")

    def span_bits(values, number, width, count, high, signed):
        if not 0 <= number <= high - width * counted(count):
            raise Fault(RANGE)
        return [at_bits(values, number + width * i, width, high, signed) for i in range(count)]

    def put_span(values, number, new, high, guard):
        if not 0 <= number <= high - len(new) or (guard and any(n in guard for n in range(number, number + len(new)))):
            raise Fault(RANGE)
        values[number : number + len(new)] = new

    def put_span_pairs(values, number, new, high, guard, letter):
        put_span(values, number, unpack(f"{order}{2 * len(new)}h", pack(f"{order}{len(new)}{letter}", *new)), high, guard)

    def put_span_dint(values, number, new, high, guard):
        put_span_pairs(values, number, new, high, guard, "i")

    def put_span_real(values, number, new, high, guard):
        put_span_pairs(values, number, [single(value) for value in new], high, guard, "f")

    def put_span_bits(values, number, width, new, high):
        if not 0 <= number <= high - width * len(new):
            raise Fault(RANGE)
        for i, value in enumerate(new):
            values[number + width * i : number + width * (i + 1)] = bits_of(value, width)

    def reset_span(area, number, new, high):
        put_span(lists[f"{area}B"], number, new, high, ())
        for part in (area, "DUE", "REST") if area == "T" else (area,):
            lists[part][number : number + len(new)] = [0] * len(new)

    def wrapped16(values):
        return [signed16(value) for value in values]

    def wrapped32(values):
        return [((value + 0x8000_0000) & 0xFFFF_FFFF) - 0x8000_0000 for value in values]

    local = dict(locals())
    for name in ("memory", "model", "lists", "first", "order", "half"):
        del local[name]
    return local | {
        "Fault": Fault,
        "HALF": half,
        "REAL": half.cast("B").cast("f"),
        "halves": Struct(">hh").pack,
        "real_of": Struct(">f").unpack,
        "split": split,
        "READ_ONLY_BITS": model.read_only_relays,
        "READ_ONLY_WORDS": model.read_only_registers,
        "counted": counted,
    }
