#!/usr/bin/python3
"""Checks who includes whom: the layers of the engine, the engine and YADE, and what a library must not do.

usage: check_layers.py ROOT | --self-test
"""

import argparse
import re
import sys
import tempfile
from pathlib import Path, PurePosixPath

LAYERS = ("lattice", "physics", "fields", "domain", "output", "facade")  # each may use itself and those before it
WITHOUT_OPENMP = ("lattice", "physics", "output")
WITH_MPI = ("domain",)
SUFFIXES = (".hpp", ".cpp", ".h", ".ipp", ".inl")

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
YADE = re.compile(r"(^|/)yade|^(core|pkg)/|^lib/(base|factory|high-precision|multimethods|pyutil|serialization)/")
PYTHON = re.compile(r"^(Python\.h$|boost/python|numpy/|pybind11/)")
MPI = re.compile(r"^(mpi\.h|boost/mpi.*)$")
OPENMP = re.compile(r'#\s*pragma\s+omp\b|_Pragma\s*\(\s*"omp\b')
PRINTS = re.compile(r"\bstd::(cout|cerr|clog)\b|(?<![\w.>])(v?printf|puts|putchar|perror)\s*\(|\b(stdout|stderr)\b")
ENDS = re.compile(r"(?<![\w.>])(exit|_Exit|quick_exit|abort|terminate|MPI_Init(_thread)?|MPI_Finalize|MPI_Abort)\s*\(")
LITERAL_OR_COMMENT = re.compile(
    r"""//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'""", re.DOTALL
)


def without_comments(text, *, strings):
    """The code of `text`, line for line; string literals stay if `strings`."""

    def blank(match):
        is_comment = match[0][0] == "/"
        return match[0] if strings and not is_comment else "\n" * match[0].count("\n")

    return LITERAL_OR_COMMENT.sub(blank, text)


class Project:
    def __init__(self, root):
        self.root = Path(root)
        self.source = PurePosixPath("lbm_engine/src")
        self.public = PurePosixPath("lbm_engine/include")
        self.program = PurePosixPath("lbm_engine/app")
        self.bridge = PurePosixPath("yade_bridge")

    def files(self):
        for top in ("lbm_engine", "yade_bridge"):
            for path in sorted((self.root / top).rglob("*")):
                if path.suffix in SUFFIXES:
                    yield PurePosixPath(path.relative_to(self.root).as_posix())

    def layer(self, path):
        """Layer of a file of the engine's sources, None for any other."""
        if path is None or not path.is_relative_to(self.source):
            return None
        return path.relative_to(self.source).parts[0]

    def resolve(self, includer, name):
        """The file of the project that an include means, None for a header of somebody else."""
        for folder in (includer.parent, self.source, self.public, self.bridge, PurePosixPath()):
            found = (self.root / folder / name).resolve()
            if found.is_file() and found.is_relative_to(self.root.resolve()):
                return PurePosixPath(found.relative_to(self.root.resolve()).as_posix())
        if name.split("/")[0] in LAYERS and "/" in name:
            return self.source / name
        return None

    def violations(self):
        checked = 0
        for path in self.files():
            checked += 1
            text = (self.root / path).read_text(encoding="utf-8")
            yield from self.violations_of_place(path)
            with_strings = without_comments(text, strings=True).splitlines()
            code = without_comments(text, strings=False).splitlines()
            for number, (full, bare) in enumerate(zip(with_strings, code), 1):
                include = INCLUDE.match(full)
                found = self.include_violations(path, include[1]) if include else self.code_violations(path, full, bare)
                yield from (f"{path}:{number}: {message}" for message in found)
        if not checked:
            yield f"{self.root}: no sources of lbm_engine or yade_bridge here"

    def violations_of_place(self, path):
        layer = self.layer(path)
        if layer is not None and layer not in LAYERS:
            yield f"{path}:1: lies in no layer: move it to one of {', '.join(LAYERS)}"

    def include_violations(self, path, name):
        target = self.resolve(path, name)
        layer, used = self.layer(path), self.layer(target)
        if path.is_relative_to(self.bridge):
            if target and target.is_relative_to("lbm_engine") and not target.is_relative_to(self.public):
                yield f"the bridge includes {name}: only the engine's public headers <lbm/...> are its business"
            return
        if layer in LAYERS and used in LAYERS and LAYERS.index(used) > LAYERS.index(layer):
            yield f"{layer} includes {name} of the later layer {used}"
        if path.is_relative_to(self.public) and used is not None:
            yield f"a public header includes the private {name}"
        if YADE.search(name) or (target and target.is_relative_to(self.bridge)):
            yield f"the engine includes {name}: only the bridge knows YADE"
        if PYTHON.search(name):
            yield f"the engine includes {name}: only the bridge knows Python"
        if path.is_relative_to(self.program):
            return
        if MPI.match(name) and layer not in WITH_MPI:
            yield f"includes {name} outside {', '.join(WITH_MPI)}"
        if name == "omp.h" and layer in WITHOUT_OPENMP:
            yield f"{layer} includes omp.h: loops over cells belong to fields"
        if name == "iostream":
            yield "includes iostream: the library never prints"

    def code_violations(self, path, full, bare):
        if path.is_relative_to(self.program):
            return
        if OPENMP.search(full) and self.layer(path) in WITHOUT_OPENMP:
            yield f"{self.layer(path)} uses OpenMP: loops over cells belong to fields"
        if match := PRINTS.search(bare):
            yield f"uses {match[0].rstrip(' (')}: the library never prints"
        if match := ENDS.search(bare):
            yield f"calls {match[0].rstrip(' (')}: the library never starts or ends what belongs to its caller"


