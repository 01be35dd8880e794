"""The stepping engine: the same program one instruction at a time, recorded where that is wanted.

Each instruction is a small function of the flow; where the program can go another way (MC, STL, FOR, CJ, CALL, an end)
a block of them ends in a control, which tells the next block. The walk can be stopped after any instruction.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from types import CodeType

from ..assembler.program import Instruction, Network, Program, Region, Unit
from ..devices import Bits, Device, Operand, number_text
from ..instructions.signature import OperandSpec
from ..memory import Memory
from ..values import BOOL, INT, DataType
from .trace import Trace, Write
from .writer import Writer, indented

DONE, HALT = -1, -2


@dataclass(slots=True)
class Op:
    """One instruction that always goes on to the next: `run(flow)` gives the flow after it."""

    position: int
    run: Callable
    join: str = ""  # contacts: how `closed()` meets the flow
    nested: bool = False
    closed: Callable | None = None
    targets: tuple = ()


@dataclass(slots=True)
class Stage:
    """A run of instructions and the control behind them."""

    ops: list[Op] = field(default_factory=list)
    control: Callable | None = None
    position: int = -1  # of the control's instruction, -1 when it has none


class SteppingEngine:
    """Runs a program instruction by instruction; `trace` holds the last recorded scan."""

    def __init__(self, program: Program, memory: Memory, services: dict[str, object]):
        self.program, self.memory, self.services = program, memory, services
        self.length = len(program.instructions)
        self.trace = Trace.blank(self.length)
        self.recording = False
        self.filename = f"<ecsim {program.model.name} stepping {id(self):x}>"
        self.bind()

    def bind(self) -> None:
        """Tie the code to the memory's present lists."""
        self.generation = self.memory.generation
        self.stack: list = []
        self.kept: list = []
        self.returns: list[Callable] = []
        self.stages: list[Stage] = []
        self.bare: list[tuple[list[Callable], Callable]] = []  # of each stage what a walk without recording needs
        self.entries: dict[str, int] = {}
        self.lines: dict[str, int] = {}  # generated function -> the student's line
        _Builder(self).build()

    def begin_scan(self) -> None:
        """What is recorded from now on belongs to a new scan: interrupt programs before the main program, too."""
        self.trace = Trace.blank(self.length)

    def scan(self) -> bool:
        """Execute the main program once; true when it stopped the PLC."""
        return self.run(self.program.main.name)

    def line_in(self, code: CodeType, generated: int) -> int:
        """The student's line that a place in generated code came from, 0 for code of others."""
        return self.lines.get(code.co_name, 0) if code.co_filename == self.filename else 0

    def run(self, unit: str) -> bool:
        """Execute a unit once, recorded when `recording` is set."""
        if self.recording:
            flow, writes, order = self.trace.flow, self.trace.writes, self.trace.order
            for position in self.walk(unit):
                order.append((position, flow[position], len(writes)))
            self.keep_locals(unit)
            return self.halted
        return self._bare(self.entries[unit.upper()])

    def _bare(self, place: int) -> bool:
        del self.stack[:], self.kept[:], self.returns[:]
        stages = self.bare
        flow = True
        while place >= 0:
            runs, control = stages[place]
            for run in runs:
                flow = run(flow)
            place = control(flow)
        return place == HALT

    def walk(self, unit: str) -> Iterator[int]:
        """Execute a unit, yielding the position of each instruction after it was executed; `halted` tells how it ended."""
        del self.stack[:], self.kept[:], self.returns[:]
        self.halted = False
        place = self.entries[unit.upper()]
        flows, states = self.trace.flow, self.trace.closed
        flow = True
        while place >= 0:
            stage = self.stages[place]
            for op in stage.ops:
                if op.closed is not None:
                    closed = bool(op.closed())
                    states[op.position] = closed
                    if op.join == "LD":
                        if op.nested:
                            self.stack.append(flow)
                        flow = closed
                    else:
                        flow = (flow and closed) if op.join == "AND" else (flow or closed)
                elif op.targets:
                    before = self.values(op.targets)
                    flow = op.run(flow)
                    self.note(op.position, before)
                else:
                    flow = op.run(flow)
                flows[op.position] = bool(flow)
                yield op.position
            if stage.position >= 0:
                flows[stage.position] = bool(flow)
                yield stage.position
            place = stage.control(flow)
        self.halted = place == HALT

    def keep_locals(self, unit: str) -> None:
        """Record what the areas of a unit's own hold at its end."""
        lists = self.memory.lists
        self.trace.locals[unit] = {area: lists[area][:] for area in self.program.model.local_areas}

    def values(self, targets) -> list[tuple[str, str, int, int]]:
        """The present values of what an instruction may write, as (list, area, number, value)."""
        lists = self.memory.lists
        found = []
        for name, area, number, index, count in targets:
            if index is not None:
                number += lists[index[0]][index[1]]
            length = count if isinstance(count, int) else count()
            found += [(name, area, n, lists[name][n]) for n in range(number, number + length) if 0 <= n < len(lists[name])]
        return found

    def note(self, position: int, before) -> None:
        """Record what has changed since `values`, as written by the instruction at a position."""
        lists = self.memory.lists
        for name, area, number, old in before:
            new = lists[name][number]
            if new != old:
                suffix = ":BOOL" if name in ("TB", "CB") else ""
                self.trace.writes.append(Write(position, f"{area}{number_text(area, number)}{suffix}", int(old), int(new)))


