// Forms of kinds, and look-ups.
#include "host_tools/job/job/keys.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace cusp::job {

const KindForm& form_of(KeyKind kind)
{
    // in the order of the kinds
    static const std::vector<KindForm> kForms{
        {"length", true},
        {"feed", true},
        {"number"},
        {"angle"},
        {"whole number"},
        {"true or false"},
        {"text"},
        {"choice"},
        {"text or list of texts"},
        {"list of texts"},
        {"list of lengths", true},
        {"two lengths", true, false, {2}},
        {"three lengths", true, false, {3}},
        {"number or list", false, true},
        {"angle or three", false, true, {1, 3}},
        {"length or two", true, true, {1, 2}},
        {"[least, greatest]", true, false, {2}},
        {"length or [least, greatest]", true, true, {1, 2}},
        {"list of pairs", true},
        {"tool"},
        {"list of tools"},
        {"table"},
        {"tables"},
    };
    return kForms.at(static_cast<std::size_t>(kind));
}

std::string Key::plain_help() const
{
    std::string plain = help;
    plain.erase(std::remove(plain.begin(), plain.end(), '`'), plain.end());
    return plain;
}

Key Key::needing(const std::vector<std::string>& keys) const
{
    Key key = *this;
    key.needs = keys;
    return key;
}

Key Key::excluding(const std::vector<std::string>& keys) const
{
    Key key = *this;
    key.excludes = keys;
    return key;
}

bool Key::has_number_otherwise() const
{
    char* end = nullptr;
    std::strtod(otherwise.c_str(), &end);
    return end != otherwise.c_str();
}

double Key::number_otherwise() const
{
    if (!has_number_otherwise()) {
        throw std::logic_error("the key " + name + " has no number as its default");
    }
    return std::strtod(otherwise.c_str(), nullptr);
}

const Key* find_key(const std::vector<Key>& keys, const std::string& name)
{
    const auto found =
        std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
    return found == keys.end() ? nullptr : &*found;
}

}  // namespace cusp::job
