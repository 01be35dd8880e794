"""Several PLCs on wires in one time: masters, slaves and instruments, the same run whatever the order (chapter 10)."""

import pytest

from ecsim.errors import EcsimError
from ecsim.hardware.serial import PortSettings
from ecsim.network import Network
from ecsim.plc import Plc
from ecsim.system import SystemBlock

# Polls stations 2, 3 and 4 in turn for D0 and keeps each answer from D(100 * station) on; then writes D10 of all of them.
MASTER = """
LD SM1
MOV 2 D0
MOV 3 D1
MOV 0 D2
MOV 0 D3
MOV 0 D4
MOV 1 D5
LD SM135
INC D50
INC D0
LD SM136
INC D51
LD SM135
RST SM135
LD> D0 4
MOV 2 D0
LD SM0
MUL D0 100 D20
MOV D21 Z1
LD SM124
ANI M0
OUT M0
LD M0
MODBUS 1 D0 D0Z1
"""


def master(program, scan_ms=10, **settings):
    """A running master on port 1."""
    plc = Plc("EC20", scan_ms, 0, SystemBlock(port1=PortSettings("modbus master", station=1, **settings)))
    plc.load(program)
    plc.run()
    return plc


def slave(station, scan_ms=10, program="LD SM0\nINC D0"):
    """A running slave on port 1 that counts its scans in D0."""
    plc = Plc("EC20", scan_ms, 0, SystemBlock(port1=PortSettings("modbus slave", station=station)))
    plc.load(program)
    plc.run()
    return plc


READ = "LD M0\nEU\nMODBUS 1 D0 D100"


def pair(scan_ms=10, slave_scan_ms=10, program="LD SM0\nINC D0"):
    """A master that reads D0 of a slave when M0 rises."""
    network = Network(head=master(READ, scan_ms), tail=slave(2, slave_scan_ms, program))
    network.wire("head.1", "tail.1")
    network["head"].set({"D0": 2, "D1": 3, "D5": 1})
    return network


def test_a_master_reads_a_slave_over_the_wire():
    network = pair()
    network["head"]["M0"] = 1
    network.advance(ms=50)
    assert [network["head"][f"D{100 + place}"] for place in range(3)] == [2, 3, 2]
    assert (network["head"]["SM135"], network["head"]["SM136"]) == (1, 0)


def test_each_character_takes_its_time_and_the_slave_answers_in_its_next_communication():
    network = pair()
    network["head"]["M0"] = 1
    network.advance(ms=50)
    (asked, who, request), (answered, other, answer) = network.log
    # 8 characters of 11 bits at 19200 baud are 4.58 ms, the silence of 3.5 characters 2 ms: the slave's next scan is at 10 ms
    assert (asked, who, request) == (0, "head.1", "020300000001" + "8439")
    assert (answered, other) == (10_000, "tail.1")
    # its program has counted the scans at 0 ms and 10 ms when it answers
    assert answer.startswith("0203020002")
    assert network["head"]["D104"] == 2


def test_members_with_other_scan_times_meet_at_the_right_moments():
    network = pair(scan_ms=3, slave_scan_ms=7)
    network["head"]["M0"] = 1
    network.advance(ms=100)
    # the request ends after 4.583 ms, with the silence at 6.588 ms; the slave's scans begin at 0, 7, 14 ms
    assert [entry[0] for entry in network.log] == [0, 7_000]


def test_a_slave_that_is_too_slow_is_a_time_out():
    network = pair(slave_scan_ms=600)  # 10.4.14: the time-out must be longer than the slave's scan
    network.advance(ms=10)
    network["head"]["M0"] = 1
    network.advance(ms=590)
    assert (network["head"]["SM136"], network["head"]["SD139"]) == (1, 0x10)


def test_a_slave_answers_in_stop_too():
    network = pair()
    network["tail"].stop()
    network["head"]["M0"] = 1
    network.advance(ms=50)
    assert network["head"]["SM135"] == 1


def test_a_slave_without_power_is_silent_and_answers_again_afterwards():
    network = pair()
    network["tail"].power_off()
    network["head"]["M0"] = 1
    network.advance(ms=600)
    assert network["head"]["SD139"] == 0x10
    network["tail"].power_on()
    network["head"]["M0"] = 0
    network.advance(ms=10)
    network["head"]["M0"] = 1
    network.advance(ms=50)
    assert (network["head"]["SM135"], network["head"]["SD139"]) == (1, 0)


class Lamp:
    """An instrument that keeps the messages it heard."""

    def __init__(self):
        self.heard = []

    def hear(self, message):
        self.heard.append(message.hex())


