"""Tests of the examples in the README, the documents and the notebook."""

from __future__ import annotations

import pathlib
import re
from typing import Any

import pytest
from conftest import SOURCE_FOLDER

EXAMPLES = SOURCE_FOLDER / "python/examples"

#: The pictures of notebooks that have any.
PICTURES = {"first_steps": 2, "own_algorithm": 1, "tables": 1}


def examples_in(document: str) -> list[Any]:
    text = (SOURCE_FOLDER / document).read_text("utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def test_the_readme_has_an_example_of_five_lines() -> None:
    assert 0 < len(examples_in("README.md")[0].strip().splitlines()) <= 5


@pytest.mark.parametrize(
    "example",
    [
        example
        for document in ("README.md", "docs/embedding.md", "docs/python.md", "docs/results.md")
        for example in examples_in(document)
    ],
)
def test_examples_run(
    example: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    exec(compile(example, "example", "exec"), {})
    for picture in re.findall(r'"(\w+\.png)"', example):
        assert (tmp_path / picture).stat().st_size > 5000


@pytest.mark.parametrize(
    "notebook", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda path: str(path.stem)
)
def test_notebooks_run(
    notebook: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    # The kernel's own files.
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("PYTHONPATH", str(SOURCE_FOLDER / "python"))
    monkeypatch.delenv("MPLBACKEND", raising=False)
    book = nbformat.read(notebook, as_version=4)
    assert not any(cell.get("outputs") for cell in book.cells), "outputs are not kept"
    client = nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": tmp_path}})
    client.execute()
    shown = [output for cell in book.cells for output in cell.get("outputs", [])]
    texts = " ".join("".join(output.get("text", "")) for output in shown)
    assert not re.search("^broadmark: |Traceback", texts, re.MULTILINE), texts  # of commands
    if notebook.stem in PICTURES:
        kinds = [kind for output in shown for kind in output.get("data", {})]
        assert (
            sum(kind in ("image/png", "image/svg+xml") for kind in kinds) == PICTURES[notebook.stem]
        )
