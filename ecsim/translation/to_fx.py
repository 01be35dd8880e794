"""EC10 and EC20 -> H1U and H2U."""

from collections.abc import Callable

from ..assembler import Instruction, Program, Unit
from ..devices import Bits, Constant, Device, number_text
from ..instructions.spelling import instructions_of
from ..models import Model
from ..models.model import By
from .places import Places
from .text import Line, Refusal, Text
from .way import INPUTS, MASKS, Way

# The same under another name, where the row of TABLE is not the same: wider, other limits, other flags.
NAMES = {
    **{name: name for name in "ADD SUB DADD DSUB DIV DDIV BCD DBCD BIN DBIN INT DINT FLT DFLT SIN COS TAN BMOV FMOV DFMOV XCH DXCH".split()},
    **{name: name for name in "SFTR SFTL WSFR WSFL TRD TWR TADD TSUB SPD".split()},
    **{name: f"D{name}" for name in "PLSY PLSR ZRN PLSV DRVI DRVA ABS".split()},
    "SQT": "SQR", "DSQT": "DSQR", "BITS": "SUM", "DBITS": "DSUM", "ITA": "ASCI", "ATI": "HEX", "SEG": "SEGD", "RMOV": "DMOV",
    "DCNT": "OUT", "HCNT": "OUT", "TON": "OUT", "TONR": "OUT", "CTU": "OUT",
}  # fmt: skip
# What differs though the name carries over.
NOTES = {
    **dict.fromkeys(
        ("ADD", "SUB", "DADD", "DSUB"), "{name}: a result beyond the range goes on from 0 there, from the other end of the range here"
    ),
    **dict.fromkeys(("TON", "TONR"), "timers stop at their preset there, and read one in a register when they start"),
    "CTU": "counters stop at their preset there",
    "DCNT": "counting down, the contact goes OFF on reaching the preset here and one count later there; "
    "a count upward from the preset or above puts it ON here and leaves it there",
    "SEG": "SEGD leaves the upper eight bits of its result as they are",
    "STL": "in the scan of a transition the step that is left stays ON there beside the one that begins",
}
HINTS = {
    "TOF": "STMR makes an off-delay on H2U", "TMON": "STMR makes pulses on H2U", "CTR": "reset the counter by its own contact",
    "ENCO": "FX takes the highest bit that is ON, EC the lowest", "DMUL": "FX writes a product of 64 bits",
    "MODBUS": "use RS", "XMT": "use RS", "RCV": "use RS", "PID": "its settings lie elsewhere: see the page of PID for H2U",
}  # fmt: skip
IN_PLACE = frozenset("ROR DROR ROL DROL RCR DRCR RCL DRCL NEG DNEG".split())
EDGES = {("LD", "EU"): "P", ("LD", "ED"): "F"}  # those of LDI differ in the first scan
FIRST_AUXILIARY = 499  # auxiliary relays are taken from here downward: they are not retained


