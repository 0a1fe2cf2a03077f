// Numbers are finite: JSON has no others.
#include "host_tools/cam/engine/arguments.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::engine {

Arguments::Arguments(std::string call, const std::string& text) : call_{std::move(call)}
{
    values_ = text.empty() ? Json::object() : Json::parse(text, nullptr, false);
    if (values_.is_null()) {
        values_ = Json::object();
    }
    if (!values_.is_object()) {
        throw InputError{call_ + ": the arguments are no JSON object"};
    }
}

const Json* Arguments::find(const char* key) const
{
    read_.emplace_back(key);
    const auto found = values_.find(key);
    return found == values_.end() || found->is_null() ? nullptr : &*found;
}

void Arguments::refuse(const char* key, const char* needed) const
{
    throw InputError{fmt::format("{}: {}: {} is needed", call_, key, needed),
                     {"", 0, key, "", needed}};
}

std::string Arguments::text(const char* key) const
{
    const auto found = find_text(key);
    if (!found) {
        refuse(key, "a text");
    }
    return *found;
}

double Arguments::number(const char* key) const
{
    const auto found = find_number(key);
    if (!found) {
        refuse(key, "a number");
    }
    return *found;
}

std::vector<std::string> Arguments::texts(const char* key) const
{
    auto found = find_texts(key);
    if (found.empty()) {
        refuse(key, "a list of texts");
    }
    return found;
}

std::optional<std::string> Arguments::find_text(const char* key) const
{
    const Json* value = find(key);
    if (value != nullptr && !value->is_string()) {
        refuse(key, "a text");
    }
    return value == nullptr ? std::nullopt : std::optional{value->get<std::string>()};
}

std::optional<double> Arguments::find_number(const char* key) const
{
    const Json* value = find(key);
    if (value != nullptr && !value->is_number()) {
        refuse(key, "a number");
    }
    return value == nullptr ? std::nullopt : std::optional{value->get<double>()};
}

std::vector<std::string> Arguments::find_texts(const char* key) const
{
    const Json* value = find(key);
    std::vector<std::string> out;
    if (value == nullptr) {
        return out;
    }
    const auto is_text = [](const Json& each) {
        return each.is_string();
    };
    if (!value->is_array() || !std::all_of(value->begin(), value->end(), is_text)) {
        refuse(key, "a list of texts");
    }
    return value->get<std::vector<std::string>>();
}

std::vector<double> Arguments::find_numbers(const char* key) const
{
    const Json* value = find(key);
    if (value == nullptr) {
        return {};
    }
    const auto is_number = [](const Json& each) {
        return each.is_number();
    };
    if (!value->is_array() || !std::all_of(value->begin(), value->end(), is_number)) {
        refuse(key, "a list of numbers");
    }
    return value->get<std::vector<double>>();
}

bool Arguments::flag(const char* key, bool otherwise) const
{
    const Json* value = find(key);
    if (value != nullptr && !value->is_boolean()) {
        refuse(key, "true or false");
    }
    return value == nullptr ? otherwise : value->get<bool>();
}

void Arguments::check_all_read() const
{
    for (const auto& [key, value] : values_.items()) {
        if (std::find(read_.begin(), read_.end(), key) == read_.end()) {
            throw InputError{fmt::format("{}: {}: there is no such argument", call_, key),
                             {"", 0, key}};
        }
    }
}

}  // namespace cusp::engine
