// One form a kind; an operation is one of the strategies, told by its name.
#include "host_tools/job/import/job_schema.hpp"

#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/job/import/job_key_tables.hpp"

#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::import {

using job::Key;
using job::KeyTable;
using Schema = nlohmann::ordered_json;
using Kind = job::KeyKind;

namespace {

Schema members_of(const std::vector<Key>& keys);

Schema table_form(const KeyTable& table)
{
    Schema form = members_of(table.keys);
    form["description"] = table.help;
    return form;
}

Schema number_form(const Key& key)
{
    Schema form{{"type", "number"}};
    form[key.range.above_low ? "exclusiveMinimum" : "minimum"] = key.range.low;
    form["maximum"] = key.range.high;
    return form;
}

Schema list_of(const Schema& items) { return {{"type", "array"}, {"items", items}}; }

Schema pair_of(const Schema& items)
{
    return {{"type", "array"}, {"items", items}, {"minItems", 2}, {"maxItems", 2}};
}

Schema any_of(const std::vector<Schema>& forms) { return {{"anyOf", forms}}; }

Schema tool_form(const Key& key)
{
    Schema number = number_form(key);
    number["type"] = "integer";
    return any_of({number, {{"type", "string"}}});
}

Schema form_of(const Key& key)
{
    const Schema text{{"type", "string"}};
    const Schema number = number_form(key);
    switch (key.kind) {
        case Kind::kLength:
        case Kind::kRate:
        case Kind::kNumber:
        case Kind::kAngle:
            return number;
        case Kind::kCount: {
            Schema whole = number;
            whole["type"] = "integer";
            return whole;
        }
        case Kind::kFlag:
            return {{"type", "boolean"}};
        case Kind::kText:
            return text;
        case Kind::kChoice:
            return {{"type", "string"}, {"enum", key.choices}};
        case Kind::kFiles:
        case Kind::kTexts:
            return any_of({text, list_of(text)});
        case Kind::kLengths:
            return list_of(number);
        case Kind::kNumbers:
            return any_of({number, list_of(number)});
        case Kind::kMargin:
        case Kind::kInterval:
            return any_of({number, pair_of(number)});
        case Kind::kExtent:
            return pair_of(number);
        case Kind::kPairs:
            return list_of(pair_of(number));
        case Kind::kTool:
            return tool_form(key);
        case Kind::kTools:
            return any_of({text, list_of(tool_form(key))});
        case Kind::kTable:
            return table_form(key.members());
        case Kind::kTables: {
            const Schema each = table_form(key.members());
            return any_of({each, list_of(each)});
        }
    }
    return {};
}

Schema described(const Key& key)
{
    Schema form = form_of(key);
    form["description"] = key.help;
    form["x-kind"] = words_of(key.kind);
    form["x-default"] = key.otherwise;
    return form;
}

Schema members_of(const std::vector<Key>& keys)
{
    Schema properties = Schema::object();
    Schema required = Schema::array();
    for (const Key& key : keys) {
        properties[key.name] = described(key);
        if (key.otherwise == "needed") {
            required.push_back(key.name);
        }
    }
    Schema out{{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
    if (!required.empty()) {
        out["required"] = required;
    }
    return out;
}

Schema operation_form(const job::Strategies& strategies)
{
    Schema names = Schema::array();
    Schema conditions = Schema::array();
    for (const job::Strategy* const strategy : strategies) {
        names.push_back(strategy->name);
        Schema keys = members_of(keys_of(*strategy));
        keys["description"] = strategy->help;
        const Schema name{{"const", strategy->name}};
        conditions.push_back({{"if", {{"properties", {{"strategy", name}}}}}, {"then", keys}});
    }
    return {{"type", "object"},
            {"required", {"strategy"}},
            {"properties", {{"strategy", {{"enum", names}}}}},
            {"allOf", conditions}};
}

}  // namespace

std::string job_schema(const job::Strategies& strategies)
{
    std::vector<Key> keys;
    for (const Key& key : job_table().keys) {
        if (key.kind != Kind::kTables || key.members != nullptr) {
            keys.push_back(key);
        }
    }
    Schema schema = members_of(keys);
    const Schema operation = operation_form(strategies);
    schema["properties"]["operation"] = any_of({operation, list_of(operation)});
    schema["required"] = {"operation"};
    schema["$schema"] = "http://json-schema.org/draft-07/schema#";
    schema["title"] = "A job of cusp";
    return json_text::written(schema, 1) + "\n";
}

}  // namespace cusp::import
