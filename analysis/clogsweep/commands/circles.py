"""Makes a file of circles from a drawing of a device: DXF, GDSII, SVG, or a picture in black and white (a mask, a
micrograph).

    python3 -m clogsweep circles mask.gds --droplet 200um --output posts
    python3 -m clogsweep circles scan.png --pixel 2.5um --droplet 200um --output posts
    clogsweep obstacles=posts.csv box=... length=...      # as the command prints it

posts.csv lists the posts in micrometres, and the droplet's diameter. posts.png shows how the drawing was interpreted:
look at it before you run anything. An outline that contains everything else becomes the edge of the device; without
such an outline the edge is a box around the posts. Lines that meet are joined into outlines. Flat outlines and lines
along the sides become walls; other lines are red in the picture. Round posts become circles. Posts of other shapes,
such as triangles, are red, too. If there are such posts, posts.csv is written only with --as-rows, which replaces each
such post by rows of overlapping circles along its outline, or with --as-circles, which replaces it by a circle of the
same area.
"""

import argparse
import collections
import pathlib

import numpy as np

from ..device import areas, lines, readers, rows, shapes
from ..drawing import device_plan
from ..style import Picture
from ..tools import outputs, rounded
from ..tools.errors import UserError
from ..tools.hints import Numbers
from ..tools.texts import printable
from . import command_line

TURNS = {"right": 0, "down": 1, "left": 2, "up": 3}


def options() -> argparse.Namespace:
    parser = command_line.Parser(__doc__)
    parser.add_argument("drawing", type=pathlib.Path,
                        help="drawing to read (.dxf, .gds, .svg, .png, .tif, .bmp or .jpg)")
    command_line.add_output(parser, "name of the files: .csv, .png and .pdf are made", ".csv", ".png", ".pdf",
                            required=True)
    parser.add_argument("--droplet", required=True, help="diameter of the droplet with its unit, such as 200um")
    scale = parser.add_mutually_exclusive_group()
    scale.add_argument("--unit", choices=shapes.METRES, help="unit of a drawing that contains none")
    scale.add_argument("--pixel", help="size of a pixel of a picture with its unit, such as 2.5um")
    parser.add_argument("--layer", help="use only this layer of a DXF or GDSII file, in GDSII also with its datatype, "
                                        "such as 1/0 (all layers)")
    parser.add_argument("--cell", help="use this cell of a GDSII file, "
                                       "with all cells to which it refers (the top cells)")
    parser.add_argument("--holes", action="store_true",
                        help="the posts are holes in the drawn areas; their outer edge is that of the device")
    parser.add_argument("--posts", choices=("dark", "bright"),
                        help="whether the posts are dark or bright in the picture "
                             "(bright if the border and most of the area are dark, otherwise dark)")
    parser.add_argument("--region", type=region_of, help="x0,y0,x1,y1: use only this rectangle, "
                                                         "in the unit and coordinates that the drawing program shows")
    parser.add_argument("--flow", choices=TURNS, default="right", help="direction of the flow in the drawing (right)")
    parser.add_argument("--tolerance", type=command_line.between(0.001, 0.5, "a fraction of the radius"), default=0.04,
                        help="largest deviation of a post from a circle, as a fraction of its radius (0.04)")
    others = parser.add_mutually_exclusive_group()
    others.add_argument("--as-rows", action="store_true",
                        help="replace posts that are not round by rows of circles along their outlines")
    others.add_argument("--as-circles", action="store_true",
                        help="replace posts that are not round by circles of the same area")
    parser.add_argument("--corner", type=command_line.between(0.01, 1, "a radius in droplet diameters"), default=0.05,
                        help="with --as-rows: radius of rounded corners, in droplet diameters (0.05)")
    return parser.parse_args()


def region_of(text: str) -> Numbers:
    """Two corners, from x0,y0,x1,y1."""
    try:
        corners = np.array([float(number) for number in text.split(",")]).reshape(2, 2)
    except ValueError:
        corners = np.zeros((2, 2))
    if not np.isfinite(corners).all() or (corners[0] == corners[1]).any():
        raise argparse.ArgumentTypeError(f"invalid value: {text} (must be x0,y0,x1,y1: two opposite corners)")
    return corners


