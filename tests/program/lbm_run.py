#!/usr/bin/python3
"""Claims about `lbm run`: results, messages and exit status, as a user of the program sees them."""

import csv
import json
import math
import os
import stat
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ.get("LBM_PROGRAM", "build/bin/lbm")
REFERENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference")

DX, DENSITY, VISCOSITY, DRIVE = 1e-4, 1000.0, 1e-3, 1e-6


def run(case):
    """Exit status, result (None without one) and messages of a case given as an object or as text."""
    text = case if isinstance(case, str) else json.dumps(case)
    done = subprocess.run([PROGRAM, "run", "-"], input=text, capture_output=True, text=True, timeout=300)
    return done.returncode, json.loads(done.stdout) if done.stdout else None, done.stderr


def array(n=8, c=0.125, **more):
    """A simple cubic array of spheres in Stokes flow."""
    radius = n * DX * (3 * c / (4 * math.pi)) ** (1 / 3)
    case = {
        "domain": {"cells": [n] * 3, "dx": DX},
        "fluid": {"density": DENSITY, "viscosity": VISCOSITY},
        "tau": 1.0,
        "inertia": False,
        "boundaries": {axis: "periodic" for axis in "xyz"},
        "acceleration": [DRIVE, 0, 0],
        "solids": [{"shape": "sphere", "center": [0.5 * n * DX] * 3, "radius": radius}],
        "stop": {"steady": 1e-7, "max_steps": 200000},
    }
    case.update(more)
    return case


def drag(case, result):
    """K = F / (6 pi mu R U) with F the drive on the whole cell."""
    volume = math.prod(case["domain"]["cells"]) * DX**3
    return DENSITY * DRIVE * volume / (6 * math.pi * VISCOSITY * case["solids"][0]["radius"] * result["superficial_velocity"][0])


def free_turn(moments, spin, time, steps=4000):
    """Axes and angular velocity about them of a body without torque, after `time`: Euler's equations, Runge and Kutta."""
    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    def rate(state):
        w, axes = state[:3], [state[3 + 3 * i : 6 + 3 * i] for i in range(3)]
        turned = [(moments[(i + 1) % 3] - moments[(i + 2) % 3]) / moments[i] * w[(i + 1) % 3] * w[(i + 2) % 3] for i in range(3)]
        absolute = [sum(axes[i][d] * w[i] for i in range(3)) for d in range(3)]
        return turned + [x for axis in axes for x in cross(absolute, axis)]

    state, h = list(spin) + [1, 0, 0, 0, 1, 0, 0, 0, 1], time / steps
    for _ in range(steps):
        k1 = rate(state)
        k2 = rate([x + h / 2 * k for x, k in zip(state, k1)])
        k3 = rate([x + h / 2 * k for x, k in zip(state, k2)])
        k4 = rate([x + h * k for x, k in zip(state, k3)])
        state = [x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip(state, k1, k2, k3, k4)]
    return [state[3 + 3 * i : 6 + 3 * i] for i in range(3)], state[:3]


