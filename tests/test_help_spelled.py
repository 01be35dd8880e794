"""Help on the instructions of H1U and H2U: every one has its page, with its forms, the devices of the model, and how sure it is."""

import json
import re
from itertools import takewhile
from pathlib import Path

import pytest

import ecsim
from ecsim.cli import main
from ecsim.help import Heading, Rows, Words
from ecsim.help_spelled import Group, SpelledContents, SpelledPage, groups, names_of
from ecsim.models import MODELS

ROOT = Path(__file__).resolve().parent.parent
H2U = MODELS["H2U"]
FACTS = json.loads((ROOT / "tests/facts/instructions_h2u.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", sorted(names_of(H2U)))
def test_every_instruction_has_a_page(name):
    page = ecsim.help(name, "H2U")
    text = str(page)
    assert text.startswith(f"{name}\n\n")
    assert "FX:" not in text
    assert not re.search(r"\bSM\d|\bSD\d|\bLM\b|chapter", text), text
    for form in page.forms:
        assert str(ecsim.help(form, "H2U")) == text


@pytest.mark.parametrize("row", [row for row in FACTS if row["mnemonic"] in names_of(H2U)], ids=lambda row: row["mnemonic"])
def test_a_page_says_how_sure_it_is(row):
    text = " ".join(str(ecsim.help(row["mnemonic"], "H2U")).split())
    assert ("the manual names it" in text) == (row["source"] == "manual")
    rules = [rule for each in FACTS if each["mnemonic"].partition(" ")[0] == row["mnemonic"] for rule in each["rules"]]
    assert ("known from the manual" in text) == any(rule.startswith("[manual]") for rule in rules)
    assert ("references of the family and" in text or "references of the family " in text.partition("is known from")[2]) == any(
        rule.startswith("[fx") for rule in rules
    )
    bare = [each for each in FACTS if each["mnemonic"].partition(" ")[0] == row["mnemonic"] and not each["rules"]]
    assert ("general knowledge" in text) == (bool(bare) or any(not rule.startswith(("[manual]", "[fx")) for rule in rules))


def test_the_section_is_the_function_number_and_the_models_are_told():
    text = str(ecsim.help("ror", "h2u"))
    assert "manual FNC 30" in text
    assert "models: H2U" in text
    assert "forms: ROR, RORP, DROR, DRORP" in text
    assert "carry (M8022)" in text
    assert "models: H1U, H2U" in str(ecsim.help("ADD", "H2U"))


@pytest.mark.parametrize("name", sorted(names_of(H2U)))
def test_a_page_speaks_of_its_own_operands_and_of_the_codes_of_the_family(name):
    page = ecsim.help(name, "H2U")
    told = [part.words for part in takewhile(lambda part: part != Heading("Example"), page.parts) if isinstance(part, Words)]
    named = {cells[0] for part in page.parts if isinstance(part, Rows) for cells in part.rows}
    devices = {"IST": {"S0", "S1", "S2"}, "PRUN": {"M", "M0", "M7"}, "SET": {"S"}, "OUT": {"S", "M8"}}.get(name, set())
    assert {word for words in told for word in re.findall(r"\b[SDMN]\d?\b", words)} - named == devices - named
    codes = {int(code) for code in re.findall(r"\berror (\d+)|^  (\d+): ", str(page), re.MULTILINE) for code in code if code}
    assert codes <= set(H2U.fault_codes.values())


def test_a_page_of_an_instruction_that_both_families_have_names_the_operands_of_the_model():
    assert "The N1 bits from D on move N2 places to lower numbers; the N2 bits from S on come in" in str(ecsim.help("SFTR", "H2U"))
    assert "The S2 bits from D on move S3 places to lower numbers; the S3 bits from S1 on come in" in str(ecsim.help("SFTR"))
    assert "division by 0 is error 6706" in str(ecsim.help("EDIV", "H2U"))
    assert "6706: division by zero" in str(ecsim.help("EDIV", "H2U"))
    assert "69: division by zero" in str(ecsim.help("RDIV"))


def test_pointers_are_told_as_they_are_written():
    assert "\n    Pn\n" in str(ecsim.help("P", "H2U"))
    assert re.search(r"^  n +read +INT +no +P +P0 to P127$", str(ecsim.help("P", "H2U")), re.MULTILINE)
    assert re.search(r"^  S +read .* P +P0 to P127$", str(ecsim.help("CJ", "H2U")), re.MULTILINE)


def test_a_label_begins_subroutines_as_well():
    assert "begins a subroutine" in ecsim.help("P", "H2U").title


def test_every_instruction_has_an_example():
    assert [name for name in names_of(H2U) if ecsim.help(name, "H2U").example is None] == []


def test_all_forms_of_out_are_on_its_page():
    text = str(ecsim.help("OUT", "H2U"))
    for words in ("C0 to C199", "C200 to C234", "C235 to C255", "On-delay", "Count the flow"):
        assert words in text


def test_an_instruction_that_only_the_other_family_has_is_found_without_a_model():
    assert isinstance(ecsim.help("SMOV"), SpelledPage)
    assert ecsim.help("ROR").definition.mnemonic == "ROR"


def test_what_a_model_has_not_is_refused_with_what_is_near():
    with pytest.raises(ecsim.EcsimError, match="there is no instruction 'TON'"):
        ecsim.help("TON", "H2U")
    with pytest.raises(ecsim.EcsimError, match="there is no instruction 'SMOV'"):
        ecsim.help("SMOV", "H1U")
    with pytest.raises(ecsim.EcsimError, match=r"did you mean RORP?"):
        ecsim.help("RORR", "H2U")


def test_groups_and_contents():
    contents = ecsim.help(model="H2U")
    assert isinstance(contents, SpelledContents)
    assert set(names_of(H2U)) <= set(str(contents).split())
    group = ecsim.help("FNC 30", "H2U")
    assert isinstance(group, Group)
    assert [row[0] for row in group.parts[1].rows] == groups(H2U)["FNC 30"] == "ROR ROL RCR RCL SFTR SFTL WSFR WSFL SFWR SFRD".split()


def test_the_shell_tells_the_same(capsys):
    assert main(["help", "ror", "--model", "H2U"]) == 0
    assert capsys.readouterr().out == f"{ecsim.help('ROR', 'H2U')}\n"
    assert main(["help", "--model", "H1U"]) == 0
    assert "ZRST" in capsys.readouterr().out
