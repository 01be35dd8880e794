"""The sequential function chart as data, both ways: instruction list -> blocks and flows of steps -> the same instruction list.

A main program is made of ladder blocks, which are no concern of any step, and of flows: steps from STL to STL, ended by RET
(7.2.3). What stands in a step is kept as its rungs; actions and transitions are read out of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from ..assembler.program import Unit
from ..devices import Device
from ..instructions import TABLE
from .rungs import Contact, Fork, Gate, Item, Output, Rung, Series, Word, instruction_list, rungs

# The qualifier of an action; a function box has its mnemonic.
QUALIFIERS = {"OUT": "N", "SET": "S", "RST": "R"}


ALWAYS = Series()


@dataclass(frozen=True)
class Action:
    """Something that a step does while it is active, under a condition of its own when that has items."""

    word: Word
    condition: Series = ALWAYS

    @property
    def qualifier(self) -> str:
        """N, S or R for a coil, the mnemonic for a box."""
        return QUALIFIERS.get(self.word.mnemonic, self.word.name)


@dataclass(frozen=True)
class Transition:
    """Where a step leads when its condition holds: one target, or several at once. `ends` tells that it only resets its step."""

    condition: Series
    targets: tuple[Word, ...]
    ends: bool = False

    @property
    def steps(self) -> tuple[Device, ...]:
        """The steps that it leads to."""
        return () if self.ends else tuple(word.operands[0] for word in self.targets)

    @property
    def position(self) -> int:
        """The position of the instruction that fires it."""
        return self.targets[0].position


@dataclass(frozen=True)
class Step:
    """One STL with what belongs to it; several STL behind one another are a join, active when all of them are."""

    opening: Rung
    rungs: tuple[Rung, ...] = ()

    @property
    def devices(self) -> tuple[Device, ...]:
        """The step, or the steps that are joined."""
        return tuple(word.operands[0] for word in self.opening.words)

    @property
    def joins(self) -> bool:
        """Whether it is a join."""
        return len(self.opening.words) > 1

    @property
    def title(self) -> str:
        """The comment above it."""
        return self.opening.title

    @cached_property
    def _parts(self) -> tuple[tuple[Action, ...], tuple[Transition, ...]]:
        actions: list[Action] = []
        transitions: list[Transition] = []
        for rung in self.rungs:
            for condition, outputs in leaves(rung.flow):
                leading = [word for word in outputs if leads(word)]
                ending = [word for word in outputs if _resets(word) and word.operands[0] in self.devices]
                if leading:
                    transitions.append(Transition(condition, tuple(leading)))
                elif ending:
                    transitions.append(Transition(condition, tuple(ending), ends=True))
                actions += [Action(word, condition) for word in outputs if not leads(word) and (leading or word not in ending)]
        return tuple(actions), tuple(transitions)

    @property
    def actions(self) -> tuple[Action, ...]:
        """What it does, in the program's order."""
        return self._parts[0]

    @property
    def transitions(self) -> tuple[Transition, ...]:
        """Where it leads, in the program's order."""
        return self._parts[1]


@dataclass(frozen=True)
class Flow:
    """A section of steps; `end` is its RET."""

    steps: tuple[Step, ...]
    end: Rung | None = None


@dataclass(frozen=True)
class Block:
    """A ladder block: rungs outside every step."""

    rungs: tuple[Rung, ...]


Part = Block | Flow


def parts(unit: Unit) -> tuple[Part, ...]:
    """A unit taken apart into its ladder blocks and flows, in order."""
    found: list[Part] = []
    outside: list[Rung] = []
    steps: list[tuple[Rung, list[Rung]]] = []
    for rung in rungs(unit):
        head = rung.words[0]
        if _opens(head):
            if outside:
                found.append(Block(tuple(outside)))
                outside = []
            steps.append((rung, []))
        elif steps and TABLE[head.mnemonic].bus and not rung.region:
            found.append(Flow(_steps(steps), rung))
            steps = []
        elif steps:
            steps[-1][1].append(rung)
        else:
            outside.append(rung)
    if steps:
        found.append(Flow(_steps(steps)))
    if outside:
        found.append(Block(tuple(outside)))
    return tuple(found)


def part_list(parts: tuple[Part, ...]) -> list[Word]:
    """The instruction list that blocks and flows are drawn from."""
    return instruction_list([rung for part in parts for rung in part_rungs(part)])


def part_rungs(part: Part) -> Iterator[Rung]:
    """The rungs of a block or flow, in order."""
    if isinstance(part, Block):
        yield from part.rungs
        return
    for step in part.steps:
        yield step.opening
        yield from step.rungs
    if part.end:
        yield part.end


def _steps(steps: list[tuple[Rung, list[Rung]]]) -> tuple[Step, ...]:
    return tuple(Step(opening, tuple(inside)) for opening, inside in steps)


def _opens(word: Word) -> bool:
    return bool(word.operands) and TABLE[word.mnemonic].operands[0].kind == "STEP"


def leads(word: Word) -> bool:
    """Whether an output in a step leads to another step: SET S is the transition, OUT S the jump (5.3.2, 5.3.3)."""
    definition = TABLE[word.mnemonic]
    return bool(definition.transition_steps) and not definition.resets and _of_step(word)


def _resets(word: Word) -> bool:
    definition = TABLE[word.mnemonic]
    return bool(definition.transition_steps) and definition.resets and _of_step(word)


def _of_step(word: Word) -> bool:
    return isinstance(word.operands[0], Device) and word.operands[0].area == "S"


def leaves(flow: Series) -> Iterator[tuple[Series, list[Word]]]:
    """Every place in a rung where outputs hang, with the condition from the bus to there."""
    waiting: list[tuple[tuple[Item, ...], Series]] = [((), flow)]
    while waiting:
        before, series = waiting.pop()
        condition, outputs = list(before), []
        for item in series.items:
            if isinstance(item, Output):
                outputs.append(item.word)
            else:
                if outputs:
                    yield Series(tuple(condition)), outputs
                    outputs = []
                if isinstance(item, Fork):
                    waiting += [(tuple(condition), branch) for branch in reversed(item.branches)]
                else:
                    condition.append(item)
        if outputs:
            yield Series(tuple(condition)), outputs


def single(condition: Series) -> tuple[Word, Word | None] | None:
    """The one contact of a condition, and the edge that it waits for if any; None when there is more to it."""
    items = condition.items
    if not 1 <= len(items) <= 2 or not isinstance(items[0], Contact):
        return None
    if len(items) == 1:
        return items[0].word, None
    return (items[0].word, items[1].word) if isinstance(items[1], Gate) and items[1].word.mnemonic in ("EU", "ED") else None
