"""What a serial line does to characters: how long they take, how they arrive, what happens when two talk at once.

A wire joins ends: ports of PLCs and stations, which stand for everything else. A character is heard by all other ends in
the moment in which its last stop bit has gone by. Each end reads the bits at its own baud rate and with its own parity, so
that wrong settings do here what they do on a real line.
"""

import copy
from collections import deque
from dataclasses import dataclass
from functools import lru_cache
from itertools import count
from typing import Any

from ..errors import EcsimError

TICK_US = 10_000  # so often an instrument that moves is moved
LOGGED = 10_000  # messages


@dataclass(frozen=True, slots=True)
class Framing:
    """How one character stands on the line."""

    baud: int
    data_bits: int
    parity: str
    stop_bits: int

    @property
    def bits(self) -> int:
        """The bits of a character, its start bit too."""
        return 1 + self.data_bits + (self.parity != "none") + self.stop_bits

    def after(self, characters: float) -> int:
        """How long so many characters take, halves too, in whole microseconds."""
        return round(2 * characters) * self.bits * 500_000 // self.baud


def _parity_bit(byte: int, parity: str) -> int:
    return (byte.bit_count() + (parity == "odd")) & 1


@lru_cache(maxsize=4096)
def arrived(byte: int, sent: Framing, own: Framing) -> tuple[int, bool]:
    """What an end with its `own` framing reads of a byte, and whether parity or stop bit were wrong."""
    byte &= (1 << sent.data_bits) - 1
    if sent == own:
        return byte, False
    levels = [0, *(byte >> place & 1 for place in range(sent.data_bits))]
    if sent.parity != "none":
        levels.append(_parity_bit(byte, sent.parity))

    def level(place: int) -> int:
        """The line in the middle of bit `place` of the receiver; behind the character it rests at 1."""
        at = (2 * place + 1) * sent.baud // (2 * own.baud)
        return levels[at] if at < len(levels) else 1

    read = sum(level(1 + place) << place for place in range(own.data_bits))
    place = 1 + own.data_bits
    wrong = False
    if own.parity != "none":
        wrong = level(place) != _parity_bit(read, own.parity)
        place += 1
    return read, wrong or not level(place)


class End:
    """One end of a wire: what it sends goes out character by character. Times are those of its own clock."""

    name = "end"
    shift = 0  # the wire's time is that of the end and so much more
    wire: "Wire | None" = None

    def __init__(self, framing: Framing):
        self.framing = framing
        self._rest()

    def _rest(self) -> None:
        self.text, self.began, self.done, self.clash = b"", 0, 0, False

    @property
    def sending(self) -> bool:
        """Whether a character is on its way."""
        return self.done < len(self.text)

    @property
    def character_due(self) -> int | None:
        """When the character that is on its way will have gone out."""
        return self.began + self.framing.after(self.done + 1) if self.sending else None

    @property
    def last_due(self) -> int:
        """When all that was sent will have gone out."""
        return self.began + self.framing.after(len(self.text))

    def deaf(self, now: int) -> bool:
        """Whether the character that ends now began while this end was sending: on two wires nobody hears it then."""
        return now - self.framing.after(1) < self.last_due

    def send(self, text: bytes, now: int) -> None:
        """Begin to send; what was being sent before is broken off."""
        self.text, self.began, self.done, self.clash = bytes(text), now, 0, False
        if self.wire is not None and text:
            self.wire.watch(self, now + self.shift)

    def character_out(self, now: int) -> int:
        """The character on its way has gone out: the others hear it."""
        byte = self.text[self.done] & (1 << self.framing.data_bits) - 1
        self.done += 1
        if self.wire is not None:
            self.wire.carry(self, byte, now + self.shift)
        return byte

    def take(self, byte: int, wrong: bool, at: int) -> None:
        """A character of another end was there; `wrong` when parity or stop bit were."""

    def sent_so_far(self) -> tuple:
        """What `send_on` takes to come back to this moment."""
        return self.text.hex(), self.began, self.done, self.clash

    def send_on(self, state: tuple) -> None:
        """Come back to a moment."""
        text, self.began, self.done, self.clash = state
        self.text = bytes.fromhex(text)


