"""FNC 30 to 39: rotating in place, shifting of bits and words, first in first out. Left is the side of the higher bit or number."""

from ..errors import OPERAND, Fault
from .define import FX, H2U, value
from .shifts import out_at_left, out_at_right, sftl, sftr, through_carry
from .transfer import same_digits, wsfl, wsfr


def ror(d, n, carry):
    """D is rotated right by N bits; the carry flag is the bit that moved last."""
    return out_at_right(d, 16, n, carry)


def dror(d, n, carry):
    """D, 32 bits, is rotated right by N bits; the carry flag is the bit that moved last."""
    return out_at_right(d, 32, n, carry)


def rol(d, n, carry):
    """D is rotated left by N bits; the carry flag is the bit that moved last."""
    return out_at_left(d, 16, n, carry)


def drol(d, n, carry):
    """D, 32 bits, is rotated left by N bits; the carry flag is the bit that moved last."""
    return out_at_left(d, 32, n, carry)


def rcr(d, n, carry):
    """D and the carry flag, a ring of 17 bits, are rotated right by N bits."""
    return through_carry(d, 16, n, carry)


def drcr(d, n, carry):
    """D and the carry flag, a ring of 33 bits, are rotated right by N bits."""
    return through_carry(d, 32, n, carry)


def rcl(d, n, carry):
    """D and the carry flag, a ring of 17 bits, are rotated left by N bits."""
    return through_carry(d, 16, -n, carry)


def drcl(d, n, carry):
    """D and the carry flag, a ring of 33 bits, are rotated left by N bits."""
    return through_carry(d, 32, -n, carry)


for _number, _pair in enumerate(((ror, dror), (rol, drol), (rcr, drcr), (rcl, drcl)), 30):
    for _function, _type, _bits, _steps in zip(_pair, ("WORD", "DWORD"), (16, 32), (5, 9), strict=True):
        value(
            f"FX:{_function.__name__.upper()}", f"D:{_type}^ N:INT[const]=0..{_bits} carry -> D carry", steps=_steps,
            section=f"FNC {_number}", models=H2U,
        )(_function)  # fmt: skip


def _no_more_than(s, d, n1, n2) -> str | None:
    """What is wrong with constant counts."""
    return f"N2 = {n2} is more than N1 = {n1}" if n2 > n1 else None


def _of_words(s, d, n1, n2) -> str | None:
    """The same, and Kn strings have to have one length."""
    return _no_more_than(s, d, n1, n2) or same_digits(0, 1)(s, d)


for _name, _number, _function in (("SFTR", 34, sftr), ("SFTL", 35, sftl)):
    value(
        f"FX:{_name}", "S:BOOL[X Y M S]*N2~ D:BOOL[Y M S]*N1~ N1:INT[const]=1..1024 N2:INT[const]=0..1024 -> D", steps=9,
        section=f"FNC {_number}", models=FX, check=_no_more_than,
    )(_function)  # fmt: skip
for _name, _number, _function in (("WSFR", 36, wsfr), ("WSFL", 37, wsfl)):
    value(
        f"FX:{_name}",
        "S:INT[KnX KnY KnM KnS T C D]*N2 D:INT[KnY KnM KnS T C D]*N1 N1:INT[const]=1..512 N2:INT[const]=0..512 -> D", steps=9,
        section=f"FNC {_number}", models=H2U, as_stored=True, check=_of_words,
    )(_function)  # fmt: skip


# A queue is a pointer, D or S, and N - 1 words behind it; the pointer tells how many of them are filled.
_QUEUE = "INT[KnY KnM KnS T C D]*N"


@value(
    "FX:SFWR", f"S:INT D:{_QUEUE} N:INT[const]=2..512 -> D carry", steps=7, section="FNC 38", models=FX, as_stored=True, faults=(OPERAND,)
)
def sfwr(s, d, n):
    """S becomes the last word of the queue at D, whose pointer grows by 1; carry tells that its N - 1 places were full already."""
    count = d[0]
    if count < 0:
        raise Fault(OPERAND)
    if count >= n - 1:
        return d, True
    d[0] = count + 1
    d[count + 1] = s
    return d, False


@value(
    "FX:SFRD", f"S:{_QUEUE} D:INT N:INT[const]=2..512 -> S D zero", steps=7, section="FNC 39", models=FX, as_stored=True, faults=(OPERAND,)
)
def sfrd(s, d, n):
    """D becomes the first word of the queue at S, the others move up, the last one stays; zero tells that the queue was empty."""
    count = s[0]
    if not 0 <= count < n:
        raise Fault(OPERAND)
    if count == 0:
        return s, d, True
    return [count - 1, *s[2:], s[-1]], s[1], False
