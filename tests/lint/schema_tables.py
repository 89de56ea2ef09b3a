"""Checks that the lists of keys and columns in the documentation agree with clogsweep --schema.

    tests/lint/schema_tables.py build/release/bin/clogsweep .            # exit code 1: a list is out of date
    tests/lint/schema_tables.py build/release/bin/clogsweep . --write    # updates the lists
"""

import json
import pathlib
import re
import subprocess
import sys
import textwrap

BEGIN, END = "<!-- {} of clogsweep --schema, by tests/lint/schema_tables.py -->", "<!-- end of {} -->"


def values_of(key):
    """The default of a key, followed by its other values."""
    words = [f"`{word}`" for word in key["words"] if word != key["default"]]
    if key["kind"] != "word":
        numbers = {"text": "a description, as of `--lab`", "file": "a file's name"}.get(key["kind"], key.get("range") or "any number")
        words = [*words, numbers + (", or a share such as `50%`" if key["kind"] == "number or share" else "")]
    return f"`{key['default']}`; {', '.join(words)}"


def definition(term, meaning):
    """An entry of a definition list."""
    yield term
    yield from textwrap.wrap(meaning, 120, initial_indent=": ", subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
    yield ""


def keys(schema):
    for key in schema["keys"]:
        scope = "" if key["scope"] == "all" else f" ({key['scope']})"
        yield from definition(f"`{key['key']}` ({values_of(key)})", key["help"] + scope)


def type_of(column):
    return {"number": "", "integer": " int64", "word": f" text {column['size']}"}[column["kind"]]


def columns(schema):
    """The list of columns. One paragraph names all columns that have the name and the value of a key. Each other column
    has an entry. Columns with meanings that differ only in numbers share an entry."""
    key_of = {(key.get("column"), key.get("meaning")): key["key"] for key in schema["keys"]}
    named, rows = [], {}
    for column in schema["columns"]:
        name = f"`{column['name']}`{type_of(column)}"
        key = key_of.get((column["name"], column["meaning"]))
        if key and key.replace("-", "_") == column["name"]:
            named.append(name)
            continue
        meaning = f"key `{key}`" if key else column["meaning"]
        meaning += f" [{column['unit']}]" if column["unit"] else ""
        names, _ = rows.setdefault(re.sub(r"\d+", "", meaning), ([], meaning))
        names.append(name)
    yield from textwrap.wrap("These columns have the name (with `_` for `-`), the value and the unit of a [key](keys.md): " + ", ".join(named) + ".", 120)
    yield ""
    for (name, *others), meaning in rows.values():
        yield from definition(name, meaning + ("; likewise " if others else "") + ", ".join(others))


TABLES = [("docs/reference/keys.md", "keys", keys), ("docs/reference/files.md", "columns", columns)]


def updated(text, name, lines):
    begin, end = BEGIN.format(name), END.format(name)
    before, _, rest = text.partition(begin)
    _, found, after = rest.partition(end)
    if not found:
        sys.exit(f"no place for the list of {name}: it stands between '{begin}' and '{end}'")
    return "\n".join([before + begin, "", *lines, "", end + after])


def main(program, root, *options):
    schema = json.loads(subprocess.run([program, "--schema"], check=True, capture_output=True, text=True).stdout)
    stale = []
    for path, name, lines in TABLES:
        place = pathlib.Path(root) / path
        text = place.read_text()
        new = updated(text, name, lines(schema))
        if new == text:
            continue
        stale.append(f"{path}: its list of {name} is stale; update it with {sys.argv[0]} {program} {root} --write")
        if "--write" in options:
            place.write_text(new)
    print("\n".join(stale) or "lists are as the schema")
    return bool(stale) and "--write" not in options


sys.exit(main(*sys.argv[1:]))
