// The text of a DXF file as UTF-8, whatever its code page.
#pragma once

#include <string>
#include <string_view>

namespace cusp::import {

// Skips a byte order mark. Files from AutoCAD 2007 on (AC1021) are UTF-8; older ones are in the code
// page that $DWGCODEPAGE names, or in UTF-8 all the same. \U+XXXX becomes its character. Bytes that
// the code page lacks become U+FFFD.
//
// bytes  of the whole file
// file   for messages
//
// Errors: InputError where the bytes are UTF-16, binary DXF, DWG, or hold a NUL.
std::string dxf_text(std::string_view bytes, const std::string& file);

}  // namespace cusp::import
