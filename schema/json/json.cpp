#include "schema/json/json.hpp"

#include "core/signal/number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <unordered_set>

template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace driftlab {
namespace {

/// Builds a document and refuses what must not be in one. Members are appended without a search, which nlohmann makes
/// for each: names are looked up in a set of their own, as soon as an object has more than a few.
class StrictBuilder final : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return put(Json(nullptr)) != nullptr; }
  bool boolean(bool value) override { return put(Json(value)) != nullptr; }
  bool number_integer(number_integer_t value) override { return put(Json(value)) != nullptr; }
  bool number_unsigned(number_unsigned_t value) override { return put(Json(value)) != nullptr; }
  bool number_float(number_float_t value, const string_t& /*text*/) override {
    if (!std::isfinite(value)) {
      return refuse("a number is too large for a double");
    }
    return put(Json(value)) != nullptr;
  }
  bool string(string_t& value) override { return put(Json(std::move(value))) != nullptr; }
  bool binary(binary_t& /*value*/) override { return refuse("it holds binary data"); }
  bool start_object(std::size_t /*elements*/) override { return open(Json::object()); }
  bool key(string_t& value) override {
    Open& object = open_.back();
    auto& members = object.value->get_ref<Json::object_t&>();
    if (!is_new(object, members, value)) {
      return refuse("the member '" + value + "' appears twice in one object");
    }
    if (members.size() >= kMaxJsonMembers) {
      return refuse("an object has more than " + std::to_string(kMaxJsonMembers) + " members");
    }
    auto& list = static_cast<Json::object_t::Container&>(members);
    list.emplace_back(std::move(value), Json());
    object.member = &list.back().second;
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*elements*/) override { return open(Json::array()); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*why*/) override {
    position_ = position;
    return refuse("it is not well-formed at byte " + std::to_string(position));
  }

  [[nodiscard]] Json& document() { return document_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  /// An object or array whose end has not come. What is open in it is its last element, so `value` stays where it is.
  struct Open {
    Json* value = nullptr;
    Json* member = nullptr;                 ///< of an object: where its next value belongs
    std::unordered_set<std::string> names;  ///< of an object with more than kFewMembers
  };
  static constexpr std::size_t kFewMembers = 16;

  static bool is_new(Open& object, const Json::object_t& members, const std::string& name) {
    if (members.size() < kFewMembers) {
      return members.find(name) == members.end();
    }
    if (object.names.empty()) {
      for (const auto& [known, value] : members) {
        object.names.insert(known);
      }
    }
    return object.names.insert(name).second;
  }

  Json* put(Json value) {
    if (open_.empty()) {
      document_ = std::move(value);
      return &document_;
    }
    Open& parent = open_.back();
    if (parent.value->is_array()) {
      auto& elements = parent.value->get_ref<Json::array_t&>();
      elements.push_back(std::move(value));
      return &elements.back();
    }
    *parent.member = std::move(value);
    return parent.member;
  }
  bool open(Json value) {
    if (open_.size() >= static_cast<std::size_t>(kMaxJsonDepth)) {
      return refuse("it is nested deeper than " + std::to_string(kMaxJsonDepth) + " levels");
    }
    Json* const placed = put(std::move(value));
    open_.emplace_back().value = placed;
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  bool refuse(std::string why) {
    if (reason_.empty()) {
      reason_ = std::move(why);
    }
    return false;
  }

  Json document_;
  std::vector<Open> open_;
  std::string reason_;
  std::size_t position_ = 0;
};

nlohmann::json sorted(const Json& document) {
  if (document.is_object()) {
    nlohmann::json object = nlohmann::json::object();
    for (const auto& [name, value] : document.items()) {
      object[name] = sorted(value);
    }
    return object;
  }
  if (document.is_array()) {
    nlohmann::json array = nlohmann::json::array();
    for (const auto& value : document) {
      array.push_back(sorted(value));
    }
    return array;
  }
  return nlohmann::json(document);
}

std::string escaped(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c == '~') {
      text += "~0";
    } else if (c == '/') {
      text += "~1";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

Result<Json> parse_json(std::string_view text) {
  // nlohmann takes a zero byte for the end of its input and would ignore whatever comes after it.
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    return fail(ErrorCode::ParseError, "The JSON document cannot be read: it holds a zero byte.",
                {{"byte", std::to_string(zero + 1)}});
  }
  StrictBuilder strict;
  if (!Json::sax_parse(text, &strict)) {
    std::vector<ErrorField> fields;
    if (strict.position() > 0) {
      fields.push_back({"byte", std::to_string(strict.position())});
    }
    return fail(ErrorCode::ParseError, "The JSON document cannot be read: " + strict.reason() + ".", std::move(fields));
  }
  return std::move(strict.document());
}

std::string canonical_text(const Json& document) {
  return sorted(document).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string to_text(const Json& document) { return document.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

namespace {

double rounded_to(double value, int digits) {
  std::array<char, 32> text{};
  const auto [stop, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific, digits - 1);
  return parse_double(std::string_view(text.data(), static_cast<std::size_t>(stop - text.data()))).value_or(value);
}

}  // namespace

Json number_in(double si, double unit) {
  const double quotient = si / unit;
  if (quotient == 0.0 || !std::isfinite(quotient)) {
    return number(quotient);
  }
  for (const int digits : {15, 16}) {
    const double rounded = rounded_to(quotient, digits);
    if (rounded * unit == si) {
      return rounded;
    }
  }
  // Multiplying and dividing move a number by at most two of its last digits.
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double candidate = std::nextafter(std::nextafter(quotient, -kInfinite), -kInfinite);
  for (int step = 0; step < 5; ++step) {
    if (candidate * unit == si) {
      return candidate;
    }
    candidate = std::nextafter(candidate, kInfinite);
  }
  const double nearest = quotient * unit;
  return nearest != 0.0 && std::isfinite(nearest) ? number_in(nearest, unit) : number(quotient);
}

Json numbers(std::span<const double> values, double factor) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(number(value * factor));
  }
  return list;
}

Json interval(const Interval& interval, double factor) {
  return Json::array({number(interval.low * factor), number(interval.high * factor)});
}

Json quantity(const Estimate& estimate, double per_si, std::string_view unit) {
  return Json{{"value", number(estimate.value * per_si)}, {"unit", unit}, {"ci95", interval(estimate.ci95, per_si)}};
}

std::int64_t within(std::int64_t value, std::int64_t least, std::int64_t most) {
  return std::clamp(value, least, most);
}

void Faults::add(std::string pointer, ErrorCode code, std::string detail) {
  if (faults_.size() >= kMaxReportedFaults) {
    ++left_out_;
    return;
  }
  faults_.push_back({std::move(pointer), code, std::move(detail)});
}

Error Faults::error() const {
  Error error;
  if (faults_.empty()) {
    return error;
  }
  error.code = faults_.front().code;
  error.message = faults_.size() == 1 ? faults_.front().detail
                                      : "The document has " + std::to_string(faults_.size() + left_out_) +
                                            " faults; the first: " + faults_.front().detail;
  for (const Fault& fault : faults_) {
    error.fields.push_back({fault.pointer.empty() ? "/" : fault.pointer, fault.detail});
  }
  return error;
}

ObjectReader::ObjectReader(const Json& object, std::string pointer, Faults& faults)
    : object_(object.is_object() ? &object : nullptr), pointer_(std::move(pointer)), faults_(faults) {
  if (object_ == nullptr) {
    faults_.add(pointer_, ErrorCode::ParseError, "A JSON object is needed here.");
  }
}

std::string ObjectReader::pointer(std::string_view name) const { return pointer_ + "/" + escaped(name); }

const Json* ObjectReader::member(std::string_view name) {
  known_.emplace_back(name);
  if (object_ == nullptr) {
    return nullptr;
  }
  const auto found = object_->find(std::string(name));
  return found == object_->end() ? nullptr : &*found;
}

std::optional<std::string> ObjectReader::text(std::string_view name) {
  const Json* const value = member(name);
  if (value == nullptr) {
    return std::nullopt;
  }
  if (!value->is_string()) {
    faults_.add(pointer(name), ErrorCode::ParseError, "The member '" + std::string(name) + "' must be a text.");
    return std::nullopt;
  }
  return value->get<std::string>();
}

std::optional<double> ObjectReader::real(std::string_view name) {
  const Json* const value = member(name);
  if (value == nullptr) {
    return std::nullopt;
  }
  if (!value->is_number()) {
    faults_.add(pointer(name), ErrorCode::ParseError, "The member '" + std::string(name) + "' must be a number.");
    return std::nullopt;
  }
  return value->get<double>();
}

std::optional<std::int64_t> ObjectReader::integer(std::string_view name) {
  const Json* const value = member(name);
  if (value == nullptr) {
    return std::nullopt;
  }
  const bool whole =
      value->is_number_integer() &&
      !(value->is_number_unsigned() && value->get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX));
  if (!whole) {
    faults_.add(pointer(name), ErrorCode::ParseError, "The member '" + std::string(name) + "' must be a whole number.");
    return std::nullopt;
  }
  return value->get<std::int64_t>();
}

std::string ObjectReader::required_text(std::string_view name) {
  const bool present = object_ != nullptr && object_->contains(std::string(name));
  if (!present && object_ != nullptr) {
    faults_.add(pointer(name), ErrorCode::InvalidArgument, "The member '" + std::string(name) + "' is missing.");
  }
  return text(name).value_or("");
}

void ObjectReader::reject_unknown() {
  if (object_ == nullptr) {
    return;
  }
  std::string known;
  for (auto name = known_.begin(); name != known_.end(); ++name) {
    if (std::find(known_.begin(), name, *name) == name) {
      known += (known.empty() ? "" : ", ") + *name;
    }
  }
  for (const auto& [name, value] : object_->items()) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) {
      faults_.add(pointer(name), ErrorCode::InvalidArgument,
                  "The member '" + name + "' is not known here" + (known.empty() ? "." : "; known are " + known + "."));
    }
  }
}

}  // namespace driftlab
