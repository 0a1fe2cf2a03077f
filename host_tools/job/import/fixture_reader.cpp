// A box has x and y, a cylinder centre and diameter.
#include "host_tools/job/import/fixture_reader.hpp"

#include "host_tools/job/import/job_key_tables.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::Fixture;

namespace {

// The rules of its table say that it is one of both.
Fixture read_fixture(JobTable& keys)
{
    Fixture fixture;
    fixture.name = keys.text("name").value_or(keys.name());
    const auto centre = keys.point("centre");
    const auto diameter = keys.number("diameter");
    const auto x = keys.extent("x");
    const auto y = keys.extent("y");
    if (centre) {
        fixture.low = fixture.high = *centre;
        fixture.radius = *diameter / 2;
    } else if (x) {
        fixture.low = {(*x)[0], (*y)[0]};
        fixture.high = {(*x)[1], (*y)[1]};
    } else {
        keys.refuse("x", "is missing: a box has x and y, a cylinder centre and diameter");
    }
    fixture.top = keys.number("top").value();
    fixture.margin = keys.number_or_default("margin");
    return fixture;
}

}  // namespace

std::vector<Fixture> read_fixtures(JobTable& top, const SetupTables& setups, std::size_t setup)
{
    std::vector<Fixture> fixtures;
    for (JobTable& keys : top.each("fixture", fixture_table())) {
        const std::size_t place = setups.place_of(keys);
        const Fixture fixture = read_fixture(keys);
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
