#include "schema/json/recording_tags.hpp"

#include "core/signal/text.hpp"
#include "schema/json/regression.hpp"

#include <algorithm>

namespace driftlab {
namespace {

/// Labels stand in queries and sentences as `name=value,name=value`.
bool is_label(std::string_view name, std::string_view value) {
  const auto plain = [](std::string_view text) {
    return !text.empty() && std::none_of(text.begin(), text.end(), [](char c) {
      return c == ',' || static_cast<unsigned char>(c) < 32 || c == 127;
    });
  };
  return plain(name) && plain(value) && name.find('=') == std::string_view::npos;
}

constexpr const char* kLabelRule =
    "A label is a name and a value, both without commas and the name without =, for example firmware=1.5.0.";

}  // namespace

RecordingTags recording_tags_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  RecordingTags tags;
  if (!document.is_object()) {
    return tags;
  }
  ObjectReader reader(document, pointer, faults);
  if (const Json* const labels = reader.member("labels")) {
    if (!labels->is_object()) {
      faults.add(reader.pointer("labels"), ErrorCode::ParseError,
                 "Labels are an object of texts, for example {\"firmware\": \"1.5.0\"}.");
    } else {
      const ObjectReader within(*labels, reader.pointer("labels"), faults);
      for (const auto& [name, value] : labels->items()) {
        const std::string text = value.is_string() ? value.get<std::string>() : "";
        if (!is_label(name, text)) {
          faults.add(within.pointer(name), ErrorCode::InvalidArgument, kLabelRule);
        } else {
          tags.labels[name] = text;
        }
      }
    }
  }
  tags.session = reader.text("session").value_or("");
  tags.recorded_at = reader.text("recorded_at").value_or("");
  if (!tags.recorded_at.empty()) {
    if (const auto time = seconds_of(tags.recorded_at); !time) {
      faults.add(reader.pointer("recorded_at"), time.error());
    }
  }
  return tags;
}

Json to_json(const RecordingTags& tags) {
  Json document = Json::object();
  if (!tags.labels.empty()) {
    document["labels"] = tags.labels;
  }
  if (!tags.session.empty()) {
    document["session"] = tags.session;
  }
  if (!tags.recorded_at.empty()) {
    document["recorded_at"] = tags.recorded_at;
  }
  return document;
}

Result<std::map<std::string, std::string>> parse_labels(std::string_view text) {
  std::map<std::string, std::string> labels;
  for (const std::string_view word : split(text, ',')) {
    const std::size_t equals = word.find('=');
    const std::string_view value = equals == std::string_view::npos ? std::string_view() : word.substr(equals + 1);
    const bool sound = is_label(word.substr(0, equals), value);
    if (!sound || !labels.emplace(word.substr(0, equals), value).second) {
      return fail(ErrorCode::InvalidArgument,
                  std::string(kLabelRule) + " '" + std::string(word) + "' is none, or comes twice.",
                  {{"parameter", "labels"}});
    }
  }
  return labels;
}

std::vector<std::string> label_words(const std::map<std::string, std::string>& labels) {
  std::vector<std::string> words;
  for (const auto& [name, value] : labels) {
    std::string word = name;
    words.push_back(word.append("=").append(value));
  }
  return words;
}

}  // namespace driftlab
