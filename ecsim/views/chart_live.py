"""What changes in a chart from scan to scan: active steps and their time, actions at work, what each transition waits for."""

from __future__ import annotations

from collections.abc import Container
from typing import TYPE_CHECKING

from ..assembler.program import Program
from ..devices import Device
from ..engines import Trace
from ..instructions import TABLE
from ..memory import Memory
from ..models import Model
from .chart_layout import Node
from .conditions import Condition
from .flows import Action, Transition
from .labels import closing, constant_value, figure, operand_type, reader
from .symbols import counts

if TYPE_CHECKING:
    from .sfc import ChartSheet


class Waiting:
    """One transition: the steps that must be active, its contacts and its edges. What it may look like is remembered."""

    def __init__(self, transition: Transition, node: Node, condition: Condition, model: Model):
        self.position = transition.position
        self.steps = tuple(device.number for device in node.devices)
        self.condition = condition
        self.contacts = []  # (position, function, readers, constants)
        self.edges = []  # positions
        for word in condition.words():
            definition = TABLE[word.mnemonic]
            if definition.form == "contact":
                readers = [reader(operand, operand_type(word, place), model) for place, operand in enumerate(word.operands)]
                constants = [constant_value(operand) for operand in word.operands]
                self.contacts.append((word.position, closing(word), readers, constants))
            else:
                self.edges.append(word.position)
        self.wired = sorted({wire[4] for wire in condition.placed.wires}) if condition.placed else []
        self.seen: dict[tuple, dict[str, str]] = {}

    def put(self, entries: dict[str, str], memory: Memory, trace: Trace | None, running: bool) -> None:
        """Enter the bar, the plate and the small contacts."""
        steps = memory.lists["S"]
        active = running and all(steps[number] for number in self.steps)
        fired = trace is not None and bool(trace.flow[self.position])
        shut = tuple([self._closed(contact, memory, trace) for contact in self.contacts])
        edges = tuple([trace is not None and bool(trace.flow[position]) for position in self.edges])
        look = self.seen.get((active, fired, shut, edges))
        if look is None:
            look = self.seen[active, fired, shut, edges] = self._look(active, fired, shut, edges)
        entries.update(look)

    @staticmethod
    def _closed(contact: tuple, memory: Memory, trace: Trace | None) -> bool:
        """Whether a contact is closed: as the scan saw it, else as the memory has it now."""
        position, function, readers, constants = contact
        if trace is not None and (closed := trace.closed[position]) is not None:
            return bool(closed)
        values = [constant if read is None else read(memory) for read, constant in zip(readers, constants, strict=True)]
        return None not in values and bool(function(*values))

    def _look(self, active: bool, fired: bool, shut: tuple[bool, ...], edges: tuple[bool, ...]) -> dict[str, str]:
        entries = {
            f"b{self.position}:class": "tbar fires" if fired else "tbar enabled" if active else "tbar",
            f"p{self.position}:class": "wait-plate on" if active and not fired else "wait-plate",
        }
        if self.condition.kind == "single":
            self._single(entries, active or fired, shut[0], edges)
        elif self.condition.placed:
            self._ladder(entries, active or fired, shut, edges)
        return entries

    def _single(self, entries: dict[str, str], power: bool, shut: bool, edges: tuple[bool, ...]) -> None:
        """One contact. With an edge the symbol is open until the edge comes, whatever the contact does."""
        position = self.contacts[0][0]
        passes = edges[0] if edges else power and shut
        entries[f"i{position}:class"] = "wire on" if power else "wire"
        entries[f"o{position}:class"] = "wire on" if passes else "wire"
        entries[f"e{position}:class"] = f"contact {'flow' if passes else 'closed' if shut and not edges else 'open'}"

    def _ladder(self, entries: dict[str, str], power: bool, shut: tuple[bool, ...], edges: tuple[bool, ...]) -> None:
        placed = self.condition.placed
        closed = {contact[0]: state for contact, state in zip(self.contacts, shut, strict=True)}
        nets = placed.power.solve(power, dict(zip(self.edges, edges, strict=True)), closed)
        for symbol in placed.symbols:
            position = symbol.item.word.position
            state = "flow" if nets[symbol.after] else "closed" if closed.get(position) else "open"
            entries[f"e{position}:class"] = f"contact {state}"
        first = self.condition.words()[0].position
        for net in self.wired:
            entries[f"n{first}.{net}:class"] = "wire on" if nets[net] else "wire"


class ChartLive:
    """All that changes on a sheet."""

    def __init__(self, sheet: ChartSheet, program: Program | None):
        self.program = program
        marks = list(sheet.marks())
        # Everything with the number of its band, so that of a large chart only what is looked at need be asked.
        nodes = [(sheet.band_of(y), what) for what, _, y in marks if isinstance(what, Node)]
        bars = {id(what): sheet.band_of(y) for what, _, y in marks if isinstance(what, Transition)}
        self.steps = [(band, node.devices[0]) for band, node in nodes if not node.joins]
        self.joins = [(band, node) for band, node in nodes if node.joins]
        self.waiting = [
            (bars[id(transition)], Waiting(transition, node, sheet.lengths.condition(transition), sheet.model))
            for _, node in nodes
            for transition in (node.step.transitions if node.step else ())
            if id(transition) in bars
        ]
        self.actions: list[tuple[int, Action, Node]] = [
            (band, action, node) for band, node in nodes if node.step for action in node.step.actions
        ]
        self.values = [
            (band, f"v{action.word.position}:text", reader(action.word.operands[0], operand_type(action.word, 0), sheet.model))
            for band, action, _ in self.actions
            if counts(action.word)
        ]

    def state(self, moment, shown: Container[int] | None = None) -> dict[str, str]:
        """Every entry at this moment, or those of the bands whose numbers are in `shown`."""
        plc = getattr(moment, "plc", moment)
        since: dict[str, int] = getattr(moment, "step_since", {})
        points = {point.text: point for point in getattr(moment, "breakpoints", ())}
        memory = plc.memory
        same = self.program is None or plc.program is self.program
        trace = plc.trace if plc.running and plc.tracing and same else None
        steps = memory.lists["S"]

        def seen(band: int) -> bool:
            return shown is None or band in shown

        entries: dict[str, str] = {}
        for band, device in self.steps:
            if not seen(band):
                continue
            active = bool(steps[device.number])
            entries[f"{device}:class"] = "step active" if active else "step"
            began = since.get(str(device)) if active else None
            point = points.get(str(device))
            entries[f"k{device}:class"] = "breakpoint none" if point is None else "breakpoint" if point.enabled else "breakpoint off"
            entries[f"t{device}:text"] = "" if began is None else f"{max(0, plc.time_us - began) / 1e6:,.2f} s"
        for band, node in self.joins:
            if seen(band):
                self._join(entries, node, steps)
        for band, action, node in self.actions:
            if seen(band):
                entries[f"e{action.word.position}:class"] = "action on" if self._at_work(action, node, plc, trace) else "action"
        for band, key, read in self.values:
            if seen(band):
                entries[key] = figure(read(memory)) if read else ""
        for band, transition in self.waiting:
            if seen(band):
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
