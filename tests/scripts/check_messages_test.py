#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What check_messages.py finds: each piece of code reads a message, or does not."""

import sys
import unittest

sys.dont_write_bytecode = True
import check_messages  # noqa: E402


def handler(code):
    return f"try:\n    f()\nexcept Error as error:\n    {code}\n"


class Python(unittest.TestCase):
    def test_messages_that_are_read(self):
        for code in ('if "interpreted" in str(error): g()', 'text = str(error); g(text.replace("a", "b"))',
                     "g(re.sub('a', 'b', str(error)))", "g(str(error).splitlines()[0])", "g(error.args[0] == 'a')",
                     "g(str(error).lower().startswith('a'))"):
            self.assertTrue(check_messages.reads_in_python(handler(code)), code)
        self.assertTrue(check_messages.reads_in_python("def words(said):\n    return said.replace('a', 'b')\n"))

    def test_messages_that_are_told(self):
        for code in ("raise Other(f'{name}: {error}')", "g(str(error))", "print(error)", "g(error.name == 'a')",
                     "g(name.startswith('a'))"):
            self.assertFalse(check_messages.reads_in_python(handler(code)), code)
        self.assertFalse(check_messages.reads_in_python("text = str(x)\ng(text.startswith('a'))\n"))


class Cpp(unittest.TestCase):
    def test_messages_that_are_read(self):
        for code in ('std::string(e.what()).find("a")', "std::string_view(e.what()).starts_with(x)",
                     'e.said().text().substr(0, 3)', 'p.words == "a"', 'std::regex_search(e.what(), r)'):
            self.assertEqual(check_messages.reads_in_cpp(f"int x;\nf({code});\n"), [2], code)

    def test_messages_that_are_told(self):
        for code in ("tell(e.what())", "throw error(e.what());", "std::string(words)", "all += words_for(p)"):
            self.assertFalse(check_messages.reads_in_cpp(code), code)


unittest.main()
