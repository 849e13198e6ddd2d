# SPDX-License-Identifier: MIT
"""The notebooks of the examples have the code of their programs, and run."""

import ast
import importlib.util
import json
import pathlib

import pytest

root = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def script():
    """scripts/notebooks.py as a module."""
    spec = importlib.util.spec_from_file_location("notebooks", root / "scripts" / "notebooks.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def cells(text, kind="code"):
    return ["".join(cell["source"]) for cell in json.loads(text)["cells"] if cell["cell_type"] == kind]


def test_notebooks_are_in_step_with_their_programs(script, capsys):
    assert script.main(["--check"]) == 0, capsys.readouterr().out


def test_a_notebook_has_the_statements_of_its_program(script):
    for source in sorted(script.PROGRAMS.rglob("*.py")):
        text = script.notebook(source, source.with_suffix(".ipynb"))  # beside it, where the folder is "."
        program = ast.parse(source.read_text(encoding="utf-8").replace("pathlib.Path(__file__).parent",
                                                                       'pathlib.Path(".")'))
        if ast.get_docstring(program):
            program.body.pop(0)
        together = [statement for cell in cells(text) for statement in ast.parse(cell).body]
        assert ast.dump(ast.Module(together, [])) == ast.dump(ast.Module(program.body, [])), source
        assert cells(text, "markdown"), source


def test_a_program_that_was_changed_and_a_notebook_without_one_are_named(script, tmp_path, monkeypatch, capsys):
    programs = tmp_path / "examples"
    programs.mkdir()
    program = programs / "one.py"
    program.write_text('# SPDX-License-Identifier: MIT\n"""About one."""\n\n'
                       '# snippet: a\nx = 1\n# end of snippet\ny = 2\n')
    for name, value in (("ROOT", tmp_path), ("PROGRAMS", programs), ("NOTEBOOKS", programs / "notebooks")):
        monkeypatch.setattr(script, name, value)
    assert script.main([]) == 0 and script.main(["--check"]) == 0
    text = (programs / "notebooks" / "one.ipynb").read_text()
    assert cells(text) == ["x = 1", "y = 2"] and cells(text, "markdown") == ["About one."]
    program.write_text(program.read_text().replace("y = 2", "y = 3"))
    assert script.main(["--check"]) == 1 and "one.ipynb differs" in capsys.readouterr().out
    program.unlink()
    assert script.main(["--check"]) == 1 and "one.ipynb has no program" in capsys.readouterr().out
    assert script.main([]) == 0 and not (programs / "notebooks" / "one.ipynb").exists()


def test_a_notebook_runs_and_shows_its_picture(script, tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    for package in ("ipykernel", "matplotlib"):
        pytest.importorskip(package)
    read = nbformat.read(script.NOTEBOOKS / "how_to" / "poincare.ipynb", as_version=4)
    nbformat.validate(read)
    nbclient.NotebookClient(read, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [output for cell in read.cells for output in cell.get("outputs", [])]
    assert any("image/png" in output.get("data", {}) for output in shown)
    assert (tmp_path / "poincare.png").stat().st_size > 10_000
