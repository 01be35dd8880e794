"""A step in words: what it does, what it waits for, and where it leads, read from the networks of its STL section."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from ecsim.assembler.program import Instruction, Network, Program, Region

EDGES = {"EU": "to rise", "ED": "to fall"}
ACTIONS = frozenset({"OUT", "SET", "RST", "TON", "TONR", "TOF", "TMON", "CTU", "CTR", "DCNT"})

# (name, device, words): a name and a device, what is asked of it; or words alone.
Phrase = tuple[str, str, str]


@dataclass(frozen=True, slots=True)
class Contact:
    """One condition: the device it looks at (or a comparison as text), what it asks, and where its answer stands in a trace."""

    device: str
    asks: str
    position: int
    edge: int | None = None  # position of the EU or ED behind it


@dataclass(frozen=True, slots=True)
class Transition:
    """The way from a step to others. `ways` says that one contact of several is enough somewhere."""

    targets: tuple[str, ...]
    contacts: tuple[Contact, ...]
    ways: bool


@dataclass(slots=True)
class Section:
    """What one step does and where it leads."""

    actions: list[str] = field(default_factory=list)
    transitions: list[Transition] = field(default_factory=list)

    @property
    def targets(self) -> list[str]:
        """The steps that may follow."""
        return list(dict.fromkeys(target for transition in self.transitions for target in transition.targets))


def sections(program: Program) -> dict[str, Section]:
    """Step -> its section, for every step of the program."""
    found: dict[str, Section] = {}
    for unit in program.units:
        for region in _stl_regions(unit.nodes):
            for step in region.steps:
                section = found.setdefault(str(step), Section())
                for network in (node for node in region.nodes if isinstance(node, Network)):
                    _read(unit.instructions[network.start : network.end], section)
    return found


def _stl_regions(nodes: list) -> Iterator[Region]:
    for node in nodes:
        if isinstance(node, Region):
            if node.kind == "STL":
                yield node
            yield from _stl_regions(node.nodes)


def _read(instructions: list[Instruction], section: Section) -> None:
    contacts: list[Contact] = []
    targets: list[str] = []
    ways = False
    for instruction in instructions:
        definition = instruction.definition
        if definition.form == "contact":
            contacts.append(_contact(instruction))
            ways = ways or definition.join == "OR"
        elif instruction.mnemonic in EDGES and contacts:
            last = contacts[-1]
            contacts[-1] = Contact(last.device, EDGES[instruction.mnemonic], last.position, instruction.position)
        elif instruction.mnemonic == "ORB":
            ways = True
        elif instruction.mnemonic in ("SET", "OUT") and instruction.operands[0].area == "S":
            targets.append(str(instruction.operands[0]))
        elif instruction.mnemonic in ACTIONS:
            device = str(instruction.operands[0])
            if device not in section.actions:
                section.actions.append(device)
    if targets:
        section.transitions.append(Transition(tuple(targets), tuple(contacts), ways))


def _contact(instruction: Instruction) -> Contact:
    if len(instruction.operands) > 1 or not instruction.mnemonic.isalnum():
        sign = instruction.mnemonic.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ")
        return Contact(f" {sign} ".join(map(str, instruction.operands)), "", instruction.position)
    inverted = bool(instruction.definition.function(False))
    return Contact(str(instruction.operands[0]), "off" if inverted else "on", instruction.position)


def phrases(transition: Transition, name: Callable[[str], str], met: Callable[[Contact], bool] = lambda contact: False) -> list[Phrase]:
    """What a transition waits for: its contacts that are not met, "always" when it asks nothing more."""
    missing = [contact for contact in transition.contacts if transition.ways or not met(contact)]
    words: list[Phrase] = []
    for contact in missing:
        if words:
            words.append(("", "", "or" if transition.ways else "and"))
        words.append((name(contact.device), contact.device, contact.asks))
    return words or [("", "", "always" if not transition.contacts else "nothing more")]


def sentence(words: list[Phrase]) -> str:
    """Phrases as plain text: "Up X2 on and Start X5 to rise"."""
    return " ".join(" ".join(filter(None, phrase)) for phrase in words)
