"""SVG drawings, as Inkscape and others write them.

A layer is the nearest group that has an `inkscape:label`, or else the nearest that has an id; what is in no group is on
the layer "". Texts keep their lines. A circle or arc stays one unless it is scaled unequally; the arcs that programs
write as cubic curves are found again. The size of a unit on paper comes from width, height and viewBox, if they say it
in mm, cm, in, pt or pc: there is no standard for the size of a px.
"""

from __future__ import annotations

import re
import zlib
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import NamedTuple
from xml.parsers import expat

import numpy as np

from rocking_cli.io.drawings import contract
from rocking_cli.io.drawings import svg_paths as lines
from rocking_cli.io.drawings.contract import DrawingError, DrawnLine, DrawnText, LineDrawing, OmittedKind
from rocking_cli.text import cut

TITLE = "SVG"
ENDINGS = (".svg", ".svgz")

MAX_BYTES = 100_000_000  # also of an SVGZ file that is unpacked
MAX_CURVES = 60_000
MAX_DEPTH = 100

_SVG = "http://www.w3.org/2000/svg "
_LABEL = "http://www.inkscape.org/namespaces/inkscape label"
_ROLE = "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd role"
_HREF = "http://www.w3.org/1999/xlink href"

_GROUPS = {"g", "a", "svg", "switch", "symbol"}
_TEXTS = {"text", "tspan", "textPath", "a"}
_SHAPES = {"path", "rect", "circle", "ellipse", "line", "polyline", "polygon"}
_NEVER_DRAWN = {
    "", "defs", "symbol", "title", "desc", "metadata", "style", "script", "linearGradient", "radialGradient", "filter",
    "view", "font", "font-face", "color-profile", "cursor", "solidcolor", "animate", "animateTransform",
    "animateMotion", "set",
}  # fmt: skip
_WHY = dict.fromkeys(("clipPath", "mask", "pattern", "marker"), "it is a definition")
_CLIPS = {"clip-path": "clipPath", "mask": "mask"}
_PROPERTIES = {"display", "visibility", *_CLIPS}
_STYLED_BY = {"style", *_PROPERTIES}
_STYLED = re.compile(r"display|visibility|transform|clip-path|mask")

INCH = 0.0254
METRES: dict[str | None, float] = {
    "in": INCH, "mm": 0.001, "cm": 0.01, "pt": INCH / 72, "pc": INCH / 6, "px": INCH / 96, None: INCH / 96,
}  # fmt: skip
_PX = "there are 72, 90, 96 or 300 px per inch"  # 96 by the standard of today
_LENGTH = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(px|in|mm|cm|pt|pc|%)?\s*", re.ASCII)
_COMMENT = re.compile(r"/\*.*?(?:\*/|\Z)", re.DOTALL)
_ASPECT = re.compile(r"(?!\s*none)\s*(?:x(Min|Mid|Max)Y(Min|Mid|Max))?\s*(slice)?")
_ALIGN = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}


class SvgElement:
    """An element of the file: its name, attributes and line, and the elements and texts within it."""

    __slots__ = ("children", "given", "line", "tag")

    def __init__(self, tag: str, given: dict[str, str], line: int) -> None:
        self.tag, self.given, self.line = tag, given, line
        self.children: list[SvgElement | str] = []

    def get(self, name: str, default: str = "") -> str:
        """Return an attribute."""
        return self.given.get(name, default)

    @property
    def nodes(self) -> Iterator[SvgElement]:
        """The elements within it, without texts."""
        return (each for each in self.children if isinstance(each, SvgElement))


