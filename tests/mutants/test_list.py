"""The list of mutations keeps up with the sources: a mutation that can no longer be made counts for nothing."""

import run


def test_each_mutation_changes_one_place_of_the_sources():
    assert [str(each) for each in run.mutations() if not each.applies or each.before == each.after] == []


def test_the_tests_that_have_to_find_it_are_there():
    named = {test for each in run.mutations() for test in each.tests}
    assert [test for test in sorted(named) if not stands(*test.partition("::")[::2])] == []


def stands(file: str, name: str) -> bool:
    path = run.ROOT / file
    return path.is_file() and f"def {name.partition('[')[0]}(" * bool(name) in path.read_text(encoding="utf-8")
