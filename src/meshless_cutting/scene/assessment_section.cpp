// `assessment` of a scene file.
#include "scene/scene_sections.h"

namespace meshless_cutting {
namespace {

PlannedCut ReadPlannedCut(const YamlValue& value) {
  const YamlSection section(value, {"tool", "points_m", "direction"});
  PlannedCut plan;
  if (const auto tool = section.Find("tool")) plan.tool = tool->Text();
  const YamlValue points = section.Get("points_m");
  for (const YamlValue& point : points.List()) plan.points.push_back(point.Vector3());
  if (plan.points.size() < 2) points.Fail("at least two points [x, y, z], in metres, object frame");
  if (const auto direction = section.Find("direction")) {
    plan.direction = direction->Vector3();
    if (!(plan.direction->norm() > 1e-6)) direction->Fail("a direction that is not zero: the one in which is cut");
  }
  return plan;
}

ForbiddenZone ReadForbiddenZone(const YamlValue& value) {
  const YamlSection section(value, {"name", "box_m"});
  return {section.Get("name").Text(), ReadBox(section.Get("box_m"))};
}

}  // namespace

AssessmentConfig ReadAssessment(const YamlValue& value) {
  const YamlSection section(value, {"planned", "forbidden"});
  AssessmentConfig assessment;
  if (const auto planned = section.Find("planned")) {
    for (const YamlValue& item : planned->List()) assessment.planned.push_back(ReadPlannedCut(item));
  }
  if (const auto forbidden = section.Find("forbidden")) {
    for (const YamlValue& item : forbidden->List()) assessment.forbidden.push_back(ReadForbiddenZone(item));
  }
  return assessment;
}

}  // namespace meshless_cutting
