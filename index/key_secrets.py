"""API keys as their holders have them: ``fa_<id>_<random>``; of them only the SHA-256 is ever kept."""

import hashlib
import secrets

PREFIX = "fa"  # tells people, and programs that look for leaked secrets, what this is
ID_BYTES = 5  # public: names the key in lists, 10 hexadecimal digits
RANDOM_BYTES = 32  # 256 bits, so that nobody finds them by trying


def make_secret() -> tuple[str, str]:
    """Return the id of a new key, and the key itself."""
    key_id = secrets.token_hex(ID_BYTES)
    return key_id, f"{PREFIX}_{key_id}_{secrets.token_urlsafe(RANDOM_BYTES)}"


def digest_of(secret: bytes) -> bytes:
    """Return the SHA-256 of a key, 32 bytes.

    A slow hash with salt protects what people choose; 256 random bits need neither, and a quick one costs
    a request nothing.
    """
    return hashlib.sha256(secret).digest()


def id_in(secret: bytes) -> str:
    """Return the id that a key claims to have; empty where it is none of ours."""
    prefix, _, rest = secret.decode("ascii", errors="replace").partition("_")
    return rest.partition("_")[0] if prefix == PREFIX else ""
