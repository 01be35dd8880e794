"""The structure of a unit: its rungs and regions, and the rules of chapters 5, 6.1 and 7 about them."""

from ..models import Model
from .program import Instruction, Network, Region, Unit

_LEAVES = {
    "CFEND": ("MAIN", "the main program", "6.1.5"),
    "FX:CJ END": ("MAIN", "the main program", "6.1.4"),
    "CSRET": ("SUBROUTINE", "a subroutine", "6.1.12"),
    "CIRET": ("INTERRUPT", "an interrupt program", "6.1.9"),
}
_PARTS = frozenset({"FX:FEND", "FX:END", "FX:SRET", "FX:IRET"})  # what ends a unit, or a part of it
_CLOSERS = {"MCR": "MC", "FX:MCR": "MC", "NEXT": "FOR", "RET": "STL"}
_OPENS = {"MC": "MC", "FX:MC": "MC", "FOR": "FOR", "FX:FOR": "FOR"}
_ENDS = {"MC": "MCR", "FOR": "NEXT", "STL": "RET"}
_BLOCKS = frozenset({"ANB", "ORB", "MPS", "MRD", "MPP"})


def find_structure(unit: Unit, model: Model, report, where) -> None:
    """Fill `unit.networks` and `unit.nodes`; `report(instruction, message, hint, section)` gets every broken rule, `where(line)` names a line."""
    _Structure(unit, model, report, where).walk()


