"""The documentation shows what the commands do today, and has a page for every one of them and every mechanism.

`make docs` holds the rest: every warning of Sphinx, such as a link that leads nowhere, is an error there.
"""

from __future__ import annotations

import re
from importlib import import_module

import pytest

import rocking_cli
from rocking_cli import Registry
from rocking_cli.cli.main import COMMANDS
from tests.conftest import PROJECT

DOCS = PROJECT / "docs"
PAGES = sorted([PROJECT / "README.md", PROJECT / "CONTRIBUTING.md", *DOCS.glob("*.md"), *DOCS.glob("mechanisms/*.md")])
MECHANISMS = [name for name in Registry() if Registry().package_of(name).startswith("rocking-cli ")]


def text_of(name):
    return (DOCS / name).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def pictures():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(DOCS)
        yield import_module("make_runs")


@pytest.fixture(scope="module")
def reference(pictures):
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(DOCS)
        yield import_module("make_reference")


@pytest.fixture(scope="module")
def shown(pictures, tmp_path_factory):
    """Everything that is shown, run anew: the folder, and the content of the pictures."""
    folder = tmp_path_factory.mktemp("shown")
    return folder, pictures.run(pictures.SHOWN | pictures.of_mechanisms(), folder)


def test_the_pictures_in_the_readme_are_not_stale(pictures, shown):
    assert pictures.stale(shown[1]) == [], "run make docs"


def test_another_picture_is_not_alike(pictures, shown, tmp_path):
    (tmp_path / "pedestal.yaml").write_bytes((shown[0] / "pedestal.yaml").read_bytes())
    other = {
        "drawing": pictures.of_mechanisms()["draw_asymmetric_frame"] + " --at 0.9",
        "respond": pictures.SHOWN["respond"] + " --scale 1.02",
        "overturning": pictures.SHOWN["overturning"] + " --eta 0.9",
        "blocks": pictures.SHOWN["blocks"] + " --scale 1.02",
    }
    assert sorted(pictures.stale(pictures.run(other, tmp_path))) == sorted(pictures.IN_README)


def test_the_pictures_in_the_readme_are_small(pictures):
    sizes = [(pictures.KEPT / name).stat().st_size for name in pictures.IN_README]
    assert max(sizes) < 100_000
    assert sum(sizes) < 500_000
    readme = (PROJECT / "README.md").read_text(encoding="utf-8")
    assert all(f"docs/pictures/{name}" in readme for name in pictures.IN_README)


def test_the_tutorial_shows_the_commands_that_are_run(pictures):
    in_the_tutorial = re.findall(r"^    (rocking .*)$", text_of("tutorial.md"), re.M)
    assert len(in_the_tutorial) > 7
    assert set(in_the_tutorial) <= set(pictures.SHOWN.values())


@pytest.mark.parametrize("page", [*DOCS.glob("*.md"), *DOCS.glob("mechanisms/*.md")], ids=lambda page: page.stem)
def test_what_a_page_shows_of_a_run_is_there(page, shown):
    for name in re.findall(r"_generated/run/(\S+?)[)>\s]", page.read_text(encoding="utf-8")):
        assert (shown[0] / name).stat().st_size > 0, name


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_explained(name, reference):
    headings = re.findall(r"^## .*", text_of("commands.md"), re.M)
    assert any(re.search(rf"`rocking {name}\b", heading) for heading in headings), name
    assert f"\n## rocking {name}\n" in reference.command_line()


def test_the_reference_has_every_option(reference):
    text = reference.command_line()
    for option in ("--release RATIO", "--with-pulse [best|sine|ricker|mavroeidis]", "-h, --help"):
        assert f"`{option}`\n: " in text
    assert "    rocking respond arch.yaml --release 0.5\n" in text


@pytest.mark.parametrize("name", MECHANISMS)
def test_every_mechanism_has_its_page(name, reference):
    page = text_of(f"mechanisms/{name}.md")
    assert f"../_generated/mechanisms/{name}.md" in page
    assert "## Equations" in page
    assert f"\nmechanisms/{name}\n" in text_of("index.md")
    assert f"(mechanisms/{name}.md)" in text_of("mechanisms.md")
    part = reference.mechanism(name, Registry()[name], reference.examples()[name])
    assert all(
        f"| `{field}` |" in part for field in set(Registry()[name].model_fields) - {"name", "gravity", "restitution"}
    )


def test_every_public_name_is_documented():
    documented = set(re.findall(r"^\.\. auto\w+:: (\w+)$", text_of("api.md"), re.M))
    assert documented == set(rocking_cli.__all__) - {"__version__", "mechanisms"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_somewhere_in_the_repository_too(page):
    text = re.sub(r"^    .*", "", page.read_text(encoding="utf-8"), flags=re.M)  # without code
    for link in re.findall(r"\]\(([^)#\s]+)", text):
        if not link.startswith(("https:", "_generated")):
            assert (page.parent / link).exists(), link