def metres_of(arguments: argparse.Namespace, drawing: shapes.Drawing) -> float:
    """Metres per unit of the drawing. @throws UserError"""
    if drawing.metres and arguments.unit == drawing.unit:
        return drawing.metres
    if arguments.pixel or arguments.unit:
        if arguments.pixel:
            metres = shapes.length_in_metres(arguments.pixel, "--pixel")
        else:
            metres = shapes.METRES[arguments.unit]
        refuse_other_unit(arguments, drawing, metres)
        return metres
    if drawing.metres is None:
        what = "--pixel, such as --pixel 2.5um" if drawing.is_picture else "--unit, such as --unit um"
        raise UserError(f"{arguments.drawing} does not say how long its unit is; give {what}{drawing.unit_hint}")
    return drawing.metres


def refuse_other_unit(arguments: argparse.Namespace, drawing: shapes.Drawing, metres: float) -> None:
    """@param metres  length of the unit that the user gave. @throws UserError  if the drawing has another unit"""
    if drawing.metres is None or np.isclose(metres, drawing.metres, rtol=1e-6, atol=0):
        return
    option = f"--pixel {arguments.pixel}" if arguments.pixel else f"--unit {arguments.unit}"
    raise UserError(f"{option} contradicts {arguments.drawing} (the drawing says {drawing.unit}); "
                    f"run without {option}, or correct the unit in the drawing")


def remedy_of_unit(arguments: argparse.Namespace) -> str:
    """The remedy for wrong lengths."""
    if arguments.pixel or arguments.unit:
        return f"check {'--pixel' if arguments.pixel else '--unit'}"
    return "correct the unit in the drawing (of DXF $INSUNITS)"


def unit_in_words(arguments: argparse.Namespace, drawing: shapes.Drawing) -> str:
    return str(arguments.pixel or arguments.unit or drawing.unit)


def call_of(device: shapes.Device, drawing: shapes.Drawing, output: pathlib.Path) -> str:
    """The command that starts a sweep of the device. The border of a picture or of a region is no wall. Posts repeat
    along the flow, so the entrance and the exit of a long device are one droplet diameter inside its ends."""
    walls = "" if drawing.frame and len(device.walls) < 2 else "side-walls=on "
    inset = 1 if device.length >= 4 else 0
    ends = f"entrance={inset} exit={device.length - inset:.6g}" if inset else f"exit={device.length:.6g}"
    return (f"clogsweep obstacles={output}.csv box={device.width:.6g} length={device.length:.6g} "
            f"{walls}release=entrance {ends} ...")


def description(device: shapes.Device, drawing: shapes.Drawing, metres: float) -> list[str]:
    """Lines that describe the content of the drawing."""
    if drawing.frame and not drawing.is_picture:
        edge = "the region"
    elif device.has_frame:
        edge = "its own edge"
    else:
        edge = "between its walls" if len(device.walls) == 2 else "no edge is drawn"
    micrometres = device.droplet_micrometres
    words = [f"{rounded.count_text(device.num_posts(), 'post')}, "
             f"device {device.length:.4g} x {device.width:.4g} droplet diameters ({edge})"]
    if len(device.circles):
        diameters = device.circles[:, 2]
        gaps = [("smallest gap", device.smallest_gap()),
                ("to a side", device.gap_to_sides() if device.has_frame or device.walls else np.inf)]
        gap = "".join(f", {name} {gap:.4g} ({gap * micrometres:.4g} um)" for name, gap in gaps if np.isfinite(gap))
        words.append(f"diameters of circles {diameters.min():.4g} to {diameters.max():.4g}{gap}, in droplet diameters")
    if drawing.frame and len(device.walls) < 2:
        words.append("the border is no wall in the command below, so the posts repeat across the flow; "
                     "add side-walls=on if there are walls")
    if not device.has_frame and len(device.walls) < 2:
        words.append("no edge is drawn: the device ends half a droplet diameter beyond the posts"
                     + (", or where a wall ends" if device.walls else
                        " on every side; leave out side-walls=on if it has no walls"))
    if number := len(device.walls):
        are = ("outline or line extends along the whole device and is taken for a wall" if number == 1 else
               "outlines or lines extend along the whole device and are taken for walls")
        words.append(f"{number} {are}: side-walls=on")
    return [*words, summary(device, drawing, metres)]


