"""Checksums against long division of polynomials, published values and what a receiver checks."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

BYTES = st.binary(max_size=40)
WORDS = st.integers(0, 0xFFFF)
CHECK = b"123456789"
HIGH = 0xA500  # rubbish in the high bytes, which count for nothing


def checksum(plc, text, start):
    """D100 after the PLC's one instruction has worked on the bytes in D0 ..."""
    plc.set({f"D{place}:WORD": HIGH | byte for place, byte in enumerate(text)})
    plc.set({"D90": len(text), "D100:WORD": start})
    plc.scan()
    return plc["D100:WORD"]


def mirrored(number, bits):
    """The bits of a number in opposite order."""
    return int(f"{number:0{bits}b}"[::-1], 2)


def remainder(text, start, polynomial):
    """What long division of the message, followed by 16 zeros, leaves; the start value is added to its first bits."""
    dividend = int.from_bytes(text, "big") << 16 ^ start << 8 * len(text)
    for place in range(8 * len(text) - 1, -1, -1):
        if dividend >> place + 16 & 1:
            dividend ^= polynomial << place
    return dividend


@given(text=BYTES, start=WORDS)
def test_ccitt_is_the_remainder_of_a_long_division(running, text, start):
    assert checksum(running("LD SM0\nCCITT D0 D90 D100"), text, start) == remainder(text, start, 0x11021)


@given(text=BYTES, start=WORDS)
def test_crc16_is_the_remainder_of_a_long_division_with_all_bits_mirrored(running, text, start):
    mirror = bytes(mirrored(byte, 8) for byte in text)
    expected = mirrored(remainder(mirror, mirrored(start, 16), 0x18005), 16)
    assert checksum(running("LD SM0\nCRC16 D0 D90 D100"), text, start) == expected


@given(text=BYTES, start=WORDS)
def test_lrc_completes_the_sum_of_the_bytes_to_the_start_value(running, text, start):
    result = checksum(running("LD SM0\nLRC D0 D90 D100"), text, start)
    if text:
        assert 0 <= result <= 255
    assert (sum(text) + result - start) % 256 == 0


@given(text=BYTES, start=WORDS, cut=st.integers(0, 40))
@pytest.mark.parametrize("name", ["CCITT", "CRC16", "LRC"])
def test_two_parts_one_after_the_other_are_the_whole(running, name, text, start, cut):
    plc = running(f"LD SM0\n{name} D0 D90 D100")
    whole = checksum(plc, text, start)
    assert checksum(plc, text[cut:], checksum(plc, text[:cut], start)) == whole


@pytest.mark.parametrize(
    ("name", "start", "published"),
    [
        ("CCITT", 0, 0x31C3),  # CRC-16/XMODEM
        ("CCITT", 0xFFFF, 0x29B1),  # CRC-16/CCITT-FALSE
        ("CRC16", 0, 0xBB3D),  # CRC-16/ARC
        ("CRC16", 0xFFFF, 0x4B37),  # CRC-16/MODBUS
    ],
)
def test_the_check_string_gives_the_published_value(running, name, start, published):
    assert checksum(running(f"LD SM0\n{name} D0 D90 D100"), CHECK, start) == published


@given(text=BYTES)
def test_a_frame_with_its_crc_in_exchanged_bytes_checks_to_zero(running, text):
    plc = running("LD SM0\nCRC16 D0 D90 D100")
    crc = checksum(plc, text, 0xFFFF)
    assert checksum(plc, text + crc.to_bytes(2, "little"), 0xFFFF) == 0