class _Structure:
    def __init__(self, unit: Unit, model: Model, report, where):
        self.unit, self.model, self.limits, self.report, self.where = unit, model, model.limits, report, where
        self.regions: list[Region] = []
        self.nodes: list[list] = [unit.nodes]
        self.start = 0
        self.blocks = 0  # blocks begun by LD and not yet joined
        self.alone = False  # the newest block may still take a parallel contact
        self.kept: list[int] = []  # MPS: blocks open at each
        self.used = False  # the flow has reached an output
        self.bus = False  # a flow from the inner bus of a step or MC, without a contact
        self.forked = False  # the flow has been used or kept: the rung's first block is closed
        self.branched = False  # a contact stands behind the fork
        self.labels: dict[int, tuple[Instruction, tuple]] = {}
        self.jumps: list[tuple[Instruction, int, tuple]] = []
        self.steps: dict[int, Instruction] = {}

    # -- rungs ------------------------------------------------------------------------------------------------

    def walk(self) -> None:
        for index, instruction in enumerate(self.unit.instructions):
            definition = instruction.definition
            if definition.bus:
                self._finish(index)
                self._bus_instruction(index, instruction)
            elif definition.form == "contact":
                self._contact(index, instruction)
            else:
                self._rung_instruction(index, instruction)
        end = len(self.unit.instructions)
        self._finish(end)
        for region in reversed(self.regions):
            opening = self.unit.instructions[region.opening]
            closer = _ENDS[region.kind]
            self.report(
                opening,
                f"{opening} has no {closer}",
                f"close it with {closer}{f' {opening.operands[0]}' if region.kind == 'MC' else ''}",
                "7.2.3" if region.kind == "STL" else "5.2.1" if region.kind == "MC" else "6.1.1",
            )
            region.closing = end
        self._check_jumps()
        self._check_flows()
        if self.unit.kind == "MAIN":
            _Transitions(self.unit, self.steps, self.model, self.report, self.where).check()

    def _contact(self, index: int, instruction: Instruction) -> None:
        join = instruction.definition.join
        if join == "LD":
            if self.used or (self.blocks == 0 and not self.kept):
                self._finish(index)
            self.blocks += 1
            self.alone = True
            self.bus = False
            self.branched = self.branched or self.forked
            return
        if not self._flow(instruction):
            return
        if join == "OR" and not self.alone:
            self.report(
                instruction,
                f"{instruction} has no block to stand parallel to",
                "a parallel contact follows the contacts that it bridges, before any output or MPS",
                "5.1.5",
            )
        if self.bus:
            self.report(instruction, f"{instruction} has no LD before it", "begin the contacts of a rung with LD", "5.1.1")
            self.bus = False
        self.used = False
        self.branched = self.branched or self.forked

    def _level(self) -> int:
        """How many blocks belong to what stood before the newest fork."""
        return self.kept[-1] if self.kept else int(self.forked)

    def _flow(self, instruction: Instruction) -> bool:
        """Whether a power flow reaches the instruction; a missing one is reported once and then assumed."""
        if self.blocks or self.kept or self.bus:
            return True
        if self.regions and self.regions[-1].kind in ("STL", "MC"):
            self.bus = True
            return True
        on = "{}{}".format(*self.model.flag("running"))
        self.report(instruction, f"{instruction} has no power flow", f"begin the rung with a contact, for example LD {on}", "4.1.1")
        self.blocks = 1
        return False

    def _rung_instruction(self, index: int, instruction: Instruction) -> None:
        mnemonic = instruction.mnemonic
        check = {"ANB": self._join, "ORB": self._join, "MPS": self._mps, "MRD": self._mrd, "MPP": self._mpp}.get(mnemonic)
        if check:
            check(instruction)
            return
        used = self.used and mnemonic != "NOP" and not self.kept  # the rung's output stands before it
        if mnemonic in self.model.unconditional and (used or not (self.blocks or self.kept or self.bus)):
            self._finish(index)
            self.used = True
            self._finish(index + 1)
            return
        if not self._flow(instruction):
            pass
        elif self.bus and mnemonic in ("EU", "ED", "INV", "NOP"):
            self.report(instruction, f"{mnemonic} stands directly on the bus", "put a contact before it", instruction.definition.section)
        if mnemonic in ("EU", "ED", "INV"):
            self.used = False
            self.branched = self.branched or self.forked
            return
        self._one_block(instruction)
        self.used, self.forked, self.alone = True, True, False
        self._output(index, instruction)

    def _join(self, instruction: Instruction) -> None:
        level = self._level()
        own = self.blocks - level
        to_fork = own == 1 and (self.forked or self.kept) and instruction.mnemonic == "ANB"
        if (own < 2 and not to_fork) or self.used:
            self.report(
                instruction, f"{instruction.mnemonic} needs two blocks", "each block begins with LD", instruction.definition.section
            )
            return
        if not (to_fork and self.blocks == 1):
            self.blocks -= 1
        self.alone = self.blocks > max(1, level) or not self.forked

    def _mps(self, instruction: Instruction) -> None:
        if not self._flow(instruction):
            return
        if self.bus and self.model.strict_steps and self.regions[-1].kind == "STL":
            self.report(instruction, "MPS stands directly behind STL", "put a contact before it", "5.3.1")
        self._one_block(instruction)
        if len(self.kept) >= self.limits["stack"]:
            self.report(
                instruction, f"more than {self.limits['stack']} MPS without MPP", "the flow stack is full; begin a new rung", "5.1.10"
            )
        self.kept.append(self.blocks)
        self.alone, self.used, self.forked = False, False, True

    def _one_block(self, instruction: Instruction) -> None:
        level = max(1, self._level())
        if self.blocks > level:
            self.report(
                instruction, f"{self.blocks - level + 1} blocks are not joined before {instruction}", "join them with ANB or ORB", "5.1.8"
            )
            self.blocks = level

    def _mrd(self, instruction: Instruction) -> None:
        if not self.kept:
            self.report(
                instruction,
                f"{instruction.mnemonic} without MPS",
                "MPS keeps the flow that MRD and MPP go on from",
                instruction.definition.section,
            )
            return
        self._one_block(instruction)
        self.alone, self.used, self.branched = False, False, False

    def _mpp(self, instruction: Instruction) -> None:
        self._mrd(instruction)
        if self.kept:
            self.kept.pop()

    def _finish(self, index: int) -> None:
        """End the rung before `index`, if one is open."""
        if self.start < index:
            last = self.unit.instructions[index - 1]
            if self.kept:
                self.report(last, f"{len(self.kept)} MPS without MPP at the end of the rung", "end the last branch with MPP", "5.1.10")
            elif not self.used and (self.blocks or self.bus) and not last.definition.bus:
                self.report(last, "the rung ends without an output", "a coil or a function box belongs at its right", "4.1.1")
            self._network(self.start, index)
        self.start = index
        self.blocks, self.kept = 0, []
        self.used = self.bus = self.alone = self.forked = self.branched = False

    def _network(self, start: int, end: int) -> None:
        region = tuple((r.kind, r.number) for r in self.regions)
        network = Network(len(self.unit.networks), start, end, self.unit.titles.get(start, ""), region)
        self.unit.networks.append(network)
        self.nodes[-1].append(network)

    # -- regions ----------------------------------------------------------------------------------------------

    def _bus_instruction(self, index: int, instruction: Instruction) -> None:
        mnemonic = instruction.mnemonic
        if mnemonic == "STL":
            self._stl(index, instruction)
            return
        if mnemonic in _CLOSERS:
            self._close(index, instruction)
        elif mnemonic in _OPENS:
            self._open(index, instruction)
            return
        elif mnemonic in _PARTS and self.regions:
            region = self.regions[-1]
            opening = self.unit.instructions[region.opening]
            self.report(instruction, f"{instruction} stands inside {opening}", f"close it with {_ENDS[region.kind]} first", "5.2.1")
        if mnemonic == "LBL":
            label = instruction.operands[0].value
            if label in self.labels:
                first = self.where(self.labels[label][0].line)
                self.report(instruction, f"the label {instruction.operands[0]} stands twice", f"it stands in {first} already", "6.1.3")
            self.labels[label] = (instruction, self._loops())
        self._network(index, index + 1)
        self.start = index + 1

    def _loops(self) -> tuple:
        return tuple(r.opening for r in self.regions if r.kind == "FOR")

    def _stl(self, index: int, instruction: Instruction) -> None:
        step = instruction.operands[0]
        if self.unit.kind != "MAIN":
            self.report(instruction, "steps may stand in the main program only", "", "5.3.5")
        current = self.regions[-1] if self.regions else None
        joined = current is not None and current.kind == "STL" and current.opening + len(current.steps) == index
        if joined:
            current.steps = (*current.steps, step)
            if len(current.steps) > self.limits["joined steps"]:
                self.report(instruction, f"more than {self.limits['joined steps']} steps are joined", "", "5.3.1")
            self.unit.networks[-1].end = index + 1
        else:
            if current is not None and current.kind == "STL":
                self._pop(index)
            elif current is not None:
                self.report(
                    instruction, f"{instruction} stands inside {current.kind}", f"close it with {_ENDS[current.kind]} first", "5.2.1"
                )
            joins = index + 1 < len(self.unit.instructions) and self.unit.instructions[index + 1].mnemonic == "STL"
            if joins:
                pass
            elif step.number in self.steps:
                first = self.steps[step.number]
                self.report(instruction, f"the step {step} is used twice", f"its first use is in {self.where(first.line)}", "7.4.1(1)")
            else:
                self.steps[step.number] = instruction
            self._network(index, index + 1)
            self._push(Region("STL", step.number, index, steps=(step,)))
        self.start = index + 1

    def _push(self, region: Region) -> None:
        self.nodes[-1].append(region)
        self.nodes.append(region.nodes)
        self.regions.append(region)

    def _pop(self, index: int) -> None:
        self.regions.pop().closing = index
        self.nodes.pop()

    def _close(self, index: int, instruction: Instruction) -> None:
        kind = _CLOSERS[instruction.mnemonic]
        section = instruction.definition.section
        wanted = instruction.operands[0].value if kind == "MC" else None
        if wanted is not None and self.model.levels:  # the end of a level is that of the levels inside it
            while self.regions and self.regions[-1].kind == "MC" and self.regions[-1].number > wanted:
                self._pop(index)
        if self.regions and self.regions[-1].kind == kind and (wanted is None or self.regions[-1].number == wanted):
            self._pop(index)
        elif any(r.kind == kind and (wanted is None or r.number == wanted) for r in self.regions):
            inner = self.regions[-1]
            name = (
                f"{inner.kind} {self.unit.instructions[inner.opening].operands[0]}"
                if inner.kind == "MC"
                else f"STL {inner.steps[0]}"
                if inner.kind == "STL"
                else inner.kind
            )
            self.report(
                instruction, f"{instruction} crosses {name}", f"close {name} first; structures may be nested but not cross", section
            )
            while self.regions and not (self.regions[-1].kind == kind and (wanted is None or self.regions[-1].number == wanted)):
                self._pop(index)
            self._pop(index)
        else:
            self.report(
                instruction,
                f"{instruction} closes nothing",
                f"there is no open {kind}{f' {instruction.operands[0]}' if kind == 'MC' else ''} before it",
                section,
            )

    def _output(self, index: int, instruction: Instruction) -> None:
        mnemonic = instruction.mnemonic
        if mnemonic in _OPENS:
            self._open(index, instruction)
        elif mnemonic == "CJ":
            self.jumps.append((instruction, instruction.operands[0].value, self._loops()))
        elif mnemonic in _LEAVES:
            kind, where, section = _LEAVES[mnemonic]
            if self.unit.kind != kind:
                self.report(instruction, f"{mnemonic} may stand in {where} only", "", section)
        elif mnemonic == "CALL" and self.unit.kind == "INTERRUPT":
            self.report(instruction, "an interrupt program cannot call a subroutine", "", "4.4.2")
        elif self._is_transition(instruction) and self.branched:
            self.report(
                instruction,
                f"{instruction} stands behind a branch with a condition of its own",
                "write each transition with its whole condition, from LD on",
                "7.4.1(2)",
            )

    def _is_transition(self, instruction: Instruction) -> bool:
        in_step = any(region.kind == "STL" for region in self.regions)
        return in_step and instruction.mnemonic in ("SET", "OUT") and instruction.operands[0].area == "S"

    def _open(self, index: int, instruction: Instruction) -> None:
        kind = _OPENS[instruction.mnemonic]
        section = instruction.definition.section
        number = instruction.operands[0].value if kind == "MC" else len([r for r in self.regions if r.kind == "FOR"])
        if self.kept:
            self.report(instruction, f"{instruction} stands in a branch of MPS", f"give {kind} a rung of its own", section)
            self.kept = []
        if kind == "MC":
            if any(r.kind == "STL" for r in self.regions):
                self.report(instruction, "MC cannot be used in a step", "", "5.2.1")
            open_levels = [r for r in self.regions if r.kind == "MC"]
            if any(r.number == number for r in open_levels):
                name = f"MC {instruction.operands[0]}"
                self.report(instruction, f"{instruction} stands inside {name}", "nested structures have different numbers", section)
            elif self.model.levels and any(r.number > number for r in open_levels):
                outer = self.unit.instructions[open_levels[-1].opening]
                self.report(instruction, f"{instruction} stands inside {outer}", "levels go up from N0 on, from outside to inside", section)
        depth = sum(r.kind == kind for r in self.regions) + 1
        if depth > self.limits[f"{kind} nesting"]:
            self.report(instruction, f"{kind} is nested {depth} deep", f"at most {self.limits[f'{kind} nesting']}", section)
        if instruction.definition.bus:
            self._network(index, index + 1)
        else:
            self._finish(index + 1)
        self._push(Region(kind, number, index))
        self.start = index + 1

    def _check_flows(self) -> None:
        """A section of steps, closed by RET, is one independent flow."""
        closers = [instruction for instruction in self.unit.instructions if instruction.mnemonic == "RET"]
        if len(closers) > self.limits["flows"]:
            self.report(
                closers[self.limits["flows"]], f"there are {len(closers)} flows of steps", f"at most {self.limits['flows']}", "7.1.2"
            )

    def _check_jumps(self) -> None:
        for instruction, label, loops in self.jumps:
            if label not in self.labels:
                self.report(
                    instruction,
                    f"there is no {'label' if self.model.syntax.pointers else 'LBL'} {instruction.operands[0]} in {self.unit.name}",
                    "a label belongs to the unit in which it is jumped to",
                    "6.1.4",
                )
            elif self.labels[label][1] != loops[: len(self.labels[label][1])]:
                self.report(instruction, f"{instruction} jumps into a FOR", "a jump may leave a loop, not enter it", "6.1.1")


