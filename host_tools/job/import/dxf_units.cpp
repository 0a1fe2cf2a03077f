// Autodesk's table of $INSUNITS. The survey foot is 1200/3937 m, by the law of the United States of 1893.
#include "host_tools/job/import/dxf_units.hpp"

#include <array>

#include "firmware/base/inch.hpp"

namespace cusp::import {
namespace {

constexpr double kFoot = 12 * kMillimetresPerInch;
constexpr double kSurveyFoot = 1200e3 / 3937;
constexpr std::array<DxfUnit, 24> kDrawingUnits{{{"inches", kMillimetresPerInch},
                                                 {"feet", kFoot},
                                                 {"miles", 5280 * kFoot},
                                                 {"millimetres", 1},
                                                 {"centimetres", 10},
                                                 {"metres", 1e3},
                                                 {"kilometres", 1e6},
                                                 {"microinches", 1e-6 * kMillimetresPerInch},
                                                 {"mils", 1e-3 * kMillimetresPerInch},
                                                 {"yards", 3 * kFoot},
                                                 {"angstroms", 1e-7},
                                                 {"nanometres", 1e-6},
                                                 {"microns", 1e-3},
                                                 {"decimetres", 100},
                                                 {"decametres", 1e4},
                                                 {"hectometres", 1e5},
                                                 {"gigametres", 0},
                                                 {"astronomical units", 0},
                                                 {"light years", 0},
                                                 {"parsecs", 0},
                                                 {"US survey feet", kSurveyFoot},
                                                 {"US survey inches", kSurveyFoot / 12},
                                                 {"US survey yards", 3 * kSurveyFoot},
                                                 {"US survey miles", 5280 * kSurveyFoot}}};

}  // namespace

const DxfUnit* dxf_unit(int code)
{
    const bool known = code >= 1 && code <= static_cast<int>(kDrawingUnits.size());
    return known ? &kDrawingUnits[static_cast<std::size_t>(code - 1)] : nullptr;
}

}  // namespace cusp::import
