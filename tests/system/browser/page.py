"""The page in Chromium, from a file, offline: page.py GROUP PAGE BUNDLE NATIVE EXPERIMENT... . NATIVE has the program's
hashes. GROUP: numbers (what the page computes and keeps) or readers (accessibility); one browser for each, so that
both can run at once. ONLY selects tests, SHOTS is a folder for screenshots of them."""
import base64
import gzip
import json
import math
import os
import pathlib
import random
import re
import shlex
import subprocess
import sys
import tempfile
import time

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

import browser
import own
import reach
import settings
import steady
import written

group, page_path, bundle, native_path, *experiments = sys.argv[1:]
page = pathlib.Path(page_path).resolve().as_uri()
small = "#experiment=three-glosses&n=4"


def same_bits(driver):
    """Every arm, three scenes, every sample count, and the references: the program's hashes in Chromium."""
    native = set(pathlib.Path(native_path).read_text().split("\n"))
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


def opens_and_measures(driver):
    """The gallery to N = 64, with the article's values; a slider's move gives new pixels."""
    took = browser.open_page(driver, page)
    told = driver.execute_script("return {...document.documentElement.dataset}")
    print(f"  first picture after {told['first']} ms, three arms at N = 64 after {told['films']} ms, "
          f"with the reference and all metrics {took} ms, {told['workers']} workers")
    assert int(told["workers"]) >= 1
    assert "published" in browser.text(driver, "#pictures")
    beside = driver.execute_script("return [...document.querySelectorAll('.hash')].map((e) => e.innerText)")
    assert len(beside) == 3 and all(line.endswith(": the same bits") for line in beside), beside
    assert len(driver.find_elements(By.CSS_SELECTOR, "#pictures canvas")) == 4
    counts = driver.execute_script(
        "return [...document.querySelectorAll('#charts figure')].map((s) => s.querySelectorAll('circle').length)")
    assert counts and all(count == 9 for count in counts), f"three arms at three sample counts are charted, not {counts}"
    driver.execute_script(
        "document.getElementById('controls').open = true;"
        "const at = document.querySelector('[data-path=\"sphere.s\"] input[type=range]');"
        "at.focus(); at.value = 500; at.dispatchEvent(new Event('input', {bubbles: true}))")
    moved = browser.wait(driver, "document.documentElement.dataset.moved")
    print(f"  new pixels {moved} ms after the slider's move")
    assert "sphere.s" in driver.execute_script("return location.hash")


def address_is_data(driver):
    """Invalid parts of the address give defaults and messages."""
    browser.open_page(driver, page, "#experiment=%3Cscript%3E&arms=evil,phong&n=7&view=x"
                      "&set=__proto__.x=1&set=sphere.s=-4&pixel=a&arm=9&part=q&answer=sparkle:evil"
                      "&answer=firefly:l&answer=four-times:99&answer=sparkle:1,1,960,9&unknown=1&n=4&set=n=[3]"
                      "&set=arms.phong.n=[3]&set=reference.kind=%22monte-carlo%22",
                      until="document.getElementById('wrong').textContent.includes('sphere.s')")
    said = browser.text(driver, "#wrong")
    for word in ("experiment=", "arms=", "n=7", "view=", "set=", "pixel=", "arm=", "part=q", "unknown=1",
                 "n twice", "set=n=[3]", "set=arms.phong.n=[3]", "set=reference.kind=", "answer=sparkle:evil",
                 "answer=firefly:l", "answer=four-times:99", "answer=sparkle:1,1,960,9"):
        assert word in said, f"{word} is not told: {said}"
    browser.open_page(driver, page, "#lesson=none", until="document.getElementById('wrong').textContent && "
                      "document.getElementById('lessons').textContent.includes('minutes')")
    assert "lesson=none" in browser.text(driver, "#wrong")
    lessons = [e.text for e in driver.find_elements(By.CSS_SELECTOR, "#lessons small")]
    assert len(lessons) == 12 and all("minutes" in said for said in lessons), lessons
    browser.open_page(driver, page, small + "&pixel=160,3")
    assert "pixel=160,3" in browser.text(driver, "#wrong"), "a pixel outside the picture is not told"


