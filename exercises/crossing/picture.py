"""Where the crossing's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, latest_incident, on
from ..plant import Moment
from .plant import CROSS_S

LAMPS = ("Y0", "Y1", "Y2", "Y3", "Y4", "Y5")
CARS, WALKERS = 16, 4  # as many are drawn
PX_PER_S, LINE_X, CAR_GAP = 70, 300, 74
KERB_Y, ACROSS = 250, 170  # a walker's way over the road


def cars(moment: Moment) -> dict[str, str]:
    """The cars near the line: those that come, those that wait one behind the other, and those that have passed."""
    plant = moment.plant
    places = {number: PX_PER_S * (plant.seconds - when) - CAR_GAP * place for number, when, place in plant.leaving}
    first = plant._next_car - plant.queue
    places |= {number: -CAR_GAP * (number - first) for number in range(first, plant._next_car)}
    for number in range(plant._next_car, min(len(plant.cars), plant._next_car + CARS)):
        places[number] = min(-PX_PER_S * (plant.cars[number] - plant.seconds), -CAR_GAP * (number - first) if plant.queue else 0)
    state = {f"car-{place}:transform": "translate(-200 0)" for place in range(CARS)}
    shown = [(number, LINE_X + x) for number, x in sorted(places.items()) if -80 < LINE_X + x < 700]
    return state | {f"car-{number % CARS}:transform": f"translate({x:.1f} 0)" for number, x in shown}


def walkers(moment: Moment) -> dict[str, str]:
    """Those who wait at the kerb, one beside the other, and those who are on the road."""
    plant = moment.plant
    state = {f"walker-{place}:transform": "translate(-200 0)" for place in range(WALKERS)}
    ways = [(moment.plant.seconds - start) / CROSS_S for start in plant.walking] + [0.0] * len(plant.waiting)
    for place, way in enumerate(ways[-WALKERS:]):
        state[f"walker-{place}:transform"] = f"translate({420 + 16 * place} {KERB_Y - ACROSS * way:.1f})"
    return state


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={},
    turns={},
    lit={
        **{device: on(device) for device in ("X0", *LAMPS)},
        **{f"{device}-lamp": on(device) for device in LAMPS},
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={
        "passed": lambda moment: f"{moment.plant.passed} cars, {moment.plant.crossed} walkers",
        "amiss-text": latest_incident(),
    },
    free=lambda moment: cars(moment) | walkers(moment),
)
