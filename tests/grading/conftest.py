"""What the tests of grading share."""

import pytest
from ecsim_exercises.plant import Point

import ecsim
from ecsim.grading import Between, Do, Exercise, Never, Scenario, Within, find_exercise
from ecsim.grading.choices import usual
from ecsim.grading.run import Run


@pytest.fixture(scope="session")
def conveyor():
    return find_exercise("conveyor")


@pytest.fixture(scope="session")
def conveyor_trace(conveyor):
    """The reference program on the first scenario, as it usually goes."""
    plc = ecsim.Plc("EC20")
    plc.load(conveyor.solution)
    scenario = conveyor.scenarios[0]
    return Run(conveyor, plc, scenario, usual(scenario.choices)).to()


LAMP_RULES = (
    Within("follows", "The lamp follows the switch", "Switch and not Lock", "Lamp", 0.1),
    Never("locked", "Not while it is locked", "Lamp and Lock", 1, needs="Lamp"),
    Never("dark", "Not without the switch", "Lamp and not Switch", 1, needs="Lamp"),
)


@pytest.fixture
def lamp(tmp_path):
    """A lamp that follows a switch while a second one is off; its rules are good ones unless given."""

    class Lamp:
        wiring = {"X0": Point("Switch", "a switch"), "X1": Point("Lock", "a lock"), "Y0": Point("Lamp", "a lamp")}

        def step(self, seconds, outputs):
            return {}

    def make(*rules, text="// Follow the switch\nLD X0\nANI X1\nOUT Y0\n"):
        (tmp_path / "solution.il").write_text(text)
        script = lambda chosen: [
            Do({"Switch": 1}, at=chosen.at),
            Do({"Lock": 1}, after=1.0),
            Do({"Lock": 0}, after=1.0),
            Do({"Switch": 0}, after=1.0),
        ]
        scenario = Scenario("s", "The switches are moved", 6, script, {"at": Between(0.5, 1.5)}, draws=2)
        return Exercise(tmp_path, "Lamp", Lamp, [scenario], rules or LAMP_RULES)

    return make
