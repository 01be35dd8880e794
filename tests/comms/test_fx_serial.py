"""The ports of H1U and H2U: RS in both modes, format and protocol by registers, the Modbus slave and its addresses, real lines."""

import os
import select
import socket
import tty
from struct import pack, unpack
from time import monotonic

import pytest

import ecsim
from ecsim import Session, SystemBlock
from ecsim.comms.frames import MODES
from ecsim.comms.slave import Slave
from ecsim.hardware.serial import PortSettings
from ecsim.modbus import serve
from ecsim.network import Network

both_models = pytest.mark.parametrize("model", ["H1U", "H2U"])
RS = """
LD M8002
MOV {format} D8120
LD X20
OUT M8161
LD M8000
RS D100 K{send} D200 K{receive}
LDP X0
SET M8122
LD X1
RST M8123
RST M8129
"""


class Instrument:
    """Remembers what it hears and answers each message in the same way."""

    def __init__(self, answer=None):
        self.heard, self.answer = [], answer

    def hear(self, message):
        self.heard.append(message)
        return self.answer


def machine(text, model="H2U", **settings):
    """A PLC in RUN with a program, inputs without filter."""
    plc = ecsim.Plc(model, input_filter_ms=0, **settings)
    plc.load(text)
    plc.run()
    return plc


def talking(answer=None, mode="H81", send=5, receive=5, model="H2U"):
    """A PLC with RS and the instrument on its port 1."""
    plc = machine(RS.format(format=mode, send=send, receive=receive), model)
    instrument = Instrument(answer)
    plc.scan()
    plc.ports[1].connect(instrument)
    return plc, instrument


def words(plc, first, count):
    return [plc[f"D{first + place}:WORD"] for place in range(count)]


# -- RS -----------------------------------------------------------------------------------------------------------------------


@both_models
def test_in_16_bit_mode_a_register_holds_two_characters_the_low_one_first(model):
    plc, instrument = talking(b"hello", model=model)
    plc.set({"D100": 0x4241, "D101": 0x4443, "D102": 0x5A45, "D202:WORD": 0x7700})
    plc["X0"] = 1
    plc.scan(20)
    assert instrument.heard == [b"ABCDE"]
    assert words(plc, 200, 3) == [0x6568, 0x6C6C, 0x776F]
    assert [plc["M8122"], plc["M8123"], plc["M8129"], plc["D8122"], plc["D8123"]] == [0, 1, 0, 0, 5]


def test_in_8_bit_mode_a_register_holds_one():
    plc, instrument = talking(b"hello")
    plc["X20"] = 1
    plc.set({f"D{100 + place}": 0x5500 + character for place, character in enumerate(b"ABCDE")})
    plc["X0"] = 1
    plc.scan(20)
    assert instrument.heard == [b"ABCDE"]
    assert words(plc, 200, 6) == [*b"hello", 0]


def test_the_format_asks_for_a_header_and_a_terminator():
    plc, instrument = talking(b"xx\x02up\x03", "H381", receive=30)
    plc.set({"D100": 0x4241, "D101": 0x4443, "D102": 0x45})
    plc["X0"] = 1
    plc.scan(20)
    assert instrument.heard == [b"\x02ABCDE\x03"]
    assert [plc["D200"], plc["D8123"], plc["M8123"]] == [0x7075, 2, 1]


def test_header_and_terminator_stand_in_d8124_and_d8125():
    plc = machine("LD M8002\nMOV H3A D8124\nMOV H0D D8125\nMOV H381 D8120\nLD M8000\nRS D100 K2 D200 K9\nLDP X0\nSET M8122")
    instrument = Instrument(b":ok\r")
    plc.scan()
    plc.ports[1].connect(instrument)
    plc["D100"] = 0x3231
    plc["X0"] = 1
    plc.scan(20)
    assert instrument.heard == [b":12\r"]
    assert [plc["D200"], plc["M8123"]] == [0x6B6F, 1]


