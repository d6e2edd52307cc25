"""The results in docs/paper are of the algorithms as they are."""

from __future__ import annotations

import pathlib
import subprocess

import pytest
from conftest import SOURCE_FOLDER

import broadmark

#: Files and folders in `algorithms` of algorithms that are not the paper's.
OTHERS = ["CMakeLists", "bvh8", "boost_rtree", "columns", "embree", "fcl_tree", "ode_spaces"]
OTHERS += ["queries", "self_checks", "tide"]


def git(folder: pathlib.Path, *arguments: str) -> str:
    return subprocess.run(
        ["git", "-C", folder, *arguments], check=True, capture_output=True, text=True
    ).stdout


def changed_since(commit: str, folder: pathlib.Path) -> list[str]:
    """The sources of the paper's algorithms with other code than in a commit, comments aside."""
    files = git(folder, "diff", "--name-only", "--no-renames", commit, "--", "algorithms").split()
    return [
        file
        for file in files
        if pathlib.PurePath(file).parts[1].partition(".")[0] not in OTHERS
        and code_of(at_commit(folder, commit, file)) != code_of(in_tree(folder, file))
    ]


def at_commit(folder: pathlib.Path, commit: str, file: str) -> str:
    known = git(folder, "ls-tree", "--name-only", commit, "--", file)
    return git(folder, "show", f"{commit}:{file}") if known else ""


def in_tree(folder: pathlib.Path, file: str) -> str:
    return (folder / file).read_text("utf-8") if (folder / file).exists() else ""


def code_of(source: str) -> str:
    """A source without comments and white space."""
    command = ["g++", "-fpreprocessed", "-dD", "-E", "-P", "-x", "c++", "-"]
    done = subprocess.run(command, input=source, check=True, capture_output=True, text=True)
    return "".join(done.stdout.split())


@pytest.fixture
def repository(tmp_path: pathlib.Path) -> pathlib.Path:
    for file in ("kd/tree.cpp", "tide.cpp", "grid.cpp"):
        path = tmp_path / "algorithms" / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("// An idea.\nint cells = 3;\n")
    git(tmp_path, "init", "-q")
    git(tmp_path, "add", ".")
    identity = ["-c", "user.name=a", "-c", "user.email=a@localhost"]
    git(tmp_path, *identity, "commit", "-qm", "algorithms")
    return tmp_path


def test_changes_of_code_are_found(repository: pathlib.Path) -> None:
    commit = git(repository, "rev-parse", "HEAD").strip()
    (repository / "algorithms/grid.cpp").write_text("/* A better\nidea. */ int  cells = 3;\n")
    (repository / "algorithms/tide.cpp").write_text("int cells = 4;\n")
    assert changed_since(commit, repository) == []
    (repository / "algorithms/grid.cpp").write_text("int cells = 4;\n")
    (repository / "algorithms/kd/tree.cpp").unlink()
    assert changed_since(commit, repository) == ["algorithms/grid.cpp", "algorithms/kd/tree.cpp"]


def test_the_papers_algorithms_have_not_changed_since_they_were_measured() -> None:
    results = broadmark.read_results(SOURCE_FOLDER / "docs/paper/results.json.gz")
    if "commit" not in results.environments:
        pytest.skip("measured before results stated their build: which algorithms is unknown")
    if not (SOURCE_FOLDER / ".git").exists():
        pytest.skip("not a git repository")
    assert not results.environments["dirty"].any(), "measured by a build with changes"
    for commit in results.environments["commit"]:
        changed = changed_since(commit, SOURCE_FOLDER)
        assert not changed, f"changed since commit {commit}: measure docs/paper again"
