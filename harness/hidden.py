"""Characters that hide or reverse the text around them, or control a terminal."""

import re
import unicodedata

HIDDEN = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})  # Unicode categories: control, format, surrogate, line, paragraph

# Control characters but line feed and tab, what joins and hides characters or turns the direction of writing, half
# characters, and what no XML may hold.
UNSEEN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\xad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ufffe\uffff\ud800-\udfff\U000e0000-\U000e0fff]"
)


def hidden_character(text: str) -> str:
    """Return the first character that hides or reverses text, as ``U+202E``.

    Parameters
    ----------
    text : str
        Any text.

    Returns
    -------
    str
        Empty if there is no such character.
    """
    return next((f"U+{ord(each):04X}" for each in text if unicodedata.category(each) in HIDDEN), "")


def visible(text: str) -> str:
    """Return a text with hidden characters made visible.

    Parameters
    ----------
    text : str
        Any number of lines.

    Returns
    -------
    str
        Line feeds and tabs are unchanged.
    """
    return UNSEEN.sub(_code, text)


def visible_line(text: str) -> str:
    """Return a text as one line, with hidden characters and line ends made visible.

    Parameters
    ----------
    text : str
        Any number of lines.

    Returns
    -------
    str
    """
    return visible(text).replace("\n", "\\n").replace("\t", " ")


def _code(found: re.Match[str]) -> str:
    number = ord(found[0])
    return f"\\x{number:02x}" if number < 0x100 else f"\\u{number:04x}" if number < 0x10000 else f"\\U{number:08x}"
