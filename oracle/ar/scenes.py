"""Pictures of markers with a known pose over photographs, drawn with OpenCV and numpy.

Coordinates: pixel centres at .5 (the first pixel's centre is (0.5, 0.5)). A marker's own axes: x right, y up, z out of the
paper; the camera's: x right, y down, z forward. Sizes and distances in metres.
"""
import cv2
import numpy

FINE = 4  # samples a pixel and axis
TEXELS = 24  # a cell


class Camera:
    """Focal lengths and principal point in pixels, and OpenCV's k1, k2, p1, p2, k3."""

    def __init__(self, width=640, height=480, focal=600.0, centre=None, distortion=(0, 0, 0, 0, 0)):
        self.width, self.height, self.focal = width, height, focal
        self.centre = centre or (width / 2, height / 2)
        self.distortion = numpy.array(distortion, float)

    def matrix(self):
        """Intrinsics for pixel centres at .5."""
        return numpy.array([[self.focal, 0, self.centre[0]], [0, self.focal, self.centre[1]], [0, 0, 1.0]])

    def opencv(self):
        """Intrinsics for pixel centres at .0."""
        return self.matrix() - numpy.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])

    def project(self, points):
        """Points in the camera's axes, n x 3, to pixels, n x 2."""
        pixels, _ = cv2.projectPoints(numpy.asarray(points, float).reshape(-1, 1, 3), numpy.zeros(3), numpy.zeros(3),
                                      self.matrix(), self.distortion)
        return pixels.reshape(-1, 2)


def square(size):
    """Top left, top right, bottom right, bottom left of a marker, in its own axes."""
    h = size / 2
    return numpy.array([[-h, h, 0], [h, h, 0], [h, -h, 0], [-h, -h, 0]])


class Marker:
    """A printed marker with its pose."""

    def __init__(self, dictionary, number, size, rotation, translation, quiet=1.0):
        self.dictionary, self.number, self.size = dictionary, number, size
        self.rotation, self.translation, self.quiet = rotation, numpy.asarray(translation, float), quiet

    def in_camera(self, points):
        return numpy.asarray(points) @ self.rotation.T + self.translation

    def corners(self, camera):
        return camera.project(self.in_camera(square(self.size)))


def texture(dictionary, number, quiet):
    """The marker with `quiet` cells of paper around, TEXELS a cell, and its cells in a row."""
    cells = dictionary.markerSize + 2
    picture = dictionary.generateImageMarker(number, cells, borderBits=1)
    picture = numpy.kron(picture, numpy.ones((TEXELS, TEXELS), numpy.uint8))
    edge = round(quiet * TEXELS)
    return numpy.pad(picture, edge, constant_values=255), cells, edge


def paint(canvas, camera, marker, black=20.0, white=235.0):
    """Draws a marker on a canvas of floats; returns where its paper is."""
    picture, cells, edge = texture(marker.dictionary, marker.number, marker.quiet)
    half = marker.size / 2 * (1 + 2 * edge / TEXELS / cells)
    sheet = camera.project(marker.in_camera(square(half * 2)))
    low = numpy.maximum(numpy.floor(sheet.min(0)).astype(int) - 2, 0)
    high = numpy.minimum(numpy.ceil(sheet.max(0)).astype(int) + 2, [camera.width, camera.height])
    mask = numpy.zeros((camera.height, camera.width))
    if (high <= low).any():
        return mask
    (x0, y0), (x1, y1) = low, high
    # Rays through the fine samples of the box, then where they meet the paper.
    xs = (numpy.arange((x1 - x0) * FINE) + 0.5) / FINE + x0
    ys = (numpy.arange((y1 - y0) * FINE) + 0.5) / FINE + y0
    grid = numpy.stack(numpy.meshgrid(xs, ys), -1)
    if camera.distortion.any():
        flat = cv2.undistortPoints(grid.reshape(-1, 1, 2), camera.matrix(), camera.distortion, R=None, P=None,
                                   criteria=(cv2.TERM_CRITERIA_COUNT, 20, 1e-9)).reshape(grid.shape)
    else:
        flat = (grid - camera.centre) / camera.focal
    rays = numpy.concatenate([flat, numpy.ones(flat.shape[:2] + (1,))], -1)
    plane = numpy.stack([marker.rotation[:, 0], marker.rotation[:, 1], marker.translation], 1)
    met = rays @ numpy.linalg.inv(plane).T
    with numpy.errstate(divide="ignore", invalid="ignore"):
        u, v = met[..., 0] / met[..., 2], met[..., 1] / met[..., 2]
    scale = cells * TEXELS / marker.size
    column = (u + marker.size / 2) * scale + edge
    line = (marker.size / 2 - v) * scale + edge
    inside = (column >= 0) & (line >= 0) & (column < picture.shape[1]) & (line < picture.shape[0]) & (met[..., 2] > 0)
    # A fine sample covers several texels of a small marker: the mean over its footprint by a blurred picture.
    side = numpy.sqrt(abs(cv2.contourArea(sheet.astype(numpy.float32)))) + 1e-9
    footprint = picture.shape[0] / (side * FINE)
    source = picture.astype(numpy.float32)
    if footprint > 1.5:
        source = cv2.GaussianBlur(source, (0, 0), footprint / 3)
    grey = cv2.remap(source, (column - 0.5).astype(numpy.float32), (line - 0.5).astype(numpy.float32), cv2.INTER_LINEAR,
                     borderMode=cv2.BORDER_REPLICATE)
    grey = black + grey / 255 * (white - black)
    shape = (y1 - y0, FINE, x1 - x0, FINE)
    part = inside.astype(float).reshape(shape).mean((1, 3))
    value = (grey * inside).reshape(shape).mean((1, 3))
    box = canvas[y0:y1, x0:x1]
    canvas[y0:y1, x0:x1] = box * (1 - part) + value
    mask[y0:y1, x0:x1] = part
    return mask