class SvgPlace(NamedTuple):
    """Where an element is drawn."""

    to: lines.Affine  # from its coordinates to those of the drawing
    width: float  # of which a percentage is part
    height: float
    label: str = ""  # of the nearest group that has one
    group: str = ""  # id of the nearest group that has one
    visible: bool = True  # unless it says otherwise
    used_as: str = ""  # id of the outermost `use` element that draws it
    trail: tuple[str, ...] = ()  # ids of the elements that are being drawn again
    depth: int = 0  # elements around it

    @property
    def layer(self) -> str:
        """Name of the layer."""
        return self.label or self.group

    def pair(self, node: SvgElement, x: str, y: str, default: str = "0") -> complex:
        """Return two lengths of an element, along x and y, as x + iy. Raises `ValueError`."""
        return complex(_length(node, x, self.width, default), _length(node, y, self.height, default))


def sniff(data: bytes, ending: str) -> bool:
    """Return whether a file is an SVG drawing: by its ending, or its first element."""
    return ending in ENDINGS or b"<svg" in data[:4096].replace(b"\0", b"")


def read(data: bytes, file: str) -> LineDrawing:
    """Return the drawing in a file. Raises `DrawingError`."""
    if data[:2] == b"\x1f\x8b":
        data = _unpacked(data, file)
    contract.check_content(data, MAX_BYTES, file)
    return _SvgReader(_parsed(data, file), file).drawing()


def _unpacked(data: bytes, file: str) -> bytes:
    """Return the content of a gzip file, one byte more than allowed at most."""
    try:
        unpack = zlib.decompressobj(31)
        content = unpack.decompress(data, MAX_BYTES + 1)
    except zlib.error:
        raise DrawingError("not_svg", "the compressed file is damaged", file) from None
    if not unpack.eof and len(content) <= MAX_BYTES:
        raise DrawingError("not_svg", "the compressed file is cut short", file)
    return content


def _parsed(data: bytes, file: str) -> SvgElement:
    """Return the root of an XML text. Entities are refused, as a few lines of them can stand for gigabytes."""
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.buffer_text = True
    open_nodes = [SvgElement("", {}, 0)]
    count = 0

    def begin(name: str, given: dict[str, str]) -> None:
        nonlocal count
        count += 1
        line = parser.CurrentLineNumber
        contract.check_count(count, contract.MAX_ELEMENTS, "elements", file)
        if len(open_nodes) > MAX_DEPTH:
            raise DrawingError("too_large", f"elements are nested more than {MAX_DEPTH} deep", file, line=line)
        node = SvgElement(name.removeprefix(_SVG) if " " not in name or name.startswith(_SVG) else "", given, line)
        open_nodes[-1].children.append(node)
        open_nodes.append(node)

    def end(_: str) -> None:
        del open_nodes[-1]

    def words(text: str) -> None:
        if open_nodes[-1].tag in _TEXTS or open_nodes[-1].tag == "style":
            open_nodes[-1].children.append(text)

    def entity(name: str, *_: object) -> None:
        raise DrawingError("not_svg", f"the file declares the entity `{cut(name)}`", file,
                           hint="save it as plain SVG", line=parser.CurrentLineNumber)  # fmt: skip

    parser.StartElementHandler, parser.EndElementHandler = begin, end
    parser.CharacterDataHandler, parser.EntityDeclHandler = words, entity
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        why = expat.ErrorString(error.code) or "unknown error"
        cut_short = "the file is cut short" if why == "no element found" else f"this is not valid XML: {why}"
        raise DrawingError("not_svg", cut_short, file, hint="save the drawing as SVG", line=error.lineno) from None
    except (ValueError, LookupError) as error:  # encodings that Python does not have, or of several bytes
        raise DrawingError("not_svg", f"the encoding cannot be read: {error}", file, hint="save it in UTF-8") from None
    root = next(open_nodes[0].nodes)
    if root.tag != "svg":
        raise DrawingError("not_svg", "the first element is not `svg`", file, line=root.line)
    return root


