#!/usr/bin/python3
"""Draws the clogged droplets of a sweep on one sheet, with what holds each of them.

    clogsweep --output sweep.h5 line-tension=0.2,0.3,1 seeds=1..10
    analysis/clogs.py sweep.h5                  # sweep-clogs.png, sweep-clogs.pdf

Runs the clogged rows again until they rest (clogrun; an outline is in no table). The flow goes to the right. Touched
obstacles are blue, arcs of contact red, the droplet's convex hull dashed. Titles say by what and how far away it
clogged, how many obstacles it wraps and which part of its support they bear, and how many gaps and contacts it has.
"""

import concurrent.futures
import pathlib
import subprocess
import sys
import tempfile

import command_line
from command_line import UserError

with command_line.needs_modules():
    import numpy as np
    import programs
    import rounded
    import stored
    import style
    import trajectory
    from matplotlib.patches import Circle
    from style import plt


def read_clogs(path):
    """Rows of the polygons that have clogged."""
    with stored.opened(path, stored.SWEEP) as file:
        rows = file["runs"][:]
    if len(rows) > 0 and rows["obstacle_filling"][0] in (b"channel", b"wall"):
        raise UserError(f"cannot draw clogs of {path} (its droplets were in a channel or on a wall); clogfit report draws what came out of them")
    return [row for row in rows if row["status"] == b"clogged" and row["model"] == b"dp"]


def mechanism(row):
    """As clogfit calls it: a clog whose mechanism is `none` of the three is another one."""
    name = row["mechanism"].decode()
    return "other" if name == "none" else name


def run_again(clogrun, sweep, row, folder):
    """The interface that walls meet (2 x N) at rest and the obstacles (n x 3: x, y, diameter) around it."""
    output = pathlib.Path(folder) / f"{row['task']}.h5"
    # A certified row describes an equilibrium that the run ends before.
    subprocess.run([clogrun, "replay", sweep, str(row["task"]), "--to-rest", "--output", output,
                    "--polygon-interval", "1e9", "--sample-interval", "1e9"], check=True, capture_output=True, text=True)
    with stored.opened(output) as file:
        return trajectory.refined(file["polygons"][-1], row), file["obstacles"][:]


def distances(polygon, obstacle):
    """From an obstacle's surface to every edge."""
    begin, way = polygon, np.roll(polygon, -1, axis=1) - polygon
    to_centre = obstacle[:2, None] - begin
    along = np.clip((to_centre * way).sum(axis=0) / (way**2).sum(axis=0), 0, 1)
    return np.hypot(*(to_centre - along * way)) - obstacle[2] / 2


def overlaps(row, polygon, obstacles):
    """How deep every obstacle (rows) is in the contact of every edge (columns) [sigma]; above 0 they touch."""
    return trajectory.contact_range(row) - np.array([distances(polygon, obstacle) for obstacle in obstacles])


