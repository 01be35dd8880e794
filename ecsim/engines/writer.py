"""What both engines write for one instruction; how instructions follow one another is each engine's own.

An `emitted` instruction of TABLE speaks to its writer in these verbs:

    assign(d)  turn(d, on)  transfer(step)          coils and steps
    combine("and"|"or")  push()  read()  pop()      blocks and branches of a rung
    guard()  step()  repeat(count)  close()         structures: MC, STL, FOR and their ends
    label(n)  jump(n)  leave()  halt()  call(name, arguments)
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager

from ..assembler.program import Instruction, Network, Program, Region, Unit, Variable
from ..devices import Bits, Constant, Device, Operand
from ..errors import OPERAND
from ..instructions.define import Definition
from ..instructions.signature import OperandSpec
from ..values import BOOL, DINT, INT, REAL, REAL_LIMIT, DataType, join, singles, words_from_real
from .access import ROUNDED, Access
from .known import Known
from .template import Template, template

INDENT = "    "


def indented(lines: list[str]) -> list[str]:
    """The lines one level deeper."""
    return [INDENT + line for line in lines]


def regions(nodes: list[Network | Region]) -> Iterator[Region]:
    """Every region below some nodes, outer ones first."""
    for node in nodes:
        if isinstance(node, Region):
            yield node
            yield from regions(node.nodes)


class Writer:
    """Source for single instructions of one program."""

    def __init__(self, program: Program, forwarding: bool = False):
        self.program, self.model = program, program.model
        self.access = Access(self.model)
        self.known = Known(forwarding)
        self.telling = True
        self.globals: dict[str, object] = {}
        self.can_fault = any(self._may_fault(i) for i in program.instructions)
        self.fault_flag = "{}[{}]".format(*self.model.flag("fault"))
        self.unit: Unit = program.main
        self.region: Region | None = None  # the step (STL) that is being written
        self.instruction: Instruction | None = None

    # -- what can go wrong --------------------------------------------------------------------------------------

    def _may_fault(self, instruction: Instruction) -> bool:
        definition = instruction.definition
        if definition.faults or any(self.access.can_fault(operand) for operand in instruction.operands):
            return True
        pairs = zip(definition.operands, instruction.operands, strict=False)  # a CALL has the operands of its subroutine
        if any(self._checked(spec, operand) for spec, operand in pairs):
            return True
        if definition.form not in ("value", "command"):
            return False
        called = definition.form == "value" and template(definition.function, "value").text is None
        return called or any(spec.span for spec in definition.operands)

    @staticmethod
    def _checked(spec: OperandSpec, operand: Operand) -> bool:
        """Whether the operand's value is held against its range when the instruction is executed."""
        return spec.range is not None and spec.plain and spec.read and not isinstance(operand, Constant)

    def guarded(self, instruction: Instruction, lines: list[str], after: tuple[str, ...] = ()) -> list[str]:
        """The lines of an application instruction with what an execution error does, and what a correct execution does.

        `after` is done behind an execution error besides.
        """
        application = instruction.definition.application
        if self.can_fault and application and not self.known.settled:
            lines = [*lines, f"if {self.fault_flag}: executed()"]
            self.known.settled = self.known.on
        if self._may_fault(instruction):
            lines = ["try:", *indented(lines), "except Fault as error:", *indented(["fault(error.code)", *after])]
        return lines

    @staticmethod
    def at_rise(instruction: Instruction, flow: str, lines: list[str]) -> list[str]:
        """Lines executed only in the scan in which the flow rises."""
        was = f"E[{instruction.pulse}]"
        return [f"if not ({flow}):", f"{INDENT}{was} = False", f"elif not {was}:", *indented([f"{was} = True", *lines])]

    # -- operands -----------------------------------------------------------------------------------------------

    @staticmethod
    def _simple(text: str) -> bool:
        return text.count("[") <= 1 and " " not in text

    def _loads(self, instruction: Instruction, pattern: Template, flow: str) -> tuple[list[str], dict[str, str]]:
        """Statements that fetch what stands more than once and hold values against their ranges, and a field for each parameter."""
        lines, fields = [], {}
        definition = instruction.definition
        operands = {spec.name: (spec, operand) for spec, operand in zip(definition.operands, instruction.operands, strict=True)}
        for name, word in zip(self._parameters(instruction), definition.taken, strict=True):
            if word.upper() in operands and word.islower():
                fields[name] = f"({self.access.place(operands[word.upper()][1])})"
                continue
            if word not in operands:
                fields[name] = self._special(instruction, word, flow)
                continue
            spec, operand = operands[word]
            kind = spec.type.stored if definition.as_stored else spec.type
            if spec.span is None and spec.plain and definition.form != "contact" and Known.pair(kind, operand):
                text = self._pair(kind, operand, lines)
            else:
                text = self._load(instruction, spec, operand)
            checked = self._checked(spec, operand)
            if not text.isidentifier() and (checked or (pattern.uses.get(name, 1) > 1 and not self._simple(text))):
                lines.append(f"a_{name} = {text}")
                text = f"a_{name}"
            if checked:
                lines.append(self._range_check(spec, text, flow if definition.after else ""))
            fields[name] = text
        return lines, fields

    def _pair(self, kind: DataType, device: Device, lines: list[str]) -> str:
        """The name of a register pair's value, with the statements that fetch it if it is not known."""
        name = self.known.find(kind, device)
        if name is None:
            name = self.known.new()
            lines += [f"{name} = {ROUNDED}"] if kind is REAL and self.known.in_scratch(device) else self.access.fetch(kind, device, name)
            self.known.read(kind, device)
            self.known.keep(kind, device, name)
        return name

    def _special(self, instruction: Instruction, word: str, flow: str) -> str:
        """What a function gets that is no operand."""
        known = {
            "flow": flow,
            "machine": "machine",
            "now": "CLOCK[0]",
            "scan": "machine.scans",
            "state": f"E[{instruction.slot}]",
            "claim": str(instruction.slot),
        }
        return known.get(word) or "{}[{}]".format(*self.model.flag(word))

    @staticmethod
    def _range_check(spec: OperandSpec, text: str, flow: str) -> str:
        """The statement that makes a value outside its range error 64; a command that is called without flow takes any value."""
        low, high = spec.range
        above = f" <= {high}" if high < spec.type.high else ""
        test = f"{low} <= {text}{above}" if low > spec.type.low else f"{text}{above}"
        return f"if {f'{flow} and ' if flow else ''}not {test}: raise Fault({OPERAND})"

    def _load(self, instruction: Instruction, spec: OperandSpec, operand: Operand) -> str:
        if spec.unit:
            return self._hardware(spec, operand)
        kind = spec.type
        if instruction.definition.as_stored:
            kind = kind.stored
            if spec.type is REAL and isinstance(operand, Constant):
                operand = Constant(join(*words_from_real(float(operand.value))), operand.text)
        if spec.span is None:
            return self.access.load(kind, operand)
        return self.access.load_span(kind, operand, self._count(instruction, spec))

    def _hardware(self, spec: OperandSpec, operand: Operand) -> str:
        """What a command gets of a device that it works on: the device itself, or the number of a counter, pulse output or table."""
        if spec.kind == "BLOCK" and not (isinstance(operand, Device) and operand.area == "D"):
            return self.access.load(spec.type, operand)
        if spec.kind not in ("POINT", "PLACE", "FRAME", "DPLACE"):
            return self.access.index(operand) if operand.index is not None else str(operand.number)
        name = f"place_{len(self.globals)}"
        self.globals[name] = operand
        own = spec.type.words if operand.area not in ("T", "C") else 1
        length = spec.span if isinstance(spec.span, int) else own or 1  # a length that is an operand is the function's to check
        offset = "0" if operand.index is None else f"{operand.index_area}[{operand.index}]"
        fits = isinstance(operand, Bits) or operand.number + length <= self.model.areas[operand.area].count
        return name if operand.index is None and fits else f"placed({name}, {offset}, {length})"

    def _count(self, instruction: Instruction, spec: OperandSpec) -> str:
        """The length of a span as an expression."""
        pairs = list(zip(instruction.definition.operands, instruction.operands, strict=True))
        loads = {other.name: self.access.load(other.type, operand) for other, operand in pairs if other.span is None and other.plain}
        loads |= {other.name.lower(): f"({self.access.place(operand)})" for other, operand in pairs if isinstance(operand, (Device, Bits))}

        def known(match: re.Match) -> str:
            word = match[0]
            return loads.get(word) or ("{}[{}]".format(*self.model.flag(word)) if word in self.model.relays else word)

        return re.sub(r"[A-Za-z]\w*", known, str(spec.span).strip("{}"))

    def _function(self, instruction: Instruction) -> str:
        function = instruction.definition.function
        name = f"{function.__module__.rpartition('.')[2]}_{function.__name__}"
        while self.globals.setdefault(name, function) is not function:  # functions made in a loop share their name
            name += "_"
        return name

    @staticmethod
    def _parameters(instruction: Instruction) -> list[str]:
        code = instruction.definition.function.__code__
        return list(code.co_varnames[: code.co_argcount])

    # -- contacts -----------------------------------------------------------------------------------------------

    def contact(self, instruction: Instruction) -> tuple[list[str], str]:
        """Statements to run first, and the expression that is true while the contact is closed."""
        pattern = template(instruction.definition.function, "contact")
        lines, text = [], self._relation(instruction, pattern)
        if text is None:
            lines, fields = self._loads(instruction, pattern, "")
            self.globals.update(pattern.globals)
            text = pattern.fill(fields)
        if instruction.definition.given:  # what it keeps, besides whether it is closed
            name = f"c{instruction.position}"
            return [*lines, f"{name}, E[{instruction.slot}] = {text.strip('()')}"], name
        if not (self.can_fault and instruction.definition.application):
            return lines, text
        name = f"c{instruction.position}"
        body = [*lines, f"{name} = {text}", f"if {self.fault_flag}: executed()"]
        if self._may_fault(instruction):
            body = ["try:", *indented(body), "except Fault as error:", f"{INDENT}{name} = fault(error.code)"]
        return body, name

    def _relation(self, instruction: Instruction, pattern: Template) -> str | None:
        """The expression for a comparison of two 32-bit operands, where there is one that does without their values."""
        if pattern.relation is None or instruction.definition.operands[0].type.words < 2:
            return None
        first, second = instruction.operands
        return self.access.compare(instruction.definition.operands[0].type, first, pattern.relation, second)

    # -- values -------------------------------------------------------------------------------------------------

    def value(self, instruction: Instruction, flow: str = "True", telling: bool = True) -> list[str]:
        """The statements of an instruction that gives values; `flow` is the flow for one that is told of it.

        Not `telling`, they leave the flags that the result tells to the instruction that follows.
        """
        self.telling = telling
        lines = self._value(instruction, flow)
        if instruction.definition.form == "command" or self._may_fault(instruction):
            self.known.forget()
        return lines

    def overridden(self, instruction: Instruction, following: list[Instruction]) -> bool:
        """Whether the flags of a result are all set again by an instruction of the same flow before anything looks at them."""
        flags = set(instruction.definition.flags)
        if not flags or instruction.definition.given or instruction.pulse >= 0:
            return False
        special = {self.model.special_bits, self.model.special_words}
        for later in following:
            definition = later.definition
            looks = set(definition.taken) & self.model.relays.keys() or any(getattr(o, "area", "") in special for o in later.operands)
            if definition.form != "value" or definition.told or looks or any(spec.span for spec in definition.operands) or later.pulse >= 0:
                return False
            if flags <= set(definition.flags) - set(definition.given) and not self._may_fault(later):
                return True
        return False

    def _value(self, instruction: Instruction, flow: str) -> list[str]:
        definition = instruction.definition
        if definition.claims:
            return self._claimed(instruction, flow)
        after = (f"if not {flow}: E[{instruction.slot}] = False",) if definition.after else ()
        lines = self.guarded(instruction, self.result_lines(instruction, flow), after)
        return [f"if {flow} or E[{instruction.slot}]:", *indented(lines)] if definition.after else lines

    def _claimed(self, instruction: Instruction, flow: str) -> list[str]:
        """The statements of a command that holds something while its flow is ON, and gives it back afterwards."""
        held = f"E[{instruction.slot}]"
        work = [f"{held} = True", *self.guarded(instruction, self.result_lines(instruction, flow))]
        return [f"if {flow}:", *indented(work), f"elif {held}:", *indented(self._release(instruction))]

    @staticmethod
    def _release(instruction: Instruction) -> list[str]:
        return [f"E[{instruction.slot}] = False", f"release({instruction.slot})"]

    def result_lines(self, instruction: Instruction, flow: str) -> list[str]:
        """Load, compute, store, without what an execution error does."""
        definition = instruction.definition
        pattern = template(definition.function, "value")
        if pattern.passes and definition.as_stored and all(map(self._is_pair, definition.operands, instruction.operands)):
            return self._copy(*instruction.operands)
        lines, fields = self._loads(instruction, pattern, flow)
        if pattern.text is None or definition.form == "command":
            result = f"{self._function(instruction)}({', '.join(fields.values())})"
        else:
            self.globals.update(pattern.globals)
            result = pattern.fill(fields)
        pairs = zip(definition.operands, instruction.operands, strict=True)
        targets = [(spec, operand) for spec, operand in pairs if spec.written and not spec.unit]
        if len(targets) == 1 and not definition.given:
            lines += self._one_result(instruction, *targets[0], result, pattern)
        else:
            values = [self.known.new() if self._is_pair(*target) else f"v{place}" for place, target in enumerate(targets)]
            names = values + [f"f_{word}" for word in definition.given]
            lines.append(f"{', '.join(names)}{',' if len(names) == 1 else ''} = {result}" if names else result)
            # What is read too can be reached; what is not goes first, so that an error leaves all destinations as they are.
            for name, (spec, operand) in sorted(zip(values, targets, strict=True), key=lambda stored: stored[1][0].read):
                stored = self._store_result(instruction, spec, operand, name)
                lines += self._where_given(name, operand, stored) if spec.maybe else stored
            lines += [f"{self._special(instruction, word, flow)} = f_{word}" for word in definition.given]
        if definition.after and "state" not in definition.given:
            lines.append(f"E[{instruction.slot}] = {flow}")
        return lines

    def _where_given(self, name: str, operand, stored: list[str]) -> list[str]:
        """The statements that store a result if there is one; in what only the system writes that is error 64."""
        fixed = operand.area == "X" or (operand.index is None and operand.number in self.model.read_only(operand.area))
        return [f"if {name} is not None:", *indented([f"raise Fault({OPERAND})"] if fixed else stored)]

    def _one_result(self, instruction: Instruction, spec: OperandSpec, operand, result: str, pattern: Template) -> list[str]:
        definition = instruction.definition
        if definition.as_stored and not definition.flags and not self._is_pair(spec, operand):
            return self._store_result(instruction, spec, operand, result)
        if pattern.passes and self._is_pair(spec, operand) and {each.type for each in definition.operands} == {INT, REAL}:
            name = self.known.new()
            self.known.spoil(operand, 2)
            self.known.keep(REAL, operand, name)
            self.globals["SINGLES"] = singles()
            return self.access.whole(operand, name, result)
        if spec.type is REAL and self._is_pair(spec, operand) and not self._flags(instruction, REAL, ""):
            return self._store_result(instruction, spec, operand, result)
        name = self.known.new() if self._is_pair(spec, operand) else "v"
        return [f"{name} = {result}", *self._store_result(instruction, spec, operand, name, self._fits(definition, spec.type, pattern))]

    @staticmethod
    def _fits(definition: Definition, kind: DataType, pattern: Template) -> bool:
        """Whether a result needs no wrapping: the operand itself, of a range that registers of `kind`'s width hold."""
        sources = [spec for spec in definition.operands if not spec.written]
        if not pattern.passes or len(sources) != 1:
            return False
        low, high = sources[0].range or (sources[0].type.low, sources[0].type.high)
        return kind.stored.low <= low and high <= kind.stored.high

    def _copy(self, source: Device, target: Device) -> list[str]:
        """A pair of registers moved as it stands."""
        names = {kind: self.known.find(kind, source) for kind in (DINT, REAL)}
        self.known.spoil(target, 2)
        for kind, name in names.items():
            if name is not None:
                self.known.keep(kind, target, name)
        return self.access.copy(source, target)

    @staticmethod
    def _is_pair(spec: OperandSpec, operand: Operand) -> bool:
        return spec.span is None and Known.pair(spec.type, operand)

    def _store_result(self, instruction: Instruction, spec: OperandSpec, operand, name: str, fits: bool = False) -> list[str]:
        as_stored = instruction.definition.as_stored
        kind = spec.type.stored if as_stored else spec.type
        self.known.spoil(operand, max(1, kind.words) if spec.span is None else None)
        if kind is BOOL or isinstance(operand, Bits):
            self.known.settled = False  # the bit of an execution error may be among them
        if spec.first and isinstance(operand, Bits):
            return self.access.store(kind, operand, f"{name}[0]")
        if spec.span is not None:
            if kind.words and kind is not REAL and not as_stored:
                name = f"wrapped{kind.bits}({name})"
            return self.access.store_span(kind, operand, name, instruction.definition.resets, self._count(instruction, spec))
        if kind is BOOL:
            return self.access.store(kind, operand, name)
        if kind is REAL:
            return self._store_real(instruction, operand, name)
        lines = self._flags(instruction, kind, name)
        if not (as_stored or fits):
            half, full = 1 << kind.bits - 1, (1 << kind.bits) - 1
            fitted = f"{name} = ({name} + {half} & {full}) - {half}"
            if instruction.definition.restarts:
                fitted = f"{name} -= {half} if {name} > 0 else {-half - 1}"
            if lines and lines[-1].startswith(INDENT):  # the flags have found the result to be too large already
                lines.append(INDENT + fitted)
                if instruction.definition.restarts:
                    lines.append(INDENT + lines[0])  # zero: the stored number
            else:
                lines.append(f"if not {-half} <= {name} <= {half - 1}: {fitted}")
        if Known.pair(kind, operand):
            self.known.keep(kind.stored, operand, name)
        return lines + self.access.store(kind, operand, name)

    def _store_real(self, instruction: Instruction, operand, name: str) -> list[str]:
        """A REAL is rounded when it is stored; flags tell about the single that is stored."""
        plain = Known.pair(REAL, operand)
        flags = self._flags(instruction, REAL, name)
        if plain:
            self.known.read(REAL, operand)
        if not flags:
            return self.access.store(REAL, operand, name)
        if plain:
            self.known.keep(REAL, operand, name)
        return [*self.access.round(name), *flags, *self.access.store(REAL, operand, ROUNDED if plain else name)]

    def _flags(self, instruction: Instruction, kind, name: str) -> list[str]:
        """What the exact result tells: zero, above the range (carry), below it (borrow)."""
        given = instruction.definition.given if self.telling else instruction.definition.flags
        flags = [flag for flag in instruction.definition.flags if flag not in given]
        relay = {flag: "{}[{}]".format(*self.model.flag(flag)) for flag in flags}
        lines = [f"{relay['zero']} = {name} == {0.0 if kind is REAL else 0}"] if "zero" in relay else []
        out = [
            (relay[flag], test) for flag, test in (("carry", f"{name} > {kind.high}"), ("borrow", f"{name} < {kind.low}")) if flag in relay
        ]
        if out and kind is not REAL:
            lines += [f"if {kind.low} <= {name} <= {kind.high}:", INDENT + " = ".join(target for target, _ in out) + " = False", "else:"]
            lines += [f"{INDENT}{target} = {test}" for target, test in out]
        elif "carry" in relay:
            lines += [f"if {-REAL_LIMIT} <= {name} <= {REAL_LIMIT}: {relay['carry']} = False", f"else: {relay['carry']} = True"]
        return lines

    # -- always and command ---------------------------------------------------------------------------------------

    def always_fields(self, instruction: Instruction) -> dict[str, str]:
        """The fields of an always instruction but for the flow."""
        fields: dict[str, str] = {}
        names = self._parameters(instruction)[1:]
        operands = iter(zip(instruction.definition.operands, instruction.operands, strict=True))
        for name in names:
            if name == "state":
                fields["state_was"] = f"E[{instruction.slot}]"
                continue
            spec, operand = next(operands)
            fields |= (
                self._unit_fields(name, spec, operand)
                if spec.kind in ("TIMER", "COUNTER", "DCOUNTER")
                else {name: self.access.load(spec.type, operand)}
            )
        return fields

    def _unit_fields(self, name: str, spec: OperandSpec, device: Device) -> dict[str, str]:
        number = device.number
        fields = {
            f"{name}_number": str(number),
            f"{name}_value": f"{device.area}[{number}]",
            f"{name}_contact": f"{device.area}B[{number}]",
        }
        if spec.kind == "TIMER":
            fields |= {f"{name}_due": f"DUE[{number}]", f"{name}_rest": f"REST[{number}]", f"{name}_now": "CLOCK[0]"}
            fields[f"{name}_base"] = str(self.model.timer_base_us(number))
        else:
            fields[f"{name}_down"] = f"{self.model.special_bits}[{self.model.relays['counter direction'] + number}]"
        return fields

    def always(self, instruction: Instruction, flow: str, result: str) -> tuple[list[str], bool]:
        """The statements of an always instruction that do not give a flow by an expression alone; whether they assign the flow `result`."""
        pattern = template(instruction.definition.function, "always")
        self.globals.update(pattern.globals)
        fields = self.always_fields(instruction)
        lines = []
        for name in [n for n in fields if pattern.uses.get(n, 0) > 1 and not self._simple(fields[n])]:
            lines.append(f"a_{name} = {fields[name]}")
            fields[name] = f"a_{name}"
        fields["flow"] = flow
        body = pattern.fill(fields)
        if pattern.returns:
            head, _, tail = body.rpartition("\n")
            body = f"{head}\n{result} = {tail.partition(' = ')[2]}"
        text = body.split("\n")
        if not self._fast(instruction):
            text = [re.sub(r"\bwatch\(.*", "pass", line) for line in text]
        if self._may_fault(instruction):
            text = ["try:", *indented(lines + text), "except Fault as error:", f"{INDENT}fault(error.code)"]
            lines = []
        return lines + text, pattern.returns

    def _fast(self, instruction: Instruction) -> bool:
        first, last = self.model.fast_timers
        return any(isinstance(o, Device) and o.area == "T" and first <= o.number <= last for o in instruction.operands[:1])

    # -- coils, steps, calls --------------------------------------------------------------------------------------

    @contextmanager
    def inside(self, region: Region) -> Iterator[None]:
        """While the inside of a region is written; a loop in a step belongs to the step."""
        outer = self.region
        if region.kind == "STL":
            self.region = region
        yield
        self.region = outer

    @property
    def in_step(self) -> bool:
        return self.region is not None

    def turn_lines(self, d: Device, on: bool) -> list[str]:
        """A bit set or reset."""
        lines = self.access.store(BOOL, d, "True") if on else self.access.reset(d)
        if on and d.area == "S" and self.model.overlap:
            lines += [f"ENDING.discard({d.number})"]
        return self._unless_held(lines) if self.in_step and d.area == "S" else lines

    def transfer_lines(self, target: Device) -> list[str]:
        """A step handed over: the steps that the transition stands in end, at once or with the scan, the target begins (5.3.2)."""
        sources = [step.number for step in self.region.steps]
        if self.model.overlap:
            return [f"hand_over({', '.join(map(str, (target.number, *sources)))})"]
        return self._unless_held([*(f"S[{number}] = False" for number in sources), f"S[{target.number}] = True"])

    def _unless_held(self, lines: list[str]) -> list[str]:
        """What a transition does, asked for in the scan in which it fires: nothing while transitions are held."""
        held = "HELD[0]"
        if "hold transitions" in self.model.relays:
            held = "({} or {}[{}])".format(held, *self.model.flag("hold transitions"))
        return [f"if not {held}:", *indented(lines)]

    def pulse_lines(self, instruction: Instruction, d: Device, flow: str, rising: bool) -> list[str]:
        """A coil that is ON in the scan in which the flow rises or falls."""
        was = f"E[{instruction.slot}]"
        edge = f"{flow} and not {was}" if rising else f"{was} and not {flow}"
        return [*self.access.store(BOOL, d, edge), f"{was} = {flow}"]

    def clear_lines(self, unit: Unit, region: Region) -> list[str]:
        """What is cleared when a region is left: the destinations of OUT, TON, TOF ... inside (5.2.1, 5.3.1), and claims."""
        blocks: dict[tuple[str, ...], None] = {}  # each once, in order
        for instruction in unit.instructions[region.opening + 1 : region.closing]:
            handed_on = instruction.definition.transition_steps and instruction.operands[0].area == "S"
            if (instruction.definition.cleared or instruction.definition.released) and not (region.kind == "STL" and handed_on):
                blocks |= dict.fromkeys(self._erasures(instruction))
        return [line for block in blocks for line in block]

    def _erasures(self, instruction: Instruction) -> list[tuple[str, ...]]:
        """The statements that clear each destination of one instruction."""
        definition = instruction.definition
        self.known.forget()
        if definition.assigns:  # the bit of a word: executed without flow; one that cannot be reached needs no clearing
            lines = self.result_lines(instruction, "False")
            if definition.after:  # a command that is not at work has nothing to end
                lines = [f"if E[{instruction.slot}]:", *indented(lines)]
                self.known.forget()
            return [("try:", *indented(lines), "except Fault:", f"{INDENT}pass") if self._may_fault(instruction) else (*lines,)]
        if definition.claims:
            gone = (f"if E[{instruction.slot}]:", *indented(self._release(instruction)))
            return [gone, *(self._unit_erasures(instruction) if definition.cleared else ())]
        written = [(spec, operand) for spec, operand in zip(definition.operands, instruction.operands, strict=True) if spec.written]
        if definition.form == "always":
            return [(*self.access.reset(device),) for spec, device in written if not spec.unit]  # an annunciator stays
        return [(*self.access.store(BOOL, device, "False"),) for _, device in written]

    def _unit_erasures(self, instruction: Instruction) -> Iterator[tuple[str, ...]]:
        """The statements that clear the destinations of a command: a counter with its contact, bits, registers."""
        for spec, operand in zip(instruction.definition.operands, instruction.operands, strict=True):
            if spec.written and spec.kind == "HCOUNTER":
                yield (*self.access.reset(operand),)
            elif spec.written and operand.index is None:
                zeros = "[False]" if spec.type is BOOL else "[0]"
                yield (*self.access.store_span(spec.type, operand, f"{zeros} * {spec.span or 1}", resets=True),)

    @staticmethod
    def way(unit: Unit, first: int, last: int) -> int:
        """The steps that a jump back makes a program go through once more, from its label's position to its own."""
        begin = unit.instructions[0].position
        return unit.length(first - begin, last - begin + 1)

    def enter_lines(self, callee: Unit, arguments: tuple[Operand, ...]) -> list[str]:
        """A call's beginning: the caller's LM and V put aside, the callee's cleared and loaded (3.1.12, 4.4.3)."""
        loads, stores = [], []
        for place, (variable, operand) in enumerate(zip(callee.parameters, arguments, strict=True)):
            if variable.role != "OUTPUT":
                loads.append(f"p{place} = {self.access.load(variable.type, operand)}")
                text = f"p{place}" if variable.type in (BOOL, REAL) else f"wrapped{variable.type.bits}([p{place}])[0]"
                stores += self.access.store(variable.type, variable.device, text)
        takes = f"SPENT[0] += {callee.length() * self.model.instruction_ns}"
        return [*loads, takes, f"FRAMES.append({self._frame})", *self._blank_locals(), *stores]

    @property
    def _frame(self) -> str:
        """All that belongs to the unit that is executed, as a tuple."""
        return f"({''.join(f'{area}[:], ' for area in self.model.local_areas)})"

    def _blank_locals(self) -> list[str]:
        areas = [self.model.areas[name] for name in self.model.local_areas]
        return [f"{area.name}[:] = [{'False' if area.kind == 'bit' else '0'}] * {area.count}" for area in areas]

    def exit_lines(self, callee: Unit, arguments: tuple[Operand, ...], caller: Unit) -> list[str]:
        """A call's end: results fetched, the caller's LM and V put back (cleared in the main program, 3.1.12), results stored."""
        lines, stores = [], []
        for place, (variable, operand) in enumerate(zip(callee.parameters, arguments, strict=True)):
            if variable.role in ("OUTPUT", "IN_OUT"):
                lines.append(f"p{place} = {self.access.load(self._signed(variable), variable.device)}")
                stores += self.access.store(variable.type, operand, f"p{place}")
        lines.append(f"{self._frame} = FRAMES.pop()")
        if caller.kind == "MAIN":
            lines += self._blank_locals()
        return lines + stores

    @staticmethod
    def _signed(variable: Variable):
        return variable.type if variable.type in (BOOL, REAL) else INT if variable.type.words == 1 else DINT

    def guard_faults(self, lines: list[str], operands: tuple[Operand, ...]) -> list[str]:
        """Lines with their execution errors caught, if their operands can make any."""
        if any(self.access.can_fault(operand) for operand in operands):
            return ["try:", *indented(lines), "except Fault as error:", f"{INDENT}fault(error.code)"]
        return lines

    @staticmethod
    def constant_value(operand: Operand) -> int | None:
        return operand.value if isinstance(operand, Constant) else None

    @staticmethod
    def targets(instruction: Instruction) -> list[tuple[OperandSpec, Device | Bits]]:
        """The operands that an instruction writes."""
        return [
            (spec, operand)
            for spec, operand in zip(instruction.definition.operands, instruction.operands, strict=True)
            if spec.written and isinstance(operand, (Device, Bits))
        ]
