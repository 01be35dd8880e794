"""The compiled engine: a program as readable Python over plain lists, the contacts of a rung folded into one expression.

A unit becomes functions of about 200 instructions, cut between rungs. Structures become `if` and `for`; a unit with
jumps (CJ) is written flat instead: segments that tell which one follows. The logic stack exists only here, while writing.
"""

import linecache
import re
from dataclasses import dataclass, field
from types import CodeType

from ..assembler.program import Instruction, Network, Program, Region, Unit
from ..devices import Device, Operand
from ..memory import Memory
from ..values import BOOL, INT
from .writer import INDENT, Writer, indented

CHUNK = 200
LEFT, HALTED = 1, 2  # what a unit's functions return: 0 goes on, LEFT ends the unit, HALTED stops the PLC
MAX_TEXT, MAX_DEPTH = 1200, 20  # a longer or deeper expression is cut by a name: CPython's parser has limits

_OR, _AND, _NOT, _ATOM = range(4)
_LISTS = re.compile(r"\b([A-Z]{1,5})\[")


@dataclass(slots=True)
class Flow:
    """A power flow as an expression, with its binding strength and depth of parentheses."""

    text: str
    binds: int = _ATOM
    depth: int = 0

    def within(self, binds: int) -> str:
        return self.text if self.binds >= binds else f"({self.text})"

    @property
    def named(self) -> bool:
        return self.text.isidentifier()


ON = Flow("True")


def _joined(word: str, left: Flow, right: Flow) -> Flow:
    binds = _AND if word == "and" else _OR
    depth = max(left.depth + (left.binds < binds), right.depth + (right.binds <= binds and right.binds != binds))
    return Flow(f"{left.within(binds)} {word} {right.within(binds)}", binds, depth)


def _statements(lines: list[str]) -> list[str]:
    """Lines as the body of a function or an `if`: comments alone are none."""
    return lines if any(not line.lstrip().startswith("#") for line in lines) else [*lines, "pass"]


@dataclass(slots=True)
class Block:
    """Statements of so many instructions; `leaves` when they can return."""

    lines: list[str] = field(default_factory=list)
    count: int = 0
    leaves: bool = False


