#!/usr/bin/env python3
"""Checks the spelling of prose with aspell: *.md, comments, docstrings, and messages of programs. The spelling is
British, with -ise.

Correct words that aspell does not know are in words.txt. Words that look like code are excluded. Such words are
`quoted`, are in CamelCase or CAPITALS, or contain digits, underscores, slashes or equals signs.
"""

import ast
import io
import re
import subprocess
import sys
import tokenize

import known

WORDS = known.ROOT / "tests/gates/words.txt"
CPP = re.compile(r'''//(?P<line>[^\n]*)|/\*(?P<block>.*?)\*/|R"\((?P<raw>.*?)\)"|"(?P<text>(?:\\.|[^"\\\n])*)"|'''
                 r"""(?<![0-9A-Za-z])'(?:\\.|[^'\\\n])+'""", re.DOTALL)
CODE = re.compile(r"\b(?:upper|lower) center\b|`[^`]*`|\]\([^)]*\)|https?://\S+|@param\s+\S+|@\w+|<[^>\s]*>|\{[^}\s]*\}|(?<!\w)--?\w[\w-]*|"
                  r"\S*[_:=/%^]\S+|\S*[^\W\d_]\(\S*|\S*\w\.(?:py|h5|csv|cpp|hpp|md|cfg|sh|txt|png|mp4|html|journal)\b|\S*\d\S*")
WORD = re.compile(r"[^\W\d_]+(?:'[^\W\d_]+)*")


def of_markdown(text):
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        fenced ^= line.lstrip().startswith("```")
        if not fenced and not line.startswith("    "):
            yield number, re.sub(r"\\[A-Za-z]+", " ", line)  # commands of a formula are no words


def of_cpp(text, with_messages):
    for found in CPP.finditer(text):
        comment = found["line"] or found["block"]
        message = found["text"] or found["raw"]
        prose = comment or (message if with_messages and message and " " in message.strip() else "")
        first = text.count("\n", 0, found.start()) + 1
        escape = r"\\\w+" if found["raw"] else r"\\."  # commands of a formula, or line breaks
        for number, line in enumerate(prose.splitlines(), first):
            yield number, re.sub(escape, " ", line)


def of_python(text, with_messages):
    docstrings = {node.body[0].value.lineno for node in ast.walk(ast.parse(text))
                  if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node)}
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        number = token.start[0]
        is_message = with_messages and " " in token.string.strip() and not re.search(r"[<;]|\\math", token.string)
        if token.type == tokenize.COMMENT or token.type == tokenize.STRING and (number in docstrings or is_message):
            escape = r"\\\w+" if token.string.startswith("r") else r"\\."
            yield from enumerate((re.sub(escape, " ", line) for line in token.string.splitlines()), number)


def of_script(text):
    for number, line in enumerate(text.splitlines(), 1):
        comment = re.search(r"(?:^|\s)#(.*)", line)
        if comment:
            yield number, comment[1]


def prose(name):
    """The lines of prose in a file, with their numbers. Messages in tests are excluded, because tests quote mistakes of
    users."""
    text = (known.ROOT / name).read_text()
    with_messages = not name.startswith("tests/")
    if name.endswith(".md"):
        return of_markdown(text)
    if name.endswith((".cpp", ".hpp")):
        return of_cpp(text, with_messages)
    if name.endswith(".py"):
        return of_python(text, with_messages)
    return of_script(text)


def words_of(line):
    for word in WORD.findall(CODE.sub(" ", line)):
        word = word.removesuffix("'s")
        if len(word) > 1 and not re.search("[A-Z]{2}|[a-z][A-Z]", word):
            yield word


def main():
    names = known.files("*.md", "*.cpp", "*.hpp", "*.py", "*.sh", "*.cmake", "*CMakeLists.txt", "*.cfg", "*.cff",
                        ".ci/run", ".clang-tidy", ".clang-format")
    places = {}
    for name in names:
        for number, line in prose(name):
            for word in words_of(line):
                places.setdefault(word, []).append(f"{name}:{number}")
    asked = subprocess.run(["aspell", "list", "--lang=en_GB-ise", "--encoding=utf-8", "--ignore-case"],
                           input="\n".join(places), capture_output=True, text=True)
    if asked.returncode != 0 or asked.stderr:
        sys.exit(f"aspell does not work: {asked.stderr.strip()}")
    own = {word.lower() for word in WORDS.read_text().split()}
    doubted = set(asked.stdout.split())
    wrong = sorted(word for word in doubted if word.lower() not in own)
    for word in wrong:
        print(f"{places[word][0]}: {word}" + (f" (and {len(places[word]) - 1} more)" if len(places[word]) > 1 else ""))
    idle = own - {word.lower() for word in doubted}
    if idle:
        print("words.txt has words that nobody uses or that aspell knows: " + " ".join(sorted(idle)))
    if wrong or idle:
        sys.exit("mend the spelling, or add the words to tests/gates/words.txt if they are right")
    print(f"{len(places)} words in {len(names)} files are spelt well")


if __name__ == "__main__":
    main()
