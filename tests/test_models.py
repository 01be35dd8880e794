"""EC10 and EC20 as data, against the tables of chapters 1 to 3 and the appendices 1 and 2 (a copy stands in tests/facts)."""

import json
from pathlib import Path

import pytest

from ecsim.hardware.faults import MEANINGS
from ecsim.models import MODELS, get_model

FACTS = json.loads((Path(__file__).parent / "facts" / "system.json").read_text(encoding="utf-8"))


@pytest.fixture(params=sorted(name for name, model in MODELS.items() if model.family == "EC"))
def model(request):
    """Each model in turn."""
    return get_model(request.param)


def test_a_model_has_the_devices_of_the_manual(model):
    facts = FACTS["models"][model.name]
    assert {area.name: area.count for area in model.areas.values()} == facts["device_counts"]
    assert {area.name: area.span for area in model.areas.values()} == {
        name: f"{first} to {last}" for name, (first, last) in facts["devices"].items()
    }


def numbers(runs):
    """T0 to T209 as numbers."""
    first, last = (int(name[1:]) for name in runs)
    return range(first, last + 1)


def test_timers_have_the_units_of_the_manual(model):
    timers = FACTS["models"][model.name]["timers"]
    for name, base in (("100ms", 100_000), ("10ms", 10_000), ("1ms", 1_000)):
        assert {model.timer_base_us(n) for n in numbers(timers[name])} == {base}
    assert range(model.fast_timers[0], model.fast_timers[1] + 1) == numbers(timers["1ms"])


def test_counters_and_steps_are_divided_as_in_the_manual(model):
    facts = FACTS["models"][model.name]
    assert model.wide_counters == numbers(facts["counters"]["32bit_updown"]).start
    assert model.initial_steps == numbers(facts["states"]["initial"]).stop


def expand(rows):
    """Every number of the rows' addresses, with its row."""
    for row in rows:
        first, _, last = row["address"].replace("..", "-").partition("-")
        start = int(first.lstrip("SMD"))
        for number in range(start, int(last.lstrip("SMD") or start) + 1 if last else start + 1):
            yield number, row


@pytest.mark.parametrize("kind", ["sm", "sd"])
def test_what_only_the_system_writes_is_read_only(model, kind):
    fixed = model.read_only_relays if kind == "sm" else model.read_only_registers
    facts = {number for number, row in expand(FACTS[kind]) if model.name in row["models"] and row["access"] == "R"}
    writable = {number for number, row in expand(FACTS[kind]) if model.name in row["models"] and row["access"] != "R"}
    assert sorted(facts - fixed) == []
    assert sorted(fixed & writable) == []


def test_errors_have_words():
    codes = {row["code"] for row in FACTS["errors"] if row["code"] >= 40}
    assert codes - set(MEANINGS) == set()


def test_models_are_found_in_any_case_and_handed_through(model):
    assert get_model(model.name.lower()) is model
    assert get_model(model) is model
