# SPDX-License-Identifier: MIT
"""Headers with one piece of text changed. A mutation is (header, text, replacement, ...)."""


def stale(mutations, folder):
    """Messages about mutations, by name, whose text does not stand exactly once in their header in `folder`."""
    found = {name: (folder / header).read_text().count(text) for name, (header, text, *_) in mutations.items()}
    return [f"{name}: {mutations[name][0]} has the text {count} times, not once: {mutations[name][1]}"
            for name, count in found.items() if count != 1]


def change(mutation, folder):
    """Makes the change in `folder`. Returns the header's path and what was in it."""
    header, text, becomes, *_ = mutation
    path = folder / header
    content = path.read_text()
    path.write_text(content.replace(text, becomes))
    return path, content
