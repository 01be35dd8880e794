"""Scans that are passed over leave no trace: every run is the same as if they had been done."""

import pytest
from ecsim_exercises.plant import Machine, Point

import ecsim
from ecsim.grading import Do, Exercise, Never, Scenario, find_exercise
from ecsim.grading.grade import Stage, runs_of
from ecsim.grading.rest import Rest
from ecsim.models import model_in

MIXER = find_exercise("mixer")
PROGRAMS = MIXER.solutions | {name: text for name, (text, _) in MIXER.mistakes.items()}


def traces(exercise, program, monkeypatch, passing):
    """What each usual run noted, and how many scans were passed over."""
    passed = []
    with monkeypatch.context() as patched:
        put_forward = Rest.pass_over
        patched.setattr(Rest, "pass_over", lambda rest, count: (passed.append(count), put_forward(rest, count))[1])
        if not passing:
            patched.setattr(Rest, "scans", lambda rest, most: 0)
        stage = Stage(exercise, program)
        found = [stage.run(scenario, values)[0] for scenario, values in runs_of(exercise)]
    return [(trace.end, trace.scans, trace.rows) for trace in found], sum(passed)


@pytest.mark.parametrize("name", ["solution", "chart.h2u", "always_washes", "drain_stays_open"])
def test_the_mixer_s_runs_are_the_same(name, monkeypatch):
    program = ecsim.compile(PROGRAMS[name], model_in(name))
    quick, passed = traces(MIXER, program, monkeypatch, True)
    whole, none = traces(MIXER, program, monkeypatch, False)
    assert quick == whole
    assert none == 0
    assert passed > (sum(end for end, _, _ in whole) // 4 if name in MIXER.solutions else 0)  # it is worth it


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
