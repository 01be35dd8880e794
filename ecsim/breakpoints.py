"""Breakpoints of a session: conditions at which a run stops."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from .conditions import condition
from .errors import EcsimError
from .plc import Plc


class Breakpoint:
    """A condition that stops the run when it becomes true: a step ("S21"), or what `conditions` can read ("D0 > 100 and X1")."""

    def __init__(self, plc: Plc, text: str, enabled: bool = True):
        self.text, self.enabled = text, bool(enabled)
        self.hits = 0  # how often it has stopped a run
        self.problem = ""  # why it cannot be met with the program that is loaded now
        self._test: Callable[[], bool] = condition(plc, text)
        self.was = self._test()

    def follow(self, plc: Plc) -> None:
        """Another program may call devices by other names."""
        try:
            self._test, self.problem = condition(plc, self.text), ""
        except EcsimError as error:
            self._test, self.problem = bool, str(error)

    def rises(self) -> bool:
        """Whether it has become true since the last look."""
        now, was = self._test(), self.was
        self.was = now
        return now and not was

    def look(self) -> None:
        """Take note of how things stand; what is true already does not stop a run."""
        self.was = self._test()

    def __repr__(self) -> str:
        return f"<Breakpoint {self.text!r}{'' if self.enabled else ', off'}, {self.hits} hits>"


class Breakpoints:
    """The breakpoints of one session, in the order in which they were set; each is found by its text."""

    def __init__(self, plc: Plc, changed: Callable[[], None] = lambda: None):
        self._plc, self._changed = plc, changed
        self._all: dict[str, Breakpoint] = {}
        self.armed: tuple[Breakpoint, ...] = ()  # those that each scan has to ask

    def add(self, text: str, enabled: bool = True) -> Breakpoint:
        """Set a breakpoint; one that is there already is given back as it is. Raises EcsimError for what is no condition."""
        text = " ".join(str(text).split())
        if text not in self._all:
            self._all[text] = Breakpoint(self._plc, text, enabled)
            self._arm()
        return self._all[text]

    def remove(self, text: str) -> None:
        """Take a breakpoint away; raises EcsimError for one that there is not."""
        self[text]
        del self._all[text]
        self._arm()

    def enable(self, text: str, on: bool = True) -> None:
        """Switch a breakpoint on or off; it keeps its place and its count. Raises EcsimError for one that there is not."""
        each = self[text]
        each.enabled = bool(on)
        each.look()
        self._arm()

    def clear(self) -> None:
        """Take all away."""
        self._all.clear()
        self._arm()

    def follow(self) -> None:
        """Read all conditions again for the program that is loaded now."""
        for each in self:
            each.follow(self._plc)
        self._arm()

    def look(self) -> None:
        """Take note of how things stand, after a jump in time."""
        for each in self.armed:
            each.look()

    def _arm(self) -> None:
        self.armed = tuple(each for each in self if each.enabled and not each.problem)
        self._changed()

    def __getitem__(self, text: str) -> Breakpoint:
        if text not in self._all:
            raise EcsimError(f"there is no breakpoint {text!r}; there are {', '.join(self._all) or 'none'}")
        return self._all[text]

    def __contains__(self, text: object) -> bool:
        return text in self._all

    def __iter__(self) -> Iterator[Breakpoint]:
        return iter(tuple(self._all.values()))

    def __len__(self) -> int:
        return len(self._all)

    def __repr__(self) -> str:
        return f"<Breakpoints {', '.join(self._all) or 'none'}>"
