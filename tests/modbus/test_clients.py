"""Programs that nobody here wrote, against a served PLC: pymodbus' client, pyModbusTCP and mbpoll, over TCP and serial lines."""

import asyncio
import shutil
import subprocess

import pytest
from pymodbus.client import AsyncModbusTcpClient, ModbusSerialClient, ModbusTcpClient

import ecsim
from ecsim.modbus import serve

ASKING = {"timeout": 5, "retries": 0}


@pytest.fixture
def client(server):
    client = ModbusTcpClient("127.0.0.1", port=server.port, **ASKING)
    assert client.connect()
    yield client
    client.close()


# -- pymodbus ------------------------------------------------------------------------------------------------------


def test_pymodbus_reads_and_writes_every_kind_of_device(plc, client):
    plc.set({"X1": 1, "M5": 1, "D10": -2, "D11:DINT": 0x12345678, "C200": 70_000})
    plc.scan(2)
    assert client.read_discrete_inputs(0, count=3).bits[:3] == [False, True, False]
    assert client.read_coils(2000, count=8).bits == [n == 5 for n in range(8)]
    assert client.read_holding_registers(10, count=3).registers == [0xFFFE, 0x1234, 0x5678]
    assert client.read_holding_registers(9700, count=2).registers == [1, 70_000 - 65_536]
    assert not client.write_coil(2001, True).isError()
    assert not client.write_coils(2010, [True, False, True]).isError()
    assert not client.write_register(20, 40_000).isError()
    assert not client.write_registers(21, [1, 2, 3]).isError()
    assert [plc[f"M{n}"] for n in (1, 10, 11, 12)] == [1, 1, 0, 1]
    assert [plc[f"D{n}:WORD"] for n in range(20, 24)] == [40_000, 1, 2, 3]


@pytest.mark.parametrize(
    ("ask", "code"),
    [
        (lambda client: client.read_input_registers(0, count=1), 1),
        (lambda client: client.read_holding_registers(8600, count=1), 2),
        (lambda client: client.read_coils(0, count=257), 3),
        (lambda client: client.read_holding_registers(9700, count=1), 3),
        (lambda client: client.report_device_id(), 1),
    ],
)
def test_pymodbus_gets_the_exceptions(client, ask, code):
    answer = ask(client)
    assert answer.isError()
    assert answer.exception_code == code


def test_pymodbus_runs_the_diagnostics(client, server):
    assert client.diag_query_data(b"\x12\x34").message == b"\x12\x34"
    client.read_input_registers(0, count=1)
    assert client.diag_read_bus_exception_error_count().message == 1
    assert client.diag_read_bus_message_count().message == 4
    assert not client.diag_clear_counters().isError()
    assert client.diag_read_device_message_count().message == 1
    client.diag_force_listen_only(no_response_expected=True)
    client.diag_restart_communication(True, no_response_expected=True)
    assert client.read_holding_registers(0, count=1).registers == [0]


@pytest.mark.parametrize("unit", [0, 1, 255])
def test_unit_numbers_over_tcp_that_mean_this_plc(client, unit):
    assert client.read_holding_registers(0, count=1, device_id=unit).registers == [0]


@pytest.mark.parametrize("mode", ["rtu", "ascii"])
def test_pymodbus_over_a_serial_line(plc, cable, mode):
    with serve(plc, **{mode: cable.ends[0]}, station=7) as server:
        client = ModbusSerialClient(cable.ends[1], framer=mode, **ASKING)  # pseudo-terminals have no parity
        assert client.connect()
        assert not client.write_registers(100, list(range(100)), device_id=7).isError()
        assert client.read_holding_registers(100, count=100, device_id=7).registers == list(range(100))
        assert client.read_input_registers(0, count=1, device_id=7).exception_code == 1  # of no known length: silence ends it
        client.write_register(5, 55, device_id=0, no_response_expected=True)
        assert client.read_holding_registers(5, count=1, device_id=7).registers == [55]
        assert client.diag_read_bus_comm_error_count(device_id=7).message == 0
        assert server.slaves[0].counts["unanswered"] == 1
        client.close()


