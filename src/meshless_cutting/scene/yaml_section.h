// Strict access to a YAML tree: every key is known, every value is typed and in range, every error is one line.
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace meshless_cutting {

/// An interval of numbers, each end open or closed.
struct NumberRange {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool min_open = false;
  bool max_open = false;

  bool Contains(double value) const;
  /// "a number in (0, 0.5]", "a number above 0", "a finite number".
  std::string Words() const;

  static NumberRange Any() { return {}; }
  static NumberRange Above(double min) { return {min, std::numeric_limits<double>::max(), true, false}; }
  static NumberRange AtLeast(double min) { return {min, std::numeric_limits<double>::max(), false, false}; }
  static NumberRange Closed(double min, double max) { return {min, max, false, false}; }
  static NumberRange Open(double min, double max) { return {min, max, true, true}; }
};

/// A node of the tree with its key path. Cheap to copy; `source` must outlive it.
/// All getters throw std::runtime_error in the form of SceneMessage().
class YamlValue {
 public:
  YamlValue(const YAML::Node& node, std::string key, const SourceFile* source)
      : node_(node), key_(std::move(key)), source_(source) {}

  double Number(const NumberRange& range, const std::string& remedy = {}) const;
  int Integer(int min, int max) const;
  /// true or false.
  bool Flag() const;
  /// Not empty.
  std::string Text() const;
  Eigen::Vector3d Vector3() const;
  /// Number of numbers in `count`; all finite.
  std::vector<double> Numbers(int count, const std::string& words) const;
  std::vector<YamlValue> List() const;

  /// "value: expected `expected`", thrown.
  [[noreturn]] void Fail(const std::string& expected) const;
  const std::string& key() const { return key_; }
  const YAML::Node& node() const { return node_; }
  const SourceFile* source() const { return source_; }

 private:
  YAML::Node node_;
  std::string key_;  // "object.material.poisson_ratio"; empty at the top
  const SourceFile* source_;
};

/// A map whose keys are all known. The constructor checks that: unknown, misspelt and doubled keys throw.
class YamlSection {
 public:
  YamlSection(const YamlValue& value, std::vector<std::string> known_keys);

  bool Has(const std::string& key) const;
  /// Throws when the key is missing.
  YamlValue Get(const std::string& key) const;
  std::optional<YamlValue> Find(const std::string& key) const;
  /// The one of `keys` that is there; throws when none or several are.
  std::string ExactlyOneOf(const std::vector<std::string>& keys) const;
  [[noreturn]] void Fail(const std::string& expected) const { value_.Fail(expected); }

 private:
  YamlValue value_;
  std::vector<std::string> known_keys_;
};

/// Reads and parses `file`, fills `source` with its name, text and lines. `what` is expected in it, in words, for
/// messages. Throws std::runtime_error: missing or unreadable file, not YAML, not a map.
YAML::Node LoadYaml(const std::filesystem::path& file, const std::string& what, SourceFile* source);

/// A value as a message quotes it: one line, at most 60 characters; a map or a list by its kind and size.
std::string Quote(const YAML::Node& node);

}  // namespace meshless_cutting
