"""How a load of the fluid reaches grains that make several steps per fluid step: three schemes, on top of LbmEngine.

With the loads L of the present and the last fluid step the grains get, until the next one,

    held            L                       what LbmEngine does
    averaged        (L + L_last) / 2        less noise, later by half a fluid step
    extrapolated    (3 L - L_last) / 2      earlier by half a fluid step

All three hand over the same impulse in the long run.
"""

import builtins

from yade import O
from yade.wrapper import ForceResetter, NewtonIntegrator, PyRunner

SCHEMES = {"held": 0.0, "averaged": -0.5, "extrapolated": 0.5}  # times (L - L_last), on top of L


class Coupling:
    """Adds to the load of body 0 what makes LbmEngine's scheme another one, and keeps its motion."""

    def __init__(self, fluid, scheme):
        self.fluid, self.factor = fluid, SCHEMES[scheme]
        self.steps, self.load, self.last = 0, None, None
        self.history = []  # at the beginning of each fluid step: time, z, velocity and spin along z

    def correct(self):
        """Called by YADE between fluid and integrator."""
        if self.fluid.fluidSteps != self.steps:
            self.steps, self.last = self.fluid.fluidSteps, self.load
            self.load = self.fluid.fluidForce(0)
            state = O.bodies[0].state
            self.history.append((O.time, state.pos[2], state.vel[2], state.angVel[2]))
        if self.factor and self.last is not None:
            O.forces.addF(0, self.factor * (self.load - self.last))


def start(fluid, scheme, gravity=(0, 0, 0), contacts=()):
    """Completes a scene; returns its Coupling."""
    found = builtins.coupling = Coupling(fluid, scheme)
    O.engines = [ForceResetter(), *contacts, fluid, PyRunner(command="coupling.correct()", iterPeriod=1, initRun=True),
                 NewtonIntegrator(gravity=gravity, damping=0)]
    return found
