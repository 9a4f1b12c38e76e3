#!/usr/bin/env python3
"""What ffmpeg's filter stereo3d makes of two eyes' pictures.

    stereo.py OUT WIDTH HEIGHT < left and right side by side, 2 WIDTH x HEIGHT, RGB > the filter's picture, RGB

OUT is the filter's name of an arrangement (arcg, sbsl, irl, ...). Exit code 77 when imageio-ffmpeg, which carries the
program, is not installed.
"""

import subprocess
import sys

try:
    import imageio_ffmpeg
except ImportError:
    print("SKIPPED: ffmpeg is not there; pip install imageio-ffmpeg", file=sys.stderr)
    sys.exit(77)


def main():
    """Runs the filter on one frame."""
    out, width, height = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24"]
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", *raw, "-s", f"{2 * width}x{height}", "-i", "-"]
    command += ["-vf", f"stereo3d=sbsl:{out}", *raw, "-"]
    done = subprocess.run(command, input=sys.stdin.buffer.read(), capture_output=True)
    sys.stderr.buffer.write(done.stderr)
    sys.stdout.buffer.write(done.stdout)
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
