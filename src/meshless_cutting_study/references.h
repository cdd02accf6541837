// Reference solutions beside the scenes of the reference problems.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace meshless_cutting {

struct ReferenceSolution {
  std::map<std::string, double> values;  // SI
  std::vector<Eigen::Vector3d> points, displacements;

  /// Throws std::runtime_error when there is no such value.
  double Value(const std::string& name) const;
};

/// By "problem_modulus_ratio_model". Throws std::runtime_error: file missing or malformed.
std::map<std::string, ReferenceSolution> ReadReferences(const std::filesystem::path& file);

}  // namespace meshless_cutting
