"""FNC 81 to 84: octal places and decimal ones, ASCII characters of hexadecimal digits, check codes.

Characters lie two in a word, the first one in the low byte, or while M8161 is ON one in the low byte of each word.
"""

from functools import reduce
from operator import xor

from ..errors import OPERAND, Fault
from .conversion import HEX_DIGITS, fetched, stored
from .define import FX, command, value
from .transfer import same_digits

# -- PRUN: M0 to M7, M10 to M17 and so on stand for eight inputs or outputs each --------------------------------------


def _round_numbers(source, target) -> str | None:
    """What is wrong with the first devices of PRUN."""
    wrong = next((each for each in (source, target) if each.number % (10 if each.area == "M" else 8)), None)
    return f"{wrong} does not begin with a number that ends in 0" if wrong else same_digits(0, 1)(source, target)


def _places(group) -> list[int]:
    """The numbers of the relays that a group of PRUN stands for."""
    return [group.number + place // 8 * 10 + place % 8 for place in range(4 * group.digits)]


@command("FX:PRUN", "S:WORD[KnX] >D:PLACE[KnM]~", steps=5, section="FNC 81", models=FX, check=_round_numbers)
@command("FX:DPRUN", "S:DWORD[KnX] >D:DPLACE[KnM]~", steps=9, section="FNC 81", models=FX, check=_round_numbers)
def prun(machine, s, group):
    """The relays M from D on take the inputs from S on, by number: X0 to X7 go to M0 to M7, X10 to X17 to M10 to M17."""
    relays = machine.memory.lists[group.area]
    for place, number in enumerate(_places(group)):
        relays[number] = s >> place & 1 == 1


@command("FX:PRUN M", "S:PLACE[KnM]~ >D:WORD[KnY]", steps=5, section="FNC 81", models=FX, check=_round_numbers)
@command("FX:DPRUN M", "S:DPLACE[KnM]~ >D:DWORD[KnY]", steps=9, section="FNC 81", models=FX, check=_round_numbers)
def prun_of_relays(machine, group):
    """The outputs from D on take the relays M from S on, by number: M0 to M7 go to Y0 to Y7, M10 to M17 to Y10 to Y17."""
    relays = machine.memory.lists[group.area]
    return sum(relays[number] << place for place, number in enumerate(_places(group)))


# -- characters ---------------------------------------------------------------------------------------------------------

_COUNT = "N:INT[const D]=1..256 bytewise"
_CHARACTERS = "*{N if bytewise else (N+1)//2}"
_DIGITS = "*{(N+3)//4}"
_BLOCK = "[KnY KnM KnS T C D]"


@value("FX:ASCI", f"S:WORD{_DIGITS} >D:WORD{_BLOCK}{_CHARACTERS} {_COUNT}", steps=7, section="FNC 82", models=FX)
def asci(s, n, bytewise):
    """The words from D on become the characters of the low N hexadecimal digits of the number from S on, the highest digit first.

    The number has its lowest four digits in S, the next four in S+1 and so on.
    """
    number = sum(word << 16 * place for place, word in enumerate(s))
    return stored(f"{number:0{n}X}"[-n:].encode(), bytewise)


@value("FX:HEX", f"S:WORD{_CHARACTERS} >D:WORD{_DIGITS} {_COUNT}", steps=7, section="FNC 83", models=FX, faults=(OPERAND,))
def hex_(s, n, bytewise):
    """D becomes the number that the N characters from S on spell in hexadecimal, its lowest four digits in D, the next in D+1 and so on.

    A character other than 0 to 9 and A to F is an operation error.
    """
    digits = bytes(fetched(s, bytewise)[:n])
    if not HEX_DIGITS.issuperset(digits):
        raise Fault(OPERAND)
    number = int(digits, 16)
    return [number >> place & 0xFFFF for place in range(0, 4 * n, 16)]


@value("FX:CCD", f"S:WORD[KnX KnY KnM KnS T C D]{_CHARACTERS} >D:WORD{_BLOCK}*2 {_COUNT}", steps=7, section="FNC 84", models=FX)
def ccd(s, n, bytewise):
    """D = the sum of the N bytes from S on, D+1 = their exclusive or."""
    octets = fetched(s, bytewise)[:n]
    return [sum(octets), reduce(xor, octets)]
