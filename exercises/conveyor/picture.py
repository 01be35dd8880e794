"""Where the conveyor's state stands in its picture."""

from math import atan2, cos, degrees
from pathlib import Path

from ..picture import Picture, latest_incident, on
from ..plant import Moment
from .plant import PALLET, Conveyor

SCALE = 100  # pixels a metre
LEFT_EDGE = -30  # where the line's 0 m lies
BELT_TOP = 212
TRAVEL = 76  # of the lifts; the rollers lie 4 below the belts' level when they are down
SUNK = 4
SLOTS = 8  # as many pallets as the machine and its two hoods can hold
ROLLERS = tuple(f"roller-{side}-{n}" for side in ("left", "right") for n in range(6))
ROLLER_RADIUS, DRUM_RADIUS = 0.07, 0.15  # metres


def pallets(moment: Moment) -> dict[str, str]:
    """Each pallet in its slot; the free slots lie outside."""
    plant: Conveyor = moment.plant
    state = {f"pallet-{slot}:transform": "translate(-200 212)" for slot in range(SLOTS)}
    for number, front in enumerate(plant.fronts, plant.delivered + 1):
        rear_up, front_up = (max(0.0, height * TRAVEL - SUNK) for height in plant.pose(front))
        tilt = -atan2(front_up - rear_up, PALLET * SCALE)
        x = SCALE * front + LEFT_EDGE - PALLET * SCALE * cos(tilt)
        lean = f" rotate({degrees(tilt):.1f})" if tilt else ""
        state[f"pallet-{number % SLOTS}:transform"] = f"translate({x:.1f} {BELT_TOP - rear_up:.1f}){lean}"
        state[f"pallet-{number % SLOTS}-number:text"] = str(number)
    return state


# A tag shows what the PLC has at its terminal, a switch on the machine what the machine does to it.
PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={
        "gate": lambda moment: moment.plant.gate,
        **dict.fromkeys(("lift-left", "lift-left-tag"), lambda moment: moment.plant.left),
        **dict.fromkeys(("lift-right", "lift-right-tag"), lambda moment: moment.plant.right),
    },
    turns={
        **dict.fromkeys(ROLLERS, lambda moment: degrees(moment.plant.rollers_m / ROLLER_RADIUS)),
        **dict.fromkeys(("drum-left-0", "drum-left-1"), lambda moment: degrees(moment.plant.belt_left_m / DRUM_RADIUS)),
        **dict.fromkeys(("drum-right-0", "drum-right-1"), lambda moment: degrees(moment.plant.belt_right_m / DRUM_RADIUS)),
    },
    lit={
        **{device: on(device) for device in ("X0", "X1", "X2", "X3", "X4", "Y0", "Y1", "Y2", "Y3", "Y4", "Y5")},
        **{f"{device}-switch": lambda moment, device=device: moment.plant.inputs[device] for device in ("X0", "X1", "X3", "X4")},
        "X2-left": lambda moment: moment.plant.left == 1,
        "X2-right": lambda moment: moment.plant.right == 1,
        "gate-cylinder": on("Y0"),
        "lift-left-cylinder": on("Y1"),
        "lift-right-cylinder": on("Y2"),
        "roller-motor": on("Y3"),
        "belt-left-motor": on("Y4"),
        "belt-right-motor": on("Y5"),
        "go-left": on("Y4"),
        "go-right": on("Y5"),
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={
        "amiss-text": latest_incident(digits=2, of="pallet"),
        "delivered": lambda moment: f"{moment.plant.delivered} delivered",
    },
    free=pallets,
)
