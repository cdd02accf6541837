#include "urdf_tools.h"

#include <urdf/model.h>

#include <Eigen/Geometry>
#include <memory>
#include <stdexcept>

namespace meshless_cutting {
namespace {

Eigen::Isometry3d ToIsometry(const urdf::Pose& pose) {
  const auto& p = pose.position;
  const auto& q = pose.rotation;
  return Eigen::Translation3d(p.x, p.y, p.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

std::vector<Eigen::Vector3d> EdgeOfChildren(const urdf::Model& model, const std::string& link) {
  std::vector<Eigen::Vector3d> edge;
  for (int i = 0;; ++i) {
    const auto child = model.getLink(link + "_edge_" + std::to_string(i));
    if (!child || !child->parent_joint || child->parent_joint->parent_link_name != link) return edge;
    edge.push_back(ToIsometry(child->parent_joint->parent_to_joint_origin_transform).translation());
  }
}

// Half of the longest centre line of a shape, in its own frame; zero when it has none.
Eigen::Vector3d HalfLine(const urdf::GeometrySharedPtr& geometry) {
  if (const auto box = std::dynamic_pointer_cast<urdf::Box>(geometry)) {
    const Eigen::Vector3d size(box->dim.x, box->dim.y, box->dim.z);
    int axis = 0;
    size.maxCoeff(&axis);
    return 0.5 * size[axis] * Eigen::Vector3d::Unit(axis);
  }
  if (const auto cylinder = std::dynamic_pointer_cast<urdf::Cylinder>(geometry)) {
    return 0.5 * cylinder->length * Eigen::Vector3d::UnitZ();
  }
  return Eigen::Vector3d::Zero();
}

void Parse(const std::string& urdf, urdf::Model* model) {
  if (urdf.empty()) {
    throw std::runtime_error(
        "expected a robot description: set the parameter /robot_description (replay: --urdf FILE)");
  }
  if (!model->initString(urdf))
    throw std::runtime_error("expected a valid URDF in the robot description; see check_urdf");
}

// Pose of a link in the root of the tree.
Eigen::Isometry3d PoseOf(const urdf::Model& model, const std::string& name) {
  urdf::LinkConstSharedPtr link = model.getLink(name);
  if (!link) throw std::runtime_error("expected a link of the robot description `" + model.getName() + "`: " + name);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (; link->parent_joint; link = model.getLink(link->parent_joint->parent_link_name)) {
    if (link->parent_joint->type != urdf::Joint::FIXED) {
      throw std::runtime_error("expected fixed joints only between scene frame and obstacle; `" +
                               link->parent_joint->name + "` moves");
    }
    pose = ToIsometry(link->parent_joint->parent_to_joint_origin_transform) * pose;
  }
  return pose;
}

}  // namespace

std::vector<Eigen::Vector3d> EdgeOfLink(const std::string& urdf, const std::string& link) {
  urdf::Model model;
  Parse(urdf, &model);
  const auto found = model.getLink(link);
  if (!found)
    throw std::runtime_error("expected the name of a link of the robot description `" + model.getName() + "`");
  const std::vector<Eigen::Vector3d> edge = EdgeOfChildren(model, link);
  if (edge.size() >= 2) return edge;

  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  Eigen::Isometry3d T_LS = Eigen::Isometry3d::Identity();
  if (found->collision && found->collision->geometry) {
    half = HalfLine(found->collision->geometry);
    T_LS = ToIsometry(found->collision->origin);
  }
  if (half.isZero() && found->visual && found->visual->geometry) {
    half = HalfLine(found->visual->geometry);
    T_LS = ToIsometry(found->visual->origin);
  }
  if (half.isZero()) {
    throw std::runtime_error("expected a link with children " + link + "_edge_0, " + link +
                             "_edge_1, ..., or with a box or cylinder as collision or visual shape");
  }
  return {T_LS * -half, T_LS * half};
}

std::vector<BoxObstacle> CollisionBoxes(const std::string& urdf, const std::string& link, const std::string& frame) {
  urdf::Model model;
  Parse(urdf, &model);
  const Eigen::Isometry3d T_WL = PoseOf(model, frame).inverse() * PoseOf(model, link);
  std::vector<BoxObstacle> boxes;
  for (const auto& collision : model.getLink(link)->collision_array) {
    const auto box = std::dynamic_pointer_cast<urdf::Box>(collision->geometry);
    if (!box) {
      throw std::runtime_error("expected boxes as collision shapes; `" + link +
                               "` has another: put boxes around it, or give a plane or box_m in the scene");
    }
    BoxObstacle obstacle;
    obstacle.half_extents = 0.5 * Eigen::Vector3d(box->dim.x, box->dim.y, box->dim.z);
    obstacle.T_WB = T_WL * ToIsometry(collision->origin);
    boxes.push_back(obstacle);
  }
  if (boxes.empty()) throw std::runtime_error("expected a link with a collision shape; `" + link + "` has none");
  return boxes;
}

}  // namespace meshless_cutting
