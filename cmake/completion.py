"""What bash and zsh complete after clogsweep, clogrun and clogfit, from what the programs say of themselves.

    cmake/completion.py FOLDER_OF_PROGRAMS OUTPUT      # OUTPUT/clogsweep for bash, OUTPUT/_clogsweep for zsh

Keys and their words come from `clogsweep --schema`, options from `--help`.
"""

import json
import pathlib
import re
import shlex
import subprocess
import sys

COMMANDS = {"clogsweep": ["status", "verify", "salvage", "replay", "merge", "select", "doctor"], "clogrun": ["array", "channel", "sag", "replay"],
            "clogfit": ["calibrate", "compare", "curve", "deviation", "drag", "report", "units"]}
IN_PYTHON = {"calibrate", "curve", "deviation", "drag", "report"}  # whose modules need not be there yet
POSITIONAL = {"--file", "--system", "--task"}
FILES = {"--config", "--frames", "--lab", "--output", "--picture", "--points", "--programs", "--write-obstacles"}
# Those of an option are the ones that its help names.
WORDS = {"--format": ["text", "csv", "json", "peaks"], "--instruction-set": ["avx512", "avx2", "baseline"], "--isolate": ["yes", "no"],
         "--master-computes": ["auto", "yes", "no"]}
ANY_FILE = "/"  # stands for names of files among words


def asked(folder, program, *words):
    return subprocess.run([str(folder / program), *words], check=not IN_PYTHON & set(words), capture_output=True, text=True).stdout


def options(folder, keys, program, *command):
    """What follows each option of a command, None if nothing does; without keys and positional words."""
    found = {}
    one = re.compile(r"^  (?:(-\w)(?: [A-Z]+)?(?:, | \[ ))?(--[a-z][a-z-]*)(?: \])?(\sarg|\s[A-Z]+)?(.*(?:\n {20}.*)*)", re.MULTILINE)
    for short, name, argument, meaning in one.findall(asked(folder, program, *command, "--help")):
        if name in POSITIONAL or name[2:] in keys:
            continue
        words = [word for word in WORDS.get(name, []) if re.search(rf"\b{word}\b", meaning)] + [ANY_FILE] * (name in FILES)
        found |= {called: " ".join(words) if argument else None for called in (short, name) if called}
    return found


def assigned(table, separator):
    """Lines of an associative array."""
    return "\n".join(f"  {separator.format(shlex.quote(name), shlex.quote(text))}" for name, text in table.items())


def main(programs, output):
    folder, output = pathlib.Path(programs), pathlib.Path(output)
    keys = json.loads(asked(folder, "clogsweep", "--schema"))["keys"]
    names = {key["key"] for key in keys}
    after, arguments = {}, {}
    for program, commands in COMMANDS.items():
        for command in ["", *commands]:
            called = f"{program} {command}".strip()
            found = options(folder, names, *called.split())
            long = sorted(name for name in found if name.startswith("--"))
            after[called] = " ".join(long)
            arguments |= {f"{called} {name}": words for name, words in found.items() if words is not None}
    values = {key["key"]: " ".join([*key["words"], *[ANY_FILE] * (key["kind"] == "file")]) for key in keys}
    meanings = [f"{key['key']}:{re.split('[;:(]', key['help'])[0].strip()}" for key in keys]
    with_keys = [name for name in after if "\nKeys" in asked(folder, *name.split(), "--help")]
    output.mkdir(parents=True, exist_ok=True)
    for name, template, item in (("clogsweep", "completion.bash.in", "[{}]={}"), ("_clogsweep", "completion.zsh.in", "{} {}")):
        text = pathlib.Path(__file__).with_name(template).read_text()
        text = text.replace("@WITH_KEYS@", " ".join(name.replace(" ", ":") for name in with_keys))
        commands = {program: " ".join(words) for program, words in COMMANDS.items()}
        for place, table in (("@OPTIONS@", after), ("@COMMANDS@", commands), ("@ARGUMENTS@", arguments), ("@VALUES@", values)):
            text = text.replace(place, assigned(table, item))
        (output / name).write_text(text.replace("@MEANINGS@", "\n".join(f"  {shlex.quote(meaning)}" for meaning in meanings)))


if __name__ == "__main__":
    main(*sys.argv[1:])
