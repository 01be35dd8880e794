"""Inputs: terminals, the input filter and the input image (2.1.2, 2.2.1, 3.1.3)."""

from collections.abc import Callable

from ..memory import Memory


class Inputs:
    """The X terminals. A terminal is what the wiring holds; the image X takes it over at the input refresh, after the filter."""

    def __init__(self, memory: Memory, filter_ms: float, on_edge: Callable[[int, bool], None]):
        self.memory, self.on_edge = memory, on_edge
        self.terminals = [False] * memory.model.areas["X"].count
        self.filtered = memory.model.filter_inputs
        self.filter_us = round(filter_ms * 1000)
        self.waiting: dict[int, tuple[int, int]] = {}  # number -> (level, time from which it counts)
        self.changed = True

    def set(self, number: int, level: int, now: int) -> None:
        """Put a level on a terminal; it stays until it is set again."""
        level = bool(level)
        if self.terminals[number] is level:
            return
        self.terminals[number] = level
        self.changed = True
        self.on_edge(number, level)
        if number < self.filtered and self.filter_us:
            self.waiting[number] = (level, now + self.filter_us)

    def refresh(self, now: int) -> None:
        """Take the terminals over into the input image."""
        if not self.changed:
            return
        image = self.memory.lists["X"]
        if not self.waiting:
            image[:] = self.terminals
            self.changed = False
            return
        for number, level in enumerate(self.terminals):
            if number not in self.waiting:
                image[number] = level
        for number, (level, due) in list(self.waiting.items()):
            if now >= due:
                image[number] = level
                del self.waiting[number]

    def snapshot(self) -> tuple:
        return list(self.terminals), dict(self.waiting)

    def restore(self, snapshot: tuple) -> None:
        self.terminals[:] = snapshot[0]
        self.waiting = dict(snapshot[1])
        self.changed = True
