"""The page in a second browser engine, WebKit: opens, computes a film with the same hash, completes one lesson, checks a sampler in JavaScript.
webkit.py PAGE HASH"""
import pathlib
import sys
import time

from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.by import By
from selenium.webdriver.webkitgtk.options import Options

page, expected = pathlib.Path(sys.argv[1]).resolve().as_uri(), sys.argv[2]
options = Options()
options.binary_location = "/usr/lib/x86_64-linux-gnu/webkit2gtk-4.1/MiniBrowser"
options.add_argument("--automation")
driver = webdriver.WebKitGTK(executable_path="/usr/bin/WebKitWebDriver", options=options)


def wait(script, seconds=600):  # a hang, on a machine that has something else to do
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            if value := driver.execute_script("return " + script):
                return value
        except WebDriverException:  # called while one page replaces another
            pass
        time.sleep(0.2)
    said = driver.execute_script(
        "return [...document.querySelectorAll('[role=alert]'), document.body].map((e) => e.innerText.slice(0, 800))")
    raise SystemExit(f"after {seconds} s still not: {script}; {said}")


try:
    driver.get(page + "#experiment=three-glosses&arms=phong&n=16")
    wait("document.documentElement.dataset.took")
    found = driver.find_element(By.CSS_SELECTOR, "[data-hash]").text
    if found != expected:
        raise SystemExit(f"WebKit's film has the hash {found}, the program's {expected}")
    driver.get(page + "#lesson=four-times&answer=four-times:2")
    driver.refresh()
    wait("document.getElementById('reveal')")
    said = driver.find_element(By.ID, "reveal").text
    if "measured here" not in said:
        raise SystemExit(f"the lesson says: {said}")
    driver.get("about:blank")
    driver.get(page + "#part=write")
    wait("document.documentElement.dataset.looked")
    driver.execute_script("document.getElementById('check-yours').click()")
    wait("document.documentElement.dataset.checked")
    states = driver.execute_script("return [...document.querySelectorAll('[data-verdict]')].map((e) => e.dataset.state)")
    if len(states) != 8 or set(states) != {"right"}:
        raise SystemExit(f"the verdicts of a right sampler are {states}")
    workers = driver.execute_script("return document.documentElement.dataset.workers")
    print(f"WebKit: {workers} workers, the same hash; {said.splitlines()[0]}")
finally:
    driver.quit()
