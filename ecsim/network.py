"""Several PLCs in one simulated time, with the wires between their serial ports.

The member whose next moment comes first goes on, up to that moment and no further: so nobody ever hears a character before
its own time, and nobody misses one. Members that come to the same moment go on in the order of their names, first with
what happens between scans, then with the ends of scans, then with new scans; the order in which they joined means nothing.
"""

from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

from .errors import EcsimError
from .hardware.wire import Wire
from .plc import Plc
from .system import within

EVENT, SCAN_END, SCAN_BEGIN = range(3)  # what comes first at the same moment


@dataclass
class Member:
    """A PLC of a network. The network's time is its own and `shift` more; `until` ends the scan that it is in, None between two."""

    plc: Plc
    shift: int
    until: int | None = None
    seen: tuple[int, int] = (0, 0)  # where the network has left it: its time, its scans

    def look(self) -> None:
        """Remember where the PLC stands."""
        self.seen = self.plc.clock[0], self.plc.scans

    def next(self) -> tuple[int, int]:
        """When it goes on, in the network's time, and with what."""
        if self.until is None:
            return self.plc.clock[0] + self.shift, SCAN_BEGIN
        unit, moment = self.plc.next_event(self.until)
        return (self.until + self.shift, SCAN_END) if unit is None else (moment + self.shift, EVENT)

    def go_on(self, moment: int, what: int) -> None:
        """Do what `next` told of."""
        if what == EVENT:
            self.plc.go_on(moment - self.shift)
        elif what == SCAN_END:
            self.plc.end_scan(self.until)
            self.until = None
        else:
            self.until = self.plc.begin_scan()


