"""Photographs that packages carry, in grey: PyPI's scikit-image, and Debian's wallpapers where they are installed."""
import pathlib

import cv2
import numpy

SKIMAGE = ["astronaut.png", "camera.png", "chelsea.png", "coffee.png", "rocket.jpg", "brick.png", "grass.png", "gravel.png",
           "motorcycle_left.png", "motorcycle_right.png", "coins.png", "page.png", "text.png", "color.png"]
# Debian: lomiri-wallpapers-16.04, mate-backgrounds, plasma-workspace-wallpapers.
FOLDERS = ["/usr/share/backgrounds", "/usr/share/backgrounds/mate/nature", "/usr/share/backgrounds/mate/abstract",
           "/usr/share/wallpapers"]
LARGEST = 2400


def files(all_of_them=False):
    """The photographs' paths, each picture once: scikit-image's, or all that are installed."""
    import skimage.data

    folder = pathlib.Path(skimage.data.__file__).parent
    paths = [folder / name for name in SKIMAGE if (folder / name).exists()]
    seen = set()
    for directory in map(pathlib.Path, FOLDERS if all_of_them else []):
        pattern = "*/contents/images/*.jpg" if directory.name == "wallpapers" else "*.jpg"
        for path in sorted(directory.glob(pattern)):
            real = path.resolve()
            # Plasma's wallpapers are links of many sizes to one file.
            if real not in seen and real.stat().st_size < 6_000_000:
                seen.add(real)
                paths.append(path)
    return paths


def load(paths):
    """The photographs, at most 2400 pixels wide and at least 640 x 480."""
    pictures = []
    for path in paths:
        picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        if picture is None:
            continue
        height, width = picture.shape
        scale = min(1.0, LARGEST / width)
        scale = max(scale, 640 / width, 480 / height)
        if scale != 1.0:
            how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
            picture = cv2.resize(picture, (max(640, round(width * scale)), max(480, round(height * scale))), interpolation=how)
        pictures.append(picture)
    return pictures


def crop(random, picture, width, height):
    """A piece of a photograph, at a random scale and place, mirrored half of the time."""
    rows, columns = picture.shape
    most = min(columns / width, rows / height)
    scale = random.uniform(1.0, most) if most > 1 else most
    w, h = int(width * scale), int(height * scale)
    x, y = random.integers(0, columns - w + 1), random.integers(0, rows - h + 1)
    piece = cv2.resize(picture[y : y + h, x : x + w], (width, height), interpolation=cv2.INTER_AREA)
    return numpy.ascontiguousarray(piece[:, ::-1] if random.integers(2) else piece)
