"""Both engines give every program the same meaning: random programs, run side by side, compared device by device after each scan.

A longer run of the same is `bench/soak.py`.
"""

import random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ecsim.instructions import TABLE

from .random_programs import random_program
from .side_by_side import Differ, Machines, run_side_by_side

CHANCE = st.randoms(use_true_random=False)
MODELS = ("EC10", "EC20")
QUICK = settings(max_examples=40, suppress_health_check=list(HealthCheck), database=None)


@QUICK
@given(CHANCE, st.sampled_from(MODELS))
def test_both_engines_reach_the_same_state_after_every_scan(chance, model):
    run_side_by_side(random_program(chance, 2, model), chance, 8, model)


@pytest.mark.parametrize("seed", range(4))
def test_in_longer_programs_too(seed):
    chance, model = random.Random(seed), MODELS[seed % 2]
    run_side_by_side(random_program(chance, 20, model), chance, 10, model)


def test_the_random_programs_meet_every_instruction():
    met = {
        line.split()[0] for model in MODELS for seed in range(150) for line in random_program(random.Random(seed), 12, model).splitlines()
    }
    known = {mnemonic for mnemonic, row in TABLE.items() if set(MODELS) & set(row.models)}
    missing = known - met
    assert len(missing) <= len(known) // 20, missing  # chance may leave out a few


def test_the_comparison_sees_a_difference():
    machines = Machines("LD X0\nOUT Y0\nLD X1\nTON T0 5", 10, "EC20")
    machines.each(lambda plc: plc.scan())
    machines.compare(0)
    machines.plcs["stepping"].memory.lists["Y"][3] = True
    with pytest.raises(Differ, match=r"compiled / stepping: Y\[3\]: False / True"):
        machines.compare(0)