def reference_drag(c):
    with open(os.path.join(REFERENCE, "02_cubic_arrays_stokes.csv"), encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["lattice"] == "SC" and float(row["c"]) == c:
                return float(row["K"])
    raise ValueError(f"no simple cubic array with c = {c} in the reference")


class Results(unittest.TestCase):
    def test_drag_of_an_array_agrees_with_the_reference(self):
        case = array(14)
        status, result, _ = run(case)
        self.assertEqual(status, 0)
        self.assertTrue(result["converged"])
        # 8.7 cells across, this place on the lattice: measured -0.57 %.
        self.assertAlmostEqual(drag(case, result) / reference_drag(0.125), 1, delta=0.0085)

    def test_drag_of_spheres_that_nearly_touch_agrees_with_the_reference(self):
        # The gap between neighbours is 0.15 cells. Measured +1.7 %; -10 % where cut cells leak in narrow pores.
        case = array(10, c=0.5)
        status, result, _ = run(case)
        self.assertEqual(status, 0)
        self.assertAlmostEqual(drag(case, result) / reference_drag(0.5), 1, delta=0.025)
        whole_drive = DENSITY * DRIVE * math.prod(case["domain"]["cells"]) * DX**3
        self.assertAlmostEqual(result["solids"][0]["force"][0] / whole_drive, 1, delta=1e-5)

    def test_drag_does_not_depend_on_tau(self):
        for magic_parameter in (0.125, 0.1875):
            drags = []
            for tau in (0.6, 1.0, 2.0):
                case = array(8, tau=tau, magic_parameter=magic_parameter, stop={"steady": 1e-10, "max_steps": 400000})
                status, result, message = run(case)
                self.assertEqual(status, 0, message)
                drags.append(drag(case, result))
            self.assertLess(max(drags) / min(drags) - 1, 1e-7)

    def test_spheres_that_overlap_are_warned_about(self):
        case = array(stop={"max_steps": 1, "steady": 0})
        other = dict(case["solids"][0], center=[0.5 * 8 * DX, 0.5 * 8 * DX, 0.75 * 8 * DX])
        case["solids"].append(other)
        status, _, message = run(case)
        self.assertEqual(status, 0)
        self.assertIn("solids[0] and solids[1] share ", message)
        for solid in case["solids"]:
            solid["body"] = 1
        self.assertEqual(run(case)[2], "")

    def test_a_fluid_that_its_walls_hold_becomes_steady(self):
        case = array(acceleration=[1e-4, 2e-4, -1e-4], boundaries={axis: {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}} for axis in "xyz"}, solids=[])
        status, result, message = run(case)
        self.assertEqual(status, 0, message)
        self.assertLess(max(map(abs, result["superficial_velocity"])), 1e-15)

    def test_a_flow_without_net_velocity_or_force_becomes_steady(self):
        spinning = array(10, acceleration=[0, 0, 0])
        spinning["solids"][0].update(moving=True, angular_velocity=[0, 0, 1e-2])
        status, result, message = run(spinning)
        self.assertEqual(status, 0, message)
        self.assertLess(result["solids"][0]["torque"][2], 0)

    def test_force_permeability_and_velocity_belong_together(self):
        case = array()
        _, result, _ = run(case)
        force = DENSITY * DRIVE * (8 * DX) ** 3
        self.assertAlmostEqual(result["solids"][0]["force"][0] / force, 1, delta=1e-5)
        k = VISCOSITY / DENSITY * result["superficial_velocity"][0] / DRIVE
        self.assertAlmostEqual(result["permeability"] / k, 1, delta=1e-12)
        self.assertLess(abs(result["mass_drift"]), 1e-12)

    def test_a_free_sphere_sinks_and_a_moving_one_goes_its_way(self):
        free = array(10, acceleration=[0, 0, 0], gravity=[0, 0, -1e-3], stop={"max_steps": 500})
        free["solids"][0].update(free=True, density=2000.0)
        _, result, _ = run(free)
        self.assertLess(result["solids"][0]["velocity"][2], 0)
        wall = {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}}
        moving = array(10, acceleration=[0, 0, 0], stop={"max_steps": 500}, boundaries={"y": wall, "z": wall})
        moving["solids"][0].update(moving=True, velocity=[1e-6, 0, 0])
        _, result, _ = run(moving)
        self.assertAlmostEqual(result["solids"][0]["position"][0], 5 * DX + 1e-6 * result["time"], delta=1e-15)
        self.assertLess(result["solids"][0]["force"][0], 0)

    def test_a_heavy_body_turns_as_euler_says(self):
        # A box and the same one made of two halves, a billion times as dense as the fluid, turning about an axis near the one of its second moment.
        half, spin = [3.0, 4.0, 5.5], [0.00075, 0.01, 0.0005]
        moments = [half[1] ** 2 + half[2] ** 2, half[2] ** 2 + half[0] ** 2, half[0] ** 2 + half[1] ** 2]
        steps = 1200
        axes, w = free_turn(moments, spin, steps)
        expected = [sum(axes[i][d] * w[i] for i in range(3)) for d in range(3)]
        middle = 10.0
        one = [{"shape": "box", "center": [middle] * 3, "half_extents": half}]
        two = [{"shape": "box", "center": [middle, middle, middle + z], "half_extents": [3, 4, 2.75], "body": 7, "velocity": [spin[1] * z, -spin[0] * z, 0]} for z in (-2.75, 2.75)]
        for solids in (one, two):
            for solid in solids:
                solid.update(free=True, density=1e9, angular_velocity=spin)
            case = {"domain": {"cells": [20] * 3, "dx": 1.0}, "fluid": {"density": 1.0, "viscosity": 0.1}, "tau": 0.8, "solids": solids, "stop": {"max_steps": steps}}
            status, result, message = run(case)
            self.assertEqual(status, 0, message)
            for found in result["solids"]:
                for d in range(3):
                    self.assertAlmostEqual(found["angular_velocity"][d], expected[d], delta=1e-5 * 0.01)
            centre = [sum(s["position"][d] for s in result["solids"]) / len(solids) for d in range(3)]
            for d in range(3):
                self.assertAlmostEqual(centre[d], middle, delta=1e-3)
            if solids is two:
                arm = [(b - a) / 5.5 for a, b in zip(*(s["position"] for s in result["solids"]))]
                for d in range(3):
                    self.assertAlmostEqual(arm[d], axes[2][d], delta=1e-3)

    def test_a_body_of_coincident_spheres_moves_as_one(self):
        ball = {"center": [4.1 * DX, 3.9 * DX, 4 * DX], "radius": 2.5 * DX, "free": True, "density": 2000.0}
        results = []
        for solids in ([dict(ball, body=3)], [dict(ball, body=3), dict(ball, body=3)]):
            _, result, _ = run(array(acceleration=[0, 0, 0], gravity=[1e-3, 0, -1e-3], stop={"max_steps": 300}, solids=solids))
            results.append(result["solids"])
        for d in range(3):
            for other in results[1]:
                self.assertAlmostEqual(results[0][0]["velocity"][d], other["velocity"][d], delta=1e-9 * abs(results[0][0]["velocity"][0]))

    def test_what_comes_in_goes_out_and_pressure_bears_the_walls(self):
        wall, slip = {"type": "noSlip"}, {"type": "freeSlip"}
        inlet, outlet = {"type": "velocity", "velocity": [1e-4, 0, 0]}, {"type": "pressure", "pressure": 2e-3}
        faces = {"x": {"min": inlet, "max": outlet}, "z": {"min": wall, "max": slip}}
        case = array(acceleration=[0, 0, 0], boundaries=faces, inertia=False, stop={"steady": 1e-9, "max_steps": 20000})
        status, result, message = run(case)
        self.assertEqual(status, 0, message)
        flux = [face["flux"] for face in result["boundaries"]]
        area = (8 * DX) ** 2
        self.assertAlmostEqual(flux[0] / area, -1e-4, delta=1e-15)
        self.assertAlmostEqual(flux[1] / area, 1e-4, delta=1e-12)
        force = [face["force"] for face in result["boundaries"]]
        load = result["solids"][0]["force"]
        for axis in range(3):
            total = load[axis] + sum(force[face][axis] for face in (0, 1, 4, 5))
            self.assertAlmostEqual(total / load[0], 0, delta=1e-7)
        self.assertEqual(force[2], [0, 0, 0])
        self.assertAlmostEqual(force[5][0] / force[4][0], 0, delta=1e-9)
        self.assertIsNone(result["permeability"])

    def test_ducts_without_grains_get_the_isotropic_lattice(self):
        wall = {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}}
        duct = array(domain={"cells": [1, 16, 16], "dx": DX}, boundaries={"y": wall, "z": wall}, solids=[])
        exact = (1 - 192 / math.pi**5 * sum(math.tanh((k + 0.5) * math.pi) / (2 * k + 1) ** 5 for k in range(50))) / 12
        for more, name, off in (({}, "D3Q27", 2e-5), ({"lattice": "D3Q19"}, "D3Q19", 1.68e-3)):
            status, result, _ = run({**duct, **more})
            self.assertEqual((status, result["lattice"]), (0, name))
            found = result["superficial_velocity"][0] * VISCOSITY / (DENSITY * DRIVE * (16 * DX) ** 2)
            self.assertAlmostEqual(found / exact - 1, off, delta=2e-5)  # docs/physics.md, "Ducts"

    def test_grains_and_plates_get_the_quicker_lattice(self):
        wall = {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}}
        ball = {"shape": "sphere", "center": [8 * DX] * 3, "radius": 4 * DX}
        cube = {"shape": "box", "center": [8 * DX] * 3, "half_extents": [3 * DX] * 3}
        for solids, boundaries, lattice in (
            ([], {"y": wall}, "D3Q19"),
            ([ball], {"y": wall, "z": wall}, "D3Q19"),
            ([{**cube, "free": True, "density": 2000}], {}, "D3Q19"),
            ([cube], {}, "D3Q27"),
            ([{**ball, "shape": "pipe"}], {}, "D3Q27"),
        ):
            case = array(domain={"cells": [16] * 3, "dx": DX}, boundaries=boundaries, solids=solids, stop={"max_steps": 1})
            self.assertEqual(run(case)[1]["lattice"], lattice)

    def test_pressure_faces_drive_a_flow_as_a_uniform_drive_does(self):
        drop = DENSITY * DRIVE * 8 * DX
        ends = {"min": {"type": "pressure", "pressure": drop}, "max": {"type": "pressure", "pressure": 0}}
        stop = {"steady": 1e-9, "max_steps": 20000}
        _, driven, _ = run(array(inertia=False, stop=stop))
        _, pressed, _ = run(array(acceleration=[0, 0, 0], boundaries={"x": ends}, inertia=False, stop=stop))
        self.assertAlmostEqual(pressed["permeability"] / driven["permeability"], 1, delta=0.02)

    def test_a_quarter_between_planes_of_symmetry_is_the_whole(self):
        for c in (0.125, 0.5):  # with wide and with narrow pores
            whole = array(c=c)
            mirror = {"min": {"type": "freeSlip"}, "max": {"type": "freeSlip"}}
            quarter = dict(whole, domain={"cells": [8, 4, 4], "dx": DX}, boundaries={"y": mirror, "z": mirror})
            results = [run(case)[1] for case in (whole, quarter)]
            velocity, force = ([r["superficial_velocity"][0] for r in results], [r["solids"][0]["force"][0] for r in results])
            self.assertAlmostEqual(velocity[1] / velocity[0], 1, delta=1e-6)  # both steady to 1e-7
            self.assertAlmostEqual(4 * force[1] / force[0], 1, delta=1e-6)

    def test_the_flow_is_written_for_paraview(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "flow.vti")
            status, _, message = run(array(output={"vtk": path}))
            self.assertEqual(status, 0, message)
            with open(path, "rb") as file:
                content = file.read()
            self.assertIn(b'WholeExtent="0 8 0 8 0 8"', content)
            for name, components in ((b"velocity", 3), (b"pressure", 1), (b"solidFraction", 1)):
                self.assertIn(b'Name="%s" NumberOfComponents="%d"' % (name, components), content)
            data = content.split(b'encoding="raw">\n_')[1]
            self.assertEqual(int.from_bytes(data[:8], "little"), 8**3 * 3 * 4)
            self.assertEqual(os.listdir(folder), ["flow.vti"])

    def test_links_and_pipes_stay_what_they_are(self):
        with tempfile.TemporaryDirectory() as folder:
            link, target, pipe = (os.path.join(folder, name) for name in ("link.vti", "target.vti", "pipe.vti"))
            with open(target, "w", encoding="utf-8"):
                os.symlink(target, link)
            run(array(output={"vtk": link}, stop={"max_steps": 1}))
            self.assertTrue(os.path.islink(link))
            self.assertGreater(os.path.getsize(target), 1000)
            os.mkfifo(pipe)
            reader = subprocess.Popen(["cat", pipe], stdout=subprocess.DEVNULL)
            keeper = os.open(pipe, os.O_RDWR)  # so that the reader does not leave after the first writer
            run(array(output={"vtk": pipe}, stop={"max_steps": 1}))
            self.assertTrue(stat.S_ISFIFO(os.stat(pipe).st_mode))
            os.close(keeper)
            reader.wait(10)

    def test_a_far_box_is_written_where_it_is(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "flow.vti")
            far = {"cells": [8] * 3, "dx": DX, "lower": [5000000.125, 0, 0]}
            run(array(domain=far, solids=[], output={"vtk": path}, stop={"max_steps": 1}))
            with open(path, "rb") as file:
                self.assertIn(b'Origin="5000000.125 0 0"', file.read())


