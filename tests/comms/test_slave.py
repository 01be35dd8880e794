"""The slave against the manual's frames, its table of addresses and rules of 10.4 and appendix 7."""

import json
import struct
from pathlib import Path

import pytest

import ecsim
from ecsim.comms.frames import Heard, ascii_encode, rtu_encode
from ecsim.comms.slave import Slave

FACTS = Path(__file__).parent.parent / "facts"
PRINTED = json.loads((FACTS / "modbus_frames.json").read_text(encoding="utf-8"))
MAP = json.loads((FACTS / "modbus_map.json").read_text(encoding="utf-8"))
BOTH = pytest.mark.parametrize("model", ["EC10", "EC20"])


@pytest.fixture
def plc():
    return ecsim.Plc("EC20")


@pytest.fixture
def slave(plc):
    return Slave(plc.memory)


def request(function, *words, tail=b""):
    """A message of a function code, words and octets."""
    return bytes((function,)) + struct.pack(f">{len(words)}H", *words) + tail


def write_words(address, *words):
    return request(16, address, len(words), tail=bytes((2 * len(words),)) + struct.pack(f">{len(words)}H", *words))


def refused(function, code):
    return bytes((function | 0x80, code))


def number(name):
    """The number of a device's name; X and Y count in octal."""
    digits = name.lstrip("XYMSTCDZ")
    return int(digits, 8) if name[0] in "XY" else int(digits)


# -- the manual's frames ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("row", "model"), [pytest.param(row, model, id=f"{row['note']}, {model}") for row in PRINTED for model in row["models"]]
)
def test_the_printed_frames(row, model):
    plc = ecsim.Plc(model, input_filter_ms=0)
    plc.set(row["set"])
    plc.scan()
    answer = Slave(plc.memory).hear(Heard(bytes.fromhex(row["request"])), "rtu")
    assert answer.hex(" ").upper() == (row["response"] or row["response_if_all_off"])
    assert {name: plc[name] for name in row["expect"]} == row["expect"]


# -- the map ---------------------------------------------------------------------------------------------------


@BOTH
@pytest.mark.parametrize("row", MAP, ids=lambda row: f"{row['device']} {row['kind']} {row['address_first']}")
def test_every_row_of_the_map_at_its_first_and_last_address(row, model):
    plc = ecsim.Plc(model, input_filter_ms=0)
    slave = Slave(plc.memory)
    suffix = ":BOOL" if row["kind"] == "bit" and row["device"] in "TC" else ""
    for end in ("first", "last"):
        device, address = number(row[end]), row[f"address_{end}"]
        if row["kind"] == "dword":
            address -= end == "last"  # the last pair begins one address before the end
            plc.memory.lists["C"][device] = -5
            assert slave.answer(request(3, address, 2)) == b"\3\4\xff\xff\xff\xfb"
            continue
        there = device < plc.model.areas[row["device"]].count  # EC10 has half of X and Y
        name = row["device"] + row[end][len(row["device"]) :] + suffix
        if there and row["device"] not in ("SM", "SD"):
            plc[name] = 1
            plc.scan()
        function = row["functions"][0]
        value = int(plc[name]) & 0xFFFF if there else 0
        octets = b"\2" + value.to_bytes(2) if row["kind"] == "word" else b"\1" + bytes((value,))
        assert slave.answer(request(function, address, 1)) == bytes((function,)) + octets


def test_the_addresses_outside_the_map_do_not_exist(slave):
    known = {}
    for row in MAP:
        for function in row["functions"]:
            known.setdefault(function, set()).update(range(row["address_first"], row["address_last"] + 1))
    for function in (1, 2):
        for address in range(0x10000):
            answer = slave.answer(request(function, address, 1))
            assert (answer == refused(function, 2)) is (address not in known[function]), address
    for address in range(0x10000):
        pair = address >= 9700 and address in known[3]
        answer = slave.answer(request(3, address, 1))
        assert answer == refused(3, 3) if pair else (answer == refused(3, 2)) is (address not in known[3]), address


