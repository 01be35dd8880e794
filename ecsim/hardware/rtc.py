"""The real-time clock (6.9, SD100 to SD106). It counts simulated time from a fixed date, so that every run is the same."""

from datetime import date, datetime, timedelta

from ..errors import CLOCK, EcsimError, Fault
from ..memory import Memory
from .unit import Unit

START = datetime(2000, 1, 1)  # a clock that was never set: Saturday, 1 January 2000, 0:00:00
YEARS = range(2000, 2100)
CENTURY = (date(2100, 1, 1) - START.date()).days  # after 2099 the clock goes on with 2000
SECOND_US = 1_000_000
DAY = 24 * 60 * 60
NEVER = 1 << 62


class RealTimeClock(Unit):
    """Date, time and weekday. It runs in STOP and without power too; TWR and the programming tool set it."""

    def __init__(self, memory: Memory, awake: list[Unit]):
        super().__init__(awake)
        self.memory = memory
        self.first = memory.model.registers.get("clock")
        self.since = 0  # the simulated moment at which `seconds` was right
        self.seconds = 0  # since START, at that moment
        self.shift = START.isoweekday() % 7  # the weekday on a day 0; weekdays need not fit the date that was set
        self.due = 0 if self.first is not None else NEVER

    def read(self, now: int) -> list[int]:
        """Year, month, day, hour, minute, second, weekday (0 is Sunday)."""
        days, second = divmod(self.seconds + (now - self.since) // SECOND_US, DAY)
        day = START.date() + timedelta(days % CENTURY)
        return [day.year, day.month, day.day, second // 3600, second // 60 % 60, second % 60, (days + self.shift) % 7]

    def write(self, year: int, month: int, day: int, hour: int, minute: int, second: int, weekday: int, now: int) -> None:
        """Set the clock; what is no date, time or weekday is error 76 and leaves it."""
        try:
            moment = datetime(year, month, day, hour, minute, second)
        except ValueError:
            raise Fault(CLOCK) from None
        if year not in YEARS or not 0 <= weekday <= 6:
            raise Fault(CLOCK)
        self._set(moment, weekday, now)

    def _set(self, moment: datetime, weekday: int, now: int) -> None:
        self.seconds = (moment - START) // timedelta(seconds=1)
        self.since = now - moment.microsecond
        self.shift = weekday - self.seconds // DAY
        self.refresh(now)

    def moment(self, now: int) -> datetime:
        """Date and time as Python has them, with the fraction of the second."""
        return datetime(*self.read(now)[:6], (now - self.since) % SECOND_US)

    def put(self, moment: datetime, now: int) -> None:
        """Set the clock, as the programming tool does; raises EcsimError for what it cannot show."""
        if not isinstance(moment, datetime) or moment.tzinfo is not None:
            raise EcsimError(f"the clock takes a datetime without time zone, not {moment!r}; write datetime(2024, 5, 14, 10, 20, 30)")
        if moment.year not in YEARS:
            raise EcsimError(f"the clock goes from {YEARS.start} to {YEARS.stop - 1}, {moment.year} is outside")
        self._set(moment, moment.isoweekday() % 7, now)

    def lose(self, now: int) -> None:
        """The clock had no supply: it begins anew."""
        self._set(START, START.isoweekday() % 7, now)

    def refresh(self, now: int) -> None:
        """Show date and time in the clock's registers; `due` is when they change next."""
        if self.first is not None:
            model, values = self.memory.model, self.read(now)
            self.memory.lists[model.special_words][self.first : self.first + 7] = [values[part] for part in model.clock_order]
            self.due = now + SECOND_US - (now - self.since) % SECOND_US

    def restart(self, now: int) -> None:
        self.refresh(now)

    def snapshot(self) -> tuple[int, ...]:
        return self.since, self.seconds, self.shift, self.due

    def restore(self, snapshot: tuple[int, ...]) -> None:
        self.since, self.seconds, self.shift, self.due = snapshot
