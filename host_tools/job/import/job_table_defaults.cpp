// Values that have to be there, and those that have a default.
#include "host_tools/job/import/job_table.hpp"

namespace cusp::import {

std::string JobTable::required_text(const char* key)
{
    const std::optional<std::string> value = text(key);
    if (!value) {
        refuse(key, "is missing");
    }
    return *value;
}

std::vector<std::string> JobTable::required_texts(const char* key)
{
    const auto value = texts(key);
    if (!value) {
        refuse(key, "is missing: a list of lines, [] for none");
    }
    return *value;
}

bool JobTable::required_flag(const char* key)
{
    const std::optional<bool> value = flag(key);
    if (!value) {
        refuse(key, "is missing: true or false");
    }
    return *value;
}

double JobTable::length_or_default(const char* key, double millimetres)
{
    const auto value = length(key, millimetres);
    return value ? *value : key_of(key).number_otherwise();
}

double JobTable::number_or_default(const char* key) { return length_or_default(key, 1.0); }

int JobTable::whole_number_or_default(const char* key)
{
    const auto value = whole_number(key);
    return value ? *value : static_cast<int>(key_of(key).number_otherwise());
}

bool JobTable::flag_or_default(const char* key)
{
    return flag(key).value_or(key_of(key).otherwise == "true");
}

std::string JobTable::choice_or_default(const char* key)
{
    return choice(key).value_or(key_of(key).otherwise);
}

double JobTable::required_number(const char* key)
{
    const std::optional<double> value = number(key);
    if (!value) {
        refuse(key, "is missing");
    }
    return *value;
}

}  // namespace cusp::import
