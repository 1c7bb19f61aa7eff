# The site of a whole run in headless Chromium: every page, light and dark, narrow and wide, every link.
from urllib.parse import parse_qs

import pytest

from study.tests.browser import HIDDEN, TALL

from analysis.core.view import parts

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("smoke")]
PAGES = ["index", "explore", *parts()]

LINKS = "[...document.querySelectorAll('a[href]')].map(one => one.getAttribute('href'))"
BEYOND = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
CONTRAST = """(() => {
  const colour = getComputedStyle(document.body), brightness = text => text.match(/[\\d.]+/g).slice(0, 3)
    .map(Number).reduce((sum, one) => sum + one, 0) / 3;
  return Math.abs(brightness(colour.color) - brightness(colour.backgroundColor));
})()"""


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_whole_at_every_width(browser, smoke, name):
    for width in (360, 1300, 1600):
        browser.resize(width, 900)
        browser.open(smoke / f"{name}.html")
        assert browser.value(BEYOND) <= 0, f"{name}.html is wider than {width} px"
        if width >= 1300:
            assert browser.value(TALL) == [], f"{name}.html has something taller than two screens at {width} px"
            assert browser.value(HIDDEN) == [], f"{name}.html hides something at {width} px"
    assert browser.value("document.querySelectorAll('h1').length") == 1
    assert browser.value("[...document.images].every(one => one.complete && one.naturalWidth > 0 && one.alt)")


@pytest.mark.parametrize("name", PAGES)
def test_it_can_be_read_in_light_and_dark(browser, smoke, name):
    for scheme in ("light", "dark"):
        browser.prefer(prefers_color_scheme=scheme)
        browser.open(smoke / f"{name}.html")
        assert browser.value(CONTRAST) > 150, scheme
    browser.prefer(prefers_color_scheme="light")


def test_every_link_leads_somewhere(browser, smoke):
    broken, questions = [], set()
    for name in PAGES:
        browser.open(smoke / f"{name}.html")
        for link in browser.value(LINKS):
            file, _, anchor = link.partition("#")
            target = smoke / (file or f"{name}.html")
            if not target.exists():
                broken.append((name, link))
            elif file == "explore.html":  # what follows '#' is a question there
                questions.add(anchor)
            elif anchor and f'id="{anchor}"' not in target.read_text(encoding="utf-8"):
                broken.append((name, link))
    assert broken == []
    browser.open(smoke / "explore.html")
    for question in filter(None, questions):  # the page writes what it understood into its address
        browser.value(f"new Promise((done) => {{ addEventListener('hashchange', done); location.hash = {question!r}; }})")
        assert parse_qs(question).items() <= parse_qs(browser.value("location.hash.slice(1)")).items(), question


def test_one_clicks_through_all_parts_without_a_complaint(browser, smoke):
    browser.open(smoke / "index.html")
    for name in parts():
        browser.value(f"document.querySelector('nav a[href=\"{name}.html\"]').click()")
        browser.wait(f"location.pathname.endsWith('/{name}.html') && document.readyState === 'complete'")
        assert browser.value("document.querySelector('nav a[aria-current]').textContent") == name
    assert browser.complaints == []
    assert all(address.startswith(("file:", "data:")) for address in browser.requests)


def test_every_part_answers(smoke):
    from analysis.core.files import read_json
    for part in parts():
        answers = read_json(smoke / part / "answers.json")["answers"]
        assert 1 <= len(answers) <= 4 and all(one["text"].endswith(".") for one in answers), part
