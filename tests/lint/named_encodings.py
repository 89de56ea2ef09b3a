"""Checks that the Python package names an encoding wherever it reads or writes text. Otherwise the locale would choose
the encoding, and a page with `charset=utf-8` might have another encoding.

    tests/lint/named_encodings.py ROOT
"""

import ast
import pathlib
import sys

METHODS = {"read_text", "write_text", "loadtxt", "savetxt"}
PROCESSES = {"Popen", "run", "check_output"}


def is_unnamed(call):
    """Whether this call reads or writes text without naming an encoding."""
    given = {word.arg: word.value for word in call.keywords}
    if "encoding" in given:
        return False
    if isinstance(call.func, ast.Attribute):
        is_process = isinstance(call.func.value, ast.Name) and call.func.value.id == "subprocess" and call.func.attr in PROCESSES
        return call.func.attr in METHODS or is_process and bool({"text", "universal_newlines", "errors"} & set(given))
    mode = given.get("mode") or (call.args[1] if len(call.args) > 1 else ast.Constant("r"))
    return isinstance(call.func, ast.Name) and call.func.id == "open" and not (isinstance(mode, ast.Constant) and "b" in mode.value)


root = pathlib.Path(sys.argv[1])
found = [f"{path.relative_to(root)}:{node.lineno}: name the encoding" for path in sorted((root / "analysis" / "clogsweep").rglob("*.py"))
         for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call) and is_unnamed(node)]
print("\n".join(found) or "every encoding is named")
sys.exit(bool(found))
