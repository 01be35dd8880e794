"""The trace: a logic analyser in simulated time. Python draws what the window shows, in pieces that are sent once."""

from __future__ import annotations

import base64
import gzip
from typing import Any

from ecsim.errors import EcsimError
from ecsim.record import interval
from ecsim.views import svg as s
from ecsim.views.labels import figure
from ecsim.views.lettering import cut, width
from ecsim.views.timing import Stretch, bit, bus, clock_text, curve, nice_range, range_text, ticks

from .panel import Part
from .rig import PREFIX, Rig
from .scope import CHUNKS, Lane, Scope

NARROWEST, WIDEST = 480, 2400
LEFT, VALUE, HEAD = 150, 64, 58  # names, a column of values, cursors and scale
HEIGHTS = {"bit": 38, "bus": 38, "steps": 38, "curve": 64}
SLOTS = CHUNKS + 1
MARK_PX = 84  # the least distance of two marks of the scale
SNAP_PX = 6
LOOK_AHEAD_PX = 170  # a piece knows what follows so far behind it
KEPT = 600  # pieces


class Trace(Part):
    """Lanes over time, with cursors and a trigger; several panels of one simulation show the same scope."""

    key = "trace"

    def __init__(self, rig: Rig):
        super().__init__(rig)
        if rig.scope is None:
            rig.scope = Scope(rig, rig.traced)
        self.scope: Scope = rig.scope
        self.scope.follow_program()
        self.width = 960
        self.said = ""
        self._pieces: dict[tuple, tuple[Any, tuple[str, str]]] = {}
        self._drawn: tuple[tuple, str] = ((), "")
        self._now = 0

    # -- the drawing --------------------------------------------------------------------------------------------

    @property
    def plot(self) -> int:
        """The width of the lanes, in px: a multiple of the pieces."""
        return (self.width - LEFT - 2 * VALUE - 22) // CHUNKS * CHUNKS

    def _tops(self) -> list[int]:
        tops = [HEAD]
        for lane in self.scope.lanes:
            tops.append(tops[-1] + HEIGHTS[lane.style])
        return tops

    def _skeleton(self) -> str:
        """What stands still while the window moves: names, rules, and the places that a frame fills."""
        shape = (self.width, tuple((lane.name, lane.style) for lane in self.scope.lanes), self.rig.program)
        if shape == self._drawn[0]:
            return self._drawn[1]
        tops, right = self._tops(), LEFT + self.plot
        height = tops[-1] + 1
        clip = s.element("rect", x=LEFT, y=HEAD - 20, width=0, height=height, id=f"{PREFIX}now")
        window = s.element("rect", x=LEFT, y=0, width=self.plot, height=height)
        parts = [
            s.element("defs", s.element("clipPath", clip, id=f"{PREFIX}past") + s.element("clipPath", window, id=f"{PREFIX}view")),
            s.element("rect", class_="plane", x=LEFT, y=0, width=self.plot, height=height, data_testid="trace-plane"),
            s.element("g", "", id=f"{PREFIX}scale"),
        ]
        middles = [right + 22 + VALUE // 2, right + 22 + VALUE + VALUE // 2]
        parts += [
            s.text(middles[0], 39, "now", "ax b mid", id=f"{PREFIX}ha"),
            s.text(middles[1], 39, "", "ax b mid", id=f"{PREFIX}hb"),
            s.text(LEFT - 30, 39, "s", "ax end"),  # clear of the first figure
        ]
        for place, (lane, top) in enumerate(zip(self.scope.lanes, tops, strict=False)):
            parts.append(self._lane(place, lane, top, middles))
        parts.append(s.element("path", class_="lane-rule", d="".join(f"M0 {top}.5H{self.width}" for top in tops)))
        layers = "".join(self._slots(letter, tops) for letter in "kt")
        parts.append(s.element("g", s.element("g", layers, clip_path=f"url(#{PREFIX}past)"), clip_path=f"url(#{PREFIX}view)"))
        for place, (lane, top) in enumerate(zip(self.scope.lanes, tops, strict=False)):
            if lane.style in ("bus", "steps"):
                parts.append(
                    s.text(LEFT + 8, top + 23, "", "bus-text steps" if lane.style == "steps" else "bus-text", id=f"{PREFIX}s{place}")
                )
        flag = s.element("path", d=f"M.5 {HEAD - 4}V{height}") + s.element("path", class_="flag", d=f"M.5 {HEAD - 13}h13l-4 4.5 4 4.5h-13z")
        parts.append(s.element("g", flag, class_="trig away", id=f"{PREFIX}trig"))
        for letter in "BA":
            plate = s.element("rect", x=-8.5, y=6, width=18, height=16, rx=2) + s.text(0.5, 18, letter, "mid")
            line = s.element("path", d=f"M.5 22V27M.5 44V{height}")
            grip = s.element("rect", class_="grip", x=-12, y=0, width=25, height=HEAD)
            attributes = {"class_": f"cursor c{letter} away", "role": "slider", "tabindex": "-1", "aria_label": f"Cursor {letter}"}
            parts.append(s.element("g", line + plate + grip, id=f"{PREFIX}c{letter}", data_testid=f"cursor-{letter}", **attributes))
        parts.append(s.element("g", "", class_="interval", id=f"{PREFIX}between"))
        size = {"width": self.width, "height": height, "viewBox": f"0 0 {self.width} {height}"}
        names = ", ".join(self.rig.name(lane.name) or lane.name for lane in self.scope.lanes)
        svg = s.element("svg", "".join(parts), class_="trace", role="img", aria_label=f"Trace of {names}", **size)
        self._drawn = shape, svg
        return svg

    def _slots(self, letter: str, tops: list[int]) -> str:
        """The places of a layer's pieces, a group for each piece and in it one for each lane."""
        rows = list(enumerate(tops[:-1]))
        groups = []
        for slot in range(SLOTS):
            lanes = [s.element("g", "", id=f"{PREFIX}{letter}{slot}.{place}", transform=f"translate(0 {top})") for place, top in rows]
            groups.append(s.element("g", "".join(lanes), id=f"{PREFIX}{letter}{slot}"))
        return "".join(groups)

    def _lane(self, place: int, lane: Lane, top: int, middles: list[int]) -> str:
        """A lane's name, its address and the places of its values."""
        height = HEIGHTS[lane.style]
        line = top + height // 2 + 4
        name = self.rig.name(lane.name.partition(":")[0]) if lane.kind != "steps" else "Steps"
        words = [s.element("rect", class_="lane-plate", x=4, y=top + 4, width=LEFT - 12, height=height - 8, rx=4)]
        if name:
            words += [
                s.text(16, line, cut(name, 76), "lane-name"),
                s.text(LEFT - 14, line, lane.name if lane.kind != "steps" else "S", "lane-addr end"),
            ]
        else:
            words.append(s.text(16, line, lane.name, "lane-addr alone"))
        said = f"{name} {lane.name}".strip()
        keys = "Delete removes it, Alt and arrows move it" + (", Enter changes between curve and segments" if lane.kind == "word" else "")
        label = s.element(
            "g",
            "".join(words) + s.tip(f"{said}: {keys}"),
            class_="lane",
            role="button",
            tabindex="-1",
            aria_label=said,
            aria_description=keys,
            data_row=place,
            data_col=0,
            data_testid=f"lane-{lane.name}",
        )
        cells = []
        for letter, x in zip("ab", middles, strict=True):
            if lane.kind == "bit":
                box = s.element("rect", x=x - 9, y=line - 13, width=18, height=17, rx=2)
                cells.append(
                    s.element("g", box + s.text(x, line, "", "mid", id=f"{PREFIX}v{letter}{place}"), id=f"{PREFIX}g{letter}{place}")
                )
            else:
                cells.append(s.text(x + 18, line, "", "wv end", id=f"{PREFIX}v{letter}{place}"))
        if lane.style == "curve":
            cells.append(s.text(LEFT + 6, top + 18, "", "ax", id=f"{PREFIX}r{place}"))
        return label + "".join(cells)

    # -- a frame ------------------------------------------------------------------------------------------------

    def frame(self) -> dict[str, Any]:
        scope, now = self.scope, self.rig.plc.time_us
        begin, span = scope.window()
        if now < self._now:
            self._pieces.clear()  # the run has gone back
        self._now = now
        us_per_px = span / self.plot
        entries: dict[str, Any] = {"svg": self._skeleton(), "window": [begin, span, LEFT, self.plot]}
        entries["now:width"] = s.number(max(0.0, min(self.plot, (now - begin) / us_per_px)))
        piece = span // CHUNKS
        first = begin // piece
        for chunk in range(first, first + SLOTS):
            slot = chunk % SLOTS
            entries[f"k{slot}:transform"] = entries[f"t{slot}:transform"] = (
                f"translate({s.number(LEFT + (chunk * piece - begin) / us_per_px)} 0)"
            )
            for place, lane in enumerate(scope.lanes):
                entries[f"k{slot}.{place}:markup"], letters = self._piece(lane, chunk, piece, us_per_px)
                if lane.style in ("bus", "steps"):
                    entries[f"t{slot}.{place}:markup"] = letters
        entries["scale:markup"] = self._scale(begin, span, us_per_px)
        for place, lane in enumerate(scope.lanes):
            self._enter_values(entries, place, lane, begin, us_per_px)
        self._enter_marks(entries, begin, span, us_per_px)
        step = ticks(begin, max(1, span // 10))[1]
        scans = us_per_px / self.rig.plc.period_us
        count = scope.recording.scan_at(min(now, begin + span)) - scope.recording.scan_at(min(now, begin))
        entries |= {
            "about": f"{clock_text(begin // step * step, step)} s to {clock_text(-(-(begin + span) // step) * step, step)} s",
            "foot": f"{count:,} scans shown, none left out"
            if scans <= 1
            else f"{count:,} scans, {scans:,.0f} in a pixel: edges in one pixel are a solid bar",
            "following": scope.following,
            "trigger": scope.trigger.text if scope.trigger else "",
            "armed": scope.armed,
            "hit": f"{scope.hit_us / 1e6:,.3f} s" if scope.hit_us is not None else "",
            "said": self.said,
        }
        return entries

    def _piece(self, lane: Lane, chunk: int, piece: int, us_per_px: float) -> tuple[str, str]:
        """A lane's look in one piece of the window, its shapes and its words; drawn again only while something may still come."""
        recording, begin = self.scope.recording, chunk * piece
        if not recording.times or begin > self._now:
            return "", ""
        ahead = begin + piece + int(LOOK_AHEAD_PX * us_per_px) + 2 * self.rig.plc.period_us
        newest = recording.times[-1]
        state = True if self._now >= ahead else newest // max(1, int(us_per_px)) if self.rig.session.state == "running" else newest
        key = (lane.name, lane.style, chunk, piece, self.plot)
        known = self._pieces.get(key)
        if known is not None and known[0] == state:
            return known[1]
        changes = recording.changes(lane.name, begin - int(LOOK_AHEAD_PX * us_per_px), ahead)
        stretch = Stretch(begin, begin + piece, us_per_px, ahead)
        if lane.style == "bit":
            markup = bit(changes, stretch, self.rig.plc.period_us), ""
        elif lane.style == "curve":
            self._fit_scale(lane, [value for _, value in changes if value is not None])
            markup = curve(changes, stretch, lane.low, lane.high), ""
        elif lane.style == "steps":
            markup = bus(changes, stretch, self._words(lane), "steps")
        else:
            markup = bus(changes, stretch, figure)
        if len(self._pieces) > KEPT:
            self._pieces.clear()
        self._pieces[key] = state, markup
        return markup

    def _fit_scale(self, lane: Lane, values: list[int]) -> None:
        """Make a curve's scale wide enough; what was drawn with the former one is drawn anew in the next frame."""
        if values and not (lane.low <= min(values) and max(values) <= lane.high):
            lane.low, lane.high = nice_range(min(lane.low, *values), max(lane.high, *values))
            for key in [key for key in self._pieces if key[0] == lane.name]:
                del self._pieces[key]

    def _words(self, lane: Lane):
        """What a value of a lane is called."""
        recording, rig = self.scope.recording, self.rig
        if lane.kind != "steps":
            return figure

        def words(value: int) -> str:
            steps = recording.in_words(lane.name, value).split()
            return f"{steps[0]} {rig.step_name(steps[0])}".strip() if len(steps) == 1 else " ".join(steps)

        return words

    def _scale(self, begin: int, span: int, us_per_px: float) -> str:
        """Marks and grid of the time axis."""
        first, step, parts = ticks(begin, max(1, int(MARK_PX * us_per_px)))
        bottom = self._tops()[-1]
        grid, big, small, letters = "", "", "", ""
        time = first - step
        while time <= begin + span:
            for part in range(parts):
                at = time + step * part // parts
                x = LEFT + round((at - begin) / us_per_px) + 0.5
                if not begin <= at <= begin + span:
                    continue
                if part:
                    small += f"M{x} {HEAD - 10}v4"
                else:
                    big += f"M{x} {HEAD - 13}v7"
                    grid += f"M{x} {HEAD - 6}V{bottom}"
                    letters += s.text(x, 39, clock_text(at, step), "ax mid")
            time += step
        return f'<path class="vgrid" d="{grid}"/><path class="tick" d="{big}"/><path class="tick minor" d="{small}"/>{letters}'

    def _enter_values(self, entries: dict[str, Any], place: int, lane: Lane, begin: int, us_per_px: float) -> None:
        """The values at the cursors; without cursor A the present ones."""
        recording, cursors = self.scope.recording, self.scope.cursors
        times = {"a": self._now if cursors["A"] is None else cursors["A"], "b": cursors["B"]}
        for letter, time in times.items():
            value = recording.value(lane.name, time) if time is not None and recording.times else None
            if lane.kind == "bit":
                entries[f"v{letter}{place}:text"] = "" if value is None else str(value)
                entries[f"g{letter}{place}:class"] = "bv none" if value is None else "bv on" if value else "bv"
            else:
                words = recording.in_words(lane.name, value) if lane.kind == "steps" else "" if value is None else figure(value)
                entries[f"v{letter}{place}:text"] = cut(words, VALUE - 12)
        if lane.style == "curve":
            entries[f"r{place}:text"] = range_text(lane.low, lane.high) if lane.high or lane.low else ""
        elif lane.style != "bit":
            held = recording.changes(lane.name, begin, begin + int(LOOK_AHEAD_PX * us_per_px))
            words = self._words(lane)(held[0][1]) if held and held[0][0] <= begin and held[0][1] is not None else ""
            room = (held[1][0] - begin) / us_per_px if len(held) > 1 else LOOK_AHEAD_PX
            entries[f"s{place}:text"] = words if width(words, 11, True) + 16 <= room else ""

    def _enter_marks(self, entries: dict[str, Any], begin: int, span: int, us_per_px: float) -> None:
        """Cursors, what lies between them, and where the trigger was."""
        scope, places = self.scope, {}
        for letter, time in scope.cursors.items():
            inside = time is not None and begin <= time <= begin + span
            places[letter] = LEFT + round(((time or 0) - begin) / us_per_px)
            entries[f"c{letter}:class"] = f"cursor c{letter}{'' if inside else ' away'}"
            entries[f"c{letter}:transform"] = f"translate({places[letter] if inside else 0} 0)"
            entries[f"c{letter}:aria-valuetext"] = f"{time / 1e6:,.6f} s" if time is not None else "not placed"
            moments = (None, None, None) if time is None else (min(begin, time), time, max(begin + span, time))
            for word, moment in zip(("min", "now", "max"), moments, strict=True):  # in seconds
                entries[f"c{letter}:aria-value{word}"] = None if moment is None else f"{moment / 1e6:.6f}"
        entries["ha:text"] = "now" if scope.cursors["A"] is None else "A"
        entries["hb:text"] = "" if scope.cursors["B"] is None else "B"
        hit = scope.hit_us is not None and begin <= scope.hit_us <= begin + span
        entries["trig:class"] = "trig" if hit else "trig away"
        entries["trig:transform"] = f"translate({LEFT + round(((scope.hit_us or 0) - begin) / us_per_px) if hit else 0} 0)"
        entries["between:markup"], entries["between"] = "", ""
        if None not in scope.cursors.values():
            first, last = sorted(scope.cursors.values())
            words = interval(last - first, scope.recording.scan_at(last) - scope.recording.scan_at(first))
            entries["between"] = words
            a, b = (max(LEFT, min(LEFT + self.plot, x)) for x in sorted(places.values()))
            entries["between:markup"] = self._between(a, b, words)

    def _between(self, a: int, b: int, words: str) -> str:
        room = width(words, 12) + 16
        if b - a - 24 >= room:
            middle = (a + b) / 2
            line = f"M{a + 12} 14H{s.number(middle - room / 2)}M{s.number(middle + room / 2)} 14H{b - 12}"
            return s.element("path", d=line) + s.text(middle, 18, words, "mid")
        if b + 12 + room <= LEFT + self.plot:
            return s.text(b + 18, 18, words, "")
        return s.text(a - 18, 18, words, "end")

    # -- what the page may do -----------------------------------------------------------------------------------

    def receive(self, verb: str, values: dict[str, Any]) -> Any:
        """One call, between two scans; what is refused is told in the panel."""
        with self.rig.session.held():
            try:
                answer = super().receive(verb, values)
            except EcsimError as error:
                self.said = str(error)
                return None
        if verb != "fit":  # which nobody has asked for by hand
            self.said = ""
        return answer

    def on_fit(self, width):
        """The room in px."""
        self.width = min(max(int(width), NARROWEST), WIDEST)

    def on_zoom(self, factor, at):
        """Show `factor` times as long, with the moment `at`, in us, left in its place."""
        self.scope.zoom(float(factor), float(at))

    def on_look(self, begin, span):
        """Hold a stretch of time, in us."""
        self.scope.look_at(float(begin), float(span))

    def on_all(self):
        """Show everything that was recorded."""
        self.scope.fit()

    def on_follow(self, on):
        """Go on with the present, or hold."""
        self.scope.window()
        self.scope.following = bool(on)

    def on_cursor(self, letter, at):
        """A cursor to a moment in us, caught by an edge nearby; None takes it away."""
        if letter not in self.scope.cursors:
            raise ValueError(f"there is no cursor {letter!r}")
        if at is None:
            self.scope.cursors[letter] = None
        else:
            self.scope.place(letter, float(at), SNAP_PX * self.scope.span_us / self.plot)

    def on_edge(self, letter, forward, lane=None):
        """A cursor to the next edge or back to the last, of one lane or of any."""
        names = None if lane is None else [self.scope.lanes[lane].name]
        self.scope.to_edge(letter if letter in self.scope.cursors else "A", bool(forward), names)

    def on_arm(self, text):
        """Wait for a condition."""
        self.scope.arm(str(text))

    def on_add(self, names):
        """Lanes more, as words with blanks or commas between them; the first that is refused ends it."""
        for name in str(names).replace(",", " ").split():
            self.scope.add(name)

    def on_remove(self, lane):
        """A lane less."""
        self.scope.remove(self._known(lane))

    def on_move(self, lane, to):
        """A lane to another place."""
        self.scope.move(self._known(lane), int(to))

    def on_style(self, lane):
        """A word as a curve or as segments."""
        shown = self.scope.lanes[self._known(lane)]
        shown.curved = not shown.curved

    def _known(self, lane: Any) -> int:
        if not isinstance(lane, int) or not 0 <= lane < len(self.scope.lanes):
            raise ValueError(f"there is no lane {lane!r}")
        return lane

    def on_export(self, form):
        """Everything as a file for the page to keep, packed by gzip: its name and its content in base 64. The picture shows the window."""
        begin, span = self.scope.window()
        end = min(begin + span, self.rig.plc.time_us)
        content = self.scope.recording.export(str(form), (begin / 1000, max(end, begin + 1) / 1000))
        return {"name": f"trace.{form}", "packed": base64.b64encode(gzip.compress(content, 6)).decode()}
