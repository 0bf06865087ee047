#pragma once

#include <core/GlobalEngine.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>

#include <cstddef>

// What was measured on Debian 12's YADE 2023.02a. A declaration that is edited by mistake does not compile.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
namespace yade {

static_assert(sizeof(Serializable) == 24 && sizeof(Engine) == 104 && sizeof(GlobalEngine) == 104);
static_assert(sizeof(TimingInfo) == 16 && sizeof(TimingDeltas) == 64);
static_assert(sizeof(Shape) == 96 && sizeof(Sphere) == 104 && sizeof(Box) == 120 && sizeof(State) == 320 &&
              sizeof(Body) == 176);
static_assert(sizeof(BodyContainer) == 200 && sizeof(ForceContainer) == 304 && sizeof(Scene) == 752);
static_assert(sizeof(Cell) == 1104);

static_assert(offsetof(Engine, scene) == 24 && offsetof(Engine, timingInfo) == 32);
static_assert(offsetof(Engine, timingDeltas) == 48 && offsetof(Engine, dead) == 64);
static_assert(offsetof(Engine, ompThreads) == 68 && offsetof(Engine, label) == 72);
static_assert(offsetof(NewtonIntegrator, damping) == 256 && offsetof(NewtonIntegrator, gravity) == 264);
static_assert(offsetof(State, se3) == 88 && offsetof(State, vel) == 144 && offsetof(State, mass) == 168);
static_assert(offsetof(State, angVel) == 176 && offsetof(State, inertia) == 224);
static_assert(offsetof(State, blockedDOFs) == 304);
static_assert(offsetof(Body, id) == 24 && offsetof(Body, groupMask) == 28 && offsetof(Body, state) == 56);
static_assert(offsetof(Body, shape) == 72 && offsetof(Body, clumpId) == 152);
static_assert(offsetof(BodyContainer, body) == 24 && offsetof(Shape, color) == 64 && offsetof(Sphere, radius) == 96);
static_assert(offsetof(Box, extents) == 96);
static_assert(offsetof(Scene, forces) == 32 && offsetof(Scene, dt) == 440 && offsetof(Scene, iter) == 448);
static_assert(offsetof(Scene, time) == 464 && offsetof(Scene, isPeriodic) == 496);
static_assert(offsetof(Scene, engines) == 552 && offsetof(Scene, _nextEngines) == 576 &&
              offsetof(Scene, bodies) == 600 && offsetof(Scene, cell) == 688);
static_assert(offsetof(Cell, hSize) == 736 && offsetof(Cell, prevHSize) == 808 && offsetof(Cell, velGrad) == 880);

}  // namespace yade
#pragma GCC diagnostic pop
