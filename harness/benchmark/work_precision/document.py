"""A study as a JSON document."""

from dataclasses import asdict
from typing import Any

from ...documents import Publication, published
from .advice import Advice
from .study import Study


def study_document(done: Study) -> dict[str, Any]:
    """What `holonom accuracy --json` writes; `schemas/accuracy.json` describes it."""
    reference = done.reference
    content = {
        "scene": done.scene,
        "title": done.title,
        "until": str(done.until),
        "machine": asdict(done.machine),
        "reference": {
            "digits": reference.digits,
            "order": reference.order,
            "confirming_digits": reference.confirming_digits,
            "confirming_order": reference.confirming_order,
            "difference": reference.difference,
        },
        "measurements": [asdict(m) | {"instant": str(m.instant)} for m in done.measurements],
        "omissions": [asdict(omission) for omission in done.omissions],
        "advice": [_published_advice(advice) for advice in done.advice],
        "prices": [asdict(price) for price in done.prices],
    }
    return published(Publication.ACCURACY, content)


def _published_advice(advice: Advice) -> dict[str, Any]:
    m = advice.cheapest
    found = None if m is None else {"method": m.method, "setting": m.setting, "seconds": m.seconds, "error": m.error}
    return {"digits": advice.digits, "cheapest": found}