def test_a_message_that_breaks_off_ends_by_its_time():
    plc, _ = talking(b"abc", receive=9)
    plc["D8129"] = 5
    plc["X0"] = 1
    plc.until("M8123", timeout_ms=500)
    ended = plc.time_us
    assert [plc["M8129"], plc["D8123"], plc["D200"]] == [1, 3, 0x6261]
    plc, _ = talking(b"abc", receive=9)
    plc["X0"] = 1
    plc.until("M8123", timeout_ms=500)
    assert plc.time_us - ended == 50_000  # 0 stands for 100 ms


def test_until_the_program_has_taken_a_message_no_other_is_received():
    plc, instrument = talking(b"12345")
    plc["X0"] = 1
    plc.scan(20)
    instrument.answer = b"67890"
    plc["X0"] = 0
    plc.scan()
    plc["X0"] = 1
    plc.scan(20)
    assert (len(instrument.heard), plc["D200"]) == (2, 0x3231)
    plc.set({"X0": 0, "X1": 1})
    plc.scan()
    assert [plc["M8123"], plc["M8129"]] == [0, 0]
    plc.set({"X0": 1, "X1": 0})
    plc.scan(20)
    assert [plc["M8123"], plc["D200"]] == [1, 0x3736]


def test_without_flow_nothing_is_sent_or_received_and_stop_ends_both():
    plc = machine("LD X2\nRS D100 K40 D200 K2\nLDP X0\nSET M8122")
    instrument = Instrument(b"ok")
    plc.ports[1].connect(instrument)
    plc["X0"] = 1
    plc.scan(10)
    assert (instrument.heard, plc["M8122"]) == ([], 1)
    plc["X2"] = 1
    plc.scan()
    plc.stop()
    plc.scan(10)
    assert (plc["D200"], plc["M8122"]) == (0, 0)


@pytest.mark.parametrize("text", ["RS D100 K257 D200 K1", "RS D100 K-1 D200 K1"])
def test_more_than_256_characters_are_an_operation_error(text):
    plc = machine(f"LD M8000\n{text}")
    plc.scan()
    assert [plc["M8067"], plc["D8067"]] == [1, 6706]


def test_rs_goes_on_where_a_snapshot_was_taken():
    plc, _ = talking(b"hello")
    plc.set({"D100": 0x4241, "D101": 0x4443, "D102": 0x45})
    plc["X0"] = 1
    plc.scan()
    kept = plc.snapshot()
    plc.scan(20)
    after = words(plc, 200, 3), plc["M8123"]
    plc.restore(kept)
    plc.scan(20)
    assert (words(plc, 200, 3), plc["M8123"]) == after
    assert after[1] == 1


# -- format and protocol ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("word", "expected"),
    [
        (0x81, (9600, 8, "none", 1)), (0x86, (9600, 7, "even", 1)), (0x8A, (9600, 7, "odd", 2)), (0x97, (19200, 8, "even", 1)),
        (0x31, (300, 8, "none", 1)), (0x79, (4800, 8, "none", 2)), (0xA1, (38400, 8, "none", 1)),
    ],
)  # fmt: skip
def test_d8120_sets_the_format(word, expected):
    plc = machine(f"LD M8002\nMOV H{word:X} D8120")
    plc.scan()
    framing = plc.ports[1].framing
    assert (framing.baud, framing.data_bits, framing.parity, framing.stop_bits) == expected


def test_a_rate_that_there_is_not_leaves_the_port():
    plc = machine("LD M8002\nMOV H1 D8120")
    plc.scan()
    assert plc.ports[1].framing.baud == 9600


