"""The instructions of H1U and H2U against their catalogue (a copy stands in tests/facts): names, models, operands, widths, pulse forms."""

import json
import re
from pathlib import Path

import pytest

from ecsim.assembler.operands import Resolver
from ecsim.instructions import TABLE
from ecsim.instructions.spelling import instructions_of, pulse_forms_of, section_of
from ecsim.models import MODELS, By
from ecsim.models.fx_spelling import REFERENCE, plain

ROOT = Path(__file__).resolve().parent.parent.parent
FACTS = {row["mnemonic"]: row for row in json.loads((ROOT / "tests/facts/instructions_h2u.json").read_text(encoding="utf-8"))}
H2U, H1U = MODELS["H2U"], MODELS["H1U"]
BY_OPERAND = {"OUT T", "OUT C", "OUT C200"}  # rows of the catalogue that are OUT with another first operand
NAMES = {name: [spelled for spelled in H2U.spelling if plain(spelled) == name] for name in FACTS if name not in BY_OPERAND}
DONE = sorted(NAMES)
MARKS = ("P", "I")  # the catalogue gives a pointer on its own line no operand
# Operands whose devices are others than the catalogue's, and why.
BLOCKS = "a run of words in bits is written KnY, KnM or KnS, as everywhere"
REGISTERS = "V and Z are registers too"
OTHERS = {
    **{(name, "D"): BLOCKS for name in ("BMOV", "WSFR", "WSFL", "SFWR", "SER", "DSER", "ASCI", "CCD")},
    ("SFRD", "S"): BLOCKS,
    ("OUT", "D"): "timers and counters have a preset besides: the rows of section 3.5 and 3.6",
    ("SET", "D"): "a timer or counter is refused by a row of its own",
    ("PLS", "D"): "Y and M only, as the rules beside say",
    ("PLF", "D"): "Y and M only, as the rules beside say",
    ("CALL", "P"): "the name of a subroutine is its pointer",
    ("REF", "D"): "inputs and outputs only, as the rules beside say",
    ("DHSCS", "D"): "I010 to I060 too, as the rules beside say",
    ("ASC", "S"): "characters are no constant",
    **dict.fromkeys((("HKY", "D2"), ("DSW", "D2"), ("ARWS", "D1"), ("ASC", "D")), REGISTERS),
}
REGISTERS_OF_16_BITS = {"T", "V", "Z"}  # a 32-bit number lies in Z at most where the instruction has one of them (docs/decisions.md)


def rows_of(spelled):
    meant = H2U.spelling[spelled]
    return [TABLE[key] for key in (meant.keys if isinstance(meant, By) else (meant,))]


def in_the_model(spec):
    """The areas of an operand that H2U has."""
    return {area for area in Resolver(H2U, {}).areas(spec) if area not in ("routine", "text")}


def printed(devices):
    """The areas that the catalogue names."""
    found = set()
    for device in devices:
        word = device.split(" ")[0]
        found.add("const" if word in ("K", "H", "E", "P", "characters", "N0..N7") else re.match(r"[A-Z][a-z]?[A-Z]?", word)[0])
    return found


def test_every_instruction_of_the_catalogue_can_be_written():
    assert [name for name in NAMES if not NAMES[name]] == []


def test_no_name_is_unknown_to_the_catalogue():
    assert [spelled for spelled in H2U.spelling if plain(spelled) not in FACTS] == []


@pytest.mark.parametrize("name", DONE)
def test_h1u_has_what_the_catalogue_gives_it(name):
    assert all((spelled in H1U.spelling) == ("H1U" in FACTS[name]["models"]) for spelled in NAMES[name])
    for spelled in NAMES[name]:
        assert all(row.models != ("H2U",) or "H1U" not in FACTS[name]["models"] for row in rows_of(spelled)), spelled


@pytest.mark.parametrize("name", [name for name in DONE if FACTS[name]["width"]])
def test_an_instruction_has_its_widths(name):
    wide = {spelled != name and spelled not in ("TD", "P") and spelled[:1] in "DLAO" for spelled in NAMES[name]}
    assert wide == {width == "32" for width in FACTS[name]["width"]}


@pytest.mark.parametrize("name", DONE)
def test_the_pulse_forms_are_the_catalogue_s(name):
    forms = pulse_forms_of(H2U)
    assert all((f"{spelled}P" in forms) == FACTS[name]["pulse"] for spelled in NAMES[name])


@pytest.mark.parametrize("name", [name for name in DONE if name not in MARKS])
def test_the_operands_lie_where_the_catalogue_says(name):
    for spelled in NAMES[name]:
        rows = rows_of(spelled)
        for place, operand in enumerate(FACTS[name]["operands"]):
            found = set().union(*(in_the_model(row.operands[place]) for row in rows))
            wanted = printed(operand["devices"])
            if rows[0].operands[place].type.words == 2:
                found, wanted = found - REGISTERS_OF_16_BITS, wanted - REGISTERS_OF_16_BITS
            if (spelled, operand["name"]) in OTHERS:
                assert found != wanted, f"{spelled} {operand['name']} is as the catalogue says now"
            else:
                assert found == wanted, (spelled, operand["name"])


@pytest.mark.parametrize("name", [name for name in DONE if name not in MARKS])
def test_an_instruction_takes_as_many_operands_as_the_catalogue_says(name):
    more = 1 if name == "OUT" else 0  # the preset of a timer or counter
    for spelled in NAMES[name]:
        assert {len(row.operands) for row in rows_of(spelled)} <= {len(FACTS[name]["operands"]) + n for n in range(more + 1)}


@pytest.mark.parametrize("name", DONE)
def test_the_section_is_the_function_number(name):
    number = FACTS[name]["fnc"]
    for spelled in NAMES[name]:
        section = section_of(H2U, spelled, rows_of(spelled)[0])
        assert section == f"FNC {number}" if number else section in ("4.1", "4.1.1", "3.8")


def test_it_is_told_what_is_known_from_the_reference_alone():
    assert {name for name, row in FACTS.items() if row["source"] != "manual"} == REFERENCE


def test_the_other_family_has_none_of_these_rows():
    assert [name for name in instructions_of(MODELS["EC20"]) if name.startswith("FX:")] == []
