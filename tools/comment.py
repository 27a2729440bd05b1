#!/usr/bin/env python3
"""Posts what crescent found as one comment on the pull request or merge request that a job belongs to, and updates that
comment when it runs again. Python's standard library alone.

    comment.py [--name NAME] [--report URL] [--plates FOLDER] FILE...

FILE: of `crescent compare --markdown`, one below the other. FOLDER: plates/ next to the report; the pictures of its worst
three views are shown from their places next to URL.

GitHub: GITHUB_TOKEN, GITHUB_REPOSITORY, GITHUB_EVENT_PATH, and GITHUB_API_URL, GITHUB_SERVER_URL, GITHUB_RUN_ID.
GitLab: CRESCENT_GITLAB_TOKEN (scope api), CI_API_V4_URL, CI_PROJECT_ID, CI_MERGE_REQUEST_IID, CI_PIPELINE_URL.

Exit code 0 also if the token may not comment, as for a pull request of a fork: the job's summary has the same text.
"""
import argparse
import html
import json
import os
import pathlib
import re
import sys
import urllib.error
import urllib.parse
import urllib.request

LONGEST = 65_000  # characters; GitHub takes 65,536
SHOWN = 3  # views with pictures


def call(method: str, url: str, headers: dict, body=None):
    """Returns the answer and the address of the next page ("": none)."""
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(url, data=data, method=method, headers={
        "Content-Type": "application/json", "User-Agent": "crescent", **headers})
    with urllib.request.urlopen(request, timeout=60) as answer:
        following = re.search(r'<([^>]+)>;\s*rel="next"', answer.headers.get("Link", ""))
        return json.load(answer), following.group(1) if following else ""


class GitHub:
    def __init__(self, number: int):
        api = os.environ.get("GITHUB_API_URL", "https://api.github.com")
        self.repository = f"{api}/repos/{os.environ['GITHUB_REPOSITORY']}"
        self.comments = f"{self.repository}/issues/{number}/comments"
        self.headers = {"Authorization": f"Bearer {os.environ['GITHUB_TOKEN']}",
                        "Accept": "application/vnd.github+json", "X-GitHub-Api-Version": "2022-11-28"}

    def is_ours(self, comment: dict) -> bool:
        return comment["user"]["type"] == "Bot"  # a stranger may write our mark

    def update(self, comment: dict, text: str):
        call("PATCH", f"{self.repository}/issues/comments/{comment['id']}", self.headers, {"body": text})

    def run(self) -> str:
        server = os.environ.get("GITHUB_SERVER_URL", "https://github.com")
        return f"{server}/{os.environ['GITHUB_REPOSITORY']}/actions/runs/{os.environ.get('GITHUB_RUN_ID', '')}"


class GitLab:
    def __init__(self):
        project = urllib.parse.quote(os.environ["CI_PROJECT_ID"], safe="")
        self.comments = (f"{os.environ['CI_API_V4_URL']}/projects/{project}/merge_requests/"
                         f"{int(os.environ['CI_MERGE_REQUEST_IID'])}/notes")
        self.headers = {"PRIVATE-TOKEN": os.environ["CRESCENT_GITLAB_TOKEN"]}
        api = os.environ["CI_API_V4_URL"]
        self.own = call("GET", f"{api}/user", self.headers)[0]["id"]

    def is_ours(self, comment: dict) -> bool:
        return comment["author"]["id"] == self.own

    def update(self, comment: dict, text: str):
        call("PUT", f"{self.comments}/{comment['id']}", self.headers, {"body": text})

    def run(self) -> str:
        return os.environ.get("CI_PIPELINE_URL", "")


def place():
    """Where the comment goes; None if the job belongs to no request."""
    if os.environ.get("CI_MERGE_REQUEST_IID"):
        return GitLab()
    path = os.environ.get("GITHUB_EVENT_PATH")
    event = json.loads(pathlib.Path(path).read_text()) if path else {}
    number = event.get("pull_request", {}).get("number")
    return GitHub(int(number)) if number else None


def post(to, mark: str, text: str):
    """Updates the first comment of ours that begins with the mark, or makes one."""
    page = f"{to.comments}?per_page=100"
    while page:
        comments, page = call("GET", page, to.headers)
        for comment in comments:
            if comment["body"].startswith(mark) and to.is_ours(comment):
                return to.update(comment, text)
    call("POST", to.comments, to.headers, {"body": text})


def pictures(folder: pathlib.Path, report: str) -> str:
    """A table of the pictures of the worst views, "1-VIEW-baseline.png" and so on, from where the report is published."""
    rows = []
    for number in range(1, SHOWN + 1):
        cells = []
        for kind in ("baseline", "candidate", "difference"):
            for file in sorted(folder.glob(f"{number}-*-{kind}.png")):
                address = urllib.parse.urljoin(report, f"{folder.name}/{urllib.parse.quote(file.name)}")
                name = file.name.removesuffix(f"-{kind}.png").removeprefix(f"{number}-")
                cells.append(f'{name}, {kind}<br><img width="260" alt="{kind}" src="{html.escape(address)}">')
        if cells:
            rows.append(f"<tr><td>{'</td><td>'.join(cells)}</td></tr>")
    return f"<table>{''.join(rows)}</table>" if rows else ""


def main() -> int:
    parser = argparse.ArgumentParser(description="Posts what crescent found as one comment.")
    parser.add_argument("--name", default="crescent", help="comments of other names are others")
    parser.add_argument("--report", default="", help="an address where the report opens")
    parser.add_argument("--plates", type=pathlib.Path, help="the folder of pictures, which is published with the report")
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    to = place()
    if to is None:
        print("comment.py: this job belongs to no pull request or merge request", file=sys.stderr)
        return 0
    mark = f"<!-- {re.sub('[^A-Za-z0-9_.]+', '-', arguments.name)} -->"
    parts = [pathlib.Path(file).read_text() for file in arguments.files if pathlib.Path(file).is_file()]
    if not parts:
        parts = ["crescent ended before there was a result; the log of the run has the reason."]
    links = f"[Report]({arguments.report}), [run]({to.run()})" if arguments.report else f"[Run]({to.run()})"
    shown = pictures(arguments.plates, arguments.report) if arguments.plates and arguments.report else ""
    end = f"\n\n{shown}\n\n{links}\n" if shown else f"\n\n{links}\n"
    text = mark + "\n" + "\n\n".join(parts)
    post(to, mark, text[:LONGEST - len(end)] + end)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except urllib.error.HTTPError as error:
        print(f"::warning::crescent: no comment was posted: {error.code} {error.reason}")
    except (urllib.error.URLError, TimeoutError) as error:
        print(f"::warning::crescent: no comment was posted: {error}")
