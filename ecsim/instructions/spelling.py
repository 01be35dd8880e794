"""TABLE as a model spells it: which rows its programs can name, and how."""

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


def pulse_forms_of(model: Model) -> dict[str, Definition]:
    """The names with the model's pulse suffix -> their row; a name that belongs to another instruction stays with it."""
    own = instructions_of(model)
    return {
        spelled + model.pulse_suffix: row
        for spelled, row in own.items()
        if model.pulse_suffix and row.pulses and spelled + model.pulse_suffix not in own
    }
