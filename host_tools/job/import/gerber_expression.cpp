// By recursive descent, of bounded depth.
#include "host_tools/job/import/gerber_expression.hpp"

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

constexpr int kDeepestExpression = 64;

class ExpressionReader {
public:
    ExpressionReader(std::string_view text,
                     const GerberVariables& variables,
                     const std::string& place)
        : whole_{text}, rest_{text}, variables_{variables}, place_{place}
    {
    }

    double value()
    {
        const double result = sum(0);
        if (!next_is('\0')) {
            refuse("ends too early");
        }
        return result;
    }

private:
    [[noreturn]] void refuse(const char* what) const
    {
        throw InputError(fmt::format("{}: the expression \"{}\" {}", place_,
                                     std::string{whole_}.substr(0, 60), what));
    }
    // '\0': the end
    bool next_is(char c)
    {
        while (!rest_.empty() && rest_.front() == ' ') {
            rest_.remove_prefix(1);
        }
        return c == '\0' ? rest_.empty() : !rest_.empty() && rest_.front() == c;
    }
    bool take(char c)
    {
        if (!next_is(c)) {
            return false;
        }
        rest_.remove_prefix(1);
        return true;
    }
    double sum(int depth)
    {
        double result = product(depth);
        while (true) {
            if (take('+')) {
                result += product(depth);
            } else if (take('-')) {
                result -= product(depth);
            } else {
                return result;
            }
        }
    }
    double product(int depth)
    {
        double result = factor(depth);
        while (true) {
            if (take('x') || take('X')) {
                result *= factor(depth);
            } else if (take('/')) {
                const double divisor = factor(depth);
                if (divisor == 0) {
                    refuse("divides by 0");
                }
                result /= divisor;
            } else {
                return result;
            }
        }
    }
    double factor(int depth)
    {
        if (depth > kDeepestExpression) {
            refuse("is nested too deeply");
        }
        if (take('-')) {
            return -factor(depth + 1);
        }
        if (take('+')) {
            return factor(depth + 1);
        }
        if (take('(')) {
            const double result = sum(depth + 1);
            if (!take(')')) {
                refuse("lacks a )");
            }
            return result;
        }
        const bool variable = take('$');
        const auto number = number_text::leading_number(rest_);
        if (!number || rest_.front() == '-') {
            refuse("has no number where one is due");
        }
        rest_.remove_prefix(number->size);
        if (!variable) {
            return number->value;
        }
        const auto found = variables_.find(static_cast<int>(number->value));
        return found == variables_.end() ? 0.0 : found->second;
    }

    std::string_view whole_;
    std::string_view rest_;
    const GerberVariables& variables_;
    const std::string& place_;
};

}  // namespace

double gerber_value(std::string_view text,
                    const GerberVariables& variables,
                    const std::string& place)
{
    return ExpressionReader{text, variables, place}.value();
}

}  // namespace cusp::import
