// Whatever the bytes: a line is accepted only where its CRC, computed anew, and its number are
// right.
#include <cstddef>
#include <cstdint>
#include <string>

#include "firmware/base/assert.hpp"
#include "firmware/protocol/checked_lines.hpp"
#include "firmware/protocol/receive_queue.hpp"

namespace {

using cusp::protocol::CheckedLines;
using cusp::protocol::LineAssembler;

// The plain reading of docs/protocol.md.
bool should_accept(const std::string& raw, std::uint32_t expected)
{
    const std::size_t star = raw.rfind('*');
    if (star == std::string::npos || raw.size() - star != 9) {
        return false;
    }
    cusp::protocol::Crc32 crc;
    for (std::size_t i = 0; i < star; ++i) {
        crc.add(static_cast<std::uint8_t>(raw[i]));
    }
    const std::string digits = raw.substr(star + 1);
    if (digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos ||
        std::stoul(digits, nullptr, 16) != crc.value()) {
        return false;
    }
    LineAssembler line;
    for (std::size_t i = 0; i < star; ++i) {
        (void)line.add(static_cast<std::uint8_t>(raw[i]));
    }
    const std::string text{line.line()};
    const std::string number = "N" + std::to_string(expected);
    std::size_t end = 1;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9') {
        ++end;
    }
    return !line.overflow() && text.size() >= 2 && text[0] == 'N' && end > 1 && end <= 10 &&
           std::stoul(text.substr(1, end - 1)) == expected &&
           text.substr(0, 1) == number.substr(0, 1);
}

std::string repaired(const std::string& raw)
{
    cusp::protocol::Crc32 crc;
    for (const char c : raw) {
        crc.add(static_cast<std::uint8_t>(c));
    }
    std::string line = raw + "*";
    for (int shift = 28; shift >= 0; shift -= 4) {
        line += "0123456789ABCDEF"[crc.value() >> static_cast<unsigned>(shift) & 15U];
    }
    return line;
}

void try_line(CheckedLines& lines, const std::string& raw)
{
    LineAssembler line;
    for (const char c : raw) {
        (void)line.add(static_cast<std::uint8_t>(c));
    }
    const std::uint32_t expected = lines.expected();
    const bool accepted = lines.accept(line).has_value();
    CUSP_ASSERT(accepted == should_accept(raw, expected));
    CUSP_ASSERT(lines.expected() == expected + (accepted ? 1U : 0U));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    CheckedLines lines;
    lines.switch_on();
    std::string raw;
    for (std::size_t i = 0; i < size; ++i) {
        if (!cusp::protocol::is_line_end(data[i])) {
            raw += static_cast<char>(data[i]);
            continue;
        }
        // As it is, and with the check that would make it right: a fuzzer does not guess CRCs.
        try_line(lines, raw);
        try_line(lines, repaired(raw));
        raw.clear();
    }
    return 0;
}