def rotation(random, tilt):
    """A marker turned anyhow in its plane and tilted by `tilt` radians away from the camera, any direction."""
    spin, axis = random.uniform(0, 2 * numpy.pi, 2)
    facing = numpy.diag([1.0, -1.0, -1.0])
    turn, _ = cv2.Rodrigues(numpy.array([0, 0, spin]))
    lean, _ = cv2.Rodrigues(tilt * numpy.array([numpy.cos(axis), numpy.sin(axis), 0]))
    return lean @ facing @ turn


def place(random, camera, dictionary, number, side, tilt, others, size=0.08):
    """A marker whose side appears about `side` pixels long if seen front-on, apart from the others; None if there is no room."""
    for _ in range(60):
        distance = camera.focal * size / side
        margin = side * 0.75 + 3
        if 2 * margin >= min(camera.width, camera.height):
            margin = min(camera.width, camera.height) * 0.45
        x = random.uniform(margin, camera.width - margin)
        y = random.uniform(margin, camera.height - margin)
        at = distance * numpy.array([(x - camera.centre[0]) / camera.focal, (y - camera.centre[1]) / camera.focal, 1])
        # Tilted away from the line of sight, not from the camera's axis.
        ray = at / numpy.linalg.norm(at)
        swing, _ = cv2.Rodrigues(numpy.cross([0, 0, 1.0], ray) * numpy.arcsin(min(1, numpy.hypot(ray[0], ray[1])))
                                 / max(1e-9, numpy.hypot(ray[0], ray[1])))
        marker = Marker(dictionary, number, size, swing @ rotation(random, tilt), at)
        edge = marker.in_camera(square(size * (1 + 2.6 / (dictionary.markerSize + 2))))
        if (edge[:, 2] < size / 10).any():
            continue
        box = camera.project(edge)
        if box.min() < 1 or box[:, 0].max() > camera.width - 1 or box[:, 1].max() > camera.height - 1:
            continue
        middle, reach = box.mean(0), numpy.linalg.norm(box - box.mean(0), axis=1).max()
        if all(numpy.linalg.norm(middle - m) > reach + r for m, r in others):
            others.append((middle, reach))
            return marker
    return None


# ------------------------------------------------------------------------------------------------- what happens to a picture


def uneven_light(random, picture):
    height, width = picture.shape
    angle, depth = random.uniform(0, 2 * numpy.pi), random.uniform(0.5, 0.8)
    x, y = numpy.meshgrid(numpy.linspace(-1, 1, width), numpy.linspace(-1, 1, height))
    slope = (x * numpy.cos(angle) + y * numpy.sin(angle)) / 1.5
    spot = numpy.exp(-((x - random.uniform(-1, 1)) ** 2 + (y - random.uniform(-1, 1)) ** 2) * 3)
    return picture * (1 - depth * (0.5 + 0.5 * slope)) + 60 * spot * (picture / 255)


def motion(random, picture, length):
    angle = random.uniform(0, numpy.pi)
    kernel = numpy.zeros((63, 63))
    steps = numpy.linspace(-length / 2, length / 2, 8 * int(numpy.ceil(length)) + 1)
    for step in steps:
        x, y = 31 + step * numpy.cos(angle), 31 + step * numpy.sin(angle)
        i, j = int(x), int(y)
        for di, wi in ((0, 1 - (x - i)), (1, x - i)):
            for dj, wj in ((0, 1 - (y - j)), (1, y - j)):
                kernel[j + dj, i + di] += wi * wj
    return cv2.filter2D(picture, -1, kernel / kernel.sum(), borderType=cv2.BORDER_REPLICATE)


