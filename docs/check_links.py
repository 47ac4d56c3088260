#!/usr/bin/env python3
"""Checks that every link of the built site that stays within it leads to a page and a place on it."""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LINKS = [("a", "href"), ("img", "src"), ("iframe", "src"), ("link", "href"), ("script", "src")]


class Page(HTMLParser):
    """Links and places of a page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: set[str] = set()
        self.places: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if value and name in ("id", "name"):
                self.places.add(value)
            elif value and (tag, name) in LINKS:
                self.links.add(value)


def main() -> int:
    root = Path(sys.argv[1]).resolve()
    # rustdoc checks its own pages.
    pages = {path: Page(path) for path in root.rglob("*.html") if not {"_static", "rust"} & {*path.relative_to(root).parts}}
    dead = 0
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            place = unquote(parts.fragment)
            if not target.exists() or (place and target in pages and place not in pages[target].places):
                dead += 1
                print(f"{path.relative_to(root)}: dead link {link}")
    print(f"{len(pages)} pages, {sum(len(page.links) for page in pages.values())} links, {dead} dead")
    return int(dead > 0 or not pages)


if __name__ == "__main__":
    sys.exit(main())
