#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows on small packages that check_import_graph.py finds each violation, and nothing else."""
import pathlib
import tempfile
import unittest

from check_import_graph import complaints

SOUND = {
    "__init__.py": "from . import _core\nfrom .models.model import *\nfrom .formats.sbml.model import read\n",
    "base/__init__.py": "", "models/__init__.py": "", "formats/__init__.py": "", "formats/sbml/__init__.py": "",
    "base/errors.py": "import os\nfrom math import pi\n",
    "base/kinds.py": "from .. import _core\nfrom .._core import kinds\n",
    "models/event.py": "from ..base import errors as why, kinds\n",
    "models/model.py": "from typing import TYPE_CHECKING\nimport myriad_ode._core\nfrom ..base.errors import Error\n"
                       "if TYPE_CHECKING:\n    from .event import Event\n",
    "formats/sbml/math.py": "from ...base import errors\n",
    "formats/sbml/model.py": "def read():\n    from ...models.model import Model\n    from . import math\n",
}


class CheckImportGraph(unittest.TestCase):
    def complaints_of(self, changed):
        """The complaints about SOUND with other texts of some files."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder, "myriad_ode")
            for name, text in {**SOUND, **changed}.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return complaints(root)

    def assert_found(self, changed, *words):
        found = "\n".join(self.complaints_of(changed))
        for word in words:
            self.assertIn(word, found)

    def test_imports_that_point_down_pass(self):
        self.assertEqual(self.complaints_of({}), [])

    def test_no_files_are_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertIn("no files", complaints(pathlib.Path(folder))[0])

    def test_an_import_that_points_up(self):
        self.assert_found({"base/errors.py": "from ..models.event import Event\n"}, "base/errors.py:1",
                          "models.event", "'base' may import base alone")

    def test_one_for_type_checkers_and_one_within_a_function(self):
        for text in ("if TYPE_CHECKING:\n    from ..formats.sbml.model import read\n",
                     "def f():\n    from ..formats.sbml import model\n", "import myriad_ode.formats.sbml.model\n",
                     "from myriad_ode.formats.sbml import model\n"):
            self.assert_found({"models/event.py": text}, "models/event.py", "formats.sbml.model")

    def test_what_the_package_brings_together(self):
        self.assert_found({"models/event.py": "from .. import model\n"}, "models/event.py:1 imports the package itself")
        self.assert_found({"models/event.py": "import myriad_ode\n"}, "models/event.py:1 imports the package itself")

    def test_a_circle_of_files_of_a_package(self):
        self.assert_found({"models/event.py": "def f():\n    from . import model\n"}, "in a circle",
                          "models/event.py:2 imports models.model", "models/model.py:5 imports models.event")

    def test_a_circle_of_three_by_a_package_within_a_package(self):
        self.assert_found({"formats/sbml/math.py": "from . import rates\n",
                           "formats/sbml/rates.py": "from .model import read\n"}, "in a circle", "rates.py:1")

    def test_a_file_in_no_layer(self):
        self.assert_found({"lost.py": ""}, "lost.py is in no layer")
        self.assert_found({"other/lost.py": ""}, "other/lost.py is in no layer")


if __name__ == "__main__":
    unittest.main()
