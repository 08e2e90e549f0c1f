"""What a file says, repeated in a message for people: cut to a length, and nothing that disturbs a screen."""

import unicodedata

LONGEST = 100  # characters of a name

_UNSEEN = {"Cc", "Cs", "Zl", "Zp"}  # control characters, halves of characters, line ends
_TURNING = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")  # they reverse what follows
_PICTURES = 0x2400  # of the first control characters: ␀ for zero
_UNKNOWN = "\N{REPLACEMENT CHARACTER}"


def shown(text: str | bytes, longest: int = LONGEST) -> str:
    """Return text in quotes for a message.

    Parameters
    ----------
    text : str or bytes
        A name or a word as it came; bytes are taken for UTF-8.
    longest : int
        Characters that are shown; what is longer ends in “…”.
    """
    if isinstance(text, bytes):
        text = text[: 4 * longest + 4].decode("utf-8", "replace")
    seen = "".join(_seen(character) for character in text[:longest])
    return f"“{seen}…”" if len(text) > longest else f"“{seen}”"


def _seen(character: str) -> str:
    if ord(character) < 32:
        return chr(_PICTURES + ord(character))
    unseen = unicodedata.category(character) in _UNSEEN or character in _TURNING
    return _UNKNOWN if unseen else character