@pytest.mark.parametrize("function", sorted(set(range(256)) - {1, 2, 3, 5, 6, 8, 15, 16}))
def test_any_other_function_is_illegal(slave, function):
    assert slave.answer(request(function, 0, 1)) == refused(function, 1)


# -- reading and writing ------------------------------------------------------------------------------------------


def test_bits_are_packed_from_the_lowest_on_and_filled_up_with_0(plc, slave):
    plc.set({"M0": 1, "M3": 1, "M8": 1, "M9": 1, "M10": 1})
    assert slave.answer(request(1, 2000, 10)) == b"\1\2\x09\x03"


def test_registers_are_read_high_byte_first(plc, slave):
    plc.set({"D5": 0x1234, "D6": -2})
    assert slave.answer(request(3, 5, 2)) == b"\3\4\x12\x34\xff\xfe"


def test_a_long_number_and_a_real_have_their_high_word_first(plc, slave):
    plc.set({"D3:DINT": 0x12345678, "D8:REAL": 1.5})  # 1.5 is 3FC00000
    assert slave.answer(request(3, 3, 2)) == b"\3\4\x12\x34\x56\x78"
    assert slave.answer(request(3, 8, 2)) == b"\3\4\x3f\xc0\x00\x00"


def test_a_32_bit_counter_is_written_and_read_in_pairs(plc, slave):
    assert slave.answer(write_words(9700, 0xFFFF, 0xFFFE, 0x0001, 0x0002)) == b"\x10" + struct.pack(">HH", 9700, 4)
    assert (plc["C200"], plc["C201"]) == (-2, 65538)
    assert slave.answer(request(3, 9700, 4)) == b"\3\x08\xff\xff\xff\xfe\0\1\0\2"


@pytest.mark.parametrize(
    ("message", "code"),
    [
        (request(3, 9701, 2), 2),
        (request(3, 9700, 1), 3),
        (request(3, 9701, 1), 3),  # the count is looked at first
        (request(3, 9810, 4), 2),
        (request(3, 9811, 2), 2),
        (write_words(9701, 1, 2), 2),
        (write_words(9700, 1, 2, 3), 3),
        (request(6, 9700, 1), 2),
        (request(3, 9698, 4), 2),  # C198, C199 and C200: one kind in one request
    ],
)
def test_pairs_only(slave, message, code):
    assert slave.answer(message) == refused(message[0], code)


def test_one_coil(plc, slave):
    message = request(5, 2007, 0xFF00)
    assert slave.answer(message) == message
    assert plc["M7"] == 1
    assert slave.answer(request(5, 2007, 0)) == request(5, 2007, 0)
    assert plc["M7"] == 0
    assert slave.answer(request(5, 2007, 1)) == refused(5, 3)


def test_one_register(plc, slave):
    message = request(6, 100, 0xFFFE)
    assert slave.answer(message) == message
    assert plc["D100"] == -2
    assert slave.answer(request(6, 8503, 7)) == request(6, 8503, 7)
    assert plc["Z3"] == 7


def test_several_coils(plc, slave):
    assert slave.answer(request(15, 2019, 10, tail=b"\2\xcd\x01")) == request(15, 2019, 10)
    assert [plc[f"M{n}"] for n in range(19, 29)] == [1, 0, 1, 1, 0, 0, 1, 1, 1, 0]  # CD is 11001101


def test_several_registers(plc, slave):
    assert slave.answer(write_words(1, 10, 0x0102)) == request(16, 1, 2)
    assert (plc["D1"], plc["D2"]) == (10, 258)


def test_contacts_and_values_of_timers_and_counters_stand_apart(plc, slave):
    slave.answer(request(5, 8004, 0xFF00))
    slave.answer(request(6, 9004, 77))
    slave.answer(request(5, 9404, 0xFF00))
    assert (plc["T4:BOOL"], plc["T4"], plc["C204:BOOL"], plc["C204"]) == (1, 77, 1, 0)
    assert slave.answer(request(1, 8004, 1)) == b"\1\1\1"
    assert slave.answer(request(3, 9004, 1)) == b"\3\2\0\x4d"


