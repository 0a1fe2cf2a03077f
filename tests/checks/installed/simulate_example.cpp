// Runs a program on the controller's core: simulate_example PROGRAM
#include <cstdio>
#include <exception>

#include "host_tools/controller/simulate/simulate.hpp"

int main(int argc, char** argv)
try {
    if (argc != 2) {
        return 2;
    }
    const cusp::simulate::SimulationResult run = cusp::simulate::simulate(argv[1], {});
    std::printf("%.3f s in motion, off the path by %.6f mm at most\n", run.duration_s,
                run.max_deviation_mm);
    return run.good() ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
