// Which runs the study makes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study_runs.h"

namespace meshless_cutting {

struct StudyTask {
  StudyRow row;                                 // its label
  std::function<void(StudyRuns&, StudyRow&)> run;
  double band = 0;                              // the error that the quick set allows; 0: none
};

/// `quick`: under three minutes on two cores that do other work as well; each task with a band. Else the full set.
std::vector<StudyTask> StudySuite(const StudyRuns& runs, bool quick);

}  // namespace meshless_cutting
