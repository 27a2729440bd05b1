"""A headless browser, offline, that records the page's log and its network requests."""
import json
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.keys import Keys


def chromium(width=1280, height=900, flags=(), traced=""):
    """traced: categories of a trace, which traced_events() returns."""
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for flag in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
                 "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--disable-ipc-flooding-protection", "--host-resolver-rules=MAP * ~NOTFOUND",
                 f"--window-size={width},{height}", *flags):
        options.add_argument(flag)
    if traced:
        options.add_experimental_option("perfLoggingPrefs", {
            "traceCategories": traced, "enableNetwork": False, "enablePage": False})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_script_timeout(180)
    size(driver, width, height)
    return driver


def traced_events(driver):
    """Returns the trace of the page that was left last."""
    driver.get("about:blank")
    messages = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
    return [m["params"] for m in messages if m["method"] == "Tracing.dataCollected"]


def size(driver, width, height):
    """Sets the size of the page, not of the window, which has a smallest width."""
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})


def media(driver, kind="", **features):
    """Sets the user's preferences: media(driver, prefers_color_scheme="dark"); kind: "print". The rest is default."""
    features = {"prefers-color-scheme": "light", "prefers-reduced-motion": "no-preference", "forced-colors": "none",
                **{name.replace("_", "-"): value for name, value in features.items()}}
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
        "media": kind, "features": [{"name": name, "value": value} for name, value in features.items()]})


def wait(driver, script, seconds=120):
    """Waits until `return SCRIPT` is true; returns its last value."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = driver.execute_script("return " + script)
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"after {seconds} s still not: {script}; the page says: "
                         + driver.execute_script("return document.body.innerText.slice(0, 1500)"))


FINISHED = "document.documentElement.dataset.took"


def open_page(driver, page, address="", seconds=120, until=FINISHED):
    driver.get("about:blank")
    driver.get(page + address)
    return wait(driver, until, seconds)


def keys(driver, *words):
    """Sends keys to the focused element."""
    driver.switch_to.active_element.send_keys(*words)


def tab_to(driver, css, most=150):
    """Moves the focus with only the tab key; returns the number of strokes."""
    for count in range(most):
        if driver.execute_script("return document.activeElement.matches(arguments[0])", css):
            return count
        keys(driver, Keys.TAB)
    raise AssertionError(f"{most} strokes of the tabulator do not reach {css}")


def axe(driver, source):
    """Returns what axe-core finds on the page in its current state."""
    driver.execute_script(source)
    return driver.execute_async_script(
        "axe.run({runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'],"
        " rules: {'target-size': {enabled: true}}})"
        ".then((r) => arguments[0](r.violations.map("
        "(v) => v.id + ': ' + v.nodes.map((n) => n.html).slice(0, 3).join(' '))))")


def console(driver):
    return [entry["message"] for entry in driver.get_log("browser")]


def requests(driver):
    """Returns the requested addresses, without files and data of the page itself."""
    asked = []
    for entry in driver.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            url = message["params"]["request"]["url"]
            if not url.startswith(("file:", "data:", "blob:", "about:")):
                asked.append(url)
    return asked


def text(driver, css):
    return driver.execute_script("return document.querySelector(arguments[0]).innerText", css)


def shown(driver):
    """Returns the hashes of the films under the pictures."""
    return driver.execute_script(
        "return [...document.querySelectorAll('[data-hash]')].map((e) => e.textContent).sort()")
