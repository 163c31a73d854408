"""Runs IEC 61131-3 function blocks from blark's tree: enough of the language for what thermfit exports.

A function block becomes a Python class with one attribute a variable and `__call__` for one cycle. What a compiler
would refuse is an error here too: undeclared names, and a value of another type than the variable's. `after_power_cycle`
makes an instance that has kept VAR RETAIN and nothing else.
"""

import math

import numpy

from blark import transform as tree
from blark.parse import parse_source_code

OPERATORS = {"AND": "and", "OR": "or", "=": "==", "<>": "!="}


def quotient(a, b):
    """Of whole numbers it is whole."""
    return a // b if type(a) is int and type(b) is int else a / b


FUNCTIONS = {"UDINT_TO_LREAL": float, "UDINT_TO_REAL": numpy.float32}
FUNCTIONS["SQRT"] = lambda x: numpy.sqrt(x) if isinstance(x, numpy.float32) else math.sqrt(x)
TYPES = {"BOOL": bool, "UDINT": int, "LREAL": float, "REAL": numpy.float32}


class FunctionBlock:
    """Writes one function block as Python text."""

    def __init__(self, block, known_blocks):
        self.types, self.lines, self.known, self.retained = {}, [], known_blocks, []
        initial = []
        for section in block.declarations:
            for item in section.items:
                type_name = str(item.init.spec.type).upper()
                for variable in item.variables:
                    name = str(variable.variable.name).lower()
                    if name in self.types:
                        raise SyntaxError("declared twice: " + name)
                    self.types[name] = type_name
                    if "RETAIN" in str(getattr(section, "attrs", "")).upper():
                        self.retained.append(name)
                    value = "known[%r]()" % type_name.lower() if type_name.lower() in known_blocks else None
                    initial.append((name, value or self.expression(item.init.value)))
        self.real = "REAL" if "REAL" in self.types.values() else "LREAL"
        for name, value in initial:
            self.lines.append("    self.%s = %s" % (name, value))
        start = ["def initialise(self):"] + self.lines
        self.lines = ["def cycle(self):"]
        self.statements(block.body.statements, 1)
        scope = {"quotient": quotient, "known": known_blocks, "assign": self.assign, "real": lambda text: TYPES[self.real](text)}
        scope.update(FUNCTIONS)
        exec("\n".join(start + self.lines), scope)

        def call(instance, **inputs):
            for name, value in inputs.items():
                self.assign(instance, name.lower(), value)
            scope["cycle"](instance)

        self.made = type(str(block.name), (), {"__init__": scope["initialise"], "__call__": call,
                                               "retained": self.retained, "set": self.assign})

    def assign(self, instance, name, value):
        if type(value) is not TYPES[self.types[name]]:
            raise TypeError("%s is %s, not %s" % (name, self.types[name], type(value)))
        if type(value) is int and not 0 <= value < 2**32:
            raise OverflowError("%s := %d" % (name, value))
        setattr(instance, name, value)

    def name(self, variable):
        name = str(variable.name).lower()
        if name not in self.types:
            raise NameError("not declared: " + name)
        if isinstance(variable, tree.MultiElementVariable):
            return "self.%s.%s" % (name, ".".join(str(e.field.name).lower() for e in variable.elements))
        return "self." + name

    def expression(self, node):
        if isinstance(node, tree.Boolean):
            return "True" if str(node.value).upper() == "TRUE" else "False"
        if isinstance(node, tree.Integer):
            return str(node.value)
        if isinstance(node, tree.Real):
            return "real(%r)" % str(node.value)
        if isinstance(node, tree.ParenthesizedExpression):
            return "(%s)" % self.expression(node.expr)
        if isinstance(node, tree.UnaryOperation):
            return "(%s %s)" % ("not" if str(node.op).upper() == "NOT" else str(node.op), self.expression(node.expr))
        if isinstance(node, tree.BinaryOperation):
            operator = str(node.op).upper()
            if operator == "/":
                return "quotient(%s, %s)" % (self.expression(node.left), self.expression(node.right))
            kind = "bool" if operator[0] in "=<>" else ""  # numpy has a type of its own for it
            return "%s(%s %s %s)" % (kind, self.expression(node.left), OPERATORS.get(operator, operator),
                                     self.expression(node.right))
        if isinstance(node, tree.FunctionCall):
            return "%s(%s)" % (str(node.name.name).upper(), ", ".join(self.expression(p.value) for p in node.parameters))
        if isinstance(node, (tree.SimpleVariable, tree.MultiElementVariable)):
            return self.name(node)
        raise NotImplementedError(type(node).__name__)

    def statements(self, nodes, depth):
        nodes = nodes.statements if isinstance(nodes, tree.StatementList) else nodes or []
        out = lambda text, extra=0: self.lines.append("    " * (depth + extra) + text)
        out("pass")
        for node in nodes:
            if isinstance(node, tree.AssignmentStatement):
                out("assign(self, %r, %s)" % (self.name(node.variables[0])[5:], self.expression(node.expression)))
            elif isinstance(node, tree.IfStatement):
                out("if %s:" % self.expression(node.if_expression))
                self.statements(node.statements, depth + 1)
                for branch in node.else_ifs:
                    out("elif %s:" % self.expression(branch.if_expression))
                    self.statements(branch.statements, depth + 1)
                if node.else_clause:
                    out("else:")
                    self.statements(node.else_clause.statements, depth + 1)
            elif isinstance(node, tree.WhileStatement):
                out("while %s:" % self.expression(node.expression))
                self.statements(node.statements, depth + 1)
            elif isinstance(node, tree.CaseStatement):
                out("case = " + self.expression(node.expression))
                for i, case in enumerate(node.cases):
                    out("%s case in (%s,):" % ("elif" if i else "if", ", ".join(map(self.expression, case.matches))))
                    self.statements(case.statements, depth + 1)
                out("else:")
                self.statements(node.else_clause.statements, depth + 1)
            elif isinstance(node, tree.FunctionCallStatement):
                arguments = ("%s=%s" % (p.name.name, self.expression(p.value)) for p in node.parameters)
                out("%s(%s)" % (self.name(node.name), ", ".join(arguments)))
            else:
                raise NotImplementedError(type(node).__name__)


def after_power_cycle(instance):
    """A new instance of the same block that knows what the old one retained, and the blocks inside it too."""
    new = type(instance)()
    for name, value in vars(instance).items():
        if name in instance.retained:
            setattr(new, name, value)
        elif hasattr(value, "retained"):
            setattr(new, name, after_power_cycle(value))
    return new


def load(text, known_blocks=()):
    """The function blocks of `text` and those known before, by lower-case name, as classes."""
    parsed = parse_source_code(text)
    if parsed.exception:
        raise parsed.exception
    blocks = dict(known_blocks)
    for block in parsed.transform().items:
        blocks[str(block.name).lower()] = FunctionBlock(block, blocks).made
    return blocks
