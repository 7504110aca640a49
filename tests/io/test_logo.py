"""A logo at the head of a report is in the page itself."""

import base64
import io

import pytest
from PIL import Image

from rocking_cli.documents.figures import MAX_LOGO_SIZE, embedded
from rocking_cli.errors import InputError
from tests.cli.test_cli import run


def picture(kind):
    """A picture of four pixels, written by another program."""
    out = io.BytesIO()
    Image.new("RGB", (2, 2), "red").save(out, kind)
    return out.getvalue()


PNG, JPEG = picture("PNG"), picture("JPEG")
SVG = b'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>\n'


@pytest.mark.parametrize(("content", "kind"), [(PNG, "image/png"), (JPEG, "image/jpeg"), (SVG, "image/svg+xml")])
def test_a_picture_is_known_by_its_content_and_kept_whole(tmp_path, content, kind):
    (tmp_path / "logo").write_bytes(content)
    before, _, data = embedded(tmp_path / "logo").partition(",")
    assert before == f"data:{kind};base64" and base64.b64decode(data) == content


def test_what_is_no_picture_or_too_large_is_refused(tmp_path):
    (tmp_path / "text").write_text("logo")
    with pytest.raises(InputError, match="the file is not a PNG, JPEG or SVG picture"):
        embedded(tmp_path / "text")
    (tmp_path / "large").write_bytes(PNG + bytes(MAX_LOGO_SIZE))
    with pytest.raises(InputError, match="large"):
        embedded(tmp_path / "large")


def test_the_page_of_a_report_has_it(tmp_path, small_maps):
    (tmp_path / "logo.svg").write_bytes(SVG)
    out = tmp_path / "report.html"
    run("report", "--logo", tmp_path / "logo.svg", "--author", "A & B", "--out", out)
    page = out.read_text(encoding="utf-8")
    assert f'src="{embedded(tmp_path / "logo.svg")}" alt="Logo of A &amp; B"' in page


@pytest.mark.parametrize("content", [PNG[:-20], PNG[:8] + b"rest", PNG[:30], JPEG[:3], JPEG[:30], SVG[:-9]])
def test_a_broken_picture_is_named(tmp_path, content):
    path = tmp_path / "logo.png"
    path.write_bytes(content)
    with pytest.raises(InputError, match="the logo is damaged") as caught:
        embedded(path)
    assert caught.value.problems[0].file == str(path)
    assert "object at 0x" not in str(caught.value)
