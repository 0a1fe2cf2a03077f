// Numbers of things in messages: "1 curve", "2 curves".
#pragma once

#include <cstddef>
#include <string>

namespace cusp {

// thing  what is counted, in the singular, of a plural in -s; `plural` names any other
inline std::string counted(std::size_t count, const std::string& thing, const char* plural = "")
{
    const std::string many = *plural == '\0' ? thing + "s" : plural;
    return std::to_string(count) + " " + (count == 1 ? thing : many);
}

}  // namespace cusp
