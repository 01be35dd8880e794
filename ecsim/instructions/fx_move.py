"""FNC 13 to 19 and 147: moving, exchanging and BCD, where H1U and H2U differ from the other family."""

from ..errors import OPERAND, Fault
from .conversion import bcd, bin_
from .define import FX, H2U, value
from .transfer import fmov, same_digits

_FROM, _TO = "[KnX KnY KnM KnS T C D]", "[KnY KnM KnS T C D]"  # of blocks of words
_DIGIT = "INT[const]=1..4"


def _from_the_left(s, m1, m2, d, n):
    """What is wrong with constant places: the digits that move must all lie in a word."""
    return f"M2 = {m2} digits do not fit behind digit {min(m1, n)}" if m2 > min(m1, n) else None


@value(
    "FX:SMOV", f"S:WORD{_FROM} M1:{_DIGIT} M2:{_DIGIT} D:WORD N:{_DIGIT} unconverted -> D", steps=11, section="FNC 13", models=H2U,
    check=_from_the_left, faults=(OPERAND,),
)  # fmt: skip
def smov(s, m1, m2, d, n, unconverted):
    """M2 digits of S, from digit M1 on down, become those of D from digit N on down; digit 1 is the lowest, the others of D stay.

    The digits are those of the decimal numbers, 0 to 9999, or while M8168 is ON the hexadecimal ones.
    """
    source, target = (s, d) if unconverted else (_coded(s), _coded(d))
    mask = 16**m2 - 1
    target = target & ~(mask << 4 * (n - m2)) | (source >> 4 * (m1 - m2) & mask) << 4 * (n - m2)
    return target if unconverted else int(f"{target:x}")


def _coded(number: int) -> int:
    """A number as its decimal digits, four bits each."""
    if number > 9999:
        raise Fault(OPERAND)
    return bcd(number)


@value(
    "FX:BMOV", f"S:INT{_FROM}*N? D:INT{_TO}*N N:INT[const D]=1..512 backwards -> S D", steps=7, section="FNC 15", models=FX, as_stored=True,
    check=same_digits(0, 1),
)  # fmt: skip
def bmov(s, d, n, backwards):
    """The N words from D on become those from S on, or, while M8024 is ON, those from S on become those from D on; they may overlap."""
    return (d, d) if backwards else (None, s)


for _name, _type, _steps in (("FMOV", "INT", 7), ("DFMOV", "DINT", 13)):
    value(f"FX:{_name}", f"S:{_type} >D:{_type}*N N:INT[const]=1..512", steps=_steps, section="FNC 16", models=H2U, as_stored=True)(fmov)


@value("FX:XCH", "D1:INT D2:INT d1 d2 exchange -> D1 D2", steps=5, section="FNC 17", models=H2U, faults=(OPERAND,))
@value("FX:DXCH", "D1:DINT D2:DINT d1 d2 exchange -> D1 D2", steps=9, section="FNC 17", models=H2U, faults=(OPERAND,))
def xch(one, other, first, second, exchange):
    """D1 and D2 change places; while M8160 is ON the bytes in each word of D1 do, and D2 has to be the same device."""
    if not exchange:
        return other, one
    if first != second or one != other:
        raise Fault(OPERAND)
    return swapped(one), swapped(one)


@value("FX:DSWAP", "D:DINT -> D", steps=5, section="FNC 147", models=H2U)
def swapped(d):
    """The two bytes of each word of D change places."""
    return (d & 0x00FF00FF) << 8 | d >> 8 & 0x00FF00FF


for _name, _type, _most, _steps in (("BCD", "WORD", 9999, 5), ("DBCD", "DWORD", 99999999, 9)):
    value(f"FX:{_name}", f"S:{_type}-const=0..{_most} -> D:{_type}", steps=_steps, section="FNC 18", models=FX)(bcd)
for _name, _type, _steps in (("BIN", "WORD", 5), ("DBIN", "DWORD", 9)):
    value(f"FX:{_name}", f"S:{_type}-const -> D:{_type}", steps=_steps, section="FNC 19", models=FX, faults=(OPERAND,))(bin_)
