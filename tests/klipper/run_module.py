# SPDX-License-Identifier: GPL-3.0-or-later
"""The module that export klipper writes, against a stub of what Klipper gives a kinematics module.

The stub computes what Klipper's C does: a stepper of winch counts its straight distance from its anchor,
along straight moves. What the chains have been paid out at the ends of moves and between is held to the
map's own lengths (chaintrue query).

    python3 tests/klipper/run_module.py build/chaintrue map.json
"""
import csv
import io
import importlib.util
import math
import os
import subprocess
import sys
import tempfile
import types

# A table is within 0.005 mm of its map; a piece of a move may bow by as much again.
AT_NODES_MM = 0.005
BETWEEN_MM = 0.010


class Stepper:
    def __init__(self, config):
        self.name = config.name
        self.position = None

    def setup_itersolve(self, kind, *numbers):
        self.kind, self.numbers = kind, numbers

    def set_trapq(self, trapq):
        assert trapq == 'trapq'

    def generate_steps(self, time):
        raise AssertionError('not asked for')

    def set_position(self, place):
        self.position = self.counted(place)

    def counted(self, place):
        if self.kind == 'winch_stepper_alloc':
            return math.dist(self.numbers, place[:3])
        assert (self.kind, self.numbers) == ('cartesian_stepper_alloc', (b'z',))
        return place[2]


class Config:
    def __init__(self, printer, name, values, sections):
        self.printer, self.name, self.values, self.sections = printer, name, values, sections

    def get_printer(self):
        return self.printer

    def getsection(self, name):
        return Config(self.printer, name, {}, ())

    def has_section(self, name):
        return name in self.sections

    def getfloat(self, name, default):
        return self.values.get(name, default)

    class error(Exception):
        pass


class Printer:
    class command_error(Exception):
        pass

    def __init__(self):
        self.handlers = {}
        self.objects = {}

    def register_event_handler(self, event, handler):
        self.handlers[event] = handler

    def lookup_object(self, name):
        return self.objects[name]


class Toolhead:
    def __init__(self):
        self.position = [0., 0., 0., 0.]
        self.moves = []
        self.generators = []

    def get_trapq(self):
        return 'trapq'

    def register_step_generator(self, generator):
        self.generators.append(generator)

    def Coord(self, x, y, z, e):
        return (x, y, z, e)

    def get_position(self):
        return list(self.position)

    def set_position(self, place, homing_axes=()):
        self.position = list(place)
        self.kinematics.set_position(place, homing_axes)

    def move(self, place, speed):
        self.moves.append((list(self.position), list(place), speed))
        self.position = list(place)


class GcodeMove:
    def __init__(self, toolhead):
        self.transform = toolhead

    def set_move_transform(self, transform, force=False):
        assert force
        before, self.transform = self.transform, transform
        return before


class Homing:
    def set_axes(self, axes):
        self.axes = axes

    def set_homed_position(self, place):
        self.place = place


def map_lengths(chaintrue, map_file, places):
    numbers = [f'{value:.9f}' for place in places for value in place]
    text = subprocess.run([chaintrue, 'query', map_file] + numbers, check=True, capture_output=True,
                          text=True).stdout
    return [(float(row['left_mm']), float(row['right_mm'])) for row in csv.DictReader(io.StringIO(text))]


def load(source):
    sys.modules['stepper'] = types.SimpleNamespace(PrinterStepper=Stepper)
    spec = importlib.util.spec_from_file_location('chaintrue', source)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def started(module, values, sections):
    printer, toolhead = Printer(), Toolhead()
    gcode_move = GcodeMove(toolhead)
    printer.objects['gcode_move'] = gcode_move
    toolhead.kinematics = module.load_kinematics(toolhead, Config(printer, 'printer', values, sections))
    printer.handlers['klippy:connect']()
    return printer, toolhead, gcode_move.transform


