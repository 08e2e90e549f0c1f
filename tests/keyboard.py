"""What somebody reaches who has no pointer: every control in turn, each with its focus to be seen."""

from playwright.sync_api import Page

MARK = "data-tabbed"
MOST = 300  # steps of a way round a page
CONTROLS = f"""() => {{
  const modal = document.querySelector("dialog:modal");
  const fields = "button:not(:disabled), input:not(:disabled), select, textarea";
  const wanted = `a[href], ${{fields}}, summary, [tabindex='0']`;
  const here = [...(modal ?? document).querySelectorAll(wanted)].filter((one) => one.checkVisibility({{
    visibilityProperty: true, contentVisibilityAuto: false }}) && one.tabIndex >= 0);
  here.forEach((one, place) => one.setAttribute("{MARK}", place));
  return here.map((one) => one.outerHTML.slice(0, 160));
}}"""
FOCUSED = f"""() => {{
  const one = document.activeElement;
  const {{ outlineStyle, outlineWidth }} = getComputedStyle(one);
  const mark = one.getAttribute("{MARK}");
  const box = one.getBoundingClientRect();
  return [mark === null ? null : Number(mark), outlineStyle !== "none" && parseFloat(outlineWidth) >= 2,
    box.bottom > 0 && box.top < innerHeight];
}}"""


def assert_reachable(page: Page) -> None:
    """Go round with Tab; each control is met, in the order of the page, with an outline, and in view."""
    controls: list[str] = page.evaluate(CONTROLS)
    page.evaluate("document.activeElement.blur(); document.getSelection().removeAllRanges()")
    met: list[int] = []
    for _ in range(min(MOST, len(controls) + 10)):
        page.keyboard.press("Tab")
        place, outlined, in_view = page.evaluate(FOCUSED)
        if place is None or place in met:
            continue  # the browser's own, or the second round
        assert outlined, f"the focus is not seen at {controls[place]}"
        assert in_view, f"the focus is out of view at {controls[place]}"
        met.append(place)
    missed = [control for place, control in enumerate(controls) if place not in met]
    assert not missed, f"Tab does not lead to {missed}"
