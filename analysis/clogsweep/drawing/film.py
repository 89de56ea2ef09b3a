"""Makes a film of one droplet. The camera follows the droplet, the curve r(t) grows beside it, and the last frame shows
how the run ended."""

import pathlib
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.path import Path
from PIL import Image
from scipy import ndimage

from .. import style
from ..reading import trajectory
from ..tools import outputs, progress
from ..tools.errors import UserError
from ..tools.hints import Numbers
from . import surroundings

Pixels = npt.NDArray[np.uint8]  # height x width x 4, for red, green, blue and alpha

FORMAT = (9.6, 5.4)  # Inches.
SIZES = {"540p": 100, "1080p": 200, "2160p": 400}  # Pixels per inch.
# Margin as a fraction of the figure. Without it, half of the line around the frame would be outside the picture.
LINE = 0.002
HEIGHT = 0.93  # Height of the droplet's surroundings, as a fraction of the figure.
# Width of the droplet's surroundings as a fraction of the figure, with and without room for a colour bar.
WIDTHS = {"speed": 0.91, "mechanism": 1 - 2 * LINE}
# Largest distance that the droplet moves between two frames [sigma]. The eye cannot follow longer steps.
LONGEST_STEP = 0.5
SECONDS_OF_VERDICT = 2
ENDINGS = (".mp4", ".gif")
COLOURS = tuple(WIDTHS)
SHADES = 96  # Number of colours of a palette for the first frame, and number of colours for the colour bar.