def test_a_client_in_the_event_loop_of_the_caller(plc):
    """A notebook's cell awaits its client while the session runs on and the server has its own loop."""

    async def cell():
        session = ecsim.Session(plc, name="served", speed=None).start()
        with serve(session, tcp=0) as server:
            client = AsyncModbusTcpClient("127.0.0.1", port=server.port, **ASKING)
            await client.connect()
            first = (await client.read_holding_registers(0, count=1)).registers[0]
            while (later := (await client.read_holding_registers(0, count=1)).registers[0]) == first:
                await asyncio.sleep(0)
            client.close()
        session.stop()
        return first, later

    first, later = asyncio.run(asyncio.wait_for(cell(), 20))
    assert later != first


# -- pyModbusTCP -----------------------------------------------------------------------------------------------------


def test_pymodbustcp_reads_and_writes(plc, server):
    clients = pytest.importorskip("pyModbusTCP.client")
    client = clients.ModbusClient(host="127.0.0.1", port=server.port, auto_close=False)
    assert client.write_multiple_registers(30, [7, 8, 65_535])
    assert client.read_holding_registers(30, 3) == [7, 8, 65_535]
    assert client.write_single_coil(2000, True)
    assert client.read_coils(2000, 2) == [True, False]
    assert client.read_discrete_inputs(0, 4) == [False] * 4
    assert client.read_holding_registers(8600, 1) is None
    assert client.last_except == 2
    assert plc["D32"] == -1
    client.close()


# -- mbpoll --------------------------------------------------------------------------------------------------------


def mbpoll(*arguments):
    """What mbpoll says after one poll; it counts from 1 unless it is told otherwise (-0)."""
    if shutil.which("mbpoll") is None:
        pytest.skip("no mbpoll here (apt install mbpoll)")
    done = subprocess.run(["mbpoll", "-1", "-0", "-o", "5", *map(str, arguments)], capture_output=True, text=True, timeout=30)
    return done.stdout + done.stderr


def test_mbpoll_over_tcp(plc, server):
    plc.set({"D40": 1234, "D41": -5, "M3": 1})
    plc["X2"] = 1
    plc.scan()
    tcp = ("-m", "tcp", "-p", server.port)
    said = mbpoll(*tcp, "-t", 4, "-r", 40, "-c", 2, "127.0.0.1")
    assert "[40]: \t1234" in said
    assert "[41]: \t65531 (-5)" in said
    assert "[2003]: \t1" in mbpoll(*tcp, "-t", 0, "-r", 2003, "127.0.0.1")
    assert "[2]: \t1" in mbpoll(*tcp, "-t", 1, "-r", 2, "127.0.0.1")
    assert "Illegal data address" in mbpoll(*tcp, "-t", 4, "-r", 8600, "127.0.0.1")
    assert "Illegal function" in mbpoll(*tcp, "-t", 3, "-r", 0, "127.0.0.1")
    assert "Written 2 references" in mbpoll(*tcp, "-t", 4, "-r", 50, "127.0.0.1", "--", 11, 12)
    assert (plc["D50"], plc["D51"]) == (11, 12)
    assert "Written 1 references" in mbpoll(*tcp, "-t", 0, "-r", 2009, "127.0.0.1", "--", 1)
    assert plc["M9"] == 1


def test_mbpoll_over_a_serial_line(plc, cable):
    plc["D40"] = 1234
    with serve(plc, rtu=cable.ends[0], station=9, baud=9600, parity="none"):
        rtu = ("-m", "rtu", "-a", 9, "-b", 9600, "-P", "none", "-s", 2)
        assert "[40]: \t1234" in mbpoll(*rtu, "-t", 4, "-r", 40, cable.ends[1])
        assert "Written 1 references" in mbpoll(*rtu, "-t", 4, "-r", 41, cable.ends[1], "--", 77)
        assert plc["D41"] == 77
