// Coordinates written as digits without a point, as Gerber and Excellon files do.
#pragma once

#include <optional>
#include <string_view>

namespace cusp::import {

struct DigitFormat {
    int whole{};              // digits before the point
    int decimals{};           // behind it
    bool trailing_omitted{};  // zeros that are not written are the last ones; else the first ones

    // Of "LAX46Y46" in %FSLAX46Y46*%; nothing where it is malformed or incremental.
    static std::optional<DigitFormat> of_gerber(std::string_view text);

    // Value of the last digit, in units of the file.
    double last_place() const;

    // In units of the file; a point in the text rules. Nothing where it is no number.
    std::optional<double> value_of(std::string_view text) const;
};

}  // namespace cusp::import
