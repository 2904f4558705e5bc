"""Mutants: the changes of each language, the draw and the score."""

from itertools import islice

import pytest
import run
import sources
from changes import blanked, changes


def made(language, body, **options):
    """All changed bodies, by kind."""
    return {kind: {change() for change in found} for kind, found in changes(language, body, **options).items()}


def test_tokens_of_maxima_are_changed_one_at_a_time():
    assert made("mac", "a < -b + 10")["comparison"] == {"a <= -b + 10", "a > -b + 10"}
    assert made("mac", "a < -b + 10")["sign"] == {"a < b + 10"}
    assert made("mac", "a < -b + 10")["arithmetic"] == {"a < -b - 10"}
    assert made("mac", "a < -b + 10")["constant"] == {"a < -b + 9", "a < -b + 11"}
    assert made("mac", "some(f, first(L))")["exchange"] == {"every(f, first(L))", "some(f, last(L))"}
    assert made("mac", 'a and "b or c" /* 1 */') == {"boolean": {'a or "b or c" /* 1 */'}}


def test_conditions_statements_and_arguments_of_maxima():
    assert made("mac", "if if a then b then c")["condition"] == {
        *("if true then c", "if false then c"),
        *("if if true then b then c", "if if false then b then c"),
    }
    assert made("mac", "block([x], x : f(y), g(x), x)")["statement"] == {
        "block([x], g(x), x)",
        "block([x], x : f(y), x)",
    }
    assert made("mac", "f([a, b], g(c), d)")["arguments"] == {"f(g(c), [a, b], d)", "f([a, b], d, g(c))"}
    assert "arguments" not in made("mac", "max(a, b)")


def test_forms_of_lisp():
    assert made("lisp", "(and (< a 3) 'b)")["comparison"] == {"(and (<= a 3) 'b)", "(and (> a 3) 'b)"}
    assert made("lisp", '(if (p "or" x) (- y))') == {
        "condition": {"(if t (- y))", "(if nil (- y))"},
        "sign": {'(if (p "or" x) (identity y))'},
    }
    assert made("lisp", "(when a (f) (g))\n b")["statement"] == {"(when a nil (g))\n b", "nil\n b"}
    assert made("lisp", "(f 'a #\\( (f b c))", functions=frozenset("f"))["arguments"] == {
        *("(f #\\( 'a (f b c))", "(f 'a (f b c) #\\()", "(f 'a #\\( (f c b))"),
    }


def test_statements_of_python_and_the_operators_of_cosmic_ray():
    pytest.importorskip("cosmic_ray")
    found = made("py", "    if any(a) and b < 2:\n        f(a, b)\n")
    assert found["Exchange"] == {"    if all(a) and b < 2:\n        f(a, b)\n"}
    assert found["Arguments"] == {"    if any(a) and b < 2:\n        f(b, a)\n"}
    assert "Arguments" not in made("py", "    f(max(a, b), key=1)\n")
    assert found["Statement"] == {"    if any(a) and b < 2:\n        pass\n"}
    assert found["Condition"] == {f"    if {value}:\n        f(a, b)\n" for value in (True, False)}
    assert "    if any(a) or b < 2:\n        f(a, b)\n" in found["boolean_replacer"]
    assert "    if any(a) and b <= 2:\n        f(a, b)\n" in found["comparison_operator_replacement"]


@pytest.mark.parametrize("language", ["mac", "lisp"])
def test_changes_keep_the_brackets_balanced(language):
    names = frozenset(each.name for each in sources.functions())
    for function in islice((each for each in sources.functions() if each.language == language), 0, None, 9):
        for found in changes(language, function.body, names).values():
            for change in found:
                text = blanked(language, change())
                assert text.count("(") == text.count(")"), (function, change())


def test_a_seed_gives_the_same_mutants_again():
    pytest.importorskip("cosmic_ray")
    drawn = [list(map(str, islice(run.draw(seed), 3))) for seed in ("1", "1", "2")]
    assert drawn[0] == drawn[1] != drawn[2]


def test_what_a_body_says_about_its_lengths_is_no_change():
    assert run.words_of("zip(a, b, strict=True)") == run.words_of("zip(a,  b, strict=False)")
    assert run.words_of("f(True)") != run.words_of("f(False)")


def test_the_score_leaves_out_equivalent_mutants(capsys, tmp_path, monkeypatch):
    mutants = [run.Mutant(each, "changed") for each in sources.functions()[:3]]
    listed = tmp_path / "equivalent.toml"
    function, change = str(mutants[0]).split(": ", 1)
    listed.write_text(
        f"[[mutant]]\nfunction = '{function}'\nchange = '''{change}'''\nreason = 'known'\n", encoding="utf-8"
    )
    monkeypatch.setattr(run, "EQUIVALENT", listed)
    run.report({mutants[0]: "", mutants[1]: "", mutants[2]: "tests/test_cli.py"})
    printed = capsys.readouterr().out
    assert "1 of 2 mutants killed, 50.0%, 95 % interval 9.5% to 90.5%; 1 more are equivalent." in printed
    assert f"SURVIVES {mutants[1]}" in printed