class _SvgReader:
    """Reading of one drawing."""

    def __init__(self, root: SvgElement, file: str) -> None:
        self.root, self.file = root, file
        self.named: dict[str, SvgElement] = {}
        self.chains: list[DrawnLine] = []
        self.labels: list[DrawnText] = []
        self.left: Counter[tuple[str, str, str]] = Counter()
        self.count = self.sides = self.curves = self.shapes = 0
        sheets: list[str] = []
        stack = [root]
        while stack:  # from the end of the file, so that the first of several elements with an id has it
            node = stack.pop()
            if name := node.get("id"):
                self.named[name] = node
            if node.tag == "style":
                sheets += (each for each in reversed(node.children) if isinstance(each, str))
            stack += node.nodes
        self.rules = _rules("".join(reversed(sheets)))

    def drawing(self) -> LineDrawing:
        """Return the whole drawing."""
        try:
            box = _box(self.root)
            paper, doubt, stretch = _paper(self.root, box)
            start = SvgPlace(lines.scaling(1.0, -stretch), 100.0, 100.0)  # y is turned up
            size = complex(*box[2:]) if box else start.pair(self.root, "width", "height", "100")
        except ValueError as error:
            raise self._fault(self.root, error) from None
        self._draw(self.root, start._replace(width=size.real, height=size.imag), is_viewport=True)
        left = [OmittedKind(kind, layer, why, count) for (kind, layer, why), count in self.left.items()]
        return LineDrawing(TITLE, self.chains, self.labels, (), left, None, paper, doubt)

    def _fault(self, node: SvgElement, error: ValueError) -> DrawingError:
        return DrawingError("not_svg", f"`{node.tag}`: {error}", self.file, line=node.line)

    def _counted(self, node: SvgElement, depth: int = 0) -> None:
        self.count += 1
        what = "elements, with those that are used again"
        contract.check_count(self.count, contract.MAX_ELEMENTS, what, self.file, node.line)
        if depth > MAX_DEPTH:
            message = f"elements are nested more than {MAX_DEPTH} deep"
            raise DrawingError("too_large", message, self.file, line=node.line)

    def _draw(self, node: SvgElement, place: SvgPlace, is_viewport: bool = False) -> None:
        """Draw an element and what is in it; `is_viewport` if its own size and viewBox are taken into account."""
        self._counted(node, place.depth)
        if node.tag in _NEVER_DRAWN and not (is_viewport and node.tag == "symbol"):
            return
        try:
            style = self._styled(node)
            place = self._placed(node, place, style)
            if style.get("display") == "none":
                self._hide(node, place)
            elif "transform" in node.given and place.to.is_flat:
                self.left[node.tag, place.layer, "its transform leaves no area"] += 1
            elif node.tag in _GROUPS:
                inner = place if is_viewport or node.tag != "svg" else _viewport(node, place, node)
                if inner:
                    for each in node.nodes:
                        self._draw(each, inner)
            elif node.tag == "use":
                self._use(node, place)
            elif not place.visible:
                self.left[node.tag, place.layer, "it is hidden"] += 1
            elif node.tag == "text":
                self._text(node, place)
            elif node.tag in _SHAPES:
                self._shape(node, place)
            else:
                self.left[node.tag, place.layer, _WHY.get(node.tag, "it is not read")] += 1
        except ValueError as error:
            raise self._fault(node, error) from None

    def _placed(self, node: SvgElement, place: SvgPlace, style: Mapping[str, str]) -> SvgPlace:
        """Return where an element is drawn, with its own transform, and as a group for what is in it."""
        if node.tag in _GROUPS or node.tag == "use":
            label, group = (node.get(_LABEL), node.get("id")) if node.tag == "g" else ("", "")
            place = place._replace(label=label or place.label, group=group or place.group, depth=place.depth + 1)
        given = node.get("transform")
        if given:
            place = place._replace(to=place.to.after(lines.transform(given)))
            if not max(map(abs, place.to)) < contract.MAX_NUMBER:
                raise ValueError(f"has a transform beyond {contract.MAX_NUMBER:g}")
        if style.get("transform", "none") not in ("none", given.strip()) or node.get("transform-origin"):
            raise ValueError("has a transform in its style, which is not read: put it into the attribute")
        if (visibility := style.get("visibility", "inherit")) != "inherit":
            place = place._replace(visible=visibility == "visible")
        for name, kind in _CLIPS.items():
            if style.get(name, "none") != "none":
                self.left[kind, place.layer, "what it clips is taken whole"] += 1
        return place

    def _styled(self, node: SvgElement) -> dict[str, str]:
        """Return the properties that count here: of attributes, of sheets, and of the style of an element itself."""
        if not self.rules and _STYLED_BY.isdisjoint(node.given):
            return {}
        properties = {name: node.given[name].strip() for name in _PROPERTIES & node.given.keys()}
        if self.rules:
            names = [f".{each}" for each in node.get("class").split()]
            for each in ("*", node.tag, *names, *(node.tag + name for name in names), f"#{node.get('id')}"):
                properties |= self.rules.get(each, {})
        return properties | _declared(node.get("style"))

    def _hide(self, node: SvgElement, place: SvgPlace) -> None:
        """Count what is not displayed."""
        stack = [node]
        while stack:
            node = stack.pop()
            self._counted(node)
            if node.tag in _GROUPS:
                stack += node.nodes
            elif node.tag not in _NEVER_DRAWN:
                self.left[node.tag, place.layer, "it is hidden"] += 1

    def _target(self, node: SvgElement) -> tuple[str, SvgElement | None]:
        """Return the name of the element that another refers to, and the element, if it exists."""
        reference = (node.get("href") or node.get(_HREF)).strip()
        if reference and not reference.startswith("#"):
            message = f"`{node.tag}` refers to another file, {cut(reference)}"
            raise DrawingError("xref", message, self.file, hint="put its content into the drawing", line=node.line)
        return reference[1:], self.named.get(reference[1:])

    def _use(self, node: SvgElement, place: SvgPlace) -> None:
        name, target = self._target(node)
        if target is None:
            self.left["use", place.layer, "what it refers to is not in the file"] += 1
            return
        if name in place.trail:
            message = f"`use` draws the element `{cut(name)}` within itself"
            raise DrawingError("not_svg", message, self.file, line=node.line)
        shift = lines.Affine(shift=place.pair(node, "x", "y"))
        used_as = place.used_as or node.get("id")
        there = place._replace(to=place.to.after(shift), trail=(*place.trail, name), used_as=used_as)
        is_viewport = target.tag in ("symbol", "svg")
        inner = _viewport(target, there, node) if is_viewport else there
        if inner:
            self._draw(target, inner, is_viewport)

    def _text(self, node: SvgElement, place: SvgPlace) -> None:
        written = [""]
        spans = [node]

        def collect(part: SvgElement) -> None:
            for each in part.children:
                if isinstance(each, str):
                    written[-1] += each
                elif each.tag in _TEXTS:
                    if written[-1].strip() and (each.get("y") or each.get(_ROLE) == "line"):
                        written.append("")
                    spans.append(each)
                    collect(each)

        collect(node)
        text = "\n".join(line for each in written if (line := " ".join(each.split())))
        if not text:
            return
        at = complex(*(
            next((_length(each, name, whole) for each in spans if each.get(name)), 0.0)
            for name, whole in (("x", place.width), ("y", place.height))
        ))  # fmt: skip
        for each in spans:
            if each.tag == "textPath":
                target = self._target(each)[1]
                if target is not None and (tracks := lines.path(target.get("d"))):
                    at = lines.transform(target.get("transform"))(tracks[0].start)
        self.labels.append(DrawnText(text, place.to(at), place.layer, "text", place.used_as or node.get("id")))

    def _shape(self, node: SvgElement, place: SvgPlace) -> None:
        tracks = _tracks(node, place)
        for track in tracks:
            self.sides += len(track.pieces)
            self.curves += sum(not isinstance(piece, complex) for piece in track.pieces)
        contract.check_count(self.curves, MAX_CURVES, "curves", self.file)
        contract.check_count(self.sides, contract.MAX_SIDES, "sides", self.file)
        bents = list(lines.bent(tracks, place.to))
        self.shapes += 1
        shape = f"{node.tag} {self.shapes}" if len(bents) > 1 else ""
        self.sides += sum(len(each.points) for each in bents if each.is_straightened)
        contract.check_count(self.sides, contract.MAX_SIDES, "sides", self.file)
        for each in bents:
            if not max(map(abs, each.points)) <= contract.MAX_NUMBER:
                raise ValueError(f"has a point beyond {contract.MAX_NUMBER:g}")
            self.chains.append(DrawnLine(
                np.array(each.points), np.array(each.bulges), each.closed, place.layer, node.tag,
                place.used_as or node.get("id"), shape,
                is_straightened=each.is_straightened, arcs_found=each.arcs_found,
            ))  # fmt: skip


