"""Tests of the commit that a build states (cmake/Commit.cmake)."""

from __future__ import annotations

import pathlib
import re
import subprocess

import pytest
from conftest import SOURCE_FOLDER


def git(folder: pathlib.Path, *arguments: str) -> str:
    identity = ["-c", "user.name=a", "-c", "user.email=a@localhost"]
    command = ["git", "-C", str(folder), *identity, *arguments]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return done.stdout.strip()


def stated(source: pathlib.Path, given: str = "") -> tuple[str, str, str]:
    """The commit, its date and whether it is dirty, as a build of the folder would state them."""
    output = source.parent / "commit.cpp"
    script = SOURCE_FOLDER / "cmake/Commit.cmake"
    definitions = [f"-DSOURCE={source}", f"-DOUTPUT={output}", f"-DGIVEN={given}"]
    subprocess.run(["cmake", *definitions, "-P", script], check=True)
    found = re.findall(r'= (?:"(.*)"|(\w+));', output.read_text())
    commit, date, dirty = (text or word for text, word in found)
    return commit, date, dirty


@pytest.fixture
def repository(tmp_path: pathlib.Path) -> pathlib.Path:
    folder = tmp_path / "source"
    (folder / "engine").mkdir(parents=True)
    (folder / "engine/frame.cpp").write_text("int frames;\n")
    (folder / "README").write_text("Read me.\n")
    git(folder, "init", "-q")
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "all")
    return folder


def test_a_build_states_its_commit(repository: pathlib.Path) -> None:
    head, date = git(repository, "log", "-1", "--format=%H %cI").split()
    assert stated(repository, "ignored") == (head, date, "false")
    output = repository.parent / "commit.cpp"
    before = output.stat().st_mtime_ns
    (repository / "README").write_text("Not part of the program.\n")
    assert stated(repository) == (head, date, "false")
    assert output.stat().st_mtime_ns == before  # so nothing is compiled
    (repository / "engine/new.cpp").write_text("int more;\n")
    assert stated(repository) == (head, date, "true")


def test_what_is_no_repository_states_what_is_given(repository: pathlib.Path) -> None:
    inner = repository / "third_party"  # in the repository of another project
    inner.mkdir()
    assert stated(inner) == ("", "", "false")
    assert stated(inner, "0123abcd") == ("0123abcd", "", "false")
