#!/usr/bin/env python3
"""Compares lines with Pillow's, and with scikit-image's where that is installed.

    lines.py FILE       FILE holds a line each: "x0 y0 x1 y1: x,y x,y ..." (pixels in any order, each once)
    lines.py --check    only says whether Pillow is there

Both draw textbook Bresenham and step when 2e >= major, in the direction in which they are asked; we ask in the direction of
increasing major coordinate. Exit code: 0 all equal, 1 some differ, 2 unreadable, 77 Pillow is not installed.
"""

import sys

try:
    from PIL import Image, ImageDraw, __version__ as pillow_version
except ImportError:
    print("SKIPPED: Pillow not found; install pillow (PyPI) or python3-pil (Debian)", file=sys.stderr)
    sys.exit(77)

try:
    from skimage.draw import line as skimage_line
except ImportError:
    skimage_line = None


def canonical(x0, y0, x1, y1):
    """The ends in the order of increasing major coordinate."""
    key = (lambda p: p[1]) if abs(y1 - y0) > abs(x1 - x0) else (lambda p: p[0])
    first, second = (x0, y0), (x1, y1)
    return (second, first) if key(second) < key(first) else (first, second)


def by_pillow(first, second):
    """The set of pixels that ImageDraw.line draws, on an image with a margin of one pixel."""
    left, top = (min(a, b) - 1 for a, b in zip(first, second))
    width, height = (abs(a - b) + 3 for a, b in zip(first, second))
    image = Image.new("L", (width, height))
    ends = [(x - left, y - top) for x, y in (first, second)]
    ImageDraw.Draw(image).line(ends, fill=255)
    return {(i % width + left, i // width + top) for i, value in enumerate(image.tobytes()) if value}


def by_skimage(first, second):
    """The set of pixels of skimage.draw.line."""
    rows, columns = skimage_line(first[1], first[0], second[1], second[0])
    return set(zip(map(int, columns), map(int, rows)))


def main(path):
    judges = {"Pillow " + pillow_version: by_pillow}
    if skimage_line:
        judges["scikit-image"] = by_skimage
    count, wrong = 0, 0
    with open(path, encoding="ascii") as file:
        for text in file:
            ends, _, listed = text.partition(":")
            ends = canonical(*map(int, ends.split()))
            pixels = [tuple(map(int, pixel.split(","))) for pixel in listed.split()]
            count += 1
            for name, judge in judges.items():
                expected = judge(*ends)
                if set(pixels) != expected or len(pixels) != len(expected):
                    wrong += 1
                    extra, missing = set(pixels) - expected, expected - set(pixels)
                    print(f"{ends[0]} - {ends[1]}: {name} disagrees: extra {sorted(extra)}, missing {sorted(missing)}")
    print(f"{count} lines against {' and '.join(judges)}: {wrong} differ")
    return 1 if wrong or not count else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    if sys.argv[1] == "--check":
        sys.exit(0)
    sys.exit(main(sys.argv[1]))
