"""From text to a program: read, resolved, checked against TABLE and the model, all problems reported together."""

from collections.abc import Mapping
from dataclasses import replace
from difflib import get_close_matches

from ..devices import Bits, Constant, Device, Name, Operand
from ..errors import ProgramError
from ..instructions import TABLE, Definition
from ..instructions.signature import OperandSpec, parse_signature
from ..instructions.spelling import choices_of, instructions_of, pulse_forms_of, section_of
from ..models import Model, get_model
from ..values import BOOL, TYPES
from .hints import elsewhere
from .inputs import check_inputs
from .operands import Misplaced, Refused, Resolver
from .program import Instruction, Network, Program, Region, Unit, Variable
from .reader import RawUnit, RawVariable, Source, Statement, read, shown
from .structure import find_structure

# Words that other languages and families have for what is written otherwise here.
FOREIGN = {
    **dict.fromkeys(("END", "FEND"), "a program ends with its last line"),
    **{word: f"write {here}" for word, here in (("LDN", "LDI"), ("ANDN", "ANI"), ("ORN", "ORI"), ("AN", "ANI"), ("ON", "ORI"), ("ST", "OUT"))},
    **{word: f"write {here}" for word, here in (("S", "SET"), ("R", "RST"), ("RES", "RST"), ("JMP", "CJ"), ("NOT", "INV"), ("SRET", "CSRET"))},
    **{f"{join}P": f"write {join} and EU behind the contacts" for join in ("LD", "AND", "OR")},
    **{f"{join}F": f"write {join} and ED behind the contacts" for join in ("LD", "AND", "OR")},
    "PLF": "write ED before OUT",
    "CLOSED": "a password closes this unit, and what stands for its text is spoilt; upload it again",
}  # fmt: skip

_DEFINE = "define it between SUBROUTINE NAME and END_SUBROUTINE"

__all__ = ["Instruction", "Network", "Program", "Region", "Unit", "Variable", "assemble"]


def assemble(text: str | Mapping[str, str], model: str | Model, name: str = "") -> Program:
    """The program that a text, or files by name, spell for a model; raises ProgramError with every problem found.

    Messages name the file and its own line; for a text alone the file is `name`.
    """
    model = get_model(model)
    return _Assembler(read(text, name, model.syntax), model).program()


