"""A report counts its verdicts."""

from holonom.crosscheck.report import CheckReport, EquationVerdict, Verdict

FOUND = [Verdict.PROVED] * 3 + [Verdict.AGREES] + [Verdict.DISAGREES] * 2 + [Verdict.LEFT_OUT]


def report(found: list[Verdict]) -> CheckReport:
    return CheckReport(tuple(EquationVerdict("", "1", "", 0, None, each, None, None, "") for each in found), "seed")


def test_what_disagrees_is_counted_and_nothing_else_for_it() -> None:
    assert report(FOUND).disagreements == 2
    assert report([each for each in FOUND if each is not Verdict.DISAGREES]).disagreements == 0


def test_several_verdicts_are_counted_together() -> None:
    assert report(FOUND).count(Verdict.PROVED, Verdict.AGREES) == 4
    assert report(FOUND).count() == 0
