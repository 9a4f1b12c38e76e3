#!/usr/bin/env python3
"""Counts instructions a frame and prints the tables of BENCHMARKS.md.

Builds `count` for the generic target (no RUSTFLAGS), runs each case in valgrind with two numbers of frames and
divides the difference: loading and preparing data cancel out, and the count doesn't depend on the machine's load.
Needs valgrind. With --hot CASE: the functions and lines in which a case spends its instructions.
With --peers: the crates of the package registry that draw the same, instead of the tables.
With --two CASE...: what two threads have to do, each part counted by doing it twice: the most that they can gain.

    python3 benches/instructions.py [--only TEXT] [--jobs N] [--commit NAME] [--hot CASE] [--peers]
    python3 benches/instructions.py --two CASE...
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
MODELS = HERE.parent / "models"
SMALL, LARGE = "320x240", "640x480"
LOOKS = ["flat", "flat-face-normals", "gouraud", "textured", "flat-textured", "phong", "wire", "hidden"]

# Millions of instructions a frame. Measured elsewhere, once, with a sphere of this many triangles that covers as
# much of the picture; not repeated by this script.
TGX = {"5000:flat": 2.37, "5000:gouraud": 2.72, "5000:textured": 3.05, "5000:wire": 2.72, "70000:gouraud": 25.7}
SMALL3DLIB = {"5000:flat": 5.9, "5000:gouraud": 6.8, "5000:textured": 8.1}
TARGET = {"5000:flat": 1.6, "5000:gouraud": 1.8, "5000:textured": 2.0, "5000:wire": 1.2, "70000:gouraud": 17.0}
SCALAR_TARGET = {"5000:flat": 2.2, "5000:gouraud": 2.6, "5000:textured": 3.0}
# Parts of a step and bands for two threads, as crates/scanout-cli/src/draw/threads.rs has them; frames to count.
PARTS, BANDS, FRAMES = 8, 2, 9
# Instructions a line.
TINYGL = {"long": 1123, "short": 203}
LINE_TARGET = {"long": 900, "short": 180}
LINE_KINDS = {
    "fill": "one value (`Field::line`)",
    "flat": "one value (`walk_cells`)",
    "colour": "colour interpolated",
    "depth": "one value, depth tested",
    "full": "colour and depth (`walk`)",
}


def build(peers):
    """The path of `count`, freshly built for the generic target, with or without the peers."""
    env = {k: v for k, v in os.environ.items() if k not in ("RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS")}
    manifest = ["--manifest-path", str(HERE / "Cargo.toml")]
    command = ["cargo", "build", "--quiet", "--release", "--bin", "count", *manifest]
    features = ["--features", "peers"] if peers else []
    subprocess.run([*command, *features], check=True, env=env)
    command = ["cargo", "metadata", "--format-version", "1", "--no-deps", *manifest]
    metadata = json.loads(subprocess.run(command, check=True, env=env, capture_output=True).stdout)
    return pathlib.Path(metadata["target_directory"]) / "release" / "count"


def total(count, case, frames):
    """Instructions of a whole run."""
    command = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
    done = subprocess.run([*command, count, case, str(frames)], capture_output=True, text=True)
    found = re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)
    if done.returncode != 0 or not found:
        sys.exit(f"{case}: {done.stderr}")
    return int(found[1].replace(",", ""))


def per_frame(count, case):
    """Instructions a frame; the first frame of a run may differ and isn't counted."""
    return (total(count, case, 3) - total(count, case, 1)) / 2


def facts(count, case):
    """What a frame of the case consists of."""
    return subprocess.run([count, case, "0"], check=True, capture_output=True, text=True).stdout.strip().split("\t")


