"""Scans that are passed over leave no trace: every run is the same as if they had been done."""

import random
from dataclasses import dataclass, field

import pytest
from ecsim_exercises.plant import Machine, Point

import ecsim
from ecsim.grading import Do, Exercise, Never, Scenario, find_exercise
from ecsim.grading.edits import edits
from ecsim.grading.grade import Stage, runs_of
from ecsim.grading.rest import Rest
from ecsim.models import model_in

MIXER = find_exercise("mixer")
PROGRAMS = MIXER.solutions | {name: text for name, (text, _) in MIXER.mistakes.items()} | {"runs_over": "LD M2\nSET Y1"}


def traces(exercise, program, monkeypatch, passing):
    """What each run noted, and how many scans the program was left out."""
    passed = []
    with monkeypatch.context() as patched:
        put_forward = Rest.pass_over
        patched.setattr(Rest, "pass_over", lambda rest, count: (passed.append(count), put_forward(rest, count))[1])
        if not passing:
            patched.setattr(Rest, "scans", lambda rest, most: 0)
        stage = Stage(exercise, program)
        found = [stage.run(scenario, values)[0] for scenario, values in runs_of(exercise)]
    return [(trace.end, trace.scans, trace.rows) for trace in found], sum(passed)


@pytest.mark.parametrize("name", ["solution", "latches", "chart.h2u", "always_washes", "drain_stays_open", "both_additives", "runs_over"])
def test_the_mixer_s_runs_are_the_same(name, monkeypatch):
    program = ecsim.compile(PROGRAMS[name], model_in(name))
    quick, passed = traces(MIXER, program, monkeypatch, True)
    whole, none = traces(MIXER, program, monkeypatch, False)
    assert quick == whole
    assert none == 0
    assert passed > 0.9 * sum(end for end, _, _ in whole)  # it is worth it


@pytest.mark.parametrize("number", range(3))
def test_the_mixer_s_first_run_is_the_same_with_a_slip_of_the_hand(number, monkeypatch):
    chance = random.Random(number)
    scenario = MIXER.scenarios[0]
    task = Exercise(MIXER.folder, "Mixer", MIXER.plant, [scenario], MIXER.rules[:1], MIXER.quantities, scan_ms=MIXER.scan_ms)
    tried = 0
    while tried < 2:
        try:
            program = ecsim.compile(chance.choice(list(edits(MIXER.solution))).text)
        except ecsim.ProgramError:
            continue
        assert traces(task, program, monkeypatch, True)[0] == traces(task, program, monkeypatch, False)[0]
        tried += 1


WIRING = {"X0": Point("Start", "start"), "X1": Point("Stop", "stop"), "Y0": Point("Lamp", "lamp"), "Y1": Point("Late", "late lamp")}


class Lamp(Machine):
    """A machine that does nothing."""

    wiring = WIRING
    DRIVES = ("Y0", "Y1")
    still = 1e9

    def _plan(self):
        return 1e9


SCRIPT = [Do({"Start": 1}, at=3.33, hold=0.5), Do({"Stop": 1}, after=100.1, hold=20), Do(when="Late", after=7.77, set={"Start": 1})]


@pytest.mark.parametrize(
    ("program", "rests"),
    [
        ("LD X0\nOR M0\nANI X1\nOUT M0\nOUT Y0\nTON T0 600\nLD T0\nOUT Y1", True),
        ("LD X0\nTOF T0 600\nLD T0\nOUT Y0\nLD X1\nTMON T1 77\nLD T1\nOUT Y1", True),
        ("LD X0\nTONR T0 3\nLD T0\nOUT Y0\nLD X1\nCTU C0 1\nLD C0\nOUT Y1", True),
        ("LD X0\nSET M0\nLD M0\nMOV 250 D0\nTON T0 D0\nLD T0\nOUT Y1\nLDI T0\nTON T1 31\nLD T1\nOUT Y0", True),
        ("LDI T0\nTON T0 5\nLD T0\nEU\nINC D0\nLD= D0 7\nOUT Y0", True),  # a clock of its own
        ("LD SM0\nINC D0\nLD>= D0 30000\nOUT Y0", False),  # counts scans
        ("LD SM12\nOUT Y0", False),  # reads a clock
        ("LD SM0\nTON T0 30000\nLD>= T0 77\nOUT Y0", False),  # reads the value of a timer
        ("LD M1\nINV\nOUT M1\nLD M1\nOUT Y0", False),  # toggles
        ("LD SM0\nTON T252 20000\nLD T252\nOUT Y0", False),  # a timer by interrupt
        ("LD SM0\nTRD D0\nLD>= D5 30\nOUT Y0", False),  # reads the clock
    ],
)
def test_programs_that_wait_are_put_forward_and_others_are_not(program, rests, tmp_path, monkeypatch):
    waiting = Scenario("waits", "It waits", 900, script=SCRIPT)
    task = Exercise(tmp_path, "Lamp", Lamp, [waiting], [Never("nothing", "Nothing", "Lamp and not Lamp")])
    compiled = ecsim.compile(program)
    quick, passed = traces(task, compiled, monkeypatch, True)
    whole, _ = traces(task, compiled, monkeypatch, False)
    assert quick == whole
    assert (passed > 0) is rests