def _tracks(node: SvgElement, place: SvgPlace) -> list[lines.Track]:
    """Return the tracks of a shape. Raises `ValueError`."""
    if node.tag == "path":
        return lines.path(node.get("d"))
    if node.tag in ("polyline", "polygon"):
        given = lines.numbers(node.get("points"))
        if len(given) % 2:
            raise ValueError("has an odd number of coordinates")
        points = [complex(x, y) for x, y in zip(given[::2], given[1::2], strict=True)]
        return lines.polygon(points, node.tag == "polygon")

    if node.tag == "line":
        return lines.polygon([place.pair(node, "x1", "y1"), place.pair(node, "x2", "y2")], closed=False)
    if node.tag == "circle":
        mean = float(np.hypot(place.width, place.height)) / 2**0.5
        rx = ry = _length(node, "r", mean)
    else:
        rx, ry = _radii(node, place)
    size = place.pair(node, "width", "height") if node.tag == "rect" else complex(rx, ry)
    if min(size.real, size.imag, rx, ry) < 0:
        raise ValueError("has a negative size")
    if not (size.real and size.imag):
        return []
    if node.tag == "rect":
        rx, ry = min(rx, size.real / 2), min(ry, size.imag / 2)
        return lines.rectangle(place.pair(node, "x", "y"), size.real, size.imag, rx, ry)
    return lines.rectangle(place.pair(node, "cx", "cy") - complex(rx, ry), 2 * rx, 2 * ry, rx, ry)


