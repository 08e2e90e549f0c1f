"""Signatures are those of the Standard Webhooks specification."""

import base64

from service.webhooks.signing import shown, signature


def test_the_specifications_own_example() -> None:
    secret = base64.b64decode("MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw")
    body = b'{"test": 2432232314}'
    made = signature(secret, "msg_p5jXN8AQM9LWM0D4loKWxJek", 1614265330, body)
    assert made == "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE="
    assert shown(secret) == "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"


def test_another_body_moment_or_secret_has_another_signature() -> None:
    made = {
        signature(b"s" * 32, "msg_1", 1, b"{}"),
        signature(b"s" * 32, "msg_1", 1, b"[]"),
        signature(b"s" * 32, "msg_1", 2, b"{}"),
        signature(b"s" * 32, "msg_2", 1, b"{}"),
        signature(b"t" * 32, "msg_1", 1, b"{}"),
    }
    assert len(made) == 5