def address_keeps_all(driver):
    """The settings of an answered lesson are in its address and are restored from there; so is every part."""
    browser.open_page(driver, page, "#experiment=three-glosses&arms=cosine&n=4&lesson=firefly&answer=firefly:1/p&zz=1",
                      until=f"document.getElementById('reveal') && {browser.FINISHED}")
    address = driver.execute_script("return location.hash")
    for word in ("lesson=firefly", "answer=firefly:1/p", "experiment=three-glosses", "arms=cosine", "n=4"):
        assert word in address, f"{word} is lost: {address}"
    assert "You said 1/p" in browser.text(driver, "#reveal") and "zz=1" in browser.text(driver, "#wrong")
    browser.open_page(driver, page, "#part=sheet", until="!document.getElementById('sheet').hidden")


def faults_are_sentences(driver):
    """A scene that does not fit into memory gives a message, and the page continues."""
    browser.open_page(driver, page, small + "&set=image.width=16384&set=image.height=16384",
                      until="document.getElementById('wrong').textContent")
    said = browser.text(driver, "#wrong")
    assert "not enough memory" in said and "image.width=16384" in browser.text(driver, "#command"), said
    driver.execute_script("document.getElementById('reset').focus()")
    browser.keys(driver, Keys.ENTER)
    browser.wait(driver, browser.FINISHED)
    assert browser.text(driver, "#wrong") == "" and driver.find_elements(By.CSS_SELECTOR, "[data-hash]")


def number_of(run, name):
    """Returns the value in metrics.json of a number that the page shows."""
    if name in ("fireflies", "under the horizon", "mean Y"):
        return run[{"fireflies": "fireflies", "under the horizon": "horizon_frac", "mean Y": "y_mean"}[name]]
    kind, region = name.split(" of ")
    of = run["regions"][region]
    return of["rmse"] if kind == "RMSE" else of.get("tail", {}).get("k")


def reads_as(text, number):
    """Returns whether a number equals this one as shown: two digits of a tail's k and four of others."""
    if number is None:
        return text == "–"
    k = text.replace("−", "-").split(" ± ")
    return math.isclose(float(k[0]), number, rel_tol=0.051 if len(k) > 1 else 1e-3, abs_tol=1e-9)


