"""Puts values and seeds of a sweep where its curve needs them, and runs clogsweep round by round.

    python3 -m clogsweep refine line-tension --config sweep.cfg --output sweep.h5 line-tension=0.03,3 seeds=1..4 \\
        --until curve=20% -- mpirun -np 2
    python3 -m clogsweep refine line-tension,friction --config sweep.cfg --output both.h5 preset=elastic \\
        line-tension=0.03,3 friction=0.01,0.3 --budget 10h -- srun
    python3 -m clogsweep refine lattice-angle --config lattice.cfg --output lattice.h5 --until critical-angle=0.5

The words after -- start clogsweep; without these words clogsweep runs on one core. The points of a round are stored
beside the output (OUTPUT.refine-*.csv) before the round starts. The same command resumes a stopped search; exit codes
are those of clogsweep.
"""

import argparse
import hashlib
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..reading import programs, stored
from ..refinement import critical_angle, curve_search, driver, goals
from ..refinement.membership import Membership, Values, tasks_of
from ..tools.errors import ProgramFailed, UserError
from ..tools.lists import number, numbers
from . import command_line

PASSED_ON = ("lab", "attempts", "isolate", "report-seconds", "master-computes", "instruction-set")
BLOCKS_OF_A_VALUE = 50  # without --most-seeds, a value gets at most this number of blocks of seeds


def parse(words: Sequence[str]) -> argparse.Namespace:
    parser = command_line.Parser(__doc__)
    parser.add_argument("keys", metavar="KEY[,KEY]", help="one key, or two separated by a comma; the outermost given values of a key are its bounds")
    parser.add_argument("settings", type=command_line.key_and_value, nargs="*", metavar="KEY=VALUES", help="keys of clogsweep")
    parser.add_argument("--config", help="file with lines `key = value`")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="HDF5 file to create, to resume or to add to")
    parser.add_argument("--until", metavar="GOAL",
                        help="curve=20%%, peak=10%%, crossing=10:5%% or, for a lattice, critical-angle=0.5")
    parser.add_argument("--budget", metavar="H", help="largest number of core-hours of all runs together, e.g. 10h")
    parser.add_argument("--max-hours", type=command_line.between(0, 1e9, "hours"), default=math.inf, metavar="H",
                        help="stop the sweep after this number of hours")
    parser.add_argument("--most-seeds", type=command_line.whole(1), metavar="N",
                        help=f"largest number of seeds of a value ({BLOCKS_OF_A_VALUE} times `seeds`)")
    parser.add_argument("--same-seeds", action="store_true", help="use the same seeds for all values")
    parser.add_argument("--dry-run", action="store_true", help="print the first round and its cost, run nothing")
    for name in PASSED_ON:
        parser.add_argument(f"--{name}", help="as for clogsweep")
    for name in ("verbose", "quiet"):
        parser.add_argument(f"--{name}", action="store_true", help="as for clogsweep")
    programs.add_option(parser)
    return parser.parse_intermixed_args(words)


def require_keys(keys: Sequence[str], config: dict[str, str], schema: dict[str, list[dict[str, str]]]) -> None:
    """@throws UserError  for keys that cannot be refined"""
    named = ",".join(keys)
    if len(keys) > 2 or len(set(keys)) != len(keys):
        raise UserError(f"cannot refine {named} (names one key, or two different ones) try line-tension,friction")
    known = {key["key"]: key for key in schema["keys"]}
    for key in keys:
        if key not in known:
            raise UserError(f"cannot refine {key} (no such key); clogsweep --schema lists the keys")
        if known[key].get("role") != "physics" or known[key]["kind"] not in ("number", "number or share"):
            raise UserError(f"cannot refine {key} (is not a number of the physics); list its values in a sweep")
    if config["obstacle-layout"] in ("channel", "wall"):
        raise UserError(f"cannot refine with obstacle-layout={config['obstacle-layout']} (it has no clogging length); list "
                        "values in a sweep")


