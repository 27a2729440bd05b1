"""What is set: sliders, fields, and what they give."""
import math

import browser

small = "#experiment=three-glosses&n=4"


def laws(page):
    def sliders_and_fields(driver):
        """A slider and its field show one number, whichever was moved; three of a colour keep their hue; what is typed
        is set to its last digit; each coordinate of a light has a slider."""
        browser.open_page(driver, page, small)
        driver.execute_script("document.getElementById('controls').open = true")

        def give(label, value, event):
            driver.execute_script(
                "const at = document.querySelector(`[aria-label='${arguments[0]}']`); at.focus();"
                "at.value = arguments[1]; at.dispatchEvent(new Event(arguments[2], {bubbles: true}))",
                label, value, event)

        def shows(*labels):
            return driver.execute_script(
                "return arguments[0].map((l) => document.querySelector(`[aria-label='${l}']`).value)", labels)

        def is_set(path, value):
            browser.wait(driver, "decodeURIComponent(location.hash).replaceAll('+', ' ').includes("
                                 f"'set={path}={value}') && {browser.FINISHED}")

        give("s of gloss", "64.0625", "change")
        is_set("gloss.s", "64.0625")
        bar, text = shows("s of gloss (slider)", "s of gloss")
        assert abs(int(bar) - 500) <= 1 and text == "64.0625", (bar, text)  # 64 is the middle of 1 to 4096
        give("s of gloss (slider)", 750, "input")
        is_set("gloss.s", "512")
        assert shows("s of gloss") == ["512"], shows("s of gloss")
        colour = ["fill red", "fill green", "fill blue"]
        before = [float(x) for x in shows(*colour)]
        give("fill (slider)", 0, "input")
        is_set("fill.radiance", "[0, 0, 0]")
        give("fill (slider)", 500, "input")
        after = [float(x) for x in shows(*colour)]
        assert math.isclose(max(after), 2) and all(
            math.isclose(b / max(before), a / 2, rel_tol=1e-3) for a, b in zip(after, before)), (before, after)
        place = driver.execute_script("return [...document.querySelectorAll('input[type=range]')]"
                                      ".map((e) => e.ariaLabel).filter((l) => /^place of .* x /.test(l))[0]")
        give(place, 750, "input")
        assert shows(place.replace(" (slider)", "")) == ["2"], shows(place.replace(" (slider)", ""))
        assert browser.text(driver, "#wrong") == "", browser.text(driver, "#wrong")

    return [sliders_and_fields]
