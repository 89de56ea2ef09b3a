"""Which mean speeds of clogfit are told: one or two runs that happened to come far enough say little of all."""

from __future__ import annotations

from .hints import Group

FEWEST_RUNS = 3  # as `fewest_speeds` of src/campaign/group_table.cpp, for clogfit's table
COLUMNS = ("relative_speed", "relative_speed_error", "relative_speed_pooled", "relative_speed_pooled_error", "capillary_number")


def sound(group: Group) -> Group:
    """The group, without a mean speed and what follows from it where that is of too few runs."""
    if group.get("relative_speed_runs", FEWEST_RUNS) >= FEWEST_RUNS:
        return group
    return group | {name: None for name in COLUMNS if name in group}
