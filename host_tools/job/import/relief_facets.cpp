// stb_image decodes; pixels are averaged, then joined.
#include "host_tools/job/import/relief_facets.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>

#include "host_tools/base/files/files.hpp"
#include "host_tools/job/import/path_ending.hpp"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include "stb/stb_image.h"

namespace cusp::import {

namespace {

struct Greys {
    int columns{};
    int rows{};
    std::vector<double> values{};  // 0 to 1, from the lowest row up

    double& at(int column, int row)
    {
        return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column)];
    }
};

// The reason may hold bytes of the file.
[[noreturn]] void refuse_picture(const std::string& file)
{
    std::string reason = stbi_failure_reason();
    std::replace_if(
        reason.begin(), reason.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    throw InputError(fmt::format("{}: not a PNG picture: {}", file, reason));
}

Greys read_greys(const std::string& file)
{
    constexpr double kMostPixels = 2.5e7;
    const std::string bytes = files::text_of_file(file);
    const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
    constexpr std::size_t kMostBytes = std::numeric_limits<int>::max();
    const int size = static_cast<int>(std::min(bytes.size(), kMostBytes));
    int columns = 0;
    int rows = 0;
    int channels = 0;
    if (stbi_info_from_memory(data, size, &columns, &rows, &channels) == 0) {
        refuse_picture(file);
    }
    if (columns < 2 || rows < 2 || 1.0 * columns * rows > kMostPixels) {
        throw InputError(
            fmt::format("{}: has {} x {} pixels, 2 x 2 at least and {:g} at most are needed", file,
                        columns, rows, kMostPixels));
    }
    const std::unique_ptr<stbi_us, void (*)(void*)> pixels{
        stbi_load_16_from_memory(data, size, &columns, &rows, &channels, 1), stbi_image_free};
    if (!pixels) {
        refuse_picture(file);
    }
    constexpr double kWhite = std::numeric_limits<std::uint16_t>::max();
    Greys greys{columns, rows};
    greys.values.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int row = rows - 1; row >= 0; --row) {
        for (int column = 0; column < columns; ++column) {
            greys.values.push_back(
                pixels.get()[static_cast<std::ptrdiff_t>(row) * columns + column] / kWhite);
        }
    }
    return greys;
}

// Squares of `count` pixels become one; the rest at the right and upper edge is left out.
Greys averaged(Greys& fine, int count)
{
    Greys coarse{fine.columns / count, fine.rows / count};
    for (int row = 0; row < coarse.rows; ++row) {
        for (int column = 0; column < coarse.columns; ++column) {
            double sum = 0;
            for (int k = 0; k < count * count; ++k) {
                sum += fine.at(column * count + k % count, row * count + k / count);
            }
            coarse.values.push_back(sum / (count * count));
        }
    }
    return coarse;
}

}  // namespace

bool is_picture_file(const std::string& file) { return path_ending(file) == ".png"; }

Facets read_relief(const std::string& file, const ReliefSize& size)
{
    constexpr double kMostSamples = 1e6;
    Greys greys = read_greys(file);
    int count = 1;
    while (1.0 * greys.columns * greys.rows / count / count > kMostSamples) {
        ++count;
    }
    Facets facets;
    if (count > 1 && greys.columns >= 2 * count && greys.rows >= 2 * count) {
        facets.note = fmt::format("{} x {} pixels, averaged {} by {}", greys.columns, greys.rows,
                                  count, count);
        greys = averaged(greys, count);
    }
    const double pitch = size.width / (greys.columns - 1);
    const auto corner = [&](int column, int row) {
        return Vec3d{column * pitch, row * pitch,
                     size.black + greys.at(column, row) * (size.white - size.black)};
    };
    for (int row = 0; row + 1 < greys.rows; ++row) {
        for (int column = 0; column + 1 < greys.columns; ++column) {
            const Vec3d a = corner(column, row);
            const Vec3d b = corner(column + 1, row);
            const Vec3d c = corner(column + 1, row + 1);
            const Vec3d d = corner(column, row + 1);
            add_facet({a, b, c}, facets);
            add_facet({a, c, d}, facets);
        }
    }
    return facets;
}

}  // namespace cusp::import