@pytest.mark.parametrize(
    ("settings", "word", "code"),
    [
        (None, 0x81, 0x10),
        (PortSettings("modbus slave", station=7), 0x97, 2),
        (PortSettings("modbus slave", "ascii"), 0x96, 3),
        (PortSettings("rs", baud=4800, parity="odd", data_bits=7, stop_bits=2, start_char=5), 0x17A, 0x10),
    ],
)
def test_the_settings_of_the_system_block_stand_in_the_registers(settings, word, code):
    plc = ecsim.Plc("H2U", system=SystemBlock(port1=settings))
    assert [plc["D8120"], plc["D8126"], plc["D8121"]] == [word, code, settings.station if settings else 1]
    assert plc["D8124"] == (5 if code == 0x10 and settings else 2)


# -- Modbus -----------------------------------------------------------------------------------------------------------------------


def asked(plc, *request):
    """The slave's answer, function code first."""
    return Slave(plc.memory).answer(bytes(request))


def read(plc, function, address, count=1):
    return asked(plc, function, *pack(">HH", address, count))[2:]


BITS = [
    ("M0", 0x0000), ("M499", 499), ("M8000", 0x1F40), ("M8255", 0x203F), ("S0", 0xE000), ("S999", 0xE3E7),
    ("T0:BOOL", 0xF000), ("T255:BOOL", 0xF0FF), ("C0:BOOL", 0xF400), ("C255:BOOL", 0xF4FF),
    ("X0", 0xF800), ("X17", 0xF80F), ("X377", 0xF8FF), ("Y0", 0xFC00), ("Y20", 0xFC10), ("Y377", 0xFCFF),
]  # fmt: skip
WORDS = [("D0", 0), ("D7999", 7999), ("D8000", 8000), ("D8255", 8255), ("T0", 0xF000), ("T255", 0xF0FF), ("C0", 0xF400), ("C199", 0xF4C7)]


@both_models
@pytest.mark.parametrize(("name", "address"), BITS)
@pytest.mark.parametrize("function", [1, 2])
def test_bits_have_the_addresses_of_the_table(model, name, address, function):
    plc = ecsim.Plc(model)
    device, kind = plc.memory.parse(name)
    before = plc[name]
    assert read(plc, function, address) == bytes((before,))
    plc.memory.set(device, kind, 1 - before)
    assert read(plc, function, address) == bytes((1 - before,))


@both_models
@pytest.mark.parametrize(("name", "address"), WORDS)
def test_words_have_the_addresses_of_the_table(model, name, address):
    plc = ecsim.Plc(model)
    device, kind = plc.memory.parse(name)
    plc.memory.set(device, kind, -12345)
    assert read(plc, 3, address) == pack(">h", -12345)
    assert asked(plc, 6, *pack(">Hh", address, 321)) == bytes((6, *pack(">Hh", address, 321)))
    assert plc[name] == 321


@pytest.mark.parametrize(("number", "address"), [(200, 0xF700), (201, 0xF702), (255, 0xF76E)])
def test_counters_of_32_bits_take_two_addresses_the_low_word_first(number, address):
    plc = ecsim.Plc("H2U")
    plc[f"C{number}"] = 0x12345678
    assert read(plc, 3, address, 2) == bytes.fromhex("56781234")
    asked(plc, 16, *pack(">HHB", address, 2, 4), *bytes.fromhex("fffeffff"))
    assert plc[f"C{number}"] == -2
    assert asked(plc, 3, *pack(">HH", address + 1, 2)) == bytes((0x83, 2))


@pytest.mark.parametrize(
    ("model", "function", "address"),
    [
        ("H2U", 1, 3072), ("H1U", 1, 1536), ("H2U", 1, 8256), ("H2U", 1, 0xE3E8), ("H2U", 1, 0xF900), ("H2U", 3, 8256), ("H2U", 3, 0xF4C8),
        ("H2U", 3, 0xE000),
    ],
)  # fmt: skip
def test_between_the_runs_there_is_nothing(model, function, address):
    assert asked(ecsim.Plc(model), function, *pack(">HH", address, 1)) == bytes((function | 0x80, 2))


