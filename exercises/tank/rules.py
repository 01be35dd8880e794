"""What happens to the tank when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Do, Exercise, Lasts, Never, OneOf, Order, Scenario, Several

from .picture import PICTURE
from .plant import Tank

RUNS = "(PumpA or PumpB)"
ENDS = "High or not Auto or Alarm"
FILLING = f"between(Auto and not Low and not Alarm, {ENDS})"
BOTH = f"between(Auto and not Bottom and not Alarm, {ENDS})"
ANSWER = 10  # scans: 0.2 s
READY = Do({"Auto": 1}, at=0.2)
OKS = {"A": "OkA", "B": "OkB"}
OTHER = {"A": "B", "B": "A"}


def drawing(chosen):
    """What the consumers draw, in stretches of 20 s."""
    return tuple((20.0, flow) for flow in chosen.flows)


SCENARIOS = (
    Scenario(
        "day",
        "Consumers draw now more, now less, and the tank is filled again and again",
        seconds=420,
        choices={"flows": Several(Between(1.0, 5.5, usual=5.0, digits=1), 3, 5), "water": Between(155, 390, usual=200, digits=0)},
        plant=lambda chosen: Tank(chosen.water, drawing(chosen)),
        script=[READY, Do({"Reset": 1}, when="PumpA", after=5.0, hold=0.5)],
        draws=1,
    ),
    Scenario(
        "peak",
        "For a while they draw more than one pump brings",
        seconds=160,
        choices={"peak": Between(14.0, 20.0, usual=16.0, digits=1), "lasts": Between(15.0, 30.0, usual=26.0, digits=0)},
        plant=lambda chosen: Tank(170.0, ((5.0, 2.0), (chosen.lasts, chosen.peak), (60.0, 6.0), (60.0, 5.0))),
        script=[READY],
        draws=2,
    ),
    Scenario(
        "trip",
        "A pump trips while it fills, and is mended later; then the other one",
        seconds=280,
        choices={"pump": OneOf("A", "B"), "after": Between(0.1, 20.0, usual=8.0), "mended": Between(2.0, 60.0, usual=4.0)},
        plant=lambda chosen: Tank(160.0, ((100.0, 4.0), (100.0, 5.0))),
        script=lambda chosen: [
            READY,
            Do(fail=f"{chosen.pump} trips", when=f"Pump{chosen.pump}", after=chosen.after),
            Do(mend=f"{chosen.pump} trips", after=chosen.mended),
            Do(when=f"not {RUNS}"),
            Do(fail=f"{OTHER[chosen.pump]} trips", when=f"Pump{OTHER[chosen.pump]}", after=chosen.after),
            Do(mend=f"{OTHER[chosen.pump]} trips", after=chosen.mended),
        ],
        draws=2,
    ),
    Scenario(
        "one-pump",
        "One pump has tripped from the beginning, and the consumers draw much",
        seconds=100,
        choices={"pump": OneOf("A", "B")},
        plant=lambda chosen: Tank(70.0, ((4.0, 8.0), (60.0, 2.0))),
        script=lambda chosen: [Do(fail=f"{chosen.pump} trips", at=0.0), READY],
        draws=0,
    ),
    Scenario(
        "one-pump-b",
        "The same with the other pump, at the bottom",
        seconds=80,
        plant=lambda chosen: Tank(40.0, ((60.0, 2.0),)),
        script=[Do(fail="B trips", at=0.0), READY],
        draws=0,
    ),
    Scenario(
        "leak",
        "The tank springs a leak; it is mended, and the alarm is reset",
        seconds=190,
        choices={
            "from": Between(1.0, 40.0, usual=5.0),
            "reset": Between(1.0, 20.0, usual=8.0),
            "pressed": Between(0.3, 2.0, usual=0.5),
            "early": Between(5.0, 30.0, usual=12.0),
        },
        plant=lambda chosen: Tank(170.0, ((50.0, 4.0), (50.0, 6.0))),
        script=lambda chosen: [
            READY,
            Do(fail="leak", at=getattr(chosen, "from")),
            Do({"Reset": 1}, when="not Low", after=chosen.early, hold=0.5),
            Do({"Auto": 0}, when="Alarm", after=2.0),
            Do({"Auto": 1}, after=3.0),
            Do(mend="leak", after=chosen.reset),
            Do({"Reset": 1}, after=1.0, hold=chosen.pressed),
        ],
        draws=2,
    ),
    Scenario(
        "no-water",
        "A pump brings no water: the alarm comes with the water between the switches, and it waits for Low after Reset",
        seconds=190,
        plant=lambda chosen: Tank(160.0, ((4.0, 3.0), (18.0, 0.0), (20.0, 5.0), (60.0, 0.0), (10.0, 9.0))),
        script=[
            Do(fail="A blocked", at=0.0),
            READY,
            Do(mend="A blocked", when="not Low", after=50.0),
            Do({"Reset": 1}, when="Alarm", after=5.0, hold=0.5),
        ],
        draws=0,
    ),
    Scenario(
        "by-hand",
        "Auto is switched off and on while it fills, and between the switches",
        seconds=130,
        choices={
            "fills": Between(0.5, 18.0, usual=15.0),
            "off": Between(0.5, 8.0, usual=2.0),
            "water": Between(20, 140, usual=120, digits=0),
        },
        plant=lambda chosen: Tank(chosen.water, ((60.0, 3.0), (60.0, 5.0))),
        script=lambda chosen: [
            Do({"Auto": 1}, at=3.0),
            Do({"Auto": 0}, when=RUNS, after=chosen.fills),
            Do({"Auto": 1}, after=chosen.off),
            Do({"Auto": 0}, when="High", after=5.0),
            Do({"Auto": 1}, after=chosen.off),
        ],
        draws=2,
    ),
)

RULES = (
    Never(
        "fills",
        "From Low to High a pump runs",
        f"{FILLING} and (OkA or OkB) and not {RUNS}",
        grace=ANSWER,
        needs=FILLING,
        expected="A pump ON within 0.2 s of Low OFF, and without a gap until High.",
    ),
    Never(
        "not-between",
        "No pump starts between Low and High, and none runs above High",
        f"{RUNS} and Auto and not Alarm and not {FILLING}",
        grace=ANSWER,
        needs=f"{RUNS} and Low",
        expected="No pump ON but from Low OFF to High ON.",
    ),
    Never(
        "both",
        "Below Bottom both pumps run, until High",
        f"{BOTH} and OkA and OkB and not (PumpA and PumpB)",
        grace=ANSWER,
        needs=f"{BOTH} and OkA and OkB",
        expected="PumpA and PumpB ON within 0.2 s of Bottom OFF, until High.",
    ),
    Never("one", "Above Bottom one pump is enough", f"PumpA and PumpB and not {BOTH}", grace=ANSWER, needs=f"{RUNS} and not {BOTH}"),
    Order("turns", "They take turns, and pump A begins", ("PumpA", "PumpB"), scenarios=("day",)),
    Never(
        "tripped",
        "A pump that has tripped is OFF",
        "(PumpA and not OkA) or (PumpB and not OkB)",
        grace=ANSWER,
        needs=f"{RUNS} and not (OkA and OkB)",
    ),
    Never("by-hand", "Nothing runs with Auto OFF", f"{RUNS} and not Auto", grace=ANSWER, needs=f"count({RUNS}) > 0 and not Auto"),
    Lasts(
        "leak",
        "A filling ends at High, or with an alarm after 60 s",
        FILLING,
        59.7,
        60.4,
        unless="High or not Auto",
        expected="Alarm after 60 s without High, and not before.",
    ),
    Never("quiet", "Nothing runs in an alarm", f"{RUNS} and Alarm", grace=ANSWER, needs="Alarm"),
    Never(
        "no-false-alarm",
        "There is no alarm without a filling of 60 s",
        f"rise(Alarm) and not between(held({FILLING}, 59.6), not Auto or rise(Reset))",
        needs=FILLING,
    ),
    Never("alarm-stays", "The alarm stays until Reset", "fall(Alarm) and not Reset", needs="Alarm"),
    Never("reset", "Reset ends the alarm", "Alarm and held(Reset, 0.2)", needs="fall(Alarm)"),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Tank",
    plant=Tank,
    quantities=("water", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    scan_ms=20,
    picture=PICTURE,
)
