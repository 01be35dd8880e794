"""FNC 40 to 47: resetting runs of devices, decoding, encoding, counting and testing bits, the mean, annunciators."""

from ..errors import OPERAND
from .bits import dbits
from .define import FX, H2U, always, command, value


def _one_kind(model, first, last) -> str | None:
    """What is wrong with the ends of a run."""
    kinds = {(each.area, each.area == "C" and each.number >= model.wide_counters) for each in (first, last)}
    return f"D1 = {first} and D2 = {last} are not of one kind" if len(kinds) > 1 else None


_RUN = "*{max(d2-d1,0)+1}"


@value(
    "FX:ZRST", f">D1:BOOL[Y M S T C]{_RUN}~ D2:BOOL[Y M S T C]~ d1 d2", steps=5, section="FNC 40", models=FX, resets=True, check=_one_kind
)
def zrst(_, first, last):
    """Turn the devices from D1 to D2 OFF; of timers and counters the values are cleared too. A D2 below D1 leaves D1 alone to be reset."""
    return [False] * (max(last - first, 0) + 1)


@value("FX:ZRST D", f">D1:INT[D]{_RUN} D2:INT[D] d1 d2", steps=5, section="FNC 40", models=FX, as_stored=True)
def zrst_d(_, first, last):
    """The registers from D1 to D2 become 0; a D2 below D1 leaves D1 alone to be cleared."""
    return [0] * (max(last - first, 0) + 1)


# DECO and ENCO take words or runs of bits on either side; N is the number of bits of the encoded number.
_WORD, _BITS = "[T C D V Z]", "[X Y M S]"
_SMALL, _LARGE = "N:INT[const]=1..4", "N:INT[const]=1..8"
_MANY = "*{2**N}~"


def number_of(bits) -> int:
    """Bits as a number, the first one lowest."""
    return sum(bit << place for place, bit in enumerate(bits))


@value("FX:DECO", f"S:WORD[const T C D V Z] >D:WORD[T C D] {_SMALL}", steps=7, section="FNC 41", models=FX)
def deco(s, n):
    """D becomes the word in which one bit alone is ON, that of the number in the low N bits of S."""
    return 1 << s % 2**n


@value("FX:DECO bits", f"S:BOOL{_BITS}*N~ >D:WORD[T C D] {_SMALL}", steps=7, section="FNC 41", models=FX)
def deco_of_bits(s, n):
    """D becomes the word in which one bit alone is ON, that of the number in the N bits from S on."""
    return 1 << number_of(s)


@value("FX:DECO to bits", f"S:WORD[const T C D V Z] >D:BOOL[Y M S]{_MANY} {_LARGE}", steps=7, section="FNC 41", models=FX)
def deco_to_bits(s, n):
    """Of the 2^N bits from D on one alone is ON, that of the number in the low N bits of S."""
    chosen = s % 2**n
    return [place == chosen for place in range(2**n)]


@value("FX:DECO bits to bits", f"S:BOOL{_BITS}*N~ >D:BOOL[Y M S]{_MANY} {_LARGE}", steps=7, section="FNC 41", models=FX)
def deco_bits_to_bits(s, n):
    """Of the 2^N bits from D on one alone is ON, that of the number in the N bits from S on."""
    return deco_to_bits(number_of(s), n)


@command("FX:ENCO", f"S:WORD{_WORD} >D:INT {_SMALL}", steps=7, section="FNC 42", models=FX, faults=(OPERAND,), application=False)
def enco(machine, s, n):
    """D becomes the number of the highest of the low 2^N bits of S that is ON; without one D is 0, and it is an operation error."""
    return _highest(machine, s % 2**2**n)


@command(
    "FX:ENCO bits", f"S:BOOL{_BITS}{_MANY} >D:INT {_LARGE}", steps=7, section="FNC 42", models=FX, faults=(OPERAND,), application=False
)
def enco_of_bits(machine, s, n):
    """D becomes the number of the highest of the 2^N bits from S on that is ON; without one D is 0, and it is an operation error."""
    return _highest(machine, number_of(s))


def _highest(machine, number: int) -> int:
    if not number:
        machine.faults.note(OPERAND)
    return max(number.bit_length() - 1, 0)


value("FX:SUM", "S:WORD -> D:INT", steps=5, section="FNC 43", models=H2U, flags=("zero",))(dbits)
value("FX:DSUM", "S:DWORD -> D:DINT", steps=9, section="FNC 43", models=H2U, flags=("zero",))(dbits)


@value("FX:BON", "S:WORD >D:BOOL[Y M S]~ N:INT[const]=0..15", steps=7, section="FNC 44", models=H2U)
@value("FX:DBON", "S:DWORD >D:BOOL[Y M S]~ N:INT[const]=0..31", steps=13, section="FNC 44", models=H2U)
def bon(s, n):
    """D takes the state of bit N of S."""
    return s >> n & 1 == 1


@value("FX:MEAN", "S:INT[KnX KnY KnM KnS T C D]*N >D:INT N:INT[const]=1..64", steps=7, section="FNC 45", models=H2U)
@value("FX:DMEAN", "S:DINT[KnX KnY KnM KnS C D]*N >D:DINT N:INT[const]=1..64", steps=13, section="FNC 45", models=H2U)
def mean(s, n):
    """D = the mean of the N numbers from S on, cut to a whole number."""
    return int(sum(s) / n)


@always("FX:ANS", "S:TIMER[T]=0..199 M:INT[const]=1..32767 >D:POINT[S]=900..999", steps=7, section="FNC 46", models=H2U, cleared=True)
def ans(flow, timer, time, annunciator):
    """The annunciator D goes ON, and stays, when the flow has been ON for M x 100 ms; timer S measures that, flow OFF clears it."""
    if flow:
        if timer.now >= timer.due:
            timer.begin()
        if timer.value >= time:
            timer.contact = True
            annunciator = True  # noqa: F841
    else:
        timer.contact = False
        timer.value = timer.due = 0


@command("FX:ANR", "", steps=1, section="FNC 47", models=H2U)
def anr(machine):
    """Of the annunciators that are ON, S900 to S999, the one with the lowest number goes OFF."""
    states = machine.memory.lists["S"]
    lit = next((number for number in machine.model.annunciators if states[number]), None)
    if lit is not None:
        states[lit] = False
