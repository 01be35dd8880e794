"""Contacts and coils on the bits of words."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ecsim

OPERAND_ERROR = 64
WORDS, BITS = st.integers(0, 0xFFFF), st.integers(0, 15)


@given(word=WORDS, bit=BITS, flow=st.integers(0, 1))
def test_a_contact_is_the_bit_and_joins_the_flow(running, word, bit, flow):
    plc = running(
        "BLD D0 D1\nOUT Y0\nBLDI D0 D1\nOUT Y1\nLD M0\nBAND D0 D1\nOUT Y2\nLD M0\nBANI D0 D1\nOUT Y3\n"
        "LD M0\nBOR D0 D1\nOUT Y4\nLD M0\nBORI D0 D1\nOUT Y5"
    )
    plc.set({"D0:WORD": word, "D1": bit, "M0": flow})
    plc.scan()
    on = f"{word:016b}"[::-1][bit] == "1"
    assert [plc[f"Y{place}"] for place in range(6)] == [on, not on, flow and on, flow and not on, flow or on, flow or not on]


@given(word=WORDS, bit=BITS)
def test_a_constant_number_reads_the_same_bit(word, bit):
    plc = ecsim.Plc("EC20")
    plc.load(f"BLD D0 {bit}\nOUT Y0\nBLDI D0 {bit}\nOUT Y1")
    plc.run()
    plc["D0:WORD"] = word
    plc.scan()
    assert (plc["Y0"], plc["Y1"]) == (word >> bit & 1, 1 - (word >> bit & 1))


@pytest.mark.parametrize("number", [16, -1, 32767])
@pytest.mark.parametrize("name", ["BLD", "BLDI"])
def test_a_contact_on_no_bit_is_open_and_an_operand_error(running, name, number):
    plc = running(f"{name} D0 D1\nOUT Y0")
    plc.set({"D0": -1 if name == "BLD" else 0, "D1": number})
    plc.scan()
    assert (plc["Y0"], plc["SM20"], plc["SD20"]) == (0, 1, OPERAND_ERROR)


@pytest.mark.parametrize("name", ["BLD", "BAND", "BORI"])
def test_a_number_that_is_no_bit_is_refused(name):
    before = "" if name == "BLD" else "LD X0\n"
    with pytest.raises(ecsim.ProgramError, match="S2 goes from 0 to 15"):
        ecsim.compile(f"{before}{name} D0 16\nOUT Y0", "EC20")


@given(word=WORDS, bit=BITS, flow=st.integers(0, 1))
def test_a_coil_writes_its_bit_and_no_other(running, word, bit, flow):
    plc = running("LD M0\nBOUT D0 D1\nBSET D2 D1\nBRST D3 D1")
    plc.set({"D0:WORD": word, "D2:WORD": word, "D3:WORD": word, "D1": bit, "M0": flow})
    plc.scan()
    digits = f"{word:016b}"
    on, off = (int(digits[: 15 - bit] + digit + digits[16 - bit :], 2) for digit in "10")
    assert plc["D0:WORD"] == (on if flow else off)
    assert (plc["D2:WORD"], plc["D3:WORD"]) == ((on, off) if flow else (word, word))


def test_a_coil_in_a_skipped_structure_is_off_and_needs_no_legal_number(running):
    plc = running("LD X0\nMC 0\nLD SM0\nBOUT D0 D1\nBOUT D0 2\nBSET D0 4\nMCR 0")
    plc.set({"X0": 1, "D0": 0, "D1": 1})
    plc.scan()
    assert plc["D0"] == 0b10110
    plc["X0"] = 0
    plc.scan()
    assert plc["D0"] == 0b10000
    plc.set({"D0": 0b11111, "D1": 16})
    plc.scan()
    assert (plc["D0"], plc["SM20"], plc["SD20"]) == (0b11011, 0, 0)


def test_a_coil_is_cleared_when_its_step_has_been_left(running):
    plc = running("LD SM1\nSET S0\nSTL S0\nLD SM0\nBOUT D0 3\nBSET D0 5\nLD X0\nSET S20\nSTL S20\nLD SM0\nBOUT D0 4\nRET")
    plc.set({"X0": 0})
    plc.scan(2)
    assert plc["D0"] == 0b101000
    plc["X0"] = 1
    plc.scan(2)
    assert plc["D0"] == 0b110000


def test_a_coil_behind_an_error_keeps_the_word(running):
    plc = running("LD M0\nBOUT D0 D1\nOUT Y0")
    plc.set({"M0": 1, "D0": 77, "D1": 16})
    plc.scan()
    assert (plc["D0"], plc["Y0"], plc["SM20"], plc["SD20"]) == (77, 1, 1, OPERAND_ERROR)


def test_the_trace_shows_what_a_coil_has_written():
    plc = ecsim.Plc("EC20")
    plc.load("LD SM0\nBOUT D0 3")
    plc.run()
    plc.tracing = True
    plc.scan()
    assert [(write.device, write.old, write.new) for write in plc.trace.writes] == [("D0", 0, 8)]
