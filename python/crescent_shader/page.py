"""What surrounds a user's WGSL in the page, from the same text as here: ``python -m crescent_shader.page`` prints
apps/web/shader_text.json, which the page's scripts fill in (apps/web/wgsl.ts)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from .languages import IN, OUT, ROWS_IN_GROUP, SET, program
from .request import CONTEXT, Request

NUMBERS = 8  # of a row, of which a sampler may take fewer
USES = ("s", "alpha", "rho_d", "rho_s")  # the page's surfaces have neither `side` nor `eta`
_NUMBERS = ", ".join(["u", *(f"u{k + 1}" for k in range(NUMBERS))])
_MARKS = {"page_file": "<file>", "page_let": "<let>", "page_sample": "<sample>", "page_pdf": "<pdf>"}


def _operation(operation: str, draws_pdf: bool) -> dict[str, Any]:
    """The lines of one operation, each mark at the place of a text of the user's."""
    request = Request(
        path=Path("page.wgsl"),
        language="wgsl",
        text="page_file",
        sample=f"page_sample({_NUMBERS}{', pdf' if draws_pdf else ''});",
        pdf="page_pdf = 1; pdf = 1;",
        let=("page_let;",),
        numbers=NUMBERS,
        uses=USES,
    )
    made = program(request, operation, 1, 0)
    lines, context = [], {}
    for line in made.lines:
        words = line.text.split()
        mark = next((mark for word, mark in _MARKS.items() if word in line.text), None)
        name = words[1].rstrip(":") if words[:1] == ["let"] else ""
        if name in USES:
            context[name] = line.text
        else:
            lines.append(mark or line.text)
    return {"columns_in": made.columns_in, "columns_out": made.columns_out, "lines": lines, "context": context}


def texts() -> dict[str, Any]:
    """The operations, and what the buffers are bound to."""
    return {
        "set": SET,
        "in": IN,
        "out": OUT,
        "rows_in_group": ROWS_IN_GROUP,
        "numbers": NUMBERS,
        "context": {name: CONTEXT[name] for name in USES},
        "sample": _operation("sample", draws_pdf=False),
        "sample_with_pdf": _operation("sample", draws_pdf=True),
        "pdf": _operation("pdf", draws_pdf=False),
    }


if __name__ == "__main__":
    print(json.dumps(texts(), indent=1))
