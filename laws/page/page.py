"""The page in Chromium, from a file, offline: page.py PAGE BUNDLE NATIVE EXPERIMENT... .
NATIVE has the program's hashes."""
import base64
import gzip
import os
import pathlib
import random
import re
import sys

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import browser

page_path, bundle, native_path, *experiments = sys.argv[1:]
page = pathlib.Path(page_path).resolve().as_uri()
axe = pathlib.Path(page_path).resolve().parent / "node_modules/axe-core/axe.min.js"
laws = []


def law(test):
    laws.append(test)
    return test


def quiet(driver):
    assert (said := browser.console(driver)) == [], f"the console has lines: {said}"
    assert (asked := browser.requests(driver)) == [], f"the page asked for {asked}"


@law
def same_bits():
    """Every arm, three scenes, every rung, and the references: the program's hashes in Chromium."""
    native = set(pathlib.Path(native_path).read_text().split("\n"))
    driver = browser.chromium()
    try:
        driver.get("about:blank")
        driver.execute_script(pathlib.Path(bundle).read_text())
        packed = re.search(r'id="module">([^<]+)<', pathlib.Path(page_path).read_text()).group(1)
        module = base64.b64encode(gzip.decompress(base64.b64decode(packed))).decode()
        for file in experiments:
            lines = driver.execute_async_script(
                "const [b, f, t, done] = arguments;"
                "WebAssembly.compile(Uint8Array.from(atob(b), (c) => c.charCodeAt(0)))"
                ".then((m) => done(crescentHashes(m, f, t)), (e) => done([String(e)]))",
                module, file, pathlib.Path(file).read_text())
            assert len(lines) > 3, lines
            for line in lines:
                assert line in native, f"not of the program: {line}"
    finally:
        driver.quit()


@law
def opens_and_measures():
    """The gallery to N = 64 without a console line or a request, and the note's figures beside."""
    driver = browser.chromium()
    try:
        took = browser.open_page(driver, page)
        first = driver.execute_script("return document.documentElement.dataset.first")
        workers = driver.execute_script("return document.documentElement.dataset.workers")
        print(f"  first picture after {first} ms, "
              f"three arms at N = 64 with the reference after {took} ms, {workers} workers")
        assert int(workers) >= 1
        assert "published" in browser.text(driver, "#pictures")
        assert len(driver.find_elements(By.CSS_SELECTOR, "#pictures canvas")) == 4
        quiet(driver)
    finally:
        driver.quit()


@law
def address_is_data():
    """Nonsense in the address gives defaults and lines that say so."""
    driver = browser.chromium()
    try:
        browser.open_page(driver, page, "#experiment=%3Cscript%3E&arms=evil,phong&n=7&view=x"
                          "&set=__proto__.x=1&set=sphere.s=-4&pixel=a&arm=9")
        said = browser.text(driver, "#wrong")
        for word in ("experiment=", "arms=", "n=7", "view=", "set=", "pixel=", "arm="):
            assert word in said, f"{word} is not told: {said}"
        assert "sphere.s" in said, f"a value out of range is not told: {said}"
        quiet(driver)
    finally:
        driver.quit()


@law
def slices_without_workers():
    """The program's hash stands under the picture; where workers are refused, the same come in slices."""
    small = "#experiment=three-glosses&n=16"
    found = []
    for refuse in (False, True):
        driver = browser.chromium()
        try:
            if refuse:
                driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
                    "source": "window.Worker = function () { throw new Error('refused'); };"})
            browser.open_page(driver, page, small, 120)
            workers = driver.execute_script("return document.documentElement.dataset.workers")
            assert (workers == "0") == refuse, workers
            found.append([e.text for e in driver.find_elements(By.CSS_SELECTOR, "[data-hash]")])
            quiet(driver)
        finally:
            driver.quit()
    assert os.environ["SHOWN"] in found[0] and found[0] == found[1], found


@law
def lessons_by_keyboard():
    """Every lesson from its question to what was measured, by keys alone."""
    driver = browser.chromium()
    try:
        browser.open_page(driver, page, "#experiment=three-glosses&n=16")
        ids = driver.execute_script(
            "document.querySelector('[data-tab=lessons]').focus(); return null")
        driver.switch_to.active_element.send_keys(Keys.ENTER)
        ids = [e.get_attribute("data-lesson") for e in driver.find_elements(By.CSS_SELECTOR, "[data-lesson]")]
        assert len(ids) >= 8, ids
        first = driver.find_element(By.CSS_SELECTOR, "[data-lesson]")
        driver.execute_script("arguments[0].focus()", first)
        first.send_keys(Keys.ENTER)
        for lesson in ids:
            radios = driver.find_elements(By.CSS_SELECTOR, "#lessons input[type=radio]")
            active = radios[0] if radios else driver.find_element(By.ID, "guess")
            driver.execute_script("arguments[0].focus()", active)
            active.send_keys(Keys.SPACE if radios else Keys.ARROW_RIGHT)
            active.send_keys(Keys.ENTER)
            browser.wait(driver, "document.getElementById('reveal') || document.querySelector('#lessons .bad')", 120)
            assert not driver.find_elements(By.CSS_SELECTOR, "#lessons .bad"), \
                f"{lesson}: {browser.text(driver, '#lessons')}"
            said = browser.text(driver, "#reveal")
            assert "measured here" in said, f"{lesson}: {said}"
            print(f"  {lesson}: {said.splitlines()[0]}")
            button = driver.find_element(By.CSS_SELECTOR, "#lessons button[type=button]")
            button.send_keys(Keys.ENTER)
        quiet(driver)
    finally:
        driver.quit()


