"""The unit's face: inputs as switches and buttons, the window with its lamps, the mode switch, the potentiometers, analog signals; a plate for each point."""

from ecsim.errors import EcsimError

from .history import Pulses
from .plate import Plated
from .table import row_of

PATIENCE_US = 100_000  # a press that no scan sees for so long (a filter, a force) is let go all the same


class Unit(Plated):
    """Inputs and outputs of the unit; a control shows the terminal, a lamp what the program sees at an input and what an output gives."""

    key = "unit"

    def __init__(self, rig):
        super().__init__(rig)
        self._pressed_us: dict[str, int] = {}
        self._releases: set[str] = set()
        self.points = {device: rig.point(device) for device in (*rig.inputs, *rig.outputs)}
        self._pulses = Pulses()
        self._image: tuple[list, list] | None = None
        self._leave = rig.session.each_scan(self._watch)

    def layout(self):
        rows = {device: {"device": device, "name": name, "what": what} for device, (name, what) in self.points.items()}
        return {
            "model": self.rig.plc.model.name,
            "inputs": [rows[device] | {"control": self.rig.controls.get(device, "switch")} for device in self.rig.inputs],
            "outputs": [rows[device] for device in self.rig.outputs],
            "pots": len(self.rig.plc.pots),
            "analog": [self._terminal(terminal) for terminal in self.rig.analog],
        }

    def frame(self):
        rig = self.rig
        entries = {**rig.plc.lamps, "switch": rig.plc.switch, **self.plates()}
        entries.update((f"pot{number}", value) for number, value in enumerate(rig.plc.pots))
        forced = rig.plc.forced
        for device in rig.inputs:
            entries[device] = rig.terminal(device)
            entries[f"{device}.seen"] = rig.bit(device)
            entries[f"{device}.by"] = rig.by(device)
        for device in rig.outputs:
            entries[device] = rig.terminal(device)
        entries |= self._signals()
        entries.update((f"{device}.forced", int(forced[device])) for device in self.points if device in forced)
        return entries

    def _terminal(self, terminal):
        """An analog terminal; its module is like "4AD 1", "" for the base unit."""
        name, what = self.rig.point(terminal)
        place, dot, _ = terminal[2:].partition(".")
        return {"device": terminal, "name": name, "what": what, "module": f"{self.rig.plc.modules[int(place)].kind} {place}" if dot else ""}

    def _signals(self):
        """The analog terminals: [signal or None, its unit, [lowest, highest], who drives it]; None where a module is away.

        A channel that is off has no ends, and is shown in the first kind of signal that it can have.
        """
        channels = {channel.terminal: channel for channel in self.rig.plc.analog_channels}
        return {terminal: self._signal(channels[terminal]) if terminal in channels else None for terminal in self.rig.analog}

    def _signal(self, channel):
        unit = channel.mode.unit if channel.mode else channel.units[0]
        name = f"{channel.terminal}:{unit}"
        ends = [channel.mode.low, channel.mode.high] if channel.mode else None
        return [self.rig.plc[name], unit, ends, self.rig.by(name)]

    def pulsed(self):
        return self._pulses.take(self._on())

    def _on(self):
        return [device for device in self.points if self.rig.bit(device)]

    def _watch(self):
        """After each scan; most of them change nothing, so the two images are compared as a whole."""
        lists = self.rig.plc.memory.lists
        image = lists["X"][: len(self.rig.inputs)], lists["Y"][: len(self.rig.outputs)]
        if image != self._image:
            self._image = image
            self._pulses.see(self._on())
        for device in list(self._releases):
            self._release(device)

    def close(self):
        self._leave()

    def _input(self, device):
        if device not in self.rig.inputs:
            raise ValueError(f"{device!r} is no input of the unit")
        return device

    def on_set(self, device, on):
        """Put an input to 0 or 1; one that the machine drives is taken over."""
        self.rig.put(self._input(device), int(bool(on)))

    def on_press(self, device):
        """Hold a push button."""
        device = self._input(device)
        self.rig.post(lambda plc: self._press(plc, device))

    def on_release(self, device):
        """Let a push button go; the program gets at least one look at it, however short the press was."""
        device = self._input(device)
        self.rig.post(lambda plc: self._release(device))

    def _press(self, plc, device):
        plc[device] = 1
        self._pressed_us[device] = plc.time_us
        self._releases.discard(device)

    def _release(self, device):
        plc = self.rig.plc
        if self.rig.bit(device) or plc.time_us - self._pressed_us.get(device, 0) > PATIENCE_US:
            plc[device] = 0
            self._releases.discard(device)
        else:
            self._releases.add(device)

    def on_signal(self, name, text):
        """Put a signal on an analog input, "AI0:V"; gives the reason in words where it is refused, else ""."""
        try:
            row = row_of(self.rig.plc, name)
            self.rig.signal(row.name, row.read(str(text)))
        except EcsimError as error:
            return str(error)
        return ""

    def on_free_signal(self, name):
        """Give an analog input back to the machine."""
        self.rig.free(name)

    def on_free(self, device):
        """Give an input back to the machine."""
        self.rig.free(self._input(device))

    def on_mode(self, mode):
        """Turn the mode switch to "ON", "TM" or "OFF"."""
        self.rig.post(lambda plc: setattr(plc, "switch", mode))

    def on_pot(self, number, value):
        """Turn a potentiometer to a value of 0 to 255."""
        self.rig.post(lambda plc: plc.pots.__setitem__(int(number), int(value)))
