"""A machine's picture: one SVG drawn at rest and a table from the plant's state to what changes in it.

In the SVG a part that travels carries `data-move="dx dy"`, one that turns `data-turn="cx cy"`; the table says how
far. What lights up has a class, and gets the class `on` beside it. The classes of all machines are in machine.css.
"""

import re
import xml.etree.ElementTree as xml
from collections.abc import Callable, Mapping
from pathlib import Path

from .plant import Moment

STYLE = Path(__file__).with_name("machine.css").read_text(encoding="utf-8")
REFERENCE = re.compile(r'(\bid="|url\(#|href="#)')


class Picture:
    """A drawing of a machine: `svg()` shows it at rest, `state()` says what a moment changes in it.

    The tables name elements by their id: `places` gives parts of the way (0 at rest, 1 at the end of data-move),
    `turns` gives degrees round data-turn, `lit` tells what is on, `texts` what is written; `free` returns ready
    entries ("id:attribute" -> value) for what has no table.
    """

    def __init__(
        self,
        file: Path,
        *,
        places: Mapping[str, Callable[[Moment], float]],
        turns: Mapping[str, Callable[[Moment], float]],
        lit: Mapping[str, Callable[[Moment], object]],
        texts: Mapping[str, Callable[[Moment], str]],
        free: Callable[[Moment], dict[str, str]] = lambda moment: {},
    ):
        opening, rest = file.read_text(encoding="utf-8").split(">", 1)
        self._text = f"{opening}>\n<style>\n{STYLE}</style>{rest}"
        parts = {part.get("id"): part for part in xml.fromstring(self._text).iter() if part.get("id")}
        self._moves = [(part, place, *map(float, parts[part].get("data-move").split())) for part, place in places.items()]
        self._turns = [(part, degrees, parts[part].get("data-turn")) for part, degrees in turns.items()]
        self._lit = [(part, on, parts[part].get("class")) for part, on in lit.items()]
        self._texts = texts
        self._free = free

    def svg(self, prefix: str = "", width: float | None = None) -> str:
        """The whole picture at rest; `prefix` goes before every id, `width` in pixels replaces the natural one."""
        text = REFERENCE.sub(rf"\g<1>{prefix}", self._text)
        if width is None:
            return text
        opening, rest = text.split(">", 1)
        natural, height = (float(re.search(rf' {name}="([\d.]+)"', opening)[1]) for name in ("width", "height"))
        opening = re.sub(r' width="[\d.]+"', f' width="{width:g}"', opening)
        return re.sub(r' height="[\d.]+"', f' height="{height * width / natural:g}"', opening) + ">" + rest

    def state(self, moment: Moment) -> dict[str, str]:
        """What this moment changes in the picture at rest: "id:attribute" -> value, `text` for what is written."""
        state = {
            f"{part}:transform": f"translate({dx * at:.1f} {dy * at:.1f})" for part, place, dx, dy in self._moves for at in [place(moment)]
        }
        state |= {f"{part}:transform": f"rotate({degrees(moment) % 360:.0f} {centre})" for part, degrees, centre in self._turns}
        state |= {f"{part}:class": f"{base} on" if on(moment) else base for part, on, base in self._lit}
        state |= {f"{part}:text": text(moment) for part, text in self._texts.items()}
        return state | self._free(moment)


def on(device: str) -> Callable[[Moment], object]:
    """Whether the lamp of a terminal is lit."""
    outputs = device.startswith("Y")
    return lambda moment: (moment.outputs if outputs else moment.inputs).get(device, 0)


def latest_incident(digits: int = 1, of: str = "") -> Callable[[Moment], str]:
    """The last of the plant's incidents in words, its time with so many digits; `of` says what an incident's number counts, if it has one."""

    def words(moment: Moment) -> str:
        if not moment.plant.incidents:
            return ""
        seconds, *what = moment.plant.incidents[-1]
        return f"{seconds:.{digits}f} s: {' '.join(map(str, [of, *what] if of else what))}"

    return words


def contacts(places: Mapping[str, float]) -> dict[str, str]:
    """Contacts by name, 0 for an open one, whose blades lean as they are drawn, 1 for a closed one, whose blades stand upright."""
    foot, lean = 148, 10 / 36
    return {f"contact-{name}:transform": f"matrix(1 0 {-lean * place:.4f} 1 {lean * place * foot:.2f} 0)" for name, place in places.items()}
