"""Reading, writing and forcing devices from outside: what fits, what does not, and what the refusal says."""

import numpy
import pytest

from ecsim import EcsimError, Plc


@pytest.fixture
def plc() -> Plc:
    plc = Plc("EC20", input_filter_ms=0)
    plc.load("LD X0\nTON T0 10\nLD T0\nOUT Y0")
    plc.run()
    return plc


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("X8", "octal"),
        ("X400", r"EC20 has no X400 \(X0 to X377\)"),
        ("D7999:DINT", "D7999:DINT reaches beyond the last D"),
        ("K4M1999", "reaches beyond the last M"),
        ("K4D0", "write K4M0"),
        ("T0:REAL", "T0 cannot be had as REAL; it is INT, WORD, BOOL"),
        ("C0:DINT", "it is INT, WORD, BOOL"),
        ("C200:INT", "it is DINT, DWORD, BOOL"),
        ("D0:BOOL", "it is INT, WORD, DINT, DWORD, REAL"),
        ("X0:INT", "it is BOOL"),
        ("K4M0:REAL", "it is INT, WORD, DINT, DWORD"),
        ("D0:FOO", "'FOO' is no type"),
        ("D0Z0", "name the device itself"),
        ("Lamp", "no device of EC20"),
    ],
)
def test_a_name_that_leads_nowhere_is_refused_with_the_remedy(plc, name, says):
    with pytest.raises(EcsimError, match=says):
        plc[name]


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("D0", 70000, r"70000 does not fit into D0 \(-32768 to 65535\)"),
        ("D0", 1.5, "write D0:REAL"),
        ("D0", None, "whole number"),
        ("C0", 2.5, "C0 takes a whole number, not 2.5$"),
        ("K1M0", 16, r"K1M0 \(0 to 15\)"),
        ("K1M0", -1, r"K1M0 \(0 to 15\)"),
        ("K1X0", 1.5, "whole number"),
        ("K1X0", 16, r"K1X0 \(0 to 15\)"),
        ("X0", 2, "one bit"),
        ("Y0", "1", "one bit"),
        ("D0:REAL", "1.5", "takes a number"),
        ("D0:REAL", 10**400, "takes a number"),
    ],
)
def test_a_value_that_does_not_fit_is_refused(plc, name, value, says):
    with pytest.raises(EcsimError, match=says):
        plc[name] = value


@pytest.mark.parametrize(
    ("name", "value", "read"),
    [
        ("D0", 40000, -25536),
        ("D0:WORD", -1, 65535),
        ("K4M0", -1, -1),
        ("K2M0", 255, 255),
        ("C200", -(2**31), -(2**31)),
        ("D0", numpy.int16(-3), -3),
        ("D0:REAL", numpy.float32(1.5), 1.5),
        ("D0:REAL", numpy.int64(3), 3.0),
        ("Y7", numpy.True_, 1),
    ],
)
def test_numbers_of_any_kind_are_taken_where_they_fit(plc, name, value, read):
    plc[name] = value
    assert plc[name] == read


def test_kn_on_inputs_sets_the_terminals(plc):
    plc["K1X4"] = 0b1010
    plc.scan()
    assert [plc[f"X{n}"] for n in (4, 5, 6, 7)] == [0, 1, 0, 1]


# -- forcing (2.4.6) ----------------------------------------------------------------------------------------------------


def test_the_contact_of_a_timer_is_forced_without_its_value(plc):
    plc.force("T0:BOOL", 1)
    plc.scan()
    assert (plc["T0"], plc["T0:BOOL"], plc["Y0"], plc.forced) == (0, 1, 1, {"T0:BOOL": 1})
    plc.unforce("T0:BOOL")
    plc.scan()
    assert (plc["Y0"], plc.forced) == (0, {})


def test_a_forced_register_holds_what_a_register_holds(plc):
    plc.force("D0", 65535)
    assert (plc["D0"], plc["D0:WORD"], plc.forced) == (-1, 65535, {"D0": -1})


def test_bits_and_contacts_share_the_limit_of_128(plc):
    for number in range(127):
        plc.force(f"M{number}", 1)
    plc.force("T0:BOOL", 1)
    with pytest.raises(EcsimError, match="128 bits are forced already"):
        plc.force("C0:BOOL", 1)
    plc.force("T0", 5)  # a word


@pytest.mark.parametrize("name", ["SM0", "SM12", "SD30"])
def test_what_the_system_writes_cannot_be_forced(plc, name):
    with pytest.raises(EcsimError, match=f"{name} cannot be forced"):
        plc.force(name, 0)


def test_a_forced_device_stays_forced_through_a_power_cycle(plc):
    plc.force("Y0", 1)
    plc.force("D5", 7)
    plc.power_cycle()
    plc.scan(3)
    assert (plc["Y0"], plc["D5"], plc.forced) == (1, 7, {"Y0": 1, "D5": 7})
    plc.unforce()
    plc.scan()
    assert (plc["Y0"], plc.forced) == (0, {})


@pytest.mark.parametrize("name", ["SM0", "SM100", "SD20", "SD19:DINT", "K4SM32"])
def test_what_the_system_writes_cannot_be_written_from_outside(plc, name):
    with pytest.raises(EcsimError, match=f"{name} cannot be written: the system writes it"):
        plc[name] = 0


def test_several_writes_are_done_all_or_none(plc):
    with pytest.raises(EcsimError, match="EC20 has no Y400"):
        plc.set({"D0": 5, "X3": 1, "Y400": 1})
    with pytest.raises(EcsimError, match="SM0 cannot be written"):
        plc.set({"D0": 5, "X3": 1, "SM0": 0})
    plc.scan()
    assert (plc["D0"], plc["X3"]) == (0, 0)