ALLOWED = {
    "lbm_engine/include/lbm/fluid.hpp": '#include "lbm/errors.hpp"\n#include <vector>\n',
    "lbm_engine/include/lbm/errors.hpp": "#include <stdexcept>\n",
    "lbm_engine/src/lattice/d3q19.hpp": '#include <array>\n// #include "facade/fluid.hpp"\n/* std::cout\n#pragma omp */\n',
    "lbm_engine/src/physics/collide.hpp": '#include "lattice/d3q19.hpp"\n#include "lbm/errors.hpp"\n#include "weight.hpp"\n',
    "lbm_engine/src/physics/weight.hpp": 'auto s = "printf(exit(1)) // std::cerr";\n' + "auto c = '\"'; snprintf(b, 1'0, s);\n",
    "lbm_engine/src/fields/sweep.cpp": '#include "physics/collide.hpp"\n#include <omp.h>\n#pragma omp parallel for\n',
    "lbm_engine/src/domain/halo.cpp": "#include <mpi.h>\nhalo.abort();\n",
    "lbm_engine/src/output/vtk.cpp": '#include "fields/grid.hpp"\n#include "domain/halo.hpp"\n',
    "lbm_engine/src/facade/fluid.cpp": '#include "lbm/fluid.hpp"\n#include "output/vtk.hpp"\n',
    "lbm_engine/app/main.cpp": '#include "lbm/fluid.hpp"\n#include <iostream>\nstd::cout << 1;\nstd::exit(3);\nMPI_Init(0, 0);\n',
    "yade_bridge/engine.cpp": '#include "lbm/fluid.hpp"\n#include <core/Engine.hpp>\n#include "abi/output/core.hpp"\n',
}

FORBIDDEN = (  # file, line, what the message says
    ("lbm_engine/src/lattice/a.hpp", '#include "physics/collide.hpp"', "later layer physics"),
    ("lbm_engine/src/lattice/b.hpp", '#include "../physics/collide.hpp"', "later layer physics"),
    ("lbm_engine/src/physics/a.cpp", "#include <fields/not_there.hpp>", "later layer fields"),
    ("lbm_engine/src/fields/a.cpp", '# include "domain/halo.cpp"', "later layer domain"),
    ("lbm_engine/src/domain/a.cpp", '#include "output/vtk.cpp"', "later layer output"),
    ("lbm_engine/src/output/a.cpp", '#include "facade/fluid.cpp"', "later layer facade"),
    ("lbm_engine/src/loose.cpp", "int n;", "lies in no layer"),
    ("lbm_engine/src/fields/b.cpp", "#include <mpi.h>", "includes mpi.h outside domain"),
    ("lbm_engine/include/lbm/a.hpp", "#include <mpi.h>", "includes mpi.h outside domain"),
    ("lbm_engine/include/lbm/b.hpp", '#include "lattice/d3q19.hpp"', "public header"),
    ("lbm_engine/src/physics/b.cpp", "#include <omp.h>", "includes omp.h"),
    ("lbm_engine/src/physics/c.cpp", "#pragma omp simd", "uses OpenMP"),
    ("lbm_engine/src/output/c.cpp", '_Pragma("omp parallel")', "uses OpenMP"),
    ("lbm_engine/src/facade/a.cpp", "#include <core/Scene.hpp>", "only the bridge knows YADE"),
    ("lbm_engine/app/a.cpp", '#include "yade/core/Scene.hpp"', "only the bridge knows YADE"),
    ("lbm_engine/src/facade/b.cpp", "#include <boost/python.hpp>", "only the bridge knows Python"),
    ("lbm_engine/src/facade/c.cpp", "#include <iostream>", "never prints"),
    ("lbm_engine/src/facade/d.cpp", "std::cerr << x;", "never prints"),
    ("lbm_engine/src/facade/e.cpp", "    std::printf(x);", "never prints"),
    ("lbm_engine/src/facade/f.cpp", "fprintf(stderr, x);", "never prints"),
    ("lbm_engine/src/facade/g.cpp", "if (bad) std::exit(1);", "calls exit"),
    ("lbm_engine/src/facade/h.cpp", "abort();", "calls abort"),
    ("lbm_engine/src/domain/b.cpp", "MPI_Init(&argc, &argv);", "calls MPI_Init"),
    ("yade_bridge/a.cpp", '#include "../lbm_engine/src/facade/fluid.cpp"', "the bridge includes"),
    ("yade_bridge/b.cpp", '#include "physics/collide.hpp"', "the bridge includes"),
    ("yade_bridge/c.cpp", "std::cout << x;", "never prints"),
)


def self_test():
    def check(files):
        with tempfile.TemporaryDirectory() as root:
            for name, text in files.items():
                path = Path(root, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return list(Project(root).violations())

    failures = [f"allowed, but reported: {message}" for message in check(ALLOWED)]
    if not check({}):
        failures.append("an empty tree is not reported")
    for path, line, expected in FORBIDDEN:
        found = check({**ALLOWED, path: line + "\n"})
        if len(found) != 1 or not found[0].startswith(f"{path}:1: ") or expected not in found[0]:
            failures.append(f"{path}: {line!r} should give one '{expected}', gives {found}")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("root", nargs="?", metavar="ROOT", help="root of the repository")
    parser.add_argument("--self-test", action="store_true", help="check the check, on files made for it")
    arguments = parser.parse_args()
    if bool(arguments.root) == arguments.self_test:
        parser.error("give either ROOT or --self-test")

    messages = self_test() if arguments.self_test else list(Project(arguments.root).violations())
    print("\n".join(messages) or "no violation")
    return 1 if messages else 0


if __name__ == "__main__":
    sys.exit(main())
