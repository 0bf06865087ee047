"""How long reading states and writing loads takes for 10,000 spheres. Not a test: numbers of one machine.

    scripts/yade tests/bridge/time_10000_spheres.py
"""

import random

from yade import timing
from yadelbm import LbmEngine

CELL = 1e-3
N = (25, 20, 20)  # spheres along x, y, z
SPACING = 5  # cells between their centres
SUB_CYCLES = 2
FLUID_STEPS = 20

random.seed(1)
size = [n * SPACING * CELL for n in N]
order = [(i, j, k) for i in range(N[0]) for j in range(N[1]) for k in range(N[2])]
random.shuffle(order)  # neighbours in memory are not neighbours in space
for i, j, k in order:
    O.bodies.append(utils.sphere([(index + 0.5) * SPACING * CELL for index in (i, j, k)], 2.1 * CELL))
    O.bodies[-1].state.vel = [random.uniform(-1e-3, 1e-3) for _ in range(3)]

fluid = LbmEngine(
    lower=(0, 0, 0), upper=size, dx=CELL, density=1000, viscosity=1e-2, boundary=["periodic"] * 6, tau=0.6, label="fluid"
)
O.engines = [ForceResetter(), fluid, NewtonIntegrator(damping=0)]
O.dt = 0.1 * CELL**2 * 1000 / (3 * 1e-2) / SUB_CYCLES
O.run(2 * SUB_CYCLES, True)
O.timingEnabled = True
timing.reset()
O.run(FLUID_STEPS * SUB_CYCLES, True)
timing.stats()
steps = fluid.timingDeltas.data[3][2]
milliseconds = {name: nanoseconds / steps * 1e-6 for name, nanoseconds, _ in fluid.timingDeltas.data}
print("%d spheres, %d grain steps per fluid step; per fluid step:" % (len(O.bodies), SUB_CYCLES))
for name, value in milliseconds.items():
    print("  %-15s %8.3f ms" % (name, value))
print("  states in + loads out: %.3f ms (target: below 1 ms)" % (milliseconds["states in"] + milliseconds["loads out"]))
