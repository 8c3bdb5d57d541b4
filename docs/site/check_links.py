#!/usr/bin/env python3
"""Looks up every link of a folder of HTML pages: files and anchors within it. Prints those that lead nowhere, and then fails.

check_links.py FOLDER
"""

import pathlib
import sys
import urllib.parse
from html.parser import HTMLParser


class Page(HTMLParser):
    """The anchors of a page, and what it links to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = {"", "top"}
        self.links: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value or "")
            elif name in ("href", "src") and value is not None:
                self.links.add(value)


def main() -> int:
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = {path: Page(path.read_text("utf-8", "replace")) for path in root.rglob("*.html")}
    broken, count = [], 0
    for path, page in pages.items():
        if path.name == "404.html":
            continue  # its links are meant for a server's root
        for link in sorted(page.links):
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue  # elsewhere
            count += 1
            target = path
            if parts.path:
                target = (path.parent / urllib.parse.unquote(parts.path)).resolve()
            if target.is_dir():
                target /= "index.html"
            anchor = urllib.parse.unquote(parts.fragment)
            if not target.is_relative_to(root) or not target.exists():
                broken.append(f"{path.relative_to(root)}: {link}: no such file")
            elif target in pages and anchor not in pages[target].anchors:
                broken.append(f"{path.relative_to(root)}: {link}: no such anchor")
    print("\n".join(broken), file=sys.stderr)
    print(f"{len(pages)} pages, {count} links, {len(broken)} broken")
    return 1 if broken or not count else 0


if __name__ == "__main__":
    sys.exit(main())
