"""Settings of a sweep, as `clogsweep --print-config` resolves them."""

import math
import re
from collections.abc import Sequence

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Column
from .goals import number

Config = dict[str, str]
SPACED = re.compile(r"(lin|log)\(([^,()]+),([^,()]+),\s*(\d+)\s*\)")


def numbers(text: str) -> list[float]:
    """A list of numbers as clogsweep reads it: `0.2,0.3`, `1..50`, `lin(a,b,n)`, `log(a,b,n)`. What is no number is NaN."""
    values: list[float] = []
    for word in re.split(r",(?![^()]*\))", text):
        word = word.strip()
        if spaced := SPACED.fullmatch(word):
            first, last, count = number(spaced[2].strip()), number(spaced[3].strip()), int(spaced[4])
            between = np.linspace(first, last, count) if spaced[1] == "lin" else np.geomspace(first, last, count)
            values += [first, *(float(f"{value:.12g}") for value in between[1:-1]), last][:count]
        elif whole := re.fullmatch(r"(-?\d+)\.\.(-?\d+)", word):
            values += map(float, range(int(whole[1]), int(whole[2]) + 1))
        else:
            values.append(number(word))
    return values


def check_keys(keys: Sequence[str], config: Config, all_keys: Sequence[Column]) -> None:
    """@throws UserError  for keys that cannot be refined, and for lists of other keys"""
    if not 1 <= len(keys) <= 2 or len(set(keys)) != len(keys):
        raise UserError(f"cannot refine {','.join(keys)} (names one key, or two different ones) try line-tension,friction")
    schema = {key["key"]: key for key in all_keys}
    for key in keys:
        if key not in schema:
            raise UserError(f"cannot refine {key} (no such key); clogsweep --schema lists the keys")
        if schema[key].get("role") != "physics" or schema[key]["kind"] not in ("number", "number or share"):
            raise UserError(f"cannot refine {key} (is not a number of the physics); list its values in a sweep")
    if config["obstacle-layout"] in ("channel", "wall"):
        raise UserError(f"cannot refine with obstacle-layout={config['obstacle-layout']} (it has no clogging length); "
                        "list values in a sweep")
    for key, value in config.items():
        is_list = key in schema and schema[key]["kind"] not in ("word", "file") and len(numbers(value)) > 1
        if is_list and key not in (*keys, "seeds"):
            raise UserError(f"invalid {key}={value} (refine takes one value of every other key) give one, and the next "
                            "in a command of its own, with the same --output")


def seed_block(text: str) -> list[int]:
    """Seeds that follow one another. @throws UserError"""
    seeds = numbers(text)
    if any(math.isnan(seed) or seed != seeds[0] + i for i, seed in enumerate(seeds)):
        raise UserError(f"invalid seeds={text} (with refine seeds follow one another) try seeds=1..4")
    return [int(seed) for seed in seeds]
