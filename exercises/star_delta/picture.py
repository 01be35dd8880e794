"""Where the drive's state stands in its picture."""

from pathlib import Path

from ..picture import Picture
from ..plant import Moment

FOOT, LEAN = 148, 10 / 36  # where the contacts turn, and how far they lean
CONTACTORS = ("line", "star", "delta")


def on(device):
    """The lamp of a terminal."""
    outputs = device.startswith("Y")
    return lambda moment: (moment.outputs if outputs else moment.inputs).get(device, 0)


def blades(moment: Moment) -> dict[str, str]:
    """The contacts lean over when they are open, and stand upright when they are closed."""
    state = {}
    for name, place in zip(CONTACTORS, moment.plant.places, strict=True):
        lean = LEAN * place
        state[f"contact-{name}:transform"] = f"matrix(1 0 {-lean:.4f} 1 {lean * FOOT:.2f} 0)"
    return state


def latest_incident(moment: Moment) -> str:
    """The last thing that went wrong, in words."""
    if not moment.plant.incidents:
        return ""
    seconds, what = moment.plant.incidents[-1]
    return f"{seconds:.2f} s: {what}"


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={"bar": lambda moment: moment.plant.speed},
    turns={"shaft": lambda moment: 360 * moment.plant.turns},
    lit={
        **{device: on(device) for device in ("X0", "X1", "X2", "Y0", "Y1", "Y2")},
        **{f"coil-{name}": on(f"Y{number}") for number, name in enumerate(CONTACTORS)},
        "motor": lambda moment: moment.plant.speed,
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={"speed": lambda moment: f"{moment.plant.speed:.0%}", "amiss-text": latest_incident},
    free=blades,
)