class _Transitions:
    """7.4.1(6): SET leads to the adjacent step, OUT jumps."""

    def __init__(self, unit: Unit, steps: dict[int, Instruction], model: Model, report, where):
        self.unit, self.steps, self.model, self.report, self.where = unit, steps, model, report, where
        self.initial_steps = model.initial_steps

    def check(self) -> None:
        transitions = list(self._transitions())
        if self.model.strict_steps:
            self._check_conditions(transitions)
        reached = {target.number for _, instruction, target, _ in transitions if instruction.mnemonic == "SET"}
        order = {number: place for place, number in enumerate(self.steps)}
        links: dict[int, set[int]] = {}
        for region, instruction, target, _ in transitions:
            for source in region.steps:
                if instruction.mnemonic == "SET" and order.get(target.number, len(order)) > order.get(
                    source.number, -1
                ):  # a SET that goes back is told once
                    links.setdefault(source.number, set()).add(target.number)
        for region, instruction, target, section in transitions:
            if target.number not in self.steps:
                continue
            sources = [s.number for s in region.steps]
            back = any(order.get(target.number, 0) <= order.get(source, -1) for source in sources)
            if instruction.mnemonic == "SET":
                if target.number < self.initial_steps and not back:
                    self.report(
                        instruction,
                        f"{instruction} leads to an initial step",
                        f"S0 to S{self.initial_steps - 1} are initial; a jump is written OUT {target}",
                        "7.4.1(6)",
                    )
                elif back:
                    self.report(instruction, f"{instruction} goes back", f"a jump is written OUT {target}", "7.4.1(6)")
                elif self._section(target.number) != section:
                    self.report(instruction, f"{instruction} leads into another flow", f"a jump is written OUT {target}", "7.4.1(6)")
                elif self._reached_another_way(sources, target.number, links):
                    hint = self._joined_twice(sources) or f"a jump is written OUT {target}"
                    self.report(instruction, f"{instruction} leaves out the steps between", hint, "7.4.1(6)")
            elif (
                not back
                and target.number not in reached
                and self._section(target.number) == section
                and self._follows(target.number, sources, order)
            ):
                self.report(instruction, f"{instruction} leads to the adjacent step", f"a transition is written SET {target}", "7.4.1(6)")

    def _check_conditions(self, transitions: list) -> None:
        """4.1.1 of the FX family: how many ways a branch has, and what may stand in the conditions of branches and joins."""
        most, most_of_all = self.model.limits["ways"], self.model.limits["ways of an initial step"]
        initial, side_by_side = None, 1  # the initial step of a flow, and the ways that its branches have made of one
        for _, region in self._sections():
            if region.number < self.initial_steps:
                initial, side_by_side = region, 1
            ways = [instruction for source, instruction, *_ in transitions if source is region]
            if not ways:
                continue
            if len(ways) > most:
                self.report(ways[most], f"{len(ways)} ways lead on from S{region.number}", f"at most {most} in one branch", "7.4.1")
            lines = [way for way in ways if way.mnemonic == "SET"]  # the others jump
            before, side_by_side = side_by_side, side_by_side + max(len(lines) - 1, 0)
            if initial and before <= most_of_all < side_by_side:
                hint = f"at most {most_of_all} belong to one initial step"
                self.report(lines[-1], f"the branches behind S{initial.number} have {side_by_side} ways", hint, "7.4.1")
            if len(region.steps) > 1 and len(ways) > 1:
                hint = "lead to one empty step, and branch from that"
                self.report(ways[1], f"{ways[1]} branches straight from a join", hint, "7.4.1")
            if len(region.steps) > 1 or len(ways) > 1:
                self._check_blocks(region, ways)

    def _check_blocks(self, region: Region, ways: list[Instruction]) -> None:
        instructions = self.unit.instructions
        for network in region.nodes:
            rung = instructions[network.start : network.end] if isinstance(network, Network) else ()
            way = next((instruction for instruction in rung if any(instruction is each for each in ways)), None)
            block = next((instruction for instruction in rung if instruction.mnemonic in _BLOCKS), None)
            if way and block:
                hint = "work the condition out in a relay before, and let that lead on"
                self.report(block, f"{block} stands in the condition of {way}, where ways part or join", hint, "7.4.1")

    @staticmethod
    def _reached_another_way(sources: list[int], target: int, links: dict[int, set[int]]) -> bool:
        """Whether transitions lead from the sources to the target by way of other steps too."""
        seen: set[int] = set()
        waiting = [step for source in sources for step in links.get(source, ()) if step != target]
        while waiting:
            step = waiting.pop()
            if step in seen:
                continue
            seen.add(step)
            following = links.get(step, set())
            if target in following:
                return True
            waiting += following
        return False

    def _joined_twice(self, sources: list[int]) -> str:
        """What to say of a step that stands in several joins: two STL one after the other join, so an empty step needs a rung."""
        joins = [region for _, region in self._sections() if len(region.steps) > 1]
        for region in joins:
            steps = {step.number for step in region.steps}
            others = [{step.number for step in other.steps} for other in joins if other is not region]
            if any(steps & other and (steps | other) & set(sources) for other in others):
                stl = " and ".join(f"STL {step}" for step in region.steps)
                where = self.where(self.unit.instructions[region.opening].line)
                return f"{stl} in {where} are a join; give an empty step a rung of its own, for example LD SM0, NOP"
        return ""

    def _follows(self, target: int, sources: list[int], order: dict[int, int]) -> bool:
        return target >= self.initial_steps and order[target] == max(order.get(source, -1) for source in sources) + 1

    def _sections(self):
        section = 0
        for node in self.unit.nodes:
            if isinstance(node, Region) and node.kind == "STL":
                yield section, node
            elif isinstance(node, Network) and self.unit.instructions[node.start].mnemonic == "RET":
                section += 1

    def _section(self, number: int) -> int:
        return next((section for section, region in self._sections() if len(region.steps) == 1 and region.number == number), -1)

    def _transitions(self):
        for section, region in self._sections():
            first = region.opening + len(region.steps)
            for instruction in self.unit.instructions[first : region.closing]:
                if instruction.mnemonic in ("SET", "OUT") and instruction.operands[0].area == "S":
                    yield region, instruction, instruction.operands[0], section
