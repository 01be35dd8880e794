"""The operand tables of the manual as one line of text: "S1:INT S2:INT -> D:INT".

They stand in the order in which a program writes them. Left of the arrow are those that are read, right of it those
that are written; an operand on both sides is read and written, and one with ">" before it is written although it stands
left. After the type may follow, in this order:

    +SD -T        areas added to or taken from the usual ones of the type (table 3-3)
    [D V]         just these areas
    *S2  *4       a span of as many elements as S2 says, or of 4; the function gets or gives a list
    *{S2+1}       the same as an expression of operands, flags and, in small letters, of the numbers of their devices
    '             of such a span a Kn string takes the first element only
    ?             it keeps what it holds where the function gives None for it; devices that only the system writes may stand here
    ^             a Kn string only in the full width of the type (K4, K8)
    ~  !          may be indexed, may not be indexed, where that differs from the usual
    =0..7         range of the value: a constant outside is refused, another value is error 64 when it is executed

A word in small letters is no operand. Left of the arrow it is something else that the function is given, right of it
something that the function gives after its values: a flag by its meaning (carry), `state`, which the instruction keeps
from one execution to the next (False at first), `now`, the simulated time in microseconds, `scan`, the number of the scan,
or `claim`, the number under which a command holds something until its flow goes; the name of an operand in small letters (s3) is the number of its
device.
"""

import re
from dataclasses import dataclass

from ..values import BOOL, DINT, INT, TYPES, WORD, DataType

_KN_READ = "KnX KnY KnM KnS KnLM KnSM"
_KN_WRITE = "KnY KnM KnS KnLM"
# Table 3-3, and what the operand tables of chapters 5 and 6 have in common.
READABLE = {
    "BOOL": "X Y M S LM SM C T",
    "INT": f"const {_KN_READ} D SD C T V Z",
    "WORD": f"const {_KN_READ} D SD C T V Z",
    "DINT": f"const {_KN_READ} D SD C V",
    "DWORD": f"const {_KN_READ} D SD C V",
    "REAL": "const D V",
}
WRITABLE = {
    "BOOL": "Y M S LM C T",
    "INT": f"{_KN_WRITE} D C T V Z",
    "WORD": f"{_KN_WRITE} D C T V Z",
    "DINT": f"{_KN_WRITE} D C V",
    "DWORD": f"{_KN_WRITE} D C V",
    "REAL": "D V",
}
# Operands that are more than a value: what the function gets, the type the manual prints, their areas and range.
SPECIAL: dict[str, tuple[DataType, str, tuple[int, int] | None]] = {
    "TIMER": (INT, "T", None),
    "COUNTER": (INT, "C", (0, 199)),
    "DCOUNTER": (DINT, "C", (200, 235)),
    "HCOUNTER": (DINT, "C", (236, 255)),
    "STEP": (BOOL, "S", None),
    "NEST": (INT, "const", (0, 7)),
    "LABEL": (INT, "const", (0, 127)),
    "EVENT": (INT, "const", None),
    "ROUTINE": (WORD, "routine", None),
    "TEXT": (WORD, "text", None),  # characters as they are typed, as many as the span says
    "PULSE": (BOOL, "Y", (0, 1)),
    "POINT": (BOOL, "Y M S", None),
    "PLACE": (WORD, "D V", None),
    "FRAME": (INT, "D V", None),
    "DPLACE": (DINT, "D", None),
    "TABLE": (DINT, "D", None),
    "SAVED": (WORD, "D", (6000, 6999)),
    "BLOCK": (WORD, READABLE["WORD"], None),
}
# Of these, what a command works on for as long as it is driven: it gets the number of a counter, of a pulse output or of the
# first D of a table; of a POINT, PLACE or FRAME the device itself, for what it reads and writes in its own time.
UNITS = frozenset({"HCOUNTER", "PULSE", "POINT", "PLACE", "FRAME", "DPLACE", "TABLE", "SAVED", "BLOCK"})


