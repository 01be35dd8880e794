"""What happens to the mixer when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Count, Custom, Do, Exercise, Lasts, Never, OneOf, Order, Scenario, Several, Within

from .picture import PICTURE
from .plant import Mixer

FEEDS = "(Main or AddA or AddB)"
ANY = "(Water or Main or AddA or AddB or Drain or Stirrer)"
LETS_OUT = "between(fall(Stirrer), fall(Drain))"
BUSY = f"between(rise(Batch), fall({LETS_OUT}))"  # from the start of a batch until it is let out
STARTS = f"rise({BUSY})"
THIS = f"taken(Product, {STARTS})"  # the product of the batch under way
LAST = f"taken({THIS}, fall({BUSY}))"  # and of the one before it, 0 before the first
HAND_OVER = 2  # scans: one for the weight to arrive, one for the step to hand over
PRESS_S = 0.5


def batches(products, pauses, hold=PRESS_S):
    """The operator chooses a product and starts a batch, again when the one before is out."""
    script = []
    for number, (product, pause) in enumerate(zip(products, pauses, strict=True)):
        waits = {"when": f"finished >= {number} and not Drain", "after": pause} if number else {"at": pause}
        script += [Do({"Product": product}, **waits), Do({"Batch": 1}, after=1.0, hold=hold)]
    return script


def done(count):
    """So many batches are out and the drain has been closed."""
    return f"finished >= {count} and not Drain"


def closes_in_time(trace):
    """How long the drain stays open below 20 kg: half a minute, or no time if it was counted from the start of letting out."""
    for start, end in trace.intervals(f"Weight < 20 and Drain and {LETS_OUT}"):
        seconds, over = (end - start) * trace.period_s, end < trace.end
        if seconds > 30.6 or (over and 0.6 < seconds < 29.6):
            yield start, min(end, trace.end - 1), f"It closed {seconds:.1f} s after less than 20 kg were left."


VALVES = {"travel": Several(Between(0.5, 3.0, usual=1.5), 5, 5)}
SCENARIOS = (
    Scenario(
        "three",
        "Three batches, one after the other: A, A and B as a rule",
        seconds=8400,
        choices={"products": Several(OneOf(1, 2), 3, 3, usual=[1, 1, 2]), "pause": Between(1.0, 60.0, usual=5.0), **VALVES},
        plant=lambda chosen: Mixer(tuple(chosen.travel)),
        script=lambda chosen: batches(chosen.products, [chosen.pause] * 3),
        until=done(3),
        tail=5.0,
        draws=1,
    ),
    Scenario(
        "change",
        "The product on the screen is changed in the middle of a batch",
        seconds=2700,
        choices={
            "product": OneOf(1, 2),
            "moment": OneOf("Main", "AddA or AddB", "Weight > 1990", "Water", "Stirrer", "Weight > 2400"),
            "after": Between(0.0, 20.0, usual=1.0),
        },
        script=lambda chosen: [
            *batches([chosen.product], [2.0]),
            Do({"Product": 3 - chosen.product}, when=chosen.moment, after=chosen.after),
        ],
        until=done(1),
        tail=5.0,
        draws=1,
    ),
    Scenario(
        "impatient",
        "Batch is pressed again while the batch is under way",
        seconds=2700,
        choices={
            "product": OneOf(2, 1),
            "moment": OneOf("Stirrer", "Main", "Water", "AddA or AddB", "Drain and Weight > 20"),
            "after": Between(0.0, 100.0, usual=10.0),
            "held": Between(0.1, 30.0, usual=0.5),
        },
        script=lambda chosen: [
            *batches([chosen.product], [2.0]),
            Do({"Batch": 1}, when=chosen.moment, after=chosen.after, hold=chosen.held),
        ],
        until=done(1),
        tail=60.0,
        draws=0,
    ),
    Scenario(
        "power",
        "After a batch the power goes off and on, and the same product is made again",
        seconds=5400,
        choices={"product": OneOf(1, 2)},
        script=lambda chosen: [
            *batches([chosen.product], [2.0]),
            Do(when=done(1), after=4.0, act=lambda plc, plant: plc.power_cycle()),
            Do({"Product": chosen.product}, after=2.0),
            Do({"Batch": 1}, after=1.0, hold=PRESS_S),
        ],
        until=done(2),
        tail=5.0,
        draws=0,
    ),
)
POWERED = ("three", "change", "impatient")  # those without a power failure

RULES = (
    Never(
        "waits",
        "Nothing is open and nothing turns but during a batch",
        f"{ANY} and not {BUSY}",
        grace=HAND_OVER,
        needs="Main",
        expected="No output ON before Batch is pressed, and none after the batch is out.",
    ),
    Within(
        "wash-first",
        "Before the first batch, and when the product changes, the vessel is washed",
        f"{STARTS} and Product != {LAST}",
        "Water and Drain",
        0.4,
        scenarios=POWERED,
        expected="Water and drain open as soon as Batch is pressed.",
    ),
    Within(
        "no-wash",
        "When the product is the same as before, the main material comes at once",
        f"{STARTS} and Product == {LAST}",
        "Main",
        0.4,
        scenarios=("three",),
        expected="The main material as soon as Batch is pressed, without washing.",
    ),
    Count(
        "wash-after-power",
        "The first batch after power-on is washed for, whatever was made before",
        "held(Water and Drain, 290)",
        least=2,
        most=2,
        scenarios=("power",),
        expected="The vessel is washed before each of the two batches.",
    ),
    Lasts("wash-time", "The vessel is washed for 5 minutes", "Water and Drain", 299.8, 303.0),
    Never(
        "water-washes",
        "Water runs for washing alone",
        f"Water and (not Drain or {FEEDS} or Stirrer)",
        grace=HAND_OVER,
        needs="Water",
        expected="Water only together with the drain, and with no material.",
    ),
    Count("one-wash", "A batch is washed for once", "rise(Water)", most=1, within=BUSY),
    Within("main-after-wash", "After the wash the main material comes", "fall(Water)", "Main", 1.0),
    Never(
        "main-enough",
        "The main material stops at 2000 kg",
        "Main and Weight >= 2000",
        grace=HAND_OVER,
        needs="Main",
        expected="Main off as soon as the weight has reached 2000 kg.",
    ),
    Never(
        "main-all",
        "The main material is not stopped before 2000 kg",
        "fall(Main) and Weight < 2000",
        needs="fall(Main)",
        expected="Main on until the weight has reached 2000 kg.",
    ),
    Within("additive-follows", "After the main material an additive comes", "fall(Main)", "AddA or AddB", 1.0),
    Never(
        "main-before-additive",
        "No additive comes before the main material is in",
        "(AddA or AddB) and Weight < 2000",
        needs="AddA or AddB",
    ),
    Never(
        "right-additive",
        "The additive is that of the product chosen when the batch was started",
        f"AddA and {THIS} != 1 or AddB and {THIS} != 2",
        needs="AddA or AddB",
        expected="AddA for product 1, AddB for product 2, also when the screen shows another one by now.",
    ),
    Never(
        "additive-enough",
        "The additive stops at 2500 kg in all",
        "(AddA or AddB) and Weight >= 2500",
        grace=HAND_OVER,
        needs="AddA or AddB",
        expected="AddA and AddB off as soon as the weight has reached 2500 kg.",
    ),
    Never(
        "additive-all",
        "The additive is not stopped before 2500 kg",
        "(fall(AddA) or fall(AddB)) and Weight < 2500",
        needs="fall(AddA or AddB)",
        expected="AddA or AddB on until the weight has reached 2500 kg.",
    ),
    Within("stirs", "When all is in, the stirrer turns", "fall(AddA) or fall(AddB)", "Stirrer", 1.0),
    Lasts("stir-time", "The batch is stirred for 20 minutes", "Stirrer", 1199.8, 1203.0),
    Never(
        "drain-closed",
        "The drain is closed while the vessel is filled and stirred",
        f"Drain and ({FEEDS} or Stirrer)",
        grace=HAND_OVER,
        needs="Main and not Drain",
        expected="Drain off with any material and with the stirrer, but for the scan of a hand-over.",
    ),
    Within("lets-out", "After stirring the drain opens", "fall(Stirrer)", "Drain", 1.0),
    Never(
        "all-out",
        "The drain stays open until less than 20 kg are left",
        "fall(Drain) and Weight >= 20",
        needs="fall(Drain) and count(Stirrer) > 0",
        expected="Drain on until the weight is below 20 kg.",
    ),
    Custom(
        "drain-ends",
        "The drain closes below 20 kg at the earliest, half a minute after that at the latest",
        closes_in_time,
        watch=("Drain", "Weight"),
        needs=f"Weight < 20 and {LETS_OUT}",
        expected="Drain off 30 s after the weight has fallen below 20 kg, or at once then if the half minute counts from the start.",
    ),
    Order(
        "sequence",
        "Main material, additive, stirring, letting out: in this order, once for each batch",
        ("Main", "AddA or AddB", "Stirrer", "held(Drain and not Water, 5)"),
        expected="Main material, then the additive, then the stirrer, then the drain.",
    ),
    Count(
        "goes-on",
        "After a batch the next one can be started",
        "Stirrer",
        least=3,
        scenarios=("three",),
        expected="Three batches are stirred.",
    ),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Mixer",
    plant=Mixer,
    quantities=("finished",),
    scenarios=SCENARIOS,
    rules=RULES,
    scan_ms=100,
    picture=PICTURE,
)
