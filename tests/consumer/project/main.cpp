#include <lbm/fluid.hpp>

#include <cstdio>

int main()
{
    lbm::FluidConfig config;
    config.cells = {16, 16, 16};
    config.dx = 1e-4;
    config.density = 1000;
    config.viscosity = 1e-3;
    config.tau = 0.8;
    config.acceleration = {1e-3, 0, 0};

    lbm::Fluid fluid(config);
    fluid.place_solids({{.radius = 4e-4, .position = {8e-4, 8e-4, 8e-4}}});
    for (int i = 0; i < 10; ++i) fluid.step();

    const double speed = fluid.average_velocity()[0];
    const double drag = fluid.loads().at(0).force[0];
    std::printf("speed %g m/s, drag %g N\n", speed, drag);
    return speed > 0 && drag > 0 ? 0 : 1;
}
