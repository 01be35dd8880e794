"""The machine's picture: drawn once, then moved by the state of its plant."""

from .panel import Part
from .rig import PREFIX


class Machine(Part):
    """The drawing of the plant. `rig.picture` follows the protocol of the drawings: svg() and state()."""

    key = "machine"

    def layout(self):
        return {"title": self.rig.title, "svg": self.rig.picture.svg(prefix=PREFIX)}

    def frame(self):
        return dict(self.rig.picture.state(self.rig.machine_moment()))
