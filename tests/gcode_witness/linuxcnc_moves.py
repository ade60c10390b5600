#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What LinuxCNC's own interpreter makes of G-code programs.

    linuxcnc_moves.py < programs > truth

Programs come in as records: a line `=== NAME BYTES`, then that many bytes and a line feed. The answer has the same
records, in the same order, with one line for each canonical call, in mm in the machine frame (work offsets, G92 and
rotation applied), nine decimals:

    RAPID line x y z            FEED line x y z F            PROBE line x y z
    ARC line x y z C cx cy cz plane turns F       plane 17, 18 or 19; turns as canonical arcs count them, G2 negative
    DWELL line seconds          TOOL line number
    STATE S.. M.. M..           what the next call's line found: spindle speed, direction (M3 M4 M5), coolant (M7 M8 M9)
    ACCEPTED   or   REFUSED reason   or   UNKNOWN reason, where the module itself cannot know

The interpreter is that of Debian's package linuxcnc-uspace, as its Python module `gcode` gives it. RS274_ROOT names the
folder where the package was unpacked; without it the installed one is taken. Exit code 5: there is none.

Each program has a process of its own, with 99 tools of no length and no diameter, no stored parameters, no feed rate,
and two seconds. M2 is added behind it: the interpreter asks for an end that most CAM programs lack.
"""
import ctypes
import math
import os
import shutil
import signal
import sys
import tempfile

TIME_LIMIT_S = 2  # of the processor's time
INCH_MM = 25.4  # the module uses inches, independent of G20 and G21
PLANES = {1: 17, 2: 19, 3: 18}


def library_path(root):
    return f"{root}/usr/lib:{root}/usr/lib/x86_64-linux-gnu"


def restart_with_interpreter():
    """The loader reads its path once, at the start of a process."""
    root = os.environ.get("RS274_ROOT", "")
    if os.environ.get("RS274_PATHS") == "set":
        return
    environment = dict(os.environ, RS274_PATHS="set", LC_ALL="C")
    environment["LD_LIBRARY_PATH"] = library_path(root)
    environment["PYTHONPATH"] = f"{root}/usr/lib/python3/dist-packages"
    environment.pop("PYTHONHOME", None)
    python = "/usr/bin/python3"  # the version that the module was built for
    if not os.path.exists(python):
        sys.exit(5)
    os.execve(python, [python, *sys.argv], environment)


def number(value):
    text = f"{value:.9f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


class Canon:
    """The calls that the interpreter makes."""

    def __init__(self, folder, out):
        self.out = out
        self.parameter_file = os.path.join(folder, "parameters")
        self.line = 0
        self.origin = (0.0, 0.0, 0.0)
        self.offset = (0.0, 0.0, 0.0)
        self.turn = 0.0
        self.feed = 0.0
        self.plane = 1
        self.on_arc = False
        self.doubt = None
        self.state = "S0 M5 M9"
        self.told_state = self.state

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *_, **__: None

    def say(self, *words):
        if self.state != self.told_state:
            self.out.append("STATE " + self.state)
            self.told_state = self.state
        self.out.append(" ".join(str(word) for word in words))

    def look(self, state):
        _, _, spindle, _, mist, flood, *_ = state.mcodes
        if spindle == 0:  # nothing has been executed yet
            return
        coolant = "M7 M8" if mist == 7 and flood == 8 else "M7" if mist == 7 else "M8" if flood == 8 else "M9"
        self.state = f"S{number(state.speed)} M{spindle} {coolant}"

    def next_line(self, state):
        self.look(state)
        self.line = state.sequence_number

    # The interpreter's queries.
    def check_abort(self):
        return False

    def get_tool(self, pocket):
        return (pocket,) + (0.0,) * 12 + (0,)

    def get_external_angular_units(self):
        return 1.0

    def get_external_length_units(self):
        return 1.0

    def get_axis_mask(self):
        return 0x1FF

    def get_block_delete(self):
        return 0

    # The interpreter's calls.
    def set_g5x_offset(self, _, x, y, z, *__):
        self.origin = (x, y, z)

    def set_g92_offset(self, x, y, z, *_):
        self.offset = (x, y, z)

    def set_xy_rotation(self, degrees):
        self.turn = math.radians(degrees)

    def set_feed_rate(self, feed):
        self.feed = feed

    def set_plane(self, plane):
        self.plane = plane

    def machine(self, x, y, z):
        x, y, z = x + self.offset[0], y + self.offset[1], z + self.offset[2]
        c, s = math.cos(self.turn), math.sin(self.turn)
        place = (x * c - y * s + self.origin[0], x * s + y * c + self.origin[1], z + self.origin[2])
        return [number(INCH_MM * v) for v in place]

    def rate(self):
        return f"F{INCH_MM * self.feed:.12g}"

    def feeds(self, on_arc):
        self.on_arc = on_arc
        if self.feed == 0.0 and not self.doubt:
            # After a change of units the module assumes that a feed rate of one is set.
            self.doubt = "REFUSED Cannot feed with zero feed rate"

    def straight_traverse(self, x, y, z, *_):
        self.on_arc = False
        self.say("RAPID", self.line, *self.machine(x, y, z))

    def straight_feed(self, x, y, z, *_):
        self.feeds(False)
        self.say("FEED", self.line, *self.machine(x, y, z), self.rate())

    def straight_probe(self, x, y, z, *_):
        self.say("PROBE", self.line, *self.machine(x, y, z))

    def rigid_tap(self, x, y, z, *_):
        self.say("TAP", self.line, *self.machine(x, y, z))

    def arc_feed(self, first, second, centre_first, centre_second, turns, normal, *_):
        self.feeds(True)

        def place(u, v):
            return {1: (u, v, normal), 2: (normal, u, v), 3: (v, normal, u)}[self.plane]

        self.say("ARC", self.line, *self.machine(*place(first, second)), "C",
                 *self.machine(*place(centre_first, centre_second)), PLANES[self.plane], turns, self.rate())

    def dwell(self, seconds):
        self.say("DWELL", self.line, f"{seconds:.12g}")

    def change_tool(self, tool):
        if self.on_arc:
            # The module takes its own position for the machine's, without preceding arcs.
            self.doubt = self.doubt or "UNKNOWN a tool change behind an arc"
        self.say("TOOL", self.line, tool)

    def loses_its_place(self, program):
        """M61 makes the module ask for its place too, without a call that would show when."""
        bare = program.lower().replace(b" ", b"").replace(b"\t", b"")
        return b"m61" in bare and any(line.startswith("ARC") for line in self.out)


def interpret(program):
    """The answer's lines. In a process of its own: the interpreter keeps what it has been told."""
    folder = tempfile.mkdtemp()
    try:
        os.environ["HOME"] = folder  # the tool table's shared memory is there
        tools = ctypes.CDLL("libtooldata.so.0", mode=ctypes.RTLD_GLOBAL)
        status = ctypes.create_string_buffer(1 << 20)
        tools._Z17tool_mmap_creatorPK13EMC_TOOL_STATi(status, 0)
        table = os.path.join(folder, "tools")
        with open(table, "w", encoding="ascii") as file:
            file.writelines(f"T{i} P{i} Z0 D0\n" for i in range(1, 100))
        comments = (ctypes.c_char_p * 1001)(
            *[ctypes.cast(ctypes.create_string_buffer(256), ctypes.c_char_p) for _ in range(1001)])
        tools._Z13tooldata_initb(False)
        tools._Z13tooldata_loadPKcPPc(table.encode(), comments)

        import gcode  # pylint: disable=import-outside-toplevel

        source = os.path.join(folder, "program.ngc")
        with open(source, "wb") as file:
            file.write(program + b"\nM2\n")
        out = []
        canon = Canon(folder, out)
        # F0 first: the module's interpreter starts with a feed rate of one, the machine's with none.
        result, _ = gcode.parse(source, canon, "G21", "F0")
        if result > gcode.MIN_ERROR:
            reason = gcode.strerror(result).replace(folder + "/", "")
            out.append(f"REFUSED {reason}")
        else:
            if canon.loses_its_place(program):
                canon.doubt = canon.doubt or "UNKNOWN M61 and arcs"
            out.append(canon.doubt or "ACCEPTED")
        return out
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def answer(program):
    """interpret() in a child, whatever becomes of it."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        signal.setitimer(signal.ITIMER_PROF, TIME_LIMIT_S)
        os.close(reading)
        silent = os.open(os.devnull, os.O_WRONLY)
        os.dup2(silent, 1)
        os.dup2(silent, 2)
        text = "\n".join(interpret(program)) + "\n"
        with os.fdopen(writing, "wb") as pipe:
            pipe.write(text.encode("utf-8", "replace"))
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        text = pipe.read()
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        ended = os.WTERMSIG(status)
        text = b"REFUSED endless\n" if ended == signal.SIGPROF else f"REFUSED signal {ended}\n".encode()
    return text


def records(stream):
    while header := stream.readline():
        marker, name, count = header.split()
        if marker != b"===":
            sys.exit("a record begins with ===")
        program = stream.read(int(count))
        stream.readline()
        yield name, program


def main():
    restart_with_interpreter()
    try:
        import gcode  # noqa: F401  pylint: disable=import-outside-toplevel,unused-import
    except ImportError:
        sys.exit(5)
    for name, program in records(sys.stdin.buffer):
        text = answer(program)
        sys.stdout.buffer.write(b"=== %s %d\n%s\n" % (name, len(text), text))
    sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
