#!/usr/bin/env python3
"""Speed of the page: its module in node against the program's SSE4 code, and the page itself in Chromium.

    bench/page.py [--build FOLDER] [--page FILE] [--crescent PROGRAM] [--write]

Measures what ./page has built: Msamples/s of one thread by bench/page.mjs, then in Chromium, from a file, best of
three: ms from opening to the first picture, to the gallery's three arms at N = 64, to the last metric, and from a
slider's move to the first new pixels, the median of twenty moves, and to N = 64 again; ms between frames while the page
works; ms of a check of a sampler in JavaScript. --write puts all of it into
docs/speed.md. Needs chromium, chromedriver and selenium, like the tests of the page.
"""
import argparse
import datetime
import json
import os
import pathlib
import shlex
import statistics
import subprocess
import sys
import time

from selenium.webdriver.common.keys import Keys

from compare import processor
from measured_part import print_measured

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/system/browser"))
import browser  # noqa: E402


def rates(crescent, build):
    done = subprocess.run(["node", "--no-warnings", ROOT / "bench/page.mjs", crescent, build], check=True,
                          stdout=subprocess.PIPE, text=True)
    *rows, facts = [json.loads(line) for line in done.stdout.splitlines()]
    return rows, facts


def opened(page):
    """Returns ms to the first picture, to the last film, to the last metric, of a browser that was just started."""
    driver = browser.chromium()
    try:
        browser.open_page(driver, page)
        told = driver.execute_script("return {...document.documentElement.dataset}")
        told["browser"] = f"Chromium {driver.capabilities['browserVersion']}"
        return told
    finally:
        driver.quit()


def move(driver, to):
    """Moves the slider of s."""
    driver.execute_script(
        "for (const told of ['moved', 'films', 'took']) delete document.documentElement.dataset[told];"
        "const at = document.querySelector('[data-path=\"sphere.s\"] input[type=range]');"
        "at.focus(); at.value = arguments[0]; at.dispatchEvent(new Event('input', {bubbles: true}))", to)


def moved(page, turns=20, whole=3):
    """Returns ms from the move of the slider of s to the first new pixels, while the reference is being computed: the
    median and the largest; and to the last film, if no other move follows: the smallest."""
    driver = browser.chromium()
    try:
        browser.open_page(driver, page)
        driver.execute_script("document.getElementById('controls').open = true")
        first, films = [], []
        for turn in range(turns):
            move(driver, 400 + 10 * turn)
            first.append(int(browser.wait(driver, "document.documentElement.dataset.moved")))
            time.sleep(0.4)
        for turn in range(whole):
            move(driver, 300 + 10 * turn)
            time.sleep(3)  # polling it would keep a core busy
            browser.wait(driver, "document.documentElement.dataset.took")
            films.append(int(driver.execute_script("return document.documentElement.dataset.films")))
        return statistics.median(first), max(first), min(films)
    finally:
        driver.quit()


PROBE = ("window.frames_seen = []; let last = 0;"
         "const turn = (t) => { if (last) window.frames_seen.push(t - last); last = t; requestAnimationFrame(turn); };"
         "requestAnimationFrame(turn)")
EDIT = (Keys.SPACE, Keys.BACK_SPACE)


def slide(driver):
    for turn in range(20):
        move(driver, 400 + 10 * turn)
        time.sleep(0.1)


def turn_wheel(driver):
    for turn in range(40):
        driver.execute_script(
            "const film = document.getElementById('main-film'), box = film.getBoundingClientRect();"
            "film.dispatchEvent(new WheelEvent('wheel', {deltaY: arguments[0], cancelable: true,"
            " clientX: box.left + 300, clientY: box.top + 100}))", -60 if turn < 20 else 60)
        time.sleep(0.03)


def write(driver):
    driver.find_element("css selector", ".cm-content").click()
    for turn in range(20):
        browser.keys(driver, EDIT[turn % 2])
        time.sleep(0.1)
    time.sleep(2)  # it is read 350 ms after the last key, and its films are computed


def open_editor(driver):
    driver.execute_script("document.querySelector('[data-tab=write]').click()")
    browser.wait(driver, "document.documentElement.dataset.written")


def compute(driver):
    move(driver, 350)
    time.sleep(3)
    browser.wait(driver, browser.FINISHED)


PHASES = (("films and metrics are computed", "", browser.FINISHED, compute),
          ("a slider moves ten times a second", "", browser.FINISHED, slide),
          ("the wheel zooms", "", browser.FINISHED, turn_wheel),
          ("the editor opens, the first time", "", browser.FINISHED, open_editor),
          ("a sampler is edited", "#part=write", "document.documentElement.dataset.written", write))


