"""Make wrong records of the scenes, and tell how many of them the check holds up: `make tampering`.

    python tests/crosscheck/tampering/tamper.py [SEED [MUTANTS]]

The seed draws the changes, MUTANTS (15) of each class. Exit status 1: a true record is rejected, a wrong one of a class
of algebra is not, or fewer than 99.5 % of all are.
"""

import json
import random
import secrets
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import NamedTuple

from evaluator import difference
from mutants import ALGEBRA, CLASSES, mutant
from scenes import OTHERS, written, written_texts

from holonom.crosscheck.check import check_record
from holonom.crosscheck.motions import motion_verdicts, read_motions
from holonom.crosscheck.questions import ask_for_check
from holonom.crosscheck.report import Verdict
from holonom.documents import ask
from holonom.failures import HolonomError
from holonom.formats import Document
from holonom.language import translated
from holonom.record import read_record
from holonom.source import Source

WANTED = 0.995
RECORD, MOTION = "record of another scene", "motion of another scene"
DRAWS = 12  # attempts to make a mutant of a class that is a wrong one


class TrueRecord(NamedTuple):
    """A true record and the description that it is derived from."""

    name: str
    record: dict
    description: object


class Wrong(NamedTuple):
    """A wrong record, and what is wrong."""

    true: TrueRecord
    kind: str
    record: dict
    difference: str


def true_records(files):
    """The records of scene files."""
    for file in files:
        source = Source(file)
        yield TrueRecord(file.stem, json.loads(ask(Document.RECORD, source)), source.description())


def rejected(record, true, seed):
    """Why `holonom check` would not end with status 0; empty where it would."""
    try:
        report = check_record(read_record(json.dumps(record)), true.description, seed)
    except HolonomError as refusal:
        return f"refused: {refusal}"
    unwanted = [each for each in report.verdicts if each.verdict in (Verdict.DISAGREES, Verdict.UNDECIDED)]
    return "; ".join(
        f"({each.number}) {each.id} {translated(each.verdict)}: {translated(each.detail)}" for each in unwanted
    )


def wrong_records(trues, seed, count, kinds=tuple(CLASSES)):
    """Wrong records of each class, each shown to be wrong; of some classes there are fewer."""
    for kind in kinds:
        made = 0
        for attempt in range(DRAWS * count):
            draw = random.Random(f"{seed} {kind} {attempt}")
            records = ((true, mutant(kind, true.record, draw)) for true in draw.sample(trues, len(trues)))
            true, record = next(((true, record) for true, record in records if record is not None), (None, None))
            found = record is not None and difference(true.record, record)
            if found:
                yield Wrong(true, kind, record, found)
                made += 1
            if made == count:
                break


def of_other_scenes(folder, draw, count):
    """Whether the records and the motions of other scenes are rejected: class, what is other, why."""
    for text, old, new in draw.sample(OTHERS, min(count, len(OTHERS))):
        described, other = map(Source, written_texts(folder, (text, text.replace(old, new))))
        description, what = described.description(), f"{old} is {new}"
        record = json.loads(ask(Document.RECORD, other))
        true = TrueRecord("", json.loads(ask(Document.RECORD, described)), description)
        if difference(true.record, record):
            yield RECORD, what, rejected(record, true, what)
        verdicts = motion_verdicts(description, read_motions(other.description(), ask_for_check(other, {})), what)
        yield MOTION, what, "; ".join(each.detail for each in verdicts if each.verdict is Verdict.DISAGREES)


def main(seed, count):
    """Print what was found of each class, and each wrong record that was not rejected."""
    with tempfile.TemporaryDirectory() as folder:
        trues = list(true_records(written(Path(folder))))
    honest = [why for true in trues if (why := rejected(true.record, true, seed))]
    print(*(f"true, and rejected: {why}" for why in honest), sep="\n", flush=True)
    made, found = Counter(), Counter()
    for wrong in wrong_records(trues, seed, count):
        made[wrong.kind] += 1
        if rejected(wrong.record, wrong.true, seed):
            found[wrong.kind] += 1
        else:
            print(f"missed: {wrong.kind} of {wrong.true.name}: {wrong.difference}", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for kind, what, why in of_other_scenes(Path(folder), random.Random(seed), count):
            made[kind] += 1
            found[kind] += bool(why)
            print(*([] if why else [f"missed: {kind}: {what}"]), sep="\n", end="\n" * (not why), flush=True)
    for kind in (*CLASSES, RECORD, MOTION):
        print(f"{kind:45}{found[kind]:5} / {made[kind]}")
    print(f"{'all':45}{found.total():5} / {made.total()}; seed {seed}")
    algebra = all(found[kind] == made[kind] for kind in ALGEBRA)
    return honest or not algebra or found.total() < WANTED * made.total()


if __name__ == "__main__":
    given = dict(enumerate(sys.argv[1:]))
    sys.exit(bool(main(given.get(0, secrets.token_hex(4)), int(given.get(1, 15)))))
