"""The page in a browser that refuses workers: the same work on the page's own thread, in turns (apps/web/turns.ts)."""
import os

from selenium.webdriver.common.by import By

import browser

REFUSED = "window.Worker = function () { throw new Error('refused'); };"
LONG = """
    const Instance = WebAssembly.Instance;
    let tiles = 0;
    WebAssembly.Instance = function (module, imports) {
        const { exports } = new Instance(module, imports);
        const tile = (...of) => {
            if (++tiles === 5) for (let k = 0; k < 99; ++k) exports.tile(...of);
            return exports.tile(...of);
        };
        return { exports: { ...exports, tile } };
    };"""  # one call that does the work of thirty parts: a tile of one of three arms is a third of a part


def told(driver, word):
    return int(driver.execute_script("return document.documentElement.dataset[arguments[0]] ?? 0", word))


def without_workers(driver, page, address, until, planted=""):
    """The page at an address in a browser that refuses workers."""
    script = driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": REFUSED + planted})
    browser.open_page(driver, page, address, until=until)
    assert driver.execute_script("return document.documentElement.dataset.workers") == "0"
    driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)


def tests(page):
    def slices_without_workers(driver):
        """Without workers, the program's hash is shown under the picture, and no turn of the page's own thread exceeds
        ten parts; a turn into which thirty were inserted does. Work is counted, so that the machine's load does not
        matter."""
        most, longest = 100_000, 1_000_000  # samples of one part, and of a turn, at a hundred million a second
        browser.open_page(driver, page, "#experiment=three-glosses&n=16")
        hashes = browser.shown(driver)
        without_workers(driver, page, "#experiment=three-glosses&n=16", browser.FINISHED)
        assert os.environ["SHOWN"] in hashes and hashes == browser.shown(driver), (hashes, browser.shown(driver))
        browser.wait(driver, "!document.getElementById('pictures').textContent.includes('being measured')")  # tails
        parts, turns = [told(driver, "part")], [told(driver, "turn")]
        without_workers(driver, page, "#n=16&view=heat&pixel=480,300", browser.FINISHED)
        took = driver.execute_script("return document.documentElement.dataset.turns")
        parts.append(told(driver, "part")), turns.append(told(driver, "turn"))
        for lesson, guess in (("four-times", "2"), ("sparkle", "380,140,420,190"), ("firefly", "f"), ("furnace", "bug"),
                              ("unbiased", "right"), ("fault", "b")):
            without_workers(driver, page, f"#lesson={lesson}&answer={lesson}:{guess}",
                            "document.getElementById('reveal') || document.querySelector('#lessons .bad')")
            assert not driver.find_elements(By.CSS_SELECTOR, "#lessons .bad"), browser.text(driver, "#lessons")
            parts.append(told(driver, "part")), turns.append(told(driver, "turn"))
        assert all(0 < part <= most for part in parts), f"parts of {parts} samples, not at most {most}"
        assert all(0 < turn <= longest for turn in turns), f"turns of {turns} samples, not at most {longest}"
        without_workers(driver, page, "#experiment=three-glosses&n=16", browser.FINISHED, LONG)
        assert told(driver, "turn") > longest, f"a long turn is not seen: {told(driver, 'turn')} samples"
        half, most_ms = took.split()
        print(f"  without workers: parts of at most {max(parts)} samples, turns of at most {max(turns)}; half of the "
              f"turns end within {half} ms, 95 % within {most_ms} ms")

    return [slices_without_workers]