class Compiler(Writer):
    """Writes the source of one program."""

    def __init__(self, program: Program, forwarding: bool = True):
        super().__init__(program, forwarding)
        self.out: list[str] = []
        self.functions = 0
        self.globals["LOOPS"] = []
        self.unit_names = {unit.name.upper(): f"unit_{place}" for place, unit in enumerate(program.units)}

    def source(self) -> str:
        """The whole program as Python."""
        for unit in self.program.units:
            self.unit = unit
            self.flat = any(instruction.mnemonic == "CJ" for instruction in unit.instructions)
            if self.flat:
                _FlatUnit(self).write()
            else:
                self._structured()
        return "\n".join(self.out) + "\n"

    # -- functions ----------------------------------------------------------------------------------------------

    def function(self, name: str, lines: list[str]) -> None:
        """Write one function; the lists it uses become defaults, which are reached faster than globals."""
        body = _statements(lines)
        used = sorted(set(_LISTS.findall("\n".join(body))))
        parameters = ", ".join(f"{area}={area}" for area in used)
        self.out += [f"def {name}({parameters}):", *indented(body), ""]

    def new_loop(self) -> int:
        """A place for what is left of one FOR; each has its own, since a loop may call a subroutine with loops."""
        self.globals["LOOPS"].append(0)
        return len(self.globals["LOOPS"]) - 1

    def new_name(self) -> str:
        self.functions += 1
        return f"part_{self.functions}"

    def _structured(self) -> None:
        block = self.pack(self.blocks(self.unit.nodes), always=len(self.unit.instructions) > CHUNK)
        self.function(self.unit_names[self.unit.name.upper()], block.lines)

    def pack(self, blocks: list[Block], always: bool = False) -> Block:
        """Blocks one after the other; more than a function should hold are put into functions of their own."""
        total = sum(block.count for block in blocks)
        if total <= CHUNK and not always:
            return Block([line for block in blocks for line in block.lines], total, any(block.leaves for block in blocks))
        lines: list[str] = []
        leaves, pending = False, Block()
        for block in [*blocks, None]:
            if block is None or (pending.count and pending.count + block.count > CHUNK):
                name = self.new_name()
                self.function(name, pending.lines)
                lines += [f"left = {name}()", "if left: return left"] if pending.leaves else [f"{name}()"]
                leaves, pending = leaves or pending.leaves, Block()
            if block is not None:
                pending.lines += block.lines
                pending.count += block.count
                pending.leaves = pending.leaves or block.leaves
        return Block(lines, 1, leaves)

    def blocks(self, nodes: list) -> list[Block]:
        """The rungs and regions below some nodes."""
        blocks: list[Block] = []
        for node in nodes:
            if isinstance(node, Network):
                rung = _Rung(self, self.unit)
                blocks.append(Block(rung.lines, node.end - node.start, False))
                rung.write(self.unit.instructions[node.start : node.end])
                blocks[-1].leaves = rung.leaves
                opened = rung.opened
            else:
                inside = self._region(node, opened)
                blocks[-1].lines += inside.lines  # a region stays with the rung that opens it
                blocks[-1].count += inside.count
                blocks[-1].leaves = blocks[-1].leaves or inside.leaves
        return blocks

    def _region(self, region: Region, opened: str) -> Block:
        with self.inside(region):
            body = self.pack(self.blocks(region.nodes))
        inner = _statements(body.lines)
        if region.kind == "MC":
            clear = self.clear_lines(self.unit, region)
            lines = [f"if {opened}:", *indented(inner), *(["else:", *indented(clear)] if clear else [])]
        elif region.kind == "STL":
            clear = self.clear_lines(self.unit, region)
            active = " and ".join(f"S[{step.number}]" for step in region.steps)
            lines = [f"if {active}:", *indented([*([f"E[{region.slot}] = True"] if clear else []), *inner])]
            if clear:
                lines += [f"elif E[{region.slot}]:", *indented([f"E[{region.slot}] = False", *clear])]
        else:
            spend = f"spend({self.unit.length(region.opening + 1, region.closing + 1)})"
            lines = [f"for turn_{region.opening} in range({opened}):", *indented([spend, *inner])]
        return Block(lines, body.count + 1, body.leaves)


