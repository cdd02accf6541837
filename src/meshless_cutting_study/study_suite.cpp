#include "study_suite.h"

namespace meshless_cutting {
namespace {

using Model = MaterialModel;

class Suite {
 public:
  explicit Suite(const StudyRuns& runs) : runs_(runs) {}

  void Balance(const StudyCase& c, double band = 0) {
    Add(c, "quasi_static", band, [c](StudyRuns& runs, StudyRow& row) { runs.Balance(c, row); });
  }
  void Swing(const StudyCase& c, double band = 0) {
    Add(c, NameOf(c.solver), band, [c](StudyRuns& runs, StudyRow& row) { runs.Swing(c, row); });
  }
  void SolverError(StudyCase c, double band = 0) {
    c.problem = "cantilever";
    Add(c, NameOf(c.solver) + "_" + std::to_string(c.solver.newton_iterations), band,
        [c](StudyRuns& runs, StudyRow& row) { runs.SolverError(c, row); });
  }
  void Frequencies(const StudyCase& c, double band = 0) {
    for (const char* mode : {"bending", "bending_2", "torsion", "axial"}) {
      Add(c, std::string("mode_") + mode, band,
          [c, mode](StudyRuns& runs, StudyRow& row) { runs.Frequency(c, mode, row); });
    }
  }
  void CutFrames(const StudyCase& c) {
    Add(c, "default", 0, [c](StudyRuns& runs, StudyRow& row) { runs.CutFrames(c, row); });
  }

  std::vector<StudyTask> tasks;

 private:
  static std::string NameOf(const SolverConfig& solver) {
    return solver.integrator == Integrator::kImplicitEuler ? "implicit_euler" : "generalized_alpha";
  }
  void Add(const StudyCase& c, const std::string& solver, double band, std::function<void(StudyRuns&, StudyRow&)> run) {
    tasks.push_back({runs_.Label(c, solver), std::move(run), band});
  }

