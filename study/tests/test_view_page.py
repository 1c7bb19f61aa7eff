# The page of study/view in headless Chromium: it loads, plays and obeys, without a complaint.
import time
from pathlib import Path

import pytest

from study.tests.test_view import view

# The pixels of the picture, from a copy: reading the page's own canvas would slow it down.
PIXELS = """(() => {
  const view = document.getElementById("view"), copy = document.createElement("canvas");
  [copy.width, copy.height] = [view.width, view.height];
  const pen = copy.getContext("2d", {willReadFrequently: true});
  pen.drawImage(view, 0, 0);
  return new Uint32Array(pen.getImageData(0, 0, copy.width, copy.height).data.buffer);
})()"""
# How many of them differ from those of the last time that this was asked.
CHANGED = f"""(() => {{
  const pixels = {PIXELS}, old = window.before ?? pixels;
  window.before = pixels;
  return pixels.reduce((count, pixel, i) => count + (pixel !== old[i]), 0);
}})()"""
PAINTED = f"new Set({PIXELS}).size"


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    for scene, *more in (("crank",), ("top",), ("chain:10000",)):
        done = view(folder, scene, "--duration", "4", *more)
        assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture
def opened(browser, pages):
    """Opens a page, and looks for complaints and requests when the test is done."""
    def open_page(name, **features):
        browser.complaints.clear()
        browser.requests.clear()
        browser.prefer(**{"prefers_reduced_motion": "reduce", "prefers_color_scheme": "light",
                          **features})
        browser.open(pages / name)
        browser.wait("document.getElementById('time').textContent !== ''")
        return browser
    yield open_page
    browser.resize(1200, 760)
    assert browser.complaints == []
    assert all(url.startswith(("file:", "data:")) for url in browser.requests), browser.requests
    assert len(browser.requests) <= 2


def shown(browser):
    return float(browser.value("document.getElementById('scrub').value"))


def settle(browser):
    browser.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


@pytest.mark.parametrize("name", ["crank.html", "top.html", "chain-10000.html"])
def test_it_plays_by_itself_and_pauses(opened, name):
    page = opened(name, prefers_reduced_motion="no-preference")
    assert page.value(PAINTED) > 20
    first = shown(page)
    page.value(CHANGED)
    page.wait(f"+document.getElementById('scrub').value > {first} + 0.1")
    assert page.value(CHANGED) > 100
    page.value("document.getElementById('play').click()")
    settle(page)
    stopped = shown(page)
    time.sleep(0.2)
    assert shown(page) == stopped


def test_it_waits_where_motion_is_not_wanted(opened):
    page = opened("crank.html")
    time.sleep(0.2)
    assert shown(page) == 0


def test_scrubbing_shows_another_instant_and_its_values(opened):
    page = opened("crank.html")
    page.value(CHANGED)
    page.value("""(() => { const scrub = document.getElementById("scrub");
                  scrub.value = 1.6; scrub.dispatchEvent(new Event("input")); })()""")
    settle(page)
    assert "t = 1.6000 of 4 s" in page.value("document.getElementById('time').textContent")
    assert page.value(CHANGED) > 100
    values = page.value("document.getElementById('energy-values').textContent")
    assert values == "kinetic 2.232 potential 2.768 total 5".replace(" p", "p").replace(" t", "t")


def test_keys_step_and_play(opened):
    page = opened("crank.html")
    page.key("ArrowRight")
    settle(page)
    one = shown(page)
    assert 0 < one < 0.02
    page.key("ArrowRight", modifiers=8)
    settle(page)
    assert shown(page) == pytest.approx(11 * one, rel=1e-3)
    page.key("End")
    settle(page)
    assert shown(page) == 4
    page.key("Home")
    page.key(" ")
    page.wait("+document.getElementById('scrub').value > 0.05")
    assert page.value("document.getElementById('play').getAttribute('aria-label')") == "Pause"


