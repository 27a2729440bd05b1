"""A sampler written in the page, the main film, exercises, and a browser that refuses workers."""
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import browser

small = "#experiment=three-glosses&n=4"
COSINE = """function sample(wo, u) {
const r = Math.sqrt(u[0]), phi = 2 * Math.PI * u[1], z = Math.sqrt(1 - u[0]);
return { wi: [r * Math.cos(phi), r * Math.sin(phi), z], pdf: z / Math.PI }
}
function pdf(wo, wi) { return Math.max(wi[2], 0) / Math.PI }"""
SHADER = """// crescent: sample = wi = draw(u)
// crescent: pdf = density(wi)
const PI = 3.14159265;
fn draw(u: vec2f) -> vec3f {
    let r = sqrt(u.x);
    return normalize(vec3f(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), sqrt(1.0 - u.x)));
}
fn density(wi: vec3f) -> f32 { return wi.z / PI; }"""
data = "document.documentElement.dataset"
FAULT = "document.getElementById('fault-line').textContent"
LOOKED = f"{data}.code === 'runs' && {data}.looked"


def tests(page, folder):
    source = folder / "node_modules/axe-core/axe.min.js"

    def reached_and_read(driver):
        """The new parts at every width, light and dark: nothing scrolls sideways, axe finds nothing; the tab key goes
        through the editor and on."""
        for address, until in (("#part=write", f"{data}.written"), ("#part=faults", "document.querySelector('.cards')"),
                               ("#exercise=eta-squared", "document.getElementById('predict')")):
            browser.open_page(driver, page, address, until=until)
            if "write" in address:
                verdicts(driver)
                browser.tab_to(driver, ".cm-content")
                browser.keys(driver, Keys.TAB)
                assert not driver.execute_script("return !!document.activeElement.closest('.cm-editor')"), "the editor is a trap"
            for scheme in ("light", "dark"):
                browser.media(driver, prefers_color_scheme=scheme)
                for width, height in ((320, 568), (360, 740), (1440, 900)):
                    browser.size(driver, width, height)
                    wide = driver.execute_script("return document.documentElement.scrollWidth - innerWidth")
                    assert wide <= 0, f"{address} at {width} px: {wide} px too wide"
                if source.exists():
                    found = browser.axe(driver, source.read_text())
                    assert found == [], f"{address}, {scheme}: {found}"

    def write(driver, code):
        """Replaces the code, as a user pastes it."""
        driver.execute_script(f"for (const name of ['looked', 'code', 'checked', 'written']) delete {data}[name]")
        driver.find_element(By.CSS_SELECTOR, ".cm-content").click()
        browser.keys(driver, Keys.CONTROL, "a")
        driver.execute_cdp_cmd("Input.insertText", {"text": code})
        # Chromium keeps the look of what it replaces in an editable element by an inline style, which the policy forbids.
        lines = browser.console(driver)
        assert all("Applying inline style" in line for line in lines), lines

    def verdicts(driver):
        """Checks, and returns the state of each verdict."""
        driver.execute_script(f"delete {data}.checked; document.getElementById('check-yours').click()")
        browser.wait(driver, f"{data}.checked")
        return driver.execute_script(
            "return Object.fromEntries([...document.querySelectorAll('[data-verdict]')]"
            ".map((e) => [e.dataset.verdict, e.dataset.state]))")

    def a_sampler_is_written(driver):
        """A template runs and is right; a wrong one is reported with its verdict and its picture; the code comes back from
        the address; its film is next to a built-in one."""
        browser.open_page(driver, page, "#part=write", until=LOOKED)
        found = verdicts(driver)
        assert len(found) == 8 and set(found.values()) == {"right"}, found
        took = int(driver.execute_script(f"return {data}.checked"))
        write(driver, COSINE.replace("z = Math.sqrt(1 - u[0])", "z = u[0]").replace("Math.sqrt(u[0])", "Math.sqrt(1 - u[0] * u[0])"))
        browser.wait(driver, LOOKED)
        found = verdicts(driver)
        assert found["density"] == "wrong" and found["normalised"] == "right", found
        assert "fix density first" in browser.text(driver, "#verdicts"), browser.text(driver, "#verdicts")
        assert driver.execute_script("return document.getElementById('your-layer').value") == "ratio"
        browser.wait(driver, f"{data}.written")  # its film, to its last metric
        charts = len(driver.find_elements(By.CSS_SELECTOR, "#write .charts figure"))
        assert charts == 2, charts
        address = driver.execute_script("return location.hash")
        assert "code=" in address, address
        code = driver.execute_script("return document.querySelector('.cm-content').innerText")
        browser.open_page(driver, page, address, until=LOOKED)
        again = driver.execute_script("return document.querySelector('.cm-content').innerText")
        assert again == code, (again, code)
        print(f"  a sampler is checked in {took} ms")

    def mistakes_have_lines(driver):
        """What is no JavaScript, what throws, what returns something else, what never returns and what asks the network
        gives one sentence, three of them with their line."""
        browser.open_page(driver, page, "#part=write", until=LOOKED)
        for code, line, word in (
                (COSINE.replace("z = Math", "z = = Math"), 2, "SyntaxError"),
                (COSINE.replace("Math.max(wi[2], 0)", "Math.max(wi[2], zero)"), 5, "zero is not defined"),
                ("fetch('https://example.org').catch(() => {});\n" + COSINE, 0, ""),
                (COSINE.replace("pdf: z / Math.PI", "p: z / Math.PI"), 0, "sample returned"),
                (COSINE.replace("return { wi", "while (true); return { wi"), 3, "did not return within"),
                ("function pdf() { return 1 }", 0, "there is no function sample")):
            write(driver, code)
            if not word:  # refused by the policy: the draws need no answer, and none comes
                browser.wait(driver, f"{data}.looked", seconds=30)
                assert any("connect-src" in line for line in browser.console(driver)), "the policy lets a sampler ask"
                continue
            said = browser.wait(driver, f"{data}.code === 'fault' && {FAULT}")
            assert word in said and (not line or said.startswith(f"Line {line}: ")), f"{word} in line {line}: {said}"
            if line:
                browser.wait(driver, "document.querySelector('.cm-lint-marker-error, .cm-lintRange-error')")
        assert browser.requests(driver) == []
        write(driver, COSINE)
        browser.wait(driver, LOOKED)
        assert browser.text(driver, "#fault-line") == ""

    def choose(driver, name, value):
        driver.execute_script(f"for (const name of ['looked', 'code', 'checked', 'written']) delete {data}[name];"
                              "const s = document.getElementById(arguments[0]); s.value = arguments[1];"
                              "s.dispatchEvent(new Event('change'))", name, value)

    def points_are_drawn(driver):
        """Each domain of the menu has a template that is right, without a film; a missing root is named; the address gives
        the domain back; a domain that does not exist and a point of another one have a sentence."""
        browser.open_page(driver, page, "#part=write", until=LOOKED)
        domains = driver.execute_script("return [...document.getElementById('domain').options].map((o) => o.value)")
        assert len(domains) == 9 and domains[0] == "hemisphere", domains
        for domain in domains[1:]:
            choose(driver, "domain", domain)
            browser.wait(driver, LOOKED)
            found = verdicts(driver)
            assert set(found.values()) <= {"right", "skipped"} and found["density"] == "right", (domain, found)
            assert ("right" in found["mean"]) == (domain == "line:0,inf"), (domain, found)
            assert not driver.find_element(By.ID, "your-film").is_displayed()
            said = browser.text(driver, "#write figcaption")
            assert ("no picture" in said) == (domain in ("cube", "set:2 x hemisphere")), (domain, said)
            assert driver.find_element(By.ID, "your-layer").is_displayed() == (domain in ("disk", "square", "triangle")), domain
        choose(driver, "domain", "disk")
        browser.wait(driver, LOOKED)
        lens = driver.execute_script("return document.querySelector('.cm-content').innerText")
        write(driver, lens.replace("Math.sqrt(u[0])", "u[0]"))
        browser.wait(driver, LOOKED)
        assert verdicts(driver)["density"] == "wrong"
        assert "a square root is missing" in browser.text(driver, "#verdicts"), browser.text(driver, "#verdicts")
        address = driver.execute_script("return location.hash")
        browser.open_page(driver, page, address, until=LOOKED)
        assert driver.execute_script("return document.getElementById('domain').value") == "disk"
        for code, line, word in ((lens.replace('"disk"', '"disc"'), 1, "'disc' is no domain of the page"),
                                 (lens.replace('"disk"', '"line:0,1"'), 0, "expected { x: a number, pdf: number }")):
            write(driver, code)
            said = browser.wait(driver, f"{data}.code === 'fault' && {FAULT}")
            assert word in said and (not line or said.startswith(f"Line {line}: ")), f"{word} in line {line}: {said}"
        choose(driver, "domain", "hemisphere")
        browser.wait(driver, f"{data}.written")
        assert driver.find_element(By.ID, "your-film").is_displayed()

    def a_shader_is_written(driver):
        """In WGSL both templates are right, a constant too many is wrong, a mistake has its line and a sampler its film; the
        address gives the code and its language back."""
        browser.open_page(driver, page, "#part=write", until=LOOKED)
        choose(driver, "language", "wgsl")
        browser.wait(driver, LOOKED, seconds=60)
        for template in ("wgsl-cosine", "wgsl-ggx"):
            choose(driver, "template", template)
            browser.wait(driver, LOOKED, seconds=60)
            found = verdicts(driver)
            assert set(found.values()) == {"right"}, (template, found, browser.text(driver, "#verdicts"))
        browser.wait(driver, f"{data}.written", seconds=120)
        took = int(driver.execute_script(f"return {data}.checked"))
        write(driver, SHADER.replace("wi.z / PI;", "1.03 * wi.z / PI;"))
        browser.wait(driver, LOOKED, seconds=60)
        assert verdicts(driver)["normalised"] == "wrong", browser.text(driver, "#verdicts")
        address = driver.execute_script("return location.hash")
        browser.open_page(driver, page, address, until=LOOKED)
        assert driver.execute_script("return document.getElementById('language').value") == "wgsl"
        for code, line, word in ((SHADER.replace("sqrt(u.x)", "sqrt(v.x)"), 5, "v"),
                                 (SHADER.replace("= draw(u)", "= drew(u)"), 1, "drew"),
                                 (SHADER.replace("density(wi)\n", "densty(wi)\n", 1), 2, "densty"),
                                 (SHADER.replace("pdf =", "pfd ="), 2, "no key 'pfd'")):
            write(driver, code)
            said = browser.wait(driver, f"{data}.code === 'fault' && {FAULT}")
            assert said.startswith(f"Line {line}: ") and word in said, f"{word} in line {line}: {said}"
        print(f"  a shader is checked in {took} ms")

    def without_webgpu(driver):
        """The language cannot be chosen, and says why."""
        script = driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
            "source": "Object.defineProperty(Navigator.prototype, 'gpu', {get: () => undefined})"})
        browser.open_page(driver, page, "#part=write", until=LOOKED)
        driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)
        option = "document.querySelector('#language [value=wgsl]')"
        assert driver.execute_script(f"return {option}.disabled")
        assert "has no WebGPU" in driver.execute_script(f"return {option}.textContent")

    def an_exercise_is_solved(driver):
        """A prediction, a wrong verdict, hints, the repair: solved, also after the page was opened again."""
        browser.open_page(driver, page, "#part=faults", until="document.querySelectorAll('.cards [data-exercise]').length === 12")
        driver.find_element(By.CSS_SELECTOR, "[data-exercise=eta-squared] a").click()
        state = "document.querySelector('[data-exercise=eta-squared]').dataset.state"
        assert driver.execute_script("return " + state) == "open"
        browser.tab_to(driver, "#predicted-valid")
        browser.keys(driver, Keys.ARROW_DOWN, Keys.ARROW_DOWN)
        browser.tab_to(driver, "#predict")
        browser.keys(driver, Keys.ENTER)
        browser.wait(driver, LOOKED)
        for count in (1, 2, 3):
            driver.find_element(By.ID, "hint").click()
            assert len(driver.find_elements(By.CSS_SELECTOR, ".hints li")) == count
        assert verdicts(driver)["normalised"] == "wrong"
        assert "you predicted normalised" in browser.text(driver, "#exercise-result"), browser.text(driver, "#exercise-result")
        driver.find_element(By.ID, "no-fault").click()
        assert "disagrees" in browser.text(driver, "#exercise-result")
        assert driver.execute_script("return " + state) == "predicted"
        write(driver, COSINE)
        browser.wait(driver, LOOKED)
        assert "wrong" not in verdicts(driver).values()
        browser.wait(driver, state + " === 'solved'")
        browser.open_page(driver, page, "#part=faults", until="document.querySelector('.cards')")
        assert driver.execute_script("return " + state) == "solved"
        driver.execute_script("localStorage.clear()")

    def the_main_film(driver):
        """900 pixels wide at 1440 x 900; keys and the wheel zoom to single pixels; a pixel is read; the wipe and both
        panels show what was chosen; on a phone panels are stacked, and two fingers zoom."""
        browser.size(driver, 1440, 900)
        browser.open_page(driver, page, small)
        film = driver.find_element(By.ID, "main-film")
        assert film.rect["width"] >= 900, film.rect
        zoom = "Number(document.getElementById('main-film').dataset.zoom)"
        driver.execute_script("document.getElementById('main-film').focus()")
        browser.keys(driver, "+", "+", "+")
        assert driver.execute_script("return " + zoom) == 8
        browser.keys(driver, Keys.ARROW_RIGHT)
        browser.wait(driver, "/reference Y/.test(document.querySelector('#film .readout').textContent)")
        assert "pixel=" in driver.execute_script("return location.hash")
        read = browser.text(driver, "#film .readout")
        assert all(word in read for word in ("cosine", "phong", "error", "below the horizon")), read
        browser.keys(driver, "0")
        assert driver.execute_script("return " + zoom) == 1
        driver.execute_script("document.getElementById('main-film').dispatchEvent(new WheelEvent('wheel', {deltaY: -240, clientX: 500,"
                              " clientY: document.getElementById('main-film').getBoundingClientRect().top + 50, cancelable: true}))")
        assert driver.execute_script("return " + zoom) == 2
        picture = "document.getElementById('main-film').toDataURL()"
        for name, value in (("main-film-b", "error 0"), ("main-film-a", "variance 1"), ("main-film-mode", "side")):
            before = driver.execute_script("return " + picture)
            driver.execute_script("const s = document.getElementById(arguments[0]); s.value = arguments[1];"
                                  "s.dispatchEvent(new Event('change'))", name, value)
            browser.wait(driver, f"{picture} !== '{before[:40]}' && {picture}.length !== {len(before)}", seconds=20)
        said = browser.text(driver, "#film .bars")
        assert "W/(sr m²)" in said and "variance" in said, said
        browser.size(driver, 360, 740)
        browser.wait(driver, "document.getElementById('main-film').clientHeight > 200")
        wide = driver.execute_script("return document.documentElement.scrollWidth - innerWidth")
        assert wide <= 0, f"{wide} px too wide"
        film.send_keys("0")
        driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", film)
        x, y = driver.execute_script("const r = arguments[0].getBoundingClientRect();"
                                     "return [r.left + r.width / 2, r.top + r.height / 4]", film)
        for kind, apart in (("touchStart", 20), *(("touchMove", 20 + 8 * k) for k in range(1, 6)), ("touchEnd", 0)):
            fingers = [{"x": x - apart, "y": y, "id": 1}, {"x": x + apart, "y": y, "id": 2}] if apart else []
            driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": fingers})
        zoomed = browser.wait(driver, f"{zoom} > 1 && {zoom}")
        assert 2 < zoomed < 4, f"fingers three times as far apart zoom by {zoomed}"

    def workers_are_refused(driver):
        """One sentence, and nothing else."""
        script = driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
            "source": "window.Worker = function () { throw new Error('refused'); };"})
        browser.open_page(driver, page, small, until="document.getElementById('wrong').textContent")
        driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)
        assert "refuses workers" in browser.text(driver, "#wrong"), browser.text(driver, "#wrong")
        assert driver.execute_script("return document.getElementById('bench').hidden")

    return [reached_and_read, a_sampler_is_written, points_are_drawn, mistakes_have_lines, a_shader_is_written, without_webgpu,
            an_exercise_is_solved, the_main_film, workers_are_refused]
