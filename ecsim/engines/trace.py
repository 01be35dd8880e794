"""What the stepping engine saw in one scan."""

from dataclasses import dataclass, field


@dataclass(slots=True)
class Write:
    """One change of a device: by the instruction at `position`, `device` in canonical text."""

    position: int
    device: str
    old: int
    new: int


@dataclass(slots=True)
class Trace:
    """One scan: by position of an instruction the flow after it and a contact's own state, None where it was not executed.

    `order` has each execution in turn, of loops and interrupt programs too: position, flow after it, how many writes there were then.
    `locals` has of each unit that ended what its own areas held then, of its last call: unit -> area -> values.
    """

    flow: list[bool | None]
    closed: list[bool | None]
    writes: list[Write] = field(default_factory=list)
    order: list[tuple[int, bool, int]] = field(default_factory=list)
    locals: dict[str, dict[str, list]] = field(default_factory=dict)

    @classmethod
    def blank(cls, length: int) -> "Trace":
        return cls([None] * length, [None] * length)