class _Rung:
    """Writes the instructions of one rung; the verbs of `Writer` for the structured form."""

    def __init__(self, compiler: Compiler, unit: Unit):
        self.c, self.unit = compiler, unit
        self.lines: list[str] = []
        self.leaves = False
        self.opened = ""
        self.stack: list[Flow] = []
        self.flow: Flow | None = None
        self.kept: list[Flow] = []
        self.names = 0
        self.last: tuple[str, int] = ("", -1)

    @property
    def in_step(self) -> bool:
        return self.c.in_step

    def write(self, instructions: list[Instruction]) -> None:
        self.lines.append(f"# line {instructions[0].line}")
        for place, instruction in enumerate(instructions):
            self.instruction = instruction
            following = instructions[place + 1] if place + 1 < len(instructions) else None
            self.again = following is not None and following.mnemonic not in ("MRD", "MPP")
            if instruction.definition.form in ("value", "command") and not instruction.definition.told:
                self._value(instruction, instructions[place + 1 :])
            else:
                self.c.known.forget()
                self._one(instruction)
                self.c.known.forget()

    def _value(self, instruction: Instruction, following: list[Instruction]) -> None:
        flow = self._used()
        if self.last != (flow, len(self.lines)) or instruction.pulse >= 0:
            self.c.known.begin()
        self._when(self.c.value(instruction, telling=not self.c.overridden(instruction, following)))
        if instruction.pulse >= 0:
            self.c.known.forget()

    def _one(self, instruction: Instruction) -> None:
        form, definition = instruction.definition.form, instruction.definition
        if form == "contact":
            self._contact(instruction)
        elif definition.told:
            self.lines += self.c.value(instruction, self._told().text)
        elif form == "always":
            self._always(instruction)
        else:
            definition.function(self, *instruction.operands)

    def _name(self, text: str) -> Flow:
        self.names += 1
        name = f"f{self.names}"
        self.lines.append(f"{name} = {text}")
        return Flow(name)

    def _bus(self) -> Flow:
        """The flow at this place; on an inner bus it is ON."""
        if self.flow is None:
            self.flow = ON
        return self.flow

    def _contact(self, instruction: Instruction) -> None:
        lines, text = self.c.contact(instruction)
        if lines:
            if not instruction.definition.given:  # else they change nothing but what it keeps
                self._settle()
            self.lines += lines
        closed = Flow(text, _NOT if text.startswith("not ") else _ATOM)
        join = instruction.definition.join
        if join == "LD":
            if self.flow is not None:
                self.stack.append(self.flow)
            self.flow = closed
        else:
            self.flow = self._cut(_joined(join.lower(), self._bus(), closed))

    def _settle(self) -> None:
        """Fix the flows that read a special relay or register: the statements that follow may change it (SM20 and its like)."""
        self.stack = [self._name(flow.text) if self._special(flow.text) else flow for flow in self.stack]
        if self.flow is not None and self._special(self.flow.text):
            self.flow = self._name(self.flow.text)

    def _special(self, text: str) -> bool:
        """Whether an expression reads a special relay or register."""
        model = self.c.model
        found = re.findall(rf"\b(?:{model.special_bits}|{model.special_words})\[(\d+)", text)
        return any(int(number) >= model.first_special for number in found)

    def _cut(self, flow: Flow) -> Flow:
        return self._name(flow.text) if len(flow.text) > MAX_TEXT or flow.depth > MAX_DEPTH else flow

    def _used(self) -> str:
        """The flow for an output; given a name first when it is needed again afterwards."""
        flow = self._bus()
        if self.again and not flow.named:
            flow = self.flow = self._name(flow.text)
        return flow.text

    def _told(self) -> Flow:
        """The flow under a name, for an instruction that is told of it."""
        flow = self._bus()
        if not flow.named:
            flow = self.flow = self._name(flow.text)
        return flow

    def _when(self, lines: list[str]) -> None:
        flow = self._used()
        if self.instruction.pulse >= 0:
            self.lines += self.c.at_rise(self.instruction, flow, lines)
            return
        if flow == "True":
            self.lines += lines
        elif self.last == (flow, len(self.lines)):  # one `if` around several outputs of one flow
            self.lines += indented(lines)
        else:
            self.lines += [f"if {flow}:", *indented(lines)]
        self.last = (flow, len(self.lines))

    def _always(self, instruction: Instruction) -> None:
        from .template import template

        pattern = template(instruction.definition.function, "always")
        if pattern.expression and pattern.uses.get("flow") == 1 and pattern.text.startswith("not "):
            self.flow = self._cut(Flow(pattern.fill({"flow": self._bus().within(_ATOM)}), _NOT, self.flow.depth + 1))
            return
        flow = self._bus()
        if (pattern.uses.get("flow", 0) > 1 or (self.again and not pattern.returns)) and not flow.named:
            flow = self.flow = self._name(flow.text)
        result = f"g{self.names}"
        lines, returns = self.c.always(instruction, flow.within(_ATOM) if " " in flow.text else flow.text, result)
        self.lines += lines
        if returns:
            self.names += 1
            self.flow = Flow(result)

    # -- verbs --------------------------------------------------------------------------------------------------

    def assign(self, d: Device) -> None:
        flow = self._used()
        self.lines += self.c.access.store(BOOL, d, flow)

    def turn(self, d: Device, on: bool) -> None:
        self._when(self.c.turn_lines(d, on))

    def transfer(self, target: Device) -> None:
        self._when(self.c.transfer_lines(target))

    def combine(self, word: str) -> None:
        left = self.stack.pop()
        self.flow = self._cut(_joined(word, left, self.flow))

    def push(self) -> None:
        self.kept.append(self._told())

    def read(self) -> None:
        self.flow = self.kept[-1]

    def pop(self) -> None:
        self.flow = self.kept.pop()

    def pulse(self, d: Device, rising: bool) -> None:
        self.lines += self.c.pulse_lines(self.instruction, d, self._told().text, rising)

    def guard(self, d: Device | None = None) -> None:
        if d is not None:
            self.lines += self.c.access.store(BOOL, d, self._told().text)
        self.opened = self._bus().text

    def step(self) -> None:
        self.opened = ""

    def close(self) -> None:
        pass

    def repeat(self, count: Operand, least: int = 0) -> None:
        load = self.c.access.load(INT, count)
        if least:
            load = f"max({load}, {least})"
        flow = self._bus().text
        fetch = self.c.guard_faults([f"turns = {load}"], (count,))
        self.lines += ["turns = 0", *([f"if {flow}:", *indented(fetch)] if flow != "True" else fetch)]
        self.opened = "turns"

    def label(self, number: int) -> None:
        """A label that nothing jumps to needs no code."""

    def leave(self) -> None:
        self.leaves = True
        self._when([f"return {LEFT}"])

    def halt(self) -> None:
        self.leaves = True
        self._when([f"return {HALTED}"])

    def call(self, name: str, arguments: tuple[Operand, ...]) -> None:
        self.leaves = True
        callee = self.c.program.unit(name)
        enter = self.c.enter_lines(callee, arguments)
        leave = self.c.exit_lines(callee, arguments, self.unit)
        lines = [
            *enter,
            f"left = {self.c.unit_names[name.upper()]}()",
            *leave,
            *([f"if {self.c.fault_flag}: executed()"] if self.c.can_fault else []),
        ]
        guarded = self.c.guard_faults(lines, arguments)
        if guarded is not lines:
            guarded = ["left = 0", *guarded]  # the call itself may have failed
        self._when([*guarded, "if left == 2: return 2"])


