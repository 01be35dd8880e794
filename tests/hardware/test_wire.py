"""What a line does to characters: their time, their bits, two at once."""

import pytest

from ecsim.errors import EcsimError
from ecsim.hardware.serial import PortSettings
from ecsim.hardware.wire import Framing, Wire, arrived
from ecsim.plc import Plc
from ecsim.system import SystemBlock

EIGHT_NONE, SEVEN_EVEN = Framing(9600, 8, "none", 1), Framing(9600, 7, "even", 1)
FREE = PortSettings("freeport")  # 9600 8N1: a character takes 10 / 9600 s


class Parrot:
    """An instrument that keeps what it heard and says it again."""

    def __init__(self):
        self.heard = []

    def hear(self, message):
        self.heard.append(message)
        return message


def freeport(program, settings=FREE, model="EC20"):
    """A running PLC with a program and freeport on port 1."""
    plc = Plc(model, input_filter_ms=0, system=SystemBlock(port1=settings))
    plc.load(program)
    plc.run()
    return plc


# -- bits -----------------------------------------------------------------------------------------------------------


def test_ends_with_the_same_settings_read_what_was_sent():
    assert [arrived(byte, EIGHT_NONE, EIGHT_NONE) for byte in (0, 65, 255)] == [(0, False), (65, False), (255, False)]


def test_seven_data_bits_carry_seven_bits():
    assert arrived(0xC1, SEVEN_EVEN, SEVEN_EVEN) == (0x41, False)


def test_an_end_without_parity_reads_the_parity_bit_as_the_eighth_data_bit():
    # A = 1000001: two ones, even parity 0; C = 1000011: three ones, even parity 1
    assert arrived(0x41, SEVEN_EVEN, EIGHT_NONE) == (0x41, False)
    assert arrived(0x43, SEVEN_EVEN, EIGHT_NONE) == (0xC3, False)


def test_the_other_parity_is_a_parity_error_in_every_character():
    odd = Framing(9600, 7, "odd", 1)
    assert all(arrived(byte, SEVEN_EVEN, odd)[1] for byte in range(128))


def test_half_the_baud_rate_makes_two_bits_of_each():
    # 16#55 sent at 4800: start 0, then 1 0 1 0 1 0 1 0, stop 1; read at 9600: start 0 0 1 1 0 0 1 1 0: the stop bit is a 0
    slow = Framing(4800, 8, "none", 1)
    assert arrived(0x55, slow, EIGHT_NONE) == (0b01100110, True)


# -- time -----------------------------------------------------------------------------------------------------------


def test_an_answer_comes_when_the_line_was_silent_for_three_and_a_half_characters_and_the_delay_is_over():
    plc = freeport("LD SM1\nXMT 1 D0 2\nRCV 1 D10 2")
    plc.ports[1].connect(Parrot(), delay_ms=4)
    plc["D0"], plc["D1"] = 0x41, 0x42
    plc.scan()
    # two characters of 1041.67 us; silence of 3.5 characters 3645.8 us; 4 ms; two characters back
    assert plc.ports[1].wire.log == [(0, "port 1", "4142")]
    assert plc["D10"] == 0
    plc.scan()
    assert plc.ports[1].wire.log[1:] == [(2083 + 3645 + 4000, "Parrot", "4142")]
    assert [plc["D10"], plc["D11"]] == [0x41, 0x42]


def test_two_stations_that_talk_at_once_spoil_each_other():
    plc = freeport("LD SM1\nXMT 1 D0 1\nRCV 1 D10 8")
    for _ in range(2):
        plc.ports[1].connect(Parrot())
    plc["D0"] = 0x41
    plc.scan(3)
    assert [entry[1] for entry in plc.ports[1].wire.log] == ["port 1", "Parrot", "Parrot 2"]
    assert plc["SD127"] == 0
    assert plc["SD125"] == 32  # a wrong character has ended the reception


def test_a_station_with_another_parity_hears_nothing():
    plc = freeport("LD SM1\nXMT 1 D0 1")
    parrot = Parrot()
    wire = Wire()
    wire.join(plc.ports[1])
    wire.join(parrot, framing=Framing(9600, 8, "even", 1))
    plc["D0"] = 0x41
    plc.scan(2)
    assert parrot.heard == []


def test_a_station_that_has_left_is_not_heard():
    plc = freeport("LD SM1\nXMT 1 D0 1\nRCV 1 D10 1")
    parrot = Parrot()
    plc.ports[1].connect(parrot)
    plc.ports[1].wire.leave(parrot)
    plc["D0"] = 0x41
    plc.scan(3)
    assert (parrot.heard, plc["SM123"]) == ([], 0)


class Counting:
    """An instrument that counts the time for which it was moved."""

    def __init__(self):
        self.ms = 0

    def hear(self, message):
        return bytes((self.ms,))

    def step(self, seconds):
        self.ms += round(1000 * seconds)


def test_an_instrument_that_moves_is_moved_on_with_the_time():
    plc = freeport("LD SM1\nOUT Y0")
    plc.scan(2)
    counting = Counting()
    plc.ports[1].connect(counting)
    plc.scan(5)
    assert counting.ms == 50


def test_going_back_takes_wire_and_instruments_back():
    plc = freeport("LD SM1\nXMT 1 D0 2\nRCV 1 D10 2")
    counting = Counting()
    plc.ports[1].connect(counting, delay_ms=30)
    plc.scan(2)
    snapshot = plc.snapshot()
    plc.scan(4)
    after = plc["D10"], plc["SD127"], counting.ms, plc.ports[1].wire.log
    assert after[:3] == (0, 1, 60)
    plc.restore(snapshot)
    assert (plc["SD127"], counting.ms, len(plc.ports[1].wire.log)) == (0, 20, 1)
    plc.scan(4)
    assert (plc["D10"], plc["SD127"], counting.ms, plc.ports[1].wire.log) == after


def test_what_cannot_be_connected_is_refused_in_words():
    plc = freeport("")
    with pytest.raises(EcsimError, match="it has no method hear"):
        plc.ports[1].connect(7)
    wire = Wire()
    with pytest.raises(EcsimError, match="needs a framing: join a port first"):
        wire.join(Parrot())
    plc.ports[1].connect(Parrot())
    with pytest.raises(EcsimError, match=r"is connected to .* already; leave that first"):
        wire.join(plc.ports[1])
    with pytest.raises(EcsimError, match="is not on <Wire 'wire': nothing>; on it are none"):
        wire.leave(plc.ports[0])
