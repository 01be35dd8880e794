"""H1U and H2U -> EC10 and EC20."""

from collections.abc import Callable
from typing import ClassVar

from ..assembler import Instruction, Program, Unit
from ..devices import Device
from ..instructions import TABLE
from ..models import Model
from .places import Places
from .text import Line, Refusal, Text
from .to_fx import IN_PLACE, NAMES
from .way import INPUTS, MASKS, Way

_BACK = {f"FX:{name}": key for key, name in NAMES.items() if name != "OUT"}
KEYS = {
    **{key: name for key, name in _BACK.items() if key != "FX:DPLSY"},
    "FX:OUT T": "TON", "FX:OUT T D": "TON", "FX:OUT T246": "TONR", "FX:OUT T246 D": "TONR",
    "FX:OUT C": "CTU", "FX:OUT C200": "DCNT", "FX:OUT C235": "HCNT", "FX:SET": "SET",
    "FX:PLSY": "PLSY", "FX:DPLSY": "PLSY",
}  # fmt: skip
NOTES = {
    **dict.fromkeys(
        ("FX:ADD", "FX:SUB", "FX:DADD", "FX:DSUB"),
        "{name}: a result beyond the range goes on from the other end of the range there, from 0 here",
    ),
    **dict.fromkeys(("FX:OUT T", "FX:OUT T D", "FX:OUT T246", "FX:OUT T246 D"), "timers go on beyond their preset there"),
    "FX:OUT C200": "counting down, the contact goes OFF on reaching the preset there and one count later here; "
    "a count upward from the preset or above puts it ON there and leaves it here",
    "STL": "in the scan of a transition the step that is left is OFF there when the one that begins is ON",
    "FX:SEGD": "SEG clears the upper eight bits of its result",
}
CONTACTS = {f"FX:{join}{edge}": (join, "EU" if edge == "P" else "ED") for join in ("LD", "AND", "OR") for edge in "PF"}
ENDS = frozenset({"FX:SRET", "FX:IRET", "FX:FEND", "FX:END", "FX:I"})


