"""TABLE as a model spells it: which rows its programs can name, how, and in which words it tells of them."""

import re
from collections.abc import Callable
from functools import cache

from ..models.model import By, Model
from .define import TABLE, Definition


def instructions_of(model: Model) -> dict[str, Definition]:
    """The name in a program -> its row, the usual one where the first operand decides; without the pulse forms."""
    if not model.spelling:
        return {mnemonic: row for mnemonic, row in TABLE.items() if model.name in row.models}
    return {spelled: TABLE[meant.keys[0] if isinstance(meant, By) else meant] for spelled, meant in model.spelling.items()}


def section_of(model: Model, spelled: str, row: Definition) -> str:
    """Where the family's manual has an instruction under that name, with the pulse suffix or without."""
    if not model.functions:
        return row.section
    return model.functions.get(spelled) or model.functions.get(spelled.removesuffix(model.pulse_suffix)) or row.section


_PLACE = re.compile(r"\s*\((?:(?:see )?\d+\.\d[\d.]*(?:, \d[\d.]*)*|S[MD]\d+)\)")  # places and relays of the manual whose words they are
_CODE = re.compile(r"\berror (\d+)\b")


@cache
def _first(function: Callable) -> Definition:
    """The row that the words of a function were written for: the first of those that share it."""
    return next(row for row in TABLE.values() if row.function is function)


def told(model: Model, row: Definition, words: str) -> str:
    """What the function of a row says of itself as the model says it: with its own row's operands, the model's codes, without EC's sections."""
    if not model.spelling:
        return words
    names = {spec.name: own.name for spec, own in zip(_first(row.function).operands, row.operands, strict=True)}
    if names:
        words = re.sub(rf"\b({'|'.join(names)})\b", lambda match: names[match[1]], words)
    return _CODE.sub(lambda match: f"error {model.fault_code(int(match[1]))}", _PLACE.sub("", words))


def pulse_forms_of(model: Model) -> dict[str, Definition]:
    """The names with the model's pulse suffix -> their row; a name that belongs to another instruction stays with it."""
    own = instructions_of(model)
    return {
        spelled + model.pulse_suffix: row
        for spelled, row in own.items()
        if model.pulse_suffix and row.pulses and spelled + model.pulse_suffix not in own
    }


def choices_of(model: Model) -> dict[str, By]:
    """The names whose meaning depends on their operands, those with the pulse suffix too -> the choice."""
    choices = {spelled: meant for spelled, meant in model.spelling.items() if isinstance(meant, By)}
    rising = pulse_forms_of(model)
    return choices | {spelled + model.pulse_suffix: meant for spelled, meant in choices.items() if spelled + model.pulse_suffix in rising}
