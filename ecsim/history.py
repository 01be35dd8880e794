"""The way back: keyframes and the actions between them. The same actions at the same scans give the same run."""

from collections.abc import Callable, Hashable
from typing import Any

EVERY = 200  # scans between two keyframes
KEEP = 30  # keyframes kept: a minute at 10 ms a scan


class Overwrites(dict):
    """Writes from outside before one scan, by what they overwrite: only the last of each counts. Called, it repeats them in order."""

    def __call__(self) -> None:
        for write in self.values():
            write()


class History:
    """Keyframes of a simulation, and what was done to it from outside, by scan."""

    def __init__(self, take: Callable[[], Any], put: Callable[[Any], None]):
        self.take, self.put = take, put
        self.frames: list[tuple[int, int, Any]] = []  # scan, how many actions it contains, what was taken
        self.actions: list[tuple[int, int, Callable[[], None]]] = []  # scan, number, action
        self.noted = 0

    def clear(self) -> None:
        """Forget everything: the program or the plant is another one."""
        self.frames.clear()
        self.actions.clear()

    def note(self, scan: int, action: Callable[[], None]) -> None:
        """An action from outside, done before scan number `scan`."""
        self.actions.append((scan, self.noted, action))
        self.noted += 1

    def overwrite(self, scan: int, key: Hashable, write: Callable[[], None]) -> None:
        """A write before scan number `scan` that leaves nothing of an earlier one with the same key; however many come, one is remembered."""
        if not self.actions or self.actions[-1][0] != scan or not isinstance(self.actions[-1][2], Overwrites):
            self.note(scan, Overwrites())
        writes = self.actions[-1][2]
        writes.pop(key, None)
        writes[key] = write

    def tick(self, scan: int) -> None:
        """Called before each scan: takes a keyframe when one is due."""
        if scan % EVERY == 0 or not self.frames:
            self.frames.append((scan, self.noted, self.take()))
            if len(self.frames) > KEEP:
                del self.frames[0]
                first = self.frames[0][1]
                self.actions = [entry for entry in self.actions if entry[1] >= first]

    @property
    def first(self) -> int | None:
        """The earliest scan that can be gone back to."""
        return self.frames[0][0] if self.frames else None

    def go(self, scan: int, step: Callable[[], None]) -> bool:
        """Go to just before scan number `scan`, running forward from an earlier keyframe with `step`; what is known of later scans stays."""
        if self.first is None or scan < self.first:
            return False
        # one before the scan if there is any: the scan that leads there is done again, for those who look on
        place = max((place for place, frame in enumerate(self.frames) if frame[0] < scan), default=0)
        at, contained, frame = self.frames[place]
        self.put(frame)
        journal = [entry for entry in self.actions if entry[1] >= contained and entry[0] <= scan]
        place = 0
        for number in range(at, scan + 1):
            while place < len(journal) and journal[place][0] == number:
                journal[place][2]()
                place += 1
            if number < scan:
                step()
        return True

    def fork(self, scan: int) -> None:
        """From before scan number `scan` on everything happens anew: what came later is forgotten."""
        self.frames = [frame for frame in self.frames if frame[0] < scan]
        self.actions = [entry for entry in self.actions if entry[0] <= scan]
