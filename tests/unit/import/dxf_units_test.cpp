// Every unit of $INSUNITS against Autodesk's table in metres; $MEASUREMENT where there is none.
#include "host_tools/job/import/dxf_units.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/dxf_curves.hpp"
#include "tests/support/drawn_dxf.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::test;

TEST_GROUP(DxfUnits)
{
    TemporaryFolder folder;
    std::vector<std::string> notes;

    // The length of a line of one unit, mm.
    double unit_of_drawing(const DxfGroups& header, double job)
    {
        notes.clear();
        const std::string file =
            folder.with("d.dxf", dxf_drawing(dxf_line({0, 0}, {1, 0}), header));
        const auto line = read_dxf_paths(file, job, "o", &notes).paths[0].curves[0];
        return norm(line.points.back() - line.points.front());
    }
};

TEST(DxfUnits, AllAreScaled)
{
    // metres of one unit
    const std::vector<std::pair<int, double>> table{{1, 0.0254},
                                                    {2, 0.3048},
                                                    {3, 1609.344},
                                                    {4, 1e-3},
                                                    {5, 1e-2},
                                                    {6, 1},
                                                    {7, 1e3},
                                                    {8, 2.54e-8},
                                                    {9, 2.54e-5},
                                                    {10, 0.9144},
                                                    {11, 1e-10},
                                                    {12, 1e-9},
                                                    {13, 1e-6},
                                                    {14, 0.1},
                                                    {15, 10},
                                                    {16, 100},
                                                    {21, 1200.0 / 3937},
                                                    {22, 100.0 / 3937},
                                                    {23, 3600.0 / 3937},
                                                    {24, 6336000.0 / 3937}};
    for (const auto& [code, metres] : table) {
        for (const double job : {1.0, 25.4}) {
            const double found =
                unit_of_drawing({{9, "$INSUNITS"}, {70, std::to_string(code)}}, job);
            DOUBLES_EQUAL(1e3 * metres, found, 1e-12 * 1e3 * metres);
            CHECK_EQUAL(std::abs(found - job) > 1e-9 ? 1U : 0U, notes.size());
        }
    }
    unit_of_drawing({{9, "$INSUNITS"}, {70, "5"}}, 1);
    STRCMP_CONTAINS("d.dxf: $INSUNITS 5 says centimetres: 1 unit of the drawing is 10 mm",
                    notes[0].c_str());
}

TEST(DxfUnits, TooLargeAndUnknownOnesAreRefusedByName)
{
    const auto refused_unit = [&](const char* code) {
        return refusal([&] { unit_of_drawing({{9, "$INSUNITS"}, {70, code}}, 1); });
    };
    STRCMP_CONTAINS("the drawing is in gigametres", refused_unit("17").c_str());
    STRCMP_CONTAINS("the drawing is in astronomical units", refused_unit("18").c_str());
    STRCMP_CONTAINS("d.dxf:8: $INSUNITS 19: the drawing is in light years",
                    refused_unit("19").c_str());
    STRCMP_CONTAINS("the drawing is in parsecs", refused_unit("20").c_str());
    for (const char* unknown : {"25", "-1", "1.5", "1e300"}) {
        STRCMP_CONTAINS("names no unit: known are 0 (none) to 24", refused_unit(unknown).c_str());
    }
}

TEST(DxfUnits, TheMeasurementCountsWhereThereIsNoUnit)
{
    DOUBLES_EQUAL(25.4, unit_of_drawing({{9, "$MEASUREMENT"}, {70, "0"}}, 1), 1e-12);
    STRCMP_CONTAINS("no $INSUNITS, its $MEASUREMENT says inches", notes[0].c_str());
    DOUBLES_EQUAL(
        1, unit_of_drawing({{9, "$INSUNITS"}, {70, "0"}, {9, "$MEASUREMENT"}, {70, "1"}}, 25.4),
        1e-12);
    STRCMP_CONTAINS("its $MEASUREMENT says millimetres", notes[0].c_str());
    // either order; the unit counts more
    DOUBLES_EQUAL(10,
                  unit_of_drawing({{9, "$MEASUREMENT"}, {70, "0"}, {9, "$INSUNITS"}, {70, "5"}}, 1),
                  1e-12);
    // a drawing without either is in the job's unit
    DOUBLES_EQUAL(25.4, unit_of_drawing({}, 25.4), 1e-12);
    CHECK(notes.empty());
}
