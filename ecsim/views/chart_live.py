"""What changes in a chart from scan to scan: active steps and their time, actions at work, what each transition waits for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..assembler.program import Program
from ..devices import Device
from ..instructions import TABLE
from ..memory import Memory
from .chart_layout import Node
from .conditions import Condition
from .flows import Action, Transition
from .labels import constant_value, figure, operand_type, reader
from .layout import RAIL
from .rungs import Word
from .symbols import counts

if TYPE_CHECKING:
    from .sfc import ChartSheet


class Waiting:
    """One transition: the steps that must be active, and its contacts."""

    def __init__(self, transition: Transition, node: Node, condition: Condition, model):
        self.position = transition.position
        self.steps = tuple(device.number for device in node.devices)
        self.condition, self.transition = condition, transition
        self.contacts = {}
        for word in condition.words():
            if TABLE[word.mnemonic].form == "contact":
                readers = [reader(operand, operand_type(word, place), model) for place, operand in enumerate(word.operands)]
                constants = [constant_value(operand) for operand in word.operands]
                self.contacts[word.position] = (TABLE[word.mnemonic].function, readers, constants)
        self.first = condition.words()[0].position if condition.words() else -1

    def closed(self, word: Word, memory: Memory, trace) -> bool:
        """Whether a contact is closed: as the scan saw it, else as the memory has it now."""
        if trace is not None and trace.closed[word.position] is not None:
            return bool(trace.closed[word.position])
        function, readers, constants = self.contacts[word.position]
        values = [constant if read is None else read(memory) for read, constant in zip(readers, constants, strict=True)]
        return None not in values and bool(function(*values))

    def put(self, entries: dict[str, str], memory: Memory, trace, running: bool) -> None:
        """Enter the bar, the plate and the small contacts."""
        steps = memory.lists["S"]
        active = running and all(steps[number] for number in self.steps)
        fired = trace is not None and bool(trace.flow[self.position])
        key = self.position
        entries[f"b{key}:class"] = "tbar fires" if fired else "tbar enabled" if active else "tbar"
        entries[f"p{key}:class"] = "wait-plate on" if active and not fired else "wait-plate"
        if self.condition.kind == "single":
            self._single(entries, memory, trace, active or fired)
        elif self.condition.placed:
            self._ladder(entries, memory, trace, active or fired)

    def _single(self, entries: dict[str, str], memory: Memory, trace, power: bool) -> None:
        word, edge = self.condition.one
        shut = self.closed(word, memory, trace)
        passes = power and shut if edge is None else trace is not None and bool(trace.flow[edge.position])
        entries[f"i{word.position}:class"] = "wire on" if power else "wire"
        entries[f"o{word.position}:class"] = "wire on" if passes else "wire"
        # With an edge the symbol is open until the edge comes, whatever the contact does.
        state = "flow" if passes else "closed" if shut and edge is None else "open"
        entries[f"e{word.position}:class"] = f"contact {state}"

    def _ladder(self, entries: dict[str, str], memory: Memory, trace, power: bool) -> None:
        placed = self.condition.placed
        nets = [False] * placed.power.count
        nets[RAIL] = power
        states = {}
        for kind, net, sources, position in placed.power.steps:
            if kind == "contact":
                nets[net] = nets[sources[0]]
                states[net] = position
            elif kind == "gate":
                nets[net] = nets[sources[0]] and trace is not None and bool(trace.flow[position])
            else:
                nets[net] = any(nets[source] for source in sources)
            if kind == "contact":
                word = next(symbol.item.word for symbol in placed.symbols if symbol.after == net)
                shut = self.closed(word, memory, trace)
                nets[net] = nets[net] and shut
                entries[f"e{position}:class"] = f"contact {'flow' if nets[net] else 'closed' if shut else 'open'}"
            elif kind == "gate":
                entries[f"e{position}:class"] = f"contact {'flow' if nets[net] else 'open'}"
        for net in {wire[4] for wire in placed.wires}:
            entries[f"n{self.first}.{net}:class"] = "wire on" if nets[net] else "wire"


class ChartLive:
    """All that changes on a sheet."""

    def __init__(self, sheet: ChartSheet, program: Program | None):
        self.program = program
        nodes = [what for what, _, _ in sheet.marks() if isinstance(what, Node)]
        self.steps = [node.devices[0] for node in nodes if not node.joins]
        self.joins = [node for node in nodes if node.joins]
        drawn = {id(what) for what, _, _ in sheet.marks() if isinstance(what, Transition)}
        self.waiting = [
            Waiting(transition, node, sheet.lengths.condition(transition), sheet.model)
            for node in nodes
            for transition in (node.step.transitions if node.step else ())
            if id(transition) in drawn
        ]
        self.actions: list[tuple[Action, Node]] = [(action, node) for node in nodes if node.step for action in node.step.actions]
        self.values = [
            (f"v{action.word.position}:text", reader(action.word.operands[0], operand_type(action.word, 0), sheet.model))
            for action, _ in self.actions
            if counts(action.word)
        ]

    def state(self, moment) -> dict[str, str]:
        """Every entry at this moment."""
        plc = getattr(moment, "plc", moment)
        since: dict[str, int] = getattr(moment, "step_since", {})
        memory = plc.memory
        same = self.program is None or plc.program is self.program
        trace = plc.trace if plc.running and plc.tracing and same else None
        steps = memory.lists["S"]
        entries: dict[str, str] = {}
        for device in self.steps:
            active = bool(steps[device.number])
            entries[f"{device}:class"] = "step active" if active else "step"
            began = since.get(str(device)) if active else None
            entries[f"t{device}:text"] = "" if began is None else f"{max(0, plc.time_us - began) / 1e6:,.2f} s"
        for node in self.joins:
            self._join(entries, node, steps)
        for action, node in self.actions:
            entries[f"e{action.word.position}:class"] = "action on" if self._at_work(action, node, plc, trace) else "action"
        for key, read in self.values:
            entries[key] = figure(read(memory)) if read else ""
        for transition in self.waiting:
            transition.put(entries, memory, trace, plc.running)
        return entries

    @staticmethod
    def _join(entries: dict[str, str], node: Node, steps: list) -> None:
        key = node.step.opening.words[0].position
        missing = [str(device) for device in node.devices if not steps[device.number]]
        for device in node.devices:
            entries[f"j{key}.{device}:class"] = "arrive here" if steps[device.number] else "arrive"
        some = 0 < len(missing) < len(node.devices)
        entries[f"w{key}:text"] = f"waits for {' and '.join(filter(None, [', '.join(missing[:-1]), missing[-1]]))}" if some else ""

    @staticmethod
    def _at_work(action: Action, node: Node, plc, trace) -> bool:
        """Whether power reaches an action: as the scan saw it; without a trace as far as the memory tells."""
        if trace is not None:
            return bool(trace.flow[action.word.position])
        memory = plc.memory
        if not plc.running or not all(memory.lists["S"][device.number] for device in node.devices):
            return False
        target = action.word.operands[0] if action.word.operands else None
        if action.qualifier == "N" and isinstance(target, Device) and target.index is None:
            return bool(memory.bits(target.area)[target.number])
        return not action.condition.items