def summary(device: shapes.Device, drawing: shapes.Drawing, metres: float) -> str:
    """One line: what was read, joined, united, ignored, skipped and scaled."""
    words = [f"read {rounded.count_text(drawing.objects, 'object')}", *drawing.notes]
    if len(drawing.layers) > 1:
        words.append("layers " + ", ".join(f"{name} ({count})" for name, count in sorted(drawing.layers.items())))
    for (number, result), verb in ((drawing.joined, "closed"), (drawing.united, "that touch united")):
        what = rounded.count_text(number, "line" if verb == "closed" else "outline")
        words += [f"{what} {verb} into {rounded.count_text(result, 'outline')}"] if number else []
    words += [f"{rounded.count_text(drawing.duplicates, 'duplicate')} ignored"] if drawing.duplicates else []
    words += [f"{drawing.outside} outside the region"] if drawing.outside else []
    own = metres * float(np.hypot(*np.diff(drawing.from_own([(0, 0), (1, 0)]), axis=0)[0]))
    scale = (f"1 {'pixel' if drawing.is_picture else 'unit'} is {own / shapes.METRES['um']:.6g} um, "
             f"{own / device.droplet_metres:.6g} droplet diameters")
    return "; ".join([*words, *skipped(device, drawing), scale])


def skipped(device: shapes.Device, drawing: shapes.Drawing) -> list[str]:
    """Describes the unused parts of the drawing, with remedies."""
    counts = collections.Counter(drawing.skipped)
    counts.update(kind for kind, _ in device.lines)
    if not counts:
        return []
    names = ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items()))
    install = "" if drawing.can_join else ", or install python3-shapely, which joins lines"
    remedy = (f" (lines red in the picture; draw closed outlines{install}; "
              "straight walls at both sides are side-walls=on)") if device.lines else ""
    return [f"skipped: {names}{remedy}"]


def in_rows(device: shapes.Device, radius: float) -> tuple[shapes.Device, list[str]]:
    """@return the device with rows of circles, and their deviation from the outlines, in words"""
    number = len(device.others)
    found = rows.as_rows(device, radius)
    micrometres = device.droplet_micrometres
    are_cut = found.farthest > 2 * found.corner
    advice = "; thin parts are cut off, and a smaller --corner keeps more of them" if are_cut else ""
    return found.device, [f"{rounded.count_text(number, 'post')} not round (red lines) "
                          f"as {rounded.count_text(len(found.device.circles) - len(device.circles), 'circle')} "
                          f"in rows: corners lose {found.farthest:.2g} at most "
                          f"({found.farthest * micrometres:.2g} um), "
                          f"walls are rough by {found.roughness:.2g}, in droplet diameters{advice}"]


def named_slender(device: shapes.Device) -> list[str]:
    """Names the slender outlines that will become posts, because scale bars and labels would become posts, too."""
    found = shapes.slender(device.others)
    places = ", ".join(f"x={x:.5g} um, y={y:.5g} um"
                       for x, y in (outline.mean(axis=0) * device.droplet_micrometres for outline in found[:3]))
    more = f", and {len(found) - 3} more" if len(found) > 3 else ""
    are = "is" if len(found) == 1 else "are"
    return [f"{rounded.count_text(len(found), 'post')} {are} at least three times as long as wide, at {places}{more}; "
            "if this is a scale bar or a label, cut it away by --region or in the drawing"] if found else []


