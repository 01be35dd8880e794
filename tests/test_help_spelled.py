"""Help on the instructions of H1U and H2U: every one has its page, with its forms, the devices of the model, and how sure it is."""

import json
import re
from pathlib import Path

import pytest

import ecsim
from ecsim.cli import main
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
