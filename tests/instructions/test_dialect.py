"""A second family as data: its model, its constants and its spelling, and the instructions run as they are.

The family is made up, in the manner of others of this class: the low word first, flags and special registers among the
M and D, constants with K and H, no local variables, V and Z as index registers, some names of its own, and a P behind a
mnemonic for "only in the scan in which the flow rises".
"""

import re
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ecsim
from ecsim.assembler import assemble
from ecsim.assembler.printer import print_program
from ecsim.devices import Constant, Syntax
from ecsim.instructions import TABLE
from ecsim.models import Area, Model

_CONSTANT = re.compile(r"K(?P<decimal>[+-]?\d+)|H(?P<hex>[0-9A-F]+)", re.IGNORECASE)


def kh_constant(text):
    """K10, K-5, H1F."""
    match = _CONSTANT.fullmatch(text)
    if match is None:
        return None
    if match["hex"]:
        return Constant(int(match["hex"], 16), text, unsigned=True)
    return Constant(int(match["decimal"]), text)


BITS = ("X", "Y", "M", "S")
AS_ELSEWHERE = (
    "LD LDI AND ANI OR ORI ANB ORB MPS MRD MPP INV OUT SET RST MC MCR STL RET FOR NEXT CALL "
    "MOV DMOV ADD DADD SUB DSUB INC DINC DEC DDEC ZRST "
    "LD= LD> LD<> AND= AND<= OR> OR< LDD= LDD>= ANDD< ORD<>"
).split()

DIALECT = Model(
    name="DIALECT",
    family="DIALECT",
    areas={
        name: Area(name, count, kind)
        for name, count, kind in (
            ("X", 0o200, "bit"), ("Y", 0o200, "bit"), ("M", 8256, "bit"), ("S", 1000, "bit"), ("T", 256, "timer"), ("C", 256, "counter"),
            ("D", 8256, "word"), ("V", 8, "word"), ("Z", 8, "word"),
        )
    },
    syntax=Syntax(areas=frozenset("XYMSTCDVZ"), bit_areas=frozenset(BITS), index_areas=frozenset("VZ"), constant=kh_constant),
    timer_bases=((0, 199, 100_000), (200, 255, 10_000)),
    fast_timers=(256, 255),
    wide_counters=200,
    initial_steps=10,
    relays={
        "running": 8000, "first scan": 8002, "clock 10 ms": 8011, "clock 100 ms": 8012, "clock 1 s": 8013,
        "zero": 8020, "borrow": 8021, "carry": 8022, "fault": 8067, "counter direction": 8000,
    },
    registers={"watchdog": 8000, "system error": 8004, "scan time": 8010, "least scan time": 8011, "greatest scan time": 8012, "faults": 8067},
    read_only_relays=frozenset({8000, 8002, 8011, 8012, 8013}),
    read_only_registers=frozenset({8010, 8011, 8012}),
    limits=ecsim.Plc("EC20").model.limits,
    filter_inputs=8,
    filter_ms=10,
    filter_choices=(0, 10),
    instruction_ns=300,
    retained=("D", "M", "S", "C"),
    special_bits="M",
    special_words="D",
    first_special=8000,
    local_areas=(),
    high_word_first=False,
    spelling={name: name for name in AS_ELSEWHERE} | {"TMR": "TON", "CNT": "CTU", "UDC": "DCNT", "FEND": "CFEND", "SRET": "CSRET", "EADD": "RADD"},
    pulse_suffix="P",
    fault_record=1,
)  # fmt: skip

both_engines = pytest.mark.parametrize("engine", ["compiled", "stepping"])


def machine(text, engine="compiled", model=DIALECT):
    """A PLC in RUN with a program."""
    plc = ecsim.Plc(model, scan_ms=10, input_filter_ms=0)
    plc.engine = engine
    plc.load(text)
    plc.run()
    return plc


