"""What to write instead of a word of the other family: special devices by their meaning, instructions by where they exist."""

import re

from ..instructions.spelling import instructions_of, pulse_forms_of
from ..models import MODELS, Model

_SPECIAL = re.compile(r"(SM|SD|M|D)(\d{1,4})")


def special_device(text: str, model: Model) -> str:
    """The model's special device that means the same as one of another family: M8000 for SM0; "" where there is none."""
    match = _SPECIAL.fullmatch(text.upper())
    if match is None:
        return ""
    area, number = match[1], int(match[2])
    for other in MODELS.values():
        if other.family == model.family or number < other.first_special:
            continue
        for where, theirs, ours in (
            (other.special_bits, other.relays, model.relays),
            (other.special_words, other.registers, model.registers),
        ):
            meaning = next((meaning for meaning, own in theirs.items() if own == number and meaning in ours), None)
            if where == area and meaning and meaning not in ("counter direction", "clock"):  # whose parts stand in another order
                here = model.special_bits if where == other.special_bits else model.special_words
                return f"write {here}{ours[meaning]} ({meaning})"
    return ""


def elsewhere(name: str, model: Model) -> str:
    """On which models an instruction exists that this one has not, on those of its family if on one of them; "" where on none."""
    others = [
        other for other in MODELS.values() if other is not model and (name in instructions_of(other) or name in pulse_forms_of(other))
    ]
    kin = [other for other in others if other.family == model.family]
    return f"{name} exists on {' and '.join(other.name for other in kin or others)}" if others else ""
