// Words of kinds, and look-ups.
#include "host_tools/job/job/keys.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace cusp::job {

const char* words_of(KeyKind kind)
{
    switch (kind) {
        case KeyKind::kLength:
            return "length";
        case KeyKind::kRate:
            return "feed";
        case KeyKind::kNumber:
            return "number";
        case KeyKind::kAngle:
            return "angle";
        case KeyKind::kCount:
            return "whole number";
        case KeyKind::kFlag:
            return "true or false";
        case KeyKind::kText:
            return "text";
        case KeyKind::kChoice:
            return "choice";
        case KeyKind::kFiles:
            return "text or list of texts";
        case KeyKind::kTexts:
            return "list of texts";
        case KeyKind::kLengths:
            return "list of lengths";
        case KeyKind::kNumbers:
            return "number or list";
        case KeyKind::kMargin:
            return "length or two";
        case KeyKind::kExtent:
            return "[least, greatest]";
        case KeyKind::kInterval:
            return "length or [least, greatest]";
        case KeyKind::kPairs:
            return "list of pairs";
        case KeyKind::kTool:
            return "tool";
        case KeyKind::kTools:
            return "list of tools";
        case KeyKind::kTable:
            return "table";
        case KeyKind::kTables:
            return "tables";
    }
    return "";
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
