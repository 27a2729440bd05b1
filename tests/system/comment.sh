#!/bin/bash
# tools/comment.py against a server that records its calls: one comment that is posted once and updated afterwards, on
# GitHub and on GitLab; marks of strangers, names with code in them, and a token that may not comment.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3"

cat >server.py <<'PY'
import http.server, json, sys
comments, calls = [], []
class Api(http.server.BaseHTTPRequestHandler):
    def reply(self, code, what, link=""):
        body = json.dumps(what).encode()
        self.send_response(code)
        if link:
            self.send_header("Link", f'<http://127.0.0.1:{self.server.server_port}{link}>; rel="next"')
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)
    def any(self):
        length = int(self.headers.get("Content-Length", 0))
        body = json.loads(self.rfile.read(length)) if length else None
        with open("calls", "a") as out:
            out.write(json.dumps([self.command, self.path, body, self.headers.get("Authorization"),
                                  self.headers.get("PRIVATE-TOKEN")]) + "\n")
        if "forbidden" in self.path:
            return self.reply(403, {"message": "Resource not accessible by integration"})
        if self.path == "/gitlab/user":
            return self.reply(200, {"id": 7})
        if self.command == "GET":  # a page is one comment
            page = int(self.path.rpartition("page=")[2]) if "&page=" in self.path else 1
            link = f"{self.path.partition('&page=')[0]}&page={page + 1}" if page < len(comments) else ""
            return self.reply(200, comments[page - 1:page], link)
        if self.command == "POST":
            comments.append({"id": 100 + len(comments), "body": body["body"], "user": {"type": "Bot"}, "author": {"id": 7}})
            return self.reply(201, comments[-1])
        number = int(self.path.rpartition("/")[2])
        for comment in comments:
            if comment["id"] == number:
                comment["body"] = body["body"]
                return self.reply(200, comment)
        self.reply(404, {})
    do_GET = do_POST = do_PATCH = do_PUT = any
    def log_message(self, *_):
        pass
# A stranger wrote our mark before us.
comments.append({"id": 1, "body": "<!-- crescent-suite.toml -->\nall is well", "user": {"type": "User"}, "author": {"id": 9}})
server = http.server.HTTPServer(("127.0.0.1", 0), Api)
open("port.new", "w").write(str(server.server_port))
import os; os.rename("port.new", "port")
server.serve_forever()
PY
serve() {
    rm -f calls port
    python3 server.py &
    server=$!
    for _ in $(seq 100); do [ -s port ] && break; sleep 0.05; done
    [ -s port ] || die "the server did not start"
    url=http://127.0.0.1:$(cat port)
}
stop() { kill "$server" && wait "$server" 2>/dev/null; }
comment() { python3 "$CRESCENT_SOURCE/tools/comment.py" "$@"; }

printf '### views\n\n| changed | lamp |\n' >first.md
printf '### views\n\nall same\n' >second.md
echo '{"pull_request": {"number": 12}}' >event.json
unset CI_MERGE_REQUEST_IID
export GITHUB_TOKEN=secret GITHUB_REPOSITORY=owner/repository GITHUB_EVENT_PATH=$PWD/event.json GITHUB_RUN_ID=5

serve
trap 'kill "$server" 2>/dev/null; rm -rf "$work"' EXIT
export GITHUB_API_URL=$url/api
expect 0 comment --name crescent-suite.toml --report https://example.org/report first.md
expect 0 comment --name crescent-suite.toml second.md
expect 0 comment --name 'crescent-$(touch ran) --> <script>' absent.md
[ ! -e ran ] || die "a name was run"
expect 0 python3 - <<'PY'
import json
calls = [json.loads(line) for line in open("calls")]
written = [(c[0], c[1], c[2]["body"]) for c in calls if c[0] != "GET"]
assert [w[:2] for w in written] == [("POST", "/api/repos/owner/repository/issues/12/comments"),
                                    ("PATCH", "/api/repos/owner/repository/issues/comments/101"),
                                    ("POST", "/api/repos/owner/repository/issues/12/comments")], written
assert written[0][2].startswith("<!-- crescent-suite.toml -->\n### views"), written[0]
assert "[Report](https://example.org/report)" in written[0][2] and "actions/runs/5" in written[0][2], written[0]
assert "all same" in written[1][2], written[1]
assert written[2][2].startswith("<!-- crescent-touch-ran-script- -->\n"), written[2]
assert all(c[3] == "Bearer secret" for c in calls), calls
PY
GITHUB_API_URL=$url/forbidden expect 0 comment first.md
grep -q '::warning::crescent: no comment was posted: 403' printed || die "not named: $(cat printed)"
# With an address of the report, the pictures of its worst three views are shown from their places next to it.
mkdir plates
for name in 1-lamp-baseline 1-lamp-candidate 1-lamp-difference 1-lamp-noise 2-b--i--baseline 4-wall-difference; do
    : >"plates/$name.png"
done
expect 0 comment --name plates --report 'https://example.org/r/report.html?a=1&b' --plates plates first.md
expect 0 comment --name plates --plates plates first.md
expect 0 python3 - <<'PY'
import json
calls = [json.loads(line) for line in open("calls")]
shown, plain = [c[2]["body"] for c in calls if c[2]][-2:]
for kind in ("baseline", "candidate", "difference"):
    assert f'src="https://example.org/r/plates/1-lamp-{kind}.png"' in shown, shown
assert "2-b--i--baseline" in shown and "4-wall" not in shown and "noise" not in shown, shown
assert shown.index("| changed | lamp |") < shown.index("<table>") < shown.index("[Report]("), shown
assert "<img" not in plain, plain
PY
python3 -c 'print("x" * 100000)' >long.md
expect 0 comment --name long long.md
expect 0 python3 -c 'import json; last = [json.loads(line) for line in open("calls")][-1]
assert len(last[2]["body"]) <= 65536 and "actions/runs" in last[2]["body"], len(last[2]["body"])'
stop

serve
export CI_MERGE_REQUEST_IID=3 CI_API_V4_URL=$url/gitlab CI_PROJECT_ID=group/project CRESCENT_GITLAB_TOKEN=token \
    CI_PIPELINE_URL=https://example.org/pipeline
expect 0 comment --name crescent-suite.toml first.md
expect 0 comment --name crescent-suite.toml second.md
expect 0 python3 - <<'PY'
import json
calls = [json.loads(line) for line in open("calls")]
assert [c[:2] for c in calls if c[0] != "GET"] == [
    ["POST", "/gitlab/projects/group%2Fproject/merge_requests/3/notes"],
    ["PUT", "/gitlab/projects/group%2Fproject/merge_requests/3/notes/101"]], calls
assert all(c[4] == "token" for c in calls), calls
PY
stop
trap 'rm -rf "$work"' EXIT
unset CI_MERGE_REQUEST_IID
echo '{}' >event.json
expect 0 comment first.md
