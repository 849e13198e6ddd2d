#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks a site of HTML files: every link, image and anchor within it exists.

Usage: scripts/check_site.py FOLDER

Exit status 1 if one does not, or if there are no pages to check.
"""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """The links and anchors of one page."""

    def __init__(self, file):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        if values.get("id"):
            self.anchors.add(values["id"])
        for name in ("href", "src"):
            if values.get(name) and tag in ("a", "img", "link", "script", "object"):
                self.links.append(values[name])


def main(arguments):
    if len(arguments) != 1 or arguments[0] in ("-h", "--help"):
        print(__doc__.strip())
        return 0 if arguments else 2
    root = pathlib.Path(arguments[0]).resolve()
    pages = {file: Page(file) for file in sorted(root.rglob("*.html"))}
    wrong = checked = 0
    for file, page in pages.items():
        for link in page.links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc:
                continue
            target = (file.parent / urllib.parse.unquote(url.path)).resolve() if url.path else file
            anchor = urllib.parse.unquote(url.fragment)
            checked += 1
            if target.is_dir():
                target /= "index.html"
            if not target.is_file():
                problem = "is not there"
            elif anchor and target in pages and anchor not in pages[target].anchors:
                problem = "has no such anchor"
            else:
                continue
            wrong += 1
            print(f"{file.relative_to(root)}: {link} {problem}")
    print(f"{len(pages)} pages, {checked} links within the site, {wrong} of them broken")
    return 1 if wrong or not checked else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
