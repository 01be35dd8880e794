"""The way back: keyframes, and what was done between them."""

import pytest

from ecsim.history import EVERY, KEEP, History


class Counter:
    """A simulation of one number: a scan adds 1; an action adds something else."""

    def __init__(self):
        self.scan = self.value = 0
        self.history = History(lambda: (self.scan, self.value), self._put)
        self.frames_put = 0

    def _put(self, frame):
        self.frames_put += 1
        self.scan, self.value = frame

    def step(self):
        self.scan += 1
        self.value += 1

    def run(self, scans):
        for _ in range(scans):
            self.history.tick(self.scan)
            self.step()

    def add(self, amount):
        def action():
            self.value += amount

        self.history.note(self.scan, action)
        action()

    def back(self, scans):
        """Back for good: what came later is forgotten."""
        done = self.history.go(self.scan - scans, self.step)
        if done:
            self.history.fork(self.scan)
        return done


def test_a_step_back_undoes_a_scan():
    counter = Counter()
    counter.run(7)
    assert counter.back(1)
    assert (counter.scan, counter.value) == (6, 6)


def test_actions_between_keyframe_and_goal_are_done_again():
    counter = Counter()
    counter.run(5)
    counter.add(100)
    counter.run(5)
    counter.add(1000)
    counter.run(5)
    assert counter.back(3)
    assert (counter.scan, counter.value) == (12, 1112)
    assert counter.back(4)
    assert (counter.scan, counter.value) == (8, 108)


def test_actions_behind_the_goal_are_forgotten():
    counter = Counter()
    counter.run(5)
    counter.add(100)
    counter.run(5)
    counter.back(8)
    counter.run(8)
    assert (counter.scan, counter.value) == (10, 10)


def test_an_action_at_a_keyframe_is_done_once():
    counter = Counter()
    counter.run(EVERY)
    counter.add(100)
    counter.run(30)
    counter.back(20)
    assert (counter.scan, counter.value) == (EVERY + 10, EVERY + 110)
    counter.back(10)
    assert (counter.scan, counter.value) == (EVERY, EVERY + 100)


@pytest.mark.parametrize(("scan", "again"), [(2 * EVERY + 1, 1), (2 * EVERY + 7, 7), (2 * EVERY, EVERY), (0, 0)])
def test_the_way_leads_from_the_nearest_keyframe_and_does_the_last_scan_again(scan, again):
    counter = Counter()
    counter.run(3 * EVERY + 10)
    steps = []

    def step():
        steps.append(counter.scan)
        counter.step()

    assert counter.history.go(scan, step)
    assert (counter.scan, len(steps)) == (scan, again)


def test_without_a_fork_the_way_leads_forth_too():
    counter = Counter()
    counter.run(5)
    counter.add(100)
    counter.run(2 * EVERY)
    for scan in (3, 2 * EVERY, 4, 2 * EVERY + 5):
        assert counter.history.go(scan, counter.step)
        assert (counter.scan, counter.value) == (scan, scan + 100 * (scan >= 5))


def test_as_many_keyframes_are_kept_as_are_wanted():
    counter = Counter()
    counter.run((KEEP + 5) * EVERY)
    assert len(counter.history.frames) == KEEP
    assert counter.history.first == 5 * EVERY
    assert not counter.back(KEEP * EVERY + 1)
    assert counter.frames_put == 0
    assert counter.scan == (KEEP + 5) * EVERY
    assert counter.back(KEEP * EVERY)


def test_actions_do_not_pile_up():
    counter = Counter()
    for _ in range((KEEP + 20) * EVERY // 10):
        counter.add(1)
        counter.run(10)
    assert len(counter.history.actions) <= (KEEP + 1) * EVERY // 10


def test_nothing_is_gone_back_to_after_clearing():
    counter = Counter()
    counter.run(20)
    counter.history.clear()
    assert counter.history.first is None
    assert not counter.back(1)
    assert counter.scan == 20
