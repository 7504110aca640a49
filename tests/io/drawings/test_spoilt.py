"""Spoilt drawings: each is read, or refused with words."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rocking_cli.io.drawings import csv_vertices, geojson, svg
from tests.hostile import spoilt
from tests.io.drawings import test_svg

GOOD = {
    svg: f"""<svg {test_svg.SPACES} width="210mm" viewBox="0 0 210 297"><style>.a{{display:none}}</style>
<g inkscape:label="b" id="g" transform="rotate(10,2,3) scale(2 3)matrix(1 0 .2 1 3 4)"><rect width="3mm" height="4%"
rx="1"/><ellipse rx="3"/><path id="p" d="M0 0h3v4c1 2 3 4 5 6s1 2 3 4q1 2 3 4t1 2a5 3 10 0 1 3 4zm1 1 2 2"/></g>
<use href="#g" x="1"/><text x="1 2">a<tspan y="4">b</tspan><textPath href="#p">c</textPath></text></svg>""",
    geojson: """{"type": "Feature", "id": 1, "properties": {"layer": "a", "name": "b"}, "geometry": {"type": "Polygon",
"coordinates": [[[0, 0], [2, 0], [2, 3], [0, 0]], [[0.5, 1], [1, 1], [1, 2]]]}}""",
    csv_vertices: "# c\nname;x;y;bulge;layer\nb1;0;0;;M\nb1;1,5;0;0,4;M\nb1;2;3;;M\n\nb2;0;0;1;N\nb2;1;1;1;N\n",
}


@pytest.mark.rest
@given(st.sampled_from(list(GOOD)).flatmap(lambda reader: st.tuples(st.just(reader), spoilt([GOOD[reader]]))))
def test_a_spoilt_drawing_is_read_or_refused(case):
    reader, text = case
    data = text.encode(errors="surrogatepass")
    reader.sniff(data, reader.ENDINGS[0])
    try:
        drawing = reader.read(data, "x")
    except reader.DrawingError as error:
        assert error.refused and str(error).startswith("x")
        return
    for chain in drawing.chains:
        assert np.isfinite(chain.points).all() and np.isfinite(chain.bulges).all()
        assert len(chain.points) == len(chain.bulges) >= 2 and (chain.closed or not chain.bulges[-1])