@dataclass(frozen=True, slots=True)
class OperandSpec:
    """One operand of an instruction: how it is called, its type, where it may lie, whether it is read, written, indexed."""

    name: str
    kind: str  # the word of the signature: INT, TIMER ...
    type: DataType
    areas: frozenset[str]
    read: bool
    written: bool
    indexed: bool
    span: str | int | None = None
    range: tuple[int, int] | None = None
    order: tuple[str, ...] = ()
    whole: bool = False  # a Kn string must have the full width of the type
    first: bool = False  # a Kn string takes the first element of the span only
    maybe: bool = False  # written only where the function gives something

    @property
    def role(self) -> str:
        return "dest" if self.written else "source"

    @property
    def plain(self) -> bool:
        """Whether the function gets or gives its value, and not a unit, a number of a device or a name."""
        return self.kind not in SPECIAL

    def length(self, values: dict[str, int]) -> int | None:
        """How many elements its span has when the other operands have these values; None when that takes more to tell."""
        if self.span is None or isinstance(self.span, int):
            return self.span or 1
        try:
            return eval(self.span.strip("{}"), {"__builtins__": {}, "min": min, "max": max}, values)
        except NameError:
            return None

    @property
    def unit(self) -> bool:
        """Whether a command gets the device, and not what it holds."""
        return self.kind in UNITS


_OPERAND = re.compile(
    r"(?P<out>>)?(?P<name>[A-Z]+[0-9]*):(?P<kind>[A-Z]+)(?P<changes>(?:[+-](?:Kn)?[A-Z]+|[+-]const)*)(?:\[(?P<areas>[A-Za-z ]+)\])?"
    r"(?:\*(?P<span>[A-Z]*[0-9]+|[A-Z]|\{[^}]*\}))?(?P<first>')?(?P<maybe>\?)?(?P<whole>\^)?(?P<mark>[~!])?(?:=(?P<low>-?\d+)\.\.(?P<high>-?\d+))?"
)


def _areas(match: re.Match, written: bool) -> tuple[str, ...]:
    kind = match["kind"]
    if match["areas"]:
        return tuple(match["areas"].split())
    if kind in SPECIAL:
        return tuple(SPECIAL[kind][1].split())
    areas = (WRITABLE if written else READABLE)[kind].split()
    for sign, area in re.findall(r"([+-])((?:Kn)?[A-Z]+|const)", match["changes"]):
        if sign == "+":
            areas.append(area)
        else:
            areas.remove(area)
    return tuple(areas)


def parse_signature(text: str) -> tuple[tuple[OperandSpec, ...], tuple[str, ...], tuple[str, ...]]:
    """The operands in the order in which they are written, the names of all that the function gets, the flags and state that it gives."""
    left, _, right = text.partition("->")
    sides = [(word, False) for word in _words(left)] + [(word, True) for word in _words(right)]
    written_names = {word.partition(":")[0] for word, written in sides if written}
    specs: list[OperandSpec] = []
    taken: list[str] = []
    given: list[str] = []
    for word, written in sides:
        if word.islower():
            (given if written else taken).append(word)
            continue
        if ":" not in word:
            if word not in {spec.name for spec in specs}:
                raise ValueError(f"{text!r}: {word!r} has no type")
            continue
        match = _OPERAND.fullmatch(word)
        if match is None:
            raise ValueError(f"{text!r}: cannot read {word!r}")
        kind, name = match["kind"], match["name"]
        out = written or bool(match["out"]) or name in written_names or kind in ("TIMER", "COUNTER", "DCOUNTER")
        areas = _areas(match, out)
        special = SPECIAL.get(kind)
        value_range = special[2] if special else None
        if match["low"] is not None:
            value_range = (int(match["low"]), int(match["high"]))
        usual = special is None and kind != "BOOL" and areas != ("const",)
        indexed = {"~": True, "!": False, None: usual}[match["mark"]]
        span = match["span"]
        specs.append(
            OperandSpec(
                name,
                kind,
                special[0] if special else TYPES[kind],
                frozenset(areas),
                read=not (written or match["out"]),
                written=out,
                indexed=indexed,
                span=int(span) if span and span.isdigit() else span,
                range=value_range,
                order=areas,
                whole=bool(match["whole"]),
                first=bool(match["first"]),
                maybe=bool(match["maybe"]),
            )
        )
        if specs[-1].read or specs[-1].unit:
            taken.append(name)
    return tuple(specs), tuple(taken), tuple(given)


def _words(text: str) -> list[str]:
    return re.findall(r"(?:\[[^\]]*\]|\{[^}]*\}|[^\s\[{])+", text)
