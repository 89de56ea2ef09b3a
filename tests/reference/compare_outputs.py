#!/usr/bin/python3
"""Compares the outputs and the written files of two builds for the commands of the handbook.

    compare_outputs.py BEFORE AFTER [--trees TREE TREE] [--only WORD]     (folders of the programs; source trees)

The pages are README.md and those of docs/tutorial, docs/how-to and docs/reference. The pages of slow_tutorial are run
block by block. The commands of the other pages are shortened and run one by one, as in slow_pages. Outputs, exit codes
and written files are compared. Times, speeds, hosts, dates and temporary folders are masked.

--trees names the source trees whose Python modules are used with BEFORE and AFTER. By default both use this tree. Pages
and test suites come from the second tree. Exit code 1: something differs. The comparison needs about ten minutes for
each build on an idle machine.
"""

import argparse
import difflib
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile

LIMIT = 240  # Limit in seconds. On a busy machine, a command that usually takes a minute can take this long.
UNITS = "steps/s|s|ms|us|min|minutes?|hours?|h|days?|seconds?|core-hours?|core-seconds|ranks? s|kB|MB|GB|MiB|GiB"
MASKS = [(r"[\d.,e+-]+ (runs/min|ns per vertex-step|runs per minute)", r"SOME \1"),
         (r"/tmp/[\w./-]*", "TMP"), (r"\d{4}-\d\d-\d\d([T ]\d\d:\d\d(:\d\d)?(\.\d+)?Z?( UTC)?)?", "DATE"), (r"\d?\d:\d\d(:\d\d)?", "TIME"),
         (re.escape(socket.gethostname()), "HOST"), (r"\b[0-9a-f]{40}\b", "HASH"), (r"-g[0-9a-f]{7,}(-dirty)?", "-gHASH"),
         (rf"(?<![\w.])[\d.,]+(e[+-]?\d+)?( ?\.\. ?[\d.]+)? ?({UNITS})(?![\w/])", "SOME_TIME"),
         (r"('|\")?(wall_seconds|processor_seconds|seconds|busy|idle_seconds|tail_seconds|stretch)\1: ?[\d.e+\-\[\], ]+", r"\2: SOME")]


PROGRESS = re.compile(r"^\d+/\d+ done, .* left$", re.MULTILINE)


def masked(text):
    text = PROGRESS.sub("", text.replace("\r", "\n"))
    for pattern, word in MASKS:
        text = re.sub(pattern, word, text)
    return re.sub(r"\n+", "\n", re.sub(r"  +", "  ", text))


def digest(path):
    """@return lines that describe the content of a file"""
    import compare_rows
    import numpy as np
    from PIL import Image
    try:
        if path.suffix == ".h5":
            return [f"{name} {hash_of(value)}" for name, value in sorted(compare_rows.contents(path).items())]
        if path.suffix == ".png":
            pixels = np.asarray(Image.open(path))
            return [f"{pixels.shape} {hash_of(pixels.tobytes())}"]
        if path.suffix in (".csv", ".json", ".cfg", ".txt", ".html", ".md", ".svg", ".tex"):
            text = path.read_text(errors="replace")
            return re.sub(r"data:image/[^\"')]*", "PICTURE", masked(text)).splitlines()
    except (OSError, KeyError) as error:
        return [f"unreadable: {error}"]
    return ["present"]


def hash_of(value):
    import hashlib
    return hashlib.sha256(value if isinstance(value, bytes) else repr(value).encode()).hexdigest()[:12]


class Recorder:
    def __init__(self, folder):
        self.folder, self.outputs, self.seen = folder, {}, {}

    def states(self):
        return {path: path.stat().st_mtime_ns for path in sorted(self.folder().rglob("*")) if path.is_file()}

    def call(self, name, run):
        """Records a call. @param run  makes the call, and returns a CompletedProcess, or nothing if there is nothing to
        compare"""
        before = self.states()
        try:
            done = run()
        except subprocess.TimeoutExpired:
            done = subprocess.CompletedProcess(name, "", "took too long, not compared", "")
        texts = [f"exit code {done.returncode}", *masked(done.stdout or "").splitlines(), *masked(done.stderr or "").splitlines()]
        files = [(path, "") for path, changed in self.states().items() if before.get(path) != changed and path.name not in ("stdout.txt", "stderr.txt")]
        for path, _ in files:
            texts += [f"{path.relative_to(self.folder())}: {line}" for line in digest(path)]
        while name in self.outputs:
            name += " again"
        self.outputs[name] = texts
        return done


