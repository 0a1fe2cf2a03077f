// A box has x and y, a cylinder centre and diameter.
#include "host_tools/job/import/fixture_reader.hpp"

#include <array>

#include "host_tools/job/import/job_key_tables.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Fixture;

namespace {

[[noreturn]] void refuse_missing(const JobTable& keys, const char* key, const char* other)
{
    keys.refuse(key, fmt::format("is missing: two numbers are needed, with {}", other));
}

std::array<double, 2> extent_of(JobTable& keys, const char* key, const char* other, double unit)
{
    const auto extent = keys.extent(key, unit);
    if (!extent) {
        refuse_missing(keys, key, other);
    }
    return *extent;
}

Vec2d centre_of(JobTable& keys, double unit)
{
    const auto values = keys.numbers("centre");
    if (!values) {
        refuse_missing(keys, "centre", "diameter");
    }
    if (values->size() != 2) {
        keys.refuse("centre", fmt::format("has {} numbers: two are needed", values->size()));
    }
    return {(*values)[0] * unit, (*values)[1] * unit};
}

Fixture read_fixture(const toml::table& table,
                     JobTable& keys,
                     std::size_t index,
                     double millimetres)
{
    Fixture fixture;
    fixture.name = keys.text("name").value_or(fmt::format("fixture {}", index));
    const auto diameter = keys.number("diameter");
    const bool round = diameter || table.contains("centre");
    if (round) {
        const Vec2d centre = centre_of(keys, millimetres);
        if (!diameter) {
            keys.refuse("diameter", "is missing: a cylinder has centre and diameter");
        }
        if (table.contains("x") || table.contains("y")) {
            keys.refuse(table.contains("x") ? "x" : "y", "is a box', centre a cylinder's");
        }
        fixture.low = fixture.high = centre;
        fixture.radius = *diameter / 2 * millimetres;
    } else {
        const auto x = extent_of(keys, "x", "y, or centre and diameter", millimetres);
        const auto y = extent_of(keys, "y", "x", millimetres);
        fixture.low = {x[0], y[0]};
        fixture.high = {x[1], y[1]};
    }
    fixture.top = keys.required_number("top") * millimetres;
    fixture.margin = keys.length_or_default("margin", millimetres);
    return fixture;
}

}  // namespace

std::vector<Fixture> read_fixtures(JobTable& top,
                                   const std::string& file,
                                   const SetupTables& setups,
                                   std::size_t setup,
                                   double millimetres)
{
    std::vector<Fixture> fixtures;
    const auto tables = top.tables("fixture");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        JobTable keys{*tables[i], file, fmt::format("fixture {}", i + 1), fixture_table().keys};
        const std::size_t place = setups.place_of(keys);
        const Fixture fixture = read_fixture(*tables[i], keys, i + 1, millimetres);
        if (place == setup || !keys.has("setup")) {
            fixtures.push_back(fixture);
        }
    }
    return fixtures;
}

void rise_over_fixtures(job::Job& job)
{
    for (const Fixture& fixture : job.fixtures) {
        const double over = fixture.top + fixture.margin - job.stock_top;
        if (over > job.clearance) {
            job.notes.push_back(fmt::format(
                "clearance: {:g} mm above the stock's top in place of {:g}, to be over {}", over,
                job.clearance, fixture.name));
            job.clearance = over;
        }
    }
}

}  // namespace cusp::import
