"""Ports on real lines in real time: a pseudo terminal and a TCP connection, pumped by the session."""

import os
import select
import socket
import tty
from time import monotonic

import pytest

from ecsim.errors import EcsimError
from ecsim.hardware.serial import PortSettings
from ecsim.plc import Plc
from ecsim.session import Session
from ecsim.system import SystemBlock

PATIENCE_S = 20


@pytest.fixture
def terminal():
    """A pseudo terminal: the number of our side, the path of the other one."""
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    yield ours, os.ttyname(theirs)
    os.close(ours)
    os.close(theirs)


def session(program, settings, name, model="EC20"):
    """A session in real time with a PLC whose port 1 is set up so."""
    plc = Plc(model, input_filter_ms=0, system=SystemBlock(port1=settings))
    plc.load(program)
    plc.run()
    return Session(plc, name=name)


def hear(number, count):
    """So many bytes from a descriptor."""
    heard = b""
    while len(heard) < count:
        assert select.select([number], [], [], PATIENCE_S)[0], f"only {heard!r} came"
        heard += os.read(number, count - len(heard))
    return heard


REQUEST, HEAD = bytes.fromhex("0203000000018439"), bytes.fromhex("020302")  # D0 of station 2


def test_a_slave_answers_over_a_pseudo_terminal(terminal):
    ours, theirs = terminal
    lab = session("LD SM0\nMOV 1234 D0", PortSettings("modbus slave", station=2), "outside-slave")
    try:
        lab.connect(1, theirs)
        lab.run()
        for _ in range(2):
            os.write(ours, REQUEST)
            answer = hear(ours, 7)
            assert answer[:5] == HEAD + (1234).to_bytes(2)
    finally:
        lab.stop()


def test_a_request_that_comes_in_pieces_is_one_frame(terminal):
    ours, theirs = terminal
    lab = session("LD SM0\nMOV 1234 D0", PortSettings("modbus slave", station=2), "outside-pieces")
    try:
        lab.connect(1, theirs)
        lab.run()
        for octet in REQUEST:
            os.write(ours, bytes((octet,)))
        assert hear(ours, 7)[:3] == HEAD
    finally:
        lab.stop()


@pytest.mark.parametrize(
    ("program", "request_", "answer", "stored"),
    [
        (
            "LD SM1\nMOV 5 D0\nMOV 3 D1\nMOV 1 D5\nLD SM12\nMODBUS 1 D0 D100",
            "050300000001858e",
            "050302123444f3",
            {"D103": 0x12, "D104": 0x34},
        ),
        ("LD SM12\nEVRD 1 1 2 D100", "01030002000125ca", "0103021234b533", {"D100": 0x1234}),
    ],
)
def test_a_master_asks_over_a_pseudo_terminal(terminal, program, request_, answer, stored):
    ours, theirs = terminal
    lab = session(program, PortSettings("modbus master", station=31, timeout_ms=20_000), "outside-master", "EC10")
    try:
        lab.connect(1, theirs)
        lab.run()
        assert hear(ours, 8).hex() == request_
        os.write(ours, bytes.fromhex(answer))
        deadline = monotonic() + PATIENCE_S
        while not lab.plc["SM135"] and monotonic() < deadline:
            pass
        assert (lab.plc["SM136"], lab.plc["SD139"]) == (0, 0)
        assert {name: lab.plc[name] for name in stored} == stored
    finally:
        lab.stop()


def test_freeport_speaks_over_tcp():
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(PATIENCE_S)
        port = server.getsockname()[1]
        program = "LD SM1\nRCV 1 D10 3\nLD SM123\nEU\nXMT 1 D10 3"
        lab = session(program, PortSettings("freeport", baud=38400), "outside-tcp")
        try:
            lab.connect(1, f"tcp://127.0.0.1:{port}")
            lab.run()
            client, _ = server.accept()
            with client:
                client.sendall(b"abc")
                assert hear(client.fileno(), 3) == b"abc"
        finally:
            lab.stop()


def test_what_has_come_is_repeated_on_the_way_back_and_said_once(terminal):
    ours, theirs = terminal
    lab = session("LD SM0\nMOV 1234 D0\nINC D1", PortSettings("modbus slave", station=2), "outside-back")
    try:
        lab.connect(1, theirs)
        lab.run()
        os.write(ours, REQUEST)
        hear(ours, 7)
        lab.pause()
        first, scans = lab.plc.ports[1].wire.log, lab.plc.scans
        assert lab.back(1)
        assert lab.plc.ports[1].wire.log[:1] == first[:1]
        assert lab.back(lab.plc.scans - 1)
        assert lab.plc.ports[1].wire.log == []
        assert scans > 1
        assert select.select([ours], [], [], 0)[0] == []
    finally:
        lab.stop()


def test_a_line_that_is_gone_leaves_the_session_running():
    ours, theirs = os.openpty()
    lab = session("LD SM0\nXMT 1 D0 10", PortSettings("freeport"), "outside-gone")
    try:
        lab.connect(1, os.ttyname(theirs))
        os.close(ours)
        os.close(theirs)
        lab.scan(20)
        assert lab.plc["SM122"] == 1
    finally:
        lab.stop()
    assert lab.error is None


def test_what_cannot_be_connected_is_refused_in_words(terminal, tmp_path):
    lab = session("", PortSettings("freeport"), "outside-refusals")
    try:
        with pytest.raises(EcsimError, match="there is no port 2; the PLC has 0, 1"):
            lab.connect(2, terminal[1])
        with pytest.raises(EcsimError, match=r"/missing cannot be opened: No such file or directory; give the path"):
            lab.connect(1, str(tmp_path / "missing"))
        (tmp_path / "file").write_text("")
        with pytest.raises(EcsimError, match="cannot be opened: it is no serial device"):
            lab.connect(1, str(tmp_path / "file"))
        with pytest.raises(EcsimError, match=r"tcp://127\.0\.0\.1:1 cannot be opened: Connection refused"):
            lab.connect(1, "tcp://127.0.0.1:1")
        with pytest.raises(EcsimError, match="tcp://nowhere cannot be opened"):
            lab.connect(1, "tcp://nowhere")
        with pytest.raises(EcsimError, match="port 1 is connected to no line"):
            lab.disconnect(1)
        lab.connect(1, terminal[1])
        with pytest.raises(EcsimError, match=r"port 1 is connected to .*; disconnect\(1\) first"):
            lab.connect(1, terminal[1])
        lab.disconnect(1)
        assert lab.plc.ports[1].wire.stations == []
    finally:
        lab.stop()
