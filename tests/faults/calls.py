"""Makes valid calls from the programs' own descriptions. Adds mistakes to the calls or to files, and runs the calls."""

import re
import subprocess

from launch import command, quoted, run
from samples import FILE, Sample

NUMBERS = ["0", "-1", "1e308", "-1e308", "5e-324", "1e400", "nan", "NaN", "inf", "-inf", "0x10", "1e", "1,5", "1.5.2",
           "9223372036854775807", "9223372036854775808", "-9223372036854775809", "18446744073709551616", "1e9", "+2",
           "--2", "0.1", "3", "٣"]
LISTS = ["lin(0,1,3)", "lin(0,1,-3)", "lin(0,1,1e9)", "lin(0,1)", "lin(nan,1,3)", "log(0,1,3)", "log(1e-300,1e300,5)",
         "lin(-1e308,1e308,3)", "1..3", "3..1", "1..99999999999", "1..900000,900001..1800000", "..", "1..",
         "-5..5", "1,,2", ",", "1,1", "lin(1,2,2", "lin((1,2),3,4)"]
TEXTS = ["", " ", "auto", "saturated", "dp", "sp", "none", "yes", "=", "a=b", "--", "-", "#", "%", "%s%n", "x" * 300,
         "é", "\t", "a\nb", "\x1b[31mred", "\r", "\x7f", "\u202e", "nowhere.h5", ".", "/dev/null", "/", "~"]
NOT_UTF_8 = [b"\xff\xfe", b"\xc3", b"1\x80", b"\xed\xa0\x80"]
# Settings with which runs take a second. The settings include all values that could make a run long, and mistakes never
# change these values.
SHORT = {"max-time": "0.5", "vertices": "32", "box": "13", "seeds": "1"}
NAMES_OF_FILES = {"output", "frames", "obstacles", "write-obstacles"}
OWN_OPTIONS = re.compile(r"^  --([a-z-]+)( arg)?", re.MULTILINE)
CONTROL = re.compile(rb"[\x00-\x09\x0b-\x1f\x7f]")
PROFILE = "h [mm], v [mm/s], A\n-1,1.1,1\n-0.5,1,1.02\n0,0.5,1.1\n0.5,0.7,1.05\n1,1,1\n"
CIRCLES = "x,y,diameter\n1,1,0.3\n3,1,0.3\n5,7,0.3\n"


def printed(*words):
    return subprocess.run(command(*words), capture_output=True, check=True, text=True).stdout


