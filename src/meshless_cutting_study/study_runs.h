// The runs that the study is made of: each turns one configuration into one row.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "csv_table.h"
#include "references.h"
#include "scene/scene.h"

namespace meshless_cutting {

/// A reference problem as the study varies it.
struct StudyCase {
  std::string problem;  // name of the scene file
  MaterialModel model = MaterialModel::kNeoHookean;
  double youngs_modulus_pa = 1e5, poisson_ratio = 0.45;
  double cell_size_m = 0;  // 0: the scene's
  double time_step_s = 1.0 / 60;
  SolverConfig solver;
  int frames = 30;  // of a solver's error
};

class StudyRuns {
 public:
  /// `folder` holds the scenes and references.yaml. Throws std::runtime_error when it does not.
  explicit StudyRuns(const std::filesystem::path& folder);

  /// Columns of the key.
  StudyRow Label(const StudyCase& study_case, const std::string& solver) const;

  // Each fills in a row made by Label. What fails inside (status bits, a state that is not finite) sets `failed` and `note`.

  /// Balance against the reference: its value and its field. Wall time: of frames of 1/60 s of the same object on its way there with
  /// the solver as scenes have it by default.
  void Balance(const StudyCase& study_case, StudyRow& row) const;
  /// Tip of the swinging beam over its first frames against the same steps solved to 1e-8: the solver's error.
  void SolverError(const StudyCase& study_case, StudyRow& row);
  /// Period and second trough of the swing against the reference.
  void Swing(const StudyCase& study_case, StudyRow& row) const;
  /// Frequency of one mode: "bending", "bending_2", "torsion", "axial".
  void Frequency(const StudyCase& study_case, const std::string& mode, StudyRow& row);
  /// Frames that cut: launch/block.yaml at a cell size while a blade saws through it ("cut_block"), or launch/liver.yaml at a
  /// cell size during the first stroke of its script ("cut_liver"). Times by stage in the note.
  void CutFrames(const StudyCase& study_case, StudyRow& row) const;

 private:
  Scene SceneOf(const StudyCase& study_case) const;
  const ReferenceSolution& ReferenceOf(const StudyCase& study_case) const;

  std::filesystem::path folder_;
  std::map<std::string, ReferenceSolution> references_;
  std::map<std::string, std::vector<double>> converged_;               // tip paths of the same steps solved to 1e-8
  std::map<std::string, std::map<std::string, double>> frequencies_;  // one run gives all modes: by its key
};

}  // namespace meshless_cutting
