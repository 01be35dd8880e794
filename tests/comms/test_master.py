"""The Modbus master of a port: what is asked again, what is told, gaps and half-heard answers (6.12.1, appendix 4)."""

import pytest

from ecsim.hardware.serial import PortSettings
from ecsim.hardware.wire import Framing
from ecsim.network import Network
from ecsim.plc import Plc
from ecsim.system import SystemBlock

PROGRAM = "LD M0\nMODBUS 1 D0 D100\nLD M1\nMODBUS 1 D10 D200"


def crc(octets):
    """The CRC of Modbus, bit by bit."""
    register = 0xFFFF
    for octet in octets:
        register ^= octet
        for _ in range(8):
            register = register >> 1 ^ (0xA001 if register & 1 else 0)
    return register.to_bytes(2, "little")


class Script:
    """An instrument that answers from a list, None for no answer, and keeps the requests."""

    def __init__(self, *answers):
        self.answers, self.requests = list(answers), []

    def hear(self, message):
        self.requests.append(message)
        return self.answers.pop(0) if self.answers else None

    def state(self):
        return list(self.answers), list(self.requests)

    def restore(self, state):
        self.answers, self.requests = map(list, state)


ECHO = bytes.fromhex("020600010002")
GOOD, BAD = ECHO + crc(ECHO), ECHO + b"\0\0"


def asked(*answers, ms=200, framing=None, delay_ms=2, **settings):
    """A master that has asked station 2 to write 2 into its register 1, and the instrument that answered."""
    plc = Plc("EC20", input_filter_ms=0, system=SystemBlock(port1=PortSettings("modbus master", **{"timeout_ms": 50} | settings)))
    plc.load(PROGRAM)
    plc.run()
    script = Script(*answers)
    plc.ports[1].connect(script, delay_ms=delay_ms)
    if framing is not None:
        plc.ports[1].wire.stations[0].framing = framing
    plc.set({f"D{place}": octet for place, octet in enumerate(ECHO)} | {"M0": 1})
    plc.advance(ms=ms)
    return plc, script


def outcome(plc):
    """Done, failed, error code, first register of the answer."""
    return plc["SM135"], plc["SM136"], plc["SD139"], plc["D100"]


def test_a_good_answer_is_stored():
    plc, script = asked(GOOD)
    assert outcome(plc) == (1, 0, 0, 2)
    assert script.requests == [GOOD]  # request and answer are the same message
    assert plc["SM123"] == 1


@pytest.mark.parametrize(("retries", "requests", "result"), [(0, 1, (1, 1, 0x11, 0)), (1, 2, (1, 0, 0, 2))])
def test_a_bad_answer_is_asked_for_again_as_often_as_is_allowed(retries, requests, result):
    plc, script = asked(BAD, GOOD, retries=retries)
    assert (len(script.requests), outcome(plc)) == (requests, result)


def test_an_exception_is_no_reason_to_ask_again():
    plc, script = asked(bytes.fromhex("028602") + crc(bytes.fromhex("028602")), GOOD, retries=3)
    assert (len(script.requests), outcome(plc)) == (1, (1, 1, 2, 0))


def test_the_program_may_change_time_out_and_retries():
    plc, script = asked(None, None, None, ms=20)
    plc.set({"SD136": 100, "SD137": 1, "M0": 0})
    plc.advance(ms=100)
    script.requests.clear()
    plc["M0"] = 1
    plc.advance(ms=180)  # the request 4.6 ms, 100 ms; again 4.6 ms, 100 ms: the second time-out is at 209 ms
    assert (len(script.requests), outcome(plc)[:3]) == (2, (0, 0, 0))
    plc.advance(ms=40)
    assert outcome(plc)[:3] == (1, 1, 0x10)


def test_the_time_out_waits_for_the_first_character_of_the_answer_only():
    # 8 characters of 11 bits at 19200 baud take 4.6 ms: the answer begins 7 ms behind the request and ends 11.6 ms behind it
    plc, _ = asked(GOOD, timeout_ms=9, delay_ms=5)
    assert outcome(plc) == (1, 0, 0, 2)