def record(folder, tree, pages_tree, only, output):
    # The programs look for the Python module beside their folder, so a link to the module is made there.
    own = tempfile.TemporaryDirectory(prefix="clog_programs_")
    programs = pathlib.Path(own.name) / "bin"
    shutil.copytree(folder, programs)
    modules = programs.parent / "lib/python3/dist-packages"
    modules.mkdir(parents=True)
    (modules / "clogsweep").symlink_to(tree / "analysis/clogsweep")
    os.environ["CLOG_BIN"] = str(programs)
    sys.path[:0] = [str(pages_tree / "analysis"), str(pages_tree / "tests/programs"), str(pages_tree / "tests/reference")]
    import pages
    import slow_pages
    import support

    support.LONGEST = LIMIT

    def environment():
        folders = [str(programs), os.path.dirname(sys.executable), os.environ["PATH"]]
        return {**os.environ, "PATH": ":".join(folders), "PYTHONPATH": str(tree / "analysis")}

    outputs = {}
    kept = tempfile.TemporaryDirectory(prefix="clog_outputs_")
    tutorial = pages.tutorial()
    for page in [*tutorial, *(page for page in pages.PAGES)]:
        if only and only not in page:
            continue
        place = pathlib.Path(kept.name) / ("tutorial" if page in tutorial else page.replace("/", "_"))
        place.mkdir(exist_ok=True)
        recorder = Recorder(lambda: place)  # noqa: B023
        for index, (language, block) in enumerate(pages.blocks(page)):
            if language == "text":
                continue
            command = ["bash", "-c", pages.BEFORE + block] if language == "bash" else [sys.executable, "-c", block]
            recorder.call(f"{page} block {index}: {block.splitlines()[0]}",
                          lambda: subprocess.run(command, cwd=place, env=environment(), stdin=subprocess.DEVNULL, capture_output=True,  # noqa: B023
                                                 text=True, timeout=LIMIT))
        outputs.update(recorder.outputs)
        print(f"{folder}: {page}", file=sys.stderr, flush=True)

    class Commands(slow_pages.Commands):
        recorder = None

        def run_program(self, name, *arguments, **options):
            def run():
                return super(Commands, self).run_program(name, *arguments, **options)

            return self.recorder.call(f"{self.page}: {name} {' '.join(map(str, arguments))}",
                                      run) if self.recorder else run()

        def analyse(self, command, *arguments):
            def run():
                return subprocess.run([sys.executable, "-m", "clogsweep", command, *map(str, arguments)], cwd=self.folder,
                                      env=environment(), capture_output=True, text=True, timeout=LIMIT)
            return self.recorder.call(f"{self.page}: python3 -m clogsweep {command} {' '.join(map(str, arguments))}", run)

        def check(self, words):
            try:
                super().check(words)
            except AssertionError as error:
                self.recorder.outputs[f"{self.page}: {' '.join(words)} (assertion)"] = [masked(str(error))[:500]]

        def runTest(self):
            self.prepared = self.folder
            for self.page in slow_pages.PAGES:
                if "docs/how-to" not in self.page and "docs/reference" not in self.page or only and only not in self.page:
                    continue
                with tempfile.TemporaryDirectory(prefix="clog_page_") as name:
                    self.folder = pathlib.Path(name)
                    slow_pages.shutil.copytree(self.prepared, self.folder, dirs_exist_ok=True)
                    self.recorder = Recorder(lambda: self.folder)
                    for words in pages.commands(self.page):
                        if own := slow_pages.own_program(words):
                            self.check(own)
                    outputs.update(self.recorder.outputs)
                    self.recorder = None
                print(f"{folder}: {self.page}", file=sys.stderr, flush=True)
            self.folder = self.prepared

    case = Commands()
    case.setUp()
    try:
        case.runTest()
    finally:
        case.doCleanups()
    output.write_text(json.dumps(outputs))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    parser.add_argument("--trees", type=pathlib.Path, nargs=2,
                        default=[pathlib.Path(__file__).resolve().parents[2]] * 2)
    parser.add_argument("--only", default="", help="pages with this in their path")
    parser.add_argument("--record", type=pathlib.Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    trees = [tree.resolve() for tree in arguments.trees]
    if arguments.record:
        record(arguments.before.resolve(), trees[0], trees[1], arguments.only, arguments.record)
        return 0
    found = []
    with tempfile.TemporaryDirectory() as place:
        for index, programs in enumerate((arguments.before, arguments.after)):
            path = pathlib.Path(place) / f"{index}.json"
            subprocess.run([sys.executable, __file__, programs, programs, "--trees", trees[index], trees[1], "--only", arguments.only,
                            "--record", path], check=True)
            found.append(json.loads(path.read_text()))
    before, after = found
    num_differing = 0
    for name in {**before, **after}:
        one, two = before.get(name, ["not run"]), after.get(name, ["not run"])
        if one != two and sorted(one) != sorted(two):  # The order in which ranks report may differ.
            num_differing += 1
            print(f"## {name}")
            print("\n".join(line[:300] for line in difflib.unified_diff(one, two, "BEFORE", "AFTER", lineterm="", n=0)))
    print(f"{len({**before, **after})} commands, {num_differing} differ")
    return 1 if num_differing else 0


if __name__ == "__main__":
    sys.exit(main())
