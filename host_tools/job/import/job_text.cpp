// Skips strings and comments; everything else has to be ASCII.
#include "host_tools/job/import/job_text.hpp"

#include <algorithm>
#include <string_view>

#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

constexpr std::string_view kByteOrderMark{"\xEF\xBB\xBF"};

// Index after the string that starts at `from`; the end of its line where it is not closed.
std::size_t after_string(std::string_view text, std::size_t from)
{
    const char quote = text[from];
    const std::string three(3, quote);
    const bool lines = text.substr(from, 3) == three;
    for (std::size_t k = from + (lines ? 3 : 1); k < text.size(); ++k) {
        if (text[k] == '\\' && quote == '"') {
            ++k;
        } else if (lines && text.substr(k, 3) == three) {
            // The string itself may end in up to two quotes.
            k += 3;
            return std::min(text.size(), std::min(k + 2, text.find_first_not_of(quote, k)));
        } else if (!lines && (text[k] == quote || text[k] == '\n')) {
            return k + 1;
        }
    }
    return text.size();
}

}  // namespace

void check_plain_text(const std::string& text, const std::string& file)
{
    const std::string_view all{text};
    std::size_t at = all.substr(0, kByteOrderMark.size()) == kByteOrderMark ? 3 : 0;
    while (at < all.size()) {
        const char next = all[at];
        if (next == '"' || next == '\'') {
            at = after_string(all, at);
        } else if (next == '#') {
            at = std::min(all.size(), all.find('\n', at));
        } else if (static_cast<unsigned char>(next) >= 0x80) {
            const auto line =
                1 + std::count(all.begin(), all.begin() + static_cast<long>(at), '\n');
            throw InputError(
                fmt::format("{}:{}: byte 0x{:02X} outside strings and comments: letters there are "
                            "ASCII, up to 0x7F",
                            file, line, static_cast<unsigned char>(next)));
        } else {
            ++at;
        }
    }
}

}  // namespace cusp::import
