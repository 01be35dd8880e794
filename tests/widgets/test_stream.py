"""When frames go out."""

from ecsim_widgets.stream import ACK_EVERY, PERIOD_S, SILENCE_S, SILENT_PERIOD_S, Stream


class Clock:
    """A clock that the test turns."""

    now_s = 100.0

    def __call__(self):
        return self.now_s


def frames_in(stream, clock, duration_s, acknowledge=False):
    """Offer a frame every millisecond for so long; return how many went out."""
    sent = 0
    for _ in range(round(duration_s * 1000)):
        clock.now_s += 0.001
        if stream.due:
            message = stream.count()
            sent += 1
            if acknowledge and "ack" in message:
                stream.heard(message["n"])
    return sent


def started():
    clock = Clock()
    stream = Stream(clock)
    stream.heard()
    return stream, clock


def test_nothing_goes_out_before_a_page_has_come():
    clock = Clock()
    assert frames_in(Stream(clock), clock, 5) == 0


def test_an_attentive_page_gets_at_most_25_frames_a_second():
    stream, clock = started()
    sent = frames_in(stream, clock, 4, acknowledge=True)
    assert 90 <= sent <= 4 / PERIOD_S


def test_every_tenth_frame_is_to_be_acknowledged():
    stream, _ = started()
    asked = [number for number in range(1, 31) if "ack" in stream.count()]
    assert asked == [ACK_EVERY, 2 * ACK_EVERY, 3 * ACK_EVERY]


def test_a_silent_page_gets_one_frame_a_second():
    stream, clock = started()
    frames_in(stream, clock, ACK_EVERY * PERIOD_S + SILENCE_S + 0.1)
    assert stream.silent
    assert frames_in(stream, clock, 10) == 10 / SILENT_PERIOD_S


def test_a_page_that_answers_again_gets_all_frames_again():
    stream, clock = started()
    frames_in(stream, clock, 10)
    stream.heard(stream.number)
    assert not stream.silent
    assert frames_in(stream, clock, 1, acknowledge=True) > 20


def test_an_old_acknowledgement_does_not_count_for_a_later_frame():
    stream, clock = started()
    frames_in(stream, clock, ACK_EVERY * PERIOD_S + SILENCE_S + 0.1)
    stream.heard(1)
    assert stream.silent
