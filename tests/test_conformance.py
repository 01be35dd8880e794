"""Every conformance case on every model of the case and on both engines, an item a file and engine.

A case whose program uses an instruction that TABLE does not have yet waits; which ones do is computed, so that they run
by themselves once the instruction is there. `test_no_case_waits` tells how many.
"""

import json
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from ecsim.instructions import TABLE
from ecsim.models.fx_spelling import plain
from ecsim.scenario import load_cases, run_case

CONFORMANCE = Path(__file__).parent / "conformance"
FACTS = json.loads((Path(__file__).parent / "facts" / "instructions.json").read_text(encoding="utf-8"))
FX_FACTS = json.loads((Path(__file__).parent / "facts" / "instructions_h2u.json").read_text(encoding="utf-8"))
FILES = sorted(CONFORMANCE.glob("*.json"))
MNEMONICS = {row["mnemonic"].split()[0] for row in FACTS}  # "SET Sxx" is a SET
FX_MNEMONICS = {"D" * wide + row["mnemonic"] for row in FX_FACTS for wide in (False, True) if not wide or "32" in row["width"]}
WAITING = MNEMONICS - set(TABLE)

CASE_KEYS = set(
    "id section mnemonic models il scan_ms steps compile_error source confidence note system_block data_block modules io".split()
)
STEP_KEYS = set(
    "set scans ms expect expect_range error action note pulses quadrature serial force unforce edit load refused remove insert lamps".split()
)


@cache
def cases(path):
    """The cases of one file."""
    return load_cases(path)


def words_of(case):
    """The mnemonics that a case's program uses."""
    code = (line.split("//")[0].split() for line in case["il"].upper().splitlines())
    return {words[0] for words in code if words}


def waits(case):
    """Whether a case cannot run yet: an instruction of its program, or its subject, is not in TABLE."""
    return bool(WAITING & (words_of(case) | {case["mnemonic"].partition(" ")[0]}))


def verdict_line(verdict):
    """One failing case: its id and model, then step, device, value and expected value of each mismatch."""
    return str(verdict)


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_case_holds(path, engine):
    runs = [(case, model) for case in cases(path) if not waits(case) for model in case["models"]]
    verdicts = [run_case(case, model, stepping=engine == "stepping") for case, model in runs]
    failed = [verdict_line(verdict) for verdict in verdicts if not verdict.passed]
    assert failed == [], f"{len(failed)} of {len(verdicts)} fail:\n" + "\n".join(failed)


def test_every_instruction_of_the_manual_is_there():
    assert not WAITING


def test_the_cases_name_no_instruction_that_the_manual_has_not():
    told = [
        (case["id"], case["mnemonic"], MNEMONICS if case["models"][0][:2] == "EC" else FX_MNEMONICS)
        for path in FILES
        for case in cases(path)
    ]
    assert [(name, mnemonic) for name, mnemonic, known in told if mnemonic and not {mnemonic, mnemonic.split()[0]} & known] == []


def test_the_id_of_a_case_stands_once():
    count = Counter(case["id"] for path in FILES for case in cases(path))
    assert [name for name, number in count.items() if number > 1] == []


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_case_has_the_keys_of_the_form_and_expects_something(path):
    wrong = []
    for case in cases(path):
        unknown = set(case) - CASE_KEYS | {key for step in case.get("steps", []) for key in step if key not in STEP_KEYS}
        expects = case.get("compile_error") or any(
            step.keys() & {"expect", "expect_range", "error", "serial", "lamps"} for step in case["steps"]
        )
        if unknown or not expects:
            wrong.append((case["id"], unknown or "expects nothing"))
    assert wrong == []


def test_every_instruction_of_the_table_has_five_cases():
    count = Counter(case["mnemonic"].partition(" ")[0] for path in FILES for case in cases(path) if case["models"][0][:2] == "EC")
    assert {mnemonic: count[mnemonic] for mnemonic, row in TABLE.items() if count[mnemonic] < 5 and {"EC10", "EC20"} & {*row.models}} == {}


def test_every_instruction_of_h2u_has_three_cases():
    count = Counter(plain(case["mnemonic"]) for path in FILES for case in cases(path) if case["models"][0][:2] != "EC")
    assert {row["mnemonic"]: count[row["mnemonic"]] for row in FX_FACTS if count[row["mnemonic"]] < 3} == {}


# -- the harness itself -------------------------------------------------------------------------------------------

ADDITION = {"id": "harness", "models": ["EC20"], "il": "LD SM0\nADD D0 1 D1"}


@pytest.mark.parametrize("tracing", [False, True], ids=["compiled", "stepping"])
def test_a_wrong_value_is_told_with_step_device_value_and_expectation(tracing):
    steps = [{"set": {"D0": 4}, "scans": 1, "expect": {"D1": 5}}, {"set": {"D0": 7}, "scans": 1, "expect": {"D0": 7, "D1": 9}}]
    verdict = run_case(ADDITION | {"steps": steps}, "EC20", tracing)
    assert str(verdict) == "harness [EC20]: step 2: D1 is 8, expected 9"


@pytest.mark.parametrize(
    ("case", "told"),
    [
        ({"steps": [{"scans": 1, "error": 69}]}, "step 1: SD20 is 0, expected 69"),
        ({"steps": [{"scans": 1, "expect_range": {"D1": {"min": 2, "max": 3}}}]}, "step 1: D1 is 1, expected 2 to 3"),
        ({"compile_error": True, "steps": []}, "the program was accepted, expected a compile error"),
        ({"il": "LD SM0\nADD D0", "steps": []}, "ADD takes 3 operands"),
        ({"steps": [{"scan": 1}]}, "the key 'scan' is not known"),
        ({"steps": [{"action": "leap"}]}, "there is no action 'leap'"),
        ({"steps": [{"action": "stop", "refused": "in RUN"}]}, "step 1: the refusal is '', expected 'in RUN'"),
        ({"steps": [{"action": "format", "refused": "the lock"}]}, "can be cleared in STOP only"),
        ({"steps": [{"action": "format"}]}, "can be cleared in STOP only"),
        ({"steps": [{"scans": 1, "expect": {"D9000": 1}}]}, "EC20 has no D9000"),
        ({"steps": [], "system_block": {"hold": 1}}, "the system block's key 'hold' is not known"),
        ({"steps": [], "system_block": {"port1": {"speed": 1}}}, "port1 has no setting 'speed'; it has baud"),
        (
            {
                "il": "LD SM1\nXMT 1 D0 1",
                "steps": [{"scans": 1, "serial": [{"port": 1, "tx": "41"}]}],
                "system_block": {"port1": {"protocol": "freeport"}},
            },
            "step 1: port 1 is 00, expected 41",
        ),
    ],
)
def test_what_is_wrong_with_a_case_fails_it(case, told):
    verdict = run_case(ADDITION | case, "EC20")
    assert not verdict.passed
    assert told in str(verdict)
