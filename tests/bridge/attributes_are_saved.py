import math
import os
import tempfile
import warnings

from claims import *

VALUES = dict(
    lower=(1e-3, 2e-3, 3e-3),
    upper=(13e-3, 14e-3, 15e-3),
    dx=1e-3,
    density=970.0,
    viscosity=0.373,
    gravity=(0, 0.5, -9.81),
    acceleration=(1e-3, 0, 0),
    initialVelocity=(0.01, 0, 0.02),
    boundary=["periodic", "periodic", "noSlip", "noSlip", "pressure", "noSlip"],
    boundaryVelocity=[(0, 0, 0), (0, 0, 0), (0.01, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0.02, 0)],
    boundaryPressure=[0.0, 0.0, 0.0, 0.0, 1.5, 0.0],
    tau=0.75,
    magicParameter=0.1875,
    inertia=False,
    scheme="superposition",
    collision="trt",
    lattice="D3Q27",
    storage="double",
    mask=3,
    ids=[0],
    lubrication=False,
    lubricationRoughness=2e-3,
    maxMach=0.15,
    accuracy=0.03,
    stopFile="stopped.vti",
    ranks=0,
    dead=True,
    ompThreads=2,
    label="water",
)


def same(found, expected):
    if isinstance(expected, float) and math.isnan(expected):
        return math.isnan(found)
    if isinstance(expected, (tuple, list)) and expected and isinstance(expected[0], (int, float)):
        return all(a == b for a, b in zip(found, expected)) and len(found) == len(expected)
    if isinstance(expected, (tuple, list)):
        return len(found) == len(expected) and all(same(a, b) for a, b in zip(found, expected))
    return found == expected


def check_attributes(engine, values):
    for name, value in values.items():
        found = getattr(engine, name)
        check(same(found, value), "%s is %s, was %s" % (name, found, value))


def keywords_become_attributes():
    from yadelbm import LbmEngine

    engine = LbmEngine(**VALUES)
    check_attributes(engine, VALUES)
    check(set(VALUES) == set(engine.dict()), "dict() lists %s" % sorted(engine.dict()))


def every_attribute_is_documented():
    from yadelbm import LbmEngine

    for name in list(VALUES) + ["plan", "fluidForce", "velocity", "fluidDt", "totalMomentum"]:
        if name not in ("dead", "ompThreads", "label"):
            check(len(getattr(LbmEngine, name).__doc__ or "") > 20, "%s has no documentation" % name)


def files_keep_attributes():
    from yadelbm import LbmEngine

    folder = tempfile.mkdtemp()
    for name in ("scene.xml", "scene.xml.bz2", "scene.yade", "scene.yade.gz"):
        path = os.path.join(folder, name)
        for values in (VALUES, dict(VALUES, tau=math.nan, magicParameter=math.nan)):
            O.reset()
            O.engines = [LbmEngine(**values)]
            O.save(path)
            O.reset()
            O.load(path)
            check(len(O.engines) == 1 and type(O.engines[0]) is LbmEngine, "%s: engine lost" % name)
            check_attributes(O.engines[0], values)


def unset_values_are_kept_as_unset():
    from yadelbm import LbmEngine

    O.engines = [LbmEngine()]
    O.saveTmp()
    O.loadTmp()
    check(math.isnan(O.engines[0].dx) and math.isnan(O.engines[0].upper[2]), "unset values did not survive")


def label_is_bound_again_after_loading():
    import builtins
    from yadelbm import LbmEngine

    O.engines = [LbmEngine(**VALUES)]
    O.saveTmp()
    before = builtins.water
    O.loadTmp()
    check(builtins.water is not before, "label still names the old engine")
    check_attributes(builtins.water, VALUES)


def loaded_fluid_starts_from_rest():
    fluid = one_sphere(boundary=PERIODIC, acceleration=(0.01, 0, 0))
    O.run(20, True)
    check(fluid.averageVelocity()[0] > 0, "drive does nothing")
    O.saveTmp()
    O.loadTmp()
    fluid = O.engines[3]
    check(fluid.fluidSteps == 0, "%d fluid steps after loading" % fluid.fluidSteps)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        O.run(20, True)
    said = [str(warning.message) for warning in caught]
    check(any("goes on at step 20 with a fluid at rest" in text for text in said), "no warning: %s" % said)
    check(fluid.fluidSteps > 0 and fluid.averageVelocity()[0] > 0, "loaded fluid does not run")


prove(
    keywords_become_attributes,
    every_attribute_is_documented,
    files_keep_attributes,
    unset_values_are_kept_as_unset,
    label_is_bound_again_after_loading,
    loaded_fluid_starts_from_rest,
)
