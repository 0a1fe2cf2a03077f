// The coarse series; finer pitches are the reader's own.
#include "host_tools/job/job/thread.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "firmware/base/inch.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::job {
namespace {

// Nominal size in mm or inches, coarse pitch in mm or threads an inch.
using Coarse = std::array<double, 2>;

// ISO 261, first and second choice.
constexpr std::array<Coarse, 33> kMetric{
    {{1, 0.25}, {1.2, 0.25}, {1.4, 0.3}, {1.6, 0.35}, {1.8, 0.35}, {2, 0.4},  {2.5, 0.45},
     {3, 0.5},  {3.5, 0.6},  {4, 0.7},   {5, 0.8},    {6, 1},      {7, 1},    {8, 1.25},
     {10, 1.5}, {12, 1.75},  {14, 2},    {16, 2},     {18, 2.5},   {20, 2.5}, {22, 2.5},
     {24, 3},   {27, 3},     {30, 3.5},  {33, 3.5},   {36, 4},     {39, 4},   {42, 4.5},
     {45, 4.5}, {48, 5},     {52, 5},    {56, 5.5},   {64, 6}}};

// ASME B1.1, UNC. A number size is 0.06 in and 0.013 in for each number.
constexpr std::array<Coarse, 25> kUnified{
    {{0.073, 64},  {0.086, 56}, {0.099, 48}, {0.112, 40},  {0.125, 40}, {0.138, 32},  {0.164, 32},
     {0.19, 24},   {0.216, 24}, {0.25, 20},  {0.3125, 18}, {0.375, 16}, {0.4375, 14}, {0.5, 13},
     {0.5625, 12}, {0.625, 11}, {0.75, 10},  {0.875, 9},   {1, 8},      {1.125, 7},   {1.25, 7},
     {1.375, 6},   {1.5, 6},    {1.75, 5},   {2, 4.5}}};

template <std::size_t Count>
std::optional<double> coarse_of(const std::array<Coarse, Count>& series, double size)
{
    constexpr double kSame = 1e-6;
    const auto found = std::find_if(series.begin(), series.end(), [&](const Coarse& entry) {
        return entry[0] > size - kSame && entry[0] < size + kSame;
    });
    return found == series.end() ? std::nullopt : std::optional{(*found)[1]};
}

// "6", "1/4"; no value otherwise.
std::optional<double> fraction_of(const std::string& text)
{
    const std::size_t bar = text.find('/');
    if (bar == std::string::npos) {
        return number_text::number_of(text);
    }
    const auto above = number_text::number_of(text.substr(0, bar));
    const auto below = number_text::number_of(text.substr(bar + 1));
    return above && below && *below > 0 ? std::optional{*above / *below} : std::nullopt;
}

// Inches, of "#10", "1/4", "1 1/8".
std::optional<double> inches_of(const std::string& text)
{
    constexpr double kNumberZero = 0.06;
    constexpr double kEachNumber = 0.013;
    if (!text.empty() && text.front() == '#') {
        const auto number = number_text::number_of(text.substr(1));
        return number ? std::optional{kNumberZero + kEachNumber * *number} : std::nullopt;
    }
    std::istringstream words{text};
    std::optional<double> sum;
    for (std::string word; words >> word;) {
        const auto part = fraction_of(word);
        if (!part) {
            return std::nullopt;
        }
        sum = sum.value_or(0) + *part;
    }
    return sum;
}

std::optional<ThreadForm> metric_of(const std::string& text)
{
    const std::size_t by = text.find_first_of("xX");
    const auto size = number_text::number_of(text.substr(0, by));
    const auto coarse = size ? coarse_of(kMetric, *size) : std::nullopt;
    const auto pitch =
        by == std::string::npos ? coarse : number_text::number_of(text.substr(by + 1));
    if (!coarse || !pitch || !(*pitch > 0) || *pitch > *coarse) {
        return std::nullopt;
    }
    return ThreadForm{*size, *pitch};
}

std::optional<ThreadForm> unified_of(const std::string& text)
{
    const std::size_t dash = text.rfind('-');
    if (dash == std::string::npos) {
        return std::nullopt;
    }
    const auto size = inches_of(text.substr(0, dash));
    const auto threads = number_text::number_of(text.substr(dash + 1));
    const auto coarse = size ? coarse_of(kUnified, *size) : std::nullopt;
    if (!coarse || !threads || *threads < *coarse) {
        return std::nullopt;
    }
    return ThreadForm{*size * kMillimetresPerInch, kMillimetresPerInch / *threads};
}

}  // namespace

std::optional<ThreadForm> thread_of_text(const std::string& text)
{
    const bool metric = !text.empty() && (text.front() == 'M' || text.front() == 'm');
    const auto form = metric ? metric_of(text.substr(1)) : unified_of(text);
    return form && form->root() > 0 ? form : std::nullopt;
}

const Thread* thread_of(const Operation& operation)
{
    return std::any_cast<Thread>(&operation.parameters);
}

}  // namespace cusp::job
