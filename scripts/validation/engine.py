"""Runs of the engine, alone and in YADE, and the reference tables."""

import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile

import numpy as np

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
REFERENCE = os.path.join(ROOT, "tests", "reference")
PROGRAM = os.path.join(ROOT, "build", "bin", "lbm")
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"}


class RunFailed(RuntimeError):
    """A run that diverged, did not become steady, or was refused; the message says why."""


def reference(name):
    """Rows of tests/reference/NAME as dictionaries of strings; lines that start with # are comments."""
    with open(os.path.join(REFERENCE, name), encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def lbm(case):
    """Result of `lbm run` for a case (docs/user-guide.md), run on one thread.

    Adds `cells`, their number. @raise RunFailed with the program's message
    """
    text = json.dumps({**case, "threads": 1})
    done = subprocess.run([PROGRAM, "run", "-"], input=text, capture_output=True, text=True, env={**os.environ, **ONE_THREAD})
    if done.returncode != 0:
        raise RunFailed((done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1])
    result = json.loads(done.stdout)
    result["cells"] = math.prod(case["domain"]["cells"])
    return result


def yade(script, arguments):
    """What a script of scripts/validation/scenes/, run by stock yade on one thread, leaves as its result.

    The script finds `arguments` as JSON in the file named by its first argument and writes its result to that of the second.
    @raise RunFailed with the end of its output
    """
    with tempfile.TemporaryDirectory() as folder:
        given, found = os.path.join(folder, "arguments.json"), os.path.join(folder, "result.json")
        with open(given, "w", encoding="utf-8") as file:
            json.dump(arguments, file)
        path = os.path.join(ROOT, "scripts", "validation", "scenes", script)
        done = subprocess.run([os.path.join(ROOT, "scripts", "yade"), "-n", "-x", "-j1", path, given, found],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                              env={**os.environ, **ONE_THREAD, "PYTHONPATH": os.path.dirname(path)})
        if not os.path.exists(found):
            raise RunFailed(((done.stdout + done.stderr).strip().splitlines() or ["no output"])[-1].replace(ROOT, ""))
        with open(found, encoding="utf-8") as file:
            return json.load(file)


def stokes(cells, solids, tau, steady=1e-6, **more):
    """A case of steady Stokes flow in units of the cell: dx = 1, density = 1, viscosity = 1."""
    return {
        "domain": {"cells": list(cells), "dx": 1.0},
        "fluid": {"density": 1.0, "viscosity": 1.0},
        "tau": tau,
        "inertia": False,
        "solids": solids,
        "stop": {"steady": steady, "max_steps": 1000000},
        **more,
    }


def read_vti(path, name):
    """A field of a file that the engine wrote, as a flat array."""
    with open(path, "rb") as file:
        head, data = file.read().split(b'<AppendedData encoding="raw">\n_', 1)
    offset = int(re.search(rb'Name="%s"[^>]*offset="(\d+)"' % name.encode(), head).group(1))
    size = int.from_bytes(data[offset:offset + 8], sys.byteorder)
    return np.frombuffer(data, np.float32, size // 4, offset + 8)


def sphere(center, radius, **more):
    """A sphere of a case."""
    return {"shape": "sphere", "center": list(center), "radius": radius, **more}


def offsets(count):
    """Sub-cell positions that fill the cell evenly (Roberts' additive sequence); the first is (0, 0, 0)."""
    g = 1.2207440846057596  # g^4 = g + 1
    return [[i / g**d % 1 for d in (1, 2, 3)] for i in range(count)]