def test_inputs_and_what_the_system_writes_keep_their_values():
    plc = ecsim.Plc("H2U")
    for address in (0xF800, 8000):
        assert asked(plc, 5, *pack(">HH", address, 0xFF00))[0] == 5
    assert asked(plc, 6, *pack(">HH", 8010, 7))[0] == 6
    assert [plc["X0"], plc["M8000"], plc["D8010"]] == [0, 0, 0]
    assert asked(plc, 5, *pack(">HH", 8034, 0xFF00))[0] == 5
    assert plc["M8034"] == 1


@pytest.mark.parametrize(("code", "mode"), [(2, "rtu"), (3, "ascii")])
def test_the_program_makes_port_1_a_slave(code, mode):
    plc = machine(f"LD M8002\nMOV H{0x97 if mode == 'rtu' else 0x96:X} D8120\nMOV K9 D8121\nMOV K{code} D8126\nLD M8000\nMOV K4660 D0")
    plc.scan(2)
    request = MODES[mode].encode(9, bytes((3, 0, 0, 0, 1)))
    instrument = Instrument()
    end = plc.ports[1].connect(instrument)
    end.send(request, plc.time_us)
    plc.ports[1].stirred()
    plc.scan(10)
    assert instrument.heard == [MODES[mode].encode(9, bytes((3, 2, 0x12, 0x34)))]


@pytest.mark.parametrize("number", [0, 1])
def test_an_ec20_reads_and_writes_an_h2u(number):
    master = machine(
        "LD SM1\nMOV 5 D0\nMOV 3 D1\nMOV 0 D2\nMOV 100 D3\nMOV 0 D4\nMOV 2 D5\n"
        "MOV 5 D20\nMOV 6 D21\nMOV 1 D22\nMOV 0 D23\nMOV 2 D24\nMOV 186 D25\nLD X0\nMODBUS 1 D0 D100\nLD X1\nMODBUS 1 D20 D200",
        "EC20",
        system=SystemBlock(port1=PortSettings("modbus master")),
    )
    slave = machine(
        "LD M8000\nMOV K1234 D100\nMOV K-2 D101", system=SystemBlock(**{f"port{number}": PortSettings("modbus slave", station=5)})
    )
    network = Network(ec=master, h=slave)
    network.wire("ec.1", f"h.{number}")
    network.advance(ms=20)
    master["X0"] = 1
    network.advance(ms=100)
    assert [master[f"D{place}"] & 0xFF for place in range(103, 107)] == [*pack(">hh", 1234, -2)]
    master["X1"] = 1
    network.advance(ms=100)
    assert slave["D256"] == 2 * 256 + 186


# -- real lines -------------------------------------------------------------------------------------------------------------------


def test_serve_answers_over_tcp():
    plc = machine("LD M8000\nMOV K77 D5\nOUT Y1")
    plc.scan()
    with serve(plc, tcp=0) as server, socket.create_connection(("127.0.0.1", server.port), timeout=10) as peer:
        peer.sendall(pack(">HHHBBHH", 1, 0, 6, 1, 3, 5, 1))
        assert peer.recv(100)[7:] == bytes((3, 2, 0, 77))
        peer.sendall(pack(">HHHBBHH", 2, 0, 6, 1, 1, 0xFC00, 8))
        assert peer.recv(100)[7:] == bytes((1, 1, 2))


def test_rs_speaks_over_a_pseudo_terminal():
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    plc = machine(RS.format(format="H381", send=2, receive=9))
    plc["D100"] = 0x6968
    session = Session(plc)
    try:
        session.connect(1, os.ttyname(theirs))
        session.start()
        session.set("X0", 1)
        heard, patience = b"", monotonic() + 20
        while len(heard) < 4 and monotonic() < patience:
            if select.select([ours], [], [], 1)[0]:
                heard += os.read(ours, 100)
        assert heard == b"\x02hi\x03"
        os.write(ours, b"\x02yes\x03")
        assert session.until("M8123", timeout_ms=20_000) is not None
        assert plc["D200"] == unpack("<h", b"ye")[0]
    finally:
        session.stop()
        os.close(ours)
        os.close(theirs)