class _Builder(Writer):
    """Writes the functions of one program and ties them into stages; the verbs of `Writer` for this engine."""

    def __init__(self, engine: SteppingEngine):
        super().__init__(engine.program)
        self.engine = engine
        self.text: list[str] = []
        self.wanted: list[Callable[[dict], None]] = []  # what to do once the functions exist
        self.turns: list = [None]  # the count of the loop whose FOR was written last
        self.names = 0
        self.open = False

    def build(self) -> None:
        engine = self.engine
        for unit in self.program.units:
            engine.entries[unit.name.upper()] = -1
        for unit in self.program.units:
            self._unit(unit)
        lists = self.engine.memory.lists
        namespace = {**engine.services, **self.globals, **lists, "STACK": engine.stack, "KEPT": engine.kept}
        exec(compile("\n".join(self.text), engine.filename, "exec"), namespace)  # numbers and names of ours only
        for give in self.wanted:
            give(namespace)
        engine.bare = [([op.run for op in stage.ops], stage.control) for stage in engine.stages]

    # -- stages -------------------------------------------------------------------------------------------------

    def _unit(self, unit: Unit) -> None:
        self.unit = unit
        self.labels: dict[int, int] = {}
        self._stage()
        self.engine.entries[unit.name.upper()] = len(self.engine.stages) - 1
        self._nodes(unit.nodes)
        self.stage.control = self._return

    def _return(self, flow) -> int:
        """The end of a unit: back to the caller, or the end of the scan."""
        return self.engine.returns.pop()(None) if self.engine.returns else DONE

    def _stage(self) -> int:
        self.stage = Stage()
        self.engine.stages.append(self.stage)
        return len(self.engine.stages) - 1

    def _control(self, control: Callable | None, position: int = -1) -> int:
        """End the stage with a control; the new stage's number."""
        stage = self.stage
        number = self._stage()
        stage.control = control or (lambda flow: number)
        stage.position = position
        return number

    def _nodes(self, nodes: list) -> None:
        for node in nodes:
            if isinstance(node, Network):
                self._rung(node)
            else:
                self._region(node)

    def _rung(self, network: Network) -> None:
        self.open = False
        instructions = self.unit.instructions[network.start : network.end]
        if instructions[0].definition.form != "contact" and not instructions[0].definition.bus:
            self.stage.ops.append(Op(instructions[0].position, lambda _: True))  # an inner bus is ON
        for instruction in instructions:
            self.instruction = instruction
            self._instruction(instruction)

    def _instruction(self, instruction: Instruction) -> None:
        definition = instruction.definition
        if definition.form == "contact":
            self._contact(instruction)
        elif definition.told:
            self._op([*self.value(instruction, "flow"), "return flow"])
        elif definition.form in ("value", "command"):
            self._when(self.value(instruction))
        elif definition.form == "always":
            self._always(instruction)
        else:
            self.done = False
            definition.function(self, *instruction.operands)
            if not self.done:
                self._op(["return flow"])

    def _op(self, lines: list[str]) -> Op:
        """One more instruction in this stage, as a function of the flow."""
        op = Op(self.instruction.position, None, targets=self._targets(self.instruction))
        self._define("flow", lines, lambda function: setattr(op, "run", function))
        self.stage.ops.append(op)
        self.done = True
        return op

    def _define(self, parameters: str, lines: list[str], give: Callable) -> None:
        name = f"op_{self.names}"
        self.names += 1
        self.text += [f"def {name}({parameters}):", *indented(lines)]
        self.engine.lines[name] = self.instruction.line
        self.wanted.append(lambda namespace: give(namespace[name]))

    def _when(self, lines: list[str]) -> None:
        held = ["if flow:", *indented(lines)] if self.instruction.pulse < 0 else self.at_rise(self.instruction, "flow", lines)
        self._op([*held, "return flow"])

    def _contact(self, instruction: Instruction) -> None:
        lines, text = super().contact(instruction)
        join = instruction.definition.join
        nested = join == "LD" and self.open
        if join == "LD":
            body = [*lines, *(["STACK.append(flow)"] if nested else []), f"return {text}"]
        else:
            body = (
                [*lines, f"return flow {join.lower()} {text}"]
                if "(" in text or " " not in text
                else [*lines, f"return flow {join.lower()} ({text})"]
            )
        op = self._op(body)
        op.join, op.nested = join, nested
        self._define("", [*lines, f"return {text}"], lambda function: setattr(op, "closed", function))
        self.open = True

    def _always(self, instruction: Instruction) -> None:
        from .template import template

        pattern = template(instruction.definition.function, "always")
        if pattern.expression:
            self._op([f"return {pattern.fill({'flow': 'flow'})}"])
            return
        lines, _ = self.always(instruction, "flow", "flow")
        self._op([*lines, "return flow"])

    def _targets(self, instruction: Instruction) -> tuple:
        """(list, area, first number, index register, length) of all that an instruction may change."""
        definition, found = instruction.definition, []
        for spec, operand in self.targets(instruction):
            count = self._length(instruction, spec, 4 * operand.digits if isinstance(operand, Bits) else max(1, spec.type.words))
            both = operand.area in ("T", "C") and (spec.kind in ("TIMER", "COUNTER", "DCOUNTER") or definition.resets)
            found += self._places(spec.type, operand, count, both)
        found += [(*(self.model.flag(flag)[:1] * 2), self.model.flag(flag)[1], None, 1) for flag in definition.flags]
        if self.in_step and definition.transition_steps and instruction.operands[0].area == "S" and definition.mnemonic != "RST":
            found += [("S", "S", step.number, None, 1) for step in self.region.steps]
        return tuple(found)

    def _places(self, kind: DataType, operand: Device | Bits, count: int | Callable[[], int], both: bool = False) -> list[tuple]:
        """The targets that one operand stands for; `both` value and contact of a timer or counter."""
        index = None if operand.index is None else (operand.index_area, operand.index)
        rest = (operand.area, operand.number, index, count)
        if isinstance(operand, Bits):
            return [(operand.area, *rest)]
        names = [operand.area] if both or kind is not BOOL else []
        return [(name, *rest) for name in (*names, *([self.access.bits(operand.area)] if both or kind is BOOL else []))]

    def _noted(self, made: dict[str, Callable], name: str, position: int, targets: tuple) -> Callable[[], None]:
        """A function of `made` that no instruction of its own executes; what it writes is recorded for the one at a position."""
        engine = self.engine

        def run() -> None:
            if engine.recording:
                before = engine.values(targets)
                made[name]()
                engine.note(position, before)
            else:
                made[name]()

        return run

    def _length(self, instruction: Instruction, spec: OperandSpec, unit: int) -> int | Callable[[], int]:
        """How many list elements an operand covers whose values take `unit` each."""
        if spec.span is None or isinstance(spec.span, int):
            return (spec.span or 1) * unit
        counts: list[Callable[[], int]] = []
        count = self._count(instruction, spec)
        self._define("", ["try:", *indented([f"return {count}"]), "except Fault:", *indented(["return 0"])], counts.append)
        return lambda: max(0, min(counts[0](), 8000)) * unit

    # -- verbs --------------------------------------------------------------------------------------------------

    def assign(self, d: Device) -> None:
        self._op([*self.access.store(BOOL, d, "flow"), "return flow"])

    def turn(self, d: Device, on: bool) -> None:
        self._when(self.turn_lines(d, on))

    def transfer(self, target: Device) -> None:
        self._when(self.transfer_lines(target))

    def combine(self, word: str) -> None:
        self._op(
            [
                f"return STACK.pop() {word} flow" if word == "or" else "first = STACK.pop()",
                *([] if word == "or" else ["return first and flow"]),
            ]
        )

    def push(self) -> None:
        self._op(["KEPT.append(flow)", "return flow"])
        self.open = True

    def read(self) -> None:
        self._op(["return KEPT[-1]"])

    def pop(self) -> None:
        self._op(["return KEPT.pop()"])

    def pulse(self, d: Device, rising: bool) -> None:
        self._op([*self.pulse_lines(self.instruction, d, "flow", rising), "return flow"])

    def guard(self, d: Device | None = None) -> None:
        if d is not None:
            self._op([*self.access.store(BOOL, d, "flow"), "return flow"])
        self.opening, self.done = self.instruction.position, True

    def step(self) -> None:
        self.opening, self.done = self.instruction.position, True

    def repeat(self, count: Operand, least: int = 0) -> None:
        self.opening, self.done = self.instruction.position, True
        self.turns: list = [None]
        turns = self.turns
        load = self.access.load(INT, count)
        self._define(
            "",
            [*self.guard_faults([f"return max({load}, {least})" if least else f"return {load}"], (count,)), "return 0"],
            lambda function: turns.__setitem__(0, function),
        )

    def close(self) -> None:
        pass

    def label(self, number: int) -> None:
        self.labels[number] = self._control(None)

    def jump(self, number: int) -> None:
        position, unit, labels = self.instruction.position, self.unit, self.labels
        spend = self.engine.services["spend"]
        back = next(i.position for i in unit.instructions if i.mnemonic == "LBL" and i.operands[0].value == number)
        cost = self.way(unit, back, position)

        def target() -> int:
            if back <= position:
                spend(cost)
            return labels[number]

        self._branch(target)

    def _branch(self, target: Callable[[], int]) -> None:
        """A control that goes to `target()` while the flow is ON, on to the next instruction otherwise."""
        stage, reaches = self.stage, self._reaching()
        after = self._control(None, self.instruction.position)
        stage.control = lambda flow: target() if reaches(flow) else after
        self.done = True

    def _reaching(self) -> Callable[[bool], bool]:
        """Whether a flow makes the instruction act that is being written: while it is ON, when it rises, or on the bus always."""
        if self.instruction.definition.bus:
            return lambda _: True
        if self.instruction.pulse < 0:
            return bool
        kept, slot = self.engine.memory.lists["E"], self.instruction.pulse

        def rises(flow) -> bool:
            was, kept[slot] = kept[slot], bool(flow)
            return flow and not was

        return rises

    def leave(self) -> None:
        self._branch(lambda: self._return(True))

    def halt(self) -> None:
        self._branch(self._halt)

    def _halt(self) -> int:
        """The calls in progress end, then the PLC stops."""
        while self.engine.returns:
            self.engine.returns.pop()(None)
        return HALT

    def call(self, name: str, arguments: tuple[Operand, ...]) -> None:
        callee, engine, stage, reaches = self.program.unit(name), self.engine, self.stage, self._reaching()
        after = self._control(None, self.instruction.position)
        flows: list = []
        made: dict[str, Callable] = {}
        enter = [*self.enter_lines(callee, arguments), "return True"]
        leave = [*self.exit_lines(callee, arguments, self.unit), *([f"if {self.fault_flag}: executed()"] if self.can_fault else [])]
        self._define("", [*self.guard_faults(enter, arguments), "return False"], lambda function: made.__setitem__("enter", function))
        self._define("", [*self.guard_faults(leave, arguments), "return"], lambda function: made.__setitem__("leave", function))

        results = [
            target
            for variable, operand in zip(callee.parameters, arguments, strict=True)
            if variable.role in ("OUTPUT", "IN_OUT")
            for target in self._places(
                variable.type, operand, 4 * operand.digits if isinstance(operand, Bits) else max(1, variable.type.words)
            )
        ]
        finish = self._noted(made, "leave", self.instruction.position, tuple(results))

        def back(_) -> int:
            if engine.recording:
                engine.keep_locals(callee.name)
            finish()
            return after

        def control(flow) -> int:
            flows.append(flow)
            if not reaches(flow) or not made["enter"]():
                return after
            engine.returns.append(back)
            return engine.entries[callee.name.upper()]

        stage.control = control
        resume = Op(self.instruction.position, lambda _: flows.pop())  # the rung goes on with the flow that called
        self.stage.ops.append(resume)
        self.done = True

    # -- regions ------------------------------------------------------------------------------------------------

    def _region(self, region: Region) -> None:
        opening, position = self.stage, self.unit.instructions[region.opening].position
        made: dict[str, Callable] = {}
        body = self._control(None, position)
        turns = self.turns
        with self.inside(region):
            self._nodes(region.nodes)
        closing = self.stage
        after = self._control(None)
        lists = self.engine.memory.lists
        if region.kind == "FOR":
            opening.control, closing.control = self._loop(region, turns, body, after)
            return
        clear = self.clear_lines(self.unit, region)
        self._define("", clear or ["pass"], lambda function: made.__setitem__("clear", function))
        cleared = [i for i in self.unit.instructions[region.opening + 1 : region.closing] if i.definition.cleared]
        erase = self._noted(made, "clear", position, tuple(target for i in cleared for target in self._targets(i)))
        if region.kind == "MC":

            def guard(flow) -> int:
                if flow:
                    return body
                erase()
                return after

            opening.control = guard
            return
        active, was, slot = lists["S"], lists["E"], region.slot
        first, *others = [step.number for step in region.steps]

        def enter(flow) -> int:
            if active[first] and all(active[number] for number in others):
                was[slot] = True
                return body
            if was[slot]:
                was[slot] = False
                erase()
            return after

        def enter_alone(flow) -> int:
            if active[first]:
                was[slot] = True
                return body
            if was[slot]:
                was[slot] = False
                erase()
            return after

        opening.control = enter if others else enter_alone

    def _loop(self, region: Region, turns: list, body: int, after: int):
        left = [0]
        spend = self.engine.services["spend"]
        cost = self.unit.length(region.opening + 1, region.closing + 1)

        def begin(flow) -> int:
            left[0] = turns[0]() if flow else 0
            if left[0] <= 0:
                return after
            spend(cost)
            return body

        def again(flow) -> int:
            left[0] -= 1
            if left[0] <= 0:
                return after
            spend(cost)
            return body

        return begin, again
