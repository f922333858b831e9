"""Images that maps are drawn in: every form of PNG and PGM is the same picture."""

import io
import struct
import zlib

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from pin_metaik.errors import InvalidGeometry
from pin_metaik.mobile.world.images import read_image

GREYS = np.array([[0, 51, 205, 254, 255], [255, 128, 127, 1, 0], [100, 205, 0, 255, 13]])
BYTES = GREYS.astype(np.uint8)
BLACK_AND_WHITE = np.where(GREYS > 127, 255, 0)


def png(pixels: np.ndarray, depth: int, colour: int, *chunks: tuple[bytes, bytes], interlaced: bool = False) -> bytes:
    """A PNG written by hand: pixels (rows, columns, channels) in `depth` bits, 8 or 16; colour 0 grey, 2 RGB, 4, 6."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    def lines(part: np.ndarray) -> bytes:
        kind = ">u2" if depth == 16 else "u1"
        return b"".join(b"\0" + row.astype(kind).tobytes() for row in part) if part.size else b""

    rows, columns = pixels.shape[:2]
    passes = [(0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1)]  # Adam7
    parts = [pixels[y::dy, x::dx] for y, x, dy, dx in passes] if interlaced else [pixels]
    head = struct.pack(">IIBBBBB", columns, rows, depth, colour, 0, 0, int(interlaced))
    data = zlib.compress(b"".join(map(lines, parts)))
    inside = [(b"IHDR", head), *chunks, (b"IDAT", data), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*each) for each in inside)


def saved(image: Image.Image, form: str = "PNG") -> bytes:
    held = io.BytesIO()
    image.save(held, form)
    return held.getvalue()


def palette(greys: np.ndarray) -> Image.Image:
    """Indices into a palette that runs backwards."""
    image = Image.fromarray((255 - greys).astype(np.uint8))
    image.putpalette([255 - i // 3 for i in range(768)])
    return image


OPAQUE = np.full((*GREYS.shape, 1), 255)
RGB = np.repeat(GREYS[:, :, None], 3, axis=2)
PLAIN = "\n".join(" ".join(map(str, row)) for row in GREYS)
COMMENTED = "51 # three\n"

SAME = {  # file: the picture of GREYS
    "grey.png": png(GREYS[:, :, None], 8, 0),
    "grey_alpha.png": png(np.dstack((GREYS, OPAQUE)), 8, 4),
    "rgb.png": png(RGB, 8, 2),
    "rgba.png": png(np.dstack((RGB, OPAQUE)), 8, 6),
    "palette.png": saved(palette(GREYS)),
    "grey16.png": png(GREYS[:, :, None] * 257, 16, 0),
    "grey_alpha16.png": png(np.dstack((GREYS, OPAQUE)) * 257, 16, 4),
    "rgb16.png": png(RGB * 257, 16, 2),
    "rgba16.png": png(np.dstack((RGB, OPAQUE)) * 257, 16, 6),
    "interlaced.png": png(GREYS[:, :, None], 8, 0, interlaced=True),
    "interlaced_rgb.png": png(RGB, 8, 2, interlaced=True),
    "grey.bmp": saved(Image.fromarray(BYTES), "BMP"),
    "grey.tif": saved(Image.fromarray(BYTES), "TIFF"),
    "raw.pgm": b"P5\n5 3\n255\n" + BYTES.tobytes(),
    "commented.pgm": b"P5 # CREATOR: map_saver 0.050 m/pix\n# two\n5 # columns\n3\n#rows\n255\n" + BYTES.tobytes(),
    "glued.pgm": b"P5\n5 3#rows\n255#the largest\n" + BYTES.tobytes(),
    "one_line.pgm": b"P5 5 3 255 " + BYTES.tobytes(),
    "raw16.pgm": b"P5\n5 3\n65535\n" + (GREYS * 257).astype(">u2").tobytes(),
    "plain.pgm": f"P2\n5 3\n255\n{PLAIN}\n".encode(),
    "plain_commented.pgm": f"P2\n# one\n5 3 # two\n255\n{PLAIN.replace('51', COMMENTED)}\n".encode(),
    "plain_one_number_a_line.pgm": f"P2\n5\n3\n255\n{PLAIN}".replace(" ", "\n").encode(),
    "windows.pgm": f"P2\r\n# one\r\n5 3\r\n255\r\n{PLAIN}".encode(),
    "grey.ppm": b"P6\n5 3\n255\n" + RGB.astype(np.uint8).tobytes(),
}


@pytest.mark.parametrize("name", SAME)
def test_one_picture_is_the_same_in_every_form(tmp_path, name):
    (tmp_path / name).write_bytes(SAME[name])
    pixels = read_image(tmp_path / name)
    assert_allclose(pixels.lightness, GREYS / 255, atol=1e-12)
    assert pixels.opacity is None or (pixels.opacity == 1).all()
    assert (pixels.opacity is not None) == ("alpha" in name or "rgba" in name)


@pytest.mark.parametrize("name", ["one_bit.png", "raw.pbm"])
def test_one_bit_a_pixel_is_black_and_white(tmp_path, name):
    image = Image.fromarray(BLACK_AND_WHITE.astype(np.uint8)).convert("1")
    (tmp_path / name).write_bytes(saved(image, "PNG" if name.endswith("png") else "PPM"))
    assert_allclose(read_image(tmp_path / name).lightness, BLACK_AND_WHITE / 255, atol=0)


def test_sixteen_bits_are_not_cut_to_eight(tmp_path):
    deep = np.array([[0, 1, 32767, 65534, 65535]])
    (tmp_path / "deep.png").write_bytes(png(deep[:, :, None], 16, 0))
    (tmp_path / "deep.pgm").write_bytes(b"P5 5 1 65535\n" + deep.astype(">u2").tobytes())
    for name in ("deep.png", "deep.pgm"):
        assert_allclose(read_image(tmp_path / name).lightness, deep / 65535, atol=1e-15)


def test_a_largest_value_of_ones_own_is_white(tmp_path):
    (tmp_path / "map.pgm").write_text("P2 3 1 100\n0 50 100\n")
    assert_allclose(read_image(tmp_path / "map.pgm").lightness, [[0, 0.5, 1]], atol=0)


TRANSPARENT = {  # file: GREYS in which some are transparent, and where
    "alpha.png": png(np.dstack((GREYS, np.where(GREYS == 205, 0, 255))), 8, 4),
    "rgba.png": png(np.dstack((RGB, np.where(GREYS == 205, 0, 255))), 8, 6),
    "key.png": png(GREYS[:, :, None], 8, 0, (b"tRNS", b"\0\xcd")),
    "key_rgb.png": png(RGB, 8, 2, (b"tRNS", b"\0\xcd\0\xcd\0\xcd")),
    "key16.png": png(GREYS[:, :, None] * 257, 16, 0, (b"tRNS", b"\xcd\xcd")),
}


@pytest.mark.parametrize("name", TRANSPARENT)
def test_transparency_is_read_in_every_form(tmp_path, name):
    (tmp_path / name).write_bytes(TRANSPARENT[name])
    pixels = read_image(tmp_path / name)
    assert pixels.opacity is not None
    assert_allclose(pixels.opacity, GREYS != 205, atol=0)
    assert_allclose(pixels.lightness, GREYS / 255, atol=1e-12)


def test_a_palette_may_hold_transparent_colours(tmp_path):
    image = palette(GREYS)
    image.save(tmp_path / "map.png", transparency=255 - 205)
    pixels = read_image(tmp_path / "map.png")
    assert pixels.opacity is not None
    assert_allclose(pixels.opacity, GREYS != 205, atol=0)
    assert_allclose(pixels.lightness, GREYS / 255, atol=1e-12)


WRONG = {  # file: what is said
    "empty.png": (b"", "is not an image: a map is a PGM, a PNG"),
    "text.png": (b"hello", "is not an image"),
    "cut.png": (SAME["rgb.png"][:-30], "cannot be read as an image, or ends early"),
    "magic.pgm": (b"P5", "after P2 or P5 come its columns, rows and largest value"),
    "words.pgm": (b"P5 five 3 255 ", "after P2 or P5 come"),
    "negative.pgm": (b"P5 -5 3 255 ", "after P2 or P5 come"),
    "nothing.pgm": (b"P5 0 3 255 ", "after P2 or P5 come"),
    "flat.pgm": (b"P5 1 1 0 \0", "after P2 or P5 come"),
    "deep.pgm": (b"P5 1 1 65536 \0", "after P2 or P5 come"),
    "huge.pgm": (b"P5 999999999 999999999 255 \0", "ends early: 1 pixels"),
    "cut.pgm": (SAME["raw.pgm"][:-1], "ends early: 14 pixels for 5 x 3"),
    "cut16.pgm": (SAME["raw16.pgm"][:-1], "ends early: 14 pixels for 5 x 3"),
    "short.pgm": (b"P2 2 1 255\n0", "ends early: 1 pixels for 2 x 1"),
    "nan.pgm": (b"P2 2 1 255\n0 nan", "its pixels are numbers from 0 on"),
    "minus.pgm": (b"P2 2 1 255\n0 -1", "its pixels are numbers from 0 on"),
    "letters.pgm": (b"P2 2 1 255\n0 a", "is not a PGM image"),
    "floats.tif": (saved(Image.fromarray(np.eye(2, dtype=np.float32)), "TIFF"), "save it with 8 or 16 bits"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_no_image_is_named(tmp_path, name):
    content, said = WRONG[name]
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InvalidGeometry, match=said) as error:
        read_image(tmp_path / name)
    assert name in str(error.value)


def test_a_folder_and_a_missing_file_are_named(tmp_path):
    for path in (tmp_path, tmp_path / "gone.png"):
        with pytest.raises(InvalidGeometry, match="cannot read"):
            read_image(path)
