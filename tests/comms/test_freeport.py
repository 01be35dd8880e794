"""XMT and RCV: what ends a reception, relays and registers, interrupts, STOP (10.3, 6.12.11, 6.12.12, 9.8)."""

import pytest

from ecsim.hardware.serial import PortSettings
from ecsim.plc import Plc
from ecsim.system import SystemBlock

FREE = {"protocol": "freeport", "baud": 9600}  # 8N1: 10 bits, 1041.67 us a character
SEND = "LD M0\nEU\nXMT 1 D0 D100"
RECEIVE = "LD M1\nEU\nRCV 1 D10 D101"
# Interrupt programs that count: sent and received characters and frames of port 1
COUNTING = "\n".join(
    f"INTERRUPT I{event} EVENT {event}\nLD SM0\nINC D{200 + event}\nEND_INTERRUPT" for event in (34, 35, 36, 37)
)  # fmt: skip


def machine(program=f"{SEND}\n{RECEIVE}", model="EC10", count=5, **settings):
    """A running PLC with freeport on port 1; XMT sends D0 to D4, RCV takes up to D101 characters."""
    plc = Plc(model, input_filter_ms=0, system=SystemBlock(port1=PortSettings(**FREE | settings)))
    plc.load(program)
    plc.run()
    plc.set({f"D{place}": 0x1131 + place for place in range(5)} | {"D100": count, "D101": count})
    port = plc.ports[1]
    port.connect(Silent())
    return plc


class Silent:
    """An instrument that keeps what it hears."""

    def __init__(self):
        self.heard = []

    def hear(self, message):
        self.heard.append(message)


def heard(plc):
    """All that the instrument has heard."""
    return b"".join(plc.ports[1].wire.stations[0].instrument.heard)


def say(plc, text):
    """The instrument begins to send."""
    plc.ports[1].wire.stations[0].send(text, plc.time_us)
    plc.ports[1].stirred()


# -- XMT ------------------------------------------------------------------------------------------------------------


def test_the_low_bytes_go_out_one_behind_the_other():
    plc = machine()
    plc["M0"] = 1
    plc.scan()
    assert heard(plc) == b"12345"
    assert plc.ports[1].wire.log == [(0, "port 1", "3132333435")]


def test_the_relays_tell_that_it_is_sending_and_that_it_has_sent():
    plc = machine(count=10)  # 10.4 ms
    assert [plc["SM120"], plc["SM122"], plc["SM124"]] == [0, 0, 1]
    plc["M0"] = 1
    plc.scan()
    assert [plc["SM120"], plc["SM122"], plc["SM124"]] == [1, 0, 0]
    plc.scan()
    assert [plc["SM120"], plc["SM122"], plc["SM124"]] == [0, 1, 1]


def test_a_second_xmt_waits_until_the_first_has_ended():
    plc = machine("LD SM0\nXMT 1 D0 D100\nLD SM0\nXMT 1 D4 1", count=12)
    plc.scan(3)  # 12.5 ms, then in the scan at 20 ms the first XMT begins again
    assert [began for began, _, _ in plc.ports[1].wire.log] == [0]
    plc.scan()
    assert [began for began, _, _ in plc.ports[1].wire.log] == [0, 20_000]


def test_the_program_breaks_it_off_with_the_relay():
    plc = machine(f"{SEND}\nLD M5\nRST SM120", count=12)
    plc["M0"] = 1
    plc.scan()
    plc["M5"] = 1
    plc.scan(2)
    assert len(heard(plc)) == 9  # 9 characters end in 10 ms
    assert [plc["SM120"], plc["SM122"], plc["SM124"]] == [0, 0, 1]


def test_stop_breaks_it_off():
    plc = machine(count=12)
    plc["M0"] = 1
    plc.scan()
    plc.stop()
    plc.scan(3)
    assert len(heard(plc)) == 9
    assert [plc["SM120"], plc["SM124"]] == [0, 1]


@pytest.mark.parametrize(("count", "error"), [(0, 64), (-1, 64), (7999, 65)])
def test_a_count_that_cannot_be_is_an_error(count, error):
    plc = machine("LD SM0\nXMT 1 D10 D100", count=count)
    plc.scan()
    assert plc["SD20"] == error
    assert plc.ports[1].wire.log == []


