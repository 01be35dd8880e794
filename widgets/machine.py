"""The machine's picture: drawn once, then moved by the state of its plant; and what is wrong with the machine and its sensors."""

from ecsim.errors import EcsimError
from ecsim.sensors import KINDS

from .panel import Part
from .rig import PREFIX

USUAL = {"delayed": 0.5, "bounces": 30}  # what the plate offers first, in the unit of the kind


class Machine(Part):
    """The drawing of the plant. `rig.picture` follows the protocol of the drawings: svg() and state()."""

    key = "machine"

    def layout(self):
        sensors = self.rig.sensors
        return {
            "title": self.rig.title,
            "svg": self.rig.picture.svg(prefix=PREFIX),
            "sensors": [dict(zip(("device", "name", "what"), (device, *self.rig.point(device)), strict=True)) for device in sensors.says],
            "faults": [{"name": name, "what": what} for name, what in sensors.own.items()],
            "times": [{"kind": kind, "unit": KINDS[kind].unit, "usual": usual} for kind, usual in USUAL.items()],
        }

    def frame(self):
        sensors, moment = self.rig.sensors, self.rig.machine_moment()
        entries = dict(self.rig.picture.state(moment))
        for device, says in sensors.says.items():
            fault = sensors.faults.get(device)
            wrong = {"kind": fault.kind, "amount": fault.amount, "words": fault.words} if fault else None
            entries[f"sensor.{device}"] = {"says": says, "comes": moment.inputs[device], "wrong": wrong}
        entries["faults"] = sorted(getattr(sensors.plant, "faults", ()))
        return entries

    def on_fail(self, fault):
        """Switch a fault in; gives why it was refused, or ""."""
        return self._refusal(lambda: self.rig.session.fail(fault))

    def on_mend(self, fault):
        """Switch a fault out: a name, a sensor's device, or "all"; gives why it was refused, or ""."""
        return self._refusal(lambda: self.rig.session.mend(fault))

    def on_press(self, key):
        """Put a finger on a key of the drawing; gives why it was refused, or ""."""
        return self._finger("hold", key)

    def on_release(self, key):
        """Take it off again; gives why it was refused, or ""."""
        return self._finger("release", key)

    def _finger(self, act, key):
        plant = self.rig.sensors.plant
        if not hasattr(plant, act):
            return "this machine has no keys"
        return self._refusal(lambda: self.rig.session.post(lambda plc: getattr(plant, act)(key)))

    def _refusal(self, action):
        try:
            action()
        except EcsimError as error:
            return str(error)
        return ""
