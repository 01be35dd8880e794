"""One program on three machines at once: compiled, stepping (traced now and then), and one that changes all the time."""

from ecsim import Plc, SystemBlock
from ecsim.assembler import assemble
from ecsim.errors import EcsimError

WATCHDOG_MS = 2  # an endless loop of a random program ends soon
EDGES = (0, 0, 1, 1, 2, 3, 4, 7, -1, -2, 10, 100, 7990, -8000, 32767, -32768)


class Differ(AssertionError):
    """Two machines of the same program are in different states."""


def state(plc: Plc, slots: list[int]) -> dict:
    """All that a program can see or has left behind; `slots` is where instructions remember a scan before.

    What a step remembers of its last scan is each engine's own, and no state of a device.
    """
    lists = plc.memory.lists
    remembered = [lists["E"][slot] for slot in slots]
    devices = {name: values for name, values in lists.items() if name != "E"}
    interrupts = plc.interrupts
    machine = {"running": plc.running, "time": plc.time_us, "scans": plc.scans, "system error": plc.system_error}
    waiting = {"enabled": interrupts.enabled, "due": list(interrupts.due), "queue": list(interrupts.queue)}
    return devices | machine | waiting | {"remembered": remembered, "frames": len(plc._services["FRAMES"])}


def difference(first: dict, second: dict) -> str:
    """The first few places where two states differ."""
    found = []
    for key, value in first.items():
        other = second[key]
        if value == other:
            continue
        if isinstance(value, list) and len(value) == len(other):
            found += [f"{key}[{n}]: {a} / {b}" for n, (a, b) in enumerate(zip(value, other, strict=True)) if a != b]
        else:
            found.append(f"{key}: {value} / {other}")
    return ", ".join(found[:8])


class Machines:
    """The machines, and what is done to all of them alike."""

    def __init__(self, text: str, scan_ms: float | None, model: str):
        self.text = text
        self.plcs: dict[str, Plc] = {}
        program = assemble(text, model)
        self.slots = [instruction.slot for instruction in program.instructions if instruction.slot >= 0]
        for name in ("compiled", "stepping", "changing"):
            plc = Plc(model, scan_ms=scan_ms, input_filter_ms=0, system=SystemBlock(watchdog_ms=WATCHDOG_MS))
            plc.load(program)
            plc.run()
            self.plcs[name] = plc
        self.plcs["stepping"].engine = "stepping"

    def each(self, act) -> None:
        """Do `act(plc)` on every machine; what one refuses all must refuse."""
        refused = []
        for plc in self.plcs.values():
            try:
                act(plc)
            except EcsimError as error:
                refused.append(str(error))
        if len(set(refused)) > 1 or len(refused) not in (0, len(self.plcs)):
            raise Differ(f"refused by some only: {refused}")

    def compare(self, scan: int) -> None:
        """Raise Differ when any machine is not where the compiled one is."""
        first = state(self.plcs["compiled"], self.slots)
        if first["frames"]:
            raise Differ(f"scan {scan}: {first['frames']} calls have not ended\n{self.text}")
        for name, plc in self.plcs.items():
            other = state(plc, self.slots)
            if other != first:
                raise Differ(f"scan {scan}: compiled / {name}: {difference(first, other)}\n{self.text}")


def run_side_by_side(text: str, chance, scans: int, model: str = "EC20") -> None:
    """Run a program on all machines with the same random inputs, writes and forces; raise Differ when they part."""
    machines = Machines(text, chance.choice((10, 10, 1, 7.3, None)), model)
    changing = machines.plcs["changing"]
    kept = None
    for scan in range(scans):
        disturb(machines, chance)
        machines.plcs["stepping"].tracing = chance.random() < 0.5
        if chance.random() < 0.4:
            changing.engine = chance.choice(("compiled", "stepping"))
            changing.tracing = chance.random() < 0.3
        if chance.random() < 0.15:
            kept = changing.snapshot()
            for _ in range(chance.randint(1, 3)):
                changing.scan()
            changing.restore(kept)
        machines.each(lambda plc: plc.scan())
        machines.compare(scan)
        if not machines.plcs["compiled"].running:
            machines.each(lambda plc: plc.run())


def disturb(machines: Machines, chance) -> None:
    """What comes from outside before a scan."""
    for number in chance.sample(range(8), chance.randint(0, 4)):
        level = chance.randint(0, 1)
        machines.each(lambda plc, name=f"X{number}", level=level: plc.__setitem__(name, level))
    for name in chance.sample(
        ("Z0", "Z1", "Z2", "Z3", "D0", "D5", "D9", "T0", "C1", "C200", "S0", "S20", "M1", "T210:BOOL"), chance.randint(0, 3)
    ):
        value = chance.randint(0, 1) if name[0] in "SM" or name.endswith("BOOL") else chance.choice(EDGES)
        machines.each(lambda plc, name=name, value=value: plc.__setitem__(name, value))
    if chance.random() < 0.04:
        name, value = chance.choice((("M1", 1), ("Y0", 0), ("D3", 77), ("X2", 1), ("S21", 1), ("Z1", 5)))
        machines.each(lambda plc: plc.force(name, value))
    elif chance.random() < 0.2:
        machines.each(lambda plc: plc.unforce())
