"""TABLE against the manual's operand tables and its lists of step counts, flags and models (a copy stands in tests/facts)."""

import json
import re
from pathlib import Path

import pytest

from ecsim.instructions import TABLE as ROWS
from ecsim.instructions.define import _define
from ecsim.instructions.signature import parse_signature

ROOT = Path(__file__).resolve().parent.parent.parent
FACTS = {row["mnemonic"]: row for row in json.loads((ROOT / "tests/facts/instructions.json").read_text(encoding="utf-8"))}
IN_A_STEP = {"SET": "SET Sxx", "OUT": "OUT Sxx", "RST": "RST Sxx"}  # rows of their own in the manual

TABLE = {mnemonic: row for mnemonic, row in ROWS.items() if not mnemonic.startswith("FX:")}  # others are held in test_fx_table.py

# Where TABLE deliberately says something else than the copy of the facts: (mnemonic, column) -> (what TABLE says, why).
# Each stands in docs/decisions.md too, which a test below checks.
FLAGS = "the rows of 6.17 print all three flags everywhere; neither the text nor appendix 9 names one"
DIFFERENT = {
    ("DMOV", "S devices"): (
        sorted("const KnX KnY KnM KnS KnLM KnSM D SD C V".split()),
        "the printed row is two rows run together: table 3-3 and 6.1.11 give no 32-bit number to T and Z",
    ),
    **{
        ("DXCH", f"{name} devices"): (
            sorted("KnY KnM KnS KnLM D C V".split()),
            "table 3-3 gives no 32-bit number to T and Z",
        )
        for name in ("D1", "D2")
    },
    **{(name, "flags"): ([], "neither the text nor appendix 9 names a flag") for name in ("WSFR", "WSFL")},
    **{(name, "flags"): (["carry"], "the one quotient that does not fit is told") for name in ("DIV", "DDIV")},
    ("SUM", "flags"): (["borrow", "carry", "zero"], "6.3.19: carry and borrow are always 0 afterwards"),
    ("ASC", "operands"): (["S", "D"], "the characters S1 to S8 are written as one word"),
    ("PID", "S3 role"): ("dest", "S3+7 to S3+14 and S3+19 are written"),
    ("EVRDST", "models"): (["EC10"], "the inverter instructions exist on EC10, say the index and the other eight operand tables"),
    **{(mnemonic, "flags"): ([], FLAGS) for mnemonic in ("ZRN", "PLSV", "DRVI", "DRVA", "ABS")},
}
# Operands that the text calls otherwise than the operand table: (mnemonic, name in the text) -> name in the table.
RENAMED = {("PLSR", "D"): "D1"}


def of_table(mnemonic):
    """The columns of a row of TABLE, in the form of the facts."""
    row = TABLE[mnemonic]
    columns = {"section": row.section, "steps": row.steps, "flags": sorted(row.flags), "models": sorted(row.models)}
    operands = [spec for spec in row.operands if spec.kind != "ROUTINE"]  # CALL: the operands are the subroutine's own
    columns["operands"] = [spec.name for spec in operands]
    for spec in operands:
        columns |= {
            f"{spec.name} role": spec.role,
            f"{spec.name} type": spec.type.name,
            f"{spec.name} devices": sorted(spec.areas),
            f"{spec.name} index": spec.indexed,
        }
    return columns


def of_facts(mnemonic):
    """The same of the facts."""
    row = FACTS[mnemonic]
    columns = {"section": row["section"], "steps": row["steps"], "flags": sorted(row["flags"]), "models": sorted(row["models"])}
    names = [RENAMED.get((mnemonic, operand["name"]), operand["name"]) for operand in row["operands"]]
    columns["operands"] = names
    for name, operand in zip(names, row["operands"], strict=True):
        columns |= {
            f"{name} role": operand["role"],
            f"{name} type": operand["type"],
            f"{name} devices": sorted(operand["devices"] or []),
            f"{name} index": operand["index"],
        }
    return columns


def _only(columns, names):
    """Some of the columns."""
    return {name: value for name, value in columns.items() if name in names}


def test_the_table_has_no_instruction_that_the_manual_has_not():
    assert sorted(set(TABLE) - set(FACTS)) == []


@pytest.mark.parametrize("mnemonic", sorted(TABLE))
def test_a_row_says_what_the_manual_says(mnemonic):
    table, facts = of_table(mnemonic), of_facts(mnemonic)
    for (name, column), (value, _) in DIFFERENT.items():
        if name == mnemonic:
            assert facts.get(column) != value, f"the difference in {column} is none any more"
            facts[column] = value
            if column == "operands":  # what one side alone has cannot be compared
                table, facts = _only(table, set(facts) & set(table)), _only(facts, set(facts) & set(table))
    assert table == facts


