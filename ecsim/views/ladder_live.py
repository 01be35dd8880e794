"""What changes in a ladder from scan to scan: the power of a trace, the states of contacts and coils, values, forced marks.

Everything that a network can look like is computed once and remembered by what the scan recorded of it, so that a frame of
a hundred rungs costs well under a millisecond. A network knows nothing of the others: of a large program only those are asked
that are looked at.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ..devices import Device
from ..engines import Trace
from ..instructions import TABLE
from ..memory import Memory
from ..models import Model
from .labels import COILS, closing, compares, constant_value, figure, operand_type, reader
from .layout import Placed
from .rungs import Contact, Output, Word
from .svg import number
from .symbols import BOX, PAD, counts, forcible, spoken

if TYPE_CHECKING:
    from .ladder import Strip

REMEMBERED = 500  # looks of one network


class Live:
    """One network: what it may look like, and what is read for it."""

    def __init__(self, strip: Strip, placed: Placed | None, model: Model):
        self.number, self.placed, self.labels, self.rails = strip.number, placed, strip.entry.labels, strip.rails
        self.words = strip.entry.words
        self.first, self.last = self.words[0].position, self.words[-1].position + 1
        self.seen: dict[tuple, dict[str, str]] = {}
        self.bits: list[tuple[str, int]] = []  # what coils and steps hold, as list and number
        self.bit_of: dict[int, int] = {}  # position -> its place in `bits`
        self.region_bit = -1
        self.values: list[tuple] = []
        self.contacts: list[tuple] = []
        for word in self.words:
            self._gather(word, model)
        unit = strip.entry.unit
        # What a subroutine or interrupt program has of its own is gone when it has ended; the trace kept it.
        self.owner = unit.name if unit.kind != "MAIN" and any(map(self.labels.own, self.words)) else ""
        region = strip.entry.rung.region
        if region and region[-1][0] == "STL":
            self.region_bit = len(self.bits)
            self.bits.append(("S", region[-1][1]))
        if placed:
            self._trace(strip)
        self.rest = self.look(None, (None,) * (self.last - self.first), (False,) * len(self.bits))
        self.rest |= {f"{rail.key}:class": "rail" for rail in self.rails}
        for key, _, _, full in self.values:
            self.rest[f"{key}:text"] = ""
            if full:
                self.rest[f"r{key[1:].partition('.')[0]}:width"] = "0"
            if key[0] == "b":
                self.rest[f"{key}:class"] = "el-bit"
        self.forcible: dict[str, list[int]] = {}  # device -> the positions where it stands
        for word in self.words if placed else ():
            p = word.position
            for device in forcible(word):
                self.forcible.setdefault(device, []).append(p)
                self.rest |= {f"f{p}:class": "forced", f"h{p}:class": "forced", f"g{p}:text": "F"}

    def _gather(self, word: Word, model: Model) -> None:
        """What is read for one instruction."""
        definition = TABLE[word.mnemonic]
        readers = [reader(operand, operand_type(word, place), model) for place, operand in enumerate(word.operands)]
        holds = word.operands[0] if word.operands and (word.mnemonic in COILS or definition.bus) else None
        if isinstance(holds, Device) and holds.index is None:
            self.bit_of[word.position] = len(self.bits)
            self.bits.append((f"{holds.area}B" if holds.area in ("T", "C") else holds.area, holds.number))
        if definition.form == "contact":
            constants = [constant_value(operand) for operand in word.operands]
            self.contacts.append((word.position - self.first, closing(word), readers, constants))
        if word.mnemonic in COILS:
            if COILS[word.mnemonic]:
                self.values.append((f"b{word.position}", readers[0], None, 0))
        elif (definition.form != "contact" or compares(word)) and not definition.bus:
            for place, read in enumerate(readers):
                if read is not None:
                    full = BOX - 2 * PAD if counts(word) and place == 0 else 0
                    self.values.append(
                        (f"v{word.position}.{place}", read, (readers[1] or constant_value(word.operands[1])) if full else None, full)
                    )

    def _trace(self, strip: Strip) -> None:
        """Each net's wires and dots as path data; a live dot is larger."""
        nets = range(self.placed.power.count)
        wires: list[list[str]] = [[] for _ in nets]
        dots: list[list[tuple[str, str]]] = [[] for _ in nets]
        x0, y0 = strip.left, strip.wire
        for x1, y1, x2, y2, net in self.placed.wires:
            wires[net].append(f"M{number(x0 + x1)} {number(y0 + y1)}" + (f"H{number(x0 + x2)}" if y1 == y2 else f"V{number(y0 + y2)}"))
        for x, y, net in self.placed.dots:
            dots[net].append(
                tuple(f"M{number(x0 + x - r)} {number(y0 + y)}a{r} {r} 0 1 0 {2 * r} 0a{r} {r} 0 1 0 -{2 * r} 0" for r in (2.5, 3.5))
            )
        self.nets = [("".join(wires[net]), "".join(d for d, _ in dots[net]), "".join(q for _, q in dots[net])) for net in nets]

    # -- looks --------------------------------------------------------------------------------------------------

    def look(self, flow: Sequence[bool | None] | None, closed: Sequence[bool | None], bits: Sequence[bool]) -> dict[str, str]:
        """Every entry that follows from what a scan recorded, from the contacts' states and from what the coils hold."""
        entries: dict[str, str] = {}
        executed = flow is not None and flow[0] is not None
        if self.region_bit >= 0:
            entries[f"m{self.number}:class"] = "step active" if bits[self.region_bit] else "step"
        if self.placed is None:
            self._bus_look(entries, executed, bits)
            return entries
        power = self.placed.power.solve(executed, flow or (), closed, self.first)
        split = ["", "", "", ""]
        for on, (wires, dots, live_dots) in zip(power, self.nets, strict=True):
            if on:
                split[2] += wires
                split[3] += live_dots
            else:
                split[0] += wires
                split[1] += dots
        entries |= {f"{letter}{self.number}:d": path for letter, path in zip("wopq", split, strict=True)}
        for symbol in self.placed.symbols:
            word = symbol.item.word
            if isinstance(symbol.item, Output):
                kind, state = self._output_state(word, power[symbol.before], bits)
            else:
                passes = power[symbol.after]
                shut = isinstance(symbol.item, Contact) and closed[word.position - self.first]
                kind, state = "contact", "flow" if passes else "closed" if shut else "open"
            self._enter(entries, word, kind, state)
        return entries

    def _output_state(self, word: Word, powered: bool, bits: Sequence[bool]) -> tuple[str, str]:
        place = self.bit_of.get(word.position)
        if place is None:
            return "fbox", "flow" if powered else "open"
        return "coil", "flow" if powered else "on" if bits[place] and word.mnemonic == "OUT" else "open"

    def _bus_look(self, entries: dict[str, str], executed: bool, bits: Sequence[bool]) -> None:
        steps = [place for word in self.words if (place := self.bit_of.get(word.position)) is not None]
        live = executed and all(bits[place] for place in steps)
        entries[f"x{self.number}:class"] = "wire on" if live else "wire"
        for word in self.words:
            place = self.bit_of.get(word.position)
            if place is None:
                self._enter(entries, word, "fbox", "flow" if executed else "open")
            else:
                self._enter(entries, word, "step", "active" if bits[place] else "")

    def _enter(self, entries: dict[str, str], word: Word, kind: str, state: str) -> None:
        said = {
            "flow": "power flows",
            "closed": "closed",
            "open": "open" if kind == "contact" else "off",
            "on": "on",
            "active": "active",
            "": "not active",
        }
        entries[f"e{word.position}:class"] = f"{kind} {state}".rstrip()
        entries[f"e{word.position}:aria-label"] = f"{spoken(word, self.labels)}, {said[state]}"

    # -- a frame ------------------------------------------------------------------------------------------------

    def closed_now(self, memory: Memory) -> tuple[bool | None, ...]:
        """Each contact's state as the memory has it now, by position from the first."""
        states: list[bool | None] = [None] * (self.last - self.first)
        for place, function, readers, constants in self.contacts:
            values = [constant if read is None else read(memory) for read, constant in zip(readers, constants, strict=True)]
            states[place] = None if None in values else bool(function(*values))
        return tuple(states)

    def put(self, entries: dict[str, str], memory: Memory, trace: Trace | None, running: bool, forced: Mapping[str, int | float]) -> None:
        """Enter what this network looks like now."""
        if self.owner:
            memory = own_memory(memory, trace, self.owner)
        lists = memory.lists
        if trace is None:
            flow, closed = None, self.closed_now(memory)
        else:
            flow, closed = tuple(trace.flow[self.first : self.last]), tuple(trace.closed[self.first : self.last])
        bits = tuple([area in lists and lists[area][number] for area, number in self.bits])
        look = self.seen.get((flow, closed, bits))
        if look is None:
            if len(self.seen) >= REMEMBERED:
                self.seen.clear()
            look = self.seen[flow, closed, bits] = self.look(flow, closed, bits)
        entries.update(self.rest)
        entries.update(look)
        for rail in self.rails:
            if running if rail.position < 0 else trace is not None and trace.flow[rail.position] is not None:
                entries[f"{rail.key}:class"] = "rail on"
        for key, read, preset, full in self.values:
            value = read(memory)
            entries[f"{key}:text"] = figure(value)
            if full:
                goal = preset(memory) if callable(preset) else preset
                share = min(1.0, max(0.0, value / goal)) if value is not None and goal else 0.0
                entries[f"r{key[1:-2]}:width"] = number(full * share)
            elif key[0] == "b" and value:
                entries[f"{key}:class"] = "el-bit on"
        for device in forced.keys() & self.forcible.keys():
            for position in self.forcible[device]:
                entries[f"f{position}:class"] = entries[f"h{position}:class"] = "forced on"
                entries[f"g{position}:text"] = f"F {figure(forced[device])}"


def own_memory(memory: Memory, trace: Trace | None, unit: str) -> Memory:
    """The memory with a unit's own V and LM at the end of its last call in the scan; without them where no call was recorded."""
    own = copy.copy(memory)
    kept = trace.locals.get(unit, {}) if trace is not None else {}
    own.lists = {name: values for name, values in memory.lists.items() if name not in memory.model.local_areas} | kept
    return own