def _radii(node: SvgElement, place: SvgPlace) -> tuple[float, float]:
    """Return the radii of an ellipse or of corners; one that is not given is like the other."""
    names = [name for name in ("rx", "ry") if node.get(name, "auto").strip() != "auto"]
    wholes = {"rx": place.width, "ry": place.height}
    radii = [_length(node, name, wholes[name]) for name in names] or [0.0]
    return radii[0], radii[-1]


def _length(node: SvgElement, name: str, whole: float, default: str = "0") -> float:
    """Return a length in units of the drawing; `whole` is 100 %. Raises `ValueError`."""
    text = node.get(name) or default
    if node.tag in _TEXTS:
        text = (text.replace(",", " ").split() or ["0"])[0]  # a text may have a position for each letter
    length = _LENGTH.fullmatch(text)
    if not length:
        raise ValueError(f"has {name} `{cut(text)}`, which is not a length")
    number, unit = float(length[1]), length[2]
    if abs(number) > contract.MAX_NUMBER:
        raise ValueError(f"has {name} `{cut(text)}`, which is too large")
    return number / 100 * whole if unit == "%" else number * (METRES[unit] / METRES["px"])


def _box(node: SvgElement) -> list[float]:
    """Return the four values of a viewBox; empty if there is none. Raises `ValueError`."""
    text = node.get("viewBox").strip()
    box = lines.numbers(text)
    if box and (len(box) != 4 or min(box[2:]) <= 0):
        raise ValueError(f"has the viewBox `{cut(text)}`: give x, y, and a positive width and height")
    return box


