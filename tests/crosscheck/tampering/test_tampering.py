"""Wrong records of every class are rejected, and true ones are not; `make tampering` makes more of more scenes."""

import random

import pytest
from evaluator import difference
from mutants import CLASSES
from scenes import CIRCLE, KINKS, OTHERS, written_texts
from tamper import of_other_scenes, rejected, true_records, wrong_records

SEED = "make check"
SOME = 9  # classes of which a wrong record is made for every change


@pytest.fixture(scope="module")
def trues(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tampering")
    return list(true_records(written_texts(folder, (KINKS, CIRCLE))))


def test_true_records_are_not_rejected(trues):
    assert [why for true in trues if (why := rejected(true.record, true, SEED))] == []


def require_found(trues, kinds):
    wrong = list(wrong_records(trues, SEED, 1, kinds))
    missed = [f"{each.kind}: {each.difference}" for each in wrong if not rejected(each.record, each.true, SEED)]
    assert missed == []
    assert {each.kind for each in wrong} == {*kinds}


def test_wrong_records_of_some_classes_are_rejected(trues):
    require_found(trues, random.Random(SEED).sample(sorted(CLASSES), SOME))


@pytest.mark.long
def test_records_and_motions_of_some_other_scenes_are_rejected(tmp_path):
    found = list(of_other_scenes(tmp_path, random.Random(SEED), 3))
    assert [(kind, what) for kind, what, why in found if not why] == []


@pytest.mark.long
def test_records_and_motions_of_other_scenes_are_rejected(tmp_path):
    found = list(of_other_scenes(tmp_path, random.Random(SEED), len(OTHERS)))
    assert [(kind, what) for kind, what, why in found if not why] == []


@pytest.mark.long
def test_a_wrong_record_of_each_class_is_rejected(trues):
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
