"""The notebooks run from top to bottom."""

import ast
import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

FOLDER = Path(os.environ.get("CRESCENT_NOTEBOOKS", Path(__file__).resolve().parents[1] / "notebooks"))
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
PAPER = Path(os.environ.get("CRESCENT_PAPER", Path(__file__).resolve().parents[2] / "examples" / "paper"))


def test_there_are_four():
    assert {n.stem for n in NOTEBOOKS} == {"check_a_numpy_sampler", "arms_at_equal_n", "paper_figures", "sweep"}


def run_cell(source, names):
    """Runs a cell like a notebook: the value of a last expression is shown."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    if last is None:
        return None
    value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    return value._repr_html_() if hasattr(value, "_repr_html_") else repr(value)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_notebook_runs(path, monkeypatch):
    run(path, monkeypatch)


@pytest.mark.skipif(not PAPER.is_dir(), reason="the examples are not here")
def test_the_page_of_a_paper_is_made_and_compiles(tmp_path, monkeypatch):
    shutil.copytree(PAPER, tmp_path / "paper")
    run(tmp_path / "paper" / "paper.ipynb", monkeypatch)
    for name in ("page.pdf", "table.tex", "equal-time.tex", "provenance.tex"):
        assert (tmp_path / "paper" / name).stat().st_size > 0
    if latex := shutil.which("pdflatex"):
        command = [latex, "-interaction=nonstopmode", "-halt-on-error", "paper.tex"]
        for _ in range(2):
            made = subprocess.run(command, cwd=tmp_path / "paper", capture_output=True, text=True, timeout=120)
        assert made.returncode == 0, made.stdout[-2000:]
        assert "Overfull" not in made.stdout and "undefined" not in made.stdout


def run(path, monkeypatch):
    """Runs a notebook from top to bottom in its folder."""
    monkeypatch.chdir(path.parent)
    monkeypatch.setenv("MPLBACKEND", "agg")
    notebook = json.loads(path.read_text())
    assert notebook["nbformat"] == 4
    names = {}
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] != "code":
            continue
        if "matplotlib" in source or "import plot" in source:
            pytest.importorskip("matplotlib")
        if "crescent.sweep" in source:
            for needed in ("dask", "distributed", "pyarrow"):
                pytest.importorskip(needed)
        run_cell(source, names)
