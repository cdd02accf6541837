// The table of the study: one row a run, appended as runs end, so that an interrupted study goes on where it stopped.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace meshless_cutting {

/// One run. Errors are shares (0.01 is one per cent); not a number: not measured.
struct StudyRow {
  std::string problem, material;
  double youngs_modulus_pa = 0, poisson_ratio = 0;
  std::string solver;
  double time_step_s = 0, cell_size_m = 0;
  int particles = 0, integration_points = 0;
  double wall_ms_p50 = 0, wall_ms_p99 = 0;
  double error_discretisation = 0, error_solver = 0;
  bool failed = false;
  std::string note;  // no comma
  double error_field = 0, value = 0, reference = 0;

  /// What tells runs apart: the input.
  std::string Key() const;
};

class CsvTable {
 public:
  /// Reads the rows that are there; begins a new file with `header` and the names of the columns. Throws std::runtime_error when
  /// the file cannot be written or is not a table of this program.
  CsvTable(const std::filesystem::path& file, const std::string& header);

  bool Has(const StudyRow& row) const { return keys_.count(row.Key()) > 0; }
  void Append(const StudyRow& row);

 private:
  std::filesystem::path file_;
  std::set<std::string> keys_;
};

}  // namespace meshless_cutting
