"""Puts values and seeds of a sweep where its curve needs them, and runs clogsweep round by round.

    python3 -m clogsweep refine line-tension --config sweep.cfg --output sweep.h5 line-tension=0.03,3 seeds=1..4 \\
        --until curve=20% -- mpirun -np 2
    python3 -m clogsweep refine line-tension,friction --config sweep.cfg --output sweep.h5 --budget 10h -- srun
    python3 -m clogsweep refine lattice-angle --config lattice.cfg --output lattice.h5 --until critical-angle=0.5

The words after -- start clogsweep; without them it runs on one core. Each round's points are stored beside the output
(OUTPUT.refine-*.csv) before it starts. The same command resumes a stopped search; exit codes are those of clogsweep.
"""

import hashlib
import json
import math
import pathlib
import re
import sys
import tempfile
from collections.abc import Sequence

from ..reading import programs, stored
from ..refinement import critical_angle, curve_search, goals, rounds, settings
from ..refinement.driver import Launcher, Limits, Search, refine
from ..refinement.membership import Membership, Resolved, Values, resolved_tasks
from ..tools.errors import ProgramFailed, UserError
from . import command_line

PASSED_ON = ("lab", "attempts", "isolate", "report-seconds", "master-computes", "instruction-set")
BLOCKS_OF_A_VALUE = 50  # most blocks of seeds, without --most-seeds


def parse() -> tuple[command_line.argparse.Namespace, list[str]]:
    """The options, and the launcher's words."""
    words = sys.argv[1:]
    end = words.index("--") if "--" in words else len(words)
    parser = command_line.Parser(__doc__)
    parser.add_argument("refined", metavar="KEY[,KEY]", help="one key, or two with a comma between; their lists give the bounds")
    parser.add_argument("settings", type=command_line.key_and_value, nargs="*", metavar="KEY=VALUES", help="of clogsweep")
    parser.add_argument("--config", help="file with lines `key = value`")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="HDF5 file to create, to resume or to add to")
    parser.add_argument("--until", help="curve=20%%, peak=10%%, crossing=10:5%% or, for a lattice, critical-angle=0.5")
    parser.add_argument("--budget", help="core-hours that all runs may take, e.g. 10h")
    parser.add_argument("--max-hours", type=command_line.between(0, 1e9, "hours"), default=1e9,
                        help="stop after so many hours, as after a signal")
    parser.add_argument("--most-seeds", type=command_line.whole(1), help="largest number of seeds of a value (50 times `seeds`)")
    parser.add_argument("--same-seeds", action="store_true", help="all values have the same seeds, not seeds of their own")
    parser.add_argument("--dry-run", action="store_true", help="print the first round and its cost, run nothing")
    for name in PASSED_ON:
        parser.add_argument(f"--{name}", help="as for clogsweep")
    for name in ("verbose", "quiet"):
        parser.add_argument(f"--{name}", action="store_true", help="as for clogsweep")
    programs.add_option(parser)
    return parser.parse_intermixed_args(words[:end]), words[end + 1:]


def made_search(arguments: command_line.argparse.Namespace, keys: list[str], config: settings.Config) -> Search:
    """@throws UserError"""
    if not (arguments.until or arguments.budget):
        raise UserError("refine needs an end; try --until curve=20%, or --budget 10h")
    budget = goals.parse_budget(arguments.budget) if arguments.budget else math.inf
    goal = goals.parse_goal(arguments.until) if arguments.until else goals.Goal("")
    lists = [settings.numbers(config[key]) for key in keys]
    if critical_angle.KEY in keys:
        if len(keys) > 1 or goal.kind not in ("", "critical-angle"):
            raise UserError(f"cannot refine {','.join(keys)} until {goal or 'the budget is used up'} (lattice-angle is refined alone, "
                            "for the critical angle) try --until critical-angle=0.5")
        if arguments.same_seeds or arguments.most_seeds is not None:
            raise UserError("invalid --same-seeds or --most-seeds (each angle gets the seeds of `seeds`); leave them out")
        if config["obstacle-layout"] != "lattice":
            raise UserError("cannot refine lattice-angle (there is no lattice) try obstacle-layout=lattice")
        critical_angle.require_angles(config[critical_angle.KEY], lists[0])
        spacing = float(config["obstacle-gap"]) + float(config["obstacle-diameter"])
        return critical_angle.AngleSearch(lists[0], goal.precision, budget, spacing, float(config["box"]),
                                          len(settings.numbers(config["seeds"])))
    if goal.kind == "critical-angle":
        raise UserError(f"invalid --until={arguments.until} (is found over the angle of a lattice) try refine lattice-angle")
    if goal.kind == "crossing" and len(keys) > 1:
        raise UserError(f"invalid --until={arguments.until} (with two keys lambda crosses it along a line) give one key")
    seeds = settings.seed_block(config["seeds"])
    for key, given in zip(keys, lists, strict=True):
        curve_search.require_bounds(key, config[key], given)
    most = arguments.most_seeds if arguments.most_seeds is not None else BLOCKS_OF_A_VALUE * len(seeds)
    if not len(seeds) <= most <= 100000:
        raise UserError(f"invalid --most-seeds={most} (must be a whole number from {len(seeds)}, the number of `seeds`, to 1e5)")
    options = curve_search.Options(keys, goal, budget, most, arguments.same_seeds)
    return curve_search.CurveSearch(options, lists, seeds, float(config["max-time"]))


