"""The ladder with the power flow of the last scan, laid out for the width that the page has.

Of a large program the page gets the height of every network, and the drawings and values of those that it looks at. It keeps the
drawings of those that it has looked at lately, so that going to and fro sends each of them once.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator

from ecsim.assembler.program import Instruction
from ecsim.devices import Bits, Device
from ecsim.errors import EcsimError
from ecsim.instructions.signature import OperandSpec
from ecsim.values import BOOL
from ecsim.views.asked import asked
from ecsim.views.ladder import ladder

from .plate import Plated
from .rig import PREFIX, Rig

NARROWEST, WIDEST = 340, 1400
LIVE, KEPT = 150, 600  # of the networks that were looked at lately: so many have their values, so many their drawings in the page
FIRST = 12  # networks of a ladder of more than `LIVE` that are there before a page has said what it looks at
MOST_LOOKS, MOST_NETWORKS = 4, 300  # views at a time, and what one of them may look at
MOST_PLACES = 200  # of a device, told at once


class Ladder(Plated):
    """The whole program as a ladder.

    A frame has an entry "net.<n>" for the drawing of each network that was looked at lately; "live" tells which of them have their
    values in the frame, "looked" which are looked at now, as [first, last, first, last ...].
    """

    key = "ladder"

    def __init__(self, rig: Rig):
        super().__init__(rig)
        self.drawing = ladder(rig.program)
        whole = range(len(self.drawing)) if len(self.drawing) <= LIVE else None
        self._looks: dict[str, range] = {"": range(FIRST) if whole is None else whole}
        self._kept = dict.fromkeys(whole or ())  # the networks that were looked at, the latest last
        self._lay_out(NARROWEST)
        self.least = int(self.sheet.width)  # the program may need more than was asked for
        self.first = [entry.words[0].position for entry in self.drawing.entries]
        self._asked: dict[int, dict[int, str]] = {}
        self._set_at: dict[str, int] = {}  # what was asked by a breakpoint set here -> the position of its element

    def _lay_out(self, width: int) -> None:
        self.width, self.sheet = width, self.drawing.sheet(width)
        self._networks: dict[int, str] = {}
        strips = self.sheet.strips
        self._places = {
            "svg": self.sheet.shell(PREFIX),
            "tops": [*(round(strip.above) for strip in strips), round(strips[-1].bottom)] if strips else [0],
        }

    def layout(self):
        return {"about": f"{self.rig.program.steps:,} steps", "steps": self._steps(), "least": self.least}

    def _steps(self) -> dict[str, int]:
        """The network where each step begins."""
        steps: dict[str, int] = {}
        for number, entry in enumerate(self.drawing.entries):
            for word in entry.words:
                if word.mnemonic == "STL":
                    steps.setdefault(str(word.operands[0]), number)
        return steps

    def frame(self):
        plc, hit = self.rig.plc, self._hit
        looked = set().union(*self._looks.values())
        live = sorted(looked.union(list(self._kept)[-LIVE:]))
        entries = {
            "sheet": self._places,
            "active": self.rig.active(),
            "live": _runs(live),
            "looked": _runs(sorted(looked)),
            **self.plates(),
        }
        for number in (*self._kept, *live):
            if number not in self._networks:
                self._networks[number] = self.sheet.network(number, PREFIX)
            entries[f"net.{number}"] = self._networks[number]
        entries |= self.sheet.state(plc, live)
        entries["breaks"] = self._marks(live, entries)
        entries["hit"] = self._where(self._set_at[hit]) if hit in self._set_at else None
        return entries

    # -- what the page looks at ---------------------------------------------------------------------------------

    def on_fit(self, width):
        """Lay the ladder out anew for a width in px."""
        width = min(max(int(width), NARROWEST), WIDEST)
        if width != self.width:
            self._lay_out(width)
            if len(self.drawing) > LIVE:
                self._kept.clear()  # other drawings; those that nobody looks at can wait

    def on_see(self, view, first, last):
        """A view looks at the networks from `first` to `last`, counted from 0."""
        first = min(max(int(first), 0), len(self.drawing))
        looks = {name: numbers for name, numbers in self._looks.items() if name not in ("", view)}
        while len(looks) >= MOST_LOOKS:  # a page that went away leaves its own behind
            del looks[next(iter(looks))]
        now = range(first, min(int(last) + 1, len(self.drawing), first + MOST_NETWORKS))
        self._looks = looks | {view: now}
        kept = [*(number for number in self._kept if number not in now), *now]
        self._kept = dict.fromkeys(kept[-KEPT:])

    def on_unsee(self, view):
        """A view is no more."""
        self._looks = {name: numbers for name, numbers in self._looks.items() if name != view}

    def _where(self, position: int) -> list[int]:
        """An element's network and position."""
        return [bisect_right(self.first, position) - 1, position]

    # -- breakpoints --------------------------------------------------------------------------------------------

    @property
    def _hit(self) -> str:
        """The condition that has stopped the run, while it stands still."""
        session = self.rig.session
        return session.hit.text if session.hit and session.state != "running" else ""

    def _questions(self, number: int) -> dict[int, str]:
        """What a breakpoint at each element of a network would ask."""
        if number not in self._asked:
            self._asked[number] = asked(self.drawing.entries[number].rung, self.rig.plc.model)
        return self._asked[number]

    def _marks(self, shown: list[int], entries: dict) -> dict[str, str]:
        """The elements that have a breakpoint: position -> "on", "off" or "hit"."""
        points = {point.text: "on" if point.enabled else "off" for point in self.rig.session.breakpoints}
        if points.get(self._hit) == "on":
            points[self._hit] = "hit"
        if not points:
            return {}
        marks = {}
        for number in shown:
            for position, text in self._questions(number).items():
                if text in points:
                    marks[str(position)] = points[text]
                    words = {"on": "breakpoint", "off": "breakpoint, switched off", "hit": "the run stopped here"}[points[text]]
                    label = f"e{position}:aria-label"
                    entries[label] = f"{entries.get(label, '')}, {words}"
        return marks

    def on_break(self, position):
        """Set a breakpoint at an element, or take it away; gives the reason in words where nothing can be asked there, else ""."""
        number, position = self._where(int(position))
        text = self._questions(number).get(position)
        if text is None:
            return f"{self.rig.instructions[position]} has no breakpoint: between two scans nothing can be asked of it"
        points = self.rig.session.breakpoints
        if text in points:
            points.remove(text)
            self._set_at.pop(text, None)
        else:
            self._set_at[points.add(text).text] = position
        return ""

    # -- used where, and found ----------------------------------------------------------------------------------

    def on_about(self, position):
        """What an element speaks of: each of its devices, as a plate takes it, and every place where it is used.

        Gives a dict for each device with label, name, what, `written` here or only read, and `places`:
        [network from 0, position, unit, network as it is numbered, step, words].
        """
        instruction = self.rig.instructions[int(position)]
        return [
            {"label": _label(operand, spec, instruction), "written": spec.written, "places": self._places_of(operand)}
            | dict(zip(("name", "what"), self.rig.point(str(operand)), strict=True))
            for operand, spec in _devices(instruction)
        ]

    def _places_of(self, wanted: Device | Bits) -> list[list]:
        """Where a device is used, alone, in a Kn string or among the registers of a longer value, in the program's order."""
        found = []
        for instruction in self.rig.instructions:
            uses = {spec.written for operand, spec in _devices(instruction) if _meet(operand, spec, wanted)}
            if uses:
                found.append(self._place(instruction.position, f"{instruction.mnemonic} {'writes' if True in uses else 'reads'}"))
        return [place for place in found if place][:MOST_PLACES]

    def _place(self, position: int, words: str) -> list | None:
        """A place as a list has it; None in a unit that a password closes."""
        number = self._where(position)[0]
        entry = self.drawing.entries[number] if number >= 0 else None
        if entry is None or position > entry.words[-1].position:
            return None
        return [number, position, entry.unit.name, entry.rung.number + 1, self.rig.instructions[position].step, words]

    def on_find(self, text):
        """The places that a few letters lead to: a device (each of its uses), a program step, else what stands in the program."""
        text = " ".join(str(text).split())
        if not text:
            return []
        try:
            device = self.rig.plc.memory.parse(text, self.rig.plc._names)[0]
        except EcsimError:
            pass
        else:
            return self._places_of(device)
        return [place for place in self._found(text.lower()) if place][:MOST_PLACES]

    def _found(self, text: str) -> Iterator[list | None]:
        """Networks and program steps of that number; titles, comments, names and instructions that have the letters in them."""
        for entry in self.drawing.entries:
            head = entry.words[0]
            if text == str(entry.rung.number + 1):
                yield self._place(head.position, head.title or "network")
            elif text in head.title.lower():
                yield self._place(head.position, head.title)
            for word in entry.words:
                names = (entry.labels.of(word, place).name for place in range(len(word.operands)))
                if text == str(word.step) or text in f"{word} {' '.join(names)} {word.comment}".lower():
                    yield self._place(word.position, f"{word}{f' // {word.comment}' if word.comment else ''}")


