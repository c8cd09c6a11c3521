"""Data flows one way: who may import whom, and how large a room may grow."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
FORBIDDEN = {"hal": {"naod", "sim_backend"}, "naod": {"sim_backend"}, "sim_backend": {"naod"}}
LONGEST_FILE, LONGEST_BODY = 300, 40


def sources(*packages):
    for package in packages:
        yield from sorted((ROOT / package).rglob("*.py"))


def imported(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module.split(".")[0]


@pytest.mark.parametrize("package", sorted(FORBIDDEN))
def test_no_room_imports_what_it_must_not_know(package):
    for path in sources(package):
        names = set(imported(ast.parse(path.read_text())))
        assert not names & FORBIDDEN[package], path


def body_lines(function):
    body = function.body
    first = body[0]
    if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
        body = body[1:]
    return body[-1].end_lineno - body[0].lineno + 1 if body else 0


def test_rooms_stay_small():
    for path in sources("hal", "naod", "sim_backend", "tests"):
        text = path.read_text()
        assert text.count("\n") <= LONGEST_FILE, path
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                assert body_lines(node) <= LONGEST_BODY, (path, node.name)
