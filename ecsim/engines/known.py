"""What generated statements know already: pairs of registers whose value the statements before them have in hand."""

from ..devices import Device, Operand
from ..values import REAL, DataType


class Known:
    """Names that hold the values of register pairs, and the pair that the scratch memory of REAL holds, in statements that follow one another.

    Switched off it knows nothing: where registers are forced a value that was written need not be the one to be read.
    """

    def __init__(self, on: bool):
        self.on = on
        self.names: dict[tuple[DataType, str, int], str] = {}
        self.scratch: tuple[str, int] | None = None
        self.settled = False  # no execution error is left to be cleared
        self.made = 0

    @staticmethod
    def pair(kind: DataType, operand: Operand) -> bool:
        """Whether an operand is a plain pair of registers, the kind of thing that is known here."""
        return kind.words == 2 and isinstance(operand, Device) and operand.index is None and operand.area not in ("T", "C", "Z")

    def forget(self) -> None:
        """The statements that follow may be executed without those before."""
        self.names.clear()
        self.scratch = None
        self.settled = False

    def begin(self) -> None:
        """Other statements follow than those before: nothing is known, and the names are free again."""
        self.forget()
        self.made = 0

    def new(self) -> str:
        """A name that nothing else has in these statements."""
        self.made += 1
        return f"w{self.made}"

    def find(self, kind: DataType, device: Device) -> str | None:
        """The name of a pair's value."""
        return self.names.get((kind, device.area, device.number))

    def keep(self, kind: DataType, device: Device, name: str) -> None:
        """A name holds a pair's value."""
        if self.on:
            self.names[kind, device.area, device.number] = name

    def in_scratch(self, device: Device) -> bool:
        """Whether the scratch memory holds a pair."""
        return self.scratch == (device.area, device.number)

    def read(self, kind: DataType, device: Device) -> None:
        """A pair has gone through the scratch memory."""
        if kind is REAL:
            self.scratch = (device.area, device.number) if self.on else None

    def spoil(self, operand: Operand, length: int | None) -> None:
        """`length` registers from an operand on are written; an unknown number of them may be any."""
        if not isinstance(operand, Device) or operand.area in ("T", "C", "Z"):
            return
        if operand.index is not None or length is None:
            self.forget()
            return
        reach = range(operand.number - 1, operand.number + length)
        for key in [key for key in self.names if key[1] == operand.area and key[2] in reach]:
            del self.names[key]
        if self.scratch is not None and self.scratch[0] == operand.area and self.scratch[1] in reach:
            self.scratch = None
