"""Values handed from one instruction to the next without reading the registers again: what must make the engine read them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ecsim

# One flow for all of it, so that the compiled engine writes one run of statements.
LINES = st.sampled_from(
    [
        "RADD D{0} D{1} D{2}", "RMUL D{0} 1.5 D{1}", "RNEG D{0} D{1}", "RMOV D{0} D{1}", "RDIV D{0} D{1} D{2}", "RMOV D{0}Z0 D{1}", "RSQT D{0} D{1}Z0",
        "DADD D{0} D{1} D{2}", "DSUB D{0} 100000 D{1}", "DMOV D{0} D{1}", "DINC D{0}", "DMUL D{0} D{1} D{2}", "DXCH D{0} D{1}", "DWAND D{0} D{1} D{2}",
        "DDIV D{0} D{1} D{2}", "MUL D{0} D{1} D{2}", "MOV D{0} D{1}", "INC D{0}", "ADD D{0} D{1} D{2}", "BMOV D{0} D{1} 3", "FLT D{0} D{1}",
        "DFLT D{0} D{1}", "DMOV D{0} K8M0", "DMOV K8M0 D{0}", "DMOV C200 D{0}", "DMOV D{0} C200", "MOV K4SM176 D{0}", "DSUM D{0} 2 D{1}",
    ]
)  # fmt: skip
REGISTERS = st.integers(0, 9)
PROGRAMS = st.lists(st.tuples(LINES, REGISTERS, REGISTERS, REGISTERS), min_size=2, max_size=12)


def state(engine, text, values, forced=()):
    """Registers, counter and flags after two scans."""
    plc = ecsim.Plc("EC20")
    plc.load(text)
    plc.engine = engine
    plc.run()
    plc.set({f"D{place}": value for place, value in enumerate(values)})
    for number, value in forced:
        plc.force(f"D{number}", value)
    plc.scan(2)
    return [plc[name] for name in (*(f"D{n}" for n in range(16)), "C200", "K8M0", "SM180", "SM181", "SM182", "SM20", "SD20", "SD21")]


@given(
    lines=PROGRAMS,
    values=st.lists(st.one_of(st.integers(-0x8000, 0x7FFF), st.sampled_from([0x3FC0, 0x4049, 0x7F00, 0, 1])), min_size=12, max_size=12),
    forced=st.lists(st.tuples(REGISTERS, st.integers(-0x8000, 0x7FFF)), max_size=2),
)
def test_a_run_of_instructions_leaves_what_single_ones_leave(lines, values, forced):
    text = "LD SM0\n" + "\n".join(line.format(*numbers) for line, *numbers in lines)
    assert state("compiled", text, values, forced) == state("stepping", text, values, forced)


def program(*lines):
    return "\n".join(["LD SM0", *lines])


@pytest.fixture
def plc():
    return ecsim.Plc("EC20")


def test_a_forced_register_is_read_as_it_is_forced(plc):
    plc.load(program("DADD D0 1 D2", "DADD D2 1 D4"))
    plc.run()
    plc.force("D3", 50)
    plc.scan()
    assert (plc["D2:DINT"], plc["D4:DINT"]) == (50, 51)
    plc.unforce()
    plc.scan()
    assert (plc["D2:DINT"], plc["D4:DINT"]) == (1, 2)


def test_a_half_that_was_written_alone_is_read_again(plc):
    plc.load(program("DADD D0 1 D2", "MOV 7 D3", "DADD D2 0 D4"))
    plc.run()
    plc.scan()
    assert plc["D4:DINT"] == 7


def test_an_instruction_that_failed_has_handed_nothing_on(plc):
    plc.load(program("DMOV 5 D2", "DDIV D2 D0 D2", "DADD D2 1 D4"))
    plc.run()
    plc.scan()
    assert (plc["D4:DINT"], plc["SD20"]) == (6, 69)


def test_flags_that_a_later_instruction_reads_are_set(plc):
    plc.load(program("ADD D0 0 D2", "MOV K4SM180 D3", "ADD D0 1 D4"))
    plc.run()
    plc.scan()
    assert (plc["D3"] & 1, plc["SM180"]) == (1, 0)


def test_flags_stay_where_the_later_instruction_fails(plc):
    plc.load(program("ADD 32767 1 D2", "ADD D0 D7999Z0 D4"))
    plc.run()
    plc["Z0"] = 5
    plc.scan()
    assert (plc["SM181"], plc["SD20"]) == (1, 65)
