#!/usr/bin/env python3
"""Lays a marker on the table of a photograph: docs/ar-photograph.png, the input of the README's example.

    photograph.py [OUT]

The photograph is scikit-image's "coffee" (by Rachel Michetti, CC0); the marker is drawn by OpenCV with a known pose.
"""
import pathlib
import sys

import cv2
import numpy
import skimage.data

import scenes

root = pathlib.Path(__file__).parent.parent.parent
photo = cv2.imread(str(pathlib.Path(skimage.data.__file__).parent / "coffee.png"))
height, width = photo.shape[:2]
camera = scenes.Camera(width, height, width / 2 / numpy.tan(numpy.radians(30)))
dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
lean = cv2.Rodrigues(numpy.radians([-48.0, 0, 0]))[0] @ numpy.diag([1.0, -1, -1])
turn = cv2.Rodrigues(numpy.radians([0, 0, 14.0]))[0]
marker = scenes.Marker(dictionary, 7, 0.08, lean @ turn, [0.196, -0.030, 0.50])
# As light as the table's brightest, warm as its light.
channels = []
for channel, (black, white) in zip(cv2.split(photo), [(14, 150), (16, 185), (22, 205)]):
    canvas = channel.astype(float)
    mask = scenes.paint(canvas, camera, marker, black, white)
    soft = cv2.GaussianBlur(canvas, (0, 0), 0.7)
    channels.append(numpy.where(mask > 0, soft, canvas))
noise = numpy.random.default_rng(1).normal(0, 1.5, photo.shape)
result = numpy.clip(cv2.merge(channels) + noise * (cv2.merge([mask] * 3) > 0), 0, 255).round().astype(numpy.uint8)
out = sys.argv[1] if len(sys.argv) > 1 else str(root / "docs" / "ar-photograph.png")
cv2.imwrite(out, result)
