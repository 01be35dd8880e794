"""Where the mixer's state stands in its picture."""

from math import cos, tau
from pathlib import Path

from ..picture import Picture, latest_incident, on
from ..plant import Moment
from .plant import FULL, Mixer

HEIGHT = 260  # px that the level travels, as the picture's data-move says
CENTRE = 290  # of the stirrer
BOTTOM_KG, BOTTOM_PX, PX_PER_KG = 100, 17, 0.08  # the bottom is curved: the first kilograms stand higher
VALVES = ("Y0", "Y1", "Y2", "Y3", "Y4")
PRODUCTS = {1: "A", 2: "B"}


def level(moment: Moment) -> float:
    """How high the liquid stands, as a part of its travel."""
    weight = min(moment.plant.weight, FULL)
    if weight < BOTTOM_KG:
        return weight / BOTTOM_KG * BOTTOM_PX / HEIGHT
    return (BOTTOM_PX + (weight - BOTTOM_KG) * PX_PER_KG) / HEIGHT


def blades(moment: Moment) -> dict[str, str]:
    """The blades as they are seen from the side: narrower by the cosine of their angle."""
    width = max(0.12, abs(cos(moment.plant.turns * tau)))
    return {"blades:transform": f"translate({CENTRE * (1 - width):.1f} 0) scale({width:.3f} 1)"}


def opened(number):
    """Whether something can flow through a valve."""
    return lambda moment: moment.plant.places[number] > 0


def running_out(moment: Moment) -> bool:
    """Whether something comes out of the drain."""
    plant: Mixer = moment.plant
    return plant.places[4] > 0 and (plant.weight > 0 or any(plant.places[:4]))


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={"level": level},
    turns={},
    lit={
        **{device: on(device) for device in (*(f"Y{n}" for n in range(6)), *(f"X{n:o}" for n in range(11)), "M2")},
        **{f"{device}-valve": on(device) for device in VALVES},
        **{f"{device}-pipe": opened(number) for number, device in enumerate(VALVES[:4])},
        **{f"{device}-stream": opened(number) for number, device in enumerate(VALVES[:4])},
        "Y4-pipe": running_out,
        "stirrer-motor": on("Y5"),
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={
        "weight": lambda moment: f"{int(moment.plant.weight + 1e-6):,}",
        "product": lambda moment: PRODUCTS.get(moment.inputs.get("D2", 0), "not chosen"),
        "finished": lambda moment: str(moment.plant.finished),
        "amiss-text": latest_incident(of="batch"),
    },
    free=blades,
)