def hull(points):
    """Corners of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    def chain(ordered):
        corners = []
        for p in ordered:
            while len(corners) > 1 and np.linalg.det([corners[-1] - corners[-2], p - corners[-2]]) <= 0:
                corners.pop()
            corners.append(p)
        return corners[:-1]
    ordered = points[np.lexsort(points.T[::-1])]
    return np.array(chain(ordered) + chain(ordered[::-1]))


def title(row):
    """What clogged and how, in words."""
    wrapped = f"{row['num_wrapped']} wrapped (bears {100 * row['wrapped_support']:.0f} %)" if row["num_wrapped"] > 0 else "none wrapped"
    return (rf"task {row['task']}: {mechanism(row)} after $r = {rounded.plain(row['distance'])}\,\sigma$" "\n"
            rf"$\Gamma = {row['line_tension']:g}$, smallest gap ${row['obstacle_gap']:g}\,\sigma$, seed {row['seed']}" "\n"
            f"{wrapped}, {rounded.counted(row['num_gaps'], 'gap')}, {rounded.counted(row['num_arcs'], 'contact')}")


def draw(axes, row, polygon, obstacles):
    """In coordinates from the droplet's middle. Panels of one shape: titles over flat ones would leave the sheet."""
    low, high = polygon.min(axis=1), polygon.max(axis=1)
    middle, half = (low + high) / 2, (high - low).max() / 2 + 0.3
    interface = polygon - middle[:, None]
    axes.fill(*interface, facecolor="#E69F00", edgecolor="black", linewidth=0.6, alpha=0.7)
    axes.plot(*np.vstack([hull(interface.T), hull(interface.T)[:1]]).T, color="0.4", linewidth=0.6, linestyle="--")
    for obstacle, depths in zip(obstacles, overlaps(row, polygon, obstacles)):
        touches = np.flatnonzero(depths > 0)
        axes.add_patch(Circle(obstacle[:2] - middle, obstacle[2] / 2, color="#0072B2" if len(touches) else "0.85"))
        for edge in touches:
            axes.plot(*interface[:, [edge, (edge + 1) % interface.shape[1]]], color="#D00000", linewidth=1.8)
    trajectory.frame_limits(axes, (-half, -1.2 * half), (half, 1.2 * half))  # with room for the guides
    axes.locator_params(nbins=5)
    trajectory.draw_guides(axes)
    axes.set_title(title(row), fontsize=8)


def chosen(clogs, arguments):
    """@throws UserError where there is none, or not all of --tasks"""
    if not clogs:
        raise UserError(f"{arguments.sweep} holds no clogged polygon (soft disks are none); let it go on, or farther (max-time)")
    rows = [row for row in clogs if arguments.mechanism in (None, mechanism(row))]
    missing = (arguments.tasks or set()) - {row["task"] for row in rows}
    if missing or not rows:
        which = f"--tasks {', '.join(map(str, sorted(missing)))}" if missing else f"--mechanism {arguments.mechanism}"
        raise UserError(f"{which}: {arguments.sweep} holds no such clogged polygon; clogfit counts them")
    return [row for row in rows if row["task"] in arguments.tasks] if arguments.tasks else rows[: arguments.most]


def body():
    parser = command_line.Parser(__doc__)
    parser.add_argument("sweep", type=pathlib.Path, help="file of clogsweep --output")
    command_line.add_output(parser, "name of the picture; .png and .pdf are made (SWEEP-clogs)", ".png", ".pdf")
    programs.add_option(parser)
    parser.add_argument("--most", type=command_line.whole(1), default=30, help="draw so many clogs at most, the first (%(default)s)")
    parser.add_argument("--tasks", type=command_line.tasks, help="only these, e.g. 3,17,40")
    parser.add_argument("--mechanism", choices=["wrapped", "squeezed", "hybrid", "other"], help="only these")
    parser.add_argument("--jobs", type=command_line.whole(1), default=2, help="runs at a time (%(default)s)")
    arguments = parser.parse_args()
    output = arguments.output or command_line.beside(arguments.sweep, "clogs")
    command_line.refuse_unwritable_picture(output, arguments.sweep)
    clogrun = programs.programs_in(arguments.programs) / "clogrun"
    rows = chosen(read_clogs(arguments.sweep), arguments)
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        try:
            shapes = list(pool.map(lambda row: run_again(clogrun, arguments.sweep, row, folder), rows))
        except subprocess.CalledProcessError as error:
            raise UserError(f"cannot run clogrun ({programs.reason(error.stderr)})") from error
        except OSError as error:
            raise UserError(f"cannot run clogrun ({error})") from error
    across = min(6, len(rows))
    down = -(-len(rows) // across)
    figure, axes = plt.subplots(down, across, figsize=(2.8 * across, 3.9 * down), layout="constrained", squeeze=False)
    figure.get_layout_engine().set(h_pad=0.1)  # or the titles of the first row leave the sheet
    for place in axes.flat:
        place.axis("off")
    for place, row, shape in zip(axes.flat, rows, shapes):
        draw(place, row, *shape)
    style.save(figure, output)
    print(f"{output}.png (and .pdf)")
    return 0


if __name__ == "__main__":
    sys.exit(command_line.run(body))