def test_a_port_with_another_protocol_sends_nothing():
    plc = Plc("EC20")
    plc.load("LD SM0\nXMT 1 D0 1\nRCV 1 D10 1")
    plc.run()
    plc.scan(2)
    assert [plc["SM120"], plc["SM121"], plc["SM124"], plc["SD20"]] == [0, 0, 1, 0]


# -- RCV ------------------------------------------------------------------------------------------------------------


def receiving(text, scans=3, **settings):
    """A machine that receives, after an instrument has said something in the second scan."""
    plc = machine(**settings)
    plc["M1"] = 1
    plc.scan()
    say(plc, text)
    plc.scan(scans)
    return plc


def state(plc):
    """Completion code, characters received, the relays receiving, received and idle."""
    return plc["SD125"], plc["SD127"], plc["SM121"], plc["SM123"], plc["SM124"]


def test_the_greatest_count_ends_a_reception():
    plc = receiving(b"abcdefgh")
    assert state(plc) == (4, 5, 0, 1, 1)
    assert [plc[f"D{10 + place}"] for place in range(6)] == [97, 98, 99, 100, 101, 0]
    assert plc["SD126"] == 101  # the last one that it took


def test_while_it_receives_the_port_is_not_idle():
    assert state(receiving(b"ab")) == (0, 2, 1, 0, 0)


def test_a_character_before_the_rcv_is_lost():
    plc = machine()
    say(plc, b"xy")
    plc.scan()
    assert state(plc) == (0, 0, 0, 0, 1)


def test_the_end_character_ends_it_and_is_stored():
    plc = receiving(b"ab\rcd", end_char=13)
    assert state(plc) == (2, 3, 0, 1, 1)
    assert plc["D12"] == 13


def test_characters_before_the_start_character_are_passed_over():
    plc = receiving(b"xy:ab:c", start_char=0x3A)
    assert state(plc)[:2] == (4, 5)
    assert [plc[f"D{10 + place}"] for place in range(5)] == list(b":ab:c")


def test_a_start_character_that_is_the_end_character_too_begins_and_ends():
    plc = receiving(b"~ab~cd", start_char=0x7E, end_char=0x7E)
    assert state(plc)[:2] == (2, 4)


def test_the_end_character_as_the_last_one_gives_both_bits():
    assert state(receiving(b"abcd\r", end_char=13))[:2] == (6, 5)


def test_the_program_may_change_start_and_end_character():
    plc = machine(start_char=0x3A, end_char=13)
    plc.set({"SD121": 0x28, "SD122": 0x29, "M1": 1})
    plc.scan()
    say(plc, b":(a)")
    plc.scan(2)
    assert state(plc)[:2] == (2, 3)


def test_a_gap_between_two_characters_ends_it():
    plc = receiving(b"ab", scans=1, gap_timeout_ms=15)
    assert state(plc) == (0, 2, 1, 0, 0)
    plc.scan(2)  # b ended 2.08 ms into its scan; 15 ms later are 17.08 ms
    assert state(plc) == (8, 2, 0, 1, 1)


def test_no_gap_is_watched_before_the_first_character():
    plc = receiving(b"", scans=5, gap_timeout_ms=15)
    assert state(plc) == (0, 0, 1, 0, 0)


def test_the_time_of_a_frame_counts_from_the_rcv_on():
    plc = receiving(b"ab", scans=1, frame_timeout_ms=25)
    assert state(plc) == (0, 2, 1, 0, 0)
    plc.scan()
    assert state(plc) == (16, 2, 0, 1, 1)


def test_a_parity_error_ends_it_without_the_character():
    plc = machine(parity="even")
    plc["M1"] = 1
    plc.scan()
    station = plc.ports[1].wire.stations[0]
    say(plc, b"a")
    plc.scan()
    station.framing = PortSettings("freeport", parity="odd").framing
    say(plc, b"b")
    plc.scan()
    assert state(plc) == (32, 1, 0, 1, 1)


def test_the_user_ends_it_with_the_relay():
    plc = machine(f"{RECEIVE}\nLD M5\nRST SM121")
    plc["M1"] = 1
    plc.scan()
    plc["M5"] = 1
    plc.scan()
    assert state(plc) == (1, 0, 0, 0, 1)


