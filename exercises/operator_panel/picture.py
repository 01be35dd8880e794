"""Where the panel's state stands in its picture; its keys carry `data-key`, which the machine's panel hands to `hold` and `release`."""

from pathlib import Path

from ecsim.instructions.conversion import SEGMENTS

from ..picture import Picture, on
from ..plant import Moment
from .plant import ARROWS, COLUMNS, DIGITS, HEXADECIMAL, PARTS, ROWS

TERMINALS = tuple(
    device
    for inputs, outputs, says, led in PARTS.values()
    for device in (*(f"X{inputs + place:o}" for place in range(len(says))), *(f"Y{outputs + place:o}" for place in range(len(led))))
)
KEYS = {
    **{f"key{digit}": f"keys {digit}" for digit in HEXADECIMAL[:10]},
    **{f"pad{place}": f"keypad {cap}" for place, cap in enumerate(HEXADECIMAL)},
    **{f"arrow-{way}": f"arrows {way}" for way in ARROWS},
}
LINES, WIDTH = 4, 34  # of the paper that is seen


def pressed(key):
    """Whether a key is down."""
    return lambda moment: key in moment.plant.pressed


def thrown(place):
    """Whether a switch is on."""
    return lambda moment: moment.plant.switches[place]


def wheel(number, digit):
    """What a thumbwheel shows."""
    return lambda moment: str(moment.plant.numbers[number] // 10**digit % 10)


def line(place):
    """A line of the paper; the last one stands at the printer."""
    return lambda moment: ([""] * LINES + moment.plant.lines())[place - LINES][-WIDTH:]


def segment(display, digit, bit):
    """Whether a segment is lit: bit 0 is segment a."""

    def lit(moment):
        shown = moment.plant.shown(display)[DIGITS - 1 - digit]
        return shown != " " and SEGMENTS[int(shown)] >> bit & 1

    return lit


def there(moment: Moment) -> dict[str, str]:
    """What this panel does not have is not seen."""
    has = {f"{part}-part": part in moment.plant.parts for part in PARTS}
    has |= dict.fromkeys(("display1", "wheels1", "second-bits", "second-note"), moment.plant.sets == 2)
    return {f"{part}:display": "inline" if seen else "none" for part, seen in has.items()}


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={},
    turns={},
    lit={
        **{device: on(device) for device in TERMINALS},
        **{ident: pressed(key) for ident, key in KEYS.items()},
        **{f"switch{row}{column}": thrown(COLUMNS * row + column) for row in range(ROWS) for column in range(COLUMNS)},
        **{
            f"seg{display}{digit}{name}": segment(display, digit, bit)
            for display in range(2)
            for digit in range(DIGITS)
            for bit, name in enumerate("abcdefg")
        },
        "amiss": lambda moment: "no paper" in moment.plant.faults,
    },
    texts={
        **{f"wheel{number}{digit}": wheel(number, digit) for number in range(2) for digit in range(DIGITS)},
        **{f"paper{place}": line(place) for place in range(LINES)},
    },
    free=there,
)