class _FlatRung(_Rung):
    """The verbs where a unit is written flat: structures and jumps are changes of the segment."""

    def __init__(self, flat: "_FlatUnit"):
        super().__init__(flat.c, flat.unit)
        self.flat = flat

    def jump(self, number: int) -> None:
        target, here = self.flat.labels[number], self.instruction.position
        back = target <= here
        cost = self.c.way(self.unit, target, here)
        self._when([*([f"spend({cost})"] if back else []), f"return @label_{number}@"])

    def leave(self) -> None:
        self._when([f"return -{LEFT}"])

    def halt(self) -> None:
        self._when([f"return -{HALTED}"])

    def call(self, name: str, arguments: tuple[Operand, ...]) -> None:
        mark = len(self.lines)
        super().call(name, arguments)
        self.lines[mark:] = [line.replace("if left == 2: return 2", "if left == 2: return -2") for line in self.lines[mark:]]


class _FlatUnit:
    """A unit with jumps: segments that return the number of the next one, or -1 at the end, -2 to stop the PLC."""

    def __init__(self, compiler: Compiler):
        self.c, self.unit = compiler, compiler.unit
        self.segments: list[list[str]] = [[]]
        self.marks: dict[str, int] = {}
        self.labels = {i.operands[0].value: i.position for i in self.unit.instructions if i.mnemonic == "LBL"}
        self.count = 0

    def write(self) -> None:
        self._nodes(self.unit.nodes)
        last = len(self.segments) - 1
        name = self.c.unit_names[self.unit.name.upper()]
        for place, lines in enumerate(self.segments):
            lines.append(f"return {place + 1 if place < last else -1}")
            text = re.sub(r"@(\w+)@", lambda match: str(self.marks[match[1]]), "\n".join(lines))
            self.c.function(f"{name}_{place}", text.split("\n"))
        parts = ", ".join(f"{name}_{place}" for place in range(last + 1))
        self.c.out.append(f"{name}_parts = ({parts},)")
        self.c.function(
            name,
            ["place = 0", "while place >= 0:", f"{INDENT}place = {name}_parts[place]()", f"return {HALTED} if place == -{HALTED} else 0"],
        )

    def _mark(self, name: str) -> None:
        """A new segment begins here, under a name that `@name@` stands for."""
        self.segments.append([])
        self.marks[name] = len(self.segments) - 1
        self.count = 0

    def _nodes(self, nodes: list) -> None:
        opened = None
        for node in nodes:
            if isinstance(node, Network):
                opened = self._network(node)
            else:
                self._region(node, opened)

    def _network(self, network: Network) -> _FlatRung:
        instructions = self.unit.instructions[network.start : network.end]
        if instructions[0].mnemonic == "LBL":
            self._mark(f"label_{instructions[0].operands[0].value}")
        elif self.count > CHUNK:
            self._mark(f"chunk_{network.number}")
        rung = _FlatRung(self)
        rung.write(instructions)
        self.segments[-1] += rung.lines
        self.count += len(instructions)
        return rung

    def _region(self, region: Region, rung: _FlatRung) -> None:
        c, end = self.c, f"end_{region.opening}"
        lines = self.segments[-1]
        if region.kind == "MC":
            lines += [f"if not ({rung.opened}):", *indented([*c.clear_lines(self.unit, region), f"return @{end}@"])]
        elif region.kind == "STL":
            active = " and ".join(f"S[{step.number}]" for step in region.steps)
            clear = [f"if E[{region.slot}]:", *indented([f"E[{region.slot}] = False", *c.clear_lines(self.unit, region)])]
            lines += [f"if not ({active}):", *indented([*clear, f"return @{end}@"]), f"E[{region.slot}] = True"]
        else:
            cost = self.unit.length(region.opening + 1, region.closing + 1)
            loop = f"LOOPS[{c.new_loop()}]"
            lines += [f"{loop} = {rung.opened}", f"if {loop} <= 0: return @{end}@"]
            self._mark(f"body_{region.opening}")
            self.segments[-1].append(f"spend({cost})")
        with c.inside(region):
            self._nodes(region.nodes)
        if region.kind == "FOR":
            self.segments[-1] += [f"{loop} -= 1", f"if {loop} > 0: return @body_{region.opening}@"]
        self._mark(end)


