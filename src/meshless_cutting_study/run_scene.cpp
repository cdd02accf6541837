#include "run_scene.h"

#include <fstream>
#include <ostream>
#include <sstream>
#include <thread>

namespace meshless_cutting {
namespace {

std::string Processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.compare(0, 10, "model name") == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

void WriteVector(std::ostream& csv, const Eigen::Vector3d& v) { csv << ',' << v.x() << ',' << v.y() << ',' << v.z(); }

void WriteRow(const Simulation& simulation, std::ostream& csv) {
  const FrameStatistics& s = simulation.statistics();
  csv << s.time_s << ',' << s.kinetic_j << ',' << s.elastic_j << ',' << s.gravity_j << ',' << s.relative_residual << ','
      << s.status << ',' << 1e3 * s.total_s;
  for (const ProbeReading& probe : simulation.probes()) WriteVector(csv, probe.displacement);
  for (const Reaction& reaction : simulation.reactions()) {
    WriteVector(csv, reaction.force_n);
    WriteVector(csv, reaction.torque_nm);
  }
  csv << '\n';
}

}  // namespace

std::string RunHeader() {
  std::ostringstream text;
  text << "# meshless_cutting " << MESHLESS_CUTTING_COMMIT << "\n# machine: " << Processor() << ", "
       << std::thread::hardware_concurrency() << " threads\n# compiler: " << MESHLESS_CUTTING_COMPILER << ' '
       << MESHLESS_CUTTING_FLAGS << '\n';
  return text.str();
}

void RunScene(const Scene& scene, int frames, std::ostream& csv, const std::function<void(double)>& progress) {
  Simulation simulation(scene);
  csv.precision(10);
  csv << RunHeader() << "# scene: " << scene.file.string() << ", " << simulation.statistics().particles << " particles, "
      << simulation.statistics().integration_points << " integration points\n";
  csv << "time_s,kinetic_j,elastic_j,gravity_j,relative_residual,status,wall_ms";
  for (const ProbeReading& probe : simulation.probes()) {
    for (const char* axis : {"_ux_m", "_uy_m", "_uz_m"}) csv << ',' << probe.name << axis;
  }
  for (const Reaction& reaction : simulation.reactions()) {
    for (const char* column : {"_fx_n", "_fy_n", "_fz_n", "_tx_nm", "_ty_nm", "_tz_nm"}) csv << ',' << reaction.name << column;
  }
  csv << '\n';
  WriteRow(simulation, csv);
  for (int frame = 0; frame < frames; ++frame) {
    simulation.Step();
    WriteRow(simulation, csv);
    progress(static_cast<double>(frame + 1) / frames);
  }
}

}  // namespace meshless_cutting