def off_by(module, kinematics, place, lengths):
    """The worse chain: what winch has counted there, less the map."""
    left, right = kinematics.get_steppers()[:2]
    longer = (module.LEFT_LONGER, module.RIGHT_LONGER)
    return max(abs(s.counted(place) - o - l) for s, o, l in zip((left, right), longer, lengths))


def check_moves(chaintrue, map_file, module):
    printer, toolhead, sheet = started(module, {'home_x': 100., 'home_y': -50.}, ('stepper_z',))
    kinematics = toolhead.kinematics
    assert [s.name for s in kinematics.get_steppers()] == ['stepper_left', 'stepper_right', 'stepper_z']
    assert len(toolhead.generators) == 3
    assert max(abs(a - b) for a, b in zip(sheet.get_position(), (100., -50., 0., 0.))) < 1e-6
    targets = [(-900., 300., 0.), (900., 300., -6.), (900., -400., -20.), (-300., -400., 4.), (0., 0., 0.)]
    begin = [100., -50., 0.]
    asked, found = [], []
    for target in targets:
        toolhead.moves.clear()
        sheet.move(list(target) + [0.], 25.)
        pieces = len(toolhead.moves)
        assert pieces == math.ceil(math.dist(begin[:2], target[:2]) / module.LONGEST_PIECE - 1e-9)
        for number, (a, b, speed) in enumerate(toolhead.moves):
            assert speed == 25.
            for share in (0.5, 1.0):
                on_way = [p + share * (q - p) for p, q in zip(a, b)]
                whole = (number + share) / pieces
                place = [p + whole * (q - p) for p, q in zip(begin, target)]
                assert abs(on_way[2] - place[2]) < 1e-9
                asked.append(place[:2])
                found.append((on_way, share))
        assert sheet.get_position()[:3] == list(target)
        begin = list(target)
    worst = {0.5: 0., 1.0: 0.}
    for (place, share), lengths in zip(found, map_lengths(chaintrue, map_file, asked)):
        worst[share] = max(worst[share], off_by(module, kinematics, place, lengths))
    print(f'{len(asked)} places: {worst[1.0]:.4f} mm at ends of pieces, {worst[0.5]:.4f} mm between')
    assert worst[1.0] <= AT_NODES_MM and worst[0.5] <= BETWEEN_MM
    # Without its own memory the tool is where it was sent.
    kinematics.last = None
    assert math.dist(sheet.get_position()[:3], targets[-1]) < 1e-6
    counted = {s.name: s.counted(toolhead.position) for s in kinematics.get_steppers()}
    assert math.dist(kinematics.calc_position(counted), toolhead.position[:3]) < 1e-6
    return printer, toolhead, sheet


def check_refusals(module, printer, toolhead, sheet):
    before = (list(toolhead.position), len(toolhead.moves))
    for target in ((1e4, 0.), (0., 1e4), (float('nan'), 0.)):
        try:
            sheet.move([target[0], target[1], 0., 0.], 25.)
        except (Printer.command_error, ValueError) as error:
            assert 'outside the map' in str(error) or target[0] != target[0]
        else:
            raise AssertionError(f'moved to {target}')
        assert before == (list(toolhead.position), len(toolhead.moves))
    homing = Homing()
    toolhead.kinematics.home(homing)
    toolhead.set_position(homing.place + [0.])
    assert math.dist(sheet.get_position()[:2], (100., -50.)) < 1e-6
    try:
        started(module, {'home_x': 1e5}, ())
    except Config.error as error:
        assert 'outside the map' in str(error)
    else:
        raise AssertionError('home outside the map')


def main():
    chaintrue, map_file = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        source = os.path.join(folder, 'chaintrue.py')
        again = os.path.join(folder, 'again.py')
        for output in (source, again):
            subprocess.run([chaintrue, 'export', 'klipper', map_file, '-o', output], check=True)
        with open(source, 'rb') as one, open(again, 'rb') as two:
            text = one.read()
            assert text.splitlines()[1:] == two.read().splitlines()[1:]
        module = load(source)
        check_refusals(module, *check_moves(chaintrue, map_file, module))


if __name__ == '__main__':
    main()
