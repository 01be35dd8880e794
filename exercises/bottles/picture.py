"""Where the bottle machine's state stands in its picture."""

from math import cos, radians, sin
from pathlib import Path

from ..picture import Picture, latest_incident, on
from ..plant import Moment
from .plant import EXIT, REJECTING, BottleMachine

CENTRE = (290, 268)  # of the table
RING = 112  # px from there to the middle of a place
PITCH = 50  # px from bottle to bottle on the belts
TURN = 45  # degrees from place to place
THROW = 76  # px that the reject cylinder pushes, as the picture's data-move says
WAITING = 3  # bottles in sight before the entry
SLOTS = 14  # as many bottles as belts and table can hold
OUTSIDE = f"translate(-80 {CENTRE[1]})"


def bottles(moment: Moment) -> dict[str, str]:
    """Each bottle in its slot; the free slots lie outside."""
    plant: BottleMachine = moment.plant
    state = {f"bottle-{slot}:{what}": rest for slot in range(SLOTS) for what, rest in (("transform", OUTSIDE), ("class", "bottle"))}
    arrived = plant.turned + 1
    for number in range(arrived + 1, arrived + WAITING + 1):
        if plant.kind(number) != "gap":
            state[f"bottle-{number % SLOTS}:transform"] = put(arrived - number + plant.table, 0.0)
    for place, bottle in enumerate(plant.line):
        if bottle is not None:
            pushed = plant.strokes[2] if place == REJECTING else 0.0
            state[f"bottle-{bottle.number % SLOTS}:transform"] = put(place + plant.table, pushed)
            state[f"bottle-{bottle.number % SLOTS}:class"] = " ".join(("bottle", *looks(bottle)))
    return state


def looks(bottle):
    """What is seen of a cap and a label, as classes."""
    return [{"cap good": "capped", "cap bad": "askew", "label good": "labelled", "label bad": "torn"}[f"{what} {how}"]
            for what, how in (("cap", bottle.cap), ("label", bottle.label)) if how]  # fmt: skip


def put(place, pushed):
    """Where a bottle stands so many places behind the entry: on the belt before it, on the table, on the belt behind the exit."""
    angle = TURN * min(max(place, 0), EXIT)
    away = RING + THROW * pushed
    x = CENTRE[0] - away * cos(radians(angle)) + PITCH * min(place, 0)
    y = CENTRE[1] - away * sin(radians(angle)) + PITCH * max(place - EXIT, 0)
    return f"translate({x:.1f} {y:.1f}) rotate({angle:.0f})"


def turns(moment: Moment) -> float:
    """How far the table has turned, in degrees."""
    return TURN * (moment.plant.turned + moment.plant.table)


# A tag shows what the PLC has at its terminal, the switch at the rim what the table does to it.
PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={
        "capper-rod": lambda moment: moment.plant.strokes[0],
        "labeller-rod": lambda moment: moment.plant.strokes[1],
        "reject-rod": lambda moment: moment.plant.strokes[2],
    },
    turns={"table": turns},
    lit={
        **{device: on(device) for device in BottleMachine.wiring},
        "X0-switch": lambda moment: moment.plant.at_flag,
        "table-motor": on("Y0"),
        "capper-cylinder": on("Y1"),
        "labeller-cylinder": on("Y2"),
        "reject-cylinder": on("Y3"),
        "go-in": on("Y0"),
        "go-out": on("Y0"),
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={
        "passed": lambda moment: f"{moment.plant.passed} passed",
        "rejected": lambda moment: f"{moment.plant.rejected} rejected",
        "amiss-text": latest_incident(),
    },
    free=bottles,
)
