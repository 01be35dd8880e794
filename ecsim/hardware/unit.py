"""What works between two scans: the protocol of the units that time asks for their events."""

from typing import Any


class Unit:
    """One part of the hardware with a time of its own. It stands in `awake` while it has something to do, and costs nothing else.

    Time goes by in steps: `next` tells of the unit's first event, `advance` takes all units to that moment, `act` does what
    the event asks for. Units of lower rank act first when events fall on the same microsecond.
    """

    rank = 0
    in_stop = False  # whether its events come in STOP too

    def __init__(self, awake: "list[Unit]"):
        self.awake = awake

    def wake(self, on: bool = True) -> None:
        """Enter or leave the list of those that are asked."""
        if on and self not in self.awake:
            self.awake.append(self)
            self.awake.sort(key=lambda unit: unit.rank)
        elif not on and self in self.awake:
            self.awake.remove(self)

    def look(self, now: int) -> None:
        """A program has run: see what it changed in the devices that control the unit."""

    def serve(self, now: int) -> None:
        """The communication phase of a scan, in RUN and in STOP."""

    def next(self, until: int) -> int | None:
        """The moment of the unit's first event up to `until`, None without one."""
        return None

    def advance(self, now: int) -> None:
        """Time has come to `now`: bring the devices that show it up to date."""

    def act(self, now: int) -> None:
        """The event that `next` told of has come; `advance` went before."""

    def edge(self, number: int, level: bool, now: int) -> None:
        """An input terminal was switched from outside."""

    def release(self, claim: int, now: int) -> None:
        """The command with this number has lost its flow."""

    def restart(self, now: int) -> None:
        """STOP, RUN or a download: nothing is held any longer."""

    def snapshot(self) -> Any:
        """What changes while the unit works."""

    def restore(self, snapshot: Any) -> None:
        """Go back to a snapshot."""
