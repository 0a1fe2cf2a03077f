// Converts decimal text to integers, without libc and without floating point.
#include "firmware/gcode/decimal.hpp"

#include <array>

namespace cusp::gcode {
namespace {

constexpr unsigned kMaxDigits = 17;
constexpr unsigned kMaxWholeDigits = 12;
constexpr unsigned kPowers = 19;

constexpr std::array<std::int64_t, kPowers> make_powers() noexcept
{
    std::array<std::int64_t, kPowers> powers{};
    std::int64_t power = 1;
    for (unsigned i = 0; i < kPowers; ++i) {
        powers[i] = power;
        power = i + 1 < kPowers ? power * 10 : power;
    }
    return powers;
}
constexpr std::array<std::int64_t, kPowers> kPowerOf10 = make_powers();

// Exact as doubles up to 10^22.
constexpr std::array<double, kPowers> kDoublePowerOf10 = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                                          1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                                          1e14, 1e15, 1e16, 1e17, 1e18};

constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

// The fraction, a count of 10^-from, as a count of 10^-to; halves away from zero. Precondition:
// the result fits.
std::int64_t rescale(std::int64_t fraction, unsigned from, unsigned to) noexcept
{
    if (from <= to) {
        return fraction * kPowerOf10[to - from];
    }
    const std::int64_t divisor = kPowerOf10[from - to];
    const std::int64_t half = divisor / 2;
    return (fraction < 0 ? fraction - half : fraction + half) / divisor;
}

// value / divisor with the remainder never negative. Precondition: divisor > 0.
ExactLength floored(std::int64_t whole_nm, std::int64_t value, std::int64_t divisor) noexcept
{
    std::int64_t quotient = value / divisor;
    std::int64_t remainder = value % divisor;
    if (remainder < 0) {
        --quotient;
        remainder += divisor;
    }
    // Both divisors are a multiple of 10^6.
    return {whole_nm + quotient, static_cast<std::int32_t>(remainder / (divisor / 1000000))};
}

}  // namespace

Result<Decimal> read_decimal(std::string_view text, std::size_t& place) noexcept
{
    std::size_t i = place;
    bool negative = false;
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) {
        negative = text[i] == '-';
        ++i;
    }
    std::int64_t digits = 0;
    unsigned count = 0;  // significant digits in `digits`
    unsigned fraction = 0;
    bool any = false;
    bool point = false;
    bool rounded = false;
    for (; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '.' && !point) {
            point = true;
            continue;
        }
        if (!is_digit(c)) {
            break;
        }
        any = true;
        const int digit = c - '0';
        if (!point && count >= kMaxWholeDigits) {
            return Error::kGcodeMaxValueExceeded;
        }
        if (count == kMaxDigits || fraction == kMaxDigits) {
            digits += !rounded && digit >= 5 ? 1 : 0;
            rounded = true;
            continue;
        }
        digits = digits * 10 + digit;
        count += digits != 0 ? 1U : 0U;
        fraction += point ? 1U : 0U;
    }
    if (!any) {
        return Error::kBadNumberFormat;
    }
    place = i;
    return Decimal{negative ? -digits : digits, static_cast<std::uint8_t>(fraction)};
}

double to_double(Decimal decimal) noexcept
{
    return static_cast<double>(decimal.digits) / kDoublePowerOf10[decimal.fraction_digits];
}

bool is_whole(Decimal decimal, std::int64_t maximum) noexcept
{
    const std::int64_t power = kPowerOf10[decimal.fraction_digits];
    return decimal.digits >= 0 && decimal.digits % power == 0 && decimal.digits / power <= maximum;
}

std::int64_t whole_part(Decimal decimal) noexcept
{
    return decimal.digits / kPowerOf10[decimal.fraction_digits];
}

Result<ExactLength> to_length(Decimal decimal, bool inches) noexcept
{
    constexpr std::int64_t kNmPerInch = 25'400'000;
    constexpr std::int64_t kNmPerMillimetre = 1'000'000;
    const std::int64_t unit = inches ? kNmPerInch : kNmPerMillimetre;
    const unsigned places = decimal.fraction_digits;
    const std::int64_t whole = decimal.digits / kPowerOf10[places];
    if (whole > kMaxCoordinateNm / unit || whole < -(kMaxCoordinateNm / unit)) {
        return Error::kGcodeMaxValueExceeded;
    }
    // Most words: no digit is below a nanometre.
    if (!inches && places <= 6) {
        return ExactLength{decimal.digits * kPowerOf10[6 - places], 0};
    }
    if (inches && places <= 5) {
        return ExactLength{decimal.digits * kPowerOf10[5 - places] * 254, 0};
    }
    // The decimals that resolve a millionth of a nanometre; the products stay below 2.6e18.
    const unsigned kept = inches ? 11 : 12;
    const std::int64_t fraction = rescale(decimal.digits % kPowerOf10[places], places, kept);
    return floored(whole * unit, fraction * unit, kPowerOf10[kept]);
}

}  // namespace cusp::gcode
