// InputError: how host tools refuse input that can't be used.
//
//     throw InputError(fmt::format("{}: tool {}: diameter is {:g} mm; it must be above 0", file, n,
//                                  diameter));
//     throw InputError(text, {file, line, "diameter", "-2", "above 0"});  // for programs, too
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace cusp {

// A fault in parts, as far as it is known: for editors, pages and callers from Python.
struct InputFault {
    std::string file{};
    std::uint64_t line{};  // 0: none
    std::string key{};
    std::string value{};  // as written
    std::string limit{};  // in words
    std::string
        place{};  // the table of the key as messages name it, "operation 2"; "": the top of a job
};

// Input that can't be used: exit status 2. The text names file, line or key, quantity, value and
// limit.
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& text, InputFault fault = {})
        : std::runtime_error{text}, fault_{std::move(fault)}
    {
    }

    const InputFault& fault() const { return fault_; }

private:
    InputFault fault_;
};

}  // namespace cusp