def line(order="mabc"):
    """A master, three slaves and a listening instrument on one wire, joined in some order."""
    made = {"m": master(MASTER, 5), "a": slave(2), "b": slave(3, 7), "c": slave(4, 13)}
    network = Network(**{name: made[name] for name in order})
    lamp = Lamp()
    network.wire(*(f"{name}.1" for name in order[::-1]), lamp, name="line")
    return network, lamp


def test_a_master_polls_three_slaves_on_one_wire():
    network, lamp = line()
    network.advance(ms=2000)
    plc = network["m"]
    assert plc["D50"] > 30  # exchanges
    assert plc["D51"] == 0  # errors
    assert all(plc[f"D{100 * station}"] == station for station in (2, 3, 4))
    assert len(lamp.heard) == len(network.log)
    # what each slave told are the scans that it had done by then: one every 10, 7 and 13 ms
    told = [plc[f"D{100 * station + 3}"] * 256 + plc[f"D{100 * station + 4}"] for station in (2, 3, 4)]
    assert all(0.9 * 2000 / scan_ms < scans <= 1 + 2000 / scan_ms for scans, scan_ms in zip(told, (10, 7, 13), strict=True))


def test_the_same_run_twice_and_in_another_order_gives_the_same_log():
    logs = []
    for order in ("mabc", "mabc", "cbam", "bmca"):
        network, lamp = line(order)
        for _ in range(50):
            network.advance(ms=17)
        logs.append((network.log, lamp.heard, [network["m"][f"D{number}"] for number in range(500)]))
    assert len(logs[0][0]) > 20
    assert logs[1] == logs[2] == logs[3] == logs[0]


def test_the_steps_of_advance_change_nothing():
    whole, parts = line()[0], line()[0]
    whole.advance(ms=1000)
    for _ in range(3000):
        parts.advance(ms=1 / 3)
    parts.advance(ms=(whole.time_us - parts.time_us) / 1000)
    assert parts.log == whole.log


def test_going_back_in_the_middle_of_a_frame_repeats_the_same_run():
    network, _ = line()
    network.advance(ms=303.4)
    snapshot = network.snapshot()
    network.advance(ms=500)
    first = network.log, [network["m"][f"D{number}"] for number in range(500)]
    network.restore(snapshot)
    assert len(network.log) < len(first[0])
    network.advance(ms=500)
    assert (network.log, [network["m"][f"D{number}"] for number in range(500)]) == first


def test_two_masters_that_talk_at_once_spoil_each_others_requests():
    network = Network(one=master(READ, parity="even"), two=master(READ, parity="even"), tail=slave(2))
    network.wire("one.1", "two.1", "tail.1")
    for name in ("one", "two"):
        network[name].set({"D0": 2, "D1": 3, "D5": 1, "M0": 1})
    network.advance(ms=600)
    assert [network[name]["SD139"] for name in ("one", "two")] == [0x10, 0x10]
    assert [entry[1] for entry in network.log] == ["one.1", "two.1"]


def test_a_plc_may_join_later_and_leave():
    network = Network(head=master(READ))
    wire = network.wire("head.1")
    network["head"].set({"D0": 2, "D1": 3, "D5": 1, "M0": 1})
    network.advance(ms=600)
    assert network["head"]["SD139"] == 0x10
    late = slave(2)
    late.scan(3)
    network.add("tail", late)
    wire.join(late.ports[1])
    for level in (0, 1):
        network["head"]["M0"] = level
        network.advance(ms=50)
    assert (network["head"]["SM135"], network["head"]["SD139"]) == (1, 0)
    assert network.remove("tail") is late
    late.scan()
    for level in (0, 1):
        network["head"]["M0"] = level
        network.advance(ms=550)
    assert network["head"]["SD139"] == 0x10


def test_what_cannot_be_is_refused_in_words():
    network = pair()
    with pytest.raises(EcsimError, match="has a member 'head' already"):
        network.add("head", Plc())
    with pytest.raises(EcsimError, match="is a member of the network already"):
        network.add("other", network["head"])
    with pytest.raises(EcsimError, match="the network has no member 'neck'; it has head, tail"):
        network["neck"]
    with pytest.raises(EcsimError, match=r"'head\.2' is no port; write a member and one of the ports 0, 1, as head\.0"):
        network.wire("head.2")
    network["head"].scan()
    with pytest.raises(EcsimError, match="head was moved on its own; advance the network only, or remove head and add it again"):
        network.advance(ms=1)
    assert network.time_us == 0


def test_a_network_tells_its_members_and_its_time():
    network = pair()
    network.advance(ms=12.5)
    assert repr(network) == "<Network of head, tail at 12.5 ms>"
