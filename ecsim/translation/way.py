"""What both ways of a translation share: lines, operands, masks of interrupts, and whether something looks at a value."""

from typing import ClassVar

from ..assembler import Instruction, Program, Region, Unit
from ..devices import Constant, Device
from ..models import Model
from ..values import REAL
from .places import Places, numbers_in
from .text import Line, Refusal, Text

INPUTS = 6  # X0 to X5 ask for interrupts in both families
# EC's relay that lets an event ask while it is ON -> FX's that forbids it while it is ON.
MASKS = {40 + number: 8050 + number for number in range(INPUTS)} | {66 + place: 8056 + place for place in range(3)}
SWAPPED = {"SET": "RST", "RST": "SET", "LD": "LDI", "LDI": "LD", "AND": "ANI", "ANI": "AND", "OR": "ORI", "ORI": "OR"}


def _worth(operand):
    """What an operand is however it is written: 5, K5 and 16#5 are the same."""
    return operand.value if isinstance(operand, Constant) else operand


def _left(nodes: list, place: int) -> bool:
    """Whether the instruction at a place stands in an MC or a step."""
    return any(
        isinstance(node, Region) and node.opening < place < node.closing and (node.kind != "FOR" or _left(node.nodes, place))
        for node in nodes
    )


class Way:
    """A program of one family in the words of the other, instruction by instruction."""

    masks: ClassVar[dict[int, int]]  # number of a relay here -> there
    says: ClassVar[str]  # what such a relay does here while it is ON
    leaves: ClassVar[str]  # what becomes of what high-speed instructions have written where MC goes OFF or a step is left

    def __init__(self, program: Program, target: Model, places: Places, text: Text):
        self.program, self.source, self.target, self.places, self.text = program, program.model, target, places, text

    def _line(self, instruction: Instruction, name: str, written: tuple[str, ...]) -> Line:
        return Line(name, written, instruction.line, instruction.comment)

    def _operands(self, instruction: Instruction) -> tuple[str, ...]:
        specs = instruction.definition.operands
        return tuple(
            self.places.operand(operand, written, real=spec.type is REAL)
            for spec, operand, written in zip(specs, instruction.operands, instruction.written, strict=True)
        )

    def _tell_of_leaving(self, unit: Unit, place: int) -> None:
        """EC clears the destinations of high-speed instructions where MC goes OFF or a step is left, FX keeps them."""
        instruction = unit.instructions[place]
        row = instruction.definition
        keeps_or_clears = row.claims and (row.cleared or row.released) and any(s.written and s.kind != "PULSE" for s in row.operands)
        if keeps_or_clears and _left(unit.nodes, place):
            self.text.note(instruction.line, f"{instruction.name}: where MC goes OFF or a step is left, its result {self.leaves}")

    def _counter(self, coil: Instruction, words: str, hint: str = "") -> None:
        """EC's counter goes on beyond its preset and its contact is compared in each scan; FX's stops there and its contact stays.

        Refuse it where that can be seen: something looks at the value, two coils have other presets, or the preset is below 1.
        """
        device, preset = coil.operands
        if isinstance(preset, Constant) and preset.value < 1:
            raise Refusal(
                f"with a preset below 1 the contact of {device} comes at once in EC and with the first count in FX", "give 1 or more"
            )
        if not isinstance(preset, Constant):
            self.text.note(coil.line, "a preset that changes moves the contact in EC at once and in FX with the next count alone")
        for other in self.program.instructions:
            if other.mnemonic == coil.mnemonic and other.operands[0] == device and _worth(other.operands[1]) != _worth(preset):
                raise Refusal(f"{device} has another preset in line {other.line}", "count to one preset, and compare")
            for first, length, _ in numbers_in(other):
                if other.definition.form == "always" and first is other.operands[0]:
                    continue  # a coil
                behind = device.number - first.number if first.area == device.area else -1
                if behind == 0 or (behind > 0 and (length is None or behind < length)):
                    raise Refusal(f"{device} {words}, and line {other.line} looks at its value", hint)

    def _loop(self, instruction: Instruction, words: str) -> Line:
        """FOR: a count below 1 means once in one family and never in the other."""
        (count,) = instruction.operands
        if isinstance(count, Constant) and count.value < 1:
            raise Refusal(f"a loop with a count below 1 is executed {words}", "give a count from 1 on")
        if not isinstance(count, Constant):
            self.text.note(instruction.line, f"a loop with a count below 1 is executed {words}")
        return self._line(instruction, "FOR", self._operands(instruction))

    def _mask(self, instruction: Instruction) -> Line | None:
        """An instruction on a relay that lets an event ask, or forbids it, with the sense turned round; None for all others."""
        operand = instruction.operands[0] if instruction.operands else None
        if not isinstance(operand, Device) or operand.area != self.source.special_bits or operand.number not in self.masks:
            return None
        name = SWAPPED.get(instruction.mnemonic)
        if name is None:
            raise Refusal(f"{operand} has no counterpart that {instruction.mnemonic} can drive", "use SET and RST")
        place = f"{self.target.special_bits}{self.masks[operand.number]}"
        self.text.note(instruction.line, f"{operand} {self.says} while it is ON, {place} while it is OFF")
        return self._line(instruction, name, (place,))
