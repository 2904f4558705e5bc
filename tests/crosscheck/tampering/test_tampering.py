"""Wrong records of every class are held up, and true ones are not; `make tampering` makes more of more scenes."""

import random

import pytest
from evaluator import difference
from mutants import CLASSES
from scenes import CIRCLE, KINKS
from tamper import held_up, true_records, wrong_records

SEED = "make check"
SOME = 18  # classes of which a wrong record is made for every change


@pytest.fixture(scope="module")
def trues(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tampering")
    files = []
    for name, text in (("kinks", KINKS), ("circle", CIRCLE)):
        files.append(folder / f"{name}.mac")
        files[-1].write_text(f'load("holonom.mac")$\n{text}', encoding="utf-8")
    return list(true_records(files))


def test_true_records_are_not_held_up(trues):
    assert [why for true in trues if (why := held_up(true.record, true, SEED))] == []


def require_found(trues, kinds):
    wrong = list(wrong_records(trues, SEED, 1, kinds))
    missed = [f"{each.kind}: {each.difference}" for each in wrong if not held_up(each.record, each.true, SEED)]
    assert missed == []
    assert {each.kind for each in wrong} == {*kinds}


def test_wrong_records_of_some_classes_are_held_up(trues):
    require_found(trues, random.Random(SEED).sample(sorted(CLASSES), SOME))


@pytest.mark.long
def test_a_wrong_record_of_each_class_is_held_up(trues):
    require_found(trues, tuple(CLASSES))


@pytest.mark.parametrize(
    ("true", "false", "differ"),
    [
        (["Sqrt", ["Power", "x", 2]], ["Abs", "x"], False),
        (["Add", "x", "x"], ["Multiply", 2, "x"], False),
        (["Abs", ["Add", -3, "x"]], ["Add", 3, ["Multiply", -1, "x"]], True),
        (["Ln", ["Power", "x", 2]], ["Multiply", 2, ["Ln", "x"]], True),
        ("x", {"num": "1.5e0"}, True),
    ],
)
def test_the_evaluator_tells_what_is_the_same_from_what_is_not(true, false, differ):
    assert bool(difference({"right": true}, {"right": false})) is differ
