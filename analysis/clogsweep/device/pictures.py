"""Reads outlines from black-and-white pictures, such as masks."""

from __future__ import annotations

import collections
import pathlib
import re
from typing import Any

import numpy as np

from ..tools.errors import UserError
from ..tools.hints import Numbers
from .libraries import library
from .shapes import METRES, Drawing
from .walls import area

ENDINGS = (".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg")
FEWEST_CORNERS = 12  # Outlines with fewer corners are specks. The outline of three pixels has this many corners.
MOST_OF_BORDER = 0.95  # Posts may be bright only if at least this fraction of the picture's border is dark.
X_RESOLUTION, Y_RESOLUTION, RESOLUTION_UNIT, DESCRIPTION, PHOTOMETRIC = 282, 283, 296, 270, 262  # Tags of TIFF.
MODES = ("1", "L", "RGB", "RGBA")  # Modes of Pillow with up to 8 bits per channel.
ORIENTATION = 274  # Tag of EXIF and TIFF.
METRES_IN_TIFF = {2: METRES["in"], 3: METRES["cm"]}
UNITS_OF_IMAGEJ = {"micron": "um", "microns": "um", "\\u00b5m": "um", "inch": "in",
                   "centimeter": "cm", "millimeter": "mm"}


def read_picture(path: pathlib.Path, posts: str | None) -> Drawing:
    """Reads the outlines of the dark or the bright parts. Outlines run between pixels, and the unit of length is a
    pixel. Specks of a few pixels are excluded.
    @param posts  dark or bright. If None, posts are bright in two cases: the border and most of the picture are dark,
    or bright parts are on a transparent ground. Otherwise they are dark."""
    measure, filters = (library(f"skimage.{name}", "python3-skimage") for name in ("measure", "filters"))
    tags = tags_of(path)
    image = grey(path, tags)
    threshold = filters.threshold_otsu(image)
    is_dark = image <= threshold
    # half-way between dark and bright, so that outlines run between pixels.
    level = (image[is_dark].mean() + image[~is_dark].mean()) / 2
    found = Drawing([], [], metres_of(path, tags), frame=(0.0, 0.0, float(image.shape[1]), float(image.shape[0])),
                    is_picture=True, skipped=collections.Counter())
    found.unit_hint = printed(tags)
    high = image.shape[0]
    found.from_own = lambda points: np.array([0, high]) + np.asarray(points) * (1, -1)
    if posts is None:
        posts = "bright" if are_bright(is_dark) else "dark"
        found.notes.append(f"the posts are {posts} (--posts)")
    sign = 1 if posts == "bright" else -1
    for contour in measure.find_contours(sign * image, sign * level, positive_orientation="high"):
        outline = np.column_stack([contour[:, 1] + 0.5, high - contour[:, 0] - 0.5])
        if len(outline) < FEWEST_CORNERS:
            found.skipped["speck"] += 1
        elif np.allclose(outline[0], outline[-1]) and area(outline) < 0:
            found.skipped["hole"] += 1
        else:
            found.outlines.append(outline)
    return found


def are_bright(is_dark: Any) -> bool:
    """Whether posts are bright on a dark ground. A dark frame around a bright channel does not mean that posts are
    bright."""
    border = np.concatenate([is_dark[0], is_dark[-1], is_dark[:, 0], is_dark[:, -1]])
    return bool(border.mean() >= MOST_OF_BORDER and is_dark.mean() > 0.5)


def tags_of(path: pathlib.Path) -> dict[int, Any]:
    """The picture's TIFF and EXIF tags."""
    with library("PIL.Image", "python3-pil").open(path) as file:
        return {**file.getexif(), **getattr(file, "tag_v2", {})}


def grey(path: pathlib.Path, tags: dict[int, Any]) -> Numbers:
    """Brightness from 0 to 1. @throws UserError"""
    colour = library("skimage.color", "python3-skimage")
    image, is_inverted = pixels(path, tags)
    if tags.get(ORIENTATION, 1) != 1:
        raise UserError(f"cannot read {path} (it is stored turned, and shown upright by its EXIF data); "
                        "save it upright")
    if image.ndim not in (2, 3) or image.ndim == 3 and image.shape[2] > 4:
        raise UserError(f"cannot read {path} (it has several slices or channels, {' x '.join(map(str, image.shape))}); "
                        "save one slice as a picture of its own")
    full = 1.0 if image.dtype == bool else float(np.iinfo(image.dtype).max) if image.dtype.kind in "ui" else max(float(image.max()), 1e-300)
    image = np.asarray(image, dtype=float) / full
    if image.ndim == 3:
        opacity = image[..., -1] if image.shape[2] in (2, 4) else np.ones(image.shape[:2])
        image = colour.rgb2gray(image[..., :3]) if image.shape[2] >= 3 else image[..., 0]
        # Transparent parts get the opposite of the posts' brightness.
        ground = 1.0 if opacity.any() and image[opacity > 0].mean() < 0.5 else 0.0
        image = opacity * image + (1 - opacity) * ground
    if np.ptp(image) == 0:
        raise UserError(f"cannot read {path} (it is of one colour); give a mask in black and white")
    return 1 - image if is_inverted else image


def pixels(path: pathlib.Path, tags: dict[int, Any]) -> tuple[Any, bool]:
    """The pixels of a picture, and whether a value of 0 means white. TIFF files with LZW or fax compression are read
    with Pillow, because scikit-image would need another library for them. Pillow itself converts pictures in which 0
    means white.
    @throws UserError"""
    try:
        return np.asarray(library("skimage.io", "python3-skimage").imread(path)), tags.get(PHOTOMETRIC) == 0
    except ValueError as error:
        with library("PIL.Image", "python3-pil").open(path) as file:
            if file.mode not in MODES or getattr(file, "n_frames", 1) > 1:
                raise UserError(f"cannot read {path} ({error}); save it as PNG") from error
            return np.asarray(file), False


def metres_of(path: pathlib.Path, tags: dict[int, Any]) -> float | None:
    """The size of a pixel, if ImageJ has stored it. @throws UserError  if pixels are not square"""
    found = re.search(r"^unit=(\S+)", str(tags.get(DESCRIPTION, "")), re.MULTILINE)
    unit = UNITS_OF_IMAGEJ.get(found[1].lower(), found[1]) if found else ""
    horizontal, vertical = (float(tags.get(tag, 0)) for tag in (X_RESOLUTION, Y_RESOLUTION))
    if unit not in METRES or horizontal <= 0:
        return None
    if not np.isclose(horizontal, vertical, rtol=1e-4):
        raise UserError(f"cannot read {path} (its pixels are not square); scale it")
    return METRES[unit] / horizontal


def printed(tags: dict[int, Any]) -> str:
    """Words that give the size of a pixel according to the resolution of a TIFF. Often a TIFF has the resolution of a
    printer instead."""
    metres, number = METRES_IN_TIFF.get(tags.get(RESOLUTION_UNIT, 0), 0.0), float(tags.get(X_RESOLUTION, 0))
    return f" (its resolution would mean {metres / number * 1e6:.6g}um, if that is not a printer's)" if metres and number else ""
