#include "csv_table.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace meshless_cutting {
namespace {

const char* const kColumns =
    "problem,material,youngs_modulus_pa,poisson_ratio,solver,time_step_s,cell_size_m,particles,integration_points,"
    "wall_ms_per_frame_p50,wall_ms_per_frame_p99,error_discretisation,error_solver,failed,note,error_field,value,reference";

/// Columns of the key: all before `particles`.
constexpr int kKeyColumns = 7;

std::string Number(double value) {
  if (std::isnan(value)) return "";
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

}  // namespace

std::string StudyRow::Key() const {
  return problem + ',' + material + ',' + Number(youngs_modulus_pa) + ',' + Number(poisson_ratio) + ',' + solver + ',' +
         Number(time_step_s) + ',' + Number(cell_size_m);
}

CsvTable::CsvTable(const std::filesystem::path& file, const std::string& header) : file_(file) {
  std::ifstream stream(file);
  bool has_columns = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (!has_columns) {
      if (line != kColumns) throw std::runtime_error(file.string() + ": not a table of `study`; expected another --output");
      has_columns = true;
      continue;
    }
    std::size_t end = 0;
    for (int column = 0; column < kKeyColumns && end != std::string::npos; ++column) {
      end = line.find(',', column == 0 ? 0 : end + 1);
    }
    keys_.insert(line.substr(0, end));
  }
  if (has_columns) return;
  std::ofstream out(file);
  out << header << kColumns << '\n';
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written; expected a path in a folder that exists");
}

void CsvTable::Append(const StudyRow& row) {
  std::ofstream out(file_, std::ios::app);
  out << row.Key() << ',' << row.particles << ',' << row.integration_points << ',' << Number(row.wall_ms_p50) << ','
      << Number(row.wall_ms_p99) << ',' << Number(row.error_discretisation) << ',' << Number(row.error_solver) << ','
      << (row.failed ? 1 : 0) << ',' << row.note << ',' << Number(row.error_field) << ',' << Number(row.value) << ','
      << Number(row.reference) << '\n';
  if (!out.flush()) throw std::runtime_error(file_.string() + ": cannot be written; the disk may be full");
  keys_.insert(row.Key());
}

}  // namespace meshless_cutting
