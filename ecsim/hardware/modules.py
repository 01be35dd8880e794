"""Special modules on the extension bus and their buffer memory (BFM), reached with FROM and TO (6.8)."""

from collections.abc import Sequence

from ..errors import NO_BUFFER, NO_MODULE, EcsimError, Fault
from ..memory import Memory
from ..values import signed16
from .unit import Unit

PLACES = range(8)


class Module:
    """A special module as the main module sees it: so many buffers of 16 bits. What a module does with them, a subclass says."""

    def __init__(self, buffers: int):
        self.buffers = [0] * buffers

    def read(self, first: int, count: int) -> list[int]:
        """`count` buffers from `first` on; buffers that do not exist are error 78."""
        self._check(first, count)
        return self.buffers[first : first + count]

    def write(self, first: int, values: Sequence[int]) -> None:
        """Write buffers from `first` on."""
        self._check(first, len(values))
        self.buffers[first : first + len(values)] = [signed16(value) for value in values]

    def _check(self, first: int, count: int) -> None:
        if first + count > len(self.buffers):
            raise Fault(NO_BUFFER)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {len(self.buffers)} buffers>"


class Rack(Unit):
    """The places 0 to 7 for special modules, empty at first: `plc.modules[0] = Module(32)` plugs one in."""

    def __init__(self, memory: Memory, awake: list[Unit]):
        super().__init__(awake)
        self.memory = memory
        self.modules: dict[int, Module] = {}

    def read(self, place: int, first: int, count: int) -> list[int]:
        """Buffers of the module in a place; the register for it tells where an error was."""
        try:
            return self._at(place).read(first, count)
        except Fault:
            self._blame(place)
            raise

    def write(self, place: int, first: int, values: Sequence[int]) -> None:
        """Write buffers of the module in a place."""
        try:
            self._at(place).write(first, values)
        except Fault:
            self._blame(place)
            raise

    def _at(self, place: int) -> Module:
        if place not in self.modules:
            raise Fault(NO_MODULE)
        return self.modules[place]

    def _blame(self, place: int) -> None:
        model = self.memory.model
        if "faulty module" in model.registers:
            self.memory.lists[model.special_words][model.registers["faulty module"]] = place

    def __setitem__(self, place: int, module: Module) -> None:
        if place not in PLACES:
            raise EcsimError(f"special modules have the places {PLACES.start} to {PLACES.stop - 1}, not {place!r}")
        if not isinstance(module, Module):
            raise EcsimError(f"{module!r} is no special module")
        self.modules[place] = module

    def __getitem__(self, place: int) -> Module:
        if place not in self.modules:
            known = ", ".join(map(str, sorted(self.modules)))
            raise EcsimError(
                f"there is no special module in place {place!r}; " + (f"there are some in {known}" if known else "the rack is empty")
            )
        return self.modules[place]

    def __delitem__(self, place: int) -> None:
        if self[place]:
            del self.modules[place]

    def __len__(self) -> int:
        return len(self.modules)

    def __repr__(self) -> str:
        return f"<Rack {dict(sorted(self.modules.items()))}>"

    def snapshot(self) -> dict[int, list[int]]:
        return {place: list(module.buffers) for place, module in self.modules.items()}

    def restore(self, snapshot: dict[int, list[int]]) -> None:
        for place, buffers in snapshot.items():
            self.modules[place].buffers[:] = buffers
