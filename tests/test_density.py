"""A rule on expressions that linters do not have: a statement is read at one glance.

Comprehensions, conditional expressions and lambdas are clear one by one. What stops a reader is
the third one in a statement, and several assignments in one line.
"""

import ast
from collections.abc import Iterable, Iterator

import pytest
from support.paths import PACKAGE
from support.trees import list_nodes

COUNTED = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp, ast.IfExp, ast.Lambda)
STATEMENTS = (ast.Assign, ast.AnnAssign, ast.AugAssign, ast.Return, ast.Expr, ast.Raise)
LISTINGS = (ast.List, ast.Tuple, ast.Set, ast.Dict, ast.Call)
LEAVES = (ast.Name, ast.Constant, ast.expr_context, ast.operator)
MOST_IN_A_PART = 2


def list_dense(nodes: Iterable[ast.AST]) -> Iterator[str]:
    """Yield line and remedy of each statement that does too much."""
    for node in nodes:
        if isinstance(node, STATEMENTS) and count_expressions(node) > MOST_IN_A_PART:
            yield f"{node.lineno}: give a part of the expression a name"
        if isinstance(node, ast.Assign) and assigns_several(node):
            yield f"{node.lineno}: write one assignment a line"


def count_expressions(node: ast.AST) -> int:
    """Return the number of comprehensions, conditional expressions and lambdas in a node. Elements
    of a listing and arguments of a call stand side by side and are read one by one: the most
    crowded one counts.
    """
    if isinstance(node, LEAVES):
        return 0
    counts = [count_expressions(child) for child in ast.iter_child_nodes(node)]
    if isinstance(node, LISTINGS):
        return max(counts, default=0)
    return sum(counts) + isinstance(node, COUNTED)


def assigns_several(node: ast.Assign) -> bool:
    """Return whether the statement is `a, b = x, y`, but not a swap."""
    target = node.targets[0]
    if not isinstance(target, ast.Tuple) or not isinstance(node.value, ast.Tuple):
        return False
    names = {ast.unparse(part) for part in target.elts}
    return names != {ast.unparse(part) for part in node.value.elts}


@pytest.mark.parametrize(
    ("statement", "clear"),
    [
        ("a = [f(x) for x in y]", True),
        ("a = [f(x) if x else 0 for x in y]", True),
        ("a = [f(x) if x else 0 for x in y if all(z for z in x)]", False),
        ("a = b if c else d if e else f if g else h", False),
        ("a = [lambda x: x if x else 0 for _ in y]", False),
        ("a = {x: [y for y in z] for z in (w for w in v)}", False),
        ("return sum(x for x in y) + max(x for x in y) - min(x for x in y)", False),
        ("return f(x for x in y).g(x for x in y).h(x for x in y)", True),
        ("return f([x for x in y], 1 if z else 2, key=lambda x: x)", True),
        ("return {'a': [x for x in y], 'b': [x for x in z], 'c': 1 if w else 2}", True),
        ("return [f([g(x if x else z) for x in y]), w]", True),
        ("return [f([g(x if x else z if w else v) for x in y]), w]", False),
        ("raise E(f'{a if b else c} {d if e else f} {g if h else i}')", False),
        ("a: int = b if c else d if e else f if g else h", False),
        ("a += b if c else d if e else f if g else h", False),
        ("for a in (b if c else d if e else f if g else h): pass", True),
        ("a, b = b, a", True),
        ("a, b = f(c)", True),
        ("a = b = c", True),
        ("a = b, c", True),
        ("a, b = 0, 1", False),
        ("a.b, c[0] = x, y", False),
    ],
)
def test_crowded_statements_are_those_with_three_expressions_in_a_part(statement, clear):
    assert (list(list_dense(ast.walk(ast.parse(statement)))) == []) is clear


def test_a_statement_does_one_thing():
    dense = [f"{file.relative_to(PACKAGE)}:{line}" for file, nodes in list_nodes() for line in list_dense(nodes)]
    assert dense == []