def problem(text):
    """The one problem of a program that is refused."""
    with pytest.raises(ecsim.ProgramError) as refused:
        assemble(text, DIALECT)
    (found,) = refused.value.problems
    return found


# -- constants and Kn -----------------------------------------------------------------------------------------------------


@both_engines
def test_constants_carry_k_and_h(engine):
    plc = machine("LD M8000\nMOV K-5 D0\nMOV H1F D1\nMOV HFFFF D2\nDMOV H12345678 D4", engine)
    plc.scan()
    assert [plc["D0"], plc["D1"], plc["D2"], plc["D4:DINT"]] == [-5, 0x1F, -1, 0x12345678]


@both_engines
def test_k4_is_a_number_and_k4m0_a_group_of_bits(engine):
    plc = machine("LD M8000\nMOV K4 K1Y0\nMOV K4M0 D0", engine)
    plc.set({"M0": 1, "M15": 1})
    plc.scan()
    assert [plc[f"Y{n}"] for n in range(4)] == [0, 0, 1, 0]
    assert plc["D0"] == 1 - 0x8000


def test_a_number_without_its_letter_is_refused():
    assert "'5' is neither a device of DIALECT nor a declared name" in problem("LD M0\nMOV 5 D0").message


# -- word order -------------------------------------------------------------------------------------------------------------


@both_engines
def test_the_low_word_stands_in_the_lower_register(engine):
    plc = machine("LD M8000\nDMOV K65538 D10\nDMOV D10 D20\nDADD D20 K65535 D30", engine)
    plc.scan()
    assert [plc["D10"], plc["D11"]] == [2, 1]
    assert plc["D20:DINT"] == 65538
    assert [plc["D30"], plc["D31"]] == [1, 2]  # 131073


@both_engines
def test_an_indexed_double_word_has_the_same_order(engine):
    plc = machine("LD M8000\nMOV K3 V0\nMOV K5 Z1\nDMOV K65538 D0V0\nDMOV D0V0 D10Z1", engine)
    plc.scan()
    assert [plc["D3"], plc["D4"], plc["D15"], plc["D16"]] == [2, 1, 2, 1]


@both_engines
def test_a_real_number_has_the_low_word_first_too(engine):
    plc = machine("LD M8000\nEADD D0 D2 D4\nEADDP D6 D0 D6", engine)
    plc.set({"D0:REAL": 0.1, "D2:REAL": 0.2})
    plc.scan(3)
    exact = struct.pack("<f", struct.unpack("f", struct.pack("f", 0.1))[0] + struct.unpack("f", struct.pack("f", 0.2))[0])
    assert struct.pack("<hh", plc["D4"], plc["D5"]) == exact
    assert struct.pack("<hh", plc["D6"], plc["D7"]) == struct.pack("<f", 0.1)
    assert plc["D4:REAL"] == struct.unpack("<f", exact)[0]


# -- flags, faults and other special devices ----------------------------------------------------------------------------------


@both_engines
@pytest.mark.parametrize(
    ("program", "result", "zero", "borrow", "carry"),
    [
        ("ADD K1 K2 D0", 3, 0, 0, 0),
        ("ADD K5 K-5 D0", 0, 1, 0, 0),
        ("ADD K32767 K2 D0", -32767, 0, 0, 1),
        ("SUB K-32768 K1 D0", 32767, 0, 1, 0),
        ("SUB K7 K7 D0", 0, 1, 0, 0),
    ],
)
def test_the_flags_lie_at_m8020_to_m8022(engine, program, result, zero, borrow, carry):
    plc = machine(f"LD M8000\n{program}", engine)
    plc.scan()
    assert [plc["D0"], plc["M8020"], plc["M8021"], plc["M8022"]] == [result, zero, borrow, carry]
    assert [number for number in range(8000) if plc[f"M{number}"]] == []