class Network:
    """PLCs by name, `Network(press=plc, pump=other)`, whose time goes by together: `network.advance(ms=100)`.

    `network.wire("press.1", "pump.1", drive)` connects port 1 of both, and an instrument, to one wire.
    """

    def __init__(self, **plcs: Plc):
        self.time_us = 0
        self.members: dict[str, Member] = {}
        self._stale: set[str] = set()  # members whose next moment may have changed
        for name, plc in plcs.items():
            self.add(name, plc)

    def add(self, name: str, plc: Plc) -> None:
        """Take a PLC in, which may have run on its own before. Raises EcsimError for a name or PLC that is a member already."""
        if name in self.members:
            raise EcsimError(f"the network has a member {name!r} already")
        if any(member.plc is plc for member in self.members.values()):
            raise EcsimError(f"{plc!r} is a member of the network already")
        member = Member(plc, self.time_us - plc.clock[0])
        member.look()
        self.members[name] = member
        for port in plc.ports:
            port.name, port.shift, port.network = f"{name}.{port.number}", member.shift, self
            if port.wire is not None:
                port.wire.driver = self
                for station in port.wire.stations:
                    station.moved = self.time_us

    def remove(self, name: str) -> Plc:
        """Take a PLC out; its ports leave their wires. Gives the PLC, which goes on alone where it stands."""
        member = self._member(name)
        for port in member.plc.ports:
            port.disconnect()
            port.name, port.shift, port.network = f"port {port.number}", 0, None
        if member.until is not None:
            member.plc.go_on(member.until)
            member.plc.end_scan(member.until)
        del self.members[name]
        return member.plc

    def _member(self, name: str) -> Member:
        if name not in self.members:
            raise EcsimError(f"the network has no member {name!r}; it has {', '.join(sorted(self.members)) or 'none'}")
        return self.members[name]

    def __getitem__(self, name: str) -> Plc:
        return self._member(name).plc

    def wire(self, *ends: Any, name: str = "wire") -> Wire:
        """A new wire with these ends: ports as "name.number", instruments as they are."""
        wire = Wire(name)
        wire.driver = self
        for end in ends:
            wire.join(self.port(end) if isinstance(end, str) else end)
        return wire

    def port(self, name: str) -> Any:
        """The port "name.number" of a member."""
        plc, _, number = name.rpartition(".")
        ports = self._member(plc).plc.ports
        if number not in map(str, range(len(ports))):
            raise EcsimError(
                f"{name!r} is no port; write a member and one of the ports {', '.join(map(str, range(len(ports))))}, as {plc}.0"
            )
        return ports[int(number)]

    @property
    def wires(self) -> dict[str, Wire]:
        """The wires of the members' ports, each under the name of its first port."""
        found: dict[str, Wire] = {}
        for name in sorted(self.members):
            for port in self.members[name].plc.ports:
                if port.wire is not None and port.wire not in found.values():
                    found[port.name] = port.wire
        return found

    @property
    def log(self) -> list[tuple[int, str, str]]:
        """The messages on all wires as (begin in us, name of the sender, bytes in hex), in order of time."""
        return sorted(entry for wire in self.wires.values() for entry in wire.log)

    # -- time ---------------------------------------------------------------------------------------------------

    def wire_time(self) -> int:
        """The present moment as the wires count it."""
        return self.time_us

    def stirred(self) -> None:
        """A wire has changed: all are asked again when they go on."""
        self._stale.update(self.members)

    def reached(self, port: Any) -> None:
        """A member has heard something: it is asked again when it goes on."""
        self._stale.add(port.name.rpartition(".")[0])

    def advance(self, ms: float) -> None:
        """Simulated time goes on by `ms` milliseconds for all members. Raises EcsimError when one was moved on its own."""
        within("ms", ms, 0, 1e12)
        for name, member in self.members.items():
            if member.seen != (member.plc.clock[0], member.plc.scans):
                raise EcsimError(f"{name} was moved on its own; advance the network only, or remove {name} and add it again")
        with ExitStack() as held:
            for member in self.members.values():
                held.enter_context(member.plc.lock)
            try:
                self._go_on(self.time_us + round(ms * 1000))
            finally:
                for member in self.members.values():
                    member.look()

    def _go_on(self, end: int) -> None:
        members, wires, stale = self.members, self.wires, self._stale
        moments: dict[str, tuple[int, int, str]] = {}
        stale.update(members)
        while True:
            for name in stale:
                moments[name] = (*members[name].next(), name)
            stale.clear()
            first = min(moments.values(), default=(end, SCAN_BEGIN, ""))
            for name, wire in wires.items():
                due = wire.next()
                if due is not None and (due, EVENT, name) < first:
                    first = due, EVENT, name
            if first >= (end, SCAN_BEGIN):  # no scan begins at the end
                break
            moment, what, name = first
            self.time_us = max(self.time_us, moment)
            if name in members:
                members[name].go_on(moment, what)
                stale.add(name)
            else:
                wires[name].act(moment)
                stale.update(members)  # an instrument may do to them what it likes
        self.time_us = end

    # -- going back ---------------------------------------------------------------------------------------------

    def snapshot(self) -> dict[str, Any]:
        """Everything that changes, to be given to `restore` of the same network."""
        return {
            "time": self.time_us,
            "members": {name: (member.plc.snapshot(), member.shift, member.until) for name, member in self.members.items()},
            "wires": {name: wire.snapshot() for name, wire in self.wires.items()},
        }

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Go back to a snapshot. Raises EcsimError when it has other members."""
        if snapshot["members"].keys() != self.members.keys():
            raise EcsimError(
                f"the snapshot is of {', '.join(sorted(snapshot['members']))}, the network has {', '.join(sorted(self.members))} now"
            )
        for name, (state, shift, until) in snapshot["members"].items():
            member = self.members[name]
            member.plc.restore(state)
            member.shift, member.until = shift, until
            for port in member.plc.ports:
                port.shift = shift
            member.look()
        self.time_us = snapshot["time"]
        for name, wire in self.wires.items():
            if name in snapshot["wires"]:
                wire.restore(snapshot["wires"][name], self.time_us)

    def __repr__(self) -> str:
        return f"<Network of {', '.join(sorted(self.members)) or 'nothing'} at {self.time_us / 1000:g} ms>"
