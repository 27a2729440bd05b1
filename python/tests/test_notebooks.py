"""The notebooks run from top to bottom."""

import ast
import json
import os
from pathlib import Path

import pytest

FOLDER = Path(os.environ.get("CRESCENT_NOTEBOOKS", Path(__file__).resolve().parents[1] / "notebooks"))
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def test_there_are_three():
    assert {n.stem for n in NOTEBOOKS} == {"check_a_numpy_sampler", "arms_at_equal_n", "paper_figures"}


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
    monkeypatch.chdir(path.parent)
    monkeypatch.setenv("MPLBACKEND", "agg")
    notebook = json.loads(path.read_text())
    assert notebook["nbformat"] == 4
    names = {}
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "code" and "matplotlib" in source:
            pytest.importorskip("matplotlib")
        if cell["cell_type"] == "code":
            run_cell(source, names)
