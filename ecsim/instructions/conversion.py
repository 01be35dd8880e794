"""6.5: numbers from one form into another."""

from ..errors import OPERAND, Fault
from .define import value

# The pattern of segments for each hexadecimal digit: bit 0 is a, bit 6 is g.
SEGMENTS = (0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x07, 0x7F, 0x6F, 0x77, 0x7C, 0x39, 0x5E, 0x79, 0x71)
HEX_DIGITS = frozenset(b"0123456789ABCDEF")


@value("DTI", "S:DINT=-32768..32767 -> D:INT", steps=6, section="6.5.1")
@value("ITD", "S:INT -> D:DINT", steps=6, section="6.5.2")
def resized(s):
    """D becomes the same whole number as S in the other width."""
    return s


@value("FLT", "S:INT -> D:REAL", steps=6, section="6.5.3")
@value("DFLT", "S:DINT -> D:REAL", steps=7, section="6.5.4")
def real(s):
    """D becomes S as a REAL, the nearest one where there is none that equals it."""
    return s


def truncated(s, low, high):
    """A real number without its fraction, held between two limits; zero, out of the limits, fraction lost."""
    if low <= s <= high:
        whole = int(s)
        return whole, whole == 0, False, whole != s
    if s != s:
        raise Fault(OPERAND)
    return high if s > high else low, False, True, False


@value("INT", "S:REAL -> D:INT zero carry borrow", steps=6, section="6.5.5", faults=(OPERAND,))
def int_(s):
    """D becomes S without its fraction, held within 16 bits; carry tells of a limit, borrow of a lost fraction."""
    return truncated(s, -0x8000, 0x7FFF)


@value("DINT", "S:REAL -> D:DINT zero carry borrow", steps=7, section="6.5.6", faults=(OPERAND,))
def dint(s):
    """D becomes S without its fraction, held within 32 bits; carry tells of a limit, borrow of a lost fraction."""
    return truncated(s, -0x8000_0000, 0x7FFF_FFFF)


@value("BCD", "S:WORD=0..9999 -> D:WORD", steps=5, section="6.5.7")
@value("DBCD", "S:DWORD=0..99999999 -> D:DWORD", steps=7, section="6.5.8")
def bcd(s):
    """D becomes S with four bits for each of its decimal digits."""
    return int(str(s), 16)


@value("BIN", "S:WORD -> D:WORD", steps=5, section="6.5.9", faults=(OPERAND,))
@value("DBIN", "S:DWORD -> D:DWORD", steps=7, section="6.5.10", faults=(OPERAND,))
def bin_(s):
    """D becomes the number whose decimal digits stand in S, four bits each."""
    digits = f"{s:x}"
    if not digits.isdecimal():
        raise Fault(OPERAND)
    return int(digits)


@value("GRY", "S:WORD -> D:WORD", steps=5, section="6.5.11")
@value("DGRY", "S:DWORD -> D:DWORD", steps=7, section="6.5.12")
def gry(s):
    """D becomes S in Gray code, in which neighbours differ in one bit."""
    return s ^ s >> 1


@value("GBIN", "S:WORD -> D:WORD", steps=5, section="6.5.13")
@value("DGBIN", "S:DWORD -> D:DWORD", steps=7, section="6.5.14")
def gbin(s):
    """D becomes the number that S spells in Gray code."""
    for shift in (16, 8, 4, 2, 1):
        s ^= s >> shift
    return s


@value("SEG", "S:WORD=0..15 -> D:WORD", steps=5, section="6.5.15")
def seg(s):
    """D becomes the seven segments that show the digit S, 0 to F: bit 0 is segment a, bit 6 segment g."""
    return SEGMENTS[s]


def stored(codes, bytewise):
    """Characters as words: one in each, or two, the first one in the low byte."""
    if bytewise:
        return codes
    pairs = iter([*codes, 0])
    return [low | high << 8 for low, high in zip(pairs, pairs, strict=False)]


def fetched(words, bytewise):
    """The characters of words that hold them in the same way."""
    return [word & 255 for word in words] if bytewise else [code for word in words for code in (word & 255, word >> 8)]


def hold(words, count):
    """Refuse a count outside 1 to 256; a constant is one word, and there a larger count means all that it holds."""
    if count < 1 or (count > 256 and len(words) > 1):
        raise Fault(OPERAND)


def one_to_256(s1, d, s2):
    """What is wrong with a constant count."""
    if isinstance(s2, int) and not 1 <= s2 <= (65535 if isinstance(s1, int) else 256):
        return f"S2 = {s2} is out of range, S2 goes from 1 to 256"
    return None


@value("ASC", "S:TEXT*8 bytewise -> D:WORD[D C T V Z]*{8 if bytewise else 4}", steps=19, section="6.5.16", models=("EC10",), pulsed=False)
def asc(s, bytewise):
    """The words from D on become the ASCII codes of up to eight characters, the rest zeros.

    Two characters a word, the first one in the low byte; one a word while the relay of the ASCII form (SM186) is ON.
    """
    return stored(s, bytewise)


@value(
    "ITA",
    "S1:WORD*{(min(S2,256)+3)//4}^ >D:WORD*{min(S2,256) if bytewise else (min(S2,256)+1)//2}^ S2:WORD bytewise",
    steps=7,
    section="6.5.17",
    models=("EC10",),
    faults=(OPERAND,),
    check=one_to_256,
)
def ita(s1, s2, bytewise):
    """The words from D on become the ASCII codes of S2 hexadecimal digits, which are taken from S1 on, the highest of a word first.

    Two characters a word, the first one in the low byte; one a word while the relay of the ASCII form (SM186) is ON.
    """
    hold(s1, s2)
    return stored("".join(f"{word:04X}" for word in s1)[:s2].encode(), bytewise)


@value(
    "ATI",
    "S1:WORD*{min(S2,256) if bytewise else (min(S2,256)+1)//2}^ >D:WORD*{(min(S2,256)+3)//4}^ S2:WORD bytewise",
    steps=7,
    section="6.5.18",
    models=("EC10",),
    faults=(OPERAND,),
    check=one_to_256,
)
def ati(s1, s2, bytewise):
    """The words from D on become the S2 hexadecimal digits whose ASCII codes stand from S1 on, the first one highest in its word.

    Two characters a word, the first one in the low byte; one a word while the relay of the ASCII form (SM186) is ON.
    """
    hold(s1, s2)
    digits = bytes(fetched(s1, bytewise)[:s2])
    if not HEX_DIGITS.issuperset(digits):
        raise Fault(OPERAND)
    return [int(digits[place : place + 4].ljust(4, b"0"), 16) for place in range(0, len(digits), 4)]