def test_the_end_loops_or_stops(opened):
    page = opened("crank.html")
    for loops in (True, False):
        page.value(f"document.getElementById('loop').checked !== {str(loops).lower()} && "
                   "document.getElementById('loop').click()")
        page.value("""(() => { const scrub = document.getElementById("scrub"); scrub.value = 3.95;
                      scrub.dispatchEvent(new Event("input")); })()""")
        page.key(" ")
        if loops:
            page.wait("+document.getElementById('scrub').value < 1")
            page.key(" ")
        else:
            page.wait("document.getElementById('play').getAttribute('aria-label') === 'Play'")
            assert shown(page) == 4


@pytest.mark.parametrize("name", ["crank.html", "top.html"])
def test_dragging_and_the_wheel_change_the_view_and_fit_brings_it_back(opened, name):
    page = opened(name)
    page.value(CHANGED)
    page.value("void (window.first = window.before)")
    page.mouse(("mousePressed", 300, 500), ("mouseMoved", 380, 540), ("mouseReleased", 380, 540))
    settle(page)
    assert page.value(CHANGED) > 1000
    page.mouse(("mouseWheel", 300, 400))
    settle(page)
    assert page.value(CHANGED) > 1000
    if name == "crank.html":
        page.value("document.getElementById('fit').click()")
        page.mouse(("mouseMoved", 5, 755))
        settle(page)
        page.value("void (window.before = window.first)")
        assert page.value(CHANGED) == 0


def test_a_click_on_a_point_traces_it(opened):
    page = opened("crank.html")
    names = "[...document.querySelectorAll('#traces button')].map((chip) => chip.textContent)"
    assert page.value(names)[0] == "E"
    page.value("document.querySelector('#traces button').click()")
    assert "E" not in page.value(names)
    found = page.value("""(() => {
      const view = document.getElementById("view"), box = view.getBoundingClientRect();
      const tip = document.getElementById("tip");
      for (let y = 0; y < box.height; y += 8) {
        for (let x = 0; x < box.width; x += 8) {
          view.dispatchEvent(new PointerEvent("pointermove", {
            pointerType: "mouse", clientX: box.left + x, clientY: box.top + y}));
          if (!tip.hidden && tip.textContent.startsWith("E ")) return [box.left + x, box.top + y];
        }
      }
    })()""")
    page.mouse(("mousePressed", *found), ("mouseReleased", *found))
    assert "E" in page.value(names)


def test_the_chart_of_outputs_shows_the_chosen_one(opened):
    page = opened("crank.html")
    values = "document.getElementById('output-values').textContent"
    assert page.value("[...document.getElementById('output-name').options].map((o) => o.label)") == [
        "turned", "slider"]
    page.key("End")
    settle(page)
    assert page.value(values) == "16"
    page.value("""(() => { const list = document.getElementById("output-name");
                  list.value = 1; list.dispatchEvent(new Event("change")); })()""")
    settle(page)
    assert page.value(values).startswith("x 0.709") and "y 0" in page.value(values)


def test_a_phone_sees_everything(opened):
    page = opened("top.html")
    page.resize(390, 844, 2, True)
    settle(page)
    assert page.value("document.documentElement.scrollWidth") <= 390
    for part in ("view", "play", "scrub", "energy"):
        box = page.value(f"(() => {{ const box = document.getElementById('{part}')"
                         ".getBoundingClientRect(); return [box.left, box.right, box.height]; })()")
        assert 0 <= box[0] < box[1] <= 390 and box[2] > 20, part


def test_dark_and_light_differ(opened, tmp_path):
    page = opened("crank.html", prefers_color_scheme="dark")
    background = "getComputedStyle(document.body).backgroundColor"
    dark = page.value(background)
    page.value(CHANGED)
    page.prefer(prefers_color_scheme="light", prefers_reduced_motion="reduce")
    settle(page)
    assert page.value(background) != dark and page.value(CHANGED) > 1000
    page.screenshot(Path(tmp_path / "light.png"))
    assert (tmp_path / "light.png").stat().st_size > 10_000


def test_the_browser_notices_complaints(browser, tmp_path):
    broken = tmp_path / "broken.html"
    broken.write_text("<script>console.error('one'); nothing.there();</script>")
    browser.complaints.clear()
    browser.open(broken)
    browser.value("1")
    assert len(browser.complaints) >= 2
    browser.complaints.clear()
