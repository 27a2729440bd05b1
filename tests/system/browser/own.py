"""Scenes of the user: packs and an experiment, chosen or dropped."""
import base64
import json
import math
import os
import pathlib
import struct
import subprocess

from selenium.webdriver.common.by import By

import browser

small = "#experiment=three-glosses&n=4"
tent = ([(-2, 0, -2), (2, 0, -2), (2, 0, 2), (-2, 0, 2), (0, 1.5, 0)], [(0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)])
experiment = """title = "A tent"
n = 16

[image]
width = 48
height = 36

[camera]
eye = [3, 3, 6]
target = [0, 0.5, 0]
vfov_deg = 40

[meshes.tent]
file = "tent.mesh"
rho_d = [0.5, 0.4, 0.3]
rho_s = 0.3
brdf = "ggx"
alpha = 0.3

[sky]
file = "sky.image"

[reference]
n = 8

[arms.sky]
n = [4, 16]

[arms.both]
kind = "mis"
of = ["sky", "ggx-vndf"]
n = [4, 16]

[regions.all]
box = [0, 0, 47, 35]
"""
sunset = "(8, 6, 4) if 0.8 * right + 0.6 * up > 0.9 else (0.3 + 0.2 * up, 0.4 + 0.2 * up, 0.6 + 0.3 * up)"


def mesh(path, positions, triangles, version=1, cut=0):
    """Writes a .mesh file without a stated hash."""
    data = b"".join(struct.pack("<3f", *p) for p in positions) + b"".join(struct.pack("<3I", *t) for t in triangles)
    head = b"crescent" + struct.pack("<6IQ", 0x6873656D, version, len(positions), len(triangles), 0, 0, 0)
    path.write_bytes((head + data)[:len(head + data) - cut])


def choose(driver, *files):
    driver.execute_script("document.getElementById('own').open = true")
    driver.find_element(By.ID, "own-files").send_keys("\n".join(str(file) for file in files))


def drop(driver, *files):
    """Drops files on the page, as a file manager does."""
    driver.execute_script(
        "const data = new DataTransfer();"
        "for (const [name, bytes] of arguments[0])"
        "  data.items.add(new File([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))], name));"
        "document.body.dispatchEvent(new DragEvent('drop', {bubbles: true, cancelable: true, dataTransfer: data}))",
        [[file.name, base64.b64encode(file.read_bytes()).decode()] for file in files])


def tests(page, work):
    folder = work / "own"

    def your_scene(driver):
        """A mesh under a sky has the program's films, and its numbers against a reference of two estimates, whether its
        files are chosen or dropped; a mesh alone gets an experiment."""
        folder.mkdir(exist_ok=True)
        mesh(folder / "tent.mesh", *tent)
        (folder / "tent.toml").write_text(experiment)
        here = pathlib.Path(__file__).parent.parent
        subprocess.run(["/usr/bin/python3", here / "sky_image.py", folder / "sky.exr", "32", sunset], check=True)
        program = [os.environ["CRESCENT"], "import", folder / "sky.exr", "--out", folder / "sky.image"]
        subprocess.run(program, check=True, stdout=subprocess.DEVNULL)
        files = [folder / name for name in ("tent.mesh", "sky.image", "tent.toml")]
        shown = {}
        for give in (choose, drop):
            browser.open_page(driver, page, small)
            driver.execute_script("delete document.documentElement.dataset.took")
            give(driver, *files)
            browser.wait(driver, f"{browser.FINISHED} && document.getElementById('command').textContent.includes('tent.toml')")
            browser.wait(driver, "!document.getElementById('pictures').textContent.includes('being measured')")
            assert browser.text(driver, "#wrong") == "", browser.text(driver, "#wrong")
            assert browser.text(driver, "#command") == "crescent run tent.toml", browser.text(driver, "#command")
            shown[give] = browser.shown(driver)
        out = folder / "out"
        subprocess.run([os.environ["CRESCENT"], "run", "tent.toml", "--seeds", "1", "--only", "metrics", "--quiet",
                        "--out", out], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        metrics = json.loads((out / "metrics.json").read_text())
        of_program = sorted(hash for key, hash in metrics["films"].items() if " n=16" in key)
        assert shown[choose] == shown[drop] == of_program and len(of_program) == 2, (shown, metrics["films"])
        rows = driver.execute_script(
            "return [...document.querySelectorAll('.shown')].flatMap((f) => [...f.querySelectorAll('tr:not(.note)')].map("
            "(r) => [f.querySelector('b').textContent, r.cells[0].textContent, r.cells[1].firstChild.textContent]))")
        regions = {run["arm"]: run["regions"]["all"] for run in metrics["runs"] if run["n"] == 16}
        read = 0
        for arm, name, text in rows:
            number = {"RMSE of all": "rmse", "error of the reference in all": "reference_error"}.get(name)
            if not number:
                continue
            read += 1
            assert math.isclose(float(text), regions[arm][number], rel_tol=0.051), (arm, name, text, regions)
        assert read == 4, rows

        drop(driver, folder / "tent.mesh")
        browser.wait(driver, "document.getElementById('save-own')?.textContent === 'Save tent.toml' && "
                             "document.querySelectorAll('#pictures canvas')[0]?.width === 240")
        assert "renderer" in browser.text(driver, "#pictures"), browser.text(driver, "#pictures")

    def your_scene_is_refused(driver):
        """A pack that is damaged or too large, another file, and an experiment without its mesh each get a sentence with
        the file and the place, and the page keeps what it shows."""
        folder.mkdir(exist_ok=True)
        browser.open_page(driver, page, small)
        films = browser.shown(driver)
        mesh(folder / "cut.mesh", *tent, cut=5)
        mesh(folder / "next.mesh", *tent, version=2)
        mesh(folder / "outside.mesh", tent[0], [(0, 1, 9)])
        mesh(folder / "large.mesh", tent[0], [(0, 1, 2)] * 300_001)
        (folder / "model.obj").write_text("v 0 0 0\n")
        (folder / "alone.toml").write_text(experiment.replace("tent.mesh", "absent.mesh").replace("sky.image", "absent.image"))
        for name, word in (("cut.mesh", "truncated"), ("next.mesh", "byte 12"), ("outside.mesh", "triangle 0"),
                           ("large.mesh", "at most 300000 triangles"), ("model.obj", "crescent import"),
                           ("alone.toml", "absent.image")):
            choose(driver, folder / name)
            said = browser.wait(driver, f"document.getElementById('wrong').textContent.includes('{word}') && "
                                        "document.getElementById('wrong').textContent")
            assert word == "absent.image" or name in said, said
            assert browser.shown(driver) == films, f"{name} changed the films"
        assert "experiment=three-glosses" in driver.execute_script("return location.hash")

    return [your_scene, your_scene_is_refused]