@both_engines
def test_an_error_is_noted_in_the_family_s_own_relay_and_register(engine):
    plc = machine("LD M0\nMOV K9000 Z0\nMOV K1 D0Z0", engine)
    plc.scan()
    assert [plc["M8067"], plc["D8067"]] == [0, 0]
    plc["M0"] = 1
    plc.scan()
    assert [plc["M8067"], plc["D8067"]] == [1, 65]
    assert [error.code for error in plc.errors] == [65]
    assert [plc["D8066"], plc["D8068"], plc["D20"]] == [0, 0, 0]


@both_engines
def test_special_relays_live_among_the_others(engine):
    plc = machine("LD M8002\nINC D0\nLD M8000\nINC D1\nLD M8013\nOUT Y0\nLD M8000\nSET M5", engine)
    plc.scan(3)
    assert [plc["D0"], plc["D1"], plc["M8000"]] == [1, 3, 1]
    plc.advance(ms=600)
    assert plc["Y0"] == 1
    plc.stop()
    assert [plc["M8000"], plc["M5"]] == [0, 1]
    plc.run()
    assert [plc["M8000"], plc["M8002"], plc["M5"], plc["D1"]] == [1, 1, 0, 0]


def test_the_scan_times_are_noted_in_the_family_s_registers():
    plc = machine("LD M8000\nOUT Y0")
    plc.scan(2)
    assert [plc["D8010"], plc["D8011"], plc["D8012"]] == [10, 10, 10]
    assert [plc["D30"], plc["D31"], plc["D32"]] == [0, 0, 0]


def test_what_the_system_writes_is_read_only_and_the_rest_is_not():
    assert "M8000 is read only" in problem("LD M0\nSET M8000").message
    assert "special relays and registers cannot be indexed" in problem("LD M0\nMOV K1 D8000Z0").message
    assert assemble("LD M0\nSET M8034\nMOV K1 D7999Z0", DIALECT).steps > 0


# -- spelling -------------------------------------------------------------------------------------------------------------------


@both_engines
def test_timers_and_counters_under_other_names(engine):
    plc = machine("LD X0\nTMR T0 K5\nLD T0\nOUT Y0\nLD X1\nCNT C0 K2\nLD C0\nOUT Y1", engine)
    plc["X0"] = 1
    plc.scan()  # the timer begins
    plc.advance(ms=490)
    assert [plc["T0"], plc["Y0"]] == [4, 0]
    plc.advance(ms=20)
    assert [plc["T0"], plc["Y0"]] == [5, 1]
    for level, value, output in ((1, 1, 0), (0, 1, 0), (1, 2, 1)):
        plc["X1"] = level
        plc.scan()
        assert [plc["C0"], plc["Y1"]] == [value, output]


@both_engines
def test_a_counter_takes_its_direction_from_the_family_s_relay(engine):
    plc = machine("LD X0\nUDC C200 K5", engine)
    for down, value in ((0, 1), (0, 2), (1, 1), (1, 0), (1, -1)):
        plc.set({"M8200": down, "X0": 1})
        plc.scan()
        assert plc["C200"] == value
        plc["X0"] = 0
        plc.scan()


@both_engines
def test_compare_contacts_and_zrst(engine):
    plc = machine("LD= D0 K5\nOR> D0 K10\nAND<= D1 K3\nOUT Y0\nLDD>= D2 K65536\nOUT Y1\nLD X0\nZRST M10 K3\nZRST C0 K2", engine)
    for d0, d1, lamp in ((5, 3, 1), (5, 4, 0), (11, 0, 1), (7, 0, 0)):
        plc.set({"D0": d0, "D1": d1})
        plc.scan()
        assert plc["Y0"] == lamp
    plc.set({"D2": 0, "D3": 1})  # 65536, the high word in the upper register
    plc.scan()
    assert plc["Y1"] == 1
    plc.set({"D2": -1, "D3": 0})  # 65535
    plc.scan()
    assert plc["Y1"] == 0
    plc.set({f"M{n}": 1 for n in range(9, 14)} | {"C0": 7, "C1": 8, "C2": 9, "X0": 1})
    plc.scan()
    assert [plc[f"M{n}"] for n in range(9, 14)] == [1, 0, 0, 0, 1]
    assert [plc["C0"], plc["C1"], plc["C2"]] == [0, 0, 9]