def hot(count, case):
    """callgrind's list of functions and lines."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        run = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--toggle-collect=*Memory*draw*"]
        subprocess.run([*run, count, case, "3"], check=True, capture_output=True)
        for title, options in (("Functions, inclusive", ["--inclusive=yes"]), ("Functions, self", ["--inclusive=no"])):
            print(f"\n{title}:\n")
            text = subprocess.run(["callgrind_annotate", "--auto=no", *options, out], check=True, capture_output=True)
            rows = [r for r in text.stdout.decode().splitlines() if re.match(r"\s*[\d,]+ \(", r)]
            print("\n".join(rows[:40]))
        print("\nLines, self:\n")
        text = subprocess.run(["callgrind_annotate", "--auto=yes", "--context=0", out], check=True, capture_output=True)
        name, rows = "", []
        for row in text.stdout.decode().splitlines():
            if row.startswith("-- Auto-annotated source:"):
                name = row.rsplit("/", 1)[-1]
            elif (found := re.match(r"\s*([\d,]+) \([ \d.]+%\)\s(.*)", row)) and name and not re.search("=>|events annotated|unidentified lines", row):
                rows.append((int(found[1].replace(",", "")), name, found[2].strip()))
        for count, name, code in sorted(rows, reverse=True)[:40]:
            print(f"{count:12,}  {name:16} {code}")


def table(head, rows):
    """A markdown table; the first column to the left."""
    print("| " + " | ".join(head) + " |")
    print("|---|" + "---:|" * (len(head) - 1))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def frame_cases():
    """Source, look and size of each frame."""
    cases = [("empty", "flat", size) for size in (SMALL, LARGE)]
    for source, size in (("400", SMALL), ("5000", SMALL), ("70000", LARGE)):
        cases += [(source, look, size) for look in LOOKS]
    for path in sorted(MODELS.glob("*")):
        if path.suffix.lower() in (".obj", ".stl", ".ply", ".glb", ".gltf"):
            cases += [(str(path), look, LARGE) for look in ("flat", "gouraud", "textured", "wire")]
    return cases


def millions(value):
    """Two digits after the point, one above ten."""
    if value is None:
        return ""
    value /= 1e6
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def span(parts):
    """The longer of two threads' work, which take parts in turn, each the next when it has finished one."""
    threads = [0.0, 0.0]
    for part in parts:
        threads[threads.index(min(threads))] += part
    return max(threads)


def show_two(count, cases, jobs):
    """Two threads: PARTS parts of each step, BANDS bands, as `scanout` cuts a frame for them."""
    rows = []
    steps = {"vertices": PARTS, "primitives": PARTS, "bands": BANDS}
    for case in cases:
        divided = f"parts:{PARTS}:{BANDS}:{case}"
        twice = [(step, f"twice:{step}:{k}:{divided}") for step, parts in steps.items() for k in range(parts)]
        # Loading hashes with a random seed, so its count differs from run to run; many frames make that small.
        work = [(name, frames) for name in (case, divided) for frames in (1, FRAMES)] + [(name, FRAMES) for _, name in twice]
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            counts = dict(zip(work, pool.map(lambda run: total(count, *run), work)))
        one, all_parts = ((counts[name, FRAMES] - counts[name, 1]) / (FRAMES - 1) for name in (case, divided))
        costs = [(step, (counts[name, FRAMES] - counts[divided, FRAMES]) / FRAMES) for step, name in twice]
        spans = [span([cost for step, cost in costs if step == this]) for this in steps]
        serial = max(0, all_parts - sum(cost for _, cost in costs))
        most = one / (serial + sum(spans))
        source, look, size = case.rsplit(":", 2)
        name = f"{pathlib.Path(source).stem} {look} {size}"
        rows.append([name, *(millions(v) for v in (one, all_parts, serial, *spans)), f"{most:.2f}"])
    print(f"Two threads, {PARTS} parts a step, {BANDS} bands, millions of instructions; of the steps the longer thread's:\n")
    table(["case", "one thread", "in parts", "by one thread", *steps, "at most"], rows)


