"""The inverter with its motor: ramps, words, refusals with the codes of appendix 5, faults; and driven by an EC10 (6.12)."""

import pytest
from ecsim_exercises.inverter import Inverter

from ecsim import EcsimError, Plc, SystemBlock
from ecsim.hardware.serial import PortSettings


def crc(octets):
    """The CRC of Modbus, bit by bit."""
    register = 0xFFFF
    for octet in octets:
        register ^= octet
        for _ in range(8):
            register = register >> 1 ^ (0xA001 if register & 1 else 0)
    return register.to_bytes(2, "little")


def frame(text, station=1):
    """An RTU frame of a message in hex."""
    octets = bytes((station,)) + bytes.fromhex(text)
    return octets + crc(octets)


FORWARD, REVERSE, JOG, JOG_BACK = "06 6400 00C7", "06 6400 00CF", "06 6400 00D0", "06 6400 00E0"
STOP, COAST, FAST = "06 6400 00C6", "06 6400 00C5", "06 6400 00C4"


def tell(drive, text):
    """Say something; the code of a refusal, 0 for an echo."""
    answer = drive.hear(frame(text, drive.station))
    if answer[1] & 0x80:
        assert answer == frame(f"{answer[1]:02x}{answer[2]:02x}", drive.station)
        return answer[2]
    assert answer == frame(text, drive.station)
    return 0


def word(drive, register, count=1):
    """Registers as they are read."""
    answer = drive.hear(frame(f"03 {register:04X} {count:04X}", drive.station))
    assert answer[-2:] == crc(answer[:-2])
    return [int.from_bytes(answer[place : place + 2]) for place in range(3, 3 + 2 * count, 2)]


def turn(drive, seconds):
    """Let time go by in steps of 10 ms."""
    for _ in range(round(100 * seconds)):
        drive.step(0.01)


@pytest.fixture
def drive():
    """An inverter that reaches 50 Hz in 5 s, and stops from there in 10 s, fast in 1 s."""
    drive = Inverter()
    for text in ("06 000A 0032", "06 000B 0064", "06 000C 000A", "06 6401 1388"):
        assert tell(drive, text) == 0
    return drive


def test_it_runs_up_its_ramp_to_the_setting(drive):
    assert tell(drive, FORWARD) == 0
    turn(drive, 2)
    assert drive.hertz == pytest.approx(20)
    turn(drive, 4)
    assert drive.hertz == 50
    # running, arrived, remote; 50.00 Hz; 380 V; 1500 rpm less 2 % slip at half load; no fault
    assert word(drive, 0x6500, 7) == [1 + 4 + 8, 5000, 1000, 65, 380, 1470, 0]


def test_the_current_is_higher_while_it_speeds_up(drive):
    tell(drive, FORWARD)
    turn(drive, 1)
    assert word(drive, 0x6503) == [105]  # 10 A times 0.3 and 0.7 of half the load, and 0.4 more
    assert word(drive, 0x6504) == [76]  # 380 V at 10 of 50 Hz


def test_a_reversal_goes_down_through_standstill_and_up_again(drive):
    tell(drive, FORWARD)
    turn(drive, 6)
    tell(drive, REVERSE)
    turn(drive, 5)
    assert drive.hertz == pytest.approx(25)
    turn(drive, 6)  # at 10 s it stands; 1 s later it has -10 Hz
    assert drive.hertz == pytest.approx(-10)
    assert word(drive, 0x6500, 2) == [1 + 2 + 8, 1000]


@pytest.mark.parametrize(("command", "seconds", "hertz"), [(STOP, 5, 25), (FAST, 0.5, 25), (COAST, 0.01, 0)])
def test_the_three_ways_to_stop(drive, command, seconds, hertz):
    tell(drive, FORWARD)
    turn(drive, 6)
    assert tell(drive, command) == 0
    turn(drive, seconds)
    assert drive.hertz == pytest.approx(hertz)


def test_a_coasting_motor_turns_on_and_is_caught(drive):
    tell(drive, FORWARD)
    turn(drive, 6)
    tell(drive, COAST)
    turn(drive, 4)
    assert (drive.hertz, drive.rotor) == (0, pytest.approx(25))
    assert word(drive, 0x6500) == [8]
    tell(drive, FORWARD)
    assert drive.hertz == pytest.approx(25)


def test_jogging_has_a_frequency_of_its_own_and_stands_back_behind_running(drive):
    assert tell(drive, JOG_BACK) == 0
    turn(drive, 3)
    assert drive.hertz == -5
    assert tell(drive, "06 6400 00C0") == 0  # no jog any longer
    turn(drive, 3)
    assert (drive.hertz, word(drive, 0x6500)) == (0, [8])
    tell(drive, FORWARD)
    assert tell(drive, JOG) == 4


def test_a_new_setting_is_taken_over_while_it_runs(drive):
    tell(drive, FORWARD)
    turn(drive, 6)
    tell(drive, "06 6401 0BB8")
    turn(drive, 10)
    assert word(drive, 0x6501) == [3000]


def test_a_control_word_that_is_not_valid_or_holds_the_ramp(drive):
    assert tell(drive, "06 6400 0047") == 0
    turn(drive, 1)
    assert drive.hertz == 0
    tell(drive, FORWARD)
    turn(drive, 1)
    tell(drive, "06 6400 0087")
    turn(drive, 1)
    assert drive.hertz == pytest.approx(10)