@pytest.mark.parametrize(
    ("function", "address", "most"),
    [(1, 2000, 2000), (1, 0, 256), (1, 1200, 256), (2, 0, 256), (1, 6000, 992), (3, 0, 125), (3, 8500, 16), (3, 9700, 112)],
)
def test_the_most_that_one_request_reads(slave, function, address, most):
    answer = slave.answer(request(function, address, most))
    assert answer[0] == function
    assert answer[1] == len(answer) - 2 == (2 * most if function == 3 else -(-most // 8))
    for count in (0, most + 1, 0xFFFF):
        assert slave.answer(request(function, address, count)) == refused(function, 3)


@pytest.mark.parametrize(("function", "most"), [(15, 1968), (16, 120)])
def test_the_most_that_one_request_writes(slave, function, most):
    address = 2000 if function == 15 else 0
    for count, sound in ((most, True), (most + 1, False), (0, False)):
        octets = bytes(-(-count // 8) if function == 15 else 2 * count)
        answer = slave.answer(request(function, address, count, tail=bytes((len(octets) & 255,)) + octets))
        assert answer == (request(function, address, count) if sound else refused(function, 3))


@pytest.mark.parametrize(
    "message",
    [
        b"",
        b"\1",
        request(1, 0),
        request(3, 0, 1, tail=b"\0"),
        request(5, 2000),
        request(6, 0, 1, 1),
        request(15, 2000, 9, tail=b"\1\xff"),  # nine bits need two octets
        request(15, 2000, 8, tail=b"\2\xff"),
        request(16, 0, 2, tail=b"\4\0\0\0"),
        request(16, 0, 2, tail=b"\2\0\0"),
        request(16, 0, 1),
        request(8, 0),
        b"\x08",
    ],
)
def test_a_message_of_the_wrong_length_is_refused_and_changes_nothing(plc, slave, message):
    before = plc.memory.snapshot()
    assert slave.answer(message) == refused(message[0], 3) if message else slave.answer(message) == refused(0, 1)
    assert plc.memory.snapshot() == before


def test_a_write_that_reaches_beyond_the_end_changes_nothing(plc, slave):
    assert slave.answer(write_words(7999, 1, 2)) == refused(16, 2)
    assert plc["D7999"] == 0


# -- what is answered and ignored -----------------------------------------------------------------------------------


def test_inputs_cannot_be_written(plc, slave):
    assert slave.answer(request(5, 1200, 0xFF00)) == request(5, 1200, 0xFF00)
    assert slave.answer(request(15, 1200, 8, tail=b"\1\xff")) == request(15, 1200, 8)
    assert not any(plc.memory.lists["X"])
    assert slave.answer(request(5, 300, 0xFF00)) == refused(5, 2)


def test_read_only_special_devices_keep_their_values_and_the_others_take_theirs(plc, slave):
    before = plc["SD65"], plc["SD69"]
    assert slave.answer(write_words(8065, 1, 2, 3, 4, 5)) == request(16, 8065, 5)  # SD66 to SD68 may be written
    assert [plc[f"SD{n}"] for n in range(65, 70)] == [before[0], 2, 3, 4, before[1]]
    assert slave.answer(request(5, 4400, 0xFF00)) == request(5, 4400, 0xFF00)
    assert plc["SM0"] == 0
    slave.answer(request(5, 4440, 0xFF00))
    assert plc["SM40"] == 1


def test_ec10_answers_for_the_terminals_that_only_ec20_has():
    plc = ecsim.Plc("EC10")
    slave = Slave(plc.memory)
    assert slave.answer(request(15, 120, 16, tail=b"\2\xff\xff")) == request(15, 120, 16)  # Y170 to Y207
    assert slave.answer(request(1, 120, 16)) == b"\1\2\xff\x00"
    assert [plc[f"Y{n:o}"] for n in range(120, 128)] == [1] * 8


# -- forced devices (10.4.12) ---------------------------------------------------------------------------------------


def test_reads_give_what_the_program_has_written_not_what_is_forced(plc, slave):
    plc.load("LD SM0\nOUT Y0\nINC D0\nMOV 7 D1")
    plc.force("Y0", 0)
    plc.force("D1", 99)
    plc.run()
    plc.scan()
    assert (plc["Y0"], plc["D1"]) == (0, 99)
    assert slave.answer(request(1, 0, 1)) == b"\1\1\1"
    assert slave.answer(request(3, 0, 2)) == b"\3\4\0\1\0\7"


def test_a_write_to_a_forced_device_shows_when_it_is_read_and_after_nothing_else(plc, slave):
    plc.force("D1", 99)
    slave.answer(request(6, 1, 5))
    assert slave.answer(request(3, 1, 1)) == b"\3\2\0\5"
    assert plc["D1"] == 99


def test_a_forced_input_is_read_as_it_stands_on_its_terminal(slave, plc):
    plc.inputs.set_filter(0)
    plc.force("X1", 1)
    plc["X2"] = 1
    plc.scan()
    assert slave.answer(request(2, 0, 3)) == b"\2\1\4"


def test_the_way_back_keeps_what_lies_beneath_a_force(plc, slave):
    plc.force("D1", 99)
    slave.answer(request(6, 1, 5))
    kept = plc.snapshot()
    slave.answer(request(6, 1, 6))
    plc.unforce("D1")
    plc.restore(kept)
    assert slave.answer(request(3, 1, 1)) == b"\3\2\0\5"
    assert plc["D1"] == 99


# -- broadcast ---------------------------------------------------------------------------------------------------


def test_writes_to_all_are_carried_out_and_not_answered(plc, slave):
    for message in (request(5, 2000, 0xFF00), request(6, 0, 5), request(15, 2001, 1, tail=b"\1\1"), write_words(1, 6)):
        assert slave.receive(0, message) is None
    assert (plc["M0"], plc["D0"], plc["M1"], plc["D1"]) == (1, 5, 1, 6)


@pytest.mark.parametrize(
    "message", [request(1, 0, 1), request(3, 0, 1), request(8, 0, 7), request(8, 11, 0), request(4, 0, 1), request(6, 9999, 1)]
)
def test_no_other_message_to_all_is_answered(slave, message):
    assert slave.receive(0, message) is None


def test_an_error_in_a_broadcast_is_counted(slave):
    slave.receive(0, request(6, 9999, 1))
    assert count(slave, 13) == 1
    slave.receive(0, request(1, 0, 1))  # nothing is wrong with it, it is only not carried out
    assert count(slave, 13) == 1


def test_other_stations_are_none_of_its_business(plc, slave):
    assert slave.receive(2, request(6, 0, 5)) is None
    assert plc["D0"] == 0
    assert Slave(plc.memory, station=2).receive(2, request(6, 0, 5)) == request(6, 0, 5)


# -- diagnostics -------------------------------------------------------------------------------------------------


def count(slave, sub):
    """A counter, read by function 8; the reading itself counts as a message and an answer."""
    answer = slave.receive(slave.station, request(8, sub, 0))
    assert answer[:3] == bytes((8, 0, sub))
    return int.from_bytes(answer[3:])


@pytest.mark.parametrize("message", [request(8, 0, 0x1234), request(8, 1, 0), request(8, 1, 0xFF00), request(8, 10, 0)])
def test_what_is_echoed(slave, message):
    assert slave.answer(message) == message


@pytest.mark.parametrize(
    ("message", "code"),
    [(request(8, sub, 1), 3) for sub in (1, 4, 10, 11, 12, 13, 14, 15, 18)]
    + [(request(8, sub, 0), 1) for sub in (2, 3, 5, 9, 16, 17, 19, 0x0100, 0xFFFF)],
)
def test_what_of_function_8_is_refused(slave, message, code):
    assert slave.answer(message) == refused(8, code)


def test_the_counters_tell_of_the_line(slave):
    def hear(frame, **faults):
        return slave.hear(Heard(frame, **faults), "rtu")

    read = request(3, 0, 1)
    assert hear(rtu_encode(1, read))
    assert hear(rtu_encode(7, read)) is None
    assert hear(rtu_encode(1, request(4, 0, 1))) == rtu_encode(1, refused(4, 1))
    assert hear(rtu_encode(0, request(6, 0, 1))) is None
    assert hear(rtu_encode(1, read)[:-1] + b"\0") is None
    assert hear(rtu_encode(1, read), torn=True) is None
    assert hear(b"\1") is None
    assert hear(bytes(256), overrun=True) is None
    assert count(slave, 11) == 5  # sound ones with this one, whoever was meant
    assert count(slave, 12) == 3
    assert count(slave, 13) == 1
    assert count(slave, 14) == 7  # with the broadcast and the four that asked for counts
    assert count(slave, 15) == 1  # the broadcast
    assert count(slave, 18) == 1


def test_a_bad_ascii_frame_is_counted_and_not_answered(slave):
    sound = ascii_encode(1, request(3, 0, 1))
    assert slave.hear(Heard(sound), "ascii") == ascii_encode(1, b"\3\2\0\0")
    assert slave.hear(Heard(sound.replace(b"\r", b"0")), "ascii") is None
    assert slave.hear(Heard(sound.replace(b"3", b"g")), "ascii") is None
    assert count(slave, 12) == 2


@pytest.mark.parametrize("message", [request(8, 1, 0), request(8, 1, 0xFF00), request(8, 10, 0)])
def test_clearing_leaves_every_counter_at_0(slave, message):
    for faulty in (Heard(b"\1"), Heard(bytes(256), overrun=True), Heard(rtu_encode(1, request(4, 0, 0))), Heard(rtu_encode(0, b"\1"))):
        slave.hear(faulty, "rtu")
    slave.receive(1, message)
    assert count(slave, 11) == 1
    assert [count(slave, sub) for sub in (12, 13, 15, 18)] == [0, 0, 0, 0]
    slave.receive(0, message)
    assert count(slave, 14) == 1
    assert count(slave, 15) == 0


def test_counters_have_16_bits(slave):
    for _ in range(0x10000):
        slave.hear(Heard(b"\1"), "rtu")
    assert count(slave, 12) == 0
    slave.hear(Heard(b"\1"), "rtu")
    assert count(slave, 12) == 1


@pytest.mark.parametrize("station", [0, 1])
def test_listen_only_mode_ends_with_a_restart_alone(plc, slave, station):
    assert slave.receive(station, request(8, 4, 0)) is None
    for message in (
        request(6, 0, 5),
        request(3, 0, 1),
        request(8, 0, 1),
        request(8, 10, 0),
        request(8, 11, 0),
        request(4, 0, 0),
        request(8, 1, 2),
    ):
        assert slave.receive(1, message) is None
    assert plc["D0"] == 0
    assert slave.receive(station, request(8, 1, 0xFF00)) is None  # it was still only listening
    assert slave.receive(1, request(3, 0, 1)) == b"\3\2\0\0"


def test_messages_are_counted_in_listen_only_mode(slave):
    slave.receive(1, request(8, 4, 0))
    slave.receive(1, request(3, 0, 1))
    slave.receive(1, request(4, 0, 1))
    assert (slave.counts["messages"], slave.counts["addressed"], slave.counts["unanswered"], slave.counts["exceptions"]) == (3, 3, 3, 0)


def test_state_is_plain_data_and_comes_back(slave, plc):
    slave.receive(1, request(8, 4, 0))
    state = json.loads(json.dumps(slave.state()))
    other = Slave(plc.memory)
    other.restore(state)
    assert other.receive(1, request(3, 0, 1)) is None
    assert other.counts["messages"] == 2
    assert slave.counts["messages"] == 1
    other.restart()
    assert other.receive(1, request(8, 11, 0)) == request(8, 11, 1)


def test_writes_go_by_the_way_they_are_given(plc):
    writes = []
    slave = Slave(plc.memory, write=lambda *write: writes.append(write))
    assert slave.answer(request(6, 3, 9)) == request(6, 3, 9)
    assert plc["D3"] == 0
    assert writes == [("D", 3, [9])]
