// The units that a DXF drawing can name.
#pragma once

#include <string>

namespace cusp::import {

struct DxfUnit {
    const char* name;    // in the plural: "inches"
    double millimetres;  // of one; 0: too large for any part
};

// The unit of a value of $INSUNITS, 1 to 24; nullptr: no such unit, and of 0, which names none.
const DxfUnit* dxf_unit(int code);

}  // namespace cusp::import
