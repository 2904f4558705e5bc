"""Write a derivation as a LaTeX article that a plain TeX Live compiles.

It loads article, amsmath and geometry only.
"""

import unicodedata
from collections.abc import Iterable, Mapping, Sequence

from sympy import Expr, Symbol

from ..expression.mathjson import from_sympy
from ..record import Derivation, Equation, Record, Relation, Scene, System
from .equations import blocks
from .latex import latex
from .quantities import spelled_apart, spelled_out, symbol_box

WIDTH = 70  # width left of an equation's number, in digits of the article's typeface
PREAMBLE = r"""% Written by Holonom
\documentclass[11pt]{article}
\usepackage[utf8]{inputenc}
\usepackage[a4paper, margin=25mm]{geometry}
\usepackage{amsmath}
\allowdisplaybreaks
\setcounter{MaxMatrixCols}{30}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt}
\setlength{\jot}{6pt}
"""
SPECIAL = {"\\": r"$\backslash$", "~": r"\~{}", "^": r"\^{}", "<": "$<$", ">": "$>$"} | {
    sign: f"\\{sign}" for sign in "{}$&#%_"
}
LAST_LATIN = "\u017f"  # of the characters that LaTeX composes in its own typeface
PUNCTUATION = "\u2013\u2014\u2018\u2019\u201c\u201d\u2026"


def tex_document(record: Record) -> str:
    """Write a derivation as a LaTeX document.

    pdflatex and lualatex compile it. Each equation stands under the equation number and its name.

    Parameters
    ----------
    record : Record
        The derivation.

    Returns
    -------
    str
        Source text of the document, preamble included.
    """
    with spelled_apart(record.system.names):
        sections = [
            _description(record.system),
            *map(_derivation, record.derivations),
            *map(_scene, record.scenes),
        ]
    return "\n".join(
        [
            PREAMBLE,
            rf"\title{{{text(record.system.title)}}}",
            rf"\author{{{text(record.system.source or '')}}}",
            r"\date{}",
            r"\begin{document}",
            r"\maketitle",
            _paragraph(
                f"Derived by Maxima {record.maxima}. The equations have the numbers of Chen, Guo and Mei (2019)."
            ),
            *sections,
            r"\end{document}",
            "",
        ]
    )


def text(plain: str) -> str:
    """Return plain text for LaTeX's text mode.

    A character beyond Latin becomes a Greek letter or its name.

    Parameters
    ----------
    plain : str
        Plain text. Characters that LaTeX reserves are allowed.

    Returns
    -------
    str
    """
    return "".join(map(_character, plain))


def _character(sign: str) -> str:
    if sign in SPECIAL or sign < LAST_LATIN or sign in PUNCTUATION:
        return SPECIAL.get(sign, sign)
    letter = spelled_out(sign)
    return f"({unicodedata.name(sign, 'character').lower()})" if letter == sign else f"${symbol_box(letter).latex}$"


# ---- sections -------------------------------------------------------------------------------------


def _description(system: System) -> str:
    names = [
        ("Coordinates", system.coordinates),
        ("Controls", system.controls),
        ("Parameters", system.parameters),
        ("Multipliers", system.multipliers),
    ]
    energies = [("Kinetic energy", "T", system.kinetic_energy), ("Potential energy", "V", system.potential_energy)]
    return _section(
        "The system",
        [
            *(_inline(what, map(_symbol, letters)) for what, letters in names if letters),
            *(
                _named(_heading(what, part.effect), [Relation(letter, from_sympy(part.value))])
                for what, letter, parts in energies
                for part in parts
            ),
            *(
                _named(_heading("Generalized forces", force.effect), _components("Q", force.value))
                for force in system.forces
            ),
            _named("Constraints", _components("f", system.constraints)) if system.constraints else "",
        ],
    )


def _heading(what: str, effect: str) -> str:
    """Return a heading: the quantity of the system, and its effect if that has a name."""
    return what if _words(effect) == what.lower() else f"{what}, {_words(effect)}"


def _words(effect: str) -> str:
    return effect.replace("_", " ")


def _derivation(derivation: Derivation) -> str:
    heading = f"Derivation with {', '.join(map(_words, derivation.effects))}"
    return _section(heading, map(_equation, derivation.equations))


def _scene(scene: Scene) -> str:
    law = "Control law around the initial time" if scene.law_around_start else "Control law"
    given = [(law, scene.control_law), ("Parameters", scene.parameter_values)]
    return _section(
        scene.title or scene.name,
        [*(_inline(what, _equalities(values)) for what, values in given if values), *map(_equation, scene.equations)],
    )


def _section(heading: str, parts: Iterable[str]) -> str:
    return "\n".join([rf"\section*{{{text(heading)}}}", *filter(None, parts)])


def _paragraph(plain: str) -> str:
    return f"{text(plain)}\n"


def _inline(what: str, formulas: Iterable[str]) -> str:
    return f"{text(what)}: " + ", ".join(f"${formula}$" for formula in formulas) + ".\n"


# ---- equations -------------------------------------------------------------------------------------


def _equation(equation: Equation) -> str:
    heading = rf"\paragraph{{({text(equation.number)}) {text(equation.name)}}}"
    displays = [_display(rows, equation.number) for rows in blocks(equation, WIDTH)]
    return "\n".join([heading, *displays] if displays else [heading, "None.\n"])


def _display(rows: Sequence[str], number: str) -> str:
    first, *others = rows
    tagged = [rf"{first} \tag{{{text(number)}}}" if number else first, *others]
    return "\\begin{align*}\n" + " \\\\\n".join(tagged) + "\n\\end{align*}"


def _named(name: str, relations: Sequence[Relation]) -> str:
    [rows] = blocks(Equation("", "", name, tuple(relations)), WIDTH)
    return f"{text(name)}:\n{_display(rows, '')}"


def _components(letter: str, values: Sequence[Expr]) -> list[Relation]:
    return [Relation(f"{letter}{place}", from_sympy(value)) for place, value in enumerate(values, start=1)]


def _equalities(values: Mapping[str, Expr]) -> list[str]:
    return [f"{_symbol(name)} = {latex(value)}" for name, value in values.items()]


def _symbol(name: str) -> str:
    return latex(Symbol(name, real=True))