def _runs(numbers: Iterable[int]) -> list[int]:
    """Rising numbers as runs of neighbours: [first, last, first, last ...]."""
    runs: list[int] = []
    for number in numbers:
        if runs and number == runs[-1] + 1:
            runs[-1] = number
        else:
            runs += [number, number]
    return runs


def _devices(instruction: Instruction) -> list[tuple[Device | Bits, OperandSpec]]:
    """The operands that are a fixed device; where an index points changes with every scan."""
    pairs = zip(instruction.operands, instruction.definition.operands, strict=False)
    return [(operand, spec) for operand, spec in pairs if isinstance(operand, Device | Bits) and operand.index is None]


def _label(operand: Device | Bits, spec: OperandSpec, instruction: Instruction) -> str:
    """A device as it is read there: T0 as a contact, D0 as one register or as two."""
    if isinstance(operand, Bits):
        return str(operand)
    if operand.area in ("T", "C"):
        return f"{operand}:BOOL" if spec.type is BOOL else str(operand)
    return f"{operand}:{spec.type.name}" if spec.type.words > 1 and spec.plain else str(operand)


def _meet(operand: Device | Bits, spec: OperandSpec, wanted: Device | Bits) -> bool:
    """Whether an operand reaches a device that is looked for."""
    count = 4 * operand.digits if isinstance(operand, Bits) else max(1, spec.type.words) * (spec.span if isinstance(spec.span, int) else 1)
    size = 4 * wanted.digits if isinstance(wanted, Bits) else 1
    return operand.area == wanted.area and operand.number < wanted.number + size and wanted.number < operand.number + count
