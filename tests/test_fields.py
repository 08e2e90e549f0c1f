"""Text from outside is read strictly."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.intake.fields import (
    BadField,
    BadMetadata,
    UnreadableWeights,
    check_metadata,
    check_name,
    read_flag,
    read_metadata,
    read_weights,
)

NAMES = st.from_regex(r"[a-z][a-z0-9.-]{0,20}", fullmatch=True)
JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**60), 2**60)
    | st.text(st.characters(codec="utf-8", exclude_characters="\0")),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(NAMES, inner, max_size=3),
    max_leaves=10,
)


@given(st.dictionaries(NAMES, JSON))
def test_any_json_object_is_metadata(value: dict[str, object]) -> None:
    assert read_metadata(json.dumps(value)) == value


@pytest.mark.parametrize(
    "text",
    [
        "[]",
        "1",
        "",
        "{",
        '{"a": NaN}',
        '{"a": "\\ud800"}',
        '{"a": "\\u0000"}',
        '{"\\u0000": 1}',
        "[" * 50_000,
    ],
)
def test_what_no_database_could_hold_is_not_metadata(text: str) -> None:
    with pytest.raises(BadMetadata):
        read_metadata(text)


@pytest.mark.parametrize(("inner", "outer"), [("{", "}"), ("[", "]")])
def test_metadata_may_be_nested_but_not_without_end(inner: str, outer: str) -> None:
    def nested(levels: int) -> str:
        opened, closed = ('{"a":', "}") if inner == "{" else (inner, outer)
        return '{"a":' + opened * (levels - 1) + "1" + closed * (levels - 1) + "}"

    assert read_metadata(nested(32))
    with pytest.raises(BadMetadata, match="deeper"):
        read_metadata(nested(33))


def test_metadata_with_a_backslash_before_zeros_is_kept() -> None:
    value = {"path": "a\\u0000b"}
    assert check_metadata(value) == value


@given(st.dictionaries(NAMES, st.floats(0, 100, allow_nan=False), min_size=1))
def test_both_ways_to_write_weights_mean_the_same(weights: dict[str, float]) -> None:
    as_list = ",".join(f"{block}:{weight!r}" for block, weight in weights.items())
    assert read_weights(as_list) == read_weights(json.dumps(weights)) == weights


@pytest.mark.parametrize(
    "text", ["log-hks", "log-hks:", "log-hks:x", "{", '{"a": "x"}', '{"a": null}', "a:1,a:2", ","]
)
def test_unreadable_weights_are_refused(text: str) -> None:
    with pytest.raises(UnreadableWeights):
        read_weights(text)


def test_no_weights_are_no_weights() -> None:
    assert read_weights(None) is None
    assert read_weights("") is None


@pytest.mark.parametrize("name", ["", "  ", "a\nb", "x" * 501, "\ud800"])
def test_a_name_is_printable_and_not_too_long(name: str) -> None:
    with pytest.raises(BadField):
        check_name(name)


def test_a_name_loses_its_outer_blanks() -> None:
    assert check_name(" Krug 1 ") == "Krug 1"


def test_flags_are_words_not_guesses() -> None:
    assert [read_flag("f", word) for word in ("true", "1", " Yes ", "on")] == [True] * 4
    assert [read_flag("f", word) for word in ("false", "0", "no", "off", "")] == [False] * 5
    with pytest.raises(BadField, match="maybe"):
        read_flag("f", "maybe")
