"""What a transition waits for, in words: the parts of its condition that do not hold, names before addresses."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ecsim.engines import Trace
from ecsim.views.conditions import compare_words, phrase
from ecsim.views.flows import Transition
from ecsim.views.labels import EDGES as CONTACTS
from ecsim.views.labels import Labels, compares, inverted
from ecsim.views.rungs import Block, Contact, Gate, Item, Parallel, Series, Word

EDGES = {"EU": "to rise", "ED": "to fall"}

# (name, device, words): a device under its name and what is asked of it; or words alone.
Phrase = tuple[str, str, str]
Met = Callable[[Word], bool]


def nothing_met(word: Word) -> bool:
    """For a condition told as a whole."""
    return False


def recorded(trace: Trace | None) -> Met:
    """What the last recorded scan says of a contact or an edge."""
    if trace is None:
        return nothing_met
    return lambda word: bool(trace.flow[word.position] if word.mnemonic in EDGES else trace.closed[word.position])


def phrases(transition: Transition, labels: Labels, met: Met = nothing_met) -> list[Phrase]:
    """The parts of a condition that are not met, each as a phrase; of several ways all are told."""
    parts = list(_parts(transition.condition.items))
    if not parts:
        return [("", "", "nothing, it is always true")]
    return [_phrase(part, labels) for part in parts if not all(_holds(item, met) for item in part)]


def sentence(transition: Transition, labels: Labels) -> str:
    """The whole condition as plain text: "Up X2 on and Start X5 to rise"."""
    told = phrases(transition, labels)
    return " and ".join(" ".join(filter(None, part)) for part in told) if transition.condition.items else "always"


def _parts(items: tuple[Item, ...]) -> Iterator[tuple[Item, ...]]:
    """The items one by one; those before an edge or an inversion belong to it."""
    last = max((place for place, item in enumerate(items) if isinstance(item, Gate)), default=-1)
    if last >= 0:
        yield items[: last + 1]
    for item in items[last + 1 :]:
        yield (item,)


def _phrase(part: tuple[Item, ...], labels: Labels) -> Phrase:
    first = part[0]
    if isinstance(first, Contact) and not compares(first.word):
        label = labels.contact(first.word)
        if len(part) == 1 and first.word.mnemonic in CONTACTS:
            return label.name, label.address, EDGES[CONTACTS[first.word.mnemonic]]
        if len(part) == 1:
            return label.name, label.address, "off" if inverted(first.word) else "on"
        if len(part) == 2 and isinstance(part[1], Gate) and part[1].word.mnemonic in EDGES and not inverted(first.word):
            return label.name, label.address, EDGES[part[1].word.mnemonic]
    if isinstance(first, Contact) and len(part) == 1:
        return "", "", compare_words(first.word, labels)
    return "", "", phrase(Series(part), labels)


def _holds(item: Item, met: Met) -> bool:
    if isinstance(item, Contact | Gate):
        return met(item.word)
    if isinstance(item, Block):
        return all(_holds(inner, met) for inner in item.flow.items)
    if isinstance(item, Parallel):
        return any(all(_holds(inner, met) for inner in _items(way)) for way in item.ways)
    return True


def _items(way: Series | Contact | Block) -> tuple[Item, ...]:
    return (way,) if isinstance(way, Contact) else way.flow.items if isinstance(way, Block) else way.items
