"""Where the turntable's and the cam shaft's state stand in their pictures."""

from pathlib import Path

from ..picture import Picture, latest_incident, on
from .plant import CAMS, PLACES, CamShaft, Turntable


def stands(moment) -> str:
    """Which item stands at window 0, in words."""
    item, before = moment.plant.item_at(0)
    return f"item {item} at window 0" if abs(before) < 0.1 else f"item {item} near window 0"


def ran(cam):
    """From where to where an output was ON last."""

    def text(moment) -> str:
        begin, end = moment.plant.cams[cam]
        if begin is None:
            return ""
        return f"from {begin:.0f}°" if end is None or moment.outputs.get(f"Y{0o10 + cam:o}") else f"{begin:.0f}° to {end:.0f}°"

    return text


PICTURE = Picture(
    Path(__file__).with_name("picture.svg"),
    places={},
    turns={"table": lambda moment: -360 / PLACES * moment.plant.turned},  # forward takes item 1 to window 0
    lit={
        **{device: on(device) for device in Turntable.wiring},
        "motor": lambda moment: moment.plant.speed,
        "go-forward": lambda moment: moment.plant.speed > 0,
        "go-backward": lambda moment: moment.plant.speed < 0,
        "amiss": lambda moment: moment.plant.incidents,
    },
    texts={
        "stands": stands,
        "speed": lambda moment: f"{moment.plant.speed:.2f} places a second".replace("-", "−"),
        "amiss-text": latest_incident(),
    },
)

SHAFT_PICTURE = Picture(
    Path(__file__).with_name("shaft.svg"),
    places={},
    turns={"shaft": lambda moment: moment.plant.angle},
    lit={
        **{device: on(device) for device in CamShaft.wiring},
        **{f"cam{cam}": on(f"Y{0o10 + cam:o}") for cam in range(CAMS)},
        "motor": on("Y0"),
    },
    texts={
        "angle": lambda moment: f"{moment.plant.angle:.0f}°",
        "turns": lambda moment: f"turn {moment.plant.half // (2 * moment.plant.pulses) + 1}",
        **{f"range{cam}": ran(cam) for cam in range(CAMS)},
    },
)