class ToEC(Way):
    """A program of FX in the words of EC."""

    masks: ClassVar[dict[int, int]] = {there: here for here, there in MASKS.items()}
    says = "forbids an event"
    leaves = "is cleared there and stays here"

    def __init__(self, program: Program, target: Model, places: Places, text: Text):
        super().__init__(program, target, places, text)
        self.rules: dict[str, Callable[[Instruction], list[Line]]] = {
            **dict.fromkeys(CONTACTS, self._contact), "FX:PLS": self._pulse, "FX:PLF": self._pulse, "FX:MC": self._mc, "FX:MCR": self._mcr,
            "FX:RST D": self._clear, "FX:ZRST": self._zrst, "FX:ZRST D": self._zrst_words, "FX:CJ END": self._end, "FX:FOR": self._for,
            "LBL": self._label, "CJ": self._label, "CALL": self._call, **dict.fromkeys((f"FX:{name}" for name in IN_PLACE), self._in_place),
        }  # fmt: skip

    def units(self) -> list[tuple[str, list[Line], str]]:
        """Head, lines and end of each unit."""
        done = []
        for unit in self.program.units:
            self.levels: list[int] = []
            lines = self._unit(unit)
            if unit.kind == "MAIN":
                done.append(("PROGRAM MAIN", self._enables() + lines, "END_PROGRAM"))
            elif unit.kind == "SUBROUTINE":
                done.append((f"SUBROUTINE {self._routine(unit.name)}", lines, "END_SUBROUTINE"))
            else:
                done.append((f"INTERRUPT INT_{unit.name} EVENT {self._event(unit)}", lines, "END_INTERRUPT"))
        return done

    @staticmethod
    def _routine(name: str) -> str:
        return f"SBR_{name}"

    def _unit(self, unit: Unit) -> list[Line]:
        lines: list[Line] = []
        instructions = unit.instructions
        starts = {network.start for network in unit.networks if not network.region}
        for place, instruction in enumerate(instructions):
            if instruction.mnemonic in ENDS:
                if any(each.mnemonic not in ENDS for each in instructions[place + 1 :]) and instruction.mnemonic != "FX:I":
                    self.text.refuse_at(instruction, Refusal("something follows the end", "write it with one end"))
                continue
            if self._is_head(unit, place):
                continue
            self._tell_of_leaving(unit, place)
            self.more = place + 1 < len(instructions) and instructions[place + 1].definition.outputs  # the flow is needed again
            try:
                if instruction.mnemonic in NOTES:
                    self.text.note(instruction.line, NOTES[instruction.mnemonic].format(name=instruction.name))
                new = self._translated(instruction)
                if instruction.pulse >= 0 and new and not instruction.definition.rising:
                    new = self._at_rise(instruction, new)
            except Refusal as refusal:
                self.text.refuse_at(instruction, refusal)
                new = []
            if new and place in starts and instruction.mnemonic in self.source.unconditional:
                new.insert(0, Line("LD", ("SM0",), instruction.line))
            if new and unit.titles.get(place):
                new[0].title = unit.titles[place]
            lines += new
        return lines

    @staticmethod
    def _is_head(unit: Unit, place: int) -> bool:
        """The label that a subroutine begins with."""
        return unit.kind == "SUBROUTINE" and place == 0 and unit.instructions[0].mnemonic == "LBL"

    def _translated(self, instruction: Instruction) -> list[Line]:
        mask = self._mask(instruction)
        if mask:
            return [mask]
        rule = self.rules.get(instruction.mnemonic)
        if rule:
            return rule(instruction)
        name = KEYS.get(instruction.mnemonic, instruction.mnemonic)
        if name.startswith("FX:"):
            raise Refusal(f"{self.target.name} has nothing that does the same")
        if instruction.mnemonic == "FX:OUT C":
            self._counter(instruction, "stops at its preset here and counts on there")
        self.places.same_widths(instruction, TABLE[name])
        return [self._line(instruction, name, self._operands(instruction))]

    def _at_rise(self, instruction: Instruction, lines: list[Line]) -> list[Line]:
        """Executed at a rise: an edge before it, the flow kept for what follows."""
        edge = Line("EU", (), instruction.line)
        return [Line("MPS", (), instruction.line), edge, *lines, Line("MPP", (), instruction.line)] if self.more else [edge, *lines]

    # -- what has a form of its own ---------------------------------------------------------------------------------

    def _contact(self, instruction: Instruction) -> list[Line]:
        join, edge = CONTACTS[instruction.mnemonic]
        block = {"LD": [], "AND": [Line("ANB", ())], "OR": [Line("ORB", ())]}[join]
        return [self._line(instruction, "LD", self._operands(instruction)), Line(edge, (), instruction.line), *block]

    def _pulse(self, instruction: Instruction) -> list[Line]:
        edge = Line("EU" if instruction.mnemonic == "FX:PLS" else "ED", (), instruction.line)
        coil = self._line(instruction, "OUT", self._operands(instruction))
        return [Line("MPS", ()), edge, coil, Line("MPP", ())] if self.more else [edge, coil]

    def _in_place(self, instruction: Instruction) -> list[Line]:
        target, *count = self._operands(instruction)
        return [self._line(instruction, instruction.name, (target, target, *count))]

    def _mc(self, instruction: Instruction) -> list[Line]:
        level, relay = instruction.operands[0].value, self.places.operand(instruction.operands[1], instruction.written[1])
        self.levels.append(level)
        return [self._line(instruction, "OUT", (relay,)), Line("MC", (str(level),), instruction.line)]

    def _mcr(self, instruction: Instruction) -> list[Line]:
        """The end of a level ends those inside it."""
        level, lines = instruction.operands[0].value, []
        while self.levels and self.levels[-1] >= level:
            lines.append(Line("MCR", (str(self.levels.pop()),), instruction.line))
        return lines

    def _clear(self, instruction: Instruction) -> list[Line]:
        return [self._line(instruction, "MOV", ("0", *self._operands(instruction)))]

    def _count(self, instruction: Instruction) -> tuple[str, int]:
        first, last = instruction.operands
        if first.index is not None or last.index is not None:
            raise Refusal("how many devices these are is not known", "name them without an index")
        count = max(0, last.number - first.number) + 1
        for number in range(first.number, first.number + count):
            place = self.places.moved.get((first.area, number))
            if place is not None and place != Device(first.area, number):
                raise Refusal(f"{Device(first.area, number)} lies elsewhere there", "reset each by itself")
        return self._operands(instruction)[0], count

    def _zrst(self, instruction: Instruction) -> list[Line]:
        first, count = self._count(instruction)
        return [self._line(instruction, "ZRST", (first, str(count)))]

    def _zrst_words(self, instruction: Instruction) -> list[Line]:
        first, count = self._count(instruction)
        return [self._line(instruction, "FMOV", ("0", first, str(count)))]

    def _end(self, instruction: Instruction) -> list[Line]:
        return [self._line(instruction, "CFEND", ())]

    def _for(self, instruction: Instruction) -> list[Line]:
        return [Line("LD", ("SM0",), instruction.line), self._loop(instruction, "once here and never there")]

    def _label(self, instruction: Instruction) -> list[Line]:
        number = instruction.operands[0].value
        return [self._line(instruction, instruction.mnemonic, (str(number),))]

    def _call(self, instruction: Instruction) -> list[Line]:
        return [self._line(instruction, "CALL", (self._routine(str(instruction.operands[0])),))]

    # -- interrupts -------------------------------------------------------------------------------------------------

    def _enables(self) -> list[Line]:
        """Events are let in there by a relay each, here they are unless they are forbidden."""
        lines = []
        for unit in self.program.units:
            event = self._number(unit)
            if unit.kind == "INTERRUPT" and event is not None:
                relay = 40 + event % 10 if event < 20 else event + 40
                lines += [Line("LD", ("SM1",)), Line("SET", (f"SM{relay}",))]
                if event >= 26:
                    lines += [Line("LD", ("SM1",)), Line("MOV", (str(unit.event % 100), f"SD{event + 40}"))]
        if lines:
            self.text.note(0, "the events of interrupt programs are let in by relays in the first scan")
        return lines

    @staticmethod
    def _number(unit: Unit) -> int | None:
        """EC's event for an interrupt label."""
        if unit.event is None:
            return None
        head, tail = divmod(unit.event, 100)
        if head < INPUTS and tail in (0, 1):
            return head + (0 if tail else 10)
        return head + 20 if head in (6, 7, 8) and tail else None

    def _event(self, unit: Unit) -> int:
        event = self._number(unit)
        if event is None:
            self.text.refuse(unit.line, Refusal(f"the interrupt {unit.name} has no counterpart", "inputs X0 to X5 and timers have one"))
        return event or 0