@both_engines
def test_steps_loops_and_subroutines(engine):
    plc = machine(
        "PROGRAM MAIN\nLD M8002\nSET S0\nSTL S0\nLD X0\nSET S10\nSTL S10\nOUT Y1\nRET\nLD M8000\nFOR K3\nLD M8000\nINC D0\nNEXT\n"
        "LD M8000\nCALL ADD_UP\nEND_PROGRAM\nSUBROUTINE ADD_UP\nLD M8000\nADD D1 K2 D1\nEND_SUBROUTINE",
        engine,
    )
    plc.set({"V0": 7, "X0": 1})
    plc.scan(2)
    assert [plc["S0"], plc["S10"], plc["Y1"]] == [0, 1, 1]
    assert [plc["D0"], plc["D1"]] == [6, 4]
    assert plc["V0"] == 7  # V is an index register here and not cleared by a call


def test_the_other_family_s_name_is_answered_with_this_one_s():
    found = problem("LD M0\nTON T0 K5")
    assert (found.message, found.hint) == ("DIALECT has no TON", "write TMR")
    assert problem("LD M0\nRADD D0 D2 D4").hint == "write EADD"
    assert problem("LD M0\nLN D0 D2").hint == "LN exists on EC10 and EC20"
    assert "'SM0' is neither a device" in problem("LD SM0\nOUT Y0").message


def test_subroutines_have_no_variables_here():
    text = "PROGRAM MAIN\nLD M0\nCALL SUM\nEND_PROGRAM\nSUBROUTINE SUM\nVAR_TEMP A : INT\nLD M0\nINC D0\nEND_SUBROUTINE"
    assert problem(text).message == "DIALECT has no variables of subroutines"


def test_a_program_is_printed_as_the_family_spells_it():
    text = "LD    M0\nINCP  D0\nTMR   T0 K5\nLD    X0\nDMOVP H1F D2\n"
    program = assemble(text, DIALECT)
    assert print_program(program) == text
    assert [str(i) for i in program.instructions][1:3] == ["INCP D0", "TMR T0 K5"]
    assert [i.mnemonic for i in program.instructions][1:3] == ["INC", "TON"]


# -- the pulse suffix -------------------------------------------------------------------------------------------------------------


@both_engines
def test_with_the_suffix_an_instruction_acts_once_a_rise(engine):
    plc = machine("LD X0\nINCP D0\nINC D1\nMOVP D9 D2\nDADDP D4 K100000 D4", engine)
    seen = []
    for level in (1, 1, 0, 0, 1, 1, 1, 0):
        plc.set({"X0": level, "D9": plc["D9"] + 1})
        plc.scan()
        seen.append((plc["D0"], plc["D1"], plc["D2"], plc["D4:DINT"]))
    assert [row[0] for row in seen] == [1, 1, 1, 1, 2, 2, 2, 2]
    assert [row[1] for row in seen] == [1, 2, 2, 2, 3, 4, 5, 5]
    assert [row[2] for row in seen] == [1, 1, 1, 1, 5, 5, 5, 5]
    assert [row[3] for row in seen] == [100000] * 4 + [200000] * 4


@both_engines
def test_each_pulse_watches_its_own_flow(engine):
    plc = machine("LD X0\nMPS\nAND X1\nINCP D0\nMRD\nINCP D1\nMPP\nAND X2\nZRSTP M0 K2\nLDI X0\nINCP D2", engine)
    plc["M0"] = plc["M1"] = 1
    for inputs in ({"X0": 1}, {"X1": 1}, {"X2": 1}, {"X0": 0}, {"X0": 1}):
        plc.set(inputs)
        plc.scan()
        if inputs == {"X2": 1}:
            assert [plc["M0"], plc["M1"]] == [0, 0]
            plc["M0"] = 1
    assert [plc["D0"], plc["D1"], plc["D2"], plc["M0"]] == [2, 2, 1, 0]