def the_link_back(driver):
    """Four states, each with its command: the program makes the same films and the same numbers."""
    states = ("#experiment=three-glosses&arms=phong,cosine&n=16",
              "#experiment=two-lamps&arms=mis-balance,light-area&n=4&set=seed=99",
              "#experiment=three-glosses&arms=phong,mixture,uniform&n=4&set=gloss.s=8&set=gloss.rho_s=0.2"
              "&set=regions.mine.box=[50, 16, 90, 44]&set=fill.radiance=[0.5, 0.6, 0.7]",
              "#experiment=two-lamps&arms=cosine,light-area&n=4&set=broad.radius=0.3&set=broad.center=[-1,2.5,0.5]"
              "&set=ball.s=77&set=ball.rho_d=[0.3,0.1,0.2]&set=ball.rho_s=0.35&set=firefly_k=1.5")
    for state in states:
        browser.open_page(driver, page, state)
        films, words = browser.shown(driver), browser.text(driver, "#command")
        assert words.startswith("./run experiments/"), words
        assert browser.text(driver, "#wrong") == "", browser.text(driver, "#wrong")
        driver.execute_script("document.getElementById('copy').click()")
        browser.wait(driver, "/^(Copied|Selected)/.test(document.getElementById('status').textContent)")
        browser.wait(driver, "!document.getElementById('pictures').textContent.includes('being measured')")
        shown_there = driver.execute_script(
            "return [...document.querySelectorAll('.shown')].flatMap("
            "(f) => [...f.querySelectorAll('tr:not(.note)')].map("
            "(r) => [f.querySelector('b').textContent, r.cells[0].textContent, r.cells[1].firstChild.textContent]))")
        with tempfile.TemporaryDirectory() as out:
            command = shlex.split(words)[1:] + ["--seeds", "1", "--only", "metrics", "--quiet", "--out", out]
            subprocess.run([os.environ["CRESCENT"], "run", *command], cwd=os.environ["CRESCENT_SOURCE"],
                           stdout=subprocess.DEVNULL)  # exit 1 if an assertion of the experiment fails at this N
            metrics = json.loads((pathlib.Path(out) / "metrics.json").read_text())
        for film in films:
            assert film in metrics["films"].values(), f"{words}: {film} is none of {metrics['films']}"
        n = int(re.search(r"[#&]n=(\d+)", state)[1])
        for arm, name, text in shown_there:  # an arm may have run at other exponents too
            here = [number_of(run, name) for run in metrics["runs"] if run["arm"] == arm and run["n"] == n]
            assert any(reads_as(text, x) for x in here), f"{words}: {arm}, {name}: {text}, not {here}"
        assert len(shown_there) >= 5 * len(films), f"{words}: {shown_there}"
        print(f"  {words[:60]} ...: {len(films)} films, {len(shown_there)} numbers")


def a_lesson_is_confirmed(driver):
    """The numbers of an answer are those of the command under it."""
    browser.open_page(driver, page, "#lesson=sparkle&answer=sparkle:380,140,420,190",
                      until="document.getElementById('reveal')")
    said = browser.text(driver, "#reveal")
    words = driver.find_element(By.CSS_SELECTOR, "#reveal .again code").text
    source = pathlib.Path(os.environ["CRESCENT_SOURCE"])
    with tempfile.TemporaryDirectory() as out:
        file = next(word for word in shlex.split(words) if word.endswith(".toml"))
        parts = re.split(r"(?m)^(?=\[)", (source / file).read_text())  # without parts that the lesson does not need
        kept = [part for part in parts if not re.match(r"\[+(exponent|furnaces|plates|assertions)", part)]
        scene = pathlib.Path(out) / "scene.toml"
        scene.write_text(re.sub(r"(?m)^(published|monte_carlo|n = \[).*$", "", "".join(kept)))
        command = shlex.split(words.replace(file, str(scene)))[1:] + ["--only", "metrics", "--quiet", "--out", out]
        subprocess.run([os.environ["CRESCENT"], "run", *command], check=True, stdout=subprocess.DEVNULL)
        bands = json.loads((pathlib.Path(out) / "metrics.json").read_text())["bands"]
    found = re.findall(r"(\w+), N = 64: RMSE of your box ([\d.]+), from ([\d.]+) to ([\d.]+)", said)
    assert [arm for arm, *_ in found] == ["uniform", "cosine", "phong"], said
    for arm, *numbers in found:
        band = next(b for b in bands if (b["arm"], b["n"], b["s"], b["metric"]) == (arm, 64, 32, "rmse.mine"))
        for text, name in zip(numbers, ("median", "q05", "q95")):
            assert math.isclose(float(text), band[name], rel_tol=1e-3), f"{arm}, {name}: {text}, not {band[name]}"


def kept(driver):
    """Returns what the page's scripts keep, in bytes and in nodes, after garbage collection."""
    driver.execute_cdp_cmd("HeapProfiler.collectGarbage", {})
    metrics = {m["name"]: m["value"] for m in driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]}
    return metrics["JSHeapUsedSize"], metrics["Nodes"]


