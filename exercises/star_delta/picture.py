"""Where the drive's state stands in its picture."""

from pathlib import Path

from ..picture import Picture, contacts, latest_incident, on

CONTACTORS = ("line", "star", "delta")


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={"bar": lambda moment: moment.plant.speed},
    turns={"shaft": lambda moment: 360 * moment.plant.turns},
    lit={
        **{device: on(device) for device in ("X0", "X1", "X2", "Y0", "Y1", "Y2")},
        **{f"coil-{name}": on(f"Y{number}") for number, name in enumerate(CONTACTORS)},
        "motor": lambda moment: moment.plant.speed,
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={"speed": lambda moment: f"{moment.plant.speed:.0%}", "amiss-text": latest_incident(digits=2)},
    free=lambda moment: contacts(dict(zip(CONTACTORS, moment.plant.places, strict=True))),
)