@law
def fits_every_screen():
    """From 360 px to 4K, light and dark: nothing scrolls sideways."""
    driver = browser.chromium()
    try:
        browser.open_page(driver, page, "#experiment=three-glosses&n=16&pixel=80,30")
        for dark in (False, True):
            browser.dark(driver, dark)
            for width, height in ((360, 740), (768, 1024), (1280, 900), (3840, 2160)):
                browser.size(driver, width, height)
                wide = driver.execute_script("return document.documentElement.scrollWidth - innerWidth")
                assert wide <= 0, f"{width} px: {wide} px too wide"
        quiet(driver)
    finally:
        driver.quit()


@law
def two_hundred_settings():
    """Two hundred random settings, each to its end: the module takes no more memory than after the first twenty."""
    draw = random.Random(7)
    driver = browser.chromium()
    try:
        browser.open_page(driver, page, "#experiment=three-glosses&n=4")
        sizes = []
        for turn in range(200):
            arms = draw.sample(["uniform", "cosine", "phong", "mixture", "ggx-vndf", "mis-balance"], 3)
            fill = f"&set=fill.radiance=[{0.1 * (turn // 20):.1f}, 1, 1]"  # another reference now and then
            driver.execute_script("location.hash = arguments[0]", f"experiment=three-glosses&n=4&arms={','.join(arms)}"
                                  f"&set=seed={draw.randrange(2**32)}{fill}")
            browser.wait(driver, f"{browser.FINISHED} && document.getElementById('arm-0').value === '{arms[0]}'")
            sizes.append(int(driver.execute_script("return document.documentElement.dataset.memory")))
        assert max(sizes[20:]) <= max(sizes[:20]), f"memory grew: {sizes[::20]}"
        quiet(driver)
    finally:
        driver.quit()


@law
def nothing_for_axe():
    """axe-core finds nothing: the bench with a pixel open, a lesson before and after the guess; light and dark."""
    if not axe.exists():
        print("  skipped: no axe-core (npm ci in laws/page)")
        return
    driver = browser.chromium()
    try:
        for dark in (False, True):
            for address in ("#experiment=three-glosses&n=4&pixel=80,30", "#lesson=sparkle",
                            "#lesson=four-times&answer=four-times:2"):
                browser.dark(driver, dark)
                driver.get("about:blank")
                driver.get(page + address)
                browser.wait(driver, f"{browser.FINISHED} || document.getElementById('guess') || "
                             "document.getElementById('measure')")
                driver.execute_script(axe.read_text())
                found = driver.execute_async_script(
                    "axe.run({runOnly: ['wcag2a', 'wcag2aa', "
                    "'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice']})"
                    ".then((r) => arguments[0](r.violations.map("
                    "(v) => v.id + ': ' + v.nodes.map((n) => n.html).slice(0, 3).join(' '))))")
                assert found == [], f"{address}, dark {dark}: {found}"
    finally:
        driver.quit()


@law
def everything_has_a_name():
    """Each control and picture of the accessibility tree has a name."""
    driver = browser.chromium()
    try:
        browser.open_page(driver, page, "#experiment=three-glosses&n=4&pixel=80,30")
        tree = driver.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]
        wanted = {"button", "link", "textbox", "slider", "combobox", "radio", "img", "image",
                  "heading", "graphics-document"}
        nameless = [n for n in tree if not n.get("ignored") and n.get("role", {}).get("value") in wanted
                    and not n.get("name", {}).get("value")]
        assert nameless == [], nameless[:3]
    finally:
        driver.quit()


wanted = [test for test in laws if not os.environ.get('ONLY')
          or test.__name__ in os.environ['ONLY']]
for test in wanted:
    try:
        test()
    except AssertionError as error:
        print(f"{test.__name__}: {test.__doc__}\n{error}", file=sys.stderr)
        sys.exit(1)
    print(f"{test.__name__}: {test.__doc__}")