def cover(random, canvas, marker, camera, photo):
    """Something lies over a piece of the marker: over a side or its middle, not over a corner."""
    cells = marker.dictionary.markerSize + 2
    h = marker.size / 2
    wide = random.uniform(0.6, 1.4) * marker.size / cells / 2
    x = random.uniform(-0.5, 0.5) * h
    y = random.uniform(0.2, 0.8) * h
    patch = numpy.array([[x - wide, h * 1.3, 0], [x + wide, h * 1.3, 0], [x + wide, y, 0], [x - wide, y, 0]])
    turn, _ = cv2.Rodrigues(numpy.array([0, 0, random.integers(4) * numpy.pi / 2]))
    shape = camera.project(marker.in_camera(patch @ turn.T))
    mask = numpy.zeros(canvas.shape, numpy.uint8)
    cv2.fillConvexPoly(mask, numpy.round(shape * 16 - 8).astype(numpy.int32), 255, cv2.LINE_AA, 4)
    part = mask / 255.0
    return canvas * (1 - part) + numpy.clip(photo * 0.5 + 110, 0, 255) * part


def cover_corner(random, canvas, marker, camera, photo, corner):
    """Something lies over a corner of the marker, 0 - 3, and a tenth to a half of both its sides."""
    h = marker.size / 2
    x, y = -h + random.uniform(0.1, 0.5, 2) * marker.size * [1, -1] + [0, 2 * h]
    patch = numpy.array([[-h * 1.4, h * 1.4, 0], [x, h * 1.4, 0], [x, y, 0], [-h * 1.4, y, 0]])
    turn, _ = cv2.Rodrigues(numpy.array([0, 0, corner * numpy.pi / 2]))
    shape = camera.project(marker.in_camera(patch @ turn.T))
    mask = numpy.zeros(canvas.shape, numpy.uint8)
    cv2.fillConvexPoly(mask, numpy.round(shape * 16 - 8).astype(numpy.int32), 255, cv2.LINE_AA, 4)
    part = mask / 255.0
    return canvas * (1 - part) + numpy.clip(photo * 0.5 + 90, 0, 255) * part


def finish(random, picture, name):
    """Applies a condition to a canvas of floats and makes it a picture of bytes."""
    noise = 1.0
    if name in ("light", "all"):
        picture = uneven_light(random, picture)
    if name in ("dark", "all"):
        picture = picture * (random.uniform(0.12, 0.3) if name == "dark" else random.uniform(0.4, 0.8)) + 8
    if name in ("blur", "all"):
        picture = cv2.GaussianBlur(picture, (0, 0), random.uniform(1.0, 3.0) if name == "blur" else random.uniform(0.5, 1.5))
    elif name != "sharp":
        # A lens is never perfect.
        picture = cv2.GaussianBlur(picture, (0, 0), 0.5)
    if name in ("motion", "all"):
        picture = motion(random, picture, random.uniform(4, 16) if name == "motion" else random.uniform(1, 5))
    if name in ("noise", "all"):
        noise = random.uniform(5, 20) if name == "noise" else random.uniform(2, 8)
    picture = picture + random.normal(0, noise, picture.shape)
    picture = numpy.clip(numpy.round(picture), 0, 255).astype(numpy.uint8)
    if name in ("jpeg", "all"):
        quality = int(random.integers(10, 50) if name == "jpeg" else random.integers(40, 80))
        picture = cv2.imdecode(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])[1], cv2.IMREAD_GRAYSCALE)
    return picture


CONDITIONS = ["clean", "noise", "blur", "motion", "light", "dark", "jpeg", "cover", "all"]


def scene(random, photos, camera, dictionary, condition, numbers, sides=(14, 130), steepest=78):
    """A picture of up to `numbers` markers under one condition: (picture, markers)."""
    import photographs

    photo = photographs.crop(random, photos[random.integers(len(photos))], camera.width, camera.height)
    canvas = photo.astype(float)
    markers, others = [], []
    ids = random.choice(dictionary.bytesList.shape[0], numbers, replace=False)
    for number in ids:
        side = numpy.exp(random.uniform(*numpy.log(sides)))
        tilt = numpy.radians(random.uniform(0, steepest))
        marker = place(random, camera, dictionary, int(number), side, tilt, others)
        if marker is not None:
            markers.append(marker)
    for marker in markers:
        paint(canvas, camera, marker, black=random.uniform(10, 45), white=random.uniform(170, 245))
        if condition == "cover":
            other = photographs.crop(random, photos[random.integers(len(photos))], camera.width, camera.height)
            canvas = cover(random, canvas, marker, camera, other)
    return finish(random, canvas, condition), markers
