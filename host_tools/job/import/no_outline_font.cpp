// In place of outline_font.cpp where HarfBuzz is not installed.
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/outline_font.hpp"

#include "fmt/format.h"

namespace cusp::import {

struct OutlineFont::Parts {};

OutlineFont::OutlineFont(const std::string& file)
{
    throw InputError(fmt::format(
        "{}: fonts can't be read: cusp was built without HarfBuzz (libharfbuzz-dev); the "
        "single-line font needs no file",
        file));
}

OutlineFont::~OutlineFont() = default;

FontSize OutlineFont::size() const { return {}; }

FontLine OutlineFont::line(const std::string& /*text*/, const std::string& /*place*/) const
{
    return {};
}

}  // namespace cusp::import
