"""A sheet of character cells: lines that join by themselves where they meet, and letters over them."""

from .lettering import columns

LEFT, RIGHT, UP, DOWN = 1, 2, 4, 8
_LIGHT = " ╴╶─╵┘└┴╷┐┌┬│┤├┼"


class Canvas:
    """Cells by row and column, as wide and high as what is drawn."""

    def __init__(self) -> None:
        self.lines: dict[tuple[int, int], int] = {}
        self.letters: dict[tuple[int, int], str] = {}

    def horizontal(self, row: int, start: int, end: int) -> None:
        """A line between the middles of two cells of a row."""
        start, end = sorted((start, end))
        for column in range(start, end):
            self._join(row, column, RIGHT)
            self._join(row, column + 1, LEFT)

    def vertical(self, column: int, start: int, end: int) -> None:
        """A line between the middles of two cells of a column."""
        start, end = sorted((start, end))
        for row in range(start, end):
            self._join(row, column, DOWN)
            self._join(row + 1, column, UP)

    def through(self, column: int, start: int, end: int) -> None:
        """A line over whole cells of a column, from the upper edge of the first to the lower edge of the last."""
        self.vertical(column, start, end)
        self._join(start, column, UP)
        self._join(end, column, DOWN)

    def write(self, row: int, column: int, words: str) -> None:
        """Letters from a cell on; blanks cover what is below them."""
        for sign in words:
            size = columns(sign)
            if size == 0:
                self.letters[row, column - 1] = self.letters.get((row, column - 1), "") + sign
                continue
            self.letters[row, column] = sign
            if size == 2:
                self.letters[row, column + 1] = ""
            column += size

    def middle(self, row: int, column: int, words: str) -> None:
        """Letters with their middle over a cell."""
        self.write(row, column - (columns(words) - 1) // 2, words)

    def text(self) -> str:
        """The sheet as lines without blanks at their ends."""
        cells = self.lines.keys() | self.letters.keys()
        if not cells:
            return ""
        rows: dict[int, list[int]] = {}
        for row, column in cells:
            rows.setdefault(row, []).append(column)
        lines = []
        for row in range(max(rows) + 1):
            last = max(rows.get(row, [-1]))
            lines.append("".join(self._cell(row, column) for column in range(last + 1)).rstrip())
        return "\n".join(lines)

    def _cell(self, row: int, column: int) -> str:
        sign = self.letters.get((row, column))
        return _LIGHT[self.lines.get((row, column), 0)] if sign is None else sign

    def _join(self, row: int, column: int, side: int) -> None:
        self.lines[row, column] = self.lines.get((row, column), 0) | side
