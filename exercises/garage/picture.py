"""Where the door's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, latest_incident, on
from ..plant import Moment
from .plant import PASS_S

WAY = 420  # px that a car drives while it is under the door
HOUSE_X = 250  # where a waiting car stands


def car(moment: Moment) -> dict[str, str]:
    """The car that waits, or the one that drives through."""
    plant = moment.plant
    driven = (plant.seconds - plant.inside) / PASS_S
    if driven < 1:
        return {"car:transform": f"translate({WAY * driven:.1f} 0)", "car:class": "car"}
    return {"car:transform": "translate(0 0)", "car:class": "car" if plant.waiting else "car away"}


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={"door": lambda moment: moment.plant.place},
    turns={},
    lit={
        **{device: on(device) for device in ("X0", "X1", "X2", "X3", "Y0", "Y1", "Y2")},
        "motor": lambda moment: moment.outputs["Y0"] or moment.outputs["Y1"],
        "Y2-lamp": on("Y2"),
        "go-up": on("Y0"),
        "go-down": on("Y1"),
        "open-switch": lambda moment: moment.plant.is_open,
        "closed-switch": lambda moment: moment.plant.is_closed,
        "beam": lambda moment: not moment.plant.blocked,
        "child": lambda moment: "child" in moment.plant.faults,
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={
        "through": lambda moment: f"{moment.plant.through} through, {moment.plant.waiting} waiting",
        "amiss-text": latest_incident(),
    },
    free=car,
)
