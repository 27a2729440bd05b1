"""Runs the Python blocks of one page in one namespace: one request per line of stdin, one response per line of stdout.

A request is {"text", "page", "line", "file"}; the response is {"printed", "error"}. Errors have the lines of the page.
"""

import contextlib
import io
import json
import os
import sys
import traceback


def run(request: dict, names: dict) -> dict:
    printed = io.StringIO()
    error = ""
    try:
        code = compile("\n" * request["line"] + request["text"], request["page"], "exec")
        with contextlib.redirect_stdout(printed):
            exec(code, names)
    except BaseException as e:
        inside = [at for at in traceback.extract_tb(e.__traceback__) if at.filename == request["page"]]
        where = f"line {inside[-1].lineno}: " if inside else ""
        error = where + "".join(traceback.format_exception_only(e)).strip()
    return {"printed": printed.getvalue(), "error": error}


def main() -> None:
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # library output must not become part of a response
    sys.path.insert(0, os.getcwd())
    names = {"__name__": "__main__"}
    for line in sys.stdin:
        print(json.dumps(run(json.loads(line), names)), file=answers, flush=True)


main()
