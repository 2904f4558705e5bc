"""Wrong records of every class are rejected, and true ones are not; `make tampering` makes more of more scenes."""

import random
import re

import pytest
from evaluator import difference
from mutants import CLASSES
from scenes import CIRCLE, KINKS, OTHERS, written_texts
from tamper import of_other_scenes, rejected, true_records, wrong_records

from holonom.language import speaking

SEED = "make check"
ENGLISH_PROSE = re.compile(r"[A-Za-z]{2,},? [a-z]{2,}")
SOME = 9  # classes of which a wrong record is made for every change


@pytest.fixture(scope="module")
def trues(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tampering")
    return list(true_records(written_texts(folder, (KINKS, CIRCLE))))


def test_true_records_are_not_rejected(trues):
    assert [why for true in trues if (why := rejected(true.record, true, SEED))] == []


def require_found(trues, kinds):
    """Each is rejected, with a reason that has no English words in Chinese."""
    wrong = list(wrong_records(trues, SEED, 1, kinds))
    with speaking("zh"):
        reasons = [rejected(each.record, each.true, SEED) for each in wrong]
    assert [f"{each.kind}: {each.difference}" for each, why in zip(wrong, reasons, strict=True) if not why] == []
    assert {each.kind for each in wrong} == {*kinds}
    worded = [why for why in reasons if not why.startswith(("refused", "() description"))]  # those quote the files
    assert [why for why in worded if ENGLISH_PROSE.search(why)] == []


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
