"""The served lines: what they refuse, how they stop, and clients that misbehave."""

import contextlib
import os
import select
import socket
import struct
import threading
import time
import warnings

import pytest

import ecsim
from ecsim.comms.frames import ascii_encode, rtu_encode
from ecsim.modbus import serve

READ = bytes.fromhex("0001 0000 0006 01 03 0000 0001")


def connect(server):
    peer = socket.create_connection(("127.0.0.1", server.port), timeout=10)
    peer.settimeout(10)
    return peer


def take(peer, count):
    """Just so many octets from a socket or file descriptor."""
    got = b""
    while len(got) < count:
        assert select.select([peer], [], [], 10)[0], f"nothing more after {got.hex(' ')}"
        more = os.read(peer, count - len(got)) if isinstance(peer, int) else peer.recv(count - len(got))
        assert more, f"closed after {got.hex(' ')}"
        got += more
    return got


def alive(server):
    """Ask one register by a new connection."""
    with connect(server) as peer:
        peer.sendall(READ)
        assert take(peer, 11)[:9] == bytes.fromhex("0001 0000 0005 01 03 02")


# -- opening and stopping ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("lines", "complaint"),
    [
        ({}, "nothing to serve on: give tcp=5020"),
        ({"tcp": 70_000}, "tcp is 70000; it is a port from 0 to 65535"),
        ({"tcp": "502"}, "tcp is '502'"),
        ({"tcp": 0, "station": 0}, "the station of port 0 is 0; it is a whole number from 1 to 31"),
        ({"tcp": 0, "station": 32}, "the station of port 0 is 32"),
        ({"tcp": 0, "host": "203.0.113.7"}, "203.0.113.7:0 cannot be opened"),
        ({"rtu": "/dev/no-such-port"}, "/dev/no-such-port cannot be opened"),
        ({"rtu": "/dev/null", "baud": 115_200}, "the baud rate of port 0 is 115200; choose 38400 or"),
        ({"rtu": "/dev/null", "parity": "mark"}, "the parity of port 0 is 'mark'; choose none or odd or even"),
        ({"rtu": "/dev/x", "ascii": "/dev/x"}, "/dev/x is given in both modes"),
    ],
)
def test_what_cannot_be_opened_is_said(plc, lines, complaint):
    before = threading.active_count()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(ecsim.EcsimError) as refusal:
            serve(plc, **lines)
    assert complaint in str(refusal.value)
    assert threading.active_count() == before


def test_only_a_plc_or_a_session_is_served():
    with pytest.raises(ecsim.EcsimError, match="only a Plc or a Session can be served, not str"):
        serve("LD X0", tcp=0)


def test_ec10_speaks_rtu_alone():
    with pytest.raises(ecsim.EcsimError, match="the mode of port 0 is 'ascii'; choose rtu"):
        serve(ecsim.Plc("EC10"), ascii="/dev/null")


def test_a_port_in_use_is_said_and_the_lines_opened_before_are_closed(plc, server, cable):
    with pytest.raises(ecsim.EcsimError, match=f"127.0.0.1:{server.port} cannot be opened: .*choose another one, or 0 for any"):
        serve(plc, tcp=server.port)
    with pytest.raises(ecsim.EcsimError, match="no-such-port"):
        serve(plc, rtu=cable.ends[0], ascii="/dev/no-such-port")
    serve(plc, rtu=cable.ends[0]).stop()


def test_the_port_is_free_again_at_once(plc):
    server = serve(plc, tcp=0)
    port = server.port
    with connect(server) as peer:
        peer.sendall(READ)
        take(peer, 11)
        assert repr(server) == f"<Modbus server on tcp 127.0.0.1:{port}>"
        server.stop()
        assert repr(server) == "<Modbus server, stopped>"
        assert peer.recv(1) == b""
    server.stop()
    for _ in range(3):
        again = serve(plc, tcp=port)
        alive(again)
        again.stop()


