"""Where the drive's state stands in its picture."""

from pathlib import Path

from ..picture import Picture
from ..plant import Moment

FOOT, LEAN = 148, 10 / 36  # where the contacts turn, and how far they lean


def on(device):
    """The lamp of a terminal."""
    outputs = device.startswith("Y")
    return lambda moment: (moment.outputs if outputs else moment.inputs).get(device, 0)


def blades(moment: Moment) -> dict[str, str]:
    """The contacts lean over when they are open, and stand upright when they are closed."""
    state = {}
    for name, place in (("forward", moment.plant.forward), ("reverse", moment.plant.reverse)):
        lean = LEAN * place
        state[f"contact-{name}:transform"] = f"matrix(1 0 {-lean:.4f} 1 {lean * FOOT:.2f} 0)"
    return state


def speed(moment: Moment) -> str:
    """Direction and speed in words."""
    at = moment.plant.speed
    if not at:
        return "stands still"
    return f"{'forward' if at > 0 else 'reverse'}, {abs(at):.0%} of its speed"


def latest_incident(moment: Moment) -> str:
    """The last thing that went wrong, in words."""
    if not moment.plant.incidents:
        return ""
    seconds, what = moment.plant.incidents[-1]
    return f"{seconds:.2f} s: {what}"


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
    texts={"speed": speed, "amiss-text": latest_incident},
    free=blades,
)