def test_an_answer_that_begins_too_late_is_lost():
    plc, _ = asked(GOOD, timeout_ms=9, delay_ms=8)
    assert outcome(plc) == (1, 1, 0x10, 0)


def test_an_answer_with_another_parity_cannot_be_read():
    plc, script = asked(GOOD, framing=Framing(19200, 8, "odd", 1))
    assert script.requests == []  # nor can the request
    assert outcome(plc)[:3] == (1, 1, 0x10)


def test_what_comes_while_nothing_was_asked_is_passed_over():
    plc, _ = asked(GOOD)
    station = plc.ports[1].wire.stations[0]
    station.send(BAD, plc.time_us)
    plc.ports[1].stirred()
    plc.advance(ms=50)
    assert (outcome(plc), plc["SM124"]) == ((1, 0, 0, 2), 1)


def test_a_gap_in_the_answer_tears_it():
    plc, _ = asked(None, ms=10)
    station = plc.ports[1].wire.stations[0]
    station.send(GOOD[:4], plc.time_us)
    plc.ports[1].stirred()
    plc.advance(ms=10)  # 4 characters take 2.3 ms; then 7.7 ms of silence, 3.5 characters are 2 ms
    assert outcome(plc)[:3] == (1, 1, 0x11)


def test_the_way_back_leads_into_the_middle_of_an_exchange():
    plc, script = asked(BAD, GOOD, retries=1, ms=10)
    snapshot = plc.snapshot()
    plc.advance(ms=100)
    first = outcome(plc), list(script.requests), plc.ports[1].wire.log
    plc.restore(snapshot)
    assert outcome(plc)[0] == 0
    plc.advance(ms=100)
    assert (outcome(plc), script.requests, plc.ports[1].wire.log) == first


@pytest.mark.parametrize("function", [4, 7, 11, 17, 23])
def test_a_function_that_is_none_is_not_sent(function):
    plc, script = asked(ms=0)
    plc.set({"D1": function})
    plc.advance(ms=50)
    assert (script.requests, plc["SD139"]) == ([], 1)


def with_slave(scan_ms=10, **settings):
    """A master and an EC20 as station 5 on one wire; both run."""
    master = Plc("EC20", input_filter_ms=0, system=SystemBlock(port1=PortSettings("modbus master", **settings)))
    master.load("LD M0\nMODBUS 1 D0 D100")
    block = SystemBlock(watchdog_ms=1000, port1=PortSettings("modbus slave", station=5))
    slave = Plc("EC20", scan_ms=scan_ms, input_filter_ms=0, system=block)
    network = Network(master=master, slave=slave)
    network.wire("master.1", "slave.1")
    master.run()
    slave.run()
    return network, master, slave


def test_the_first_example_of_the_manual():
    # 10.4.14: 29 bits of station 5 from address 11 on, Y13 to Y47, packed from the lowest bit up and filled with zeros
    network, master, slave = with_slave()
    printed = "00110000101101100011011100001"  # as it prints them, address 39 first
    slave.set({f"Y{11 + place:o}": int(bit) for place, bit in enumerate(reversed(printed))})
    master.set(dict(zip([f"D{place}" for place in range(6)], (5, 1, 0, 11, 0, 29), strict=True)) | {"M0": 1})
    network.advance(ms=100)
    assert [master[f"D{place}"] for place in range(100, 107)] == [5, 1, 4, 0b11100001, 0b11000110, 0b00010110, 0b00110]


@pytest.mark.parametrize(("timeout_ms", "code"), [(200, 0x10), (350, 0)])
def test_a_slave_with_scans_of_300_ms_needs_a_time_out_beyond_them(timeout_ms, code):
    # 10.4.14 has these scans and recommends 350 ms
    network, master, _ = with_slave(scan_ms=300, timeout_ms=timeout_ms)
    master.set({"D0": 5, "D1": 3, "D5": 1, "M0": 1})
    network.advance(ms=900)
    assert (master["SM135"], master["SD139"]) == (1, code)
