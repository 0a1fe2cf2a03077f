// A box has x and y, a cylinder centre and diameter.
#include "host_tools/import/fixture_reader.hpp"

#include "host_tools/import/known_keys.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Fixture;

namespace {

constexpr double kDefaultMargin = 1.0;  // mm

std::vector<double> pair_of(JobTable& keys, const char* key, const char* other)
{
    const auto values = keys.numbers(key, kAnyNumber);
    if (!values || values->size() != 2) {
        keys.refuse(
            key,
            fmt::format("{}: two numbers are needed, with {}",
                        values ? "has " + std::to_string(values->size()) : "is missing", other));
    }
    return *values;
}

}  // namespace

Fixture read_fixture(const toml::table& table,
                     const std::string& file,
                     std::size_t index,
                     double millimetres)
{
    JobTable keys{table, file, fmt::format("fixture {}", index), fixture_keys()};
    Fixture fixture;
    fixture.name = keys.text("name").value_or(fmt::format("fixture {}", index));
    const auto diameter = keys.number("diameter", kPositive);
    const bool round = diameter || table.contains("centre");
    if (round) {
        const std::vector<double> centre = pair_of(keys, "centre", "diameter");
        if (!diameter) {
            keys.refuse("diameter", "is missing: a cylinder has centre and diameter");
        }
        if (table.contains("x") || table.contains("y")) {
            keys.refuse(table.contains("x") ? "x" : "y", "is a box', centre a cylinder's");
        }
        fixture.low = fixture.high = {centre[0] * millimetres, centre[1] * millimetres};
        fixture.radius = *diameter / 2 * millimetres;
    } else {
        const std::vector<double> x = pair_of(keys, "x", "y, or centre and diameter");
        const std::vector<double> y = pair_of(keys, "y", "x");
        if (!(x[0] < x[1]) || !(y[0] < y[1])) {
            keys.refuse(x[0] < x[1] ? "y" : "x",
                        "two numbers [min, max] are needed, min below max");
        }
        fixture.low = {x[0] * millimetres, y[0] * millimetres};
        fixture.high = {x[1] * millimetres, y[1] * millimetres};
    }
    fixture.top = keys.required_number("top", kAnyNumber) * millimetres;
    fixture.margin = keys.length("margin", kNotNegative, millimetres).value_or(kDefaultMargin);
    return fixture;
}

}  // namespace cusp::import
