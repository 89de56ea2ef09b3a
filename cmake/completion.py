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

COMMANDS = {"clogsweep": ["status", "verify", "salvage", "replay", "doctor"], "clogrun": ["array", "channel", "sag", "replay"],
            "clogfit": ["calibrate", "deviation", "drag", "report"]}
POSITIONAL = {"--file", "--system", "--task"}


def asked(folder, program, *words):
    # The report is a script, whose modules need not be there yet.
    return subprocess.run([str(folder / program), *words], check="report" not in words, capture_output=True, text=True).stdout


def options(folder, keys, program, *command):
    """The long ones of a command, without keys and without those that words without dashes stand for."""
    named = re.findall(r"^  (?:-\w(?: [A-Z]+)?(?:, | \[ ))?--([a-z][a-z-]*)", asked(folder, program, *command, "--help"), re.MULTILINE)
    return " ".join(sorted({f"--{name}" for name in named} - {f"--{key}" for key in keys} - POSITIONAL))


def assigned(table, separator):
    """Lines of an associative array."""
    return "\n".join(f"  {separator.format(shlex.quote(name), shlex.quote(text))}" for name, text in table.items())


def main(programs, output):
    folder, output = pathlib.Path(programs), pathlib.Path(output)
    keys = json.loads(asked(folder, "clogsweep", "--schema"))["keys"]
    names = [key["key"] for key in keys]
    after = {}
    for program, commands in COMMANDS.items():
        after |= {f"{program} {command}": options(folder, names, program, command) for command in commands}
        after[program] = " ".join([*commands, options(folder, names, program)])
    values = {key["key"]: " ".join(key["words"]) for key in keys}
    meanings = [f"{key['key']}:{re.split('[;:(]', key['help'])[0].strip()}" for key in keys]
    with_keys = [name for name in after if "\nKeys" in asked(folder, *name.split(), "--help")]
    output.mkdir(parents=True, exist_ok=True)
    for name, template, item in (("clogsweep", "completion.bash.in", "[{}]={}"), ("_clogsweep", "completion.zsh.in", "{} {}")):
        text = pathlib.Path(__file__).with_name(template).read_text()
        text = text.replace("@WITH_KEYS@", " ".join(name.replace(" ", ":") for name in with_keys))
        text = text.replace("@OPTIONS@", assigned(after, item)).replace("@VALUES@", assigned(values, item))
        (output / name).write_text(text.replace("@MEANINGS@", "\n".join(f"  {shlex.quote(meaning)}" for meaning in meanings)))


if __name__ == "__main__":
    main(*sys.argv[1:])
