"""What stands beside a symbol: names above addresses, values in figures, and the words of a tip."""

from collections.abc import Callable
from dataclasses import dataclass

from ..assembler.program import Program, Unit
from ..devices import Bits, Constant, Device, Operand
from ..instructions import TABLE
from ..memory import Memory
from ..models import Model
from ..values import BOOL, DataType
from .rungs import Word

# The letter in a coil; every other output is a function box.
COILS = {"OUT": "", "SET": "S", "RST": "R"}
# What an element that changes the flow is called.
GATES = {"EU": "rising", "ED": "falling", "INV": "inverted"}
# Contacts that wait for an edge of their device, as a contact with that gate behind it.
EDGES = {"FX:LDP": "EU", "FX:LDF": "ED"}


@dataclass(frozen=True, slots=True)
class Label:
    """An operand for people: its name, empty when it has none, and its address."""

    name: str
    address: str

    def __str__(self) -> str:
        return f"{self.name} {self.address}" if self.name else self.address


class Labels:
    """The names of one unit's operands."""

    def __init__(self, unit: Unit, program: Program | None = None):
        self.unit, self.program = unit, program
        self.names: dict[str, str] = program.names() if program else {}
        self.comments = {
            str(v.device): v.comment for v in (*(program.variables if program else {}).values(), *unit.variables.values()) if v.comment
        }
        self.locals = {str(variable.device): f"#{variable.name}" for variable in unit.variables.values()}
        self._known: dict[str, Label] = {}  # by what was written

    def of(self, word: Word, place: int) -> Label:
        """The label of an operand: the name that was written, else one that the program declares for the device."""
        written = word.written[place]
        label = self._known.get(written)
        if label is None:
            label = self._known[written] = self._label(written, word.operands[place])
        return label

    def _label(self, written: str, operand: Operand) -> Label:
        address = str(operand)
        if isinstance(operand, Device | Bits):
            if written.upper() != address:
                return Label(written, address)
            return Label(self.locals.get(address) or self.names.get(address, ""), address)
        return Label("", address)

    def comment(self, word: Word) -> list[str]:
        """What the program says about an instruction: the comments of its variables, then its own."""
        about = [f"{self.of(word, n)}: {self.comments[str(o)]}" for n, o in enumerate(word.operands) if str(o) in self.comments]
        return [*about, word.comment] if word.comment else about

    def own(self, word: Word) -> bool:
        """Whether an instruction has to do with what its unit alone has (V, LM)."""
        areas = self.program.model.local_areas if self.program else ()
        return any(isinstance(operand, Device | Bits) and operand.area in areas for operand in word.operands)

    def contact(self, word: Word) -> Label:
        """The label of a contact of one bit; of a bit in a word "D0.5"."""
        label = self.of(word, 0)
        return Label(label.name, ".".join((label.address, *map(str, word.operands[1:]))))

    def named(self, device: Device) -> Label:
        """The label of a device that stands in no instruction."""
        return Label(self.names.get(str(device), ""), str(device))

    def roles(self, word: Word) -> list[str]:
        """What each operand is called in the manual, or in the subroutine that is called."""
        specs = TABLE[word.mnemonic].operands
        roles = [spec.name for spec in specs]
        callee = (
            next((u for u in self.program.units if u.name == str(word.operands[0])), None)
            if self.program and len(word.operands) > len(specs)
            else None
        )
        roles += [variable.name for variable in callee.parameters] if callee else []
        return roles + [""] * (len(word.operands) - len(roles))


# -- values -----------------------------------------------------------------------------------------------------

Reader = Callable[[Memory], int | float | None]


def operand_type(word: Word, place: int) -> DataType | None:
    """As what an operand is read; None where it has no value (the name of a subroutine)."""
    specs = TABLE[word.mnemonic].operands
    if place < len(specs):
        return specs[place].type
    operand = word.operands[place]
    return BOOL if isinstance(operand, Device) and operand.area in ("X", "Y", "M", "S", "LM", "SM") else TABLE["MOV"].operands[0].type


def reader(operand: Operand, kind: DataType | None, model: Model) -> Reader | None:
    """A function that reads an operand's present value from memory; None for what has no value that changes."""
    if not isinstance(operand, Device | Bits) or kind is None:
        return None
    if operand.index is None and operand.area in model.local_areas:
        return lambda memory: memory.get(operand, kind) if operand.area in memory.lists else None  # gone when its unit has ended
    if operand.index is None:
        return lambda memory: memory.get(operand, kind)
    area, count = operand.area, model.areas[operand.area].count
    length = 4 * operand.digits if isinstance(operand, Bits) else max(1, kind.words)

    def indexed(memory: Memory) -> int | float | None:
        if not {area, operand.index_area} <= memory.lists.keys():
            return None
        number = operand.number + memory.lists[operand.index_area][operand.index]
        if not 0 <= number <= count - length:
            return None
        device = Bits(operand.digits, area, number) if isinstance(operand, Bits) else Device(area, number)
        return memory.get(device, kind)

    return indexed


def figure(value: int | float | None) -> str:
    """A value as it is shown: thousands with a comma, a true minus, seven digits of a REAL; a dash where there is none."""
    if value is None:
        return "–"
    return f"{value:{',' if isinstance(value, int) else '.7g'}}".replace("-", "−")


def constant_value(operand: Operand) -> int | float | None:
    """The number of a constant operand."""
    return operand.value if isinstance(operand, Constant) else None


def sign(word: Word, pretty: bool = True) -> str:
    """The comparison of a compare contact as it stands between its operands: "<", "D≥" for 32 bits, "R≠" for REAL."""
    written = word.mnemonic.removeprefix("LD")
    return written.replace("<=", "≤").replace(">=", "≥").replace("<>", "≠") if pretty else written


def compares(word: Word) -> bool:
    """Whether a contact compares two values."""
    return word.mnemonic[-1] in "=<>"


def closing(word: Word) -> Callable[..., bool]:
    """What tells from the values of its operands whether a contact is closed; an edge is there for one scan only."""
    return (lambda *values: False) if word.mnemonic in EDGES else TABLE[word.mnemonic].function


def contact_words(word: Word, labels: Labels) -> str:
    """A contact in words: "X5 Start, normally closed", "D10 Count < 12"."""
    if compares(word):
        return f"{_spoken(labels.of(word, 0))} {sign(word)} {_spoken(labels.of(word, 1))}"
    edge = EDGES.get(word.mnemonic)
    what = f"{GATES[edge]} edge" if edge else "normally closed" if inverted(word) else "normally open"
    return f"{_spoken(labels.contact(word))}, {what}"


def inverted(word: Word) -> bool:
    """Whether a contact of one bit is closed while the bit is OFF."""
    return bool(closing(word)(*[False] * len(TABLE[word.mnemonic].operands)))


def output_words(word: Word, labels: Labels) -> str:
    """A coil or box in words: "Y0 Motor, coil", "TON T0 Settle 5"."""
    spoken = [_spoken(labels.of(word, place)) for place in range(len(word.operands))]
    if word.mnemonic in COILS:
        kind = {"": "coil", "S": "set coil", "R": "reset coil"}[COILS[word.mnemonic]]
        return f"{spoken[0]}, {kind}"
    return " ".join([word.name, *spoken])


def _spoken(label: Label) -> str:
    return f"{label.address} {label.name}".rstrip()