def _viewport(node: SvgElement, place: SvgPlace, sized: SvgElement) -> SvgPlace | None:
    """Return the place within a nested `svg` or a symbol, whose size another element may give; None if it has none."""
    wholes = {"width": place.width, "height": place.height}
    size = [_length(sized if sized.get(name) else node, name, whole, "100%") for name, whole in wholes.items()]
    corner = place.pair(node, "x", "y") if node.tag == "svg" else 0j
    to = place.to.after(lines.Affine(shift=corner))
    if min(size) <= 0:
        return None
    box = _box(node)
    if not box:
        return place._replace(to=to, width=size[0], height=size[1])
    x, y, *sides = box
    align, across, up = _fitted(node, [whole / side for whole, side in zip(size, sides, strict=True)])
    room = size[0] - across * sides[0], size[1] - up * sides[1]
    to = to.after(lines.Affine(shift=complex(*(_ALIGN[each] * more for each, more in zip(align, room, strict=True)))))
    to = to.after(lines.scaling(across, up)).after(lines.Affine(shift=complex(-x, -y)))
    return place._replace(to=to, width=sides[0], height=sides[1])


def _fitted(node: SvgElement, scales: list[float]) -> tuple[tuple[str, str], float, float]:
    """Return how the viewBox of an element is put into its size: alignment, and scales along x and y.

    Parameters
    ----------
    node : SvgElement
        The element.
    scales : list of float
        Scales along x and y that fill its size; one if only one side of it is known.
    """
    match = _ASPECT.match(node.get("preserveAspectRatio"))
    if not match:
        return ("Mid", "Mid"), scales[0], scales[-1]
    scale = max(scales) if match[3] else min(scales)
    return (match[1] or "Mid", match[2] or "Mid"), scale, scale


def _paper(root: SvgElement, box: list[float]) -> tuple[float | None, str, float]:
    """Return the size of a unit on paper [m], why it is not known, and the stretch of y against x on paper."""
    if not box:
        return None, f"the drawing has no viewBox, and {_PX}", 1.0
    sizes = (_LENGTH.fullmatch(root.get(name)) for name in ("width", "height"))
    known = [(float(size[1]), size[2], side) for size, side in zip(sizes, box[2:], strict=True)
             if size and size[2] != "%" and float(size[1]) > 0]  # fmt: skip
    scales = [number / side * METRES[unit] for number, unit, side in known]
    if not all(1 / contract.MAX_NUMBER < scale < contract.MAX_NUMBER for scale in scales):
        raise ValueError("has a size that is out of range")
    _, across, up = _fitted(root, scales or [1.0])
    in_px = [unit in (None, "px") for _, unit, _ in known]
    stretch = up / across if all(in_px) or not any(in_px) else 1.0
    if any(in_px) or not known:
        return None, f"the size of the drawing is in px, and {_PX}", stretch
    return across, "", stretch


def _declared(text: str) -> dict[str, str]:
    """Return the declarations of a style that count here."""
    if not _STYLED.search(text):
        return {}
    parts = (each.partition(":") for each in text.replace("!important", "").split(";"))
    declarations = {name.strip(): value.strip() for name, _, value in parts}
    return {name: declarations[name] for name in (*_PROPERTIES, "transform") if name in declarations}


def _rules(text: str) -> dict[str, dict[str, str]]:
    """Return the declarations of style sheets that count here, by their selectors."""
    rules: dict[str, dict[str, str]] = {}
    for block in _COMMENT.sub(" ", text).split("}"):
        selectors, _, body = block.partition("{")
        if declared := _declared(body):
            for each in selectors.split(","):
                rules.setdefault(each.strip(), {}).update(declared)
    return rules
