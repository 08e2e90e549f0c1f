"""Where a Dask scheduler may be: checked as text, before anything is imported for it."""

from urllib.parse import urlsplit

SCHEMES = ("tcp", "tls")


def checked_address(address: str) -> str:
    """Return the address of a scheduler as it was given.

    Raises
    ------
    ValueError
        It is none, in words.
    """
    expected = f"a cluster is named as in tcp://scheduler:8786, not {address!r:.80}"
    try:
        place = urlsplit(address)
        complete = place.scheme in SCHEMES and place.hostname and place.port
    except ValueError:  # of a port that is no number
        raise ValueError(expected) from None
    if not complete or place.path or place.query or place.fragment or place.username is not None:
        raise ValueError(expected)
    return address