@pytest.mark.parametrize("mnemonic", sorted(TABLE))
def test_a_range_of_constants_is_the_manuals(mnemonic):
    for spec, operand in zip(TABLE[mnemonic].operands, FACTS[mnemonic]["operands"], strict=False):
        if spec.range and operand["range"]:
            low, high = (int(number) for number in re.fullmatch(r"[A-Z]*(-?\d+)\.\.[A-Z]*(-?\d+)", operand["range"]).groups())
            assert spec.range == (low, high), spec.name


@pytest.mark.parametrize("mnemonic", sorted(IN_A_STEP))
def test_a_transition_has_the_length_of_its_own_row(mnemonic):
    assert TABLE[mnemonic].transition_steps == FACTS[IN_A_STEP[mnemonic]]["steps"]


@pytest.mark.parametrize("mnemonic", sorted(TABLE))
def test_the_docstring_begins_with_a_sentence_for_the_help_page(mnemonic):
    title = TABLE[mnemonic].title
    assert title.endswith(".")
    assert title[0].isupper()
    assert len(title) < 140


def test_a_deliberate_difference_stands_in_the_decisions():
    decisions = (ROOT / "docs/decisions.md").read_text(encoding="utf-8") if DIFFERENT else ""
    assert [name for name, _ in (*DIFFERENT, *RENAMED) if not re.search(rf"(?<![A-Z]){re.escape(name)}(?![A-Z])", decisions)] == []
    assert all(reason for _, reason in DIFFERENT.values())


# -- reading of signatures ----------------------------------------------------------------------------------------


def operands(signature):
    """The operands of a signature."""
    return parse_signature(signature)[0]


def only(signature):
    """The one operand of a signature."""
    (spec,) = operands(signature)
    return spec


def test_an_operand_left_of_the_arrow_is_read_and_one_right_of_it_written():
    s, d = operands("S:INT -> D:INT")
    assert (s.read, s.written, s.role) == (True, False, "source")
    assert (d.read, d.written, d.role) == (False, True, "dest")


def test_an_operand_on_both_sides_is_read_and_written():
    spec = only("D:INT -> D")
    assert (spec.read, spec.written) == (True, True)


def test_a_leading_sign_makes_a_written_operand_of_one_that_stands_left():
    d, s = operands(">D:BOOL*S~ S:INT")
    assert (d.read, d.written, d.span, d.indexed) == (False, True, "S", True)
    assert s.read


def test_areas_are_added_taken_away_or_named():
    assert only("-> D:INT+SD").areas - only("-> D:INT").areas == {"SD"}
    assert only("S:INT").areas - only("S:INT-SD-const").areas == {"SD", "const"}
    assert only("S:INT[D V]").areas == {"D", "V"}


def test_a_span_may_be_a_number():
    assert only("S:INT*4").span == 4


def test_marks_allow_and_forbid_the_index():
    assert [only(text).indexed for text in ("S:INT", "S:INT!", "S:BOOL", "S:BOOL~")] == [True, False, False, True]


def test_a_span_may_count_from_device_to_device():
    spec = operands(">D1:BOOL*{max(d2-d1,0)+1}~ D2:BOOL d1 d2")[0]
    assert [spec.length({"d1": 5, "d2": 9}), spec.length({"d1": 9, "d2": 5}), spec.length({"d1": 5})] == [5, 1, None]


def test_of_a_span_a_kn_string_may_take_the_first_element_alone():
    assert [only(text).first for text in ("-> D:INT*2'", "-> D:INT*2")] == [True, False]
    assert only("-> D:INT*2'").span == 2


def test_an_operand_may_be_written_now_and_then():
    spec = operands("S:INT[D]*N? N:INT -> S")[0]
    assert (spec.maybe, spec.read, spec.written, spec.span) == (True, True, True, "N")


def test_a_range_of_a_constant_is_read():
    assert only("S:INT=-3..7").range == (-3, 7)


def test_a_small_word_right_of_the_arrow_is_a_flag_of_the_function():
    assert parse_signature("S:INT -> D:INT carry")[-1] == ("carry",)


@pytest.mark.parametrize("signature", ["S", "S:NUMBER", "S:INT=1", "1:INT"])
def test_a_malformed_signature_is_refused(signature):
    with pytest.raises((ValueError, KeyError)):
        parse_signature(signature)


def test_an_instruction_cannot_be_defined_twice():
    with pytest.raises(ValueError, match="MOV is defined twice"):
        _define("value", "MOV", "", 1, "6.2.1")(lambda: None)