def test_stop_breaks_a_reception_off():
    plc = receiving(b"ab")
    plc.stop()
    assert [plc["SM121"], plc["SM123"], plc["SM124"]] == [0, 0, 1]


def test_with_flow_all_the_time_the_next_reception_begins_in_the_next_scan():
    plc = machine("LD SM0\nRCV 1 D10 2")
    plc.scan()
    say(plc, b"abc")  # c comes while nothing is at work: the scan is not over
    plc.scan()
    assert state(plc)[:3] == (4, 2, 0)
    plc.scan()
    assert state(plc)[:3] == (0, 0, 1)


def test_sending_and_receiving_go_on_at_once():
    plc = machine()
    plc.set({"M0": 1, "M1": 1})
    plc.scan()
    say(plc, b"abcde")
    plc.scan()
    assert (heard(plc), state(plc)[:2]) == (b"12345", (4, 5))


@pytest.mark.parametrize(("target", "count", "error"), [("D10", 0, 64), ("D7998", 3, 65), ("V62", 3, 65)])
def test_a_reception_that_has_no_room_is_an_error(target, count, error):
    plc = machine(f"LD SM0\nRCV 1 {target} D101", count=count)
    plc.scan()
    assert (plc["SD20"], plc["SM121"]) == (error, 0)


# -- settings and interrupts ----------------------------------------------------------------------------------------


def test_the_mode_word_tells_the_settings():
    # 4800 baud 3; two stop bits 8; odd 16; parity 32; seven bits 64; start 128; end 256; gap 512; frame 1024
    plc = machine(
        baud=4800, stop_bits=2, parity="odd", data_bits=7, start_char=2, end_char=3, gap_timeout_ms=4, frame_timeout_ms=5, model="EC20"
    )  # fmt: skip
    assert plc["SD120"] == 3 + 8 + 16 + 32 + 64 + 128 + 256 + 512 + 1024
    assert [plc[f"SD{number}"] for number in (121, 122, 123, 124)] == [2, 3, 4, 5]
    assert plc["SD110"] == 2  # port 0 as it comes: 9600 8N1


def test_the_events_of_characters_and_frames_ask_for_their_programs():
    plc = machine(f"PROGRAM MAIN\nLD SM1\nEI\nSET SM52\nSET SM53\nSET SM54\nSET SM55\n{SEND}\n{RECEIVE}\nEND_PROGRAM\n{COUNTING}")
    plc.set({"M0": 1, "M1": 1})
    plc.scan()
    say(plc, b"abcde")
    plc.scan()
    assert [plc[f"D{number}"] for number in (234, 235, 236, 237)] == [5, 5, 1, 1]


def test_an_event_that_is_not_enabled_asks_for_nothing():
    plc = machine(f"PROGRAM MAIN\nLD SM1\nEI\nSET SM54\n{SEND}\n{RECEIVE}\nEND_PROGRAM\n{COUNTING}")
    plc["M0"] = 1
    plc.scan()
    assert [plc[f"D{number}"] for number in (234, 235, 236, 237)] == [0, 0, 1, 0]


def test_an_interrupt_program_may_send_the_next_frame():
    answer = "INTERRUPT I EVENT 37\nLD SM0\nXMT 1 D20 2\nEND_INTERRUPT"
    plc = machine(f"PROGRAM MAIN\nLD SM1\nEI\nSET SM55\n{RECEIVE}\nEND_PROGRAM\n{answer}", count=2)
    plc.set({"M1": 1, "D20": 0x4F, "D21": 0x4B})
    plc.scan()
    say(plc, b"ab")
    plc.scan()
    # b ends 2083 us after 10 ms; the interrupt program sends in that very moment
    assert plc.ports[1].wire.log == [(10_000, "Silent", "6162"), (12_083, "port 1", "4f4b")]


def test_going_back_repeats_the_same_characters():
    plc = machine(count=12)
    plc.set({"M0": 1, "M1": 1})
    plc.scan()
    say(plc, b"abcdefgh")
    snapshot = plc.snapshot()
    plc.scan(4)
    first = state(plc), heard(plc), plc.ports[1].wire.log
    plc.restore(snapshot)
    assert state(plc) != first[0]
    plc.scan(4)
    assert (state(plc), plc.ports[1].wire.log) == (first[0], first[2])
