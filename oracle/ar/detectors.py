"""The detectors that are compared: each gives (number, corners) and the processor's milliseconds for a picture.

Corners: top left, top right, bottom right, bottom left, pixel centres at .5.
"""
import subprocess
import time

import cv2
import numpy


class OpenCv:
    def __init__(self, dictionary):
        parameters = cv2.aruco.DetectorParameters()
        parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
        self.detector = cv2.aruco.ArucoDetector(dictionary, parameters)
        self.name = "OpenCV, sub-pixel corners"

    def __call__(self, picture):
        start = time.process_time()
        corners, numbers, _ = self.detector.detectMarkers(picture)
        spent = time.process_time() - start
        numbers = [] if numbers is None else numbers.ravel()
        # OpenCV's pixel centres lie at .0.
        return [(int(n), c.reshape(4, 2).astype(float) + 0.5) for n, c in zip(numbers, corners)], spent * 1e3


class AprilTag:
    # Never freed: pupil-apriltags sometimes frees memory twice then, and Python falls.
    kept = []

    def __init__(self, decimate):
        import pupil_apriltags

        self.detector = pupil_apriltags.Detector(families="tag36h11", nthreads=1, quad_decimate=decimate)
        self.kept.append(self.detector)
        self.name = f"AprilTag 3, decimation {decimate:g}"

    def __call__(self, picture):
        start = time.process_time()
        found = self.detector.detect(picture)
        spent = time.process_time() - start
        # Its corners go counter-clockwise; its tags stand on their heads, as OpenCV draws them.
        return [(tag.tag_id, tag.corners[[1, 0, 3, 2]]) for tag in found], spent * 1e3


class Scanout:
    """The example `detect` of scanout-ar, fed with pictures through a pipe."""

    def __init__(self, program, dictionaries, camera=None, size=None, fps=None, filtered=False, again=False):
        options = []
        if camera is not None:
            lens = [camera.focal, camera.focal, *camera.centre, *camera.distortion]
            options += ["--lens", ",".join(map(str, lens)), "--size", str(size)]
        if fps is not None:
            options += ["--fps", str(fps)]
        if filtered:
            options.append("--filter")
        if again:
            options.append("--again")
        self.process = subprocess.Popen([program, *options, *dictionaries], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.words = 9 if camera is None else 21
        self.name = "scanout"
        self.poses = {}

    def __call__(self, picture):
        height, width = picture.shape
        self.process.stdin.write(b"P5\n%d %d\n255\n" % (width, height) + picture.tobytes())
        self.process.stdin.flush()
        words = self.process.stdout.readline().split()
        found = []
        self.poses = {}
        for i in range(1, len(words), self.words):
            number = int(words[i].split(b":")[1])
            found.append((number, numpy.array(words[i + 1 : i + 9], float).reshape(4, 2)))
            if self.words > 9:
                pose = numpy.array(words[i + 9 : i + 21], float)
                self.poses[number] = pose[:9].reshape(3, 3), pose[9:]
        return found, float(words[0]) / 1e3

    def close(self):
        self.process.stdin.close()
        self.process.wait()
