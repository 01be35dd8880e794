"""Where the tank's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, latest_incident, on
from .plant import FULL

PUMPS = ("A", "B")
FLOATS = {"X1": "Bottom", "X2": "Low", "X3": "High"}


def brings(number):
    """Whether a pump brings water."""
    return lambda moment: moment.plant.speeds[number] > 0 and f"{PUMPS[number]} blocked" not in moment.plant.faults


def turned(number):
    """How far the wheel of a pump has turned, in degrees."""
    return lambda moment: 360 * moment.plant.turns[number]


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={"level": lambda moment: moment.plant.water / FULL},
    turns={f"wheel-{pump}": turned(number) for number, pump in enumerate(PUMPS)},
    lit={
        **{device: on(device) for device in (*(f"X{n}" for n in range(7)), "Y0", "Y1", "Y2")},
        **{f"float-{device}": on(device) for device in FLOATS},
        **{f"pump-{pump}": on(f"Y{number}") for number, pump in enumerate(PUMPS)},
        **{f"pipe-{pump}": brings(number) for number, pump in enumerate(PUMPS)},
        **{f"stream-{pump}": brings(number) for number, pump in enumerate(PUMPS)},
        "lamp": on("Y2"),
        "pipe-out": lambda moment: moment.plant.drawn > 0 and moment.plant.water > 0,
        "leak": lambda moment: "leak" in moment.plant.faults and moment.plant.water > 0,
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={
        "water": lambda moment: f"{moment.plant.water:.0f}",
        "drawn": lambda moment: f"{moment.plant.drawn:.1f} l/s",
        "amiss-text": latest_incident(),
    },
)
