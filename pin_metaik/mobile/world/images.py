"""Pixels of images, as maps are drawn: PGM without help, everything else (PNG, BMP, TIFF ...) with Pillow."""

from __future__ import annotations

import re
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidGeometry
from pin_metaik.files import read_bytes
from pin_metaik.lookup import need

COMMENT = re.compile(rb"#[^\r\n]*")
BETWEEN = rb"(?:\s|#[^\r\n]*[\r\n])+"
HEADER = re.compile(rb"P[25]" + 2 * (BETWEEN + rb"(\d{1,9})") + BETWEEN + rb"(\d{1,9})(?:\s|#[^\r\n]*[\r\n])")
DEEPEST = 65535  # the largest value of 16 bits
MOST = 1 << 24  # numbers that pixels are unpacked to: a small file may say that it has billions
GREY = ("1", "L", "I", "I;16", "I;16B", "I;16L", "F")
FORMATS = ("PNG", "BMP", "TIFF", "GIF", "JPEG", "JPEG2000", "WEBP", "PPM", "PCX", "TGA", "ICO", "SGI")
"""Forms of images that are read: not those, as PostScript, that another program is run for."""


@dataclass(frozen=True, eq=False)
class Pixels:
    """An image, row 0 the highest.

    Attributes:
        colours: Lightness of the channels (rows, columns, c) from 0, black, to 1: c is 1 for grey, 3 for red, green and
            blue.
        opacity: From 0, transparent, to 1 (rows, columns); None if the image has none.
    """

    colours: Array
    opacity: Array | None = None

    @property
    def lightness(self) -> Array:
        """Mean of the channels (rows, columns)."""
        return np.asarray(self.colours.mean(axis=2))


def read_image(path: Path) -> Pixels:
    """The pixels of an image.

    Raises:
        InvalidGeometry: The file is missing or no image.
        MissingExtra: It needs Pillow, which is not installed.
    """
    data = read_bytes(path, InvalidGeometry)
    if data[:2] in (b"P2", b"P5"):
        return Pixels(read_pgm(data, path)[:, :, None])
    need(f"reading {path}", "mobile", "PIL")
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(BytesIO(data), formats=FORMATS) as image:  # which has no bytes that it only says it has
            if image.width * image.height * (1 if image.mode in GREY else 4) > MOST:
                raise ValueError(
                    f"{image.width} x {image.height} pixels are too many: at most {MOST:,} grey ones are read"
                )
            return _pixels(image)
    except UnidentifiedImageError:
        raise InvalidGeometry(
            f"{path} is not an image: a map is a PGM, a PNG or another format that Pillow reads"
        ) from None
    except Exception as reason:  # a damaged file makes each of Pillow's readers stumble in its own way
        raise InvalidGeometry(f"{path} cannot be read as an image, or ends early: {reason}") from None


def _pixels(image: Any) -> Pixels:
    """The pixels of Pillow's image: palettes as their colours, 16 bits as 16 bits."""
    if image.mode == "F":
        raise ValueError("its pixels are floating-point numbers; save it with 8 or 16 bits")
    if image.mode.startswith("I"):
        grey, clear = np.asarray(image, dtype=float), image.info.get("transparency")
        return Pixels(grey[:, :, None] / DEEPEST, None if clear is None else (grey != clear).astype(float))
    if image.mode in ("1", "L") and "transparency" not in image.info:
        return Pixels(np.asarray(image.convert("L"), dtype=float)[:, :, None] / 255)
    if image.mode == "RGB" and "transparency" not in image.info:
        return Pixels(np.asarray(image, dtype=float) / 255)
    opaque = image.mode in ("CMYK", "YCbCr", "HSV", "LAB") or (image.mode == "P" and "transparency" not in image.info)
    if opaque:
        return Pixels(np.asarray(image.convert("RGB"), dtype=float) / 255)
    channels = np.asarray(image.convert("RGBA"), dtype=float) / 255
    return Pixels(channels[:, :, :3], channels[:, :, 3])


def read_pgm(data: bytes, path: Path) -> NDArray[np.float64]:
    """Lightness (rows, columns) from 0 (black) to 1 of a PGM image, plain (P2) or raw (P5), row 0 the highest.

    Args:
        data: Contents of the file.
        path: The file, for messages.

    Raises:
        InvalidGeometry: It is not a PGM image.
    """
    header = HEADER.match(data)
    columns, rows, maximum = map(int, header.groups()) if header else (0, 0, 0)
    if header is None or min(columns, rows, maximum) < 1 or maximum > DEEPEST:
        raise InvalidGeometry(f"{path} is not a PGM image: after P2 or P5 come its columns, rows and largest value")
    held = data[header.end() :]
    if data[:2] == b"P2":
        pixels = _plain(held, path)
    else:
        deep = np.dtype(np.uint8 if maximum < 256 else ">u2")
        pixels = np.frombuffer(held, deep, min(rows * columns, len(held) // deep.itemsize)).astype(float)
    if pixels.size < rows * columns:
        raise InvalidGeometry(f"{path} ends early: {pixels.size} pixels for {columns} x {rows}")
    return np.minimum(pixels[: rows * columns].reshape(rows, columns) / maximum, 1.0)


def _plain(text: bytes, path: Path) -> NDArray[np.float64]:
    """The numbers of a plain image, comments left out."""
    try:
        pixels = np.array(COMMENT.sub(b"", text).split(), dtype=float)
    except ValueError as reason:
        raise InvalidGeometry(f"{path} is not a PGM image: {reason}") from None
    if not (np.isfinite(pixels) & (pixels >= 0)).all():
        raise InvalidGeometry(f"{path} is not a PGM image: its pixels are numbers from 0 on")
    return pixels