class Station(End):
    """An instrument on a wire: a Python object with `hear(message: bytes) -> bytes | None`.

    It is given each message without faults, as soon as the line has been silent for three and a half characters, and what it
    gives back is sent `delay_us` later. One that has `step(seconds)` is moved on every 10 ms; one with `state()` and
    `restore(state)` goes back in time by these, another by a copy of its attributes.
    """

    def __init__(self, instrument: Any, framing: Framing, delay_us: int = 0, name: str = ""):
        if not callable(getattr(instrument, "hear", None)):
            raise EcsimError(f"{instrument!r} cannot be connected: it has no method hear(message), which gives the answer or None")
        super().__init__(framing)
        self.instrument, self.delay_us = instrument, delay_us
        self.name = name or type(instrument).__name__
        self.heard, self.spoilt = bytearray(), False
        self.message_due: int | None = None
        self.answer, self.answer_due = b"", 0
        self.moves = callable(getattr(instrument, "step", None))
        self.moved = 0

    def take(self, byte: int, wrong: bool, at: int) -> None:
        self.heard.append(byte)
        self.spoilt = self.spoilt or wrong
        self.message_due = at + self.framing.after(3.5)

    def next(self) -> int | None:
        """The station's next moment."""
        moments = (
            self.character_due,
            self.message_due,
            self.answer_due if self.answer else None,
            self.moved + TICK_US if self.moves else None,
        )
        return min((moment for moment in moments if moment is not None), default=None)

    def act(self, now: int) -> None:
        """Do what is due."""
        if self.moves:
            self._move(now)
        if self.character_due == now:
            self.character_out(now)
        if self.message_due is not None and self.message_due <= now:
            message, spoilt = bytes(self.heard), self.spoilt
            self._forget()
            answer = None if spoilt else self.instrument.hear(message)
            if answer:
                self.answer, self.answer_due = bytes(answer), now + self.delay_us
        if self.answer and self.answer_due <= now:
            answer, self.answer = self.answer, b""
            self.send(answer, now)

    def _forget(self) -> None:
        self.heard.clear()
        self.spoilt, self.message_due = False, None

    def _move(self, now: int) -> None:
        while self.moved + TICK_US <= now:
            self.moved += TICK_US
            self.instrument.step(TICK_US / 1e6)

    def snapshot(self) -> tuple:
        """What `restore` takes to come back to this moment."""
        own = self.instrument.state() if callable(getattr(self.instrument, "state", None)) else copy.deepcopy(vars(self.instrument))
        return (
            self.sent_so_far(), self.heard.hex(), self.spoilt, self.message_due, self.answer.hex(), self.answer_due, self.moved, own,
        )  # fmt: skip

    def restore(self, state: tuple) -> None:
        """Come back to a moment."""
        sent, heard, self.spoilt, self.message_due, answer, self.answer_due, self.moved, own = state
        self.send_on(sent)
        self.heard[:], self.answer = bytes.fromhex(heard), bytes.fromhex(answer)
        if callable(getattr(self.instrument, "restore", None)):
            self.instrument.restore(own)
        else:
            vars(self.instrument).clear()
            vars(self.instrument).update(copy.deepcopy(own))

    def __repr__(self) -> str:
        return f"<Station {self.name} {self.instrument!r}>"


