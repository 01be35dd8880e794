"""Writing SVG: elements as text, the style that a picture carries with it, and the same picture with plain values for export."""

import re
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import files

_SPECIAL = re.compile(r'[&<>"\t\n\r]')
_ENTITIES = {ord("&"): "&amp;", ord("<"): "&lt;", ord(">"): "&gt;"}
_QUOTED = _ENTITIES | {ord('"'): "&quot;", ord("\t"): "&#9;", ord("\n"): "&#10;", ord("\r"): "&#13;"}


def escape(words: str) -> str:
    """Plain text as the content of an element."""
    return words.translate(_ENTITIES) if _SPECIAL.search(words) else words


def quoted(words: str) -> str:
    """Plain text as the value of an attribute, in double quotes."""
    return f'"{words.translate(_QUOTED) if _SPECIAL.search(words) else words}"'


def number(value: float) -> str:
    """A length or coordinate, as short as it can be written."""
    return f"{value:.2f}".rstrip("0").rstrip(".") if value % 1 else str(int(value))


def element(tag: str, content: str | None = None, /, **attributes: object) -> str:
    """One element; `class_` and `data_x` become class and data-x, attributes of None are left out, `content` is markup already."""
    parts = [tag]
    for name, value in attributes.items():
        if value is not None:
            name = name.rstrip("_").replace("_", "-")
            parts.append(f"{name}={quoted(number(value) if isinstance(value, (int, float)) else str(value))}")
    head = " ".join(parts)
    return f"<{head}/>" if content is None else f"<{head}>{content}</{tag}>"


def text(x: float, y: float, content: str, class_: str, /, **attributes: object) -> str:
    """A line of letters; `content` is plain text."""
    return element("text", escape(content), class_=class_, x=x, y=y, **attributes)


def tip(words: str) -> str:
    """The words shown while the pointer rests on the element around it."""
    return f"<title>{escape(words)}</title>" if words else ""


# -- style ------------------------------------------------------------------------------------------------------


@cache
def look(name: str) -> str:
    """One of the style sheets beside this module, as text: "tokens.css" or "drawing.css"."""
    return files("ecsim.views").joinpath("look", name).read_text(encoding="utf-8")


_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_TOKEN = re.compile(r"(--ec-[\w-]+)\s*:\s*([^;]+);")
_VAR = re.compile(r"var\((--[\w-]+)(?:\s*,\s*((?:[^()]|\([^()]*\))*))?\)")
_CLASS = re.compile(r"\.([A-Za-z][\w-]*)")


@cache
def tokens(theme: str = "light") -> Mapping[str, str]:
    """Every token with its plain value in a theme, "light" or "dark": JupyterLab's variables are replaced by their literals."""
    sheet = _COMMENT.sub("", look("tokens.css"))
    light, _, rest = sheet.partition("\n}\n")
    found = dict(_TOKEN.findall(light))
    if theme == "dark":
        found.update(_TOKEN.findall(rest[: rest.index("\n}\n")]))
    elif theme != "light":
        raise ValueError(f"there is no theme {theme!r}, only light and dark")
    return {name: _plain(value.strip(), found) for name, value in found.items()}


def _plain(value: str, known: Mapping[str, str]) -> str:
    def literal(match: re.Match) -> str:
        return _plain(known.get(match[1], match[2] or "").strip(), known)

    return _VAR.sub(literal, value)


@cache
def _rules() -> tuple[tuple[frozenset[str], str], ...]:
    """Each rule of drawing.css with the classes that it is about; every var() with its literal."""
    sheet = _COMMENT.sub("", look("drawing.css"))
    light = tokens("light")
    rules = []
    for line in filter(str.strip, sheet.splitlines()):
        rule = _VAR.sub(lambda match: f"var({match[1]}, {light[match[1]]})", line.strip())
        rules.append((frozenset(_CLASS.findall(line.partition("{")[0])) - {"ec"}, rule))
    return tuple(rules)


def style(classes: Iterable[str] | None = None) -> str:
    """The rules of drawing.css, all or only those about the given classes; each value is a token with a literal to fall back to."""
    wanted = None if classes is None else frozenset(classes)
    return "\n".join(rule for about, rule in _rules() if wanted is None or about <= wanted)


_USED = re.compile(r'class="([^"]*)"')


def classes_of(markup: str) -> frozenset[str]:
    """Every class that stands in a piece of markup."""
    return frozenset(name for group in _USED.findall(markup) for name in group.split())


def standalone(picture: str) -> str:
    """A root `<svg>` with its paper and the style that it needs, to be shown where no panel brings them."""
    head = picture.index(">") + 1
    sheet = style(classes_of(picture) | {"paper"})
    return f'{picture[:head]}<style>{escape(sheet)}</style><rect class="paper" width="100%" height="100%"/>{picture[head:]}'


def plain(picture: str, theme: str = "light") -> str:
    """A stand-alone picture with plain values in place of tokens, for renderers that know no `var()`."""
    return _plain(picture, tokens(theme))


# -- state ------------------------------------------------------------------------------------------------------

_TAG = re.compile(r'<(?P<tag>[\w]+)(?P<head>[^<>]*? id="(?P<id>[^"]*)"[^<>]*?)(?P<end>/?)>(?P<text>[^<]*)')


def applied(picture: str, entries: Mapping[str, str], prefix: str = "") -> str:
    """The picture with a state put in: for each "key:attribute" the element with id prefix + key gets the attribute; "text" is its content."""
    by_id: dict[str, list[tuple[str, str]]] = {}
    for key, value in entries.items():
        name, _, attribute = key.rpartition(":")
        by_id.setdefault(prefix + name, []).append((attribute, value))

    def put(match: re.Match) -> str:
        changes = by_id.get(match["id"])
        if not changes:
            return match[0]
        head, content, end = match["head"], match["text"], match["end"]
        for attribute, value in changes:
            if attribute == "text":
                content, end = escape(value), ""
            else:
                head = re.sub(rf'\s{re.escape(attribute)}="[^"]*"', "", head, count=1) + f" {attribute}={quoted(value)}"
        closing = f"</{match['tag']}>" if match["end"] and not end else ""
        return f"<{match['tag']}{head}{end}>{content}{closing}"

    return _TAG.sub(put, picture)
