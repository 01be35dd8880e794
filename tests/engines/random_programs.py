"""Random programs that compile: what the manual's rules allow, mixed in every way. TABLE says which instructions there are.

`chance` is a random.Random or Hypothesis's stand-in for one, which makes a failing program small. A program is kept on few
devices, so that its parts meet, with numbers at the edges of the areas, so that indexed operands leave them now and then.
"""

from dataclasses import dataclass, field, replace
from functools import cache

from ecsim.assembler import assemble
from ecsim.errors import ProgramError
from ecsim.instructions import TABLE
from ecsim.instructions.signature import OperandSpec, parse_signature
from ecsim.values import BOOL, REAL, TYPES

STRUCTURE = set("ANB ORB MPS MRD MPP MC MCR STL RET FOR NEXT LBL CJ CFEND CSRET CIRET STOP CALL NOP EU ED INV".split())
CONTACTS = [row for row in TABLE.values() if row.form == "contact"]
OUTPUTS = [row for row in TABLE.values() if row.form != "contact" and row.mnemonic not in STRUCTURE and row.operands]
JOINED = {join: [row for row in CONTACTS if row.join == join] for join in ("LD", "AND", "OR")}
PLAIN = {join: [row for row in rows if not row.application] for join, rows in JOINED.items()}

NUMBERS = {
    "X": (*range(8), 0o10, 0o17, 0o177, 0o377),
    "Y": (*range(8), 0o377),
    "M": (*range(12), 16, 1999, 2047),
    "LM": (*range(4), 63),
    "SM": (1, 10, 11, 12, 15, 20, 21, 22, 180, 181, 182),
    "T": (0, 1, 209, 210, 211, 252, 253, 255),
    "C": (0, 1, 2, 199, 200, 201, 235),
    "D": (*range(16), 100, 7990, 7998, 7999),
    "SD": (0, 20, 21, 30, 31, 34),
    "V": (*range(6), 62, 63),
    "Z": (0, 1, 2, 3, 15),
}
WRITABLE_SPECIAL = {"SM": (40, 41, 66, 67, 180, 200), "SD": (66, 67, 90)}
CONSTANTS = {
    "INT": "0 1 -1 2 3 5 8 10 16 100 255 256 32767 -32768 16#FFFF 16#8000 2#1011 8#17".split(),
    "DINT": "0 1 -1 2 7 65535 65536 100000 2147483647 -2147483648 16#FFFFFFFF 16#80000000".split(),
    "REAL": "0.0 1.0 -1.5 2.5 0.1 1E10 -3.4E+38 3.4E+38 1E-40 100 7".split(),
    "BOOL": "0 1".split(),
}


def octal(area: str, number: int) -> str:
    """The name of a device."""
    return f"{area}{number:o}" if area in "XY" else f"{area}{number}"


def purpose_of(row) -> str | None:
    """What an instruction uses the first inputs for, None when it leaves them alone."""
    if any(spec.kind == "HCOUNTER" for spec in row.operands):
        return "counter"
    return "speed" if any(spec.order == ("X",) for spec in row.operands) else None


@cache
def accepted(model: str, mnemonic: str, line: str, variables: tuple[tuple[str, str, str], ...]) -> bool:
    """Whether the assembler takes a line in a unit with these variables; TABLE's ranges and checks are its own matter."""
    row = TABLE[mnemonic]
    code = [*([] if row.join == "LD" else ["LD SM0"]), line, *(["OUT M0"] if row.form == "contact" else [])]
    declared = [f"VAR_{role} {name} : {kind}" for role, name, kind in variables]
    try:
        assemble("\n".join(["PROGRAM MAIN", "END_PROGRAM", "SUBROUTINE S", *declared, *code, "END_SUBROUTINE"]), model)
    except ProgramError:
        return False
    return True


@dataclass
class Scope:
    """Where lines are being written: the unit, its own variables, the structures around."""

    kind: str = "MAIN"
    variables: tuple[tuple[str, str, str], ...] = ()  # role, name, type
    callable: list["Routine"] = field(default_factory=list)
    masters: tuple[int, ...] = ()
    loops: tuple[int, ...] = ()
    in_step: bool = False
    bus: bool = False  # whether an output may stand without a contact


