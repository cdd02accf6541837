// Small helpers of the runs of the study.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "csv_table.h"

namespace meshless_cutting {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kDeadlineMs = 1000.0 / 60;

/// The value that a share of them stays below; not a number where there are none.
inline double Percentile(std::vector<double> values, double share) {
  if (values.empty()) return kNotMeasured;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// Marks a row as failed and says why.
inline void Fail(const std::string& note, StudyRow& row) {
  row.failed = true;
  row.note += (row.note.empty() ? "" : "; ") + note;
}

}  // namespace meshless_cutting
