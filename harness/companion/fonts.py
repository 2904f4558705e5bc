"""The font of the formulas, a subset of STIX Two Math.

STIX Two Math is under the SIL Open Font License 1.1, as its name table states. The subset keeps it. The file comes
with the package ziamath, of which nothing else is used.
"""

import io
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from ..extras import missing_package

PACKAGE, FILE = "ziamath", "fonts/STIXTwoMath-Regular.ttf"
NAMES = (0, 1, 2, 3, 4, 5, 6, 7, 13, 14)  # of the name table: whose it is, and under which licence
FEATURES = ("ssty", "dtls", "flac")  # smaller indices, letters without their dots, flat accents
COPYRIGHT, LICENCE, LICENCE_ADDRESS = 0, 13, 14
CHARACTERS = (
    *range(0x20, 0x7F),
    *range(0x391, 0x3F6),  # Greek
    *range(0x1D434, 0x1D468),  # slanted letters, of which h stands elsewhere
    0x210E,
    *range(0x1D6E2, 0x1D71C),
    *map(ord, "−±×·⋅…∂∞√∑∫∈≠≤≥≈→′|‖⟨⟩¨˙¯˜ˆ⁄"),
    *(0x307, 0x308, 0x20DB, 0x20DC),  # dots above
)


@cache  # one for the pages in every language
def mathematics_font() -> tuple[bytes, str]:
    """Return the subset as WOFF, and its notice of copyright and licence.

    Returns
    -------
    tuple of bytes and str
        Font and notice.

    Raises
    ------
    HolonomError
        The package that has the font, or fontTools, is not installed.
    """
    if (found := find_spec(PACKAGE)) is None:
        raise missing_package(PACKAGE)
    try:
        from fontTools import subset
    except ImportError:
        raise missing_package("fonttools") from None
    options = subset.Options(layout_features=FEATURES, name_IDs=NAMES, notdef_outline=True, hinting=False)
    options.flavor, options.timing, options.recalc_timestamp = "woff", False, False
    font = subset.load_font(str(Path(found.origin).parent / FILE), options)
    reduced = subset.Subsetter(options)
    reduced.populate(unicodes=CHARACTERS)
    reduced.subset(font)
    notice = "\n".join(font["name"].getDebugName(name) for name in (COPYRIGHT, LICENCE, LICENCE_ADDRESS))
    written = io.BytesIO()
    font.save(written)
    return written.getvalue(), f"{notice}\nA subset, made for these pages.\n"
