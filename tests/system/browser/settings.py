"""Settings: sliders, fields, and their results."""
import math

import browser

small = "#experiment=three-glosses&n=4"


def give(driver, label, value, event):
    driver.execute_script(
        "const at = document.querySelector(`[aria-label='${arguments[0]}']`); at.focus();"
        "at.value = arguments[1]; at.dispatchEvent(new Event(arguments[2], {bubbles: true}))", label, value, event)


def shows(driver, *labels):
    return driver.execute_script(
        "return arguments[0].map((l) => document.querySelector(`[aria-label='${l}']`).value)", labels)


def is_set(driver, path, value):
    browser.wait(driver, "decodeURIComponent(location.hash).replaceAll('+', ' ').includes("
                         f"'set={path}={value}') && {browser.FINISHED}")


def tests(page):
    def sliders_and_fields(driver):
        """A slider and its field show one number, whichever was moved; the three of a colour keep their hue; an entered
        number is set to its last digit; each coordinate of a light has a slider."""
        browser.open_page(driver, page, small)
        driver.execute_script("document.getElementById('controls').open = true")

        give(driver, "s of gloss", "64.0625", "change")
        is_set(driver, "gloss.s", "64.0625")
        bar, text = shows(driver, "s of gloss (slider)", "s of gloss")
        assert abs(int(bar) - 500) <= 1 and text == "64.0625", (bar, text)  # 64 is the middle of 1 to 4096
        give(driver, "s of gloss (slider)", 750, "input")
        is_set(driver, "gloss.s", "512")
        assert shows(driver, "s of gloss") == ["512"], shows(driver, "s of gloss")
        colour = ["fill red", "fill green", "fill blue"]
        before = [float(x) for x in shows(driver, *colour)]
        give(driver, "fill (slider)", 0, "input")
        is_set(driver, "fill.radiance", "[0, 0, 0]")
        give(driver, "fill (slider)", 500, "input")
        after = [float(x) for x in shows(driver, *colour)]
        assert math.isclose(max(after), 2) and all(
            math.isclose(b / max(before), a / 2, rel_tol=1e-3) for a, b in zip(after, before)), (before, after)
        place = driver.execute_script("return [...document.querySelectorAll('input[type=range]')]"
                                      ".map((e) => e.ariaLabel).filter((l) => /^place of .* x /.test(l))[0]")
        give(driver, place, 750, "input")
        assert shows(driver, place.replace(" (slider)", "")) == ["2"], shows(driver, place.replace(" (slider)", ""))
        assert browser.text(driver, "#wrong") == "", browser.text(driver, "#wrong")

    def what_cannot_be_is_taken_back(driver):
        """A number that the core rejects is reported, and only it is reverted: earlier settings stay, its field shows
        the current value and keeps the focus. Invalid parts of the address, with nothing before them, leave the
        experiment as written."""
        browser.open_page(driver, page, small)
        driver.execute_script("document.getElementById('controls').open = true")
        give(driver, "rho_s of gloss", "0.3", "change")
        is_set(driver, "gloss.rho_s", "0.3")
        give(driver, "s of gloss", "-4", "change")
        browser.wait(driver, "document.getElementById('wrong').textContent.includes('as they were before')")
        browser.wait(driver, browser.FINISHED)
        address = driver.execute_script("return location.hash")
        assert "gloss.rho_s=0.3" in address and "gloss.s=" not in address, address
        there = shows(driver, "s of gloss", "rho_s of gloss")
        assert there == ["60", "0.3"], there
        assert driver.execute_script("return document.activeElement.ariaLabel") == "s of gloss"
        browser.open_page(driver, page, small + "&set=gloss.rho_s=0.3&set=gloss.s=-4")
        assert "as it was written" in browser.text(driver, "#wrong"), browser.text(driver, "#wrong")

    return [sliders_and_fields, what_cannot_be_is_taken_back]
