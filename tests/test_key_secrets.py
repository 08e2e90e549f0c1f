"""What a holder has cannot be guessed, and what is kept of it opens nothing."""

import hashlib

import pytest

from index.key_secrets import RANDOM_BYTES, digest_of, id_in, make_secret


def test_a_key_says_what_it_is_and_which_and_holds_256_random_bits() -> None:
    key_id, secret = make_secret()
    prefix, told, random = secret.split("_", 2)
    assert (prefix, told) == ("fa", key_id)
    assert RANDOM_BYTES * 8 >= 256
    assert len(random) >= RANDOM_BYTES * 4 / 3  # base 64


def test_no_two_keys_are_alike() -> None:
    made = [make_secret() for _ in range(200)]
    assert len({key_id for key_id, _ in made}) == len(made)
    assert len({secret.split("_", 2)[2] for _, secret in made}) == len(made)


def test_the_id_is_read_from_a_key_and_from_nothing_else() -> None:
    key_id, secret = make_secret()
    assert id_in(secret.encode()) == key_id
    for other in (b"", b"a-long-secret", b"fa", b"fb_0123_x", b"\xff\xfe", secret.encode()[1:]):
        assert id_in(other) == ""


@pytest.mark.parametrize("secret", [b"", b"fa_0_x", "clé".encode()])
def test_the_digest_is_sha_256(secret: bytes) -> None:
    assert digest_of(secret) == hashlib.sha256(secret).digest()
