"""Sums of negated terms as differences, products of reciprocals as quotients: what x - y and x/y cost everybody, one.

Computer algebra systems keep x - y as x + (-1)*y and x/y as x*y^-1, and would be charged for that.
"""

from collections.abc import Sequence

Tree = int | str | dict | list


def charged(tree: Tree) -> Tree:
    """A MathJSON tree with differences and quotients where sums and products stand for them."""
    match tree:
        case ["Rational", *_]:
            return tree
        case ["Power", base, int(exponent)] if exponent < 0:
            return ["Divide", 1, charged(base if exponent == -1 else ["Power", base, -exponent])]
        case ["Multiply", *factors]:
            return _product([charged(factor) for factor in factors])
        case ["Add", *terms]:
            return _sum([charged(term) for term in terms])
        case [head, *arguments]:
            return [head, *map(charged, arguments)]
        case _:
            return tree


def _product(factors: Sequence[Tree]) -> Tree:
    negative, above, below = False, [], []
    for factor in factors:
        match factor:
            case ["Divide", 1, divisor]:
                below.append(divisor)
            case ["Negate", negated]:
                negative ^= True
                above.append(negated)
            case int() if factor < 0:
                negative ^= True
                above += [-factor] if factor != -1 else []
            case _:
                above.append(factor)
    product = _several("Multiply", above) if above else 1
    quotient = ["Divide", product, _several("Multiply", below)] if below else product
    return ["Negate", quotient] if negative else quotient


def _sum(terms: Sequence[Tree]) -> Tree:
    minus = [term[1] for term in terms if _is_negated(term)]
    plus = [term for term in terms if not _is_negated(term)]
    if not minus:
        return _several("Add", plus)
    return ["Subtract", _several("Add", plus), _several("Add", minus)] if plus else ["Negate", _several("Add", minus)]


def _is_negated(tree: Tree) -> bool:
    return isinstance(tree, list) and tree[0] == "Negate"


def _several(head: str, parts: Sequence[Tree]) -> Tree:
    return parts[0] if len(parts) == 1 else [head, *parts]