class Faults:
    def __init__(self, folder):
        config = printed("clogsweep", "--print-config")
        self.keys = dict(line.split(" = ", 1) for line in config.splitlines() if " = " in line and line[0] != "#")
        self.options = {words: self.own_options(*words) for words in
                        [("clogsweep",), ("clogsweep", "status"), ("clogrun",), ("clogfit",), ("clogfit", "drag"),
                         ("clogfit", "deviation")]}
        self.sample = Sample("disks", folder)

    def own_options(self, *words):
        """The options of a command that are not keys. For each, whether it takes a value."""
        return {name: bool(value) for name, value in OWN_OPTIONS.findall(printed(*words, "--help"))
                if name not in self.keys}

    def try_one(self, case):
        self.write_files(case)
        words = case.chance.choice([self.preview, self.preview, self.report, self.droplet, self.measurement])(case)
        words = self.disorder(case, words)
        case.note(quoted(words))
        before = sorted(path.name for path in case.folder.iterdir())
        outcome = run(case, *words)
        if outcome.code == 2:
            self.check_refusal(case, outcome)
            case.expect(sorted(path.name for path in case.folder.iterdir()) == before,
                        f"{outcome.name}: refuses, but writes a file")

    @staticmethod
    def check_refusal(case, outcome):
        """Checks that a refusal is one line without control characters."""
        name = outcome.name
        is_line = outcome.error.count(b"\n") == 1 and outcome.error.endswith(b"\n")
        case.expect(is_line, f"{name}: refuses, but not in one line")
        case.expect(not CONTROL.search(outcome.error), f"{name}: a control character in what it says")

    def write_files(self, case):
        (case.folder / FILE).write_bytes(self.sample.content)
        for name, text in (("s.cfg", self.config_text(case)), ("p.csv", PROFILE), ("o.csv", CIRCLES)):
            content = text.encode()
            (case.folder / name).write_bytes(self.scatter(case, content) if case.chance.random() < 0.5 else content)

    # Valid calls, before mistakes are added

    def preview(self, case):
        """Calls a sweep that only prints its plan or its config."""
        own = self.options[("clogsweep",)]
        return ["clogsweep", *self.some_keys(case, self.keys), *self.some_options(case, own),
                *case.chance.choice([[], ["--config", "s.cfg"]]), case.chance.choice(["--dry-run", "--print-config"])]

    def report(self, case):
        names = ("status", "verify", "replay", "salvage", "merge", "select")
        words = case.chance.choice([["clogfit"], *(["clogsweep", name] for name in names)])
        options = self.options.get(tuple(words), {})
        options = {name: value for name, value in options.items() if name not in ("watch", "follow")}
        task = case.chance.choice(["0", "1", *NUMBERS])
        more = {"replay": [task], "salvage": ["--output", "w.h5"], "merge": [self.file_name(case), "--output", "w.h5"],
                "select": [case.chance.choice(["seed<=1", "status=clogged", "line_tension>1", self.value(case)]), "--output", "w.h5"]}.get(words[-1], [])
        return [*words, self.file_name(case), *more, *self.some_options(case, options)]

    def droplet(self, case):
        """Calls a run that is so short that it ends at once."""
        system = case.chance.choice(["array", "channel", "sag"])
        keys = {name: value for name, value in self.keys.items() if name not in SHORT}
        more = case.chance.choice([[], ["--obstacles", "o.csv"]]) if system == "array" else []
        length = ["--start=-1", "--end=1"] if system == "channel" else []
        options = {name: value for name, value in self.options[("clogrun",)].items() if name not in NAMES_OF_FILES}
        output = [] if system == "sag" else ["--output", "r.h5"]
        return ["clogrun", system, *(f"{name}={value}" for name, value in SHORT.items()), *self.some_keys(case, keys),
                *more, *length, *self.some_options(case, options), *output]

    def measurement(self, case):
        words = case.chance.choice([["clogfit", "drag"], ["clogfit", "deviation"]])
        return [*words, *(case.chance.choices(["p.csv", "o.csv", "nowhere.csv"], k=case.chance.randint(1, 2))),
                *self.some_options(case, self.options[tuple(words)])]

    # Mistakes

    def value(self, case, usual="1"):
        return case.chance.choice([usual, usual, self.misspelt(case, usual),
                                   *map(case.chance.choice, (NUMBERS, LISTS, TEXTS, NOT_UTF_8))])

    def some_keys(self, case, keys):
        chosen = case.chance.sample(sorted(keys), case.chance.randint(0, 4))
        dashes = case.chance.choice(["", "--"])
        return [(dashes + name + "=").encode() + as_bytes(self.value(case, keys[name])) for name in chosen]

    def some_options(self, case, options):
        chosen = case.chance.sample(sorted(options), min(len(options), case.chance.randint(0, 2)))
        return [f"--{name}=".encode() + as_bytes(self.value(case)) if options[name] else f"--{name}"
                for name in chosen]

    def file_name(self, case):
        return case.chance.choice([FILE, FILE, FILE, "s.cfg", *TEXTS, *NOT_UTF_8])

    def config_text(self, case):
        names = case.chance.sample(sorted(self.keys), case.chance.randint(0, 6))
        return "".join(f"{name} = {self.keys[name]}\n" for name in names)

    @staticmethod
    def misspelt(case, word):
        place = case.chance.randrange(len(word) + 1)
        return word[:place] + case.chance.choice("abz0.-=,( ") + word[place + case.chance.randrange(2):]

    def disorder(self, case, words):
        """The words of a call after a mistake: one of them may be left out, repeated or misspelt."""
        program, *words = map(as_bytes, words)
        deed = case.chance.randrange(8)
        if words and deed < 3:
            place = case.chance.randrange(len(words))
            if deed == 0 and not is_limit(words[place]):
                words.pop(place)
            elif deed == 1:
                words.insert(place, case.chance.choice(words))
            elif deed == 2 and not is_limit(words[place]):
                words[place] = self.misspelt(case, words[place].decode("latin-1")).encode("latin-1")
        return [program.decode(), *words]

    @staticmethod
    def scatter(case, content):
        """The bytes of a file, of which a few are replaced, left out or repeated."""
        content = bytearray(content)
        for _ in range(case.chance.randint(1, 8)):
            place = case.chance.randrange(len(content) + 1)
            content[place:place + case.chance.randrange(3)] = case.chance.choice(
                [b"", b",", b"=", b"\n", b"\0", b"#", b"\x1b", b"-", b"e9", as_bytes(case.chance.choice(NUMBERS)),
                 bytes([case.chance.randrange(256)])])
        return bytes(content)


def as_bytes(word):
    return word if isinstance(word, bytes) else word.encode()


def is_limit(word):
    """Whether the word keeps a call short. Mistakes must not remove or change such words."""
    return word in (b"--dry-run", b"--print-config") or word.split(b"=")[0].decode("latin-1") in SHORT