@pytest.mark.parametrize(
    ("request_", "code"),
    [
        ("04 6500 0001", 1),  # function
        ("03 7000 0001", 2),  # no such register
        ("06 7000 0001", 2),
        ("06 6401 1389", 3),  # 50.01 Hz are above the top
        ("06 0001 0004", 3),
        ("03 0001 000B", 3),
        ("06 6400 00F0", 4),  # both jogs at once
        ("06 000A 00", 0x18),  # too short
        ("06 6500 0000", 0x20),  # a word of the state
        ("06 0D00 0001", 0x20),
    ],
)
def test_a_refusal_has_its_code(drive, request_, code):
    answer = drive.hear(frame(request_))
    assert (answer[1] & 0x80, answer[2]) == (0x80, code)


def test_the_top_frequency_is_locked_while_the_motor_turns(drive):
    assert tell(drive, "06 0005 0FA0") == 0
    tell(drive, "06 0005 1388")
    tell(drive, FORWARD)
    assert tell(drive, "06 0005 0FA0") == 0x21


@pytest.mark.parametrize(("fault", "code", "kept"), [("locked", 0x22, 0), ("busy", 6, 0), ("slow", 5, 2)])
def test_a_fault_of_its_memory_is_told(drive, fault, code, kept):
    drive.fail(fault)
    assert tell(drive, "06 0001 0002") == code
    assert word(drive, 1) == [kept]
    drive.fail(fault, on=False)
    assert tell(drive, "06 0001 0003") == 0


def test_a_trip_stops_it_until_it_is_reset(drive):
    tell(drive, FORWARD)
    turn(drive, 6)
    drive.fail("overcurrent")
    assert (drive.hertz, word(drive, 0x6506), word(drive, 0x6500)) == (0, [3], [8 | 3 << 8])
    assert tell(drive, FORWARD) == 4
    tell(drive, "06 6400 0280")
    assert word(drive, 0x6506) == [3]  # its cause is still there
    drive.fail("overcurrent", on=False)
    tell(drive, "06 6400 0280")
    assert (word(drive, 0x6506), tell(drive, FORWARD)) == ([0], 0)


def test_too_much_load_trips_it(drive):
    tell(drive, FORWARD)
    drive.load = 1.6
    turn(drive, 0.1)
    assert word(drive, 0x6506) == [13]


def test_it_keeps_silent_to_others_to_rubbish_and_to_a_broadcast_which_it_obeys(drive):
    assert drive.hear(frame(FORWARD, station=2)) is None
    assert drive.hear(b"\x01\x06\x64") is None
    assert drive.hear(frame(FORWARD)[:-1] + b"\0") is None
    assert drive.hear(frame(FORWARD, station=0)) is None
    turn(drive, 1)
    assert drive.hertz == pytest.approx(10)


def test_what_it_does_not_have_is_refused_in_words():
    with pytest.raises(EcsimError, match="this machine has no fault 'rust'; it has silent, garbled"):
        Inverter().fail("rust")
    with pytest.raises(EcsimError, match="station 0 of an inverter; it is 1 to 247"):
        Inverter(station=0)


def test_it_comes_back_to_a_moment(drive):
    tell(drive, FORWARD)
    turn(drive, 1)
    state = drive.state()
    drive.fail("overheated")
    turn(drive, 3)
    drive.restore(state)
    assert (drive.hertz, drive.faults, drive.state()) == (pytest.approx(10), frozenset(), state)


# -- on the line of an EC10 -----------------------------------------------------------------------------------------

PROGRAM = """
LD M0
EVFRQ 1 5 40
LD M1
EVFWD 1 5
LD M2
EVSTOP 1 5 0
LD M3
EVRDST 1 5 1 D0
LD M4
EVRDST 1 5 6 D1
"""


@pytest.fixture
def rig():
    """An EC10 and an inverter on its port 1."""
    plc = Plc("EC10", input_filter_ms=0, system=SystemBlock(port1=PortSettings("modbus master", timeout_ms=100)))
    plc.load(PROGRAM)
    plc.run()
    drive = Inverter(station=5)
    plc.ports[1].connect(drive, delay_ms=5)
    return plc, drive


def press(plc, relay, ms=100):
    """Let one relay rise; how the exchange ended: SM135, SM136, SD139."""
    plc.set({f"M{place}": int(place == relay) for place in range(5)})
    plc.advance(ms=ms)
    return plc["SM135"], plc["SM136"], plc["SD139"]


def test_an_ec10_drives_it(rig):
    plc, drive = rig
    assert press(plc, 0) == (1, 0, 0)
    assert press(plc, 1) == (1, 0, 0)
    plc.advance(ms=6000)
    assert drive.hertz == 40
    assert press(plc, 3) == (1, 0, 0)
    assert plc["D0"] == 4000
    assert press(plc, 2) == (1, 0, 0)
    plc.advance(ms=6000)
    assert drive.mode == "stopped"


def test_its_refusals_and_faults_reach_the_program(rig):
    plc, drive = rig
    drive.fail("busy")
    assert press(plc, 1) == (1, 1, 6)
    drive.fail("garbled")
    assert press(plc, 3) == (1, 1, 0x18)
    drive.fail("silent")
    assert press(plc, 1, ms=200) == (1, 1, 0x10)
    drive.faults = frozenset()
    drive.fail("overheated")
    assert press(plc, 4) == (1, 0, 0)
    assert plc["D1"] == 11


def test_the_way_back_takes_plc_line_and_motor_back(rig):
    plc, drive = rig
    press(plc, 0)
    press(plc, 1, ms=33)
    snapshot = plc.snapshot()
    plc.advance(ms=1500)
    first = drive.state(), plc.ports[1].wire.log, plc["SM135"]
    plc.restore(snapshot)
    assert drive.state() != first[0]
    plc.advance(ms=1500)
    assert (drive.state(), plc.ports[1].wire.log, plc["SM135"]) == first
