"""What happens to the bottle machine when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Count, Do, Exercise, Never, OneOf, Scenario, Several, Within

from .picture import PICTURE
from .plant import KINDS, BottleMachine

BUSY = "(Capper or Labeller or Reject)"
HOME = "(CapHome and LabHome and RejHome)"
BEGIN_S = 0.5  # the stations begin so soon after the table stands
HAND_OVER = 1  # scan
STARTING = 2  # scans until the switches that are ON from the start have come through the input filter
TIMES = {"table_s": Between(0.7, 2.0, usual=1.0), "strokes": Several(Between(0.3, 1.2), 3, 3, usual=[0.6, 0.5, 0.4])}
STATIONS = 14  # until eight bottles are past all stations


def machine(chosen):
    """The machine with the bottles and the times of a scenario."""
    return BottleMachine(tuple(chosen.bottles), chosen.seed, chosen.table_s, tuple(chosen.strokes))


def held(when, fault, seconds):
    """A cylinder stays where it is for some seconds."""
    return [
        Do(when=when, fail=fault),
        Do(after=seconds, mend=fault),
    ]


SCENARIOS = (
    Scenario(
        "mixed",
        "Good and faulty bottles, and places without one",
        seconds=90,
        choices={
            "bottles": Several(OneOf(*KINDS), 5, 8, usual=["good", "good", "bad cap", "gap", "good", "bad label", "good"]),
            "seed": Between(1, 99, digits=0),
            **TIMES,
        },
        plant=machine,
        until=f"turned >= {STATIONS}",
    ),
    Scenario(
        "good",
        "Nothing but good bottles",
        seconds=60,
        choices=TIMES,
        plant=lambda chosen: BottleMachine(("good",) * STATIONS, table_s=chosen.table_s, stroke_s=tuple(chosen.strokes)),
        until="turned >= 11",
        draws=1,
    ),
    Scenario(
        "held",
        "One cylinder after the other stays where it is for some seconds",
        seconds=60,
        choices={"seconds": Between(1.0, 5.0, usual=2.0), "moment": OneOf("out", "on its way")},
        plant=lambda chosen: BottleMachine(("good", "bad cap", "good", "good")),
        script=lambda chosen: [
            act
            for out, way, fault in (
                ("CapOut", "Capper and not CapHome", "capper jams"),
                ("LabOut", "Labeller and not LabHome", "labeller jams"),
                ("RejOut", "Reject and not RejHome", "reject jams"),
            )
            for act in held(out if chosen.moment == "out" else way, fault, chosen.seconds)
        ],
        until="turned >= 9",
        draws=2,
    ),
    Scenario(
        "stuck",
        "The table stays where it is for some seconds, halfway between two stations",
        seconds=40,
        choices={"seconds": Between(1.0, 6.0, usual=3.0), "after": Between(0.2, 0.8, usual=0.4)},
        script=lambda chosen: [
            Do(when="turned >= 2 and Table and not Station"),
            Do(after=chosen.after, fail="table jams"),
            Do(after=chosen.seconds, mend="table jams"),
        ],
        until="turned >= 7",
        draws=1,
    ),
)

RULES = (
    Never(
        "table-stands",
        "The table stands while a cylinder is driven or has not returned",
        f"Table and ({BUSY} or not {HOME})",
        grace=STARTING,
        needs="Capper",
        expected="Table off while any of the cylinders is driven or not home, but for the scan of a hand-over.",
    ),
    Within(
        "stops",
        "The table stops at a station where something is to be done",
        "fall(held(not Station, 0.2)) and (Bottle or straight or faulty)",
        "not Table",
        0.05,
        expected="Table off as soon as Station comes ON.",
    ),
    Never(
        "whole-way",
        "The table does not stop between two stations",
        "fall(Table) and not Station",
        needs="fall(Table)",
        expected="Table on until Station comes ON.",
    ),
    Within(
        "turns-on",
        "When all stations are done, the table turns on",
        f"rise({HOME})",
        f"Table or {BUSY}",
        1.0,
        expected="Table within 1 s after the last cylinder has returned.",
    ),
    Within(
        "nothing-to-do",
        "Where nothing is to be done, the table turns on at once",
        "fall(Table)",
        f"Table or {BUSY}",
        1.0,
        expected="A cylinder or the table ON within 1 s after the table has stopped.",
    ),
    Within("caps", "A bottle is capped", "fall(Table) and Bottle", "Capper", BEGIN_S),
    Never("none-uncapped", "No bottle leaves the capper without its stroke", "uncapped > 0", needs="Capper"),
    Never("no-bottle-no-cap", "Without a bottle nothing is capped", "Capper and not Bottle", grace=HAND_OVER, needs="Capper"),
    Within(
        "labels",
        "A bottle whose cap is straight is labelled",
        "fall(Table) and straight",
        "Labeller",
        BEGIN_S,
        expected="Labeller within 0.5 s after the table stands: the cap was straight one station before.",
    ),
    Never("none-unlabelled", "No bottle with a straight cap leaves the labeller without its stroke", "unlabelled > 0", needs="Labeller"),
    Never(
        "bad-cap-no-label",
        "A bottle whose cap is not straight, and an empty place, are not labelled",
        "Labeller and not straight",
        grace=HAND_OVER,
        needs="Labeller",
        expected="Labeller off: there is no bottle with a straight cap before it.",
    ),
    Within(
        "rejects",
        "A faulty bottle is rejected",
        "fall(Table) and faulty",
        "Reject",
        BEGIN_S,
        expected="Reject within 0.5 s after the table stands: cap or label were faulty at the stations before.",
    ),
    Never("none-escapes", "No faulty bottle gets past the reject cylinder", "escaped > 0", needs="faulty"),
    Never(
        "good-stays",
        "A good bottle is not rejected",
        "Reject and sound",
        grace=HAND_OVER,
        needs="sound",
        expected="Reject off: cap and label of this bottle were right.",
    ),
    Count("one-cap", "The capper works once while the table stands", "Capper", most=1, within="not Table"),
    Count("one-label", "The labeller works once while the table stands", "Labeller", most=1, within="not Table"),
    Count("one-reject", "The reject cylinder works once while the table stands", "Reject", most=1, within="not Table"),
    Never(
        "full-stroke",
        "A cylinder goes out until its stroke is reached",
        "fall(Capper) and not CapOut or fall(Labeller) and not LabOut or fall(Reject) and not RejOut",
        needs=f"fall{BUSY}",
        expected="Each output on until the switch of its stroke comes ON.",
    ),
    Never(
        "returns",
        "A cylinder that is out returns",
        "Capper and held(CapOut, 0.2) or Labeller and held(LabOut, 0.2) or Reject and held(RejOut, 0.2)",
        needs="CapOut",
        expected="The output off within 0.2 s after the stroke is reached.",
    ),
    Never("nothing-amiss", "No cylinder strikes the table, and the table turns against none", "incidents", needs="passed > 0"),
    Count(
        "goes-on",
        "One bottle after the other goes through the machine",
        "Station",
        least=10,
        scenarios=("mixed", "good"),
        expected="The table turns to ten stations and more.",
    ),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Bottle machine",
    plant=BottleMachine,
    quantities=("turned", "straight", "faulty", "sound", "uncapped", "unlabelled", "escaped", "passed", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
