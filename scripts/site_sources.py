#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts the sources of the documentation's site together: one text for the repository and the site.

Usage: scripts/site_sources.py FOLDER

Copies docs/, CONTRIBUTING.md and CHANGELOG.md to FOLDER. A link to another file of the repository becomes a link to a
page with that file, so that the site is whole without a repository beside it; one to a folder shows its files. A block
of code gets its file as a caption. Sections between `<!-- tabs -->` and `<!-- end of tabs -->`, which a repository
shows one below the other, become tabs with their headings as names; the choice holds for all pages. Exit status 1 if a
link leads to a file that is not there.
"""

import os
import pathlib
import re
import shutil
import sys

from version import version

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES_OF_ROOT = {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md", "README.md": "index.md"}
LANGUAGES = {".hpp": "c++", ".cpp": "c++", ".cu": "cuda", ".cuh": "cuda", ".py": "python", ".sh": "bash",
             ".cmake": "cmake", ".txt": "cmake", ".json": "json", ".cff": "yaml"}
LINK = re.compile(r"(?<!!)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
IMAGE = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")
SNIPPET = re.compile(r"^<!-- snippet: (\S+)(?: \w+)? -->\n```(\S+)\n", flags=re.M)

TABS = re.compile(r"^<!-- tabs -->\n(.*?)^<!-- end of tabs -->$", flags=re.M | re.S)
FENCES = re.compile(r"(^```.*?^```$)", flags=re.M | re.S)


def tabbed(match):
    """Sections as a set of tabs."""
    out = []
    for part in FENCES.split(match[1]):
        is_code = part.startswith("```")
        out.append(part if is_code else re.sub(
            r"^## (.*)$", r"::::::\n\n::::::{tab-item} \1\n:sync: \1", part, flags=re.M).strip("\n"))
    text = "\n\n".join(part for part in out if part).removeprefix("::::::\n\n")  # the first one follows no other
    return f":::::::{{tab-set}}\n:sync-group: language\n\n{text}\n\n::::::\n:::::::"


def captioned(match):
    """The beginning of a block of code with its file as a caption; commands need none."""
    if match[2] in ("sh", "bash"):
        return "```bash\n"
    return f"```{{code-block}} {match[2].replace('cpp', 'c++')}\n:caption: {match[1]}\n\n"


class Site:
    """The pages written so far, and the files of the repository that they lead to."""

    def __init__(self, folder):
        self.folder = folder
        self.wanted = set()
        self.broken = []

    def page(self, path):
        """The page that a file or folder of the repository, relative to its root, is on."""
        text = path.as_posix()
        if text in PAGES_OF_ROOT:
            return PAGES_OF_ROOT[text]
        if text.startswith("docs/") and (path.suffix == ".md" or text.startswith("docs/images/")):
            return text.removeprefix("docs/")
        if not (ROOT / path).exists():
            return None
        self.wanted.add(path)
        return f"source/{'index' if text == '.' else text}.md"

    def rewrite(self, text, document, page):
        """The text of a document with its links as they are from its page."""
        def target(link):
            if re.match(r"[a-z]+:|#", link):
                return link
            file, _, anchor = link.partition("#")
            path = pathlib.Path(os.path.normpath(document.parent / file))
            found = None if path.as_posix().startswith("..") else self.page(path)
            if found is None:
                self.broken.append(f"{document}: {link}")
                return link
            relative = os.path.relpath(found, pathlib.Path(page).parent)
            return relative + ("#" + anchor if anchor else "")

        parts = re.split(r"(^```.*?^```$|`[^`\n]*`)", text, flags=re.M | re.S)
        for i in range(0, len(parts), 2):
            parts[i] = IMAGE.sub(lambda m: f"![{m[1]}]({target(m[2])})", parts[i])
        text = "".join(parts)
        # A link's text may have code in it, so that links are looked for in the whole, but not in blocks.
        parts = re.split(r"(^```.*?^```$)", text, flags=re.M | re.S)
        for i in range(0, len(parts), 2):
            parts[i] = LINK.sub(lambda m: f"[{m[1]}]({target(m[2])})", parts[i])
        text = "".join(parts)
        text = SNIPPET.sub(captioned, text)
        text = re.sub(r"^```sh$", "```bash", text, flags=re.M)
        text = TABS.sub(tabbed, text)
        return re.sub(r"^<!--.*?-->\n", "", text, flags=re.M)

    def write(self, page, text):
        file = self.folder / page
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def write_source(self, path):
        """The page of a file or folder of the repository."""
        page = self.page(path)
        title = f"---\norphan: true\n---\n# `{path.as_posix()}`\n\n"
        if (ROOT / path).is_dir():
            files = sorted(p.relative_to(ROOT) for p in (ROOT / path).iterdir()
                           if p.is_file() and (p.suffix in LANGUAGES or p.suffix in (".md", ".ipynb")))
            below = [f"* [{p.name}]({os.path.relpath(self.page(p), pathlib.Path(page).parent)})" for p in files]
            self.write(page, title + "\n".join(below) + "\n")
            return
        if path.suffix == ".md":
            self.write(page, title + self.rewrite((ROOT / path).read_text(encoding="utf-8"), path, page))
            return
        if path.suffix == ".ipynb":
            self.write(page, f"{title}{{download}}`Download the notebook <{path.name}>`\n")
            shutil.copy(ROOT / path, self.folder / page.removesuffix(".md"))
            return
        text = (ROOT / path).read_text(encoding="utf-8")
        language = LANGUAGES.get(path.suffix, "text")
        self.write(page, f"{title}``````{{code-block}} {language}\n{text.rstrip()}\n``````\n")


def main(arguments):
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__.strip())
        return 0 if arguments in (["-h"], ["--help"]) else 2
    folder = pathlib.Path(arguments[0])
    shutil.rmtree(folder, ignore_errors=True)
    site = Site(folder)
    documents = sorted((ROOT / "docs").rglob("*.md")) + [ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]
    for document in documents:
        relative = document.relative_to(ROOT)
        page = site.page(relative)
        site.write(page, site.rewrite(document.read_text(encoding="utf-8"), relative, page))
    for part in ("images", "static"):
        shutil.copytree(ROOT / "docs" / part, folder / part)
    shutil.copy(ROOT / "docs" / "conf.py", folder)
    site.write("version.txt", version() + "\n")
    written = set()
    while site.wanted - written:  # a folder's page leads to its files
        for path in sorted(site.wanted - written):
            site.write_source(path)
            written.add(path)
    for link in site.broken:
        print(f"{link} leads to nothing")
    return 1 if site.broken else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
