"""The device table: chosen devices in any format, written and forced in place. Only the rows that a page sees are sent to it."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from ecsim.errors import EcsimError

from .plate import Plated
from .rig import Rig
from .table import menus

VIEWS = 4  # pages that may look at a time; one that went away leaves its window behind
WINDOW = 200  # rows that a page may ask for
AGAIN_S = 0.5  # how often the whole table is looked through for what has changed


class Looker:
    """One page's view of the table: its window, what it may add, and what became of its last request."""

    def __init__(self) -> None:
        self.first, self.count = 0, 40
        self.offers: list[list[str]] = []
        self.said: list[Any] = [0, "", 0]  # number of the request, why it was refused, the row to look at


class Devices(Plated):
    """The table of the rig, as windows on its rows.

    Entries: "shown.<view>" is [first row, numbers of the rows, rows in all], "row.<number>" [text, bits, forced] and "row.<number>.of" what
    the row is; "offers.<view>" and "said.<view>" answer what was typed.
    """

    key = "devices"

    def __init__(self, rig: Rig, clock: Callable[[], float] = time.monotonic):
        super().__init__(rig)
        self.table = rig.table
        self._clock, self._looked_s = clock, 0.0
        self._views: dict[str, Looker] = {}

    def layout(self):
        return {"menus": menus(self.rig.plc)}

    def frame(self):
        table = self.table
        if table.only and self._clock() - self._looked_s >= AGAIN_S:
            self._looked_s = self._clock()
            table.look_again()
        order, forces = table.order(), self.rig.plc.memory.forces()
        entries: dict[str, Any] = {
            "count": len(table.rows),
            "forced": sum(map(len, forces.values())),
            "back": table.can_put_back,
            "as": [table.find, table.sort, table.down, table.only],
            **self.plates(),
        }
        seen: set[int] = set()
        for key, view in self._views.items():
            view.first = max(0, min(view.first, len(order) - view.count))
            numbers = order[view.first : view.first + view.count]
            seen.update(numbers)
            entries[f"shown.{key}"] = [view.first, numbers, len(order)]
            entries[f"offers.{key}"] = view.offers
            entries[f"said.{key}"] = view.said
        for number in seen:
            row = table.rows[number]
            device = str(row.device)
            entries[f"row.{number}"] = [row.text(), row.bits(), row.forced(forces)]
            entries[f"row.{number}.of"] = [device, *self.rig.point(device), row.look, row.menu, row.width, row.name]
        return entries

    def _view(self, key: str) -> Looker:
        if key not in self._views:
            while len(self._views) >= VIEWS:
                del self._views[next(iter(self._views))]
            self._views[key] = Looker()
        return self._views[key]

    def _say(self, key: str, n: int, action: Callable[[], int | None]) -> None:
        """Do what request `n` of a view asks for; what refuses it is told there."""
        view = self._view(key)
        try:
            view.said = [n, "", action() or 0]
        except EcsimError as error:
            view.said = [n, str(error), 0]

    # -- what the page may do -----------------------------------------------------------------------------------

    def on_window(self, view, first, count):
        """A page sees `count` rows from `first` on."""
        looker = self._view(view)
        looker.first, looker.count = max(0, int(first)), min(max(1, int(count)), WINDOW)

    def on_offer(self, view, text):
        """What may be meant by what has been typed."""
        self._view(view).offers = [list(offer) for offer in self.table.offers(text)]

    def on_add(self, view, n, text):
        """Add devices, names and ranges to the table; the answer tells where the first of them stands."""
        self._say(view, n, lambda: self._place(self.table.add(text)[0]))

    def _place(self, number: int) -> int:
        """The row, counted from 1, where a device stands; what was sought or chosen gives way to it."""
        if number not in self.table.order():
            self.table.arrange()
        return self.table.order().index(number) + 1

    def on_show(self, view, n, number, look):
        """Show a row in another format."""
        self._say(view, n, lambda: self.table.look_as(number, look))

    def on_arrange(self, find="", sort="", down=False, only=""):
        """Find, sort and choose rows."""
        self.table.arrange(str(find), str(sort), bool(down), str(only))

    def on_drop(self, number):
        """Take a row out."""
        self.table.remove([number])

    def on_release_row(self, number):
        """End forcing the device of a row."""
        row = self.table.rows.get(number)
        if row is not None:
            self.rig.post(lambda plc: plc.unforce(row.name))

    def on_release_all(self):
        """End all forcing, also of devices that are not in the table."""
        self.rig.post(lambda plc: plc.unforce())

    def on_clear(self):
        """Take all rows out."""
        self.table.clear()

    def on_put_back(self):
        """Bring back what was cleared away."""
        self.table.put_back()
