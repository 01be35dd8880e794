"""A program as the engines and views read it: units, instructions with resolved operands, networks and regions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import ClassVar

from ..devices import Device, Operand
from ..errors import EcsimError
from ..instructions import Definition
from ..models import Model
from ..values import DataType


def wording(name: str, written: tuple[str, ...]) -> str:
    """An instruction as a line of text; a label, whose name is the letter of its pointer, is its pointer alone."""
    return " ".join(written if is_label(name, written) else (name, *written))


def is_label(name: str, written: tuple[str, ...]) -> bool:
    """Whether an instruction is a pointer on a line of its own: P1, I101."""
    return len(name) == 1 and len(written) == 1 and written[0][:1] == name


@dataclass(slots=True)
class Instruction:
    """One line of the instruction list, resolved. `position` counts through the whole program and indexes every trace."""

    mnemonic: str
    definition: Definition
    operands: tuple[Operand, ...]
    written: tuple[str, ...]
    line: int
    comment: str = ""
    position: int = 0
    step: int = 0
    steps: int = 0
    slot: int = -1  # where its state of the last scan is kept, -1 when it has none
    spelled: str = ""  # the mnemonic as its family writes it, where that differs
    pulse: int = -1  # where the flow of the last scan is kept if it is executed at a rise only, -1 when in every scan

    @property
    def name(self) -> str:
        """The mnemonic as its family writes it."""
        return self.spelled or self.mnemonic

    def __str__(self) -> str:
        return wording(self.name, self.written)

    def __repr__(self) -> str:
        return f"<Instruction {self.position}: {self}>"


@dataclass(slots=True)
class Variable:
    """A named device: a global variable of the program or a local one of a subroutine."""

    name: str
    device: Device
    comment: str = ""
    type: DataType | None = None
    role: str = ""  # locals: INPUT, OUTPUT, IN_OUT, TEMP
    line: int = 0


@dataclass(slots=True)
class Network:
    """One rung: the instructions `start` to `end` (not included) of its unit. `region` names what encloses it, outermost first."""

    number: int
    start: int
    end: int
    title: str = ""
    region: tuple[tuple[str, int], ...] = ()


@dataclass(slots=True)
class Region:
    """A structure: MC, FOR or a step (STL). `opening` is the index of the instruction that opens it, `closing` of the one that ends it."""

    kind: str
    number: int
    opening: int
    closing: int = -1
    nodes: list[Network | Region] = field(default_factory=list)
    steps: tuple[Device, ...] = ()  # STL: the step, or all steps of a join
    slot: int = -1


def _loops(nodes: list[Network | Region]) -> Iterator[Region]:
    """The FOR loops among some nodes and inside them."""
    for node in nodes:
        if isinstance(node, Region):
            if node.kind == "FOR":
                yield node
            yield from _loops(node.nodes)


@dataclass(slots=True)
class Unit:
    """The main program, a subroutine or an interrupt program (4.2.1)."""

    kind: str
    name: str
    event: int | None = None
    variables: dict[str, Variable] = field(default_factory=dict)
    instructions: list[Instruction] = field(default_factory=list)
    networks: list[Network] = field(default_factory=list)
    nodes: list[Network | Region] = field(default_factory=list)
    line: int = 0
    titles: dict[int, str] = field(default_factory=dict)  # index of an instruction -> the whole-line comments before it
    password: str = ""  # what opens its text (2.1.11), "" for a unit that anyone may read
    opened: bool = False

    @property
    def closed(self) -> bool:
        """Whether its text is to be shown to nobody."""
        return bool(self.password) and not self.opened

    @property
    def parameters(self) -> list[Variable]:
        """The variables that a CALL gives, in order."""
        return [variable for variable in self.variables.values() if variable.role != "TEMP"]

    def length(self, begin: int = 0, end: int | None = None) -> int:
        """The steps from one instruction (by index) up to another, gone through once: the bodies of loops that begin there do not count."""
        end = len(self.instructions) if end is None else end
        bodies = {
            place for loop in _loops(self.nodes) if begin <= loop.opening < end for place in range(loop.opening + 1, loop.closing + 1)
        }
        return sum(self.instructions[place].steps for place in range(begin, end) if place not in bodies)

    def __repr__(self) -> str:
        count, networks = len(self.instructions), len(self.networks)
        return f"<Unit {self.name}, {count} instruction{'s' * (count != 1)} in {networks} network{'s' * (networks != 1)}>"


@dataclass
class Program:
    """A compiled program of one model; MAIN is the first unit."""

    model: Model
    source: str
    units: list[Unit]
    variables: dict[str, Variable]
    steps: int = 0
    slots: int = 0
    face: ClassVar[Callable[[Program], str] | None] = None  # its HTML for a notebook; the views stand above and are named here

    def _repr_html_(self) -> str | None:
        return self.face() if self.face else None

    @property
    def main(self) -> Unit:
        return self.units[0]

    @property
    def instructions(self) -> list[Instruction]:
        """All instructions by position."""
        return [instruction for unit in self.units for instruction in unit.instructions]

    def names(self) -> dict[str, str]:
        """Canonical device text -> the variable's name."""
        return {str(variable.device): variable.name for variable in self.variables.values()}

    def unit(self, name: str) -> Unit:
        """The unit of that name, in any case; raises EcsimError when there is none."""
        for unit in self.units:
            if unit.name.upper() == name.upper():
                return unit
        raise EcsimError(f"the program has no unit {name!r}; it has {', '.join(unit.name for unit in self.units)}")

    def __repr__(self) -> str:
        return f"<Program {self.model.name}, {len(self.units)} unit{'s' if len(self.units) > 1 else ''}, {self.steps} steps>"
