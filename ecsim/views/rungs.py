"""A rung as a tree, both ways: instruction list -> series, parallels, outputs, branches -> the same instruction list.

The tree keeps what the drawing does not tell: whether a single contact stands in series by AND or as a block with ANB,
whether outputs behind one another are a cascade or branches of MPS, and the comment of every instruction, also of ANB or MPP.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from ..assembler.program import Instruction, Network, Program, Unit, wording
from ..devices import Operand
from ..instructions import TABLE


@dataclass(frozen=True, slots=True)
class Word:
    """One instruction as it is written; `position` and `step` say where it stood in the program, -1 for one that is new.

    `spelled` is the mnemonic as its family writes it, where that differs from TABLE's.
    """

    mnemonic: str
    written: tuple[str, ...] = ()
    comment: str = ""
    title: str = ""
    spelled: str = ""
    operands: tuple[Operand, ...] = field(default=(), compare=False)
    position: int = field(default=-1, compare=False)
    step: int = field(default=-1, compare=False)

    @property
    def name(self) -> str:
        """The mnemonic as its family writes it."""
        return self.spelled or self.mnemonic

    def __str__(self) -> str:
        return wording(self.name, self.written)


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact. `word` has the mnemonic that would load it (LD, LDI, LD=); its place in the tree tells LD, AND and OR apart.

    `join` is the place for which it was spelled.
    """

    word: Word
    join: str = field(default="LD", compare=False)


@dataclass(frozen=True, slots=True)
class Gate:
    """An element that changes the flow that comes to it: EU, ED, INV."""

    word: Word


@dataclass(frozen=True, slots=True)
class Block:
    """Contacts that begin with a load of their own; `join` is the ANB or ORB behind them."""

    flow: Series
    join: Word | None


@dataclass(frozen=True, slots=True)
class Parallel:
    """Ways side by side: the first as a series, each further one a contact (OR) or a block (ORB)."""

    ways: tuple[Series | Contact | Block, ...]


@dataclass(frozen=True, slots=True)
class Output:
    """A coil or a function box; the flow goes on behind it."""

    word: Word


@dataclass(frozen=True, slots=True)
class Fork:
    """Branches from one kept flow: `keep` is the MPS, `turns` the MRD before each further branch and the MPP before the last."""

    keep: Word
    branches: tuple[Series, ...]
    turns: tuple[Word, ...]


Item = Contact | Gate | Block | Parallel | Output | Fork


@dataclass(frozen=True, slots=True)
class Series:
    """Items one behind the other; a Parallel stands only first, a Fork only last."""

    items: tuple[Item, ...] = ()


@dataclass(frozen=True, slots=True)
class Rung:
    """One network: its number, what encloses it (outermost first) and its flow from the left bus on."""

    number: int
    flow: Series
    region: tuple[tuple[str, int], ...] = ()

    @property
    def head(self) -> Word:
        """Its first instruction."""
        return next(words(self.flow))

    @property
    def title(self) -> str:
        """The comment above it."""
        return self.head.title

    @property
    def words(self) -> list[Word]:
        """Its instruction list."""
        return list(words(self.flow))


# Each contact by the way it joins the flow: {"LD": {"AND": "AND", "OR": "OR"}, "LD=": {"AND": "AND=", ...}, ...}
_JOINED: dict[str, dict[str, str]] = {}
# Each contact by its mnemonic: the one that loads it.
_LOAD: dict[str, str] = {}


def _tabulate() -> None:
    """Contacts that mean the same differ in `join` alone: functions of the same name in the same chapter, the same operands."""
    kinds: dict[tuple, dict[str, str]] = {}
    for mnemonic, row in TABLE.items():
        if row.form == "contact":
            what = row.function.__module__, row.function.__name__, tuple(operand.kind for operand in row.operands)
            kinds.setdefault(what, {})[row.join] = mnemonic
    for joins in kinds.values():
        _JOINED[joins["LD"]] = joins
        _LOAD.update(dict.fromkeys(joins.values(), joins["LD"]))


_tabulate()


# -- from the instruction list ----------------------------------------------------------------------------------


def rungs(unit: Unit) -> list[Rung]:
    """Every network of a unit as a rung, in order."""
    return [rung(unit, network) for network in unit.networks]


def rung(unit: Unit, network: Network) -> Rung:
    """One network of a unit as a rung."""
    parser = _Parser()
    for index in range(network.start, network.end):
        instruction = unit.instructions[index]
        parser.take(instruction, unit.titles.get(index, ""))
    return Rung(network.number, parser.finish(), network.region)


def unit_of(network: Network, program: Program) -> Unit:
    """The unit that a network belongs to."""
    for unit in program.units:
        if any(own is network for own in unit.networks):
            return unit
    raise ValueError("the network is of another program")


@dataclass(slots=True)
class _Branching:
    """A fork being read: what stood before it, its finished branches, and whether its last one has begun."""

    before: list[Item]
    keep: Word
    branches: list[Series] = field(default_factory=list)
    turns: list[Word] = field(default_factory=list)
    last: bool = False


