#include "clog/sweep/schema_json.hpp"

#include <nlohmann/json.hpp>

#include "clog/sweep/keys.hpp"

template <>
struct clog::Words<clog::ValueKind> {
  static constexpr Worded<ValueKind> all[] = {
      {ValueKind::number, "number"},   {ValueKind::number_or_share, "number or share"},
      {ValueKind::integer, "integer"}, {ValueKind::word, "word"},
      {ValueKind::file, "file"},       {ValueKind::text, "text"}};
};

namespace clog::sweep {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const std::optional<Bound>& bound) {
  if (!bound) return nullptr;
  return {{"value", bound->value}, {"is_allowed", bound->is_allowed}, {"reason", bound->reason}};
}

Json to_json(const Key& key) {
  Json json = {{"key", key.name},
               {"kind", name(key.kind)},
               {"words", key.words},
               {"default", key.default_text},
               {"help", key.help}};
  if (!key.parameter) {
    json["scope"] = "dp";
    return json;
  }
  const Parameter& parameter = *key.parameter;
  json["column"] = parameter.column;
  json["symbol"] = parameter.symbol;
  json["unit"] = parameter.unit;
  json["meaning"] = parameter.meaning;
  json["role"] = name(parameter.role);
  json["scope"] = parameter.scope->word;
  json["lower"] = to_json(parameter.range.lower);
  json["upper"] = to_json(parameter.range.upper);
  json["range"] = clog::text_of(parameter.range);
  json["shapes_array"] = parameter.shapes_array;
  return json;
}

}  // namespace

Json to_json(const Column& column) {
  Json json = {{"name", column.name},       {"symbol", column.symbol},
               {"unit", column.unit},       {"meaning", column.meaning},
               {"role", name(column.role)}, {"kind", name(column.kind)},
               {"size", column.size},       {"shapes_array", column.shapes_array}};
  if (const Parameter* parameter = column.parameter) {
    json["key"] = parameter->key;
    json["parameter_role"] = name(parameter->role);
    if (parameter->automatic_in) json["automatic_in"] = parameter->automatic_in->word;
    json["default"] = find_key(parameter->key).default_text;
  }
  return json;
}

Json schema_json() {
  Json keys_json = Json::array(), columns_json = Json::array();
  for (const Key& key : keys()) keys_json.push_back(to_json(key));
  for (const Column& column : columns()) columns_json.push_back(to_json(column));
  return {{"keys", keys_json}, {"columns", columns_json}};
}

}  // namespace clog::sweep
