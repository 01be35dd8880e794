"""Where the car park's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, latest_incident, on
from ..plant import Moment
from .plant import LENGTHS, CarPark

SCALE = 36  # pixels a metre
OUTER = 204  # where the outer barrier lies
MIDDLE = 150  # of the lane
AWAY = "translate(-2000 0)"
BAYS = 6


def lane(moment: Moment) -> dict[str, str]:
    """Who is in the lane, seen from above: those from the park drive with their nose to the street."""
    plant: CarPark = moment.plant
    state = {f"{who}:transform": AWAY for who in LENGTHS}
    if plant.who:
        front = OUTER + SCALE * plant.place
        rear = front - SCALE * LENGTHS[plant.who]
        state[f"{plant.who}:transform"] = (
            f"translate({front:.1f} {MIDDLE}) scale(-1 1)" if plant.visit.comes == "park" else f"translate({rear:.1f} {MIDDLE})"
        )
    return state


def bays(moment: Moment) -> dict[str, str]:
    """As many parked cars as there are inside; those without a place stand at the side."""
    return {f"parked-{number}:transform": "translate(0 0)" if number < moment.plant.inside else AWAY for number in range(BAYS)}


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={},
    turns={},
    lit={
        **{device: on(device) for device in ("X0", "X1", "X2", "Y0", "Y1")},
        "outer": on("X0"),
        "inner": on("X1"),
        "sign": on("Y0"),
        "lamp": on("Y1"),
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={"inside": lambda moment: str(moment.plant.inside), "amiss-text": latest_incident()},
    free=lambda moment: lane(moment) | bays(moment),
)