class _Parser:
    """Reads the instructions of one rung."""

    def __init__(self) -> None:
        self.items: list[Item] = []  # the flow from the bus, or of the branch being read
        self.blocks: list[list[Item]] = []  # blocks begun by a load and not yet joined to it
        self.forks: list[_Branching] = []

    def take(self, instruction: Instruction, title: str) -> None:
        definition = instruction.definition
        mnemonic = _LOAD[instruction.mnemonic] if definition.form == "contact" else instruction.mnemonic
        places = instruction.operands, instruction.position, instruction.step
        word = Word(mnemonic, instruction.written, instruction.comment, title, instruction.spelled, *places)
        if definition.form == "contact":
            {"LD": self.load, "AND": self.and_, "OR": self.or_}[definition.join](Contact(word, definition.join))
        else:
            _STRUCTURAL.get(mnemonic, _Parser.output)(self, word)

    def load(self, contact: Contact) -> None:
        if self.items or self.blocks or self.forks:
            self.blocks.append([contact])
        else:
            self.items.append(contact)

    def and_(self, contact: Contact) -> None:
        self._newest().append(contact)

    def or_(self, contact: Contact) -> None:
        self._bridge(contact)

    def anb(self, word: Word) -> None:
        block = Block(Series(tuple(self.blocks.pop())), word)
        self._newest().append(block)

    def orb(self, word: Word) -> None:
        self._bridge(Block(Series(tuple(self.blocks.pop())), word))

    def gate(self, word: Word) -> None:
        self._newest().append(Gate(word))

    def output(self, word: Word) -> None:
        self._join_loose()
        self.items.append(Output(word))

    def mps(self, word: Word) -> None:
        self._join_loose()
        self.forks.append(_Branching(self.items, word))
        self.items = []

    def mrd(self, word: Word) -> None:
        self._join_loose()
        self._close_forks()
        fork = self.forks[-1]
        fork.branches.append(Series(tuple(self.items)))
        fork.turns.append(word)
        self.items = []

    def mpp(self, word: Word) -> None:
        self.mrd(word)
        self.forks[-1].last = True

    def finish(self) -> Series:
        self._join_loose()
        self._close_forks()
        return Series(tuple(self.items))

    def _newest(self) -> list[Item]:
        return self.blocks[-1] if self.blocks else self.items

    def _bridge(self, way: Contact | Block) -> None:
        """Put a way beside all of the newest block."""
        block = self._newest()
        if len(block) == 1 and isinstance(block[0], Parallel):
            block[:] = [Parallel((*block[0].ways, way))]
        else:
            block[:] = [Parallel((Series(tuple(block)), way))]

    def _join_loose(self) -> None:
        """A block behind a fork from the bus itself needs no ANB: there is nothing before it."""
        while self.blocks:
            block = Block(Series(tuple(self.blocks.pop())), None)
            self._newest().append(block)

    def _close_forks(self) -> None:
        while self.forks and self.forks[-1].last:
            fork = self.forks.pop()
            branches = (*fork.branches, Series(tuple(self.items)))
            self.items = [*fork.before, Fork(fork.keep, branches, tuple(fork.turns))]


_STRUCTURAL = {
    "ANB": _Parser.anb, "ORB": _Parser.orb,
    "MPS": _Parser.mps, "MRD": _Parser.mrd, "MPP": _Parser.mpp,
    "EU": _Parser.gate, "ED": _Parser.gate, "INV": _Parser.gate,
}  # fmt: skip


# -- back to the instruction list --------------------------------------------------------------------------------


def words(flow: Series, loads: bool = True) -> Iterator[Word]:
    """The instruction list of a series; `loads` tells that it begins a block, so that a contact at its head is an LD."""
    waiting: list[tuple[Item | Series | Word, str]] = [(flow, "LD" if loads else "AND")]
    while waiting:
        node, join = waiting.pop()
        if isinstance(node, Word):
            yield node
        elif isinstance(node, Contact):
            yield _joined(node, join)
        elif isinstance(node, Gate | Output):
            yield node.word
        else:
            waiting += reversed(list(_parts(node, join)))


def _parts(node: Item | Series, join: str) -> Iterator[tuple[Item | Series | Word, str]]:
    """What a node is made of, in the order of the instruction list, and how a contact there joins the flow."""
    if isinstance(node, Series):
        for place, item in enumerate(node.items):
            yield item, "AND" if place else join
    elif isinstance(node, Block):
        yield node.flow, "LD"
        if node.join:
            yield node.join, ""
    elif isinstance(node, Parallel):
        for place, way in enumerate(node.ways):
            yield way, "OR" if place else "LD"
    else:
        for turn, branch in zip((node.keep, *node.turns), node.branches, strict=True):
            yield turn, ""
            yield branch, "AND"


def depth(flow: Series) -> int:
    """How deep a tree is nested; an output with something behind it counts, as its branch does in the drawing."""
    deepest = 0
    waiting: list[tuple[Item | Series | Word, int]] = [(flow, 1)]
    while waiting:
        node, level = waiting.pop()
        deepest = max(deepest, level)
        if isinstance(node, Series):
            level += sum(isinstance(a, Output) and not isinstance(b, Output) for a, b in pairwise(node.items))
        if isinstance(node, Series | Block | Parallel | Fork):
            waiting += [(part, level + 1) for part, _ in _parts(node, "")]
    return deepest


def _joined(contact: Contact, join: str) -> Word:
    """The contact's word in its place."""
    word = contact.word
    mnemonic, spelled = _JOINED[word.mnemonic][join], word.spelled if contact.join == join else ""
    if (mnemonic, spelled) == (word.mnemonic, word.spelled):
        return word
    return Word(mnemonic, word.written, word.comment, word.title, spelled, word.operands, word.position, word.step)


def instruction_list(tree: Rung | Series | Sequence[Rung]) -> list[Word]:
    """The instructions that a rung, a series or several rungs are drawn from, in order."""
    if isinstance(tree, Rung):
        return tree.words
    if isinstance(tree, Series):
        return list(words(tree))
    return [word for rung in tree for word in rung.words]
