"""Italian names of templates and of fields, and comments in Italian: complete, and of the same structures."""

import json
import re

import pytest
import yaml

from rocking_cli import Registry
from rocking_cli.core.structure_file import parse_structure
from rocking_cli.errors import InputError
from rocking_cli.io.starters import STARTERS, in_italian, italian, starter, template_of
from rocking_cli.questions.new.command import BUILDING, SITE, STUDY
from rocking_cli.views.mechanisms import template
from tests.cli.test_cli import run

TEMPLATES = {**{name: starter(name) for name in STARTERS}, **{name: template(cls) for name, cls in Registry().items()}}


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_in_italian_is_the_same_structure_with_every_comment_translated(name):
    english = TEMPLATES[name]
    translated, missing = in_italian(english)
    assert missing == [] and translated != english
    back = translated
    for name_in_english, name_in_italian in italian()["names"].items():
        back = re.sub(rf"name: {name_in_italian}\b", f"name: {name_in_english}", back)
    assert yaml.safe_load(back) == yaml.safe_load(english)
    for before, after in zip(english.splitlines(), back.splitlines(), strict=True):
        assert before == after or before.rpartition("# ")[0] == after.rpartition("# ")[0]
    shown = run("new", name, "--language", "it")
    assert shown.stdout == translated and shown.stderr == ""
    assert name not in STARTERS or not re.search(r"name: (my |roof|bar\b)", shown.stdout)
    assert json.loads(run("new", name, "--language", "it", "--json").stdout)["yaml"] == translated


def test_every_italian_comment_is_used_and_no_two_templates_lack_one():
    everything = "\n".join(TEMPLATES.values())
    assert [english for english in italian()["comments"] if english not in everything] == []


def test_symbols_units_and_bounds_stay():
    assert in_italian("radius: 10.0  # radius of the centre line, r [m] (> 0, <= 1e+06)\n")[0] == (
        "radius: 10.0  # raggio della linea media, r [m] (> 0, <= 1e+06)\n"
    )
    untranslated = "x: 1  # a field of a plugin [m]\n"
    assert in_italian(untranslated) == (untranslated, ["a field of a plugin [m]"])


def test_the_terms_are_those_of_the_trade():
    facade = in_italian(TEMPLATES["facade"])[0]
    for term in ("facciata in muratura", "ribalta", "spessore", "profondità", "solaio", "catene in acciaio"):
        assert term in facade
    assert "cantonale" in in_italian(TEMPLATES["corner"])[0] and "timpano" in in_italian(TEMPLATES["gable"])[0]
    assert "copertura" in in_italian(TEMPLATES["parapet"])[0] and "peso specifico" in in_italian(TEMPLATES["wall"])[0]


def test_every_italian_name_finds_a_template():
    names = italian()["templates"]
    assert set(names.values()) == {*STARTERS, *Registry(), STUDY, SITE, BUILDING} - {"asymmetric_frame"}
    assert not set(names) & {*Registry(), *STARTERS}
    for italian_name in ("facciata", "parapetto", "arco", "catena", "portale", "Cella campanaria"):
        shown = run("new", italian_name)
        assert shown.stdout == run("new", template_of(italian_name)).stdout
        assert shown.stderr.strip() == f"{italian_name} is the template {template_of(italian_name)}"
    assert "did you mean facciata?" in run("new", "faciata", code=2).stderr


def test_comments_that_stay_in_english_are_counted():
    shown = run("new", "study", "--language", "it")
    assert re.fullmatch(r"comments without an Italian text, which stay in English: \d+\n?", shown.stderr)
    assert "--language requires a template" in run("new", "--plugin", "xx", "--language", "it", code=2).stderr


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("facade", "facade is a starter: `rocking new facade > facade.yaml`"),
        ("facciata", "facade is a starter: `rocking new facade > facade.yaml`"),
        ("arco", "did you mean arch?"),
        ("blok", "did you mean block?"),
    ],
)
def test_a_starter_is_named_where_a_mechanism_is_expected(name, hint):
    with pytest.raises(InputError) as caught:
        parse_structure(f"mechanism: {name}\nwidth: 1\n", "f.yaml", "f")
    assert f"f.yaml:1:12: mechanism: unknown mechanism '{name}'" in str(caught.value) and hint in str(caught.value)
    assert hint in run("mechanisms", name, code=2).stderr
    with pytest.raises(KeyError):
        Registry()[name]


def test_italian_names_of_fields_are_understood_in_hints():
    with pytest.raises(InputError) as caught:
        parse_structure("mechanism: block\nspessore: 1\naltezza: 2\npeso: 96 kN\n", "f", "f")
    said = str(caught.value)
    for hint in ("its thickness is given by width", "did you mean height?", "its weight is given by mass"):
        assert hint in said
