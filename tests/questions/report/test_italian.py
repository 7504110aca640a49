"""The Italian report has no English word but those of the user, in its figures and charts neither."""

import re
from pathlib import Path

import pytest
import yaml

import rocking_cli as rk
from rocking_cli.questions.report.view import language_of
from rocking_cli.studies.conclusion import NextStep
from tests.conftest import EXAMPLES
from tests.questions.draw.test_hung import TIED_FILE
from tests.questions.verify.test_sheet_italian import PACKAGES, english_words, figures_as_text, rest_of, words

ARCH, BLOCK = EXAMPLES / "arch.yaml", EXAMPLES / "block.yaml"
VERIFY = EXAMPLES / "verify"
OF_BOTH = {
    "ricker",
    "sine",
    "csv",
    "eq",
    "imp",
    "no",
    "motion",
    "arias",
    "volume",
    "come",
    "javascript",
    "δt",
    "pga",
    "pgv",
    "pgd",
    "newton",
    "cr",
    "dejong",
    "dimitrakopoulos",
    "eesd",
    "sha",
    "mm",
    "assume",
}
"""Names, symbols, specifications of pulses, and words of both languages."""
ENGLISH = english_words((*PACKAGES, "rocking_cli.questions.report")) - OF_BOTH
CASES = {
    "nothing": (BLOCK, [], {}),
    "rocks and overturns": (BLOCK, ["sine:0.1g:1s", "sine:0.4g:0.6s", "sine:1g:2s"], {}),
    "unknown": (ARCH, ["sine:0.8g:0.8s"], {"polarity": "1"}),
    "no block, ties": (TIED_FILE, ["sine:0.5g:0.7s"], {}),
    "verified": (VERIFY / "tied_facade.yaml", ["sine:0.09g:0.5s"], {"verify": VERIFY / "site.yaml"}),
    "record": (EXAMPLES / "frame.yaml", [EXAMPLES / "accel.csv"], {"scale": -3}),
}


@pytest.fixture
def text_of(tmp_path, monkeypatch):
    """Returns the text of the Italian report of a structure, with the texts of its figures, which are not rendered."""

    figures_as_text(monkeypatch)
    monkeypatch.chdir(tmp_path)

    def made(structure, motions, options):
        if isinstance(structure, str):
            Path("s.yaml").write_text(structure, encoding="utf-8")
            structure = Path("s.yaml")
        rk.report(structure, motions, out="r.html", neighbours=5 if motions else 200, language="it", **options)
        page = Path("r.html").read_text(encoding="utf-8")
        names = yaml.safe_dump({"names": [{"name": str(each)} for each in motions]})
        sources = [structure.read_text(encoding="utf-8"), names]
        sources += [options["verify"].read_text(encoding="utf-8")] if "verify" in options else []
        return rest_of(page, *sources)

    return made


def test_every_next_step_is_italian():
    texts = language_of("it").texts
    assert [step for step in NextStep if f"next_{step}" not in texts] == []


@pytest.mark.usefixtures("small_maps")
@pytest.mark.every(6)
@pytest.mark.parametrize("name", CASES)
def test_every_report_is_italian(name, text_of):
    text = re.sub(r"\\\w+", " ", text_of(*CASES[name]))  # commands of formulas in plots
    found = words(text) & ENGLISH
    assert not {each: re.findall(rf".{{0,40}}\b{each}\b.{{0,40}}", text, re.IGNORECASE) for each in found}
    assert len(text) > 2000
    plain = re.sub(
        r"(rocking-cli|Python|numpy|scipy|matplotlib) [\d.]+\S*|sine:\S+|par\. [\d.]+|\[C?\d[\d.]*\]|§\S+", " ", text
    )
    assert not re.findall(r".{20}\d\.\d.{20}", plain)
