"""A store under attack loses nothing, and never gives other results without a word."""

import pytest

from rocking_cli.questions.fragility.store import DamagedFile, Store
from tests.stores import DAMAGES, Sound, attack, kills, race


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    return Sound(tmp_path_factory.mktemp("sound"))


@pytest.mark.rest
@pytest.mark.parametrize("number", range(len(DAMAGES)))  # each kind; `make soak` tries hundreds
def test_damage_is_told(sound, tmp_path, number):
    attack(sound, tmp_path, number)


def test_a_chunk_damaged_at_any_place_is_told_or_gives_the_same(sound, tmp_path):
    """A byte flipped at each place, and the file cut there."""
    (tmp_path / "study.json").write_bytes((sound.store / "study.json").read_bytes())
    store, content = Store.reading(tmp_path), (sound.store / "runs-000001.npz").read_bytes()
    file = store.file(1)
    file.write_bytes(content)
    whole, told, places = store.chunk(1), 0, range(0, len(content), 19)
    for k in places:
        file.write_bytes(content[:k])
        with pytest.raises(DamagedFile, match=r"runs-000001\.npz \("):
            store.chunk(1)
        file.write_bytes(content[:k] + bytes([content[k] ^ (1 << k % 8)]) + content[k + 1 :])
        try:
            found = store.chunk(1)
        except DamagedFile:
            told += 1
        else:
            for name, values in vars(whole).items():
                assert getattr(found, name).tobytes() == values.tobytes(), (k, name)
    assert told > 0.6 * len(places)  # what is left are names and times that nobody reads


@pytest.mark.rest
@pytest.mark.parametrize("options", [[], ["--restart"]])
def test_three_that_begin_together_give_the_same(sound, tmp_path, options):
    race(sound, tmp_path / "raced", *options)  # `make soak` has fifty of them


@pytest.mark.rest
def test_no_run_is_lost_though_two_writers_are_killed_again_and_again(tmp_path):
    assert kills(tmp_path / "killed", 2, levels=2000) == 40_000  # `make soak` kills forty times
