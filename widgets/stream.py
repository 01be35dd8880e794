"""When a frame goes out: at most 40 a second (a running session offers 30), one a second while the page is silent, everything to a page that has just come."""

from __future__ import annotations

import time
from collections.abc import Callable

PERIOD_S = 0.025
SILENCE_S = 2.0  # a page that has not acknowledged for so long is closed or behind
SILENT_PERIOD_S = 1.0
ACK_EVERY = 10


class Stream:
    """The flow of frames to the pages that show a widget. Nothing is sent before the first page has asked."""

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock = clock
        self.number = 0
        self.open = False
        self._last_s = float("-inf")
        self._asked: int | None = None  # the oldest frame that awaits its acknowledgement
        self._asked_s = 0.0

    def heard(self, number: int | None = None) -> None:
        """A page is there: it said hello, or acknowledged the frame `number`."""
        self.open = True
        if number is None or (self._asked is not None and number >= self._asked):
            self._asked = None

    @property
    def silent(self) -> bool:
        """A frame was to be acknowledged and was not."""
        return self._asked is not None and self._clock() - self._asked_s > SILENCE_S

    @property
    def wait_s(self) -> float:
        """How long until the next frame may go out."""
        period_s = SILENT_PERIOD_S if self.silent else PERIOD_S
        return max(0.0, self._last_s + period_s - self._clock())

    @property
    def due(self) -> bool:
        """Whether a frame may go out now."""
        return self.open and self.wait_s == 0

    def count(self) -> dict[str, object]:
        """Number the frame that goes out now; says whether the page is to acknowledge it."""
        self.number += 1
        self._last_s = self._clock()
        ask = (self._asked is not None and self.silent) or self.number % ACK_EVERY == 0
        if ask and self._asked is None:
            self._asked, self._asked_s = self.number, self._last_s
        return {"n": self.number, "ack": True} if ask else {"n": self.number}
