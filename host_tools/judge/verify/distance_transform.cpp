// The lower envelope of parabolas, along columns and then along rows.
#include "host_tools/judge/verify/distance_transform.hpp"

#include <cmath>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::verify {

namespace {

// For points that are not marked. Finite, since parabolas of such points are intersected.
constexpr double kUnmarked = 1e20;

// values[i] = min over k of values[k] + (i - k)^2
void transform_line(std::vector<double>& values)
{
    const std::size_t n = values.size();
    std::vector<std::size_t> at(n);   // of the parabolas of the envelope
    std::vector<double> from(n + 1);  // where each begins
    std::vector<double> out(n);
    const auto meet = [&](std::size_t a, std::size_t b) {
        const auto x = static_cast<double>(a);
        const auto y = static_cast<double>(b);
        return (values[b] + y * y - values[a] - x * x) / (2 * (y - x));
    };
    std::size_t last = 0;
    at[0] = 0;
    from[0] = -kUnmarked * 4;
    for (std::size_t q = 1; q < n; ++q) {
        double s = meet(at[last], q);
        while (s <= from[last] && last > 0) {
            --last;
            s = meet(at[last], q);
        }
        ++last;
        at[last] = q;
        from[last] = s;
    }
    std::size_t k = 0;
    for (std::size_t i = 0; i < n; ++i) {
        while (k < last && from[k + 1] < static_cast<double>(i)) {
            ++k;
        }
        const double d = static_cast<double>(i) - static_cast<double>(at[k]);
        out[i] = values[at[k]] + d * d;
    }
    values = std::move(out);
}

}  // namespace

std::vector<double> distances_from(const std::vector<char>& marked, const HeightGrid& grid)
{
    std::vector<double> square(marked.size());
    std::vector<double> line(grid.ny);
    for (std::size_t i = 0; i < grid.nx; ++i) {
        for (std::size_t j = 0; j < grid.ny; ++j) {
            line[j] = marked[grid.index(i, j)] != 0 ? 0.0 : kUnmarked;
        }
        transform_line(line);
        for (std::size_t j = 0; j < grid.ny; ++j) {
            square[grid.index(i, j)] = line[j];
        }
    }
    line.resize(grid.nx);
    for (std::size_t j = 0; j < grid.ny; ++j) {
        for (std::size_t i = 0; i < grid.nx; ++i) {
            line[i] = square[grid.index(i, j)];
        }
        transform_line(line);
        for (std::size_t i = 0; i < grid.nx; ++i) {
            const double d = line[i];
            square[grid.index(i, j)] = d < kUnmarked / 2 ? grid.pitch * std::sqrt(d) : kUnbounded;
        }
    }
    return square;
}

}  // namespace cusp::verify
