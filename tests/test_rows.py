from hypothesis import given
from hypothesis import strategies as st

from index.rows import folded


@given(st.text(st.characters(exclude_categories=[])))
def test_folded_text_can_be_stored_and_stays_as_it_is_when_folded_again(text: str) -> None:
    told = folded(text)
    told.encode()  # no half of a surrogate pair is left
    assert "\0" not in told
    assert folded(told) == told


@given(st.text(), st.text(), st.text())
def test_a_part_of_a_text_is_a_part_of_its_folded_form(before: str, part: str, after: str) -> None:
    assert folded(part) in folded(before + part + after)


def test_capitals_do_not_matter_in_any_script() -> None:
    assert folded("STRASSE Ωδή ÉCLAIR") == folded("straße ΩΔΉ éclair")
