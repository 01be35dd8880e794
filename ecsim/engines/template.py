"""The meaning of an instruction as text: what a decorated function says, ready to be written into generated code.

An instruction's function is read once. A body that is a single `return` becomes an expression, the body of an `always`
instruction a block of statements; parameters and attributes of units become fields in braces: {s1}, {timer_value}.
A longer function of another form is called instead.
"""

import ast
import builtins
import inspect
import re
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache


@dataclass(frozen=True)
class Template:
    """`text` with fields in braces; `expression` tells whether it is one, None text that the function must be called."""

    text: str | None
    expression: bool
    passes: bool = False  # the result is its one operand, untouched
    uses: dict[str, int] = field(default_factory=dict)  # field -> how often it stands there
    globals: dict[str, object] = field(default_factory=dict)
    returns: bool = False
    relation: str | None = None  # what stands between two parameters that are compared

    def fill(self, fields: dict[str, str]) -> str:
        """The text with every field replaced."""
        return _FIELD.sub(lambda match: fields[match[1]], self.text)


_FIELD = re.compile(r"__(\w+?)__")
_RELATION = re.compile(r"__\w+?__ ([=!<>]+) __\w+?__")


class _Fields(ast.NodeTransformer):
    def __init__(self, function: Callable, parameters: list[str]):
        self.function, self.parameters = function, parameters
        self.globals: dict[str, object] = {}
        self.stored: set[str] = set()

    def visit_Name(self, node):
        if node.id in self.parameters:
            return ast.Name(f"__{node.id}__", node.ctx)
        if isinstance(node.ctx, ast.Store):
            self.stored.add(node.id)
        elif node.id not in self.stored and not hasattr(builtins, node.id):
            name = f"{self.function.__module__.rpartition('.')[2]}_{node.id}"
            self.globals[name] = self.function.__globals__[node.id]
            return ast.Name(name, node.ctx)
        return node

    def visit_Attribute(self, node):
        if isinstance(node.value, ast.Name) and node.value.id in self.parameters:
            return ast.Name(f"__{node.value.id}_{node.attr}__", node.ctx)
        return self.generic_visit(node)

    def visit_Call(self, node):
        """A method of a unit becomes a function that gets the unit's number first: `timer.tick()` -> `tick(n)`."""
        if isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Name) and node.func.value.id in self.parameters:
            number = ast.Name(f"__{node.func.value.id}_number__", ast.Load())
            return ast.Call(ast.Name(node.func.attr, ast.Load()), [number, *(self.visit(a) for a in node.args)], [])
        return self.generic_visit(node)

    def visit_Return(self, node):
        return ast.Assign([ast.Name("__flow__", ast.Store())], self.visit(node.value), lineno=0)


@cache
def template(function: Callable, form: str) -> Template:
    """The template of an instruction's function."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    parameters = [argument.arg for argument in tree.args.args]
    body = tree.body[1:] if ast.get_docstring(tree) else tree.body
    single = len(body) == 1 and isinstance(body[0], ast.Return)
    fields = _Fields(function, parameters)
    if single and not tree.args.vararg:
        expression = body[0].value
        passes = isinstance(expression, ast.Name)
        text = ast.unparse(ast.fix_missing_locations(fields.visit(expression)))
        relation = _RELATION.fullmatch(text)
        return Template(text, True, passes, _count(text), fields.globals, relation=relation and relation[1])
    if form != "always":
        return Template(None, False)
    returns = isinstance(body[-1], ast.Return)
    module = ast.Module([fields.visit(statement) for statement in body], [])
    text = ast.unparse(ast.fix_missing_locations(module))
    return Template(text, False, False, _count(text), fields.globals, returns)


def _count(text: str) -> dict[str, int]:
    counts: dict[str, int] = {}
    for name in _FIELD.findall(text):
        counts[name] = counts.get(name, 0) + 1
    return counts