  const StudyRuns& runs_;
};

StudyCase Case(const std::string& problem, double modulus, double ratio, double cell, Model model = Model::kNeoHookean) {
  StudyCase c;
  c.problem = problem;
  c.model = model;
  c.youngs_modulus_pa = modulus;
  c.poisson_ratio = ratio;
  c.cell_size_m = cell;
  return c;
}

StudyCase Swinging(double cell, double time_step, Integrator integrator) {
  StudyCase c = Case("swing", 1e5, 0.45, cell);
  c.time_step_s = time_step;
  c.solver.integrator = integrator;
  return c;
}

void AddQuick(Suite& suite) {
  const double h = 0.02 / 6;  // 1,519 particles
  for (const StudyCase& c :
       {Case("cantilever", 1e5, 0.45, h), Case("cantilever", 1e5, 0.45, h, Model::kStableNeoHookean),
        Case("cantilever", 1e5, 0.45, h, Model::kStVenantKirchhoff), Case("cantilever", 1e5, 0.45, h, Model::kLinear),
        Case("cantilever", 1e5, 0.49, h), Case("cantilever", 1e4, 0.3, h), Case("cantilever", 1e6, 0.45, h)}) {
    suite.Balance(c, 0.01);
  }
  suite.Balance(Case("stretch", 1e4, 0.45, 0.004), 0.03);
  suite.Balance(Case("squeeze", 1e4, 0.3, 0.004), 0.03);
  suite.Balance(Case("torsion", 1e5, 0.45, 0.0025), 0.03);
  suite.Balance(Case("cook", 1e5, 0.3, 0.0025), 0.03);
  suite.Balance(Case("slit_beam", 2e4, 0.45, h), 0.05);
  suite.Balance(Case("slit_block", 2e4, 0.3, 0.005), 0.05);
  suite.Swing(Swinging(h, 1.0 / 120, Integrator::kGeneralizedAlpha), 0.01);
}

/// The cantilever across `cells` cells: 525 particles at 4, 1,519 at 6, 3,321 at 8, 10,309 at 12, 32,851 at 18.
StudyCase Beam(double modulus, double ratio, int cells, int newton = SolverConfig().newton_iterations) {
  StudyCase c = Case("cantilever", modulus, ratio, 0.02 / cells);
  c.solver.newton_iterations = newton;
  return c;
}

/// What says most comes first: an interrupted study is of use.
void AddFull(Suite& suite) {
  for (double rate : {60.0, 120.0, 240.0}) {
    suite.Swing(Swinging(0.02 / 6, 1 / rate, Integrator::kGeneralizedAlpha));
    suite.Swing(Swinging(0.02 / 6, 1 / rate, Integrator::kImplicitEuler));
  }
  for (int across : {3, 4, 6, 8, 10}) {
    suite.Balance(Case("cantilever", 1e5, 0.45, 0.02 / across));
    suite.Balance(Case("slit_beam", 2e4, 0.45, 0.02 / across));
  }
  for (int across : {4, 6, 8, 10}) {
    suite.Balance(Case("stretch", 1e4, 0.45, 0.04 / across));
    suite.Balance(Case("squeeze", 1e4, 0.3, 0.04 / across));
  }
  for (int across : {4, 6, 8}) {
    suite.Balance(Case("torsion", 1e5, 0.45, 0.02 / across));
    suite.Balance(Case("torsion_half_turn", 1e5, 0.3, 0.02 / across));
  }
  for (int across : {2, 4, 6}) {
    suite.Balance(Case("cook", 1e5, 0.3, 0.01 / across));
    suite.Balance(Case("cook", 1e5, 0.499, 0.01 / across));
  }
  for (int across : {6, 8, 12}) suite.Balance(Case("slit_block", 2e4, 0.3, 0.06 / across));
  for (int across : {6, 8}) {
    for (Model model : {Model::kStableNeoHookean, Model::kStVenantKirchhoff, Model::kLinear}) {
      suite.Balance(Case("cantilever", 1e5, 0.45, 0.02 / across, model));
    }
    suite.Balance(Case("cantilever", 1e5, 0.49, 0.02 / across));
    suite.Balance(Case("cantilever", 1e4, 0.3, 0.02 / across));
    suite.Balance(Case("cantilever", 1e6, 0.45, 0.02 / across));
  }
  for (double cell : {0.0046, 0.0065, 0.0085}) suite.CutFrames(Case("cut_liver", 5e3, 0.45, cell, Model::kStableNeoHookean));
  for (double cell : {0.008, 0.005, 0.004}) suite.CutFrames(Case("cut_block", 2e4, 0.4, cell, Model::kStableNeoHookean));
  for (double modulus : {1e4, 1e7}) {
    for (double ratio : {0.45, 0.49}) {
      for (int newton : {1, 2, 4, 8}) suite.SolverError(Beam(modulus, ratio, 8, newton));
    }
  }
  for (double modulus : {1e3, 1e4, 1e5, 1e6, 1e7, 1e9}) {
    for (double ratio : {0.3, 0.45, 0.49, 0.499}) suite.SolverError(Beam(modulus, ratio, 6));
  }
  for (int across : {4, 6}) {
    StudyCase modes = Case("frequencies", 1e5, 0.45, 0.02 / across, Model::kLinear);
    modes.time_step_s = 0.001;
    suite.Frequencies(modes);
  }
  suite.Balance(Case("cantilever", 1e5, 0.45, 0.02 / 12));
  // The fall. Afterwards the crushed root creases, and where its steps end is no longer unique.
  for (double ratio : {0.45, 0.49}) {
    for (int newton : {2, 3, 4}) {
      StudyCase c = Beam(1e4, ratio, 12, newton);
      c.frames = 12;
      suite.SolverError(c);
    }
  }
  for (int newton : {2, 3, 4}) suite.SolverError(Beam(1e7, 0.49, 12, newton));
  suite.Balance(Case("cantilever", 1e5, 0.45, 0.02 / 18));
  for (double modulus : {1e4, 1e7}) {
    StudyCase c = Beam(modulus, 0.45, 18);
    c.frames = 10;
    suite.SolverError(c);
  }
}

}  // namespace

std::vector<StudyTask> StudySuite(const StudyRuns& runs, bool quick) {
  Suite suite(runs);
  if (quick) {
    AddQuick(suite);
  } else {
    AddFull(suite);
  }
  return suite.tasks;
}

}  // namespace meshless_cutting
