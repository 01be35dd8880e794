"""What happens to the feed table when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Do, Exercise, Never, OneOf, Scenario, Several, Within

from .picture import PICTURE
from .plant import Axis

OFF = "(not StopPB or not Front or not Rear)"  # what ends every movement
READY = Do({"StopPB": 1}, at=0.0)  # the stop button is not pressed
PRESS_S = 0.2
HOME_AT, HOMED_AT = 1.0, 12.5  # a return is ordered, and done at the latest


def press(button, at):
    """A button, pressed for a moment."""
    return Do({button: 1}, at=round(at, 2), hold=PRESS_S)


def press_stop(at):
    """The stop button, pressed for a moment."""
    return [Do({"StopPB": 0}, at=round(at, 2)), Do({"StopPB": 1}, after=0.6)]


def by_hand(place, at):
    """Somebody turns the screw by hand until the table stands at a place."""

    def turn(plc, plant):
        plant.stand_at(place)

    return Do(act=turn, at=at)


def standing_at(chosen):
    """The table where the scenario begins."""
    return Axis(position=chosen.start)


def at(place):
    """The lamp, and the place where the table stands then."""
    return f"AtPlace and not moving and position > {place - 0.5} and position < {place + 0.5}"


SCENARIOS = (
    Scenario(
        "places",
        "It finds its origin and goes from place to place",
        seconds=lambda chosen: HOMED_AT + 5 * len(chosen.orders) + 1,
        choices={
            "start": Between(30.0, 380.0, usual=120.0, digits=1),
            "orders": Several(OneOf("To50", "To200"), 3, 5, usual=["To200", "To50", "To50", "To200"]),
        },
        plant=standing_at,
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            *[press(order, HOMED_AT + 5 * place) for place, order in enumerate(chosen.orders)],
        ],
        draws=1,
    ),
    Scenario(
        "again",
        "A second return, from one of the places",
        seconds=30,
        choices={"start": Between(30.0, 380.0, usual=60.0, digits=1), "order": OneOf("To200", "To50")},
        plant=standing_at,
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            press(chosen.order, HOMED_AT),
            press("Origin", HOMED_AT + 5),
        ],
        draws=1,
    ),
    Scenario(
        "unknown",
        "Places are asked for before the origin was found",
        seconds=16,
        choices={"order": OneOf("To50", "To200")},
        script=lambda chosen: [READY, press(chosen.order, 1.0), press("Origin", 4.0)],
        draws=1,
    ),
    Scenario(
        "busy",
        "Buttons are pressed while it moves",
        seconds=20,
        choices={"return_at": Between(0.4, 2.0, usual=1.0), "move_at": Between(0.3, 1.5, usual=0.8), "other": OneOf("To50", "Origin")},
        plant=lambda chosen: Axis(position=200.0),
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            press("To200", HOME_AT + chosen.return_at),
            press("To200", HOMED_AT),
            press(chosen.other, HOMED_AT + chosen.move_at),
        ],
        draws=1,
    ),
    Scenario(
        "stop-return",
        "Stop during the return; then a place, which is not known; then another return",
        seconds=24,
        choices={"stop": Between(0.3, 2.5, usual=1.0)},
        plant=lambda chosen: Axis(position=200.0),
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            *press_stop(HOME_AT + chosen.stop),
            press("To50", 7.0),
            press("Origin", 12.0),
        ],
        draws=1,
    ),
    Scenario(
        "stop-move",
        "Stop on the way to a place; the position is known as before",
        seconds=24,
        choices={"stop": Between(0.3, 1.5, usual=0.8), "order": OneOf("To50", "To200")},
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            press("To200", HOMED_AT),
            *press_stop(HOMED_AT + chosen.stop),
            press(chosen.order, HOMED_AT + 6),
        ],
        draws=1,
    ),
    Scenario(
        "stop-held",
        "Buttons are pressed while Stop is held",
        seconds=20,
        choices={"order": OneOf("To200", "To50")},
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            Do({"StopPB": 0}, at=HOMED_AT),
            press(chosen.order, HOMED_AT + 1),
            press("Origin", HOMED_AT + 2.5),
            Do({"StopPB": 1}, at=HOMED_AT + 4),
        ],
        draws=1,
    ),
    Scenario(
        "behind",
        "It stands behind the near-point switch, and the return runs to the rear limit switch",
        seconds=24,
        choices={"start": Between(-16.0, -3.0, usual=-8.0, digits=1), "place": Between(30.0, 300.0, usual=60.0, digits=1)},
        plant=standing_at,
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            press("Origin", 4.0),
            by_hand(chosen.place, 7.0),
            press("To50", 9.0),
            press("Origin", 11.0),
        ],
        draws=1,
    ),
    Scenario(
        "by-hand",
        "The table is turned by hand beyond the front limit switch and back again",
        seconds=36,
        choices={"place": Between(60.0, 380.0, usual=300.0, digits=1)},
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            press("To200", HOMED_AT),
            by_hand(402.0, 16.0),
            press("To50", 17.0),
            press("Origin", 18.5),
            by_hand(chosen.place, 20.0),
            press("To50", 21.0),
            press("Origin", 24.0),
        ],
        draws=1,
    ),
    Scenario(
        "wire",
        "On the way to a place the wire of a limit switch breaks; it is mended",
        seconds=32,
        choices={"breaks": Between(0.5, 1.5, usual=0.8), "wire": OneOf("front wire", "rear wire")},
        script=lambda chosen: [
            READY,
            press("Origin", HOME_AT),
            press("To200", HOMED_AT),
            Do(at=round(HOMED_AT + chosen.breaks, 2), fail=chosen.wire),
            press("Origin", 15.0),
            Do(at=17.0, mend=chosen.wire),
            press("To50", 18.0),
            press("Origin", 19.5),
        ],
        draws=1,
    ),
)

ALONE = ("places", "again", "stop-move", "by-hand")  # orders of places come while it stands
RULES = (
    Never("no-crash", "The table never runs against a stop", "incidents", needs="moving"),
    Never(
        "limits",
        "It stops at a limit switch and does not move while one is OFF",
        "moving and held(not Front or not Rear, 0.3)",
        needs="count(moving) > 0 and (not Front or not Rear)",
        expected="No pulses while Front or Rear is OFF, but for 0.3 s of slowing down.",
    ),
    Never(
        "stops",
        "Stop stops it",
        "moving and held(not StopPB, 0.5)",
        needs="count(moving) > 0 and not StopPB",
        expected="No pulses from 0.5 s after Stop is pressed.",
    ),
    Never(
        "no-restart",
        "It moves by a button and not by itself",
        f"moving and held(between({OFF}, Origin or To50 or To200), 0.5)",
        needs=f"count(moving) > 0 and {OFF}",
        expected="No pulses from Stop or a limit switch to the next press of a button.",
    ),
    Never(
        "held",
        "Orders that are given while Stop is held are forgotten",
        "moving and count(not StopPB) > 1 and held(StopPB, 0.1)",
        needs="count(moving) > 0 and not StopPB and (To200 or To50 or Origin)",
        scenarios=("stop-held",),
        expected="No pulses after Stop is let go.",
    ),
    Never(
        "held-known",
        "An order that is given while Stop is held does not make Known dark",
        "fall(Known)",
        needs="Known and not StopPB and Origin",
        scenarios=("stop-held",),
        expected="Known stays lit: the table has not moved.",
    ),
    Never(
        "unknown",
        "Without its origin it goes to no place",
        "moving and count(Origin) == 0",
        needs="count(moving) > 0",
        scenarios=("unknown",),
        expected="No pulses before the first press of Origin.",
    ),
    Never(
        "lost",
        "After a return that was stopped, or a limit switch, it goes to no place before the next return",
        "moving and held(between(not StopPB and count(Known) == 0 or not Front or not Rear, rise(Origin) and Front and Rear), 0.5)",
        needs="count(moving) > 0 and not moving and To50",
        scenarios=("stop-return", "behind", "by-hand", "wire"),
        expected="No pulses until Origin is pressed with both limit switches ON.",
    ),
    Within(
        "finds",
        "Origin brings the table to its origin",
        "rise(Origin) and Front and Rear and StopPB",
        "rise(Known) and position > -0.5 and position < 0.5",
        11.0,
        unless="not StopPB or not Rear",
        scenarios=("places", "again", "unknown", "stop-return", "behind", "by-hand", "wire"),
        expected="Known lights up at 0 mm within 11 s of Origin.",
    ),
    Never(
        "known-true",
        "Known lights up at the origin",
        "rise(Known) and (position < -0.5 or position > 0.5 or moving)",
        needs="Known",
        expected="The table stands within 0.5 mm of its origin when Known turns ON.",
    ),
    Never("known-dark", "Known is dark as long as no return is done", "Known and count(Near) == 0", needs="moving"),
    Never(
        "known-again",
        "Known is dark during a return",
        "Known and moving and count(Origin) == 2",
        grace=5,
        scenarios=("again",),
        needs="count(Known) > 0",
        expected="Known turns OFF when a return begins.",
    ),
    Never(
        "known-off",
        "A limit switch makes Known dark",
        "Known and (not Front or not Rear)",
        grace=5,
        scenarios=("by-hand", "wire"),
        needs="count(Known) > 0 and not (Front and Rear)",
    ),
    Within(
        "known-stays",
        "A stop on the way to a place leaves the position known",
        "fall(StopPB) and count(To200) == 1",
        "Known and StopPB",
        1.0,
        scenarios=("stop-move",),
    ),
    Never(
        "creep",
        "On the near-point switch it returns at 5 mm/s",
        "held(Near and not Known, 0.15) and speed > 6",
        needs="Near and moving",
        expected="5 mm/s at most from 0.15 s behind the begin of the near-point switch on.",
    ),
    Never(
        "return-speed",
        "A return is no faster than 50 mm/s",
        "speed > 52 and count(To50) + count(To200) == 0",
        needs="moving",
        scenarios=("places", "again"),
        expected="50 mm/s at most before the first place is asked for.",
    ),
    Never(
        "creep-time",
        "On the near-point switch it returns no slower than at 5 mm/s",
        "held(Near and moving, 3.2)",
        needs="Near and moving",
        expected="The 15 mm of the near-point switch take 3 s.",
    ),
    Within(
        "return-fast",
        "A return goes back at 50 mm/s",
        "rise(Origin)",
        "speed > 47",
        2.0,
        unless="Near",
        scenarios=("places",),
        expected="50 mm/s before the near-point switch is reached.",
    ),
    Within(
        "full-speed",
        "It goes to its places at 100 mm/s",
        "rise(To200) and count(To200) == 1",
        "speed > 95",
        2.0,
        scenarios=("places",),
        expected="100 mm/s on the way to 200 mm.",
    ),
    Never("speed", "It is never faster than 100 mm/s", "speed > 104", needs="moving", expected="100 mm/s at most."),
    Within(
        "to-50",
        "To50 brings it to 50 mm",
        "rise(To50) and count(Known) > 0 and Front and count(not Front) == 0",
        at(50),
        4.0,
        scenarios=ALONE,
    ),
    Within("to-200", "To200 brings it to 200 mm", "rise(To200) and count(Known) > 0", at(200), 4.0, unless="not StopPB", scenarios=ALONE),
    Within(
        "ignores",
        "Buttons that are pressed on its way do not turn it aside",
        "rise(To200) and count(Known) > 0",
        at(200),
        4.0,
        scenarios=("busy",),
    ),
    Never(
        "ignores-later",
        "They are not remembered either",
        "moving and (held(AtPlace, 0.1) or held(Known, 0.1) and count(To200) == 1)",
        scenarios=("busy",),
        needs="AtPlace",
        expected="No pulses when the origin, and then the place, is reached.",
    ),
    Never(
        "at-place",
        "AtPlace lights up where the table was sent, and while it stands there",
        "AtPlace and (moving or not Known or not (position > 49.5 and position < 50.5 or position > 199.5 and position < 200.5))",
        grace=5,
        needs="AtPlace",
    ),
    Within(
        "at-place-stays",
        "AtPlace stays lit as long as the table stands there",
        "fall(AtPlace)",
        "moving or AtPlace or not Front or not Rear",
        0.5,
        scenarios=("places", "again", "stop-move"),
        expected="AtPlace turns OFF when an order moves the table.",
    ),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Feed table",
    plant=Axis,
    quantities=("position", "speed", "moving", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