def remedy_of_touching(device: shapes.Device, pairs: list[tuple[int, int]], are_holes_read: bool) -> str:
    """The remedy for posts that touch. Two circles, one within the other, are the drawing of a ring."""
    one, other = (device.circles[[pair[side] for pair in pairs]] for side in (0, 1))
    is_within = np.hypot(*(one - other)[:, :2].T) <= np.abs(one - other)[:, 2] / 2
    if not is_within.any():
        return "Separate them in the drawing"
    holes = "" if are_holes_read else ", or give --holes if the posts are the holes of drawn areas"
    separate = "" if is_within.all() else "; separate the others"
    return (f"{int(is_within.sum())} of them {'is' if is_within.sum() == 1 else 'are'} one outline within another, "
            f"as a ring has: remove the inner one in the drawing{holes}{separate}")


def body() -> int:
    arguments = options()
    droplet = shapes.length_in_metres(arguments.droplet, "--droplet")
    table = pathlib.Path(f"{arguments.output}.csv")
    outputs.refuse_unwritable_picture(arguments.output, arguments.drawing)
    outputs.refuse_unwritable(table, "csv", arguments.drawing)
    drawing = readers.read(arguments.drawing, arguments.layer, arguments.posts, arguments.cell, arguments.holes)
    if arguments.holes and drawing.is_picture:
        raise UserError("no place for --holes (the drawing is a picture); "
                        "--posts bright or dark chooses the posts of a picture")
    lines.join(drawing)
    areas.tidy(drawing, arguments.region, arguments.tolerance, arguments.holes)
    metres = metres_of(arguments, drawing)
    device = shapes.understood(drawing, metres, droplet, arguments.tolerance, TURNS[arguments.flow])
    shapes.refuse_unlikely(device, unit_in_words(arguments, drawing), metres, remedy_of_unit(arguments),
                           drawing.is_picture)
    made = named_slender(device) if arguments.as_rows or arguments.as_circles else []
    if arguments.as_rows and device.others:
        device, deviations = in_rows(device, arguments.corner)
        made += deviations
    if arguments.as_circles:
        shapes.refuse_swallowed(drawing, [outline for outline, _ in drawing.swallowing])
        device = shapes.as_circles(device)
    picture = Picture(device_plan.understood(device, arguments.drawing.name),
                      f"python3 -m clogsweep circles {arguments.drawing}")
    command_line.tell(f"{picture.save(arguments.output)} (and .pdf)")
    command_line.tell("\n".join(description(device, drawing, metres) + made))
    if device.others:
        uneven = "; if the picture is lit unevenly, even it out and make it black and white first"
        light = uneven if drawing.is_picture else ""
        raise UserError(f"{rounded.count_text(len(device.others), 'post')} of "
                        f"{len(device.others) + len(device.circles)} not round, red in the picture; no {table} "
                        "was written. Use --as-rows for rows of circles along their outlines, "
                        "--as-circles for circles of the same area, or a larger --tolerance; "
                        "cut scale bars and labels away with --region or in the drawing, "
                        f"because these options make posts of them, too{light}")
    if touching := device.overlaps():
        x, y, _ = device.circles[touching[0][0]]
        micrometres = device.droplet_micrometres
        raise UserError(f"{rounded.count_text(len(touching), 'pair')} of posts touch, the first at x={x:.4g}, "
                        f"y={y:.4g} in droplet diameters "
                        f"({x * micrometres:.5g} um, {y * micrometres:.5g} um from the device's lower left corner); "
                        f"no {table} was written. {remedy_of_touching(device, touching, arguments.holes)}")
    centres = device.circles[:, :2]
    outside = device.circles[np.any((centres < 0) | (centres >= (device.length, device.width)), axis=1)]
    if len(outside):
        raise UserError(f"{rounded.count_text(len(outside), 'post')} with the centre outside the edge of the device; "
                        f"no {table} was written. Draw a wider edge, cut these posts away, or choose another --region")
    with outputs.replaced(table) as fresh:
        fresh.write_text(shapes.csv_of(device, printable(f"{arguments.drawing.name}, by clogsweep")), encoding="utf-8")
    command_line.tell(f"{table}\n{call_of(device, drawing, arguments.output)}")
    return 0
