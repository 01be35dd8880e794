"""Frames of both modes against the manual's own, published values and the rules of 10.4.3 and 10.4.4."""

import json
from pathlib import Path

import pytest

from ecsim.comms.frames import (
    MODES,
    BadFrame,
    Heard,
    Receiver,
    ascii_decode,
    ascii_encode,
    rtu_decode,
    rtu_encode,
    tcp_decode,
    tcp_encode,
    tcp_length,
)

PRINTED = json.loads((Path(__file__).parent.parent / "facts" / "modbus_frames.json").read_text(encoding="utf-8"))
FRAMES = sorted({row[key] for row in PRINTED for key in ("request", "response", "response_if_all_off") if row.get(key)})
CHARACTER = 1000  # us
RTU, ASCII = MODES["rtu"], MODES["ascii"]


@pytest.mark.parametrize("printed", FRAMES)
def test_every_printed_frame_is_sound_and_comes_out_again(printed):
    frame = bytes.fromhex(printed)
    station, message = rtu_decode(frame)
    assert (station, message) == (frame[0], frame[1:-2])
    assert rtu_encode(station, message) == frame


@pytest.mark.parametrize("printed", FRAMES)
def test_one_wrong_bit_anywhere_is_noticed(printed):
    frame = bytearray.fromhex(printed)
    for place in range(8 * len(frame)):
        frame[place // 8] ^= 1 << place % 8
        with pytest.raises(BadFrame):
            rtu_decode(bytes(frame))
        frame[place // 8] ^= 1 << place % 8


def test_an_ascii_frame_by_hand():
    # 01 + 03 + 00 + 00 + 00 + 0A = 0E, 100 - 0E = F2
    assert ascii_encode(1, bytes.fromhex("030000000A")) == b":01030000000AF2\r\n"
    assert ascii_decode(b":01030000000AF2\r\n") == (1, bytes.fromhex("030000000A"))


@pytest.mark.parametrize(
    "frame",
    [
        b":01030000000AF3\r\n",  # LRC
        b":01030000000AF2\n\r",  # end
        b":01030000000AF2",
        b"01030000000AF2\r\n",  # head
        b":01030000000aF2\r\n",  # a character that is none of the protocol's
        b":0103000000 AF2\r\n",
        b":01030000000F2\r\n",  # an odd number of digits
        b":\r\n",
        b":01FF\r\n",  # no function
        b"",
    ],
)
def test_a_bad_ascii_frame_is_refused(frame):
    with pytest.raises(BadFrame):
        ascii_decode(frame)


@pytest.mark.parametrize("frame", [b"", b"\x01", b"\x01\x7e\x80"])
def test_a_short_rtu_frame_is_refused(frame):
    with pytest.raises(BadFrame):
        rtu_decode(frame)


def test_the_longest_frames():
    message = bytes(253)
    assert len(rtu_encode(1, message)) == RTU.longest == 256
    assert len(ascii_encode(1, message)) == ASCII.longest == 513


def test_a_frame_over_tcp():
    frame = bytes.fromhex("1234 0000 0006 01 0300000001")
    assert tcp_encode(0x1234, 1, bytes.fromhex("0300000001")) == frame
    assert tcp_decode(frame) == (0x1234, 1, bytes.fromhex("0300000001"))
    assert tcp_length(frame + b"more") == len(frame) == 12
    assert tcp_length(frame[:5]) == 0


@pytest.mark.parametrize("head", ["0000 0001 0006", "0000 0000 0001", "0000 0000 0000", "0000 0000 00FF", "FFFF FFFF FFFF"])
def test_what_cannot_begin_a_frame_over_tcp_is_refused(head):
    with pytest.raises(BadFrame):
        tcp_length(bytes.fromhex(head))


def hear(receiver, octets, gap=0.0, begin=0.0, garbled=False):
    """Characters one after the other, `gap` characters of silence between them; the frames that end with one of them, and the time."""
    now, heard = begin, []
    for octet in octets:
        now += CHARACTER * (1 + gap)
        heard.append(receiver.hear(octet, now, garbled))
    return [frame for frame in heard if frame is not None], now


def test_a_silence_of_three_and_a_half_characters_ends_an_rtu_frame():
    receiver = Receiver(RTU, CHARACTER)
    assert receiver.due is None
    frames, now = hear(receiver, b"\1\2\3\4")
    assert frames == []
    assert receiver.due == now + 3500
    assert receiver.end() == Heard(b"\1\2\3\4")
    assert receiver.due is None


@pytest.mark.parametrize(("gap", "torn"), [(1.5, False), (1.6, True), (3.4, True)])
def test_a_gap_of_more_than_one_and_a_half_characters_tears_an_rtu_frame(gap, torn):
    receiver = Receiver(RTU, CHARACTER)
    hear(receiver, b"\1\2\3\4", gap)
    assert receiver.end() == Heard(b"\1\2\3\4", torn=torn)
    hear(receiver, b"\5", begin=1e9)
    assert receiver.end() == Heard(b"\5")  # the next frame is whole


def test_a_wrong_parity_bit_spoils_a_frame():
    receiver = Receiver(RTU, CHARACTER)
    hear(receiver, b"\1\2\3\4", garbled=True)
    assert receiver.end().torn


def test_what_is_longer_than_a_frame_is_cut_and_called_an_overrun():
    receiver = Receiver(RTU, CHARACTER)
    hear(receiver, bytes(256))
    assert receiver.end() == Heard(bytes(256))
    hear(receiver, bytes(100_000))
    assert len(receiver.octets) == 256
    assert receiver.end().overrun


def test_an_ascii_frame_begins_with_a_colon_and_ends_with_a_line_feed():
    receiver = Receiver(ASCII, CHARACTER)
    frames, _ = hear(receiver, b"noise\r\n:01030000000AF2\r\nrest")
    assert frames == [Heard(b":01030000000AF2\r\n")]
    assert receiver.due is None


def test_a_second_colon_breaks_off_an_ascii_frame_and_begins_another():
    receiver = Receiver(ASCII, CHARACTER)
    frames, _ = hear(receiver, b":0103:01030000000AF2\r\n")
    assert frames == [Heard(b":0103", torn=True), Heard(b":01030000000AF2\r\n")]


@pytest.mark.parametrize(("gap", "torn"), [(999, False), (1001, True)])  # in characters of a millisecond
def test_a_second_of_silence_tears_an_ascii_frame(gap, torn):
    receiver = Receiver(ASCII, CHARACTER)
    frames, _ = hear(receiver, b":01030000000AF2\r\n", gap)
    assert frames == [Heard(b":01030000000AF2\r\n", torn=torn)]


def test_an_endless_ascii_frame_is_an_overrun():
    receiver = Receiver(ASCII, CHARACTER)
    frames, _ = hear(receiver, b":" + b"0" * 10_000 + b"\r\n")
    assert [frame.overrun for frame in frames] == [True]
    assert len(receiver.octets) == 0
