"""Where the arm's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, latest_incident, on
from ..plant import Moment
from .plant import Arm

HANDS = {"Y0": "go-right", "Y1": "go-left"}
SWITCHES = ("X2", "X3", "X4", "X5")
AWAY = "translate(-2000 0)"


def parts(moment: Moment) -> dict[str, str]:
    """The part in the nest, the one on the place, and the one in the gripper, which rides along. One just gripped lies in the nest still."""
    plant: Arm = moment.plant
    shown = {"nest": plant.nest, "place": plant.occupied, "held": plant.holds}
    return {f"part-{where}:transform": "translate(0 0)" if there else AWAY for where, there in shown.items()}


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={
        "carriage": lambda moment: moment.plant.carriage,
        "rod": lambda moment: moment.plant.cylinder,
        "jaw-left": lambda moment: moment.plant.gripper,
        "jaw-right": lambda moment: moment.plant.gripper,
    },
    turns={},
    lit={
        **{device: on(device) for device in (*(f"X{n}" for n in range(8)), *(f"Y{n}" for n in range(4)))},
        **{f"switch-{device}": on(device) for device in (*SWITCHES, "X1", "X7")},
        **{hand: on(device) for device, hand in HANDS.items()},
        "motor": lambda moment: moment.outputs.get("Y0", 0) != moment.outputs.get("Y1", 0),
        "cylinder": on("Y2"),
        "gripper": on("Y3"),
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={
        "placed": lambda moment: str(moment.plant.placed),
        "lost": lambda moment: str(moment.plant.lost),
        "amiss-text": latest_incident(digits=2),
    },
    free=parts,
)