@dataclass
class Routine:
    """A subroutine as its callers see it."""

    name: str
    variables: tuple[tuple[str, str, str], ...]

    @property
    def parameters(self) -> list[tuple[str, str, str]]:
        return [variable for variable in self.variables if variable[0] != "TEMP"]


class Maker:
    """Writes one program. `size` is about how many rungs and structures the main program has."""

    def __init__(self, chance, size: int, model: str):
        self.chance, self.size, self.model = chance, size, model
        self.labels = 0
        self.loop_count = 0
        # Each of the first inputs serves one purpose only (8.1): this one in this program.
        self.purpose = self.pick("edges", "counter", "speed", "none")
        self.counter = self.pick(236, 242, 246, 251)
        self.outputs = [row for row in OUTPUTS if purpose_of(row) in (None, self.purpose) and model in row.models]
        self.steps = (20, 21, 22, 23)

    def pick(self, *choices):
        return self.chance.choice(choices)

    def often(self, share: float) -> bool:
        return self.chance.random() < share

    # -- operands -----------------------------------------------------------------------------------------------

    def operand(self, spec: OperandSpec, scope: Scope) -> str:
        """The text of one operand for a place of an instruction."""
        local = [name for role, name, kind in scope.variables if kind == spec.type.name]
        if local and spec.kind in TYPES and self.often(0.4):
            return f"#{self.chance.choice(local)}"
        area = self.chance.choice(
            [area for area in spec.order if area in NUMBERS or area in ("const", "text", "S") or area.startswith("Kn")]
        )
        if area == "const":
            return self._constant(spec)
        if area == "text":
            return self.pick("A", "EC20", "0123456789")
        if area.startswith("Kn"):
            digits = self.chance.choice((1, 2, 3, 4) if spec.type.bits <= 16 else (5, 6, 8))
            text = f"K{digits}{self._device(area[2:], spec, scope, wide=4 * digits)}"
        else:
            text = self._device(area, spec, scope)
        if spec.indexed and area not in ("SM", "SD", "KnSM") and self.often(0.25):
            text += f"Z{self.chance.randint(0, 3)}"
        return text

    def _constant(self, spec: OperandSpec) -> str:
        if spec.range:
            low, high = spec.range
            return str(self.pick(low, high, min(high, low + 1), self.chance.randint(low, min(high, low + 20))))
        kind = "REAL" if spec.type is REAL else "BOOL" if spec.type is BOOL else "INT" if spec.type.bits == 16 else "DINT"
        return self.chance.choice(CONSTANTS[kind])

    def _device(self, area: str, spec: OperandSpec, scope: Scope, wide: int = 0) -> str:
        if area == "S":
            return f"S{self.chance.choice((0, 1, *self.steps))}"
        if spec.kind == "HCOUNTER":
            return f"C{self.counter}"
        numbers = WRITABLE_SPECIAL[area] if spec.written and area in WRITABLE_SPECIAL else NUMBERS[area]
        if area == "C" and spec.type.bits > 1:
            numbers = [n for n in numbers if (n >= 200) == (spec.type.bits == 32)]
        return octal(area, self.chance.choice(numbers))

    def line(self, row, scope: Scope) -> str | None:
        """An instruction with operands that the assembler takes, None when it took none of several."""
        for _ in range(4):
            text = " ".join([row.mnemonic, *(self.operand(spec, scope) for spec in row.operands)])
            if accepted(self.model, row.mnemonic, text, scope.variables if "#" in text else ()):
                if (
                    scope.in_step
                    and row.mnemonic in ("SET", "OUT")
                    and text.split()[1].startswith("S")
                    and not text.split()[1].startswith("SM")
                ):
                    continue  # a transition is written by the flow
                return text
        return None

    # -- contacts -----------------------------------------------------------------------------------------------

    def contact(self, join: str, scope: Scope) -> str:
        row = self.chance.choice(PLAIN[join] if self.often(0.7) else JOINED[join])
        return self.line(row, scope) or f"{join} M{self.chance.randint(0, 11)}"

    def block(self, depth: int, scope: Scope) -> list[str]:
        """The contacts of a block, from LD on, that leave one flow."""
        lines = [self.contact("LD", scope)]
        for _ in range(self.pick(0, 0, 1, 1, 2)):
            kind = self.chance.randint(0, 3 if depth else 1)
            if kind < 2:
                lines.append(self.contact(("AND", "OR")[kind], scope))
            else:
                lines += [*self.block(depth - 1, scope), self.pick("ANB", "ORB")]
            if self.often(0.12):
                lines.append(self.pick("EU", "ED", "INV"))
        return lines

    def further(self, scope: Scope, fresh: bool) -> list[str]:
        """Contacts behind a fork: in series only, a block when no output stands right before it."""
        if fresh and self.often(0.3):
            return [*self.block(1, scope), "ANB"]
        lines = [self.contact("AND", scope)]
        if self.often(0.1):
            lines.append(self.pick("EU", "ED", "INV"))
        return lines

    # -- outputs ------------------------------------------------------------------------------------------------

    def output(self, scope: Scope) -> str:
        kind = self.chance.random()
        if kind < 0.35:
            row = self.pick(TABLE["OUT"], TABLE["SET"], TABLE["RST"])
        elif kind < 0.45:
            row = self.pick(*(TABLE[name] for name in ("TON", "TONR", "TOF", "TMON", "CTU", "CTR", "DCNT")))
        elif kind < 0.55 and scope.callable and scope.kind != "INTERRUPT":
            return self.call(scope)
        elif kind < 0.6:
            return self.rare(scope)
        else:
            row = self.chance.choice(self.outputs)
            if purpose_of(row) == "speed":
                self.outputs.remove(row)  # once
        return self.line(row, scope) or f"OUT M{self.chance.randint(0, 11)}"

    def rare(self, scope: Scope) -> str:
        leave = {"MAIN": "CFEND", "SUBROUTINE": "CSRET", "INTERRUPT": "CIRET"}[scope.kind]
        return self.pick("EI", "DI", "WDT", "MOV 2 Z0", "MOV -3 Z1", "INC Z2", leave, "STOP" if self.often(0.2) else "NOP")

    def call(self, scope: Scope) -> str:
        routine = self.chance.choice(scope.callable)
        words = []
        for role, _, kind in routine.parameters:
            spec = parameter(role, kind)
            for _ in range(6):
                word = self.operand(spec, scope)
                if word.startswith("#") or self._fits(spec, word):
                    break
            else:
                return "SET M11"
            words.append(word)
        return " ".join(["CALL", routine.name, *words])

    def _fits(self, spec: OperandSpec, word: str) -> bool:
        return parameter_accepted(self.model, spec.type.name, spec.read, spec.written, word)

    def rung(self, scope: Scope) -> list[str]:
        """One rung with one or several outputs, branches and all."""
        if scope.bus and self.often(0.2):
            line = self.output(scope)  # straight on the inner bus
            return ["LD M0", line] if line == "NOP" else [line]
        return [*self.block(2, scope), *self.branch(scope, 2, fresh=False)]

    def branch(self, scope: Scope, depth: int, fresh: bool) -> list[str]:
        """What a flow does: contacts, outputs one after the other, or several branches of MPS."""
        lines: list[str] = self.further(scope, True) if fresh and self.often(0.6) else []
        if depth and self.often(0.25):
            count = self.pick(2, 2, 3)
            for number in range(count):
                lines.append("MPS" if number == 0 else "MPP" if number == count - 1 else "MRD")
                lines += self.branch(scope, depth - 1, fresh=True)
            return lines
        lines.append(self.output(scope))
        while self.often(0.3):
            if self.often(0.4):
                lines += self.further(scope, False)
            lines.append(self.output(scope))
        return lines

    # -- structures ---------------------------------------------------------------------------------------------

    def body(self, scope: Scope, size: int) -> list[str]:
        """Rungs and structures one after the other."""
        lines: list[str] = []
        for _ in range(size):
            kind = self.chance.random()
            if kind < 0.1 and not scope.in_step and len(scope.masters) < 3:
                lines += self.master(scope, size)
            elif kind < 0.2 and len(scope.loops) < 2:
                lines += self.loop(scope, size)
            elif kind < 0.28:
                lines += self.jump(scope, size)
            else:
                lines += self.rung(scope)
        return lines

    def master(self, scope: Scope, size: int) -> list[str]:
        number = self.chance.choice([n for n in range(8) if n not in scope.masters])
        inside = self.body(replace(scope, bus=True, masters=(*scope.masters, number)), self.pick(1, 1, 2))
        lines = [*self.block(1, scope), f"MC {number}", *inside, f"MCR {number}"]
        if self.often(0.15) and self.labels < 120:  # a way in past the condition
            label = self.label()
            lines.insert(lines.index(f"MC {number}") + 1, f"LBL {label}")
            return [*self.block(1, scope), f"CJ {label}", *lines]
        return self.left(lines, scope)

    def loop(self, scope: Scope, size: int) -> list[str]:
        self.loop_count += 1
        count = self.pick("0", "1", "2", "3", "D5", "D9Z0", "-1")
        inside = self.body(replace(scope, bus=False, loops=(*scope.loops, self.loop_count)), self.pick(1, 1, 2))
        return self.left([*self.block(1, scope), f"FOR {count}", *inside, "NEXT"], scope)

    def label(self) -> int:
        self.labels += 1
        return self.labels - 1

    def left(self, lines: list[str], scope: Scope) -> list[str]:
        """A structure, now and then with a jump out of its end."""
        if self.often(0.2) and self.labels < 120:
            label = self.label()
            return [*lines[:-1], *self.block(1, scope), f"CJ {label}", *self.rung(replace(scope, bus=False)), lines[-1], f"LBL {label}"]
        return lines

    def jump(self, scope: Scope, size: int) -> list[str]:
        if self.labels >= 120:
            return self.rung(scope)
        label = self.label()
        inside = self.body(scope, self.pick(1, 1, 2))
        jump = [*self.block(1, scope), f"CJ {label}"]
        if self.often(0.6):
            return [*jump, *inside, f"LBL {label}"]
        # A way back: as long as a counted register lets it, or, seldom, until the watchdog ends it.
        if self.often(0.1):
            return [f"LBL {label}", *inside, *jump]
        register = f"D{500 + label}"
        return [
            "LD SM0",
            f"MOV 0 {register}",
            f"LBL {label}",
            *inside,
            "LD SM0",
            f"INC {register}",
            f"LD< {register} {self.pick(1, 2, 4)}",
            *jump[:-1],
            "ANB",
            jump[-1],
        ]

    # -- step flows ---------------------------------------------------------------------------------------------

    def flow(self, number: int) -> list[str]:
        """A flow of steps: in a row, selected, in parallel, with jumps; ends in RET."""
        scope = Scope(in_step=True, bus=True)
        free = iter(range(20 + 40 * number, 60 + 40 * number))
        lines: list[str] = []
        initial = f"S{number}"
        first = [*self.step(initial, scope)]
        known = [initial]
        pending = first
        for _ in range(self.pick(1, 2, 3)):
            kind = self.pick("row", "row", "selection", "parallel")
            branches = 1 if kind == "row" else self.pick(2, 3)
            chains = [[f"S{next(free)}" for _ in range(self.pick(1, 1, 2))] for _ in range(branches)]
            if kind == "parallel":
                pending += [*self.block(1, scope), *(f"SET {chain[0]}" for chain in chains)]
            else:
                for chain in chains:
                    pending += [*self.block(1, scope), f"SET {chain[0]}"]
            if self.often(0.25):
                pending += [*self.block(1, scope), f"OUT {self.chance.choice(known)}"]
            lines += pending
            pending = []
            ends = []
            for chain in chains:
                for place, step in enumerate(chain):
                    lines += pending
                    pending = self.step(step, scope)
                    known.append(step)
                    if place + 1 < len(chain):
                        pending += [*self.block(1, scope), f"SET {chain[place + 1]}"]
                    elif kind == "parallel" and len(pending) == 1:
                        pending = []  # an empty step that waits stands in the join alone: STL after STL is a join
                ends.append(chain[-1])
                if kind != "row" and chain is not chains[-1]:
                    if kind == "selection":
                        pending += [*self.block(1, scope), "SET @"]  # @: the step in which they meet
                    lines += pending
                    pending = []
            meeting = f"S{next(free)}"
            if kind == "selection":
                pending += [*self.block(1, scope), f"SET {meeting}"]
            elif kind == "parallel":
                lines += pending
                pending = [*(f"STL {end}" for end in ends), *self.rung_or_none(scope), *self.block(1, scope), f"SET {meeting}"]
            else:
                pending += [*self.block(1, scope), f"SET {meeting}"]
            lines += pending
            lines = [line.replace("@", meeting) for line in lines]
            pending = self.step(meeting, scope)
            known.append(meeting)
        pending += [*self.block(1, scope), f"OUT {self.chance.choice(known)}"]
        if self.often(0.3):
            pending += [*self.block(1, scope), f"RST {meeting}"]
        self.steps = (*self.steps, *(int(step[1:]) for step in known))
        return [*lines, *pending, "RET"]

    def rung_or_none(self, scope: Scope) -> list[str]:
        return self.rung(scope) if self.often(0.5) else []

    def step(self, step: str, scope: Scope) -> list[str]:
        return [f"STL {step}", *(line for _ in range(self.pick(0, 1, 1, 2)) for line in self.body(scope, 1))]

    # -- the program --------------------------------------------------------------------------------------------

    def routine(self, number: int, callable_: list[Routine]) -> tuple[Routine, list[str]]:
        kinds = list(TYPES)
        roles = ("INPUT", "INPUT", "OUTPUT", "IN_OUT", "TEMP")
        variables = tuple(
            (self.chance.choice(roles), f"P{number}_{place}", self.chance.choice(kinds)) for place in range(self.pick(0, 1, 2, 4))
        )
        scope = Scope(kind="SUBROUTINE", variables=variables, callable=callable_)
        declared = [f"VAR_{role} {name} : {kind}" for role, name, kind in variables]
        name = f"SBR_{number}"
        return Routine(name, variables), [f"SUBROUTINE {name}", *declared, *self.body(scope, self.pick(1, 2, 3)), "END_SUBROUTINE"]

    def interrupt(self, number: int, event: int) -> list[str]:
        return [f"INTERRUPT INT_{number} EVENT {event}", *self.body(Scope(kind="INTERRUPT"), self.pick(1, 2)), "END_INTERRUPT"]

    def program(self) -> str:
        """The text of one program."""
        routines: list[Routine] = []
        parts: list[list[str]] = []
        for number in range(self.pick(0, 0, 1, 2, 3)):
            self.labels = 0
            routine, lines = self.routine(number, list(routines))
            routines.append(routine)
            parts.append(lines)
        events = {"edges": [0, 1, 12, 26, 27], "counter": [20, 21, 26, 27]}.get(self.purpose, [26, 27])
        events = self.chance.sample(events, self.pick(0, 0, 1, 2))
        for number, event in enumerate(events):
            self.labels = 0
            parts.append(self.interrupt(number, event))
        self.labels = 0
        scope = Scope(callable=routines)
        main = (
            ["LD SM1", "EI", "SET SM40", "SET SM41", "SET SM42", "SET SM66", "SET SM65", "SET SM67", "MOV 3 SD66", "MOV 25 SD67"]
            if events
            else []
        )
        for number in range(self.pick(0, 0, 1, 2)):
            main += [f"LD {self.pick('SM1', 'SM1', 'X0', 'M1')}", f"SET S{number}", *self.body(scope, self.pick(0, 1)), *self.flow(number)]
        main += self.body(scope, self.size)
        return "\n".join(["PROGRAM MAIN", *main, "END_PROGRAM", *(line for part in parts for line in part)])


@cache
def parameter(role: str, kind: str) -> OperandSpec:
    """What may stand for a variable of a subroutine at the call (table 3-3)."""
    text = {"INPUT": f"P:{kind}", "OUTPUT": f"-> P:{kind}", "IN_OUT": f"P:{kind} -> P"}[role]
    return parse_signature(text)[0][0]


@cache
def parameter_accepted(model: str, kind: str, read: bool, written: bool, word: str) -> bool:
    """Whether the assembler takes a word for a subroutine's variable."""
    role = "IN_OUT" if read and written else "OUTPUT" if written else "INPUT"
    text = f"PROGRAM MAIN\nLD SM0\nCALL P {word}\nEND_PROGRAM\nSUBROUTINE P\nVAR_{role} A : {kind}\nEND_SUBROUTINE"
    try:
        assemble(text, model)
    except ProgramError:
        return False
    return True


def random_program(chance, size: int = 8, model: str = "EC20") -> str:
    """One program that compiles for a model."""
    return Maker(chance, size, model).program()
