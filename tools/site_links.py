"""Links of the documentation's site.

site_links.py DIR          prints relative links of the HTML pages in DIR that lead to no file there; exit code 1 if any
site_links.py DIR ROOT     first completes DIR: links to pages (NAME.md#heading) lead to their HTML, and files and
                           folders of the repository ROOT that pages name are copied to DIR/files
"""

import html
import shutil
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [value for key, value in attrs if key in ("href", "src") and value]


def broken(page: Path) -> list[str]:
    links = Links()
    links.feed(page.read_text(encoding="utf-8"))
    out = []
    for link in links.found:
        parts = urlsplit(link)
        if parts.scheme or parts.netloc or not parts.path:
            continue
        if not (page.parent / unquote(parts.path)).exists():
            out.append(f"{page.name}: {link}")
    return out


def listing(folder: Path) -> Path:
    """A page with the files of a folder."""
    out = folder / "index.html"
    names = sorted(f.name for f in folder.iterdir() if f != out and f.is_file())
    rows = "".join(f'<li><a href="{html.escape(n)}">{html.escape(n)}</a></li>' for n in names)
    out.write_text(f"<!doctype html><title>{html.escape(folder.name)}</title><ul>{rows}</ul>", encoding="utf-8")
    return out


def completed(link: str, site: Path, root: Path) -> str:
    """Where a link of a page of the repository leads in the site; itself if it leads nowhere in either."""
    path = unquote(urlsplit(link).path)
    for base in (root / "docs", root):
        source = (base / path).resolve()
        if not source.exists() or not source.is_relative_to(root):
            continue
        if source.suffix == ".md":
            part = "docs_" if source.parent.name == "docs" else ""
            name = f"md_{part}{source.stem.replace('-', '_')}.html"
            found = site / ("index.html" if source.name == "README.md" else name)
        else:
            found = site / "files" / source.relative_to(root)
            found.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, found, dirs_exist_ok=True)
                found = listing(found)
            else:
                shutil.copyfile(source, found)
        if found.exists():
            return found.relative_to(site).as_posix()
    return link


def complete(site: Path, root: Path) -> None:
    for page in sorted(site.glob("*.html")):
        text = page.read_text(encoding="utf-8")
        for line in broken(page):
            link = line.split(": ", 1)[1]
            to = html.escape(completed(link, site, root))
            text = text.replace(f'href="{html.escape(link)}"', f'href="{to}"')
        page.write_text(text, encoding="utf-8")


def main() -> int:
    if len(sys.argv) > 2:
        complete(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
    pages = sorted(Path(sys.argv[1]).rglob("*.html"))
    found = [line for page in pages for line in broken(page)]
    print("\n".join(sorted(set(found))[:40]), file=sys.stderr) if found else None
    print(f"{len(pages)} pages, {len(found)} broken links", file=sys.stderr)
    return 1 if found or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
