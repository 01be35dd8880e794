"""Where the feed table's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, on
from ..plant import Moment

PITCH_MM = 10  # the screw's travel in one turn
INPUTS, LAMPS = ("X0", "X1", "X2", "X3", "X4", "X6", "X7"), ("Y4", "Y5", "Y6")


def moving(moment: Moment) -> bool:
    """Pulses come."""
    return moment.plant.moving


def words(moment: Moment) -> str:
    """Place and speed."""
    plant = moment.plant
    return f"{plant.position:.1f} mm, {f'{plant.speed:.0f} mm/s' if plant.moving else 'stands still'}"


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={"table": lambda moment: moment.plant.position},
    turns={"coupling": lambda moment: 360 * moment.plant.position / PITCH_MM},
    lit={
        **{device: on(device) for device in (*INPUTS, *LAMPS)},
        **{f"{device}-lamp": on(device) for device in ("Y5", "Y6")},
        **{f"{device}-switch": on(device) for device in ("X3", "X6", "X7")},
        "Y0": moving,
        "motor": moving,
        "go-forward": lambda moment: moment.plant.moving and moment.outputs.get("Y4"),
        "go-back": lambda moment: moment.plant.moving and not moment.outputs.get("Y4"),
        "amiss": lambda moment: moment.plant.missed,
    },
    texts={
        "words": words,
        "amiss-text": lambda moment: f"{moment.plant.missed} pulses against the stop" if moment.plant.missed else "",
    },
)
