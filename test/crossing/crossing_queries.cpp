#include "crossing/crossing_queries.h"

#include <zlib.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

namespace meshless_cutting::test {
namespace {

constexpr int kCoordinates = 24;
constexpr int kFields = 30;

std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return fields;
}

double Number(const std::string& field, const std::string& where) {
  char* end = nullptr;
  const double x = std::strtod(field.c_str(), &end);
  if (end == field.c_str() || *end != '\0') throw std::runtime_error(where + ": '" + field + "' is not a number");
  return x;
}

CrossingQuery Parse(const std::string& line, int number, const std::string& where) {
  const std::vector<std::string> fields = Fields(line);
  if (fields.size() < kFields) throw std::runtime_error(where + ": 30 fields expected");
  CrossingQuery query;
  const auto points = Points(query);
  for (int i = 0; i < kCoordinates; ++i) (*points[i / 3])[i % 3] = Number(fields[i], where);
  query.category = fields[24];
  query.truth = fields[25] == "1";
  query.time_of_contact = Number(fields[28], where);
  query.gap = Number(fields[29], where);
  query.line = number;
  return query;
}

}  // namespace

std::vector<Eigen::Vector3d*> Points(CrossingQuery& query) {
  return {&query.a.p_t0, &query.a.q_t0, &query.b.p_t0, &query.b.q_t0,
          &query.a.p_t1, &query.a.q_t1, &query.b.p_t1, &query.b.q_t1};
}

std::vector<CrossingQuery> ReadCrossingQueries(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);  // plain text as well
  if (!file) throw std::runtime_error(path + ": cannot be opened");
  std::vector<CrossingQuery> queries;
  std::vector<char> buffer(1 << 14);
  for (int number = 1; gzgets(file.get(), buffer.data(), static_cast<int>(buffer.size())) != nullptr; ++number) {
    std::string line = buffer.data();
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
    if (!line.empty() && line[0] != '#') queries.push_back(Parse(line, number, path + ":" + std::to_string(number)));
  }
  return queries;
}

std::string ToLine(CrossingQuery query) {
  std::string line;
  char buffer[64];
  for (const Eigen::Vector3d* point : Points(query)) {
    for (int k = 0; k < 3; ++k) {
      std::snprintf(buffer, sizeof buffer, "%a,", (*point)[k]);
      line += buffer;
    }
  }
  line += query.category + (query.truth ? ",1" : ",0");
  std::snprintf(buffer, sizeof buffer, ",0,0,%.17g,%.6g", query.time_of_contact, query.gap);
  return line + buffer;
}

}  // namespace meshless_cutting::test
