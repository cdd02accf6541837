#include "references.h"

#include <yaml-cpp/yaml.h>

#include <stdexcept>

namespace meshless_cutting {

double ReferenceSolution::Value(const std::string& name) const {
  const auto found = values.find(name);
  if (found == values.end()) throw std::runtime_error("the reference has no value `" + name + "`");
  return found->second;
}

std::map<std::string, ReferenceSolution> ReadReferences(const std::filesystem::path& file) {
  std::map<std::string, ReferenceSolution> references;
  try {
    for (const auto& entry : YAML::LoadFile(file.string())) {
      ReferenceSolution& solution = references[entry.first.as<std::string>()];
      for (const auto& item : entry.second) {
        const std::string name = item.first.as<std::string>();
        if (item.second.IsScalar()) {
          solution.values[name] = item.second.as<double>();
          continue;
        }
        auto& to = name == "points" ? solution.points : solution.displacements;
        for (const auto& v : item.second) to.emplace_back(v[0].as<double>(), v[1].as<double>(), v[2].as<double>());
      }
    }
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what() + "; expected the reference values of the study");
  }
  return references;
}

}  // namespace meshless_cutting
