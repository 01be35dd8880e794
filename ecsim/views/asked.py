"""What a breakpoint at an element of the ladder asks, in the language of `ecsim.conditions`: "not X6", "D10 < 12", "X0 and (M1 or M2)"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..devices import Bits, Constant, Device, Operand
from ..instructions import TABLE
from ..models import Model
from ..values import BOOL, DataType
from .flows import leaves
from .labels import COILS, EDGES, compares, inverted, operand_type, sign
from .rungs import Block, Contact, Fork, Item, Parallel, Rung, Series, Word
from .symbols import counts


def asked(rung: Rung, model: Model) -> dict[int, str]:
    """What a breakpoint at each element of a rung asks, by position; an element of which nothing can be asked is left out.

    At a contact that it is closed, at a coil that its bit is as the coil makes it, at a timer or counter that it has reached
    its preset, at a step that it is active, at another box that power comes to it.
    """
    texts = {word.position: _contact(word, model) for word in _contacts(rung.flow.items)}
    for condition, outputs in leaves(rung.flow):
        for word in outputs:
            texts[word.position] = _of_bit(word, model) if _has_bit(word) else _series(condition.items, model)
    return {position: text for position, text in texts.items() if text}


def _contacts(items: Sequence[Item]) -> Iterator[Word]:
    for item in items:
        if isinstance(item, Contact):
            yield item.word
        elif isinstance(item, Block):
            yield from _contacts(item.flow.items)
        elif isinstance(item, Parallel):
            for way in item.ways:
                yield from _contacts(_items(way))
        elif isinstance(item, Fork):
            for branch in item.branches:
                yield from _contacts(branch.items)


def _items(way: Series | Contact | Block) -> Sequence[Item]:
    return way.items if isinstance(way, Series) else (way,)


def _has_bit(word: Word) -> bool:
    """Whether an output speaks of a bit of its own: a coil, a timer or counter, a step."""
    if not word.operands:
        return False
    specs = TABLE[word.mnemonic].operands
    return word.mnemonic in COILS or counts(word) or (bool(specs) and specs[0].kind == "STEP")


def _of_bit(word: Word, model: Model) -> str:
    bit = _operand(word.operands[0], BOOL, model)
    return f"not {bit}" if bit and word.mnemonic == "RST" else bit


def _series(items: Sequence[Item], model: Model) -> str:
    """A condition in series; "" where a part of it cannot be asked of the memory, as an edge, or where there is none."""
    texts: list[str] = []
    for item in items:
        if isinstance(item, Contact):
            texts.append(_contact(item.word, model))
        elif isinstance(item, Block):
            texts.append(_series(item.flow.items, model))
        elif isinstance(item, Parallel):
            ways = [_series(_items(way), model) for way in item.ways]
            texts.append(f"({' or '.join(ways)})" if all(ways) else "")
        elif item.word.mnemonic == "INV":
            whole = " and ".join(texts) if all(texts) else ""
            texts = [f"not ({whole})" if whole else ""]
        else:
            texts.append("")
    return " and ".join(texts) if all(texts) else ""


def _contact(word: Word, model: Model) -> str:
    if compares(word):
        left, right = (_operand(operand, operand_type(word, place), model) for place, operand in enumerate(word.operands))
        return f"{left} {sign(word, pretty=False).lstrip('DR')} {right}" if left and right else ""
    bit = _operand(word.operands[0], BOOL, model) if len(word.operands) == 1 and word.mnemonic not in EDGES else ""
    return f"not {bit}" if bit and inverted(word) else bit


def _operand(operand: Operand, kind: DataType | None, model: Model) -> str:
    """An operand as a condition reads it; "" for what is there only at a moment of the scan, as an indexed register or a V."""
    if isinstance(operand, Constant):
        return f"{operand.value:f}" if isinstance(operand.value, float) else str(operand.value)
    if not isinstance(operand, Device | Bits) or kind is None or operand.index is not None or operand.area in model.local_areas:
        return ""
    plain = kind is BOOL or kind.words == 1 or isinstance(operand, Bits) or model.areas[operand.area].kind == "counter"
    return str(operand) if plain else f"{operand}:{kind.name}"
