"""Stability: settings when the user goes back, positions when numbers arrive, pixels before their reference."""
from selenium.webdriver.common.by import By

import browser

small = "#experiment=three-glosses&n=4"


def tests(page):
    def back_and_forward(driver):
        """Back reverts a choice, a part, a lesson; Forward repeats it; the skip link changes nothing."""
        browser.open_page(driver, page, small)
        driver.execute_script("const n = document.getElementById('n'); n.value = 16;"
                              "n.dispatchEvent(new Event('change'))")
        browser.wait(driver, f"location.hash.includes('n=16') && {browser.FINISHED}")
        for css in ("[data-tab=lessons]", "[data-lesson=firefly]"):
            driver.find_element(By.CSS_SELECTOR, css).click()
        for step, end, part in (
                ("back", "n=16&part=lessons", "lessons"), ("back", "n=16", "bench"), ("back", "n=4", "bench"),
                ("forward", "n=16", "bench"), ("forward", "n=16&part=lessons", "lessons"),
                ("forward", "n=16&lesson=firefly", "lessons")):
            driver.execute_script(f"history.{step}()")
            browser.wait(driver, f"location.hash.endsWith('{end}') && !document.getElementById('{part}').hidden")
            if part == "bench":
                browser.wait(driver, f"document.getElementById('n').value === '{end[2:]}'")
        assert "Who made this firefly?" in browser.text(driver, "#lessons h2")
        address = driver.execute_script("return location.hash")
        driver.execute_script("document.querySelector('.skip').click()")
        assert driver.execute_script("return [location.hash, document.activeElement.id]") == [address, "main"]
        assert browser.text(driver, "#wrong") == "", browser.text(driver, "#wrong")

    def a_pixel_before_its_reference(driver):
        """A pixel can be opened once there is a picture; values of the reference are added when it is computed."""
        driver.get("about:blank")
        driver.get(page + "#n=4&arms=cosine")
        said = driver.execute_async_script("""
            const done = arguments[0];
            const first = () => {
                const canvas = document.querySelector('#pictures canvas');
                if (!canvas) return setTimeout(first);
                canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp'}));
                look();
            };
            const look = () => document.querySelectorAll('#pixel .disk').length === 2
                ? done(document.getElementById('pixel').innerText) : setTimeout(look);
            first();""")
        assert "the reference is being computed" in said, said
        browser.wait(driver, "/, the reference [0-9.]+/.test(document.getElementById('pixel').textContent)")

    def nothing_moves(driver):
        """Nothing below the pictures moves while numbers arrive, nor after the focus went there."""
        places = ("return ['#controls', '#hemisphere', '#copy'].map((css) => Math.round("
                  "document.querySelector(css).getBoundingClientRect().top + scrollY))")
        measuring = "document.getElementById('pictures').textContent.includes('being measured')"
        browser.open_page(driver, page, small + "&set=seed=5", until="document.documentElement.dataset.first")
        before = driver.execute_script(places)
        browser.wait(driver, f"{browser.FINISHED} && !{measuring}")
        assert driver.execute_script(places) == before, (before, driver.execute_script(places))
        tops = driver.execute_async_script("""
            const copy = document.getElementById('copy'), top = () => copy.getBoundingClientRect().top;
            copy.focus();
            const first = top();
            setTimeout(() => arguments[0]([first, top()]), 400);""")
        assert tops[0] == tops[1], f"the page scrolls on after the focus: {tops}"

    def changed_in_the_midst(driver):
        """Another experiment, another map, another pixel while pictures are painted strip by strip: the last one is
        shown, and nothing is printed to the console."""
        browser.open_page(driver, page, small + "&view=heat")
        driver.execute_async_script("""
            const done = arguments[0];
            const choose = (id, value) => {
                const at = document.getElementById(id);
                at.value = value;
                at.dispatchEvent(new Event('change'));
            };
            const turn = (k) => {
                if (k === 60) return done();
                if (k % 4 === 0) choose('experiment', k % 8 ? 'three-glosses' : 'two-lamps');
                else choose('view', ['photograph', 'heat', 'signed'][k % 3]);
                const up = new KeyboardEvent('keydown', {key: 'ArrowUp'});
                document.querySelector('#pictures canvas')?.dispatchEvent(up);
                setTimeout(() => turn(k + 1), (k * 7) % 41);
            };
            turn(0);""")
        browser.wait(driver, f"{browser.FINISHED} && document.querySelectorAll('#pixel .disk').length === 2")
        assert browser.text(driver, "#wrong") == "", browser.text(driver, "#wrong")
        assert "two-lamps" in driver.execute_script("return location.hash")

    return [changed_in_the_midst, back_and_forward, a_pixel_before_its_reference, nothing_moves]