@both_engines
def test_the_first_scan_counts_as_a_rise_and_so_does_the_first_after_stop(engine):
    plc = machine("LD X0\nMOVP K7 D0", engine)
    plc["X0"] = 1
    plc.scan()
    assert plc["D0"] == 7
    plc.stop()
    plc.run()
    assert plc["D0"] == 0
    plc.scan()
    assert plc["D0"] == 7


def test_a_pulse_s_memory_belongs_to_the_snapshot():
    plc = machine("LD X0\nINCP D0")
    before = plc.snapshot()
    plc["X0"] = 1
    plc.scan(3)
    assert plc["D0"] == 1
    plc.restore(before)
    plc["X0"] = 1
    plc.scan(3)
    assert plc["D0"] == 1


@pytest.mark.parametrize("word", ["OUTP", "SETP", "TMRP", "LDP", "INCPP", "P"])
def test_only_what_acts_on_values_takes_the_suffix(word):
    assert f"'{word}' is no instruction" in problem(f"LD M0\n{word} D0").message


def test_the_suffix_means_nothing_to_a_family_without_it():
    with pytest.raises(ecsim.ProgramError, match="'INCP' is no instruction"):
        ecsim.compile("LD M0\nINCP D0")


# -- the same instructions ----------------------------------------------------------------------------------------------------


def test_no_function_is_written_again():
    program = assemble("LD M0\nMOVP K1 D0\nTMR T0 K1\nADD D0 D1 D2", DIALECT)
    assert [i.definition for i in program.instructions] == [TABLE[name] for name in ("LD", "MOV", "TON", "ADD")]


ARITHMETIC = (("ADD", "D4 D6 D20"), ("SUB", "D4 D6 D22"), ("DADD", "D0 D2 D24"), ("DSUB", "D0 D2 D26"))


@pytest.fixture(scope="module")
def twins():
    """The same arithmetic on both families and both engines, in RUN; M100 on keep the flags: zero, carry and borrow of each in turn."""

    def text(on, flags):
        lines = []
        for place, (name, operands) in enumerate(ARITHMETIC):
            lines += [f"LD {on}", f"{name} {operands}"]
            lines += [f"LD {flag}\nOUT M{100 + 3 * place + bit}" for bit, flag in enumerate(flags)]
        return "\n".join(lines)

    families = (("EC20", "SM0", ("SM180", "SM181", "SM182")), (DIALECT, "M8000", ("M8020", "M8022", "M8021")))
    return [machine(text(on, flags), engine, model) for model, on, flags in families for engine in ("compiled", "stepping")]


def wrapped(value, bits):
    return (value + (1 << bits - 1)) % (1 << bits) - (1 << bits - 1)


def flags_of(value, bits):
    return [int(value == 0), int(value > (1 << bits - 1) - 1), int(value < -(1 << bits - 1))]


edges = st.sampled_from([0, 1, -1, 0x7FFF, -0x8000, 0x8000, 0x7FFFFFFF, -0x80000000])
numbers = edges | st.integers(-0x80000000, 0x7FFFFFFF)


@given(numbers, numbers)
def test_both_families_come_to_the_same_numbers_and_flags(twins, first, second):
    short = wrapped(first, 16), wrapped(second, 16)
    exact = [(short[0] + short[1], 16), (short[0] - short[1], 16), (first + second, 32), (first - second, 32)]
    for plc in twins:
        plc.set({"D0:DINT": first, "D2:DINT": second, "D4": short[0], "D6": short[1]})
        plc.scan()
        assert [plc["D20"], plc["D22"], plc["D24:DINT"], plc["D26:DINT"]] == [wrapped(value, bits) for value, bits in exact]
        assert [plc[f"M{n}"] for n in range(100, 112)] == [flag for value, bits in exact for flag in flags_of(value, bits)]