SCALE = {"X0": Point("Full", "full"), "X1": Point("Go", "go"), "Y0": Point("Fill", "fill"), "Y1": Point("Late", "late lamp")} | {
    "D0": Point("Weight", "kg"), "D1": Point("Goal", "what the operator wants, in kg"),
}  # fmt: skip


@dataclass
class Scale(Machine):
    """A vessel on a scale that tells whole kg: 7 kg/s come in while Y0 is ON, 2 kg/s leave while it is OFF."""

    wiring = SCALE
    DRIVES = ("Y0", "Y1")

    weight: float = field(default=0.0, init=False)

    def _plan(self):
        self._tell()
        return 1e9

    def _move(self, seconds):
        self.weight = max(0.0, self.weight + (7 if self._outputs[0] else -2) * seconds)
        self._tell()

    def _tell(self):
        self.inputs = {"X0": int(self.weight >= 400), "D0": int(self.weight)}


# What the operator waits for while the machine goes on alone; the second holds at once.
WEIGHED = [
    Do({"Go": 1, "Goal": 250}, at=2.22),
    Do(when="Weight > 111", after=3.33, set={"Goal": 333}),
    Do(when="1", set={"Go": 0}, after=150.1),
]
FILLS = "LD X1\nAND< D0 D1\nOUT Y0\n"


@pytest.mark.parametrize(
    ("program", "rests"),
    [
        (FILLS, True),
        ("LD X1\nANI M0\nAND<> D0 123\nOUT Y0\nLD>= D0 300\nOR M0\nAND> D0 100\nOUT M0", True),
        (FILLS + "LD Y0\nTONR T0 10\nLD>= D0 77\nAND< D0 200\nTONR T1 90\nLD T1\nOUT Y1", True),  # what it keeps of a time
        (FILLS + "LD= D0 0\nTON T0 20\nLD T0\nOUT Y1", True),
        (FILLS + "LDI X0\nTOF T0 55\nLD T0\nOUT Y1", True),
        (FILLS + "LD SM0\nMOV D0 D5\nLD> D5 99\nOUT Y1", False),  # keeps what is weighed
        (FILLS + "LDD> D0 99\nOUT Y1", False),  # reads it together with its neighbour
        (FILLS + "LD SM0\nBMOV D0 D10 3\nLD> D10 99\nOUT Y1", False),  # reads it as one of several
        (FILLS + "LD> D0 D3\nOUT Y1\nLD SM0\nADD D0 0 D3", False),
        (FILLS + "LD X1\nTON T0 K4M0\nLD T0\nOUT Y1", False),
        (FILLS + "LD SM15\nOUT Y1", False),  # toggles with each scan
    ],
)
def test_a_machine_goes_on_alone_where_its_weight_is_only_compared(program, rests, tmp_path, monkeypatch):
    task = Exercise(
        tmp_path, "Scale", Scale, [Scenario("fills", "It fills", 300, script=WEIGHED)], [Never("nothing", "Nothing", "Fill and not Fill")]
    )
    compiled = ecsim.compile(program)
    quick, passed = traces(task, compiled, monkeypatch, True)
    whole, _ = traces(task, compiled, monkeypatch, False)
    assert quick == whole
    assert len(whole[0][2]) > 300  # it was weighed
    assert (passed > 13_000) is rests  # of 30,000; the others rest between two whole kg


def test_the_plc_is_the_same_after_scans_without_its_program(tmp_path, monkeypatch):
    task = Exercise(
        tmp_path, "Scale", Scale, [Scenario("fills", "It fills", 300, script=WEIGHED)], [Never("nothing", "Nothing", "Fill and not Fill")]
    )
    compiled = ecsim.compile(FILLS + "LD Y0\nTONR T0 900\nLDI Y0\nTON T1 77\nLD T1\nCTU C0 5")

    def after(scans, passing):
        with monkeypatch.context() as patched:
            if not passing:
                patched.setattr(Rest, "scans", lambda rest, most: 0)
            _, plc = Stage(task, compiled).run(task.scenarios[0], {}, scans)
        plc.scan(20)  # what a scan sets anew is no difference
        state = plc.snapshot()
        return state["memory"], state["clock"], state["plc"]["scans"]

    for scans in (1234, 7001, 20_002, 25_555):
        assert after(scans, True) == after(scans, False)


def test_a_sensor_with_a_fault_ends_it(tmp_path, monkeypatch):
    script = [*WEIGHED[:2], Do(when="Weight > 150", fail="X0 delayed 2"), Do(after=100, mend="all"), Do(fail="D0 stuck 7"), *WEIGHED[2:]]
    task = Exercise(
        tmp_path, "Scale", Scale, [Scenario("fills", "It fills", 300, script=script)], [Never("nothing", "Nothing", "Fill and not Fill")]
    )
    compiled = ecsim.compile("LD X1\nANI X0\nOUT Y0\nLD> D0 170\nOUT Y1")
    quick, passed = traces(task, compiled, monkeypatch, True)
    assert quick == traces(task, compiled, monkeypatch, False)[0]
    assert 0 < passed < 25_000
