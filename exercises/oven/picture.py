"""Where the oven's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, latest_incident, on
from ..plant import Moment

HOTTEST = 320.0  # the end of the scale
FALLEN = 90.0  # degrees of the open door
CLOSES = 24.0  # degrees from an open contact to a closed one
DEVICES = ("X0", "X1", "X2", "Y0", "Y1", "Y2", "Y3")


def relay(moment: Moment) -> bool:
    """Whether the relay is closed; it need not open."""
    return bool(moment.outputs.get("Y0") or "relay welded" in moment.plant.faults)


def reading(moment: Moment) -> str:
    """What the transmitter says, in degrees."""
    return "---" if "sensor broken" in moment.plant.faults else f"{moment.plant.inputs['D0'] / 10:.1f}"


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={"heat": lambda moment: min(max(moment.plant.chamber / HOTTEST, 0), 1)},
    turns={
        "door": lambda moment: FALLEN * ("door open" in moment.plant.faults),
        "contact-Y0": lambda moment: CLOSES * relay(moment),
        "contact-Y1": lambda moment: CLOSES * bool(moment.outputs.get("Y1")),
    },
    lit={
        **{device: on(device) for device in DEVICES},
        "Y2-lamp": on("Y2"),
        "Y3-lamp": on("Y3"),
        "element": lambda moment: moment.plant.heating,
        "rises": lambda moment: moment.plant.heating,
        "door-switch": on("X1"),
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={"reading": reading, "amiss-text": latest_incident()},
)
