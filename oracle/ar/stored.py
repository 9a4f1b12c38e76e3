#!/usr/bin/env python3
"""Writes the stored frames of scripts/marker-probe: 320x240 grey, a marker with a known pose over photographs; the last has none."""
import pathlib

import cv2
import numpy

import photographs
import scenes

folder = pathlib.Path(__file__).parent.parent.parent / "scripts" / "marker-probe" / "frames"
photos = photographs.load(photographs.files())
dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
camera = scenes.Camera(320, 240, 300.0)
random = numpy.random.default_rng(11)
for number, condition in enumerate(["clean", "noise", "blur", "clean"]):
    count = 1 if number < 3 else 0
    picture, _ = scenes.scene(random, photos, camera, dictionary, condition, count, sides=(60, 90), steepest=50)
    (folder / f"{number}.grey").write_bytes(picture.tobytes())