class Wire:
    """A line that any number of ends share. When two send at once, the characters of both arrive spoilt."""

    def __init__(self, name: str = "wire"):
        self.name = name
        self.ends: list[End] = []
        self.driver: Any = None  # the port, or the network, whose clock moves the stations
        self._log: deque[tuple[int, str, str, int]] = deque(maxlen=LOGGED)

    def join(self, end: Any, framing: Framing | None = None, delay_ms: float = 0, name: str = "") -> End:
        """Connect a port, or an instrument as a station with a framing of its own; gives the end.

        Without a framing a station takes that of the first port on the wire. Raises EcsimError for a port that is connected already.
        """
        if not isinstance(end, End):
            framing = framing or next((other.framing for other in self.ends if not isinstance(other, Station)), None)
            if framing is None:
                raise EcsimError(f"{end!r} needs a framing: join a port first, or give Framing(baud, data_bits, parity, stop_bits)")
            end = Station(end, framing, round(delay_ms * 1000), name)
        if end.wire is not None:
            raise EcsimError(f"{end!r} is connected to {end.wire!r} already; leave that first")
        if any(other.name == end.name for other in self.ends):
            if not isinstance(end, Station):
                raise EcsimError(f"{self!r} has an end of the name {end.name!r} already; put the PLCs into a Network, which names them")
            end.name = next(name for number in count(2) if (name := f"{end.name} {number}") not in {other.name for other in self.ends})
        end.wire = self
        self.ends.append(end)
        if self.driver is None and not isinstance(end, Station):
            self.driver = end.network or end
        if self.driver is not None:
            for station in self.stations:
                station.moved = max(station.moved, self.driver.wire_time())
            self.driver.stirred()
        return end

    def leave(self, end: Any) -> None:
        """Take an end, or the station of an instrument, off the wire; what it was sending ends there."""
        found = next((other for other in self.ends if other is end or getattr(other, "instrument", None) is end), None)
        if found is None:
            raise EcsimError(f"{end!r} is not on {self!r}; on it are {', '.join(other.name for other in self.ends) or 'none'}")
        self.ends.remove(found)
        found.wire = None
        if self.driver is found:
            self.driver = next((other for other in self.ends if not isinstance(other, Station)), None)

    @property
    def stations(self) -> list[Station]:
        """The ends that are no ports."""
        return [end for end in self.ends if isinstance(end, Station)]

    # -- characters ---------------------------------------------------------------------------------------------

    def watch(self, sender: End, now: int) -> None:
        """A character of an end begins: those of two at once are spoilt, both of them."""
        for other in self.ends:
            if other is not sender and other.sending and other.last_due + other.shift > now:
                other.clash = sender.clash = True

    def carry(self, sender: End, byte: int, now: int) -> None:
        """A character has gone out: the others hear it."""
        clash, sender.clash = sender.clash, False
        for end in self.ends:
            if end is not sender:
                read, wrong = arrived(byte, sender.framing, end.framing)
                end.take(read ^ 0x55 if clash else read, wrong or clash, now - end.shift)
        if sender.sending:
            self.watch(sender, now)
        else:
            self._log.append((sender.began + sender.shift, sender.name, sender.text.hex(), now))

    @property
    def log(self) -> list[tuple[int, str, str]]:
        """The last 10,000 messages as (begin in us, name of the sender, bytes in hex), in order of time."""
        return sorted(entry[:3] for entry in self._log)

    @property
    def spans(self) -> list[tuple[int, int, str, str]]:
        """The same messages with their ends, as (begin, end, name of the sender, bytes in hex)."""
        return sorted((begin, end, name, text) for begin, name, text, end in self._log)

    # -- time of the stations -----------------------------------------------------------------------------------

    def next(self) -> int | None:
        """The first moment of a station."""
        return min((moment for end in self.ends if isinstance(end, Station) and (moment := end.next()) is not None), default=None)

    def act(self, now: int) -> None:
        """Let the stations do what is due."""
        for end in self.ends:
            if isinstance(end, Station):
                due = end.next()
                if due is not None and due <= now:
                    end.act(now)

    def snapshot(self) -> dict[str, tuple]:
        """What `restore` takes to come back to this moment."""
        return {station.name: station.snapshot() for station in self.stations}

    def restore(self, state: dict[str, tuple], now: int) -> None:
        """Come back to a moment; what was said later is forgotten, and stations that joined later stay as they are."""
        for station in self.stations:
            if station.name in state:
                station.restore(state[station.name])
        self._log = deque((entry for entry in self._log if entry[3] <= now), maxlen=LOGGED)

    def __repr__(self) -> str:
        return f"<Wire {self.name!r}: {', '.join(end.name for end in self.ends) or 'nothing'}>"


class Outlet(Station):
    """The end behind which real time begins: what it hears stands in `outbox` for who takes it out, what comes from there `enter`s."""

    def __init__(self, framing: Framing, name: str = "outside"):
        super().__init__(self, framing, name=name)
        self.outbox = bytearray()

    def hear(self, message: bytes) -> None:
        """A message is over; its characters have been passed on."""

    def take(self, byte: int, wrong: bool, at: int) -> None:
        self.outbox.append(byte)

    def enter(self, octets: bytes, now: int) -> None:
        """Send what has come from outside, behind what is being sent."""
        if self.sending:
            self.text += octets
        else:
            self.send(octets, now)

    def state(self) -> None:
        """Real time does not go back."""

    def restore(self, state: tuple) -> None:
        """Come back to a moment of simulated time."""
        if state is not None:
            super().restore(state)