def chosen_frames(run: trajectory.Trajectory, most: int) -> npt.NDArray[np.int64]:
    """Chooses every n-th frame back from the last one, and at most `most` frames. If the film reaches back to the first
    frame, that frame is added. If the droplet moved too far in n frames, n is reduced, and the film shows only the end
    of the run."""
    count = len(run.times)
    way = np.abs(np.diff(trajectory.centroids(run.polygons), axis=0)).sum()
    step = max(1, -(-(count - 1) // max(1, most - 1)))
    step = max(1, min(step, int(LONGEST_STEP * count / max(way, LONGEST_STEP))))
    frames = np.arange(count - 1, -1, -step)[:most][::-1]
    return np.insert(frames, 0, 0) if 0 < frames[0] < step and len(frames) < most else frames


def smoothed(values: Numbers, width: int) -> Numbers:
    """A moving average with weights that rise and fall. @param width  in frames"""
    weights = np.hanning(2 * width + 3)[1:-1]
    return np.asarray(ndimage.convolve1d(values, weights / weights.sum(), mode="nearest"))


class Camera:
    """A view that follows the droplet smoothly, and zooms out if the droplet is long."""

    HALF_HEIGHT = 2.0  # Smallest half height of the view [sigma].
    LEAD = 0.12  # The centre of the view is ahead of the droplet by this fraction of the view's width.

    def __init__(self, polygons: Numbers, frames_of_a_turn: int, aspect: float) -> None:
        """@param aspect  width of the view divided by its height"""
        low, high = polygons.min(axis=2), polygons.max(axis=2)
        length, height = (high - low).T
        half_height = np.maximum(self.HALF_HEIGHT, 0.75 * np.maximum(length / aspect, height))
        self._aspect = aspect
        self._middle = np.stack([smoothed(middle, frames_of_a_turn) for middle in ((low + high) / 2).T], axis=1)
        # An average of local maxima is never too small for the droplet.
        self._half_height = smoothed(ndimage.maximum_filter1d(half_height, 2 * frames_of_a_turn + 1, mode="nearest"),
                                     frames_of_a_turn)

    def corners(self, frame: int) -> tuple[Numbers, Numbers]:
        half = self._half_height[frame] * np.array([self._aspect, 1.0])
        middle = self._middle[frame] + [2 * self.LEAD * half[0], 0]
        return middle - half, middle + half


class Layer:
    """A static overlay, which is drawn once and then copied onto every frame."""

    def __init__(self, figure: Figure, artists: Iterable[Artist]) -> None:
        renderer = figure.canvas.get_renderer()
        renderer.clear()
        for artist in artists:
            artist.draw(renderer)
        pixels = pixels_of(figure)
        rows, columns = (np.flatnonzero(pixels[..., 3].any(axis=axis)) for axis in (1, 0))
        self._corner = columns[0], len(pixels) - 1 - rows[-1]
        # Rows run from the bottom to the top, as matplotlib expects.
        self._pixels = pixels[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1][::-1].copy()

    def draw(self, renderer: Any) -> None:
        renderer.draw_image(renderer.new_gc(), *self._corner, self._pixels)


def pixels_of(figure: Figure) -> Pixels:
    """The pixels that are drawn so far. The array is no copy: further drawing changes it."""
    return np.asarray(figure.canvas.buffer_rgba())


class Film:
    """One canvas on which a droplet moves from frame to frame.

    Only moving parts are redrawn, because the whole figure would take four times as long.

    @param colour  "speed": the outline is coloured by its speed; "mechanism": the last frame shows how the droplet
    clogged
    @param size  a key of SIZES
    """

    def __init__(self, run: trajectory.Trajectory, frames: Sequence[int] | npt.NDArray[np.int64], colour: str,
                 rate: int, size: str = "1080p") -> None:
        self._run = run
        self._frames = frames
        self._rate = rate
        width = WIDTHS[colour]
        self._camera = Camera(run.polygons[frames], rate, FORMAT[0] * width / (FORMAT[1] * HEIGHT))
        self._centres = trajectory.centroids(run.polygons)
        self.figure = style.new_figure(figsize=FORMAT, dpi=SIZES[size])
        self._axes = self.figure.add_axes((LINE, LINE, width, HEIGHT))
        self._axes.axis("off")
        self.figure.text(0.01, 0.965, trajectory.described(run), va="center", fontsize=11)
        self._draw_surroundings()
        self._draw_droplet(colour)
        self._frame = self._axes.add_patch(Rectangle((0, 0), 1, 1, transform=self._axes.transAxes,
                                                     fill=False, linewidth=0.8, clip_on=False))
        inset = self._draw_course()
        surroundings.draw_guides(self._axes)
        self._bar, = self._axes.artists
        still = [*self._axes.texts, self._draw_legend(colour)]
        self._clock = self.figure.text(width - 0.01, 0.965, "", va="center", ha="right", fontsize=11)
        self._verdict = self._axes.text(0.5, 0.9, "", transform=self._axes.transAxes, ha="center", fontsize=14,
                                        bbox={"facecolor": "white", "edgecolor": "0.5", "alpha": 0.9, "pad": 6})
        self._verdict.set_visible(False)
        self._separate(inset, still)

    def _draw_legend(self, colour: str) -> Artist:
        shown: list[Artist] = [Line2D([], [], color=style.DROPLET, linewidth=1.5, label="path of the centre")]
        if colour == "mechanism":
            shown += [Patch(facecolor=face, edgecolor="black", alpha=0.75, label=f"clogged, {name}")
                      for name, face in style.MECHANISM_COLOURS.items()
                      if name == self._run.word("mechanism")]
        return self._axes.legend(handles=shown, loc="upper right", fontsize=9, edgecolor="0.7", framealpha=1)

    def _separate(self, inset: list[Artist], still: list[Artist]) -> None:
        """Separates the static parts from the moving parts. The scale bar has the width of a droplet, so it changes
        when the camera zooms."""
        under = [*self._axes.patches[:self._num_walls], self._obstacles, self._trail,
                 self._inside, self._outline, self._frame]
        over = [self._course, self._head, self._clock, self._verdict]
        for artist in (*under, *inset, *still, *over, self._bar):
            artist.set_animated(True)
        self._moving_under, self._moving_over = under, over
        self._layers = [Layer(self.figure, inset), Layer(self.figure, still)]
        self._bar_layer, self._bar_width = self._layers[1], 0
        self.figure.canvas.draw()
        self._background = self.figure.canvas.copy_from_bbox(self.figure.bbox)

    def _draw_surroundings(self) -> None:
        surroundings.draw_walls(self._axes, self._run)
        self._num_walls = len(self._axes.patches)
        self._discs = [Path.circle((x, y), diameter / 2) for x, y, diameter in self._run.obstacles]
        self._obstacles = self._axes.add_collection(PathCollection([], facecolor=style.OBSTACLE, edgecolor="none"))

    def _draw_droplet(self, colour: str) -> None:
        self._trail, = self._axes.plot([], [], color=style.DROPLET, linewidth=1.5, alpha=0.6)
        self._inside, = self._axes.fill([0], [0], facecolor=style.DROPLET if colour == "speed" else "0.6", alpha=0.75)
        # There is one path per edge. All paths are views of one array, because making new paths for each frame would
        # take longer than drawing them.
        self._edges = np.zeros((self._run.polygons.shape[2], 2, 2))
        self._outline = PathCollection([Path(edge) for edge in self._edges], cmap=style.SCALE, facecolor="none",
                                       linewidth=2, capstyle="round")
        self._axes.add_collection(self._outline)
        self._speeds = None
        if colour == "speed":
            self._speeds = trajectory.interface_speeds(self._run) / self._run.row["terminal_speed"]
            # Speeds above this limit have the brightest colour. Without a limit, a few fast moments would make all
            # other moments dark.
            self._outline.set_norm(matplotlib.colors.Normalize(0, max(1e-3, np.percentile(self._speeds, 98))))
            self.figure.colorbar(self._outline, cax=self.figure.add_axes((0.92, 0.2, 0.012, 0.6)),
                                 label="speed of the interface $/v_t$")
        else:
            self._outline.set_edgecolor("black")
        self._colour_of_the_end = style.MECHANISM_COLOURS.get(self._run.word("mechanism")) if colour == "mechanism" else None

    def _draw_course(self) -> list[Artist]:
        """Draws the axes of r(t). @return the artists that are static"""
        table = self._run.table
        paper = self._axes.add_patch(Rectangle((0.69, 0), 0.31, 0.37, transform=self._axes.transAxes,
                                               facecolor="white", alpha=0.85))
        inset = self._axes.inset_axes((0.745, 0.1, 0.24, 0.25))
        inset.set_xlim(0, max(table["time"][-1], 1e-9))
        inset.set_ylim(min(0, table["distance"].min()), max(table["distance"].max(), 1e-9) * 1.05)
        inset.locator_params(nbins=3)
        inset.tick_params(labelsize=8)
        inset.set_xlabel("$t/t_0$", fontsize=9, labelpad=0)
        inset.set_ylabel(r"$r/\sigma$", fontsize=9, labelpad=1)
        self._course, = inset.plot([], [], color=style.DROPLET, linewidth=1.5)
        self._head, = inset.plot([], [], "o", color=style.DROPLET, markersize=4)
        return [paper, inset]

    def __len__(self) -> int:
        return len(self._frames)

    def show(self, index: int) -> None:
        """Moves the droplet to a frame, but draws nothing. @param index  index among the chosen frames"""
        frame = self._frames[index]
        polygon = self._run.polygons[frame].T
        self._look(*self._camera.corners(index))
        self._trail.set_data(*self._centres[: frame + 1].T)
        self._inside.set_xy(polygon)
        self._edges[:, 0], self._edges[:, 1] = polygon, np.roll(polygon, -1, axis=0)
        if self._speeds is not None:
            self._outline.set_array(self._speeds[frame])
        if index == len(self) - 1:
            self._show_end()
        else:
            table, time = self._run.table, self._run.times[frame]
            self._show_time(time, float(np.interp(time, table["time"], table["distance"])))

    def pixels(self, index: int) -> Pixels:
        """Draws a frame. @return its pixels, valid until the next frame is drawn"""
        self.show(index)
        canvas = self.figure.canvas
        self._redraw_bar()
        canvas.restore_region(self._background)
        renderer = canvas.get_renderer()
        for artist in (*self._moving_under, *self._layers, self._bar_layer, *self._moving_over):
            artist.draw(renderer)
        return pixels_of(self.figure)

    def _redraw_bar(self) -> None:
        (left, _), (right, _) = self._axes.transData.transform([(0, 0), (1, 0)])
        if round(right - left) != self._bar_width:
            self._bar_width = round(right - left)
            self._bar_layer = Layer(self.figure, [self._bar])

    def _look(self, low: Numbers, high: Numbers) -> None:
        surroundings.frame_limits(self._axes, low, high)
        centres, radii = self._run.obstacles[:, :2], self._run.obstacles[:, 2:] / 2
        near = np.all((centres + radii > low) & (centres - radii < high), axis=1)
        self._obstacles.set_paths([self._discs[index] for index in np.flatnonzero(near)])

    def _show_time(self, time: float, distance: float) -> None:
        table = self._run.table
        until = int(np.searchsorted(table["time"], time, side="right"))
        self._course.set_data(table["time"][:until], table["distance"][:until])
        self._head.set_data([time], [distance])
        self._clock.set_text(f"t = {time:.0f} t\N{SUBSCRIPT ZERO},  r = {distance:.2f} \N{GREEK SMALL LETTER SIGMA}")

    def _show_end(self) -> None:
        # If the clog is certified, the row has the distance of the equilibrium. The equilibrium is up to a hundredth of
        # a diameter beyond the last frame.
        self._show_time(self._run.row["time"], self._run.row["distance"])
        self._verdict.set_text(trajectory.verdict(self._run))
        self._verdict.set_visible(True)
        if self._colour_of_the_end:
            self._inside.set_facecolor(self._colour_of_the_end)

    def play(self) -> Iterator[Pixels]:
        """Draws one frame after the other, and reports the progress."""
        for index in progress.shown(range(len(self)), "drawing frame", len(self)):
            yield self.pixels(index)

    def play_and_hold(self) -> Iterator[Pixels]:
        """Plays the film, and repeats the last frame for SECONDS_OF_VERDICT."""
        yield from self.play()
        for _ in range(SECONDS_OF_VERDICT * self._rate):
            yield pixels_of(self.figure)


def size_for(path: pathlib.Path | None) -> str:
    """The default size, a key of SIZES. For a .gif the size is smaller, because such a file is large and is held in
    memory.
    @param path  of a film, or None for pictures"""
    return "540p" if path is not None and path.suffix == ".gif" else "1080p"


def path_of(output: pathlib.Path) -> pathlib.Path:
    """The file of a film, with the requested ending. If no ending is requested, the file ends in .mp4 if ffmpeg is
    installed, and in .gif otherwise.
    @throws UserError  if such a film cannot be made, or if the file exists"""
    outputs.refuse_ending(output, *ENDINGS)
    has_ffmpeg = shutil.which("ffmpeg") is not None
    if output.suffix not in ENDINGS:
        output = output.with_name(output.name + (".mp4" if has_ffmpeg else ".gif"))
    if output.suffix == ".mp4" and not has_ffmpeg:
        raise UserError(f"cannot write {output} (no ffmpeg); install it, or ask for {output.with_suffix('.gif')}")
    if output.exists():
        raise UserError(f"will not overwrite {output} (it exists); give another name, or remove it first")
    return output


def write_film(film: Film, path: pathlib.Path, rate: int) -> pathlib.Path:
    """Writes a complete film, or no file. @param path  from path_of(). @return the file written"""
    with outputs.replaced(path) as fresh:
        (write_mp4 if path.suffix == ".mp4" else write_gif)(film, fresh, rate)
    return path


def write_mp4(film: Film, path: pathlib.Path, rate: int) -> None:
    """Writes the film with ffmpeg. @throws UserError  with the reason of ffmpeg"""
    height, width, _ = pixels_of(film.figure).shape
    # The encoder takes most of the time. With `veryfast` it takes two thirds of its default time, and the file is a
    # sixth larger. Players require `yuv420p`.
    command = ["ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo",
               "-pix_fmt", "rgba", "-video_size", f"{width}x{height}", "-framerate", str(rate),
               "-i", "pipe:", "-c:v", "libx264", "-preset", "veryfast", "-pix_fmt", "yuv420p", f"file:{path}"]
    with (tempfile.TemporaryFile() as messages,
          subprocess.Popen(command, stdin=subprocess.PIPE, stderr=messages) as process):
        assert process.stdin is not None
        try:
            for pixels in film.play_and_hold():
                process.stdin.write(pixels.data)
            process.stdin.close()
        except BrokenPipeError:
            pass  # ffmpeg has ended, and prints the reason.
        if process.wait() != 0:
            messages.seek(0)
            raise UserError(f"cannot write {path.name} (ffmpeg: {' '.join(messages.read().decode(errors='replace').split())}); look at the folder and its disk")


def palette_of(first: Pixels) -> Image.Image:
    """The palette of all frames: the colours of the first frame, shades of the colour bar, greys, and colours that
    occur only at the end."""
    seen = np.reshape(Image.fromarray(first[..., :3]).quantize(SHADES).getpalette()[:3 * SHADES], (-1, 3)) / 255
    bar = style.SCALE(np.linspace(0, 1, SHADES))[:, :3]
    greys = np.repeat(np.linspace(0, 1, 32), 3).reshape(-1, 3)
    ends = matplotlib.colors.to_rgba_array(list(style.MECHANISM_COLOURS.values()))[:, :3]
    all_ = np.concatenate([seen, bar, greys, ends, 0.25 + 0.75 * ends])
    # Pillow compares only some bits of a colour, and would replace white by a light grey.
    is_white = all_.min(axis=1) > 0.97
    palette = Image.new("P", (1, 1))
    palette.putpalette([255, 255, 255, *(255 * all_[~is_white]).round().astype(int).ravel().tolist()])
    return palette


def write_gif(film: Film, path: pathlib.Path, rate: int) -> None:
    palette = palette_of(film.pixels(0))
    # All frames are held in memory until the last one is drawn, so each pixel has one byte.
    frames = (Image.fromarray(pixels[..., :3]).quantize(palette=palette, dither=Image.Dither.NONE)
              for pixels in film.play_and_hold())
    next(frames).save(path, save_all=True, append_images=frames, duration=1000 / rate, loop=0)


def write_pictures(film: Film, output: str) -> pathlib.Path:
    """Writes numbered pictures into a folder. @param output  the folder"""
    folder = pathlib.Path(output)
    folder.mkdir(parents=True, exist_ok=True)
    for index, pixels in enumerate(film.play()):
        with outputs.replaced(folder / f"{index:05d}.png") as fresh:
            Image.fromarray(pixels[..., :3]).save(fresh)
    # Deletes pictures that an earlier, longer film left behind.
    for earlier in folder.glob("[0-9]" * 5 + ".png"):
        if int(earlier.stem) >= len(film):
            earlier.unlink()
    return folder