def main():
    """Counts and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="only cases with this in their name")
    parser.add_argument("--jobs", type=int, default=2, help="cases at once")
    parser.add_argument("--commit", help="the name of what is measured, where there is no git")
    parser.add_argument("--hot", metavar="CASE", help="where a case spends its instructions")
    parser.add_argument("--peers", action="store_true", help="scanout against crates of the package registry")
    parser.add_argument("--two", metavar="CASE", nargs="+", help="what two threads have to do")
    options = parser.parse_args()
    count = build(options.peers)
    if options.hot:
        hot(count, options.hot)
        return
    if options.two:
        show_origin(options.commit)
        show_two(count, options.two, options.jobs)
        return
    if options.peers:
        show_origin(options.commit)
        show_peers(count, options.jobs)
        return
    cases = [":".join(case) for case in frame_cases()]
    lines = [f"lines:{length}:{kind}" for length in TINYGL for kind in LINE_KINDS]
    cases, lines = ([c for c in names if options.only in c] for names in (cases, lines))
    work = cases + [f"prepare:{c}" for c in cases if not c.startswith("empty")] + lines
    work += [f"scalar:{c}" for c in cases if c.rsplit(":", 1)[0] in SCALAR_TARGET]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        counts = dict(zip(work, pool.map(lambda case: per_frame(count, case), work)))
    show_origin(options.commit)
    show_frames(count, cases, counts)
    show_lines(count, lines, counts)


def show_origin(commit):
    """What was measured, with what."""

    def first_line(*command):
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\n")[0]

    if not commit:
        git = ["git", "-C", str(HERE)]
        commit = first_line(*git, "rev-parse", "--short", "HEAD")
        if first_line(*git, "status", "--porcelain", "--", str(HERE.parent / "crates")):
            commit += " and uncommitted changes"
    print(f"Commit {commit}; {first_line('rustc', '--version')}; {first_line('valgrind', '--version')}; x86-64.\n")


def show_frames(count, cases, counts):
    """The tables of instructions and of memory."""
    rows, memory = [], {}
    for case in cases:
        source, look, size = case.rsplit(":", 2)
        source = pathlib.Path(source).name
        key = f"{source}:{look}"
        whole, prepare = counts[case], counts.get(f"prepare:{case}")
        reference = [table.get(key) for table in (TGX, SMALL3DLIB, TARGET, SCALAR_TARGET)]
        shown = ["" if v is None else f"{v:g}" for v in reference]
        draw = None if prepare is None else whole - prepare
        ratio = "" if reference[0] is None else f"{whole / 1e6 / reference[0]:.2f}"
        numbers = [millions(v) for v in (whole, prepare, draw)]
        shown.insert(3, millions(counts.get(f"scalar:{case}")))
        rows.append([f"{source} {look}", size, *numbers, shown[0], ratio, *shown[1:]])
        if source != "empty":
            triangles, vertices, primitives, store, band, _ = facts(count, case)
            memory.setdefault((source, size, vertices, primitives, store, band), []).append(look)
    head = ["case", "size", "frame", "prepare", "draw", "TGX", "ratio", "small3dlib", "target", "scalar", "its target"]
    print("Millions of instructions a frame:\n")
    table(head, rows)
    print("Memory of a frame, in bytes, for the caller's slices:\n")
    head = ["case", "size", "vertices", "primitives kept", "store", "colour + depth, one band", "a line of it"]
    rows = []
    for (source, size, vertices, primitives, store, band), looks in memory.items():
        line = int(band) // int(size.split("x")[1])
        rows.append([f"{source} {', '.join(looks)}", size, vertices, primitives, store, band, str(line)])
    table(head, rows)


def show_lines(count, cases, counts):
    """The table of lines."""
    rows = []
    for case in cases:
        _, length, kind = case.split(":")
        number, pixels = facts(count, case)
        each = counts[case] / int(number)
        compared = [f"{t[length]:,}" if kind == "fill" else "" for t in (TINYGL, LINE_TARGET)]
        ratio = f"{each / TINYGL[length]:.2f}" if kind == "fill" else ""
        rows.append([f"{length}, {LINE_KINDS[kind]}", pixels, f"{each:,.0f}", compared[0], ratio, compared[1]])
    if rows:
        print("Instructions a line (averages over 1,000 random lines):\n")
        table(["lines", "pixels", "instructions", "TinyGL", "ratio", "target"], rows)


def show_peers(count, jobs):
    """The table of peers: a frame or 1,000 lines, theirs and ours."""
    spheres = [f"{n}:{look}:{size}" for n, size in (("400", SMALL), ("5000", SMALL), ("70000", LARGE)) for look in ("flat", "gouraud")]
    pairs = [("embedded-3dgfx", case) for case in spheres]
    pairs += [(peer, case) for peer in ("euc", "retrofire") for case in spheres if "gouraud" in case]
    pairs += [(peer, f"lines:{length}") for peer in ("embedded-graphics", "tiny-skia") for length in TINYGL]
    ours = [f"{case}:fill" if case.startswith("lines") else case for _, case in pairs]
    work = sorted({*ours, *(f"peer:{peer}:{case}" for peer, case in pairs)})
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        counts = dict(zip(work, pool.map(lambda case: per_frame(count, case), work)))
    rows = []
    for (peer, case), own in zip(pairs, ours):
        mine, theirs = counts[own], counts[f"peer:{peer}:{case}"]
        rows.append([case.replace(":", " "), peer, millions(mine), millions(theirs), f"{mine / theirs:.2f}"])
    print("Millions of instructions a frame, or for 1,000 lines:\n")
    table(["case", "peer", "scanout", "peer", "ratio"], rows)


if __name__ == "__main__":
    main()