def two_hundred_settings(driver):
    """Two hundred random settings, each to its end: the second hundred uses no more memory than the first, in the
    modules of the page and of its workers, in the scripts, and in the document."""
    draw = random.Random(7)
    browser.open_page(driver, page, small)
    names = ["uniform", "cosine", "phong", "mixture", "ggx-vndf", "mis-balance"]
    settings = []
    for turn in range(200):
        fill = f"&set=fill.radiance=[{0.1 * (turn // 20):.1f}, 1, 1]"  # another reference from time to time
        settings.append(f"experiment=three-glosses&n=4&arms={','.join(draw.sample(names, 3))}"
                        f"&set=seed={draw.randrange(2**32)}{fill}")
    run = """
        const [settings, done] = arguments, told = document.documentElement.dataset, sizes = [];
        const next = (k) => {
            if (k === settings.length) return done(sizes);
            delete told.took;
            location.hash = settings[k];
            const seed = /seed=[0-9]+/.exec(settings[k])[0], command = document.getElementById('command');
            const look = () => {
                if (!told.took || !command.textContent.includes(seed)) return setTimeout(look, 5);
                sizes.push(told.memory.split(" ").map(Number));
                next(k + 1);
            };
            setTimeout(look, 5);
        };
        next(0);"""
    driver.execute_cdp_cmd("Performance.enable", {})
    sizes, scripts = [], []
    for half in (settings[:100], settings[100:]):
        sizes += driver.execute_async_script(run, half)
        scripts.append(kept(driver))
    driver.execute_cdp_cmd("Performance.disable", {})
    (first, nodes), (second, nodes_after) = scripts
    own, workers = ([[one[k] for one in half] for half in (sizes[:100], sizes[100:])] for k in (0, 1))
    print(f"  the page's module {max(own[1]) / 1e6:.2f} MB; workers {max(workers[0]) / 1e6:.2f} MB, then "
          f"{max(workers[1]) / 1e6:.2f}; scripts {first / 1e6:.2f} MB, then {second / 1e6:.2f}; "
          f"{nodes} nodes, then {nodes_after}")
    assert len(sizes) == 200 and max(own[1]) <= max(own[0]), f"the page's module grew: {own[0][::20]}, {own[1][::20]}"
    # Which worker gets which tile is random, and so is when it uses the most memory. 2.5 kB per setting contain no
    # picture, ten nodes per setting no table; the pictures of the setting before the last may still be on their way.
    assert max(workers[1]) <= max(workers[0]) + 2**20, f"the workers grew: {workers[0][::20]}, {workers[1][::20]}"
    assert second <= first + 2**18 and nodes_after <= nodes + 1000, f"the scripts kept {scripts}"
    assert settings[-1].split("arms=")[1].split("&")[0] in driver.execute_script("return location.hash")


groups = {
    "numbers": [same_bits, opens_and_measures, address_is_data, address_keeps_all, faults_are_sentences, the_link_back,
                a_lesson_is_confirmed, two_hundred_settings],
    "readers": [*reach.tests(page, pathlib.Path(page_path).resolve().parent), *steady.tests(page), *settings.tests(page)],
    "writers": [*written.tests(page, pathlib.Path(page_path).resolve().parent),
                *own.tests(page, pathlib.Path(page_path).resolve().parent)],
}[group]
driver = browser.chromium()
failed = 0
try:
    for law in groups:
        if os.environ.get("ONLY") and law.__name__ not in os.environ["ONLY"]:
            continue
        start = time.monotonic()
        try:
            browser.size(driver, 1280, 900)
            browser.media(driver)
            law(driver)
            said, asked = browser.console(driver), browser.requests(driver)
            assert said == [], f"the console has lines: {said}"
            assert asked == [], f"the page asked for {asked}"
        except Exception as error:  # the others are still useful
            failed += 1
            print(f"{law.__name__}: {law.__doc__}\n{type(error).__name__}: {error}", file=sys.stderr)
        print(f"{law.__name__}: {law.__doc__} {time.monotonic() - start:.1f} s")
finally:
    driver.quit()
sys.exit(failed > 0)
