// Random numbers of a seed.
#pragma once

#include <random>

namespace cusp::test {

struct Draw {
    std::mt19937 engine;

    double uniform(double low, double high)
    {
        return std::uniform_real_distribution<double>{low, high}(engine);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>{low, high}(engine); }
};

}  // namespace cusp::test
