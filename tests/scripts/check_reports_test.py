#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows that scripts/check_reports.py counts changes of code, and only those."""

import contextlib
import io
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import check_reports  # noqa: E402 pylint: disable=wrong-import-position


class History(unittest.TestCase):
    """A repository with one header and one report."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        check_reports.ROOT = pathlib.Path(self.folder.name)
        check_reports.REPORTS = {"report.md": (r"^sources: (\w+)", ["kernel"], 1, "make")}
        self.git("init", "--quiet")
        self.first = self.commit("int f() { return 1; }\n")
        (check_reports.ROOT / "report.md").write_text(f"sources: {self.first}\n", encoding="utf-8")

    def tearDown(self):
        self.folder.cleanup()

    def git(self, *arguments):
        """Runs git in the repository."""
        identity = ["-c", "user.name=test", "-c", "user.email=test@example.org", "-c", "commit.gpgsign=false"]
        return subprocess.run(["git", *identity, *arguments], cwd=check_reports.ROOT, capture_output=True, text=True,
                              check=True).stdout.strip()

    def commit(self, text, path="kernel/a.hpp"):
        """Commits a header with this text; returns the commit."""
        file = check_reports.ROOT / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "change")
        return self.git("rev-parse", "HEAD")

    def result(self):
        """The exit status, and what was printed."""
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            status = check_reports.main([])
        return status, printed.getvalue()

    def test_comments_layout_and_moves_do_not_count(self):
        self.commit("// why\nint f() {\n    return 1;  // one\n}\n")
        self.git("mv", "kernel/a.hpp", "kernel/b.hpp")
        self.git("commit", "--quiet", "--message", "move")
        self.commit("int g();\n", "host/a.hpp")
        self.assertEqual(check_reports.age(self.first, ["kernel"]), 0)
        self.assertEqual(self.result(), (0, ""))

    def test_a_report_that_is_too_old_is_named_with_the_command_that_makes_it_anew(self):
        self.commit("int f() { return 2; }\n")
        self.assertEqual(self.result(), (0, ""))
        self.commit('const char* f() { return "// 3"; }\n')
        self.commit('const char* f() { return "// 4"; }\n')
        status, printed = self.result()
        self.assertEqual(status, 1)
        self.assertIn("report.md is 3 changes of kernel older than the sources, of at most 1: make it anew by make",
                      printed)

    def test_a_report_whose_sources_are_in_no_history_is_refused(self):
        (check_reports.ROOT / "report.md").write_text("sources: 0123abc\n", encoding="utf-8")
        self.git("add", "--all")
        status, printed = self.result()
        self.assertEqual(status, 1)
        self.assertIn("names no commit of this history", printed)
        self.assertIn("report.md names 0123abc, which is no commit of this history", printed)


if __name__ == "__main__":
    unittest.main()