def search_of(arguments: argparse.Namespace, keys: list[str], config: dict[str, str],
              plan_of: Callable[[Sequence[Values]], dict[str, Any]]) -> driver.Search:
    """@param plan_of  see planned(). @throws UserError"""
    if not (arguments.until or arguments.budget):
        raise UserError("refine needs an end; try --until curve=20%, or --budget 10h")
    budget = goals.parse_budget(arguments.budget) if arguments.budget else math.inf
    goal = goals.parse_goal(arguments.until) if arguments.until else goals.Goal("")
    lists = [numbers(config[key]) for key in keys]
    seeds = numbers(config["seeds"])
    if critical_angle.KEY in keys:
        if len(keys) > 1 or goal.kind not in ("", "critical-angle"):
            raise UserError(f"cannot refine {','.join(keys)} until {arguments.until or 'a budget is used up'} (lattice-angle "
                            "is refined alone, for the critical angle) try --until critical-angle=0.5")
        if arguments.same_seeds or arguments.most_seeds:
            raise UserError("invalid --same-seeds or --most-seeds (each angle gets the seeds of `seeds`); leave them out")
        critical_angle.require_angles(config[critical_angle.KEY], lists[0], config["lattice"])
        return critical_angle.AngleSearch(lists[0], float(config["box"]), len(seeds), goal.precision, budget,
                                          lambda angle: critical_angle.nearest_angle(plan_of([(angle,)]), angle))
    if goal.kind == "critical-angle":
        raise UserError(f"invalid --until={arguments.until} (is found over the angle of a lattice) try refine lattice-angle")
    if goal.kind == "crossing" and len(keys) > 1:
        raise UserError(f"invalid --until={arguments.until} (with two keys lambda crosses it along a line) give one key")
    if seeds != list(np.arange(len(seeds)) + seeds[0]):
        raise UserError(f"invalid seeds={config['seeds']} (with refine seeds follow one another) try seeds=1..4")
    for key, given in zip(keys, lists):
        curve_search.require_bounds(key, config[key], given)
    most = arguments.most_seeds or BLOCKS_OF_A_VALUE * len(seeds)
    if not len(seeds) <= most <= 100000:
        raise UserError(f"invalid --most-seeds={most} (must be {len(seeds)}, the number of `seeds`, to 100000)")
    options = curve_search.Options(goal, budget, most, arguments.same_seeds)
    return curve_search.CurveSearch(keys, lists, list(map(int, seeds)), number(config["max-time"]), options)


def changing_density(keys: Sequence[str], config: dict[str, str]) -> str:
    """A note for the user if the density of obstacles changes with a refined key, otherwise an empty text."""
    density, sizes = config["obstacle-density"], [key for key in keys if key in ("obstacle-gap", "obstacle-diameter")]
    if config["obstacle-layout"] != "random" or not sizes or not math.isnan(number(density)):
        return ""
    return (f"obstacle-density={density} changes the number of obstacles per area with {' and '.join(sizes)}, so lambda depends on both; "
            "a number, such as obstacle-density=0.2, keeps it")


def planned(*command: object) -> dict[str, Any]:
    """The first line of a dry run, which is stopped before it estimates the cost. @throws UserError"""
    words = [*map(str, command), "--dry-run", "--format", "json"]
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="backslashreplace") as errors:
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=errors, encoding="utf-8", errors="backslashreplace", env=_alone()) as process:
            plan = process.stdout.readline() if process.stdout else ""
            if plan:
                process.terminate()
        errors.seek(0)
        reason = programs.reason(errors.read())
    if plan:
        return json.loads(plan)
    if process.returncode == command_line.USER_FAULT:
        raise UserError(reason.removeprefix("clogsweep: "))
    raise ProgramFailed(reason, process.returncode)


