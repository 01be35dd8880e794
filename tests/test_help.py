"""Help on instructions: complete, from the table, with examples that hold, and the pages of the docs up to date."""

import importlib.util
import re
import sys
from pathlib import Path

import pytest

import ecsim
from ecsim.assembler.reader import HEADERS
from ecsim.cli import main
from ecsim.errors import WATCHDOG
from ecsim.help import OWN, Contents, Page, Section, examples, fault_codes, section_title, sections
from ecsim.help_spelled import named, names_of
from ecsim.instructions import TABLE
from ecsim.instructions.define import BOTH
from ecsim.models import MODELS
from ecsim.scenario import load_cases, run_case

ROOT = Path(__file__).resolve().parent.parent
BUILD = "python docs/build_instructions.py"


@pytest.fixture(scope="module")
def builder():
    """The script that writes the pages."""
    spec = importlib.util.spec_from_file_location("build_instructions", ROOT / "docs" / "build_instructions.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["build_instructions"] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("mnemonic", sorted(OWN))
def test_every_instruction_has_a_page_with_its_row(mnemonic):
    row, text = TABLE[mnemonic], str(ecsim.help(mnemonic))
    lines = text.split("\n")
    assert lines[0] == mnemonic
    assert " ".join(["   ", mnemonic, *(spec.name for spec in row.operands)]) in lines
    assert f"manual {row.section}, " in text
    assert f"models: {', '.join(row.models)}" in text
    for spec in row.operands:
        (line,) = [line for line in lines if line.split()[:1] == [spec.name] and spec.type.name in line.split()]
        assert set(spec.areas) <= set(
            line.replace("constant", "const").replace("name of a subroutine", "routine").replace("characters", "text").split()
        )
    for flag in row.flags:
        assert re.search(rf"\b{flag} \(SM18[012]\)", text)
    for code in row.faults:
        assert re.search(rf"^  {code}: ", text, re.MULTILINE)


@pytest.mark.parametrize(("mnemonic", "case"), examples().items(), ids=list(examples()))
@pytest.mark.parametrize("tracing", [False, True], ids=["compiled", "stepping"])
def test_every_example_comes_out_as_told(mnemonic, case, tracing):
    words = case["il"].upper().split()
    assert mnemonic.removeprefix("FX ") in ([named(word, MODELS["H2U"]) for word in words] if mnemonic.startswith("FX ") else words)
    for model in case["models"]:
        verdict = run_case(case, model, tracing)
        assert verdict.passed, str(verdict)


def test_what_can_go_wrong_is_told_of_every_case_that_goes_wrong():
    untold = set()
    for path in sorted((ROOT / "tests" / "conformance").glob("*.json")):
        for case in load_cases(path):
            names = {line.split()[0] for line in case["il"].upper().splitlines() if line.strip()}
            codes = {step.get("error", 0) for step in case.get("steps", [])} - {0, WATCHDOG}  # that one is the whole program's
            if codes and case["models"][0] in BOTH and case["mnemonic"].partition(" ")[0] in TABLE and names <= TABLE.keys() | HEADERS:
                told = {code for name in names & TABLE.keys() for code in fault_codes(TABLE[name])}
                untold |= {(case["mnemonic"], code) for code in codes - told}
    assert untold == set()


def test_the_pages_of_the_docs_are_up_to_date(builder):
    texts = builder.pages()
    written = {path.name: path.read_text(encoding="utf-8") for path in builder.PAGES.glob("*.md")}
    stale = sorted(name for name in texts.keys() | written.keys() if texts.get(name) != written.get(name))
    assert stale == [], f"run: {BUILD}"


def test_every_instruction_with_a_case_has_an_example():
    with_cases = {
        case["mnemonic"].partition(" ")[0]
        for path in (ROOT / "tests" / "conformance").glob("*.json")
        for case in load_cases(path)
        if not case.get("compile_error") and case["models"][0] in BOTH
    }
    of_fx = {f"FX {name}" for name in names_of(MODELS["H2U"])}
    assert sorted(with_cases & OWN.keys() - examples().keys()) == [], f"run: {BUILD}"
    assert sorted(examples().keys() - OWN.keys() - of_fx) == [], f"run: {BUILD}"


def test_an_example_is_one_of_the_conformance_cases(builder):
    cases = {case["id"]: case for path in builder.CASES.glob("*.json") for case in load_cases(path)}
    for mnemonic, example in examples().items():
        case = cases[example["id"]]
        name = case["mnemonic"].partition(" ")[0]
        assert (f"FX {named(name, MODELS['H2U'])}" if case["models"][0] not in BOTH else name) == mnemonic
        assert example == {key: case[key] for key in builder.KEPT if key in case}, f"run: {BUILD}"


def test_the_worked_example_of_the_manual_comes_before_others():
    text = str(ecsim.help("ADD"))
    assert "    LD X0\n    ADD D0 D1 D10\n" in text
    assert "X0 = 1, D0 = 1000, D1 = 2000; after 1 scan: D10 = 3000" in text


def test_neighbours_of_one_value_are_told_together():
    assert "M9 to M20 = 1; after 1 scan: M10 to M19 = 0, M9 = 1, M20 = 1" in str(ecsim.help("ZRST"))


def test_help_takes_any_case_and_shows_itself_in_a_notebook():
    page = ecsim.help("dadd")
    assert isinstance(page, Page)
    assert repr(page) == "<help on DADD: D = S1 + S2, wrapped to the width of D.>"
    assert page._repr_markdown_().startswith("# DADD\n\nD = S1 + S2")
    assert "| S1 | read | DINT | yes | constant KnX" in page._repr_markdown_()
    assert '<td style="text-align:left">S1</td>' in page._repr_html_()
    assert "LD&lt;=" in ecsim.help("LD<=")._repr_html_()


def test_help_lists_a_section_and_all():
    section = ecsim.help("6.16")
    assert isinstance(section, Section)
    assert len(section.parts[1].rows) == 54
    assert repr(section) == "<help on 6.16: 54 instructions>"
    contents = ecsim.help()
    assert isinstance(contents, Contents)
    assert set(OWN) <= set(str(contents).split())


def test_every_section_has_a_title():
    untitled = [section for section in sections() if section_title(section) == "instructions"]
    assert untitled == []


@pytest.mark.parametrize(
    ("name", "remedy"), [("CALLS", "did you mean CALL"), ("TOM", "TON"), ("¿?", "ecsim.help() lists all"), ("X" * 5000, "lists all")]
)
def test_an_unknown_name_is_refused_with_what_is_near(name, remedy):
    with pytest.raises(ecsim.EcsimError, match=re.escape(remedy)) as refused:
        ecsim.help(name)
    assert len(str(refused.value)) < 200


def test_the_shell_tells_the_same(capsys):
    assert main(["help", "add"]) == 0
    assert capsys.readouterr().out == f"{ecsim.help('ADD')}\n"
    assert main(["help"]) == 0
    assert capsys.readouterr().out == f"{ecsim.help()}\n"
    assert main(["help", "ADDD"]) == 2
    assert "did you mean" in capsys.readouterr().err