class CompiledEngine:
    """Runs a program as generated Python; `bind` again when the memory's lists have been replaced."""

    filename = ""

    def __init__(self, program: Program, memory: Memory, services: dict[str, object]):
        self.program, self.memory, self.services = program, memory, services
        self.filename = f"<ecsim {program.model.name} {id(self):x}>"
        self.forwarding: bool | None = None
        self.bind()

    def _compile(self, forwarding: bool) -> None:
        """Generate the code; `forwarding` where a value that was written to a register is the one that is read there."""
        compiler = Compiler(self.program, forwarding)
        self.forwarding = forwarding
        self.source = compiler.source()
        self.code = compile(self.source, self.filename, "exec")
        self.globals = compiler.globals
        self.names = compiler.unit_names
        # The text is kept for tracebacks, and given up with the engine.
        linecache.cache[self.filename] = (len(self.source), None, self.source.splitlines(keepends=True), self.filename)

    def __del__(self):
        linecache.cache.pop(self.filename, None)

    def bind(self) -> None:
        """Tie the code to the memory's present lists."""
        forwarding = not self.memory.forces_words
        if forwarding is not self.forwarding:
            self._compile(forwarding)
        namespace = {**self.services, **self.globals, **self.memory.lists}
        exec(self.code, namespace)  # the code holds numbers and names of ours only: see Compiler
        self.generation = self.memory.generation
        self.units = {name: namespace[function] for name, function in self.names.items()}
        self.main = self.units[self.program.main.name.upper()]

    def scan(self) -> bool:
        """Execute the main program once; true when it stopped the PLC."""
        return self.main() == HALTED

    def run(self, unit: str) -> bool:
        """Execute another unit once (an interrupt program)."""
        return self.units[unit.upper()]() == HALTED

    def line_in(self, code: CodeType, generated: int) -> int:
        """The student's line that a line of generated code came from, 0 for code of others."""
        if code.co_filename != self.filename:
            return 0
        for text in reversed(self.source.split("\n")[:generated]):
            if text.strip().startswith("# line "):
                return int(text.strip()[7:])
        return 0