def digest(config: str, keys: Sequence[str], search: Search) -> str:
    """Names a search: the same keys, settings and first round have the same rounds."""
    content = json.dumps([config, keys, search.first_round()]).encode()
    obstacles = stored.settings(config)["obstacles"]
    return hashlib.sha256(content + (pathlib.Path(obstacles).read_bytes() if obstacles != "none" else b"")).hexdigest()[:8]


def body() -> int:
    arguments, words = parse()
    if not (arguments.output or arguments.dry_run):
        raise UserError("no --output; give the file that the sweep is to make")
    keys = [key.replace("_", "-") for key in arguments.refined.split(",")]
    clogsweep = programs.programs_in(arguments.programs) / "clogsweep"
    options: list[str] = []
    for name in PASSED_ON:
        if value := getattr(arguments, name.replace("-", "_")):
            options += [f"--{name}", value]
    given = [*(["--config", arguments.config] if arguments.config else []), *(f"{key}={value}" for key, value in arguments.settings)]
    with Launcher(words, clogsweep) as launcher, tempfile.TemporaryDirectory(
            prefix=".clogsweep-refine-", dir=arguments.output.parent if arguments.output else None) as folder:
        config = "\n".join(line for line in launcher.ask(*given, *options, "--print-config").splitlines() if " = " in line and line[0] != "#")
        if "point-keys = " in config:
            raise UserError("the config has points, which refine chooses itself; leave them out")
        values = stored.settings(config)
        schema = json.loads(launcher.ask("--schema"))
        settings.check_keys(keys, values, schema["keys"])
        search = made_search(arguments, keys, values)
        beside = (str(arguments.output) if arguments.output else f"{folder}/none") + f".refine-{digest(config, keys, search)}"
        draft = pathlib.Path(folder, "points.csv")
        # Kept beside the output, so that `clogsweep --config ... --points ...` repeats the search's runs by hand.
        fixed = pathlib.Path(folder, "settings.cfg") if arguments.dry_run else pathlib.Path(f"{beside}.cfg")
        fresh = not fixed.exists()
        rounds.write_durably(fixed, config + "\n")
        there = ["--output", arguments.output] if arguments.output and arguments.output.exists() else []

        def points(lines: Sequence[rounds.Line]) -> list[object]:
            draft.write_text(rounds.points_text(keys, lines), encoding="utf-8")
            return ["--config", fixed, *options, "--points", draft]

        def resolve(asked: Sequence[Values]) -> list[Resolved]:
            first = int(settings.numbers(values["seeds"])[0])
            try:
                return resolved_tasks(launcher.tasks(*points([(one, (first, 1)) for one in asked])))
            except ProgramFailed as failure:
                if failure.exit_code != command_line.USER_FAULT:
                    raise
                raise UserError(str(failure).removeprefix("clogsweep: ").replace(f"{draft}", "the points")) from failure

        try:
            members = Membership(keys, schema, search.candidates, resolve)
        except (UserError, ProgramFailed):
            if fresh:
                fixed.unlink()
            raise
        if arguments.dry_run:
            table = launcher.ask(*points(search.first_round()), "--dry-run", *there)
            print(table, end="")
            cost = re.search(r"expected ([\d.e+-]+) core-hours", table)
            number = re.search(r"^# (\d+) tasks?:", table, re.MULTILINE)
            hours = float(cost[1]) / int(number[1]) if cost and number else math.nan
            print("".join(f"# {line}\n" for line in search.costs(hours)), end="")
            return 0
        comment = (f"Points of `python3 -m clogsweep refine {','.join(keys)}`, for clogsweep --points.\n"
                   "Each round is stored here before it starts; the same command reads them.")
        return refine(search, launcher, members, rounds.StoredRounds(pathlib.Path(f"{beside}.csv"), keys, comment),
                      arguments.output, ["--config", fixed, *options, *(["--verbose"] if arguments.verbose else []),
                                         *(["--quiet"] if arguments.quiet else [])],
                      Limits(arguments.max_hours), arguments.programs)