def test_it_listens_to_this_machine_alone_unless_told_otherwise(plc, server):
    assert server.lines[0].address[0] == "127.0.0.1"
    with (
        pytest.warns(UserWarning, match="whoever reaches 0.0.0.0 can write every device"),
        serve(plc, tcp=0, host="0.0.0.0") as open_to_all,
    ):
        alive(open_to_all)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        serve(plc, tcp=0, host="localhost").stop()


# -- clients that misbehave ----------------------------------------------------------------------------------------------


def test_several_requests_at_once_are_all_answered(server):
    with connect(server) as peer:
        peer.sendall(b"".join(number.to_bytes(2) + READ[2:] for number in range(500)))
        answers = take(peer, 500 * 11)
    assert [int.from_bytes(answers[place : place + 2]) for place in range(0, len(answers), 11)] == list(range(500))


def test_a_request_may_come_octet_by_octet(server):
    with connect(server) as peer:
        peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for octet in READ:
            peer.sendall(bytes((octet,)))
        assert take(peer, 11)[:2] == b"\0\1"


def test_rubbish_ends_the_connection_and_is_counted(server):
    for rubbish in (b"GET / HTTP/1.1\r\n\r\n", bytes(40), b"\xff" * 300):
        with connect(server) as peer:
            peer.sendall(rubbish)
            with contextlib.suppress(ConnectionResetError):
                assert peer.recv(1) == b""
    assert server.slaves[0].counts["garbled"] == 3
    alive(server)


def test_half_a_frame_disturbs_nobody(server):
    with connect(server) as half:
        half.sendall(READ[:7])
        alive(server)
        half.sendall(READ[7:])
        take(half, 11)


def test_a_client_that_goes_away_in_the_middle_disturbs_nobody(server):
    for _ in range(20):
        peer = connect(server)
        peer.sendall(READ * 100)
        peer.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # a reset
        peer.close()
    alive(server)


def test_a_client_that_takes_no_answers_is_held_back(server):
    """It asks for the most that there is and reads nothing: what waits for it stays bounded, and everybody else is served."""
    greedy = bytes.fromhex("0001 0000 0006 01 03 0000 007D")
    with connect(server) as peer:
        peer.setblocking(False)
        sent = 0
        quiet = time.monotonic() + 30
        while time.monotonic() < quiet:
            try:
                sent += peer.send(greedy * 1000)
            except BlockingIOError:
                alive(server)
                (client,) = [each for each in server.lines[0].active_connections.values() if len(each.octets)] or [None]
                if client is not None and client.full:
                    break
        assert client.full
        assert len(client.octets) < 1_000_000
        assert client.transport.get_write_buffer_size() < 200_000
        assert sent


def test_many_clients_at_once(server):
    peers = [connect(server) for _ in range(64)]
    for number, peer in enumerate(peers):
        peer.sendall(number.to_bytes(2) + READ[2:])
    assert [int.from_bytes(take(peer, 11)[:2]) for peer in peers] == list(range(64))
    for peer in peers:
        peer.close()


def test_more_clients_than_there_is_room_for_are_turned_away(server):
    from ecsim.modbus.lines import MOST_CLIENTS

    peers = [connect(server) for _ in range(MOST_CLIENTS)]
    for peer in peers:
        peer.sendall(READ)
        take(peer, 11)
    with connect(server) as one_more, contextlib.suppress(ConnectionError):
        one_more.sendall(READ)
        assert one_more.recv(1) == b""
    for peer in peers:
        peer.close()
    deadline = time.monotonic() + 10
    while server.lines[0].active_connections and time.monotonic() < deadline:
        pass
    alive(server)


# -- serial lines ------------------------------------------------------------------------------------------------------


@pytest.fixture
def far(cable):
    """A file descriptor on the far end of the cable."""
    fd = os.open(cable.ends[1], os.O_RDWR | os.O_NOCTTY)
    yield fd
    os.close(fd)


