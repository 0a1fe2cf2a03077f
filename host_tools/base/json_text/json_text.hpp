// The text of a JSON value, always valid UTF-8.
//
//     write_text(file, json_text::written(stats, 1) + "\n");
//
// Programs, names of files and layers, and answers of controllers may hold any bytes; JSON holds UTF-8
// alone, and nlohmann's dump() throws where it gets other bytes. The check `constants` refuses dump()
// elsewhere.
#pragma once

#include <string>

namespace cusp::json_text {

// Bytes that are no UTF-8 become U+FFFD.
//
// json    a value of nlohmann::json or nlohmann::ordered_json
// indent  blanks of each level; below 0: all in one line
template <class Json>
std::string written(const Json& json, int indent = -1)
{
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace cusp::json_text
