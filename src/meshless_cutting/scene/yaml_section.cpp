#include "scene/yaml_section.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "scene/closest_key.h"

namespace meshless_cutting {
namespace {

std::string ToText(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

std::string Join(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "`" : ", `") + word + "`";
  return joined;
}

std::string ChildKey(const std::string& key, const std::string& child) {
  return key.empty() ? child : key + "." + child;
}

// "3" in quotes is text, not a number.
bool IsQuoted(const YAML::Node& node) { return node.Tag() == "!"; }

}  // namespace

bool NumberRange::Contains(double value) const {
  return std::isfinite(value) && (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
}

std::string NumberRange::Words() const {
  const double infinity = std::numeric_limits<double>::max();
  if (min == -infinity && max == infinity) return "a finite number";
  if (max == infinity) return (min_open ? "a finite number above " : "a finite number of at least ") + ToText(min);
  return std::string("a number in ") + (min_open ? "(" : "[") + ToText(min) + ", " + ToText(max) +
         (max_open ? ")" : "]");
}

std::string Quote(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "nothing";
  if (node.IsMap()) return "a map of " + std::to_string(node.size()) + " keys";
  if (node.IsSequence()) {
    if (node.size() > 8) return "a list of " + std::to_string(node.size());
    std::string list;
    for (const YAML::Node& item : node) list += (list.empty() ? "" : ", ") + Quote(item);
    return "[" + list + "]";
  }
  std::string text = node.Scalar();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return IsQuoted(node) || text.empty() ? "\"" + text + "\"" : text;
}

void YamlValue::Fail(const std::string& expected) const {
  throw std::runtime_error(SceneMessage(*source_, key_, Quote(node_), "expected " + expected));
}

double YamlValue::Number(const NumberRange& range, const std::string& remedy) const {
  const std::string expected = range.Words() + (remedy.empty() ? "" : "; " + remedy);
  double value = 0;
  if (!node_.IsScalar() || IsQuoted(node_) || !YAML::convert<double>::decode(node_, value) || !range.Contains(value)) {
    Fail(expected);
  }
  return value;
}

bool YamlValue::Flag() const {
  bool value = false;
  if (!node_.IsScalar() || IsQuoted(node_) || !YAML::convert<bool>::decode(node_, value)) Fail("true or false");
  return value;
}

int YamlValue::Integer(int min, int max) const {
  int value = 0;
  const bool is_integer = node_.IsScalar() && !IsQuoted(node_) && YAML::convert<int>::decode(node_, value);
  if (!is_integer || value < min || value > max) {
    Fail(min == max ? "the whole number " + std::to_string(min)
                    : "a whole number from " + std::to_string(min) + " to " + std::to_string(max));
  }
  return value;
}

std::string YamlValue::Text() const {
  if (!node_.IsScalar() || node_.Scalar().empty()) Fail("text that is not empty");
  return node_.Scalar();
}

std::vector<double> YamlValue::Numbers(int count, const std::string& words) const {
  std::vector<double> numbers;
  if (node_.IsSequence() && static_cast<int>(node_.size()) == count) {
    for (const YAML::Node& item : node_) {
      double value = 0;
      if (!item.IsScalar() || IsQuoted(item) || !YAML::convert<double>::decode(item, value) || !std::isfinite(value))
        break;
      numbers.push_back(value);
    }
  }
  if (static_cast<int>(numbers.size()) != count)
    Fail("a list of " + std::to_string(count) + " finite numbers, " + words);
  return numbers;
}

Eigen::Vector3d YamlValue::Vector3() const {
  const std::vector<double> numbers = Numbers(3, "x, y, z");
  return {numbers[0], numbers[1], numbers[2]};
}

std::vector<YamlValue> YamlValue::List() const {
  if (!node_.IsSequence()) Fail("a list: each entry on a line of its own that starts with `- `, or [...]");
  std::vector<YamlValue> items;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    items.emplace_back(node_[i], key_ + "[" + std::to_string(i) + "]", source_);
  }
  return items;
}

YamlSection::YamlSection(const YamlValue& value, std::vector<std::string> known_keys)
    : value_(value), known_keys_(std::move(known_keys)) {
  if (!value_.node().IsMap()) value_.Fail("a section with keys of " + Join(known_keys_));
  std::set<std::string> seen;
  for (const auto& item : value_.node()) {
    const std::string name = item.first.IsScalar() ? item.first.Scalar() : Quote(item.first);
    // Not SceneMessage(): of two keys of one name it knows the line of the first only.
    const std::string where = value_.source()->file.string() + ":" + std::to_string(item.first.Mark().line + 1) +
                              ": key `" + ChildKey(value_.key(), name) + "`: " + Quote(item.second) + ": ";
    if (std::find(known_keys_.begin(), known_keys_.end(), name) == known_keys_.end()) {
      const std::string closest = ClosestKey(name, known_keys_);
      throw std::runtime_error(where + "unknown key; expected " +
                               (closest.empty() ? "one of " + Join(known_keys_) : "`" + closest + "`?"));
    }
    if (!seen.insert(name).second) {
      throw std::runtime_error(where + "key is there twice, first in line " +
                               std::to_string(value_.source()->lines.at(ChildKey(value_.key(), name))) +
                               "; expected once: remove one");
    }
  }
}

bool YamlSection::Has(const std::string& key) const { return Find(key).has_value(); }

std::optional<YamlValue> YamlSection::Find(const std::string& key) const {
  for (const auto& item : value_.node()) {
    if (item.first.Scalar() == key) return YamlValue(item.second, ChildKey(value_.key(), key), value_.source());
  }
  return std::nullopt;
}

YamlValue YamlSection::Get(const std::string& key) const {
  if (std::optional<YamlValue> found = Find(key)) return *found;
  throw std::runtime_error(
      SceneMessage(*value_.source(), ChildKey(value_.key(), key), "",
                   "missing; expected this key in " + (value_.key().empty() ? "the scene" : "`" + value_.key() + "`")));
}

std::string YamlSection::ExactlyOneOf(const std::vector<std::string>& keys) const {
  std::string found;
  int count = 0;
  for (const std::string& key : keys) {
    if (!Has(key)) continue;
    found = key;
    ++count;
  }
  if (count != 1) Fail("exactly one of " + Join(keys));
  return found;
}

}  // namespace meshless_cutting
