"""A film of one droplet: the camera follows it, r(t) grows beside it, and the last frame says how it ended."""

import pathlib
import shutil

import matplotlib
import numpy as np
from . import progress, style, trajectory
from .errors import UserError
from matplotlib import animation
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.patches import Circle, Rectangle

SIZE = (9.6, 5.4)  # inches
DPI = 100
PLACE = (0.0, 0.0, 0.91, 0.93)  # of the droplet's surroundings in the figure: left, bottom, width, height
ASPECT = SIZE[0] * PLACE[2] / (SIZE[1] * PLACE[3])
LONGEST_STEP = 0.5  # between frames [sigma]: what moves farther cannot be followed by eye
SECONDS_OF_VERDICT = 2
ENDINGS = (".mp4", ".gif")


def chosen_frames(run, most):
    """Every n-th frame, so that there are no more than `most`; where the droplet moves too far in n frames, n is less and
    the film has the end of the run alone."""
    count = len(run.times)
    way = np.abs(np.diff(trajectory.centroids(run.polygons), axis=0)).sum()
    step = max(1, -(-(count - 1) // max(1, most - 1)))
    step = max(1, min(step, int(LONGEST_STEP * count / max(way, LONGEST_STEP))))
    return np.arange(count - 1, -1, -step)[:most][::-1]


def around(values, width):
    """Of every value its neighbours, `width` on either side. @return one row each"""
    return np.lib.stride_tricks.sliding_window_view(np.pad(values, width, mode="edge"), 2 * width + 1)


def smoothed(values, width):
    """Moving average with weights that rise and fall. @param width  in frames"""
    weights = np.hanning(2 * width + 3)[1:-1]
    return around(values, width) @ (weights / weights.sum())


class Camera:
    """Follows the droplet without haste, and steps back from a long one."""

    HALF_HEIGHT = 2.0  # at least [sigma]
    LEAD = 0.12  # of the width: more is seen ahead of the droplet than behind it

    def __init__(self, polygons, frames_of_a_turn):
        low, high = polygons.min(axis=2), polygons.max(axis=2)
        length, height = (high - low).T
        half_height = np.maximum(self.HALF_HEIGHT, 0.75 * np.maximum(length / ASPECT, height))
        self._middle = np.stack([smoothed(middle, frames_of_a_turn) for middle in ((low + high) / 2).T], axis=1)
        # Of the largest nearby, so that the average is nowhere too small.
        self._half_height = smoothed(around(half_height, frames_of_a_turn).max(axis=1), frames_of_a_turn)

    def corners(self, frame):
        half = self._half_height[frame] * np.array([ASPECT, 1.0])
        middle = self._middle[frame] + [2 * self.LEAD * half[0], 0]
        return middle - half, middle + half


class Film:
    """One canvas on which a droplet moves from frame to frame.

    @param colour  "speed": the outline has the colour of its speed; "mechanism": the last frame shows how it clogged
    """

    def __init__(self, run, frames, colour, rate):
        self._run = run
        self._frames = frames
        self._rate = rate
        self._camera = Camera(run.polygons[frames], rate)
        self._centres = trajectory.centroids(run.polygons)
        self.figure = style.new_figure(figsize=SIZE, dpi=DPI)
        self._axes = self.figure.add_axes(PLACE)
        self._axes.xaxis.set_visible(False)
        self._axes.yaxis.set_visible(False)
        self.figure.text(0.01, 0.965, trajectory.described(run), va="center", fontsize=11)
        self._draw_surroundings()
        self._draw_droplet(colour)
        self._draw_course()
        trajectory.draw_guides(self._axes)
        self._clock = self.figure.text(0.9, 0.965, "", va="center", ha="right", fontsize=11)
        self._verdict = self._axes.text(0.5, 0.9, "", transform=self._axes.transAxes, ha="center", fontsize=14, zorder=7,
                                        bbox={"facecolor": "white", "edgecolor": "0.5", "alpha": 0.9, "pad": 6})
        self._verdict.set_visible(False)

    def _draw_surroundings(self):
        trajectory.draw_walls(self._axes, self._run)
        self._obstacles = self._axes.add_collection(PatchCollection([], facecolor=style.OBSTACLE, edgecolor="none"))

    def _draw_droplet(self, colour):
        self._trail, = self._axes.plot([], [], color=style.DROPLET, linewidth=1.5, alpha=0.6, zorder=2)
        self._inside, = self._axes.fill([0], [0], facecolor=style.DROPLET if colour == "speed" else "0.6", alpha=0.75, zorder=3)
        self._outline = LineCollection([], cmap="viridis", linewidth=2, zorder=4)
        self._axes.add_collection(self._outline)
        self._speeds = None
        if colour == "speed":
            self._speeds = trajectory.interface_speeds(self._run) / self._run.row["terminal_speed"]
            # A few fast moments would leave the rest dark.
            self._outline.set_norm(matplotlib.colors.Normalize(0, max(1e-3, np.percentile(self._speeds, 98))))
            self.figure.colorbar(self._outline, cax=self.figure.add_axes((0.92, 0.2, 0.012, 0.6)),
                                 label="speed of the interface $/v_t$")
        else:
            self._outline.set_color("black")
        self._colour_of_the_end = style.MECHANISM_COLOURS.get(trajectory.mechanism(self._run)) if colour == "mechanism" else None

    def _draw_course(self):
        table = self._run.table
        self._axes.add_patch(Rectangle((0.69, 0), 0.31, 0.37, transform=self._axes.transAxes, facecolor="white", alpha=0.85,
                                       zorder=5))
        inset = self._axes.inset_axes((0.745, 0.1, 0.24, 0.25), zorder=6)
        inset.set_xlim(0, max(table["time"][-1], 1e-9))
        inset.set_ylim(min(0, table["distance"].min()), max(table["distance"].max(), 1e-9) * 1.05)
        inset.locator_params(nbins=3)
        inset.tick_params(labelsize=8)
        inset.set_xlabel("$t/t_0$", fontsize=9, labelpad=0)
        inset.set_ylabel(r"$r/\sigma$", fontsize=9, labelpad=1)
        self._course, = inset.plot([], [], color=style.DROPLET, linewidth=1.5)
        self._head, = inset.plot([], [], "o", color=style.DROPLET, markersize=4)

    def __len__(self):
        return len(self._frames)

    def show(self, index):
        """@param index  of the chosen frames"""
        frame = self._frames[index]
        polygon = self._run.polygons[frame].T
        self._look(*self._camera.corners(index))
        self._trail.set_data(*self._centres[: frame + 1].T)
        self._inside.set_xy(polygon)
        self._outline.set_segments(np.stack([polygon, np.roll(polygon, -1, axis=0)], axis=1))
        if self._speeds is not None:
            self._outline.set_array(self._speeds[frame])
        if index == len(self) - 1:
            self._show_end()
        else:
            table, time = self._run.table, self._run.times[frame]
            self._show_time(time, np.interp(time, table["time"], table["distance"]))

    def _look(self, low, high):
        trajectory.frame_limits(self._axes, low, high)
        centres, radii = self._run.obstacles[:, :2], self._run.obstacles[:, 2:] / 2
        near = np.all((centres + radii > low) & (centres - radii < high), axis=1)
        self._obstacles.set_paths([Circle((x, y), diameter / 2) for x, y, diameter in self._run.obstacles[near]])

    def _show_time(self, time, distance):
        table = self._run.table
        until = np.searchsorted(table["time"], time, side="right")
        self._course.set_data(table["time"][:until], table["distance"][:until])
        self._head.set_data([time], [distance])
        self._clock.set_text(f"t = {time:.0f} t\N{SUBSCRIPT ZERO},  r = {distance:.2f} \N{GREEK SMALL LETTER SIGMA}")

    def _show_end(self):
        # A certified clog's distance is that of the equilibrium, up to a hundredth of a diameter beyond the last frame.
        self._show_time(self._run.row["time"], self._run.row["distance"])
        self._verdict.set_text(trajectory.verdict(self._run))
        self._verdict.set_visible(True)
        if self._colour_of_the_end:
            self._inside.set_facecolor(self._colour_of_the_end)

    def play(self):
        """Shows one frame after the other, and tells how far it is."""
        for index in progress.shown(range(len(self)), "drawing frame", len(self)):
            self.show(index)
            yield index

    def play_and_hold(self):
        """The same; the last frame stays."""
        yield from self.play()
        for _ in range(SECONDS_OF_VERDICT * self._rate):
            yield len(self) - 1


def path_of(output):
    """The file that a film goes to: the ending that was asked for, or .mp4 with ffmpeg, .gif otherwise.
    @throws UserError if it cannot be made, or is there"""
    has_ffmpeg = shutil.which("ffmpeg") is not None
    if output.suffix not in ENDINGS:
        output = output.with_name(output.name + (".mp4" if has_ffmpeg else ".gif"))
    if output.suffix == ".mp4" and not has_ffmpeg:
        raise UserError(f"cannot write {output} (no ffmpeg); install it, or ask for {output.with_suffix('.gif')}")
    if output.exists():
        raise UserError(f"will not overwrite {output} (it exists); give another name, or remove it first")
    return output


def write_film(film, path, rate):
    """The path leads to a whole film, or to nothing. @param path  see path_of(). @return the file written"""
    part = path.with_name(f"{path.stem}.part{path.suffix}")
    try:
        (write_mp4 if path.suffix == ".mp4" else write_gif)(film, part, rate)
        part.rename(path)
    finally:
        part.unlink(missing_ok=True)
    return path


def write_mp4(film, path, rate):
    # Even numbers of pixels are what players ask of H.264.
    writer = animation.FFMpegWriter(fps=rate, extra_args=["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"])
    with writer.saving(film.figure, path, dpi=DPI):
        for _ in film.play_and_hold():
            writer.grab_frame()


def write_gif(film, path, rate):
    from PIL import Image

    def images():
        for _ in film.play_and_hold():
            film.figure.canvas.draw()
            # One byte a pixel: all frames are held until the last.
            yield Image.fromarray(np.asarray(film.figure.canvas.buffer_rgba())[..., :3]).quantize(64)

    frames = images()
    next(frames).save(path, save_all=True, append_images=frames, duration=1000 / rate, loop=0)


def write_pictures(film, folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for index in film.play():
        film.figure.savefig(folder / f"{index:05d}.png", dpi=DPI)
    # Those of a longer run that were there before are no part of this one.
    for earlier in folder.glob("[0-9]" * 5 + ".png"):
        if int(earlier.stem) >= len(film):
            earlier.unlink()
    return folder
