"""Reasons that Maxima gives are translated with their values."""

import pytest

from holonom.language import Message, speaking, translated
from holonom.maxima_reasons import translatable_reason


@pytest.mark.parametrize(
    ("reason", "chinese"),
    [
        ("the condition (10) vanishes identically", "条件 (10) 恒成立"),
        ("the power series of lambda1 begins at order 0", "lambda1 的幂级数从 0 阶开始"),
        (
            "no control law makes every motion free: the coefficient of y^3 in (10), from gravity, spring, is m*g",
            "没有控制律使每个运动都是自由的：(10) 中 y^3 的系数（来自 gravity, spring）是 m*g",
        ),
    ],
)
def test_known_reason_is_translated(reason, chinese):
    known = translatable_reason(reason)
    assert known == reason
    with speaking("zh"):
        assert translated(known) == chinese


@pytest.mark.parametrize(
    "reason", ["two laws vanish", "the power series of the multipliers vanish to order 40, to 60 digits"]
)
def test_unknown_reason_stays_as_it_is(reason):
    assert not isinstance(translatable_reason(reason), Message)