def test_rubbish_on_an_rtu_line_is_passed_over_and_counted(plc, cable, far):
    request, answer = rtu_encode(1, b"\x08\0\0AB"), rtu_encode(1, b"\x08\0\0AB")
    with serve(plc, rtu=cable.ends[0]) as server:
        counts = server.slaves[0].counts
        for rubbish in (b"\xff" * 7, request[:-1] + b"\0", bytes(1000), request[:3]):
            before = counts["garbled"] + counts["overruns"]
            os.write(far, rubbish)
            deadline = time.monotonic() + 10
            while counts["garbled"] + counts["overruns"] == before and time.monotonic() < deadline:
                pass
            os.write(far, request)
            assert take(far, len(answer)) == answer
        assert (counts["garbled"], counts["overruns"]) == (3, 1)


def test_requests_without_a_silence_between_them_are_answered_in_turn(plc, cable, far):
    with serve(plc, rtu=cable.ends[0]):
        requests = [rtu_encode(1, b"\x08\0\0" + bytes((0, number))) for number in range(20)]
        os.write(far, b"".join(requests))
        assert take(far, 8 * 20) == b"".join(requests)


def test_an_ascii_line_hears_frames_among_noise(plc, cable, far):
    request = ascii_encode(1, b"\x08\0\0AB")
    with serve(plc, ascii=cable.ends[0]) as server:
        os.write(far, b"noise\r\n" + request[:5] + b":zz\r\n" + request + b"tail")
        assert take(far, len(request)) == request
        assert server.slaves[0].counts["garbled"] == 2


# -- power ---------------------------------------------------------------------------------------------------------


def test_without_power_it_says_nothing_and_power_up_begins_anew(plc, server):
    slave = server.slaves[0]
    assert slave.receive(1, b"\x08\0\4\0\0") is None
    assert slave.receive(1, b"\3\0\0\0\1") is None
    plc.power_cycle()
    assert slave.receive(1, b"\x08\0\x0b\0\0") == b"\x08\0\x0b\0\1"
    plc.power_off()
    assert slave.receive(1, b"\3\0\0\0\1") is None
    plc.power_on()
    assert slave.receive(1, b"\3\0\0\0\1") == b"\3\2\0\0"


# -- the session ---------------------------------------------------------------------------------------------------


def test_a_step_back_repeats_what_clients_have_written(plc):
    plc.load("LD SM0\nADD D1 D0 D0")
    session = ecsim.Session(plc, name="served", speed=None)
    session.run()
    session.scan(5)
    with serve(session, tcp=0) as server, connect(server) as peer:
        for value in (7, 3):
            peer.sendall(bytes.fromhex("0001 0000 0006 01 06 0001") + value.to_bytes(2))
            take(peer, 12)
        session.scan(10)
        assert plc["D0"] == 30
        assert session.back(4)
        assert plc["D0"] == 18
        session.scan(4)
        assert plc["D0"] == 30
        session.stop()


def test_a_flood_of_writes_is_remembered_once_a_scan(plc):
    session = ecsim.Session(plc, name="served", speed=None)
    session.scan(1)
    with serve(session, tcp=0) as server, connect(server) as peer:
        before = len(session.history.actions)
        for value in range(300):
            peer.sendall(bytes.fromhex("0001 0000 0006 01 06 0064") + value.to_bytes(2))
            take(peer, 12)
        assert len(session.history.actions) == before + 1
        assert plc["D100"] == 299


def test_a_flood_does_not_stop_the_scans(plc):
    session = ecsim.Session(plc, name="served", speed=1.0)
    session.run()
    ended = threading.Event()
    with serve(session, tcp=0) as server:

        def flood():
            with connect(server) as peer:
                while not ended.is_set():
                    peer.sendall(READ * 64)
                    take(peer, 64 * 11)

        floods = [threading.Thread(target=flood) for _ in range(3)]
        for each in floods:
            each.start()
        before = plc.scans
        deadline = time.monotonic() + 30
        while plc.scans < before + 50 and time.monotonic() < deadline:
            ended.wait(0.02)
        scans = plc.scans - before
        ended.set()
        for each in floods:
            each.join()
        assert scans >= 50
    session.stop()
