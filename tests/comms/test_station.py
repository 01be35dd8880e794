"""A port as Modbus slave: frames from characters, answers in the communication of a scan, registers and counters (10.4)."""

import pytest

from ecsim.hardware.serial import PortSettings
from ecsim.plc import Plc
from ecsim.system import SystemBlock


class Asker:
    """An instrument that asks, and keeps what it hears."""

    def __init__(self):
        self.heard = []

    def hear(self, message):
        self.heard.append(message.hex())


READ = bytes.fromhex("0203000000018439")  # D0 of station 2
ASCII_READ = b":020300000001FA\r\n"


def slave(port=1, program="LD SM0\nMOV 7 D0", model="EC20", **settings):
    """A slave with station 2 and the instrument that asks it."""
    system = SystemBlock(**{f"port{port}": PortSettings("modbus slave", **{"station": 2} | settings)})
    plc = Plc(model, input_filter_ms=0, system=system)
    plc.load(program)
    plc.run()
    asker = Asker()
    plc.ports[port].connect(asker)
    plc.scan()
    return plc, asker


def ask(plc, text, port=1, scans=4):
    """The instrument asks something."""
    plc.ports[port].wire.stations[0].send(text, plc.time_us)
    plc.ports[port].stirred()
    plc.scan(scans)


@pytest.mark.parametrize("port", [0, 1])
def test_both_ports_answer(port):
    plc, asker = slave(port)
    ask(plc, READ, port)
    assert asker.heard == ["0203020007bd86"]
    assert plc[f"SM{112 + 10 * port}"] == plc[f"SM{113 + 10 * port}"] == plc[f"SM{114 + 10 * port}"] == 1


def test_the_answer_begins_with_the_communication_of_the_next_scan():
    plc, _ = slave()
    ask(plc, READ)
    assert [entry[:2] for entry in plc.ports[1].wire.log] == [(10_000, "Asker"), (20_000, "port 1")]


def test_ascii_frames_are_answered_in_ascii():
    plc, asker = slave(mode="ascii")
    ask(plc, ASCII_READ)
    assert bytes.fromhex(asker.heard[0]) == b":0203020007F2\r\n"


def test_the_station_may_be_changed_by_the_program():
    plc, asker = slave(program="LD SM0\nMOV 7 D0\nMOV 3 SD135")
    ask(plc, READ)
    assert asker.heard == []
    ask(plc, bytes.fromhex("03030000000185e8"))
    assert asker.heard == ["03030200078046"]


def test_another_station_a_gap_and_a_wrong_checksum_get_no_answer_and_are_counted():
    plc, asker = slave()
    ask(plc, bytes.fromhex("03030000000185e8"))
    ask(plc, READ[:5])
    ask(plc, READ[:-1] + b"\0")
    assert asker.heard == []
    counts = plc.ports[1].protocol.slave.counts
    assert (counts["messages"], counts["garbled"], counts["addressed"]) == (1, 2, 0)


def test_a_new_power_up_begins_with_new_counters():
    plc, _ = slave()
    ask(plc, READ)
    assert plc.ports[1].protocol.slave.counts["addressed"] == 1
    plc.power_cycle()
    assert plc.ports[1].protocol.slave.counts["addressed"] == 0


def test_while_it_hears_a_request_the_port_is_not_idle():
    plc, _ = slave()
    ask(plc, READ, scans=2)  # the answer begins with the second scan and takes 4 ms
    assert plc["SM124"] == 1
    plc, _ = slave(baud=1200)
    ask(plc, READ, scans=3)  # a request takes 73 ms at 1200 baud
    assert plc["SM124"] == 0


def test_the_way_back_leads_into_the_middle_of_a_frame():
    plc, asker = slave(baud=1200)
    ask(plc, READ, scans=5)
    snapshot = plc.snapshot()
    plc.scan(20)
    first = list(asker.heard), plc.ports[1].wire.log, dict(plc.ports[1].protocol.slave.counts)
    assert len(first[0]) == 1
    plc.restore(snapshot)
    assert asker.heard == []
    plc.scan(20)
    assert (asker.heard, plc.ports[1].wire.log, dict(plc.ports[1].protocol.slave.counts)) == first