def _alone() -> dict[str, str]:
    """The environment without SLURM_NTASKS, with which clogsweep would refuse to run on one rank."""
    return {name: value for name, value in os.environ.items() if name != "SLURM_NTASKS"}


def body() -> int:
    words = sys.argv[1:]
    end = words.index("--") if "--" in words else len(words)
    arguments, starter = parse(words[:end]), words[end + 1:]
    if not (arguments.output or arguments.dry_run):
        raise UserError("no --output; give the file that the sweep is to make")
    keys = [key.replace("_", "-") for key in arguments.keys.split(",")]
    clogsweep = programs.programs_in(arguments.programs) / "clogsweep"
    lab = ["--lab", arguments.lab] if arguments.lab else []
    given = [*(["--config", arguments.config] if arguments.config else []), *map("=".join, arguments.settings), *lab]
    printed = programs.run_program(clogsweep, *given, "--print-config")
    config = "".join(f"{line}\n" for line in printed.splitlines() if " = " in line and line[0] != "#")
    if "\npoint-keys = " in config:
        raise UserError("the config has points, or --lab several droplets, and refine chooses its own points; leave the points out, and give one diameter and one angle")
    schema = json.loads(programs.run_program(clogsweep, "--schema"))
    values = stored.settings(config)
    require_keys(keys, values, schema)
    with tempfile.TemporaryDirectory(prefix="clogsweep-refine-") as temporary:
        folder = pathlib.Path(temporary)
        driver.store(folder / "settings.cfg", config)

        def plan_of(asked: Sequence[Values]) -> dict[str, Any]:
            draft = folder / "points.csv"
            first = int(numbers(values["seeds"])[0])
            driver.store(draft, driver.points_text(keys, [(one, (first, 1)) for one in asked]))
            return planned(clogsweep, "--config", folder / "settings.cfg", "--points", draft)

        search = search_of(arguments, keys, values, plan_of)
        if (note := changing_density(keys, values)) and not arguments.quiet:
            print(f"python3 -m clogsweep refine: {note}", file=sys.stderr)
        # Searches with the same settings and the same first round share their files, even if their goals differ, so
        # one search continues with the rounds of the other.
        content = config + driver.points_text(keys, search.first_round()) + _circles(values["obstacles"])
        name = "refine-" + hashlib.sha256(content.encode(errors="surrogateescape")).hexdigest()[:8]
        beside = folder / name if arguments.dry_run else arguments.output.with_name(f"{arguments.output.name}.{name}")
        points, settings = beside.with_name(f"{beside.name}.csv"), beside.with_name(f"{beside.name}.cfg")
        options = ["--config", settings, *(f"--{name}={value}" for name in PASSED_ON if name != "lab"
                                           and (value := getattr(arguments, name.replace("-", "_")))),
                   *(f"--{name}" for name in ("verbose", "quiet") if getattr(arguments, name))]
        members = Membership(keys, schema, search.candidates, lambda asked: tasks_of(plan_of(asked)))
        driver.store(settings, config)
        if not arguments.dry_run:
            launcher = driver.Launcher([*starter, clogsweep])
            return driver.refine(search, members, launcher, options, points, arguments.output, arguments.max_hours)
        driver.store(points, driver.points_text(keys, search.first_round()))
        there = ["--output", arguments.output] if arguments.output and arguments.output.exists() else []
        output = programs.run_program(clogsweep, *options, "--points", points, "--dry-run", "--format", "json", *there)
        plan, cost = map(json.loads, output.rstrip("\n").split("\n"))
        print(plan["text"], cost["text"], sep="", end="")
        each = cost.get("expected", cost["spent"]) / plan["number_of_tasks"]
        print("".join(f"# {line}\n" for line in search.costs(each)), end="")
        return 0


def _circles(name: str) -> str:
    """The content of the file of user-supplied circles."""
    return "" if name == "none" else pathlib.Path(name).read_text(encoding="utf-8", errors="surrogateescape")