class _Assembler:
    def __init__(self, source: Source, model: Model):
        self.source, self.model = source, model
        source.section = model.section
        self.parameters: dict[tuple[str, str, str], OperandSpec] = {}  # of CALL, by role, type and name
        self.choices = choices_of(model)
        rising = pulse_forms_of(model)
        self.definitions = instructions_of(model) | rising
        self.at_rise = rising.keys()

    def program(self) -> Program:
        variables = self._globals()
        self.resolver = Resolver(self.model, variables)
        if not self.source.units:
            self.source.units.append(RawUnit("MAIN", "MAIN", 1))
        if self.source.units[0].kind != "MAIN":
            self.source.report(
                self.source.units[0].line, "there is no main program", "put it between PROGRAM MAIN and END_PROGRAM", "4.2.1"
            )
        self.units = [self._unit(raw) for raw in self.source.units]
        self._unit_names()
        slots = 0
        for unit, raw in zip(self.units, self.source.units, strict=True):
            for statement in raw.statements:
                instruction = self._instruction(statement, unit)
                if instruction is not None:
                    if statement.title:
                        unit.titles[len(unit.instructions)] = statement.title
                    unit.instructions.append(instruction)
        self._raise()  # structure is looked at only where every word was understood
        for unit in self.units:
            find_structure(unit, self.model, self._report_instruction, self.source.where)
        self._calls()
        check_inputs(self.units, self.model, self.source.report, self.source.where)
        self._count_instructions()
        position, step = 0, 0
        for unit in self.units:
            stepping = {i for region in _regions(unit.nodes) if region.kind == "STL" for i in range(region.opening, region.closing)}
            for index, instruction in enumerate(unit.instructions):
                instruction.position, instruction.step = position, step
                instruction.steps = self._steps(instruction, index in stepping)
                if instruction.definition.keeps:
                    instruction.slot, slots = slots, slots + 1
                if instruction.definition.rising or instruction.spelled in self.at_rise:
                    instruction.pulse, slots = slots, slots + 1
                position, step = position + 1, step + instruction.steps
            for region in _regions(unit.nodes):
                if region.kind == "STL":
                    region.slot, slots = slots, slots + 1
        if step > self.model.limits["steps"]:
            self.source.report(0, f"the program has {step} steps", f"{self.model.name} holds {self.model.limits['steps']}", "1.1")
        self._raise()
        return Program(self.model, self.source.text, self.units, variables, step, slots)

    def _raise(self) -> None:
        if self.source.problems:
            raise ProgramError(self.source.problems)

    # -- variables and units ------------------------------------------------------------------------------------

    def _globals(self) -> dict[str, Variable]:
        variables: dict[str, Variable] = {}
        folded: dict[str, str] = {}
        resolver = Resolver(self.model, {})
        for raw in self.source.globals:
            if not self._good_name(raw):
                continue
            if raw.name.casefold() in folded:
                self.source.report(raw.line, f"the name {raw.name} is declared twice", "names differ by more than case")
                continue
            try:
                device = resolver.resolve(raw.what, {})
                if isinstance(device, Device):
                    resolver._number(device.area, device.number, 1, raw.what)
            except Refused as refused:
                self.source.report(raw.line, refused.message, refused.hint, refused.section, word=2)
                continue
            if isinstance(device, Device) and device.area in self.model.local_areas:
                self.source.report(
                    raw.line,
                    f"{raw.name} names {device}, which belongs to one program unit only",
                    f"name another device; {' and '.join(self.model.local_areas)} are given to VAR_TEMP and the like",
                    "3.1.2",
                    word=2,
                )
                continue
            if not isinstance(device, Device) or device.index is not None:
                self.source.report(
                    raw.line,
                    f"{raw.name} names {shown(raw.what)}, which is no single device",
                    "name a device, for example X0 or D100",
                    word=2,
                )
                continue
            folded[raw.name.casefold()] = raw.name
            variables[raw.name] = Variable(raw.name, device, raw.comment, role="GLOBAL", line=raw.line)
        if len(variables) > self.model.limits["global variables"]:
            self.source.report(
                self.source.globals[0].line,
                f"{len(variables)} global variables",
                f"{self.model.name} has room for {self.model.limits['global variables']}",
                "2.2.3",
            )
        return variables

    def _good_name(self, raw: RawVariable, word: int = 0) -> bool:
        name = raw.name
        taken = ""
        if not name.isidentifier():
            taken = "a name is made of letters, digits and _ and does not begin with a digit"
        elif self._is_operand(name):
            taken = "it reads like a device or a number"
        elif name.upper() in self.definitions or name.upper() in TYPES:
            taken = f"it is the name of {'an instruction' if name.upper() in self.definitions else 'a data type'}"
        if taken:
            self.source.report(raw.line, f"{shown(name)} cannot be a variable's name", taken, "2.2.3", word=word)
        return not taken

    def _is_operand(self, name: str) -> bool:
        try:
            return self.model.syntax.parse(name) is not None
        except ValueError:
            return True

    def _unit(self, raw: RawUnit) -> Unit:
        event = None
        if raw.event is not None:
            if raw.event.isdigit() and raw.event.isascii() and len(raw.event) < 4:
                event = int(raw.event)
            else:
                self.source.report(
                    raw.line, f"EVENT {shown(raw.event)} is no event number", "chapter 9 numbers them from 0 to 37", "9.1", word=3
                )
        unit = Unit(raw.kind, raw.name, event, line=raw.line)
        room = dict.fromkeys(self.model.local_areas, 0)
        count = {"bit": 0, "word": 0}
        for declared in raw.variables:
            if not self._good_name(declared, declared.word):
                continue
            kind = TYPES.get(declared.what)
            if kind is None:
                self.source.report(
                    declared.line, f"{shown(declared.what)} is no data type", f"use {', '.join(TYPES)}", "4.4.3", word=declared.word + 2
                )
                continue
            if declared.name.casefold() in unit.variables:
                self.source.report(declared.line, f"the variable {shown(declared.name)} is declared twice", "", "4.4.3", word=declared.word)
                continue
            if raw.kind != "SUBROUTINE" and declared.role != "TEMP":
                self.source.report(declared.line, f"only a subroutine has {declared.role} variables", "", "4.4.3")
            if not self.model.local_areas:
                self.source.report(declared.line, f"{self.model.name} has no variables of subroutines", "use devices", "4.4.3", word=1)
                continue
            area = self.model.local_areas[kind is not BOOL]
            count["bit" if kind is BOOL else "word"] += 1
            unit.variables[declared.name.casefold()] = Variable(
                declared.name, Device(area, room[area]), declared.comment, kind, declared.role, declared.line
            )
            room[area] += max(1, kind.words)
        for what, number in count.items():
            if number > self.model.limits[f"{what} variables"]:
                self.source.report(
                    raw.line, f"{raw.name} has {number} {what} variables", f"at most {self.model.limits[f'{what} variables']}", "4.4.2"
                )
        return unit

    def _unit_names(self) -> None:
        seen: dict[str, Unit] = {}
        events: dict[int, Unit] = {}
        timers: dict[int, Unit] = {}  # by the relay that each timer has; one gives one period
        for unit in self.units:
            first = seen.setdefault(unit.name.upper(), unit)
            if first is not unit and self.model.syntax.pointers:  # it has been told where the label stands
                continue
            if first is not unit:
                self.source.report(
                    unit.line, f"the name {shown(unit.name)} stands twice", f"it stands in {self.source.where(first.line)} already", word=1
                )
            if unit.event is not None:
                other = events.setdefault(unit.event, unit)
                if other is not unit:
                    self.source.report(
                        unit.line,
                        f"the event {unit.event} has two interrupt programs",
                        f"{other.name} in {self.source.where(other.line)} serves it already",
                        "9.2",
                        word=3,
                    )
            if unit.event in self.model.timed_ms:
                other = timers.setdefault(self.model.events.get(unit.event, unit.event), unit)
                if other is not unit:
                    self.source.report(
                        unit.line,
                        f"{unit.name} and {other.name} belong to one timer",
                        f"{other.name} in {self.source.where(other.line)} has it already; take another timer's label",
                        "9.2",
                        word=0,
                    )
        count = sum(unit.kind == "SUBROUTINE" for unit in self.units)
        if count > self.model.limits["subroutines"]:
            self.source.report(self.units[-1].line, f"{count} subroutines", f"at most {self.model.limits['subroutines']}", "4.4.2")

    # -- instructions -------------------------------------------------------------------------------------------

    def _instruction(self, statement: Statement, unit: Unit) -> Instruction | None:
        definition = self._definition(statement, unit)
        if definition is None:
            self._unknown(statement)
            return None
        if definition.mnemonic == "CALL":
            operands = self._call_operands(definition, statement, unit)
        else:
            operands = self._operands(definition, statement, unit)
        if operands is None:
            return None
        spelled = statement.mnemonic if statement.mnemonic != definition.mnemonic else ""
        written = tuple(self._written(*pair) for pair in zip(statement.operands, operands, strict=True))
        return Instruction(definition.mnemonic, definition, operands, written, statement.line, statement.comment, spelled=spelled)

    def _written(self, word: str, operand) -> str:
        """An operand as it was written, but X000, as lists of the FX family have it, as X0."""
        longer = self.model.syntax.pointers and isinstance(operand, Device | Bits) and self._is_operand(word)
        return str(operand) if longer and word.upper() != str(operand) else word

    def _definition(self, statement: Statement, unit: Unit) -> Definition | None:
        """The row that a statement's name stands for, with its first operand where that decides."""
        meant = self._meant(statement.mnemonic, statement.operands, unit)
        return TABLE[meant[0]] if meant else self.definitions.get(statement.mnemonic)

    def _meant(self, name: str, words: tuple[str, ...], unit: Unit) -> tuple[str, ...]:
        """What a name may still stand for behind these operands, the usual first; nothing for one that stands for the same always."""
        choice = self.choices.get(name)
        return choice.behind(self._known(word, unit) for word in words) if choice else ()

    def _known(self, word: str, unit: Unit) -> Operand | None:
        """The operand that a word stands for, None for one that is told when the operands are held against the usual row."""
        try:
            return self.resolver.resolve(word, unit.variables)
        except Refused:
            return None

    def _unknown(self, statement: Statement) -> None:
        written = statement.mnemonic
        row = TABLE.get(written)
        if row is not None:
            here = self.model.spelled(written)
            hint = self.model.foreign.get(written) or (f"write {' or '.join(here)}" if here else elsewhere(written, self.model))
            self.source.report(statement.line, f"{self.model.name} has no {written}", hint, row.section)
            return
        close = get_close_matches(written[:12], self.definitions, 3, 0.6)
        known = self.model.foreign.get(written) or FOREIGN.get(written) or elsewhere(written, self.model)
        hint = known or (f"did you mean {' or '.join(close)}?" if close else "one instruction a line, for example LD X0")
        self.source.report(statement.line, f"{shown(written)} is no instruction", hint)

    def _operands(self, definition: Definition, statement: Statement, unit: Unit):
        specs, words = definition.operands, statement.operands
        section = section_of(self.model, statement.mnemonic, definition)
        if len(specs) != len(words):
            names = " ".join(spec.name for spec in specs)
            wanted = f"{statement.mnemonic} takes {len(specs)} operand{'s' if len(specs) != 1 else ''}" + (f" ({names})" if specs else "")
            self.source.report(
                statement.line,
                f"{wanted}, found {len(words)}",
                self._too_many(definition, words),
                section,
                word=min(len(words), len(specs) + 1),
            )
            return None
        operands = []
        for place, (spec, word) in enumerate(zip(specs, words, strict=True), 1):
            try:
                operands.append(self.resolver.operand(spec, word, unit.variables))
            except Refused as refused:
                hint = self._open(spec, statement, place, unit) if isinstance(refused, Misplaced) else refused.hint
                self.source.report(statement.line, refused.message, hint, refused.section or section, word=place)
        if len(operands) < len(specs) or not self._spans_fit(definition, operands, statement):
            return None
        if definition.check:
            given = tuple(operand.value if isinstance(operand, Constant) else operand for operand in operands)
            first = (self.model,) if definition.check.__code__.co_varnames[0] == "model" else ()
            wrong = definition.check(*first, *given)
            if wrong:
                self.source.report(statement.line, wrong, "", section)
                return None
        return tuple(operands)

    def _open(self, spec: OperandSpec, statement: Statement, place: int, unit: Unit) -> str:
        """What may stand there in any form that the operands before it leave open."""
        forms = [TABLE[key].operands for key in self._meant(statement.mnemonic, statement.operands[: place - 1], unit)]
        others = [form[place - 1] for form in forms if len(form) == len(statement.operands)]
        return self.resolver.may_be(spec, *others)

    def _spans_fit(self, definition: Definition, operands: list, statement: Statement) -> bool:
        """Whether no span whose length is known already reaches beyond the last device; others are held against it when they are executed."""
        values = None
        fits = True
        for place, (spec, operand) in enumerate(zip(definition.operands, operands, strict=True), 1):
            if spec.span is None or not isinstance(operand, Device | Bits):
                continue
            if values is None:
                pairs = zip(definition.operands, operands, strict=True)
                values = {s.name: o.value for s, o in pairs if isinstance(o, Constant) and isinstance(o.value, int)}
                pairs = zip(definition.operands, operands, strict=True)
                values |= {s.name.lower(): o.number for s, o in pairs if isinstance(o, Device) and o.index is None}
            try:
                self.resolver.span(spec, operand, spec.length(values), statement.operands[place - 1])
            except Refused as refused:
                self.source.report(statement.line, refused.message, refused.hint, refused.section, word=place)
                fits = False
        return fits

    def _too_many(self, definition: Definition, words: tuple[str, ...]) -> str:
        """What may have been meant by more words than an instruction takes."""
        if len(words) <= len(definition.operands):
            return ""
        for place, word in enumerate(words):
            compare = f"{definition.mnemonic}{word}"
            if compare in self.definitions and len(words) == 3:
                return f"a comparison is written {compare} {' '.join(words[:place] + words[place + 1 :])}"
        return "one instruction a line" if any(word.upper() in self.definitions for word in words) else ""

    def _call_operands(self, definition: Definition, statement: Statement, unit: Unit):
        words = statement.operands
        name = words[0] if words else ""
        callee = next((u for u in self.units if u.kind == "SUBROUTINE" and u.name.upper() == name.upper()), None)
        if callee is None:
            known = ", ".join(u.name for u in self.units if u.kind == "SUBROUTINE")
            define = "begin it with its label behind FEND, SRET ends it" if self.model.syntax.pointers else _DEFINE
            hint = f"there is {known}" if known else define
            message = f"there is no subroutine {shown(name)}" if name else "CALL names no subroutine"
            self.source.report(statement.line, message, hint, definition.section, word=min(len(words), 1))
            return None
        parameters = callee.parameters
        if len(parameters) != len(words) - 1:
            names = " ".join(variable.name for variable in parameters) or "none"
            self.source.report(
                statement.line,
                f"{callee.name} takes {len(parameters)} operand{'s' if len(parameters) != 1 else ''} ({names}), found {len(words) - 1}",
                "",
                definition.section,
            )
            return None
        operands: list = [Name(callee.name)]
        for place, (variable, word) in enumerate(zip(parameters, words[1:], strict=True), 2):
            try:
                operands.append(self.resolver.operand(self._parameter_spec(variable), word, unit.variables))
            except Refused as refused:
                self.source.report(statement.line, refused.message, refused.hint, refused.section or definition.section, word=place)
        return tuple(operands) if len(operands) == len(words) else None

    def _parameter_spec(self, variable: Variable) -> OperandSpec:
        """The operand table row that a subroutine's variable stands for at the call (table 3-3)."""
        key = (variable.role, variable.type.name, variable.name)
        if key not in self.parameters:
            kind = variable.type.name
            special = {"BOOL": "+SM", "REAL": ""}.get(kind, "+SD")
            text = {
                "INPUT": f"P:{kind}+const" if kind == "BOOL" else f"P:{kind}",
                "OUTPUT": f"-> P:{kind}{special}",
                "IN_OUT": f"P:{kind}{special} -> P",
            }[variable.role]
            self.parameters[key] = replace(parse_signature(text)[0][0], name=variable.name)
        return self.parameters[key]

    def _steps(self, instruction: Instruction, in_step: bool) -> int:
        definition, operands = instruction.definition, instruction.operands
        if definition.steps is None:
            return 3 + len(operands)
        steps = definition.steps
        if in_step and definition.transition_steps and operands[0].area == "S":
            steps = definition.transition_steps
        surcharge = self.model.step_surcharge
        if surcharge and definition.form == "contact" and definition.section.startswith("5.1"):
            device = operands[0]
            if device.area == surcharge[0] and device.number >= surcharge[1]:
                steps += 1
        return steps

    def _count_instructions(self) -> None:
        """Some kinds of instructions may stand only so often in a program."""
        found: dict[str, list[Instruction]] = {}
        for unit in self.units:
            for instruction in unit.instructions:
                if instruction.definition.counted:
                    found.setdefault(instruction.definition.counted, []).append(instruction)
        for what, instructions in found.items():
            limit = self.model.limits[what]
            if len(instructions) > limit:
                kinds = " and ".join(mnemonic for mnemonic, row in self.definitions.items() if row.counted == what)
                self._report_instruction(instructions[limit], f"{kinds} stand {len(instructions)} times", f"at most {limit} times together")

    def _report_instruction(self, instruction: Instruction, message: str, hint: str = "", section: str = "") -> None:
        self.source.report(instruction.line, message, hint, section)

    # -- calls --------------------------------------------------------------------------------------------------

    def _calls(self) -> None:
        calls = {unit.name.upper(): [i for i in unit.instructions if i.mnemonic == "CALL"] for unit in self.units}
        limit = self.model.limits["CALL nesting"]
        depth: dict[str, int] = {}

        def deepest(name: str, path: tuple[str, ...]) -> int:
            if name in depth:
                return depth[name]
            best = 0
            for instruction in calls[name]:
                callee = instruction.operands[0].text.upper()
                if callee in path:
                    self._report_instruction(
                        instruction,
                        f"{instruction.operands[0]} calls itself, directly or through others",
                        "subroutines cannot recur",
                        "4.4.2",
                    )
                    continue
                best = max(best, 1 + deepest(callee, (*path, callee)))
            depth[name] = best
            return best

        for unit in self.units:
            if unit.kind == "MAIN" and deepest(unit.name.upper(), (unit.name.upper(),)) > limit:
                self._report_instruction(
                    calls[unit.name.upper()][0], f"calls are nested {depth[unit.name.upper()]} deep", f"at most {limit}", "4.4.2"
                )
            deepest(unit.name.upper(), (unit.name.upper(),))


def _regions(nodes):
    waiting = list(reversed(nodes))  # not by recursion: a wrong program may nest structures without end
    while waiting:
        node = waiting.pop()
        if isinstance(node, Region):
            yield node
            waiting.extend(reversed(node.nodes))
