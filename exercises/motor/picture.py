"""Where the drive's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, contacts, latest_incident, on
from ..plant import Moment


def speed(moment: Moment) -> str:
    """Direction and speed in words."""
    at = moment.plant.speed
    if not at:
        return "stands still"
    return f"{'forward' if at > 0 else 'reverse'}, {abs(at):.0%} of its speed"


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={},
    turns={"shaft": lambda moment: 360 * moment.plant.turns},
    lit={
        **{device: on(device) for device in ("X0", "X1", "X2", "X3", "Y0", "Y1")},
        "coil-forward": on("Y0"),
        "coil-reverse": on("Y1"),
        "motor": lambda moment: moment.plant.speed,
        "go-forward": lambda moment: moment.plant.speed > 0,
        "go-reverse": lambda moment: moment.plant.speed < 0,
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={"speed": speed, "amiss-text": latest_incident(digits=2)},
    free=lambda moment: contacts({"forward": moment.plant.forward, "reverse": moment.plant.reverse}),
)
