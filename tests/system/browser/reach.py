"""Accessibility of the page: by keyboard, on every screen size, with other colours, on paper, by a screen reader."""
import base64
import os
import pathlib
import time

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import browser

small = "#experiment=three-glosses&n=4"
PLAY = {  # the samplers that each lesson offers at its end
    "sparkle": ["sphere.s", "seed"], "four-times": ["n", "seed"], "four-times-phong": ["n", "sphere.s", "seed"],
    "firefly": ["sphere.s", "firefly_k"], "sharper": ["sphere.s"], "furnace": ["furnace-s", "furnace-n"],
    "mixture": ["sphere.s", "sphere.rho_d", "sphere.rho_s"], "seeds": ["seed"],
    **{name: ["check-sampler", "check-theta"] for name in ("unbiased", "chi-square", "t-test", "fault")}}
ASKED = "document.getElementById('measure')"
SHEET = "document.getElementById('sheet').dataset.measured"


def tests(page, folder):
    def shot(driver, name):
        if os.environ.get("SHOTS"):
            driver.save_screenshot(str(pathlib.Path(os.environ["SHOTS"]) / f"{name}.png"))

    def answer(driver, lesson):
        """Goes from the question to the measurement; the focus is on the page before it."""
        browser.tab_to(driver, "#lessons input[name=answer], #guess")
        kind = driver.execute_script("return document.activeElement.type")
        if kind == "number":  # a box: its corners
            for corner in ("380", "140", "420", "190"):
                browser.keys(driver, corner, Keys.TAB)
            assert driver.find_elements(By.CSS_SELECTOR, "#lessons .over .region:nth-child(3)"), "the box is not drawn"
        else:
            browser.keys(driver, Keys.SPACE if kind == "radio" else Keys.ARROW_RIGHT)
        browser.tab_to(driver, "#measure")
        browser.keys(driver, Keys.ENTER)
        browser.wait(driver, "document.getElementById('reveal') || document.querySelector('#lessons .bad')")
        assert not driver.find_elements(By.CSS_SELECTOR, "#lessons .bad"), \
            f"{lesson}: {browser.text(driver, '#lessons')}"
        said = browser.text(driver, "#reveal")
        assert "measured here" in said, f"{lesson}: {said}"
        kind = driver.find_element(By.CSS_SELECTOR, "#reveal [data-kind]")
        assert kind.text, f"{lesson}: nothing is said of '{kind.get_attribute('data-kind')}'"
        assert "lesson has no sentence" not in kind.text, f"{lesson}: '{kind.get_attribute('data-kind')}' has no sentence"
        controls = ("[...document.querySelectorAll('#choices select, #knobs [data-path], #lessons section select')]"
                    ".filter((e) => e.checkVisibility()).map((e) => e.dataset.path ?? e.id)"
                    ".filter((name) => !name.startsWith('regions.'))")
        end = time.monotonic() + 20  # the bench below opens after the answer
        while (left := driver.execute_script("return " + controls)) != PLAY[lesson] and time.monotonic() < end:
            time.sleep(0.1)
        assert left == PLAY[lesson], f"{lesson}: to play with are {left}"
        focused = driver.execute_script("return document.activeElement.id")
        assert focused == "reveal", f"{lesson}: the focus is on '{focused}'"
        if lesson == "firefly":
            browser.wait(driver, "/largest X/.test(document.getElementById('pixel').textContent)")
        print(f"  {lesson}: {said.splitlines()[0]} ({kind.get_attribute('data-kind')})")

    def lessons_by_keyboard(driver):
        """Every lesson from its question to its measurement and on to the next, by keyboard only."""
        browser.open_page(driver, page, small)
        browser.tab_to(driver, "[data-tab=lessons]")
        browser.keys(driver, Keys.ENTER)
        ids = [e.get_attribute("data-lesson") for e in driver.find_elements(By.CSS_SELECTOR, "[data-lesson]")]
        assert len(ids) == 12, ids
        browser.wait(driver, "document.getElementById('status').textContent === ''")  # a number answers a question
        browser.tab_to(driver, "[data-lesson]")
        browser.keys(driver, Keys.ENTER)
        for lesson in ids:
            answer(driver, lesson)
            if lesson == "furnace":  # at another s
                browser.tab_to(driver, "#furnace-s")
                browser.keys(driver, Keys.HOME)
                browser.tab_to(driver, "#read-again")
                browser.keys(driver, Keys.ENTER)
                browser.wait(driver, "/s = 8, N = 1024/.test(document.getElementById('read').textContent)")
            if lesson == "unbiased":  # `check` in the page: another w_o
                browser.tab_to(driver, "#check-theta")
                browser.keys(driver, Keys.HOME)
                browser.tab_to(driver, "#check")
                browser.keys(driver, Keys.ENTER)
                browser.wait(driver, "document.querySelector('#check-result table')")
                assert "--wo 0" in browser.text(driver, "#check-result"), browser.text(driver, "#check-result")
                shot(driver, "check")
            browser.tab_to(driver, "#next")
            browser.keys(driver, Keys.ENTER)
        assert len(driver.find_elements(By.CSS_SELECTOR, "[data-lesson]")) == 12
        assert browser.text(driver, "#lessons").count("answered") == 12

    def sheet_for_teachers(driver):
        """Twelve lessons with the numbers of this page; it is printed alone, and axe finds nothing on it."""
        if "answer=" not in driver.current_url:
            browser.open_page(driver, page, small)
        driver.find_element(By.CSS_SELECTOR, "[data-tab=sheet]").click()
        browser.wait(driver, SHEET)
        articles = [a.text for a in driver.find_elements(By.CSS_SELECTOR, "#sheet article")]
        assert len(articles) == 12
        for text in articles:
            for word in ("minutes", "Aim.", "Question.", "Expected.", "Say."):
                assert word in text, f"no '{word}' in {text}"
            assert any(c.isdigit() for c in text.split("Expected.")[1].split("Say.")[0]), text
        nothing_found(driver, "the sheet")
        shot(driver, "sheet")
        browser.media(driver, "print")
        hidden = driver.execute_script("return ['#tabs', '#bench', '#sheet button'].map((css) => "
                                       "getComputedStyle(document.querySelector(css)).display)")
        assert set(hidden) == {"none"}, hidden
        browser.media(driver)
        printed = driver.execute_cdp_cmd("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69})
        paper = base64.b64decode(printed["data"])
        pages = paper.count(b"/Type /Page\n")
        assert 2 <= pages <= 8, f"{pages} sheets of paper"
        if os.environ.get("SHOTS"):
            (pathlib.Path(os.environ["SHOTS"]) / "sheet.pdf").write_bytes(paper)

    def fits_every_screen(driver):
        """From 320 px, which is 1280 px at 400 %, to 4K, light and dark: nothing scrolls sideways."""
        for address, until in ((small + "&pixel=80,30", browser.FINISHED), ("#lesson=fault", ASKED),
                               ("#lesson=sparkle", ASKED), (small + "&view=heat", browser.FINISHED)):
            browser.open_page(driver, page, address, until=until)
            for scheme in ("light", "dark"):
                browser.media(driver, prefers_color_scheme=scheme)
                for width, height in ((320, 256), (360, 740), (768, 1024), (1280, 900), (3840, 2160)):
                    browser.size(driver, width, height)
                    wide = driver.execute_script("return document.documentElement.scrollWidth - innerWidth")
                    assert wide <= 0, f"{address} at {width} px: {wide} px too wide"
                    name = "heat" if "heat" in address else "lesson" if "lesson" in address else "bench"
                    shot(driver, f"{name}-{scheme}-{width}")

    def rows_stand_beside_each_other(driver):
        """Metrics of neighbouring arms have one line each, for any length of the words above them."""
        browser.open_page(driver, page, "#experiment=three-glosses&n=4&arms=uniform,cosine,phong")
        for width in (700, 1000, 1280, 1600, 3840):
            browser.size(driver, width, 900)
            tops = driver.execute_script(
                "return [...document.querySelectorAll('#pictures .shown')].map((f) => [f, f.querySelector('tr')].map("
                "(e) => Math.round(e.getBoundingClientRect().top)))")
            for top, row in tops:
                assert all(r == row for t, r in tops if t == top), f"rows at {width} px: {tops}"
        browser.open_page(driver, page, "#experiment=three-glosses&n=4&arms=uniform,phong&view=heat")
        apart = driver.execute_script(
            "const [words, bar] = ['.reference figcaption', '.bar'].map((css) => document.querySelector(css));"
            "return bar.getBoundingClientRect().top - words.getBoundingClientRect().bottom")
        assert 0 <= apart < 24, f"the scale is {apart} px under the reference's name"

    def other_colours_and_no_motion(driver):
        """Forced colours keep borders, outlines and focus; with reduced motion, as without, nothing moves by itself."""
        browser.media(driver, forced_colors="active", prefers_reduced_motion="reduce")
        browser.open_page(driver, page, small + "&pixel=80,30")
        shot(driver, "forced")
        driver.execute_script("document.getElementById('n').focus()")
        facts = driver.execute_script("""
            const style = (css) => getComputedStyle(document.querySelector(css));
            const line = (css) => style(css).borderBottomColor;
            return {forced: matchMedia('(forced-colors: active)').matches,
                still: matchMedia('(prefers-reduced-motion: reduce)').matches,
                border: style('.over .region').borderTopStyle, button: style('button').borderTopStyle,
                moving: document.getAnimations().length, focus: style('#n').outlineStyle,
                chosen: line('#tabs a[aria-current]') !== line('#tabs a:not([aria-current])')}""")
        assert facts == {"forced": True, "still": True, "border": "solid", "button": "solid", "moving": 0,
                         "focus": "solid", "chosen": True}, facts
        nothing_found(driver, "forced colours")
        picture = "return document.querySelector('canvas').toDataURL()"
        before = driver.execute_script(picture)
        driver.execute_async_script("setTimeout(arguments[0], 300)")
        assert before == driver.execute_script(picture), "noise moves unasked"

    def tab_order(driver):
        """The tab key reaches every control, in reading order, and none is a trap; the focus is visible."""
        browser.open_page(driver, page, small + "&pixel=80,30")
        driver.execute_script("document.getElementById('controls').open = true")
        order = driver.execute_script("""
            const can = 'a[href], button, input, select, summary, [tabindex="0"]';
            const all = [...document.querySelectorAll(can)].filter((e) => e.checkVisibility());
            return all.map((e, k) => (e.dataset.order = k))""")
        driver.execute_script("document.activeElement.blur(); window.getSelection().removeAllRanges()")
        seen = []
        for _ in order:
            browser.keys(driver, Keys.TAB)
            at, outline, name = driver.execute_script(
                "const e = document.activeElement;"
                "return [e.dataset.order, getComputedStyle(e).outlineStyle, e.outerHTML.slice(0, 120)]")
            assert outline != "none", f"the focus on {name} is not seen"
            seen.append(int(at) if at is not None else name)
        assert seen == order, f"reached {seen}"

    def corners_are_moved(driver, box, was):
        """By keyboard and by pointer, on the bench; no corner passes the opposite one."""
        x0, y0, x1, y1 = was
        corner = "#pictures .reference [data-corner='mine 2 3']"
        driver.execute_script("document.querySelector(arguments[0]).focus()", corner)
        for strokes, right in (((Keys.ARROW_RIGHT,), x1 + 1), ((Keys.SHIFT, Keys.ARROW_RIGHT), x1 + 11),
                               ((Keys.ARROW_LEFT,), x1 + 10), ((Keys.SHIFT, Keys.ARROW_LEFT, Keys.ARROW_LEFT), x0 + 1)):
            browser.keys(driver, *strokes)
            browser.wait(driver, f"({box}).join() === '{x0},{y0},{right},{y1}' && {browser.FINISHED}")
            assert driver.execute_script("return document.activeElement.matches(arguments[0])", corner), \
                "the focus is lost"
        nothing_found(driver, "a box that was drawn")
        hand = ActionChains(driver).click_and_hold(driver.find_element(By.CSS_SELECTOR, corner))
        hand.move_by_offset(30, -20).release().perform()
        browser.wait(driver, f"({box})[2] > {x0 + 5} && ({box})[3] > {y1} && {browser.FINISHED}")
        hand = ActionChains(driver).click_and_hold(driver.find_element(By.CSS_SELECTOR, corner))
        hand.move_by_offset(-250, 150).release().perform()  # beyond the corner at the bottom left
        browser.wait(driver, f"({box}).join() === '{x0},{y0},{x0 + 1},{y0 + 1}' && {browser.FINISHED}")

    def regions_are_drawn(driver):
        """A region is dragged on a picture or entered: both reach the address, the outline and the metrics."""
        browser.open_page(driver, page, small)
        canvas = driver.find_element(By.CSS_SELECTOR, "#pictures canvas")
        hand = ActionChains(driver).move_to_element_with_offset(canvas, -60, 20)
        hand.click_and_hold().move_by_offset(90, -40).release().perform()
        browser.wait(driver, f"location.hash.includes('regions.mine.box') && {browser.FINISHED}")
        assert "RMSE of mine" in browser.text(driver, "#pictures")
        driver.execute_script("document.getElementById('controls').open = true")
        browser.tab_to(driver, "[aria-label='region mine left']")
        browser.keys(driver, Keys.CONTROL, "a")
        browser.keys(driver, "7", Keys.TAB)
        browser.wait(driver, f"/regions.mine.box=\\[7,/.test(decodeURIComponent(location.hash)) && {browser.FINISHED}")
        box = ("JSON.parse(/regions.mine.box=(.[0-9, ]+.)/"
               ".exec(decodeURIComponent(location.hash).replaceAll('+', ' '))[1])")
        x0, y0, x1, y1 = driver.execute_script("return " + box)
        browser.tab_to(driver, "[aria-label='region mine right']")
        browser.keys(driver, Keys.CONTROL, "a")
        browser.keys(driver, "3", Keys.TAB)  # left of its left end: it stops next to it
        browser.wait(driver, f"({box}).join() === '{x0},{y0},{x0 + 1},{y1}' && {browser.FINISHED}")
        assert browser.text(driver, "#wrong") == "", browser.text(driver, "#wrong")
        corners_are_moved(driver, box, (x0, y0, x0 + 1, y1))
        driver.execute_script("document.querySelector('#pictures canvas').focus()")
        browser.keys(driver, Keys.ARROW_RIGHT)
        browser.wait(driver, "document.querySelector('#pixel .disk')")
        browser.open_page(driver, page, "#lesson=sparkle", until=ASKED)
        browser.wait(driver, "document.querySelector('#lessons canvas').toDataURL().length > 30000")  # painted
        canvas = driver.find_element(By.CSS_SELECTOR, "#lessons canvas")
        hand = ActionChains(driver).move_to_element_with_offset(canvas, -60, 40)
        hand.click_and_hold().move_by_offset(60, -30).release().perform()
        shot(driver, "region")
        typed = driver.execute_script("return [...document.querySelectorAll('#lessons .number')].map((e) => +e.value)")
        assert typed[0] > 0 and typed[0] < typed[2] and typed[1] < typed[3], typed

    source = folder / "node_modules/axe-core/axe.min.js"

    def nothing_found(driver, where):
        if source.exists():
            found = browser.axe(driver, source.read_text())
            assert found == [], f"{where}: {found}"

    def nothing_for_axe(driver):
        """axe-core finds nothing: the bench with a pixel open, a lesson before and after the guess; light and dark."""
        if not source.exists():
            print("  skipped: no axe-core (npm ci in tests/system/browser)")
        for scheme in ("light", "dark"):
            browser.media(driver, prefers_color_scheme=scheme)
            for address, until in ((small + "&view=heat&pixel=80,30", browser.FINISHED), ("#lesson=fault", ASKED),
                                   ("#lesson=chi-square&answer=chi-square:wrong", "document.getElementById('reveal')")):
                browser.open_page(driver, page, address, until=until)
                nothing_found(driver, f"{address}, {scheme}")

    def everything_has_a_name(driver):
        """Each control and picture of the accessibility tree has a name."""
        browser.open_page(driver, page, small + "&pixel=80,30")
        tree = driver.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]
        wanted = {"button", "link", "textbox", "slider", "combobox", "radio", "img", "image",
                  "heading", "graphics-document"}
        nameless = [n for n in tree if not n.get("ignored") and n.get("role", {}).get("value") in wanted
                    and not n.get("name", {}).get("value")]
        assert nameless == [], nameless[:3]

    return [lessons_by_keyboard, sheet_for_teachers, fits_every_screen, rows_stand_beside_each_other,
            other_colours_and_no_motion, tab_order, regions_are_drawn, nothing_for_axe, everything_has_a_name]
