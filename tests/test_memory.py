"""Devices by name: forms and suffixes, word order, Kn, forcing. What is refused, and how, stands in test_reaching_devices.py."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ecsim.errors import EcsimError
from ecsim.memory import Memory
from ecsim.models import get_model
from ecsim.plc import Plc
from ecsim.values import BOOL, DINT, DWORD, INT, REAL, WORD

MODELS = ["EC10", "EC20"]
PLC = Plc("EC20")  # in STOP: nothing but the properties below writes it


@pytest.fixture(params=MODELS)
def plc(request):
    """A PLC in STOP."""
    return Plc(request.param)


@pytest.fixture
def memory():
    """The memory of an EC20."""
    return Memory(get_model("EC20"))


@pytest.mark.parametrize(
    ("name", "device", "kind"),
    [
        ("D0", "D0", INT), ("d0", "D0", INT), (" D0 ", "D0", INT), ("D0:DINT", "D0", DINT), ("D0:real", "D0", REAL), ("D0: WORD", "D0", WORD), ("D0:DWORD", "D0", DWORD),
        ("X17", "X17", BOOL), ("Y0:BOOL", "Y0", BOOL), ("SM12", "SM12", BOOL), ("T0", "T0", INT), ("T0:BOOL", "T0", BOOL), ("T0:WORD", "T0", WORD),
        ("C199", "C199", INT), ("C200", "C200", DINT), ("C200:BOOL", "C200", BOOL), ("C200:DWORD", "C200", DWORD), ("K4M0", "K4M0", INT), ("K1X10", "K1X10", INT),
        ("K8M0", "K8M0", DINT), ("K5M0", "K5M0", DINT), ("K4M0:WORD", "K4M0", WORD), ("Z15", "Z15", INT), ("V63", "V63", INT), ("SD3", "SD3", INT),
    ],
)  # fmt: skip
def test_a_name_is_a_device_and_a_type(memory, name, device, kind):
    found, type_ = memory.parse(name)
    assert (str(found), type_) == (device, kind)


@pytest.mark.parametrize(
    ("words", "readings"),
    [
        ((-1, -2), {"D0": -1, "D0:WORD": 65535, "D0:DINT": -2, "D0:DWORD": 0xFFFF_FFFE, "D1": -2}),
        ((1, 0), {"D0:DINT": 65536, "D0:DWORD": 65536}),
        ((-32768, 0), {"D0:DINT": -(2**31), "D0:DWORD": 2**31}),
        ((0x4048, -0x0A3D), {"D0:REAL": struct.unpack(">f", bytes.fromhex("4048f5c3"))[0]}),
    ],
)
def test_the_high_word_is_in_the_lower_register(plc, words, readings):
    plc["D0"], plc["D1"] = words
    assert {name: plc[name] for name in readings} == readings


@given(st.integers(-(2**31), 2**32 - 1))
def test_thirty_two_bits_read_back_signed_and_unsigned(value):
    plc = PLC
    plc["D10:DINT"] = value
    assert plc["D10:DWORD"] == value % 2**32
    assert plc["D10:DINT"] == (value + 2**31) % 2**32 - 2**31
    assert (plc["D10:WORD"], plc["D11:WORD"]) == divmod(value % 2**32, 2**16)


@given(st.integers(1, 8), st.integers(0, 40), st.integers(0, 2**32 - 1))
def test_kn_groups_bits_with_the_lowest_first(digits, first, value):
    plc = PLC
    value %= 16**digits
    plc[f"K{digits}M{first}:{'DWORD' if digits > 4 else 'WORD'}"] = value
    assert [plc[f"M{first + place}"] for place in range(4 * digits)] == [value >> place & 1 for place in range(4 * digits)]
    signed = value - 16**digits if digits in (4, 8) and value >> (4 * digits - 1) else value
    assert plc[f"K{digits}M{first}"] == signed


def test_kn_on_inputs_counts_in_octal(plc):
    plc["X7"] = plc["X10"] = 1
    plc.scan(3)
    assert plc["K1X5"] == 0b1100  # X5 X6 X7 X10
    assert plc["K2X10"] == 1


def test_a_written_kn_leaves_its_neighbours_alone(plc):
    plc.set({"M3": 1, "M8": 1})
    plc["K1M4"] = 0
    assert (plc["M3"], plc["M8"]) == (1, 1)


def test_counters_beyond_199_hold_thirty_two_bits(plc):
    plc["C200"] = 2**31 - 1
    plc["C199"] = -1
    assert (plc["C200"], plc["C199"], plc["C199:WORD"]) == (2**31 - 1, -1, 65535)
    plc["C235:DWORD"] = 2**32 - 1
    assert plc["C235"] == -1


def test_value_and_contact_of_a_timer_are_two_things(plc):
    plc["T5"] = 7
    plc["T6:BOOL"] = 1
    assert (plc["T5"], plc["T5:BOOL"], plc["T6"], plc["T6:BOOL"]) == (7, 0, 0, 1)


@pytest.mark.parametrize("value", [True, 1.0, 1])
def test_a_bit_takes_what_equals_one(plc, value):
    plc["M0"] = value
    assert plc["M0"] == 1
    assert type(plc["M0"]) is int


def test_a_name_of_the_program_may_have_a_type(plc):
    plc.load("VAR_GLOBAL\nLevel AT D4\nDone AT T3\nEND_VAR\nPROGRAM MAIN\nEND_PROGRAM")
    plc["level:REAL"] = 1.5
    plc["Done:BOOL"] = 1
    assert (plc["D4:REAL"], plc["T3:BOOL"], plc["LEVEL:DWORD"]) == (1.5, 1, 0x3FC0_0000)
    assert plc.names == {"D4": "Level", "T3": "Done"}


# -- forcing (2.2) ------------------------------------------------------------------------------------------------


def test_a_forced_device_keeps_its_value_whatever_writes_it():
    plc = Plc("EC20", input_filter_ms=0)
    plc.load("LD SM0\nOUT Y0\nMOV 7 D0\nMOV 3 K1M0\nLD X0\nOUT Y1\nLD Y0\nOUT Y2")
    plc.force("Y0", 0)
    plc.force("D0", -5)
    plc.force("X0", 1)
    plc.force("M1", 0)
    plc.run()
    plc.scan()
    plc["D0"] = 9
    assert {name: plc[name] for name in ("Y0", "D0", "Y1", "Y2", "K1M0")} == {"Y0": 0, "D0": -5, "Y1": 1, "Y2": 0, "K1M0": 1}
    assert plc.forced == {"X0": 1, "Y0": 0, "M1": 0, "D0": -5}


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
def test_what_is_released_is_written_again(engine):
    plc = Plc("EC20", input_filter_ms=0)
    plc.engine = engine
    plc.load("LD X0\nOUT Y0\nLD SM0\nINC D0")
    plc.run()
    plc.force("X0", 1)
    plc.force("D0", 100)
    plc.scan(2)
    assert (plc["Y0"], plc["D0"]) == (1, 100)
    plc.unforce("X0")
    plc.unforce("D0")
    plc.scan()
    assert (plc["Y0"], plc["D0"]) == (0, 101)
    assert plc.forced == {}


def test_a_forced_input_shows_its_terminal_again_when_it_is_released():
    plc = Plc("EC20", input_filter_ms=0)
    plc["X3"] = 1
    plc.force("X3", 0)
    plc.scan()
    assert plc["X3"] == 0
    plc.unforce("X3")
    plc.scan()
    assert plc["X3"] == 1


def test_forcing_again_changes_the_value_and_counts_once():
    plc = Plc("EC20")
    for value in range(30):
        plc.force("D0", value)
    assert plc.forced == {"D0": 29}


@pytest.mark.parametrize(
    ("names", "most"),
    [
        ([f"M{n}" for n in range(100)] + [f"Y{n:o}" for n in range(28)], 128),
        ([f"D{n}" for n in range(10)] + [f"V{n}" for n in range(6)], 16),
    ],
)
def test_so_many_devices_are_forced_and_no_more(names, most):
    plc = Plc("EC20")
    for name in names:
        plc.force(name, 1)
    assert len(plc.forced) == most
    more = "S0" if most == 128 else "Z0"
    with pytest.raises(EcsimError, match=f"{most} (bits|words) are forced already; release one first"):
        plc.force(more, 1)
    plc.unforce(names[0])
    plc.force(more, 1)
    assert len(plc.forced) == most


def test_all_are_released_at_once():
    plc = Plc("EC20")
    for name in ("X0", "M0", "D0", "T0"):
        plc.force(name, 1)
    plc.unforce()
    assert plc.forced == {}


def test_what_is_not_forced_cannot_be_released():
    plc = Plc("EC20")
    with pytest.raises(EcsimError, match="M0 is not forced"):
        plc.unforce("M0")
    plc.force("M1", 1)
    with pytest.raises(EcsimError, match="M0 is not forced"):
        plc.unforce("M0")


@pytest.mark.parametrize("name", ["D0:DINT", "K4M0", "C200", "D0:REAL"])
def test_one_bit_or_one_register_is_forced_at_a_time(name):
    with pytest.raises(EcsimError, match="can be forced"):
        Plc("EC20").force(name, 1)


def test_a_write_of_many_devices_goes_around_the_forced_ones(memory):
    device, kind = memory.parse("M3")
    memory.force(device, kind, 1)
    memory.lists["M"][0:8] = [False] * 8
    memory.clear("M")
    assert [n for n, bit in enumerate(memory.lists["M"]) if bit] == [3]


def test_the_lists_keep_their_identity_until_something_is_forced(memory):
    before = memory.lists["D"]
    memory.clear("D")
    memory.restore(memory.snapshot())
    assert memory.lists["D"] is before
    generation = memory.generation
    memory.force(*memory.parse("D0"), 1)
    assert memory.lists["D"] is not before
    assert memory.generation == generation + 1


def test_a_snapshot_is_a_copy(memory):
    kept = memory.snapshot()
    memory.set(*memory.parse("D5"), 42)
    assert kept["D"][5] == 0
    memory.restore(kept)
    assert memory.get(*memory.parse("D5")) == 0


def test_what_comes_through_a_port_passes_by_inputs_and_what_the_system_writes(memory):
    memory.receive("X", 0, [True, True])
    assert not any(memory.lists["X"])
    memory.receive("SM", 39, [True, True, True])
    assert memory.lists["SM"][38:43] == [False, False, True, True, False]
    memory.receive("SD", 65, [1, 2, 3, 4, 5])
    assert memory.lists["SD"][64:71] == [0, 0, 2, 3, 4, 0, 0]
    memory.receive("D", 10, [-7, 8])
    assert memory.lists["D"][9:13] == [0, -7, 8, 0]
    memory.receive("TB", 5, [True])
    assert memory.lists["TB"][5] is True


def test_what_comes_through_a_port_leaves_forced_devices(memory):
    memory.force(*memory.parse("D3"), 4)
    memory.receive("D", 2, [7, 7, 7])
    assert memory.lists["D"][2:5] == [7, 4, 7]
