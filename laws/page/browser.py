"""A browser without a window, offline, that keeps what the page logs and what it asks the network for."""
import json
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By


def chromium(width=1280, height=900, dark=False, flags=()):
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for flag in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
                 "--host-resolver-rules=MAP * ~NOTFOUND", f"--window-size={width},{height}", *flags):
        options.add_argument(flag)
    if dark:
        options.add_argument("--force-dark-mode")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_script_timeout(300)
    size(driver, width, height)
    return driver


def size(driver, width, height):
    """Of the page, not of the window, which has a smallest width."""
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})


def dark(driver, on=True):
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                           {"features": [{"name": "prefers-color-scheme", "value": "dark" if on else "light"}]})


def wait(driver, script, seconds=60):
    """Until `return SCRIPT` is true; what it was at last."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = driver.execute_script("return " + script)
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"after {seconds} s still not: {script}; the page says: "
                         + driver.execute_script("return document.body.innerText.slice(0, 1500)"))


FINISHED = "document.documentElement.dataset.took"


def open_page(driver, page, address="", seconds=90):
    driver.get("about:blank")
    driver.get(page + address)
    return wait(driver, FINISHED, seconds)


def console(driver):
    return [entry["message"] for entry in driver.get_log("browser")]


def requests(driver):
    """Addresses that were asked for, files and what the page holds itself apart."""
    asked = []
    for entry in driver.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            url = message["params"]["request"]["url"]
            if not url.startswith(("file:", "data:", "blob:", "about:")):
                asked.append(url)
    return asked


def text(driver, css):
    return driver.find_element(By.CSS_SELECTOR, css).text