def frames(page):
    """Returns for each phase ms between frames, median, 99th percentile and largest, and the longest task of the page's
    thread, ms of its processor time; the same of the opening alone; and ms of a check of a sampler in JavaScript, the
    median of five."""
    rows, checks = [], []
    for words, address, until, act in (("the page opens", "", browser.FINISHED, None), *PHASES):
        driver = browser.chromium(1440, 900, traced="toplevel,blink.user_timing")
        try:
            browser.open_page(driver, page, address, until=until)
            seen = []
            if act:
                driver.execute_script("document.getElementById('controls').open = true;" + PROBE)
                driver.execute_script("performance.mark('begin')")
                act(driver)
                seen = sorted(driver.execute_script("return window.frames_seen"))
            if until != browser.FINISHED:
                for _ in range(5):
                    driver.execute_script("delete document.documentElement.dataset.checked;"
                                          "document.getElementById('check-yours').click()")
                    checks.append(int(browser.wait(driver, "document.documentElement.dataset.checked")))
            task = longest_task(browser.traced_events(driver), act)
            rows.append((words, *((statistics.median(seen), seen[int(0.99 * (len(seen) - 1))], seen[-1]) if seen else ()), task))
        finally:
            driver.quit()
    return rows, statistics.median(checks)


def longest_task(events, marked):
    """ms of processor time of the longest task of the page's thread after the mark `begin`, of all if there is no mark to
    be set; none if the trace was full before it, as after the long computations of an edited sampler."""
    threads = {(e["pid"], e["tid"]) for e in events
               if e["ph"] == "M" and e["name"] == "thread_name" and e["args"]["name"] == "CrRendererMain"}
    begin = [e["ts"] for e in events if e["name"] == "begin" and e.get("cat") == "blink.user_timing"]
    if marked and not begin:
        return None
    navigated = [(e["pid"], e["ts"]) for e in events if e["name"] == "navigationStart"
                 and "crescent" in json.dumps(e["args"])]
    pid, start = max(navigated, key=lambda one: one[1])
    start = max([start, *begin])
    return max(e.get("tdur", 0) / 1000 for e in events
               if e["ph"] == "X" and e["pid"] == pid and (pid, e["tid"]) in threads and e["ts"] >= start)


def section(rows, facts, openings, slider, drawn, command):
    least = {key: min(int(one[key]) for one in openings) for key in ("first", "films", "took")}
    load = os.getloadavg()[0]
    table = "\n".join(f"| {r['arm']} | {r['page']:.1f} | {r['program']:.1f} | {r['page'] / r['program']:.2f} |"
                      for r in rows)
    phases, checked = drawn
    framed = "\n".join(f"| {words} | {' | '.join(f'{ms:.0f}' for ms in times) or ' |  | '} | {'' if task is None else f'{task:.0f}'} |"
                       for words, *times, task in phases)
    return f"""Msamples/s of one thread, the best of five alternating runs: the module of the web app and the SSE4 code of the program.

| sampler | page | program, SSE4 | page / program |
|---|---|---|---|
{table}

| in Chromium, {openings[0]['workers']} workers, best of {len(openings)} | ms |
|---|---|
| from opening the file to the first picture | {least['first']} |
| the gallery's three samplers at N = 64, N = 4 first | {least['films']} |
| the same with the reference and all metrics | {least['took']} |
| from a move of a slider to the first new pixels, median of 20 moves | {slider[0]:.0f} |
| the same, largest of the 20 | {slider[1]} |
| from a move of a slider to the three samplers at N = 64, best of 3 | {slider[2]} |
| verdicts on a sampler in JavaScript, four w_o, median of 5 | {checked:.0f} |

| while | ms between frames: median | 99th percentile | largest | longest task of the page's thread, ms of processor time |
|---|---|---|---|---|
{framed}

- A cosine sampler in JavaScript, in the film: {facts['written']:.1f} million draws/s of one thread.
- {datetime.date.today().isoformat()}, {processor()}, {os.cpu_count()} threads, load {load:.1f} at the end;
  {openings[0]['browser']}; {facts['engine']}; crescent {facts['commit']}
- Written by `{command}`.
- The reference, computed by the module on one thread: {facts['reference']:.1f} s."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build-web")
    parser.add_argument("--page", type=pathlib.Path, default=ROOT / "out/page/crescent.html")
    parser.add_argument("--crescent", type=pathlib.Path, default=ROOT / "build/crescent")
    parser.add_argument("--write", action="store_true", help="write the part of docs/speed.md")
    args = parser.parse_args()
    page = args.page.resolve().as_uri()
    rows, facts = rates(args.crescent.resolve(), args.build.resolve())
    command = shlex.join(["bench/page.py", *sys.argv[1:]])
    text = section(rows, facts, [opened(page) for _ in range(3)], moved(page), frames(page), command)
    print_measured(text, ROOT / "docs" / "speed.md" if args.write else None, "page.py")


if __name__ == "__main__":
    main()
