"""6.13: checksums over the low bytes of registers. D holds the start value before and the result after."""

from binascii import crc_hqx

from ..comms import checksums
from .define import value


def low_bytes(words):
    """The data: the high byte of a word counts for nothing."""
    return bytes(word & 255 for word in words)


@value("CCITT", "S1:WORD[D V]*S2 S2:INT=0..32767 D:WORD[D V] -> D", steps=7, section="6.13.1")
def ccitt(s1, s2, d):
    """D becomes the CRC of S2 bytes from S1 on with x^16 + x^12 + x^5 + 1, the highest bit first, begun with D."""
    return crc_hqx(low_bytes(s1), d)


@value("CRC16", "S1:WORD[D V]*S2 S2:INT=0..32767 D:WORD[D V] -> D", steps=7, section="6.13.2")
def crc16(s1, s2, d):
    """D becomes the CRC of S2 bytes from S1 on with x^16 + x^15 + x^2 + 1, the lowest bit first, begun with D.

    Begun with 16#FFFF it is the CRC of Modbus, whose low byte is sent first.
    """
    return checksums.crc16(low_bytes(s1), d)


@value("LRC", "S1:WORD[D V]*S2 S2:INT=0..32767 D:WORD[D V] -> D", steps=7, section="6.13.3")
def lrc(s1, s2, d):
    """D becomes the LRC of S2 bytes from S1 on: what is missing from their sum to a multiple of 256, begun with D."""
    return checksums.lrc(low_bytes(s1), d)