class ToFX(Way):
    """A program of EC in the words of FX."""

    masks = MASKS
    says = "lets an event ask"
    leaves = "stays there and is cleared here"

    def __init__(self, program: Program, target: Model, places: Places, text: Text):
        super().__init__(program, target, places, text)
        self.names: dict[str, str] = {}
        for spelled, meant in target.spelling.items():
            for key in meant.keys if isinstance(meant, By) else (meant,):
                self.names.setdefault(key, spelled)
        self.rows = instructions_of(target)
        self.names |= {key: name for key, name in NAMES.items() if name in target.spelling}
        self.labels = {i.operands[0].value for i in program.instructions if i.mnemonic == "LBL" and isinstance(i.operands[0], Constant)}
        self.routines = {unit.name.upper(): self._label() for unit in program.units if unit.kind == "SUBROUTINE"}
        self.periods = self._periods()
        self.rules: dict[str, Callable[[Instruction], list[Line]]] = {
            "MC": self._mc, "MCR": self._mcr, "ZRST": self._zrst, "DECO": self._deco, "CALL": self._call, "LBL": self._lbl, "CJ": self._cj,
            "CFEND": self._cfend, "CSRET": self._leave, "CIRET": self._leave, **dict.fromkeys(IN_PLACE, self._in_place),
        }  # fmt: skip

    def units(self) -> list[tuple[str, list[Line], str]]:
        """Head, lines and end of each unit."""
        done = []
        others = len(self.program.units) > 1
        for unit in self.program.units:
            self.exit: int | None = None  # the label behind the last instruction, where one leads there
            lines = self._unit(unit)
            if self.exit is not None:
                lines.append(Line("P", (f"P{self.exit}",)))
            if unit.kind == "MAIN":
                done.append(("", lines, "FEND" if others else ""))
            elif unit.kind == "SUBROUTINE":
                done.append((f"// {unit.name}\nP{self.routines[unit.name.upper()]}", lines, "SRET"))
            else:
                done.append((f"// {unit.name}\n{self._event(unit)}", lines, "IRET"))
        return done

    def _label(self) -> int:
        number = next(number for number in range(128) if number not in self.labels and number != 63)
        self.labels.add(number)
        return number

    # -- one unit -------------------------------------------------------------------------------------------------

    def _unit(self, unit: Unit) -> list[Line]:
        lines: list[Line] = []
        instructions = unit.instructions
        if unit.parameters:
            self.text.refuse(
                unit.line,
                Refusal(f"{unit.name} has variables of its own", f"hand values over in devices; {self.target.name} has no others"),
            )
        open_blocks = branches = 0  # blocks that wait to be joined, flows that are kept
        place = 0
        while place < len(instructions):
            instruction = instructions[place]
            following = instructions[place + 1].mnemonic if place + 1 < len(instructions) else ""
            if any(network.start == place for network in unit.networks):
                open_blocks = branches = 0
            join = instruction.definition.join
            open_blocks += join == "LD"
            open_blocks -= instruction.mnemonic in ("ANB", "ORB")
            branches += (instruction.mnemonic == "MPS") - (instruction.mnemonic == "MPP")
            title = unit.titles.get(place, "")
            self._tell_of_leaving(unit, place)
            try:
                if instruction.mnemonic in NOTES:
                    self.text.note(instruction.line, NOTES[instruction.mnemonic].format(name=instruction.mnemonic))
                edge = EDGES.get((instruction.mnemonic, following))
                if edge:
                    new = [self._line(instruction, f"LD{edge}", self._operands(instruction))]
                    place += 1
                elif instruction.mnemonic in ("EU", "ED"):
                    new = self._edge(instruction, open_blocks, branches)
                elif following == "FOR" and str(self.places.operand(instruction.operands[0], instruction.written[0])) == "M8000":
                    place += 1
                    instruction = instructions[place]
                    new = [self._loop(instruction, "once there and never here")]
                elif self._drops(instruction):
                    new = []
                else:
                    new = self._translated(instruction)
                    alone = new and new[0].mnemonic in ("EI", "DI")
                    if alone and instructions[place - 1].definition.outputs and not branches:
                        new.insert(0, Line("AND", ("M8000",), instruction.line))  # keeps it in its rung
            except Refusal as refusal:
                self.text.refuse_at(instruction, refusal)
                new = []
            if new and title:
                new[0].title = title
            lines += new
            place += 1
        return lines

    def _translated(self, instruction: Instruction) -> list[Line]:
        mnemonic = instruction.mnemonic
        mask = self._mask(instruction)
        if mask:
            return [mask]
        rule = self.rules.get(mnemonic)
        if rule:
            return rule(instruction)
        name = self.names.get(mnemonic)
        if name is None:
            raise Refusal(f"{self.target.name} has nothing that does the same", HINTS.get(mnemonic, ""))
        if mnemonic == "CTU":
            self._counter(instruction, "counts on beyond its preset", "count with INC instead")
        if name != "OUT":
            self.places.same_widths(instruction, self.rows[name])
        return [self._line(instruction, name, self._operands(instruction))]

    # -- what has a form of its own ---------------------------------------------------------------------------------

    def _edge(self, instruction: Instruction, blocks: int, branches: int) -> list[Line]:
        """An edge of a whole flow: a relay that is ON for the scan, and then stands for the flow."""
        if blocks > 1 or (branches and instruction.mnemonic == "ED"):
            raise Refusal("the edge of a part of a rung has no counterpart", "put the edge on an auxiliary relay by a rung of its own")
        relay = str(self.places.free("M", range(FIRST_AUXILIARY, -1, -1)))
        if instruction.mnemonic == "EU":
            return [self._line(instruction, "PLS", (relay,)), Line("AND", (relay,), instruction.line)]
        return [self._line(instruction, "PLF", (relay,)), Line("LD", (relay,), instruction.line)]

    def _in_place(self, instruction: Instruction) -> list[Line]:
        """The result lies where the operand was: it is moved there first."""
        source, target, *count = self._operands(instruction)
        wide = instruction.mnemonic[0] == "D"
        if count and isinstance(instruction.operands[2], Constant):  # a whole turn more changes nothing
            turn = (32 if wide else 16) + instruction.mnemonic.lstrip("D").startswith("RC")
            places = instruction.operands[2].value
            places = (places - 1) % turn + 1 if places else 0
            count = [f"K{places if places <= 32 and (wide or places <= 16) else 0}"]
        lines = [] if source == target else [self._line(instruction, "DMOV" if wide else "MOV", (source, target))]
        return [*lines, self._line(instruction, instruction.mnemonic, (target, *count))]

    def _mc(self, instruction: Instruction) -> list[Line]:
        level = f"N{instruction.operands[0].value}"
        relay = self.places.free("M", range(FIRST_AUXILIARY, -1, -1))
        return [self._line(instruction, "MC", (level, str(relay)))]

    def _mcr(self, instruction: Instruction) -> list[Line]:
        return [self._line(instruction, "MCR", (f"N{instruction.operands[0].value}",))]

    def _zrst(self, instruction: Instruction) -> list[Line]:
        """First and count here, first and last there."""
        first, count = instruction.operands
        if not isinstance(count, Constant) or not isinstance(first, Device) or first.index is not None:
            raise Refusal("the last device is not known", "give the count as a constant")
        length = max(1, count.value)
        places = [
            self.places.device(Device(first.area, first.number + n))
            for n in range(length)
            if (first.area, first.number + n) in self.places.moved
        ]
        begin = self.places.moved[first.area, first.number]
        if any(place.number - begin.number >= length or place.number < begin.number for place in places):
            raise Refusal(f"the {length} devices from {first} on are no neighbours in {self.target.name}", "reset each by itself")
        last = f"{begin.area}{number_text(begin.area, begin.number + length - 1)}"
        return [self._line(instruction, "ZRST", (self._operands(instruction)[0], last))]

    def _deco(self, instruction: Instruction) -> list[Line]:
        source, target = self._operands(instruction)
        if isinstance(instruction.operands[1], Bits):
            raise Refusal("DECO counts its bits there", "decode into a register")
        return [self._line(instruction, "DECO", (source, target, "K4"))]

    def _call(self, instruction: Instruction) -> list[Line]:
        return [self._line(instruction, "CALL", (f"P{self.routines[instruction.operands[0].text.upper()]}",))]

    def _lbl(self, instruction: Instruction) -> list[Line]:
        return [self._line(instruction, "P", (f"P{self._jump(instruction)}",))]

    def _cj(self, instruction: Instruction) -> list[Line]:
        return [self._line(instruction, "CJ", (f"P{self._jump(instruction)}",))]

    @staticmethod
    def _jump(instruction: Instruction) -> int:
        number = instruction.operands[0].value
        if number == 63:
            raise Refusal("P63 is the end of the program there", "take another label")
        return number

    def _cfend(self, instruction: Instruction) -> list[Line]:
        return [self._line(instruction, "CJ", ("P63",))]

    def _leave(self, instruction: Instruction) -> list[Line]:
        """A conditional return: a jump to the end of the unit."""
        if self.exit is None:
            self.exit = self._label()
        return [self._line(instruction, "CJ", (f"P{self.exit}",))]

    # -- interrupts -------------------------------------------------------------------------------------------------

    def _periods(self) -> dict[int, int]:
        """The periods of timed interrupts that the program sets, by register."""
        found: dict[int, set[int]] = {}
        for instruction in self.program.instructions:
            target = instruction.operands[-1] if instruction.operands else None
            if isinstance(target, Device) and target.area == self.source.special_words and target.number in (66, 67, 68):
                value = instruction.operands[0]
                found.setdefault(target.number, set()).add(
                    value.value if instruction.mnemonic == "MOV" and isinstance(value, Constant) else -1
                )
        return {register: next(iter(values)) for register, values in found.items() if len(values) == 1}

    def _drops(self, instruction: Instruction) -> bool:
        target = instruction.operands[-1] if instruction.operands else None
        return isinstance(target, Device) and target.area == self.source.special_words and target.number in self.periods

    def _event(self, unit: Unit) -> str:
        event = unit.event
        try:
            if event % 10 < INPUTS and event < 20:
                return f"I{event % 10}0{int(event < 10)}"
            period = self.periods.get(event + 40, 0)
            if event in (26, 27, 28) and 1 <= period <= 99:
                return f"I{event - 20}{period:02}"
            raise Refusal(f"{unit.name}: event {event} has no counterpart", "inputs X0 to X5 and fixed periods of 1 to 99 ms have one")
        except Refusal as refusal:
            self.text.refuse(unit.line, refusal)
            return "I000"