class Messages(unittest.TestCase):
    def refused(self, text, case):
        status, result, message = run(case)
        self.assertEqual(status, 2, message)
        self.assertIsNone(result)
        self.assertIn(text, message)
        self.assertEqual(message.count("\n"), 1, message)

    def test_keys_are_named(self):
        self.refused("solidz: unknown key", array(solidz=[]))
        self.refused("tau: missing", {key: value for key, value in array().items() if key != "tau"})
        self.refused('tau: must be a number', array(tau="high"))
        self.refused("fluid.viscosty: unknown key", array(fluid={"density": 1, "viscosity": 1, "viscosty": 1}))
        self.refused("domain.cells: must be three whole numbers", array(domain={"cells": [8, 8.5, 8], "dx": DX}))
        self.refused('scheme = "magic": must be one of exact', array(scheme="magic"))
        self.refused("stop.max_steps: must be a whole number", array(stop={"max_steps": -1}))
        solid = dict(array()["solids"][0], colour="red")
        self.refused("solids[0].colour: unknown key", array(solids=[solid]))
        self.refused("a solid is free or moving", array(solids=[dict(array()["solids"][0], free=True, moving=True, density=1)]))
        sphere = dict(array()["solids"][0], free=True, density=1.0, body=1)
        self.refused("free or moving otherwise than solids[0]", array(solids=[sphere, dict(array()["solids"][0], body=1)]))
        self.refused("solids[1].velocity: with the velocities of the first part", array(solids=[sphere, dict(sphere, velocity=[1, 0, 0])]))
        self.refused("solids[1]: has the place and size of solids[0]; leave one", array(solids=array()["solids"] * 2))
        self.refused("a pipe cannot be free", array(solids=[dict(sphere, shape="pipe")]))
        self.refused("boundaries.x.max: missing", array(boundaries={"x": {"min": {"type": "noSlip"}}}))
        self.refused('boundaries.x: must be "periodic" or {"min"', array(boundaries={"x": "noSlip"}))
        self.refused("boundaries.x.min.pressure: missing", array(boundaries={"x": {"min": {"type": "pressure"}, "max": {}}}))
        self.refused("boundaries.x.min.velocity: missing", array(boundaries={"x": {"min": {"type": "velocity"}, "max": {}}}))
        self.refused("boundaries.x.min.velocity: unknown key", array(boundaries={"x": {"min": {"type": "freeSlip", "velocity": [0, 0, 0]}, "max": {}}}))
        self.refused('boundaries.x.min.type = "wet"', array(boundaries={"x": {"min": {"type": "wet"}, "max": {}}}))

    def test_a_key_that_stands_twice_is_named(self):
        text = json.dumps(array())
        self.refused("tau: stands twice", text.replace('"tau":', '"tau": 2.0, "tau":'))
        self.refused("domain.dx: stands twice", text.replace('"dx":', '"dx": 1.0, "dx":'))
        two = json.dumps(array(solids=array()["solids"] + [dict(array()["solids"][0], center=[0, 0, 0])]))
        before, after = two.rsplit('"radius":', 1)
        self.refused("solids[1].radius: stands twice", before + '"radius": 1.0, "radius":' + after)

    def test_more_threads_than_processors_are_not_used(self):
        status, many, message = run(array(threads=1000000, stop={"max_steps": 20}))
        self.assertEqual(status, 0, message)
        self.assertRegex(message, r"threads = 1000000: there are (\d+) processors, so \1 are used")
        _, one, _ = run(array(threads=1, stop={"max_steps": 20}))
        self.assertEqual(many["solids"], one["solids"])

    def test_a_benchmark_without_sense_is_refused(self):
        for option, value, text in (("--seconds", "", "needs a value"), ("--cells", "8.5", "whole"), ("--threads", "1000000", "from 1 to")):
            done = subprocess.run([PROGRAM, "bench", option, value], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn(option, done.stderr)
            self.assertIn(text, done.stderr)
        small = [PROGRAM, "bench", "--cells", "8", "--cases", "dilute", "--threads", "1", "--seconds", "0.01"]
        done = subprocess.run(small, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--cells 8: too few for spheres of four cells or more at a solid fraction of 0.02; use at least 19", done.stderr)

    def test_values_are_checked(self):
        self.refused("dx = -1", array(domain={"cells": [8, 8, 8], "dx": -1}))
        self.refused("must lie between", array(tau=0.5))
        self.refused("solid 0: radius", array(solids=[{"center": [0, 0, 0], "radius": DX}]))
        free = {"center": [4 * DX] * 3, "free": True, "density": 1.0}
        self.refused("solids[0].radius: must be finite and > 0", array(solids=[dict(free, radius=0)]))
        self.refused("solids[0].half_extents: must be finite and > 0", array(solids=[dict(free, shape="box", half_extents=[DX, 0, DX])]))
        self.refused("solids[0].orientation: must be a unit quaternion", array(solids=[dict(free, shape="box", half_extents=[DX] * 3, orientation=[0, 0, 0, 0])]))
        self.refused("larger than the box along x", array(solids=[{"center": [0, 0, 0], "radius": 5 * DX}]))
        walls = {axis: {"min": {"type": "noSlip"}, "max": {"type": "noSlip"}} for axis in "xyz"}
        self.refused("larger than twice the box", array(boundaries=walls, solids=[{"center": [0, 0, 0], "radius": 900 * DX}]))

    def test_text_that_is_no_case(self):
        self.refused("not valid JSON", "{")
        self.refused("not valid JSON", json.dumps(array()).replace("1.0", "1e999"))
        self.refused("must be an object", "[]")
        done = subprocess.run([PROGRAM, "run", "/nowhere.json"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("/nowhere.json: cannot be read", done.stderr)
        done = subprocess.run([PROGRAM, "run", "/tmp"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2, done.stderr)

    def test_runs_that_fail_say_so(self):
        status, result, message = run(array(stop={"steady": 1e-12, "max_steps": 400}))
        self.assertEqual(status, 3)
        self.assertFalse(result["converged"])
        self.assertIn("raise stop.max_steps", message)
        self.refused("output.vtk: /nowhere/at/all.vti cannot be written", array(output={"vtk": "/nowhere/at/all.vti"}))
        with tempfile.TemporaryDirectory() as folder:
            self.refused("tau", array(tau=0.1, output={"vtk": os.path.join(folder, "flow.vti")}))
            self.assertEqual(os.listdir(folder), [])
        # The disk is full when the run ends: the numbers are there all the same.
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "flow.vti")
            os.symlink("/dev/full", path)
            status, result, message = run(array(output={"vtk": path}, stop={"max_steps": 5}))
            self.assertEqual(status, 3)
            self.assertEqual(result["steps"], 5)
            self.assertIn(f"cannot write {path}", message)
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([PROGRAM, "run", "-"], input=json.dumps(array(stop={"max_steps": 5})), stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 3)
        self.assertIn("cannot be written to standard output", done.stderr)
        status, _, message = run(array(acceleration=[1e3, 0, 0]))
        self.assertEqual(status, 3)
        self.assertIn("above the limit", message)

    def test_wrong_usage_is_explained(self):
        done = subprocess.run([PROGRAM, "fly"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("usage: lbm run CASE.json", done.stderr)
        for words in (["--help"], ["-h"], ["run", "--help"], ["bench", "-h"]):
            done = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout[:6]), (0, "usage:"), words)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
